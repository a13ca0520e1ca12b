/* scene_api.c - the scene part of facet.h: reading, counting, finding, describing. */
#include "base/result.h"
#include "base/text.h"
#include "io/model_file.h"
#include "io/ogl1/ogl1_json.h"
#include "legacy/convert.h"
#include "scene/origin.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const facet_scene_desc default_desc = {0};

/* Parameters of the caller over those of the file, and glTF materials for those that came as OpenGL 1 has them. */
static facet_result complete(facet_scene **scene, const facet_scene_desc *desc, facet_error *error)
{
    facet_result result = FACET_OK;
    if (desc->parameters)
        result = ogl1_json_overlay(*scene, desc->parameters, desc, error);
    if (result == FACET_OK && (*scene)->legacy && (*scene)->legacy->is_source &&
        !desc->legacy.keeps_materials)
        result =
            legacy_convert(*scene, FACET_MATERIAL_MODEL_METALLIC_ROUGHNESS, &desc->legacy, &desc->log, error);
    if (result != FACET_OK) {
        facet_scene_destroy(*scene);
        *scene = NULL;
    }
    return result;
}

facet_result facet_scene_load(const char *path, const facet_scene_desc *desc, facet_scene **scene,
                              facet_error *error)
{
    *scene = NULL;
    desc = desc ? desc : &default_desc;
    facet_result result = model_file_load(path, desc, scene, error);
    return result == FACET_OK ? complete(scene, desc, error) : result;
}

facet_result facet_scene_load_memory(const void *bytes, size_t size, const char *name,
                                     const facet_scene_desc *desc, facet_scene **scene, facet_error *error)
{
    *scene = NULL;
    desc = desc ? desc : &default_desc;
    facet_result result = model_file_load_memory(bytes, size, name ? name : "(memory)", desc, scene, error);
    return result == FACET_OK ? complete(scene, desc, error) : result;
}

facet_result facet_scene_create_builtin(const facet_scene_desc *desc, facet_scene **scene, facet_error *error)
{
    *scene = NULL;
    return scene_create_builtin(desc ? desc : &default_desc, scene, error);
}

void facet_scene_destroy(facet_scene *scene)
{
    scene_destroy(scene);
}

bool facet_scene_has_file(const facet_scene *scene, const char *path)
{
    return scene_has_file(scene, path);
}

facet_scene_counts facet_scene_get_counts(const facet_scene *scene)
{
    return scene_count(scene);
}

facet_result facet_scene_describe_json(const facet_scene *scene, char **text_out, facet_error *error)
{
    *text_out = NULL;
    text t = {.allocator = scene->allocator};
    scene_describe_json(scene, &t);
    if (t.has_failed) {
        text_destroy(&t);
        return fail_memory(error, "description of the scene", t.capacity);
    }
    *text_out = t.data;
    return FACET_OK;
}

void facet_text_destroy(char *description)
{
    mem_free(description);
}

/* Finds name among count names that name_at() gives; else reads it as a number. what is "scene", "camera". */
static facet_result find(const facet_scene *scene, const char *what, const char *name, uint32_t count,
                         const char *(*name_at)(const facet_scene *, uint32_t), uint32_t *index,
                         facet_error *error)
{
    for (uint32_t i = 0; i < count; i++)
        if (strcmp(name_at(scene, i), name) == 0) {
            *index = i;
            return FACET_OK;
        }
    for (uint32_t i = 0; i < count; i++)
        if (strcasecmp(name_at(scene, i), name) == 0) {
            *index = i;
            return FACET_OK;
        }
    char *end;
    unsigned long number = strtoul(name, &end, 10);
    if (end != name && *end == 0 && number < count && name[0] != '-') {
        *index = (uint32_t)number;
        return FACET_OK;
    }
    if (count == 0)
        return fail(error, FACET_ERROR_ARGUMENT, "%s: there is no %s \"%s\": the file has none",
                    scene->source, what, name);
    text names = {0};
    for (uint32_t i = 0; i < count && i < 12; i++)
        text_addf(&names, name_at(scene, i)[0] ? "%s%u \"%s\"" : "%s%u", i ? ", " : "", i, name_at(scene, i));
    if (count > 12)
        text_add(&names, ", ...");
    facet_result result =
        fail(error, FACET_ERROR_ARGUMENT, "%s: there is no %s \"%s\"; there %s %s", scene->source, what, name,
             count > 1 ? "are" : "is only", names.data ? names.data : "another");
    text_destroy(&names);
    return result;
}

static const char *scene_name(const facet_scene *scene, uint32_t index)
{
    return scene->scenes[index].name;
}

static const char *camera_name(const facet_scene *scene, uint32_t index)
{
    return scene->cameras[index].name;
}

facet_result facet_scene_find_scene(const facet_scene *scene, const char *name, uint32_t *index,
                                    facet_error *error)
{
    return find(scene, "scene", name, scene->scene_count, scene_name, index, error);
}

facet_result facet_scene_find_camera(const facet_scene *scene, const char *name, uint32_t *index,
                                     facet_error *error)
{
    return find(scene, "camera", name, scene->camera_count, camera_name, index, error);
}

static const char *animation_name(const facet_scene *scene, uint32_t index)
{
    return scene->animations[index].name;
}

static const char *variant_name(const facet_scene *scene, uint32_t index)
{
    return scene->variants[index];
}

facet_result facet_scene_find_animation(const facet_scene *scene, const char *name, uint32_t *index,
                                        facet_error *error)
{
    return find(scene, "animation", name, scene->animation_count, animation_name, index, error);
}

facet_result facet_scene_find_variant(const facet_scene *scene, const char *name, uint32_t *index,
                                      facet_error *error)
{
    return find(scene, "variant", name, scene->variant_count, variant_name, index, error);
}

facet_animation facet_scene_get_animation(const facet_scene *scene, uint32_t index)
{
    if (index >= scene->animation_count)
        return (facet_animation){0};
    const scene_animation *animation = &scene->animations[index];
    return (facet_animation){
        .name = animation->name, .begin_s = (double)animation->begin_s, .end_s = (double)animation->end_s};
}

facet_result facet_scene_place(facet_scene *scene, const float matrix[16], facet_error *error)
{
    return scene_place(scene, matrix, error);
}

facet_result facet_scene_save(const facet_scene *scene, const char *path, const facet_scene_save_desc *desc,
                              facet_error *error)
{
    char generator[64];
    snprintf(generator, sizeof generator, "facet %s", facet_version());
    return model_file_save(scene, path, generator, desc, error);
}

void facet_scene_get_origin(const facet_scene *scene, double origin[3])
{
    memcpy(origin, scene->origin, sizeof scene->origin);
}

facet_result facet_scene_choose_origin(facet_scene *scene, const facet_pose_desc *pose, facet_error *error)
{
    return scene_settle_origin(scene, pose, NULL, error);
}

bool facet_scene_get_bounds(const facet_scene *scene, const facet_pose_desc *desc, float minimum[3],
                            float maximum[3])
{
    scene_pose pose;
    bool has_bounds = false;
    memset(minimum, 0, 3 * sizeof *minimum);
    memset(maximum, 0, 3 * sizeof *maximum);
    if (scene_pose_create(scene, desc, &scene->allocator, scene->thread_count, &pose, NULL) == FACET_OK) {
        has_bounds = pose.has_bounds;
        memcpy(minimum, pose.bounds_min, sizeof pose.bounds_min);
        memcpy(maximum, pose.bounds_max, sizeof pose.bounds_max);
        scene_pose_destroy(&pose);
    }
    return has_bounds;
}
