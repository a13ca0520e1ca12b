/* scene_api.c - the scene part of facet.h: reading, counting, finding, describing. */
#include "base/result.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/text.h"
#include "io/arrays/arrays.h"
#include "io/model_file.h"
#include "io/model_needs.h"
#include "io/ogl1/ogl1_json.h"
#include "legacy/convert.h"
#include "scene/origin.h"
#include "scene/scene.h"
#include "report/report.h"

static const facet_scene_desc default_desc = {0};

/* Applies the caller's parameters over those of the file, and converts OpenGL 1 materials to glTF. */
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

facet_result facet_scene_create(const facet_arrays_desc *arrays, const facet_scene_desc *desc,
                                facet_scene **scene, facet_error *error)
{
    return model_file_create(arrays, desc ? desc : &default_desc, scene, error);
}

facet_material facet_material_default(void)
{
    return arrays_material_default();
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

const char *facet_scene_get_file(const facet_scene *scene, uint32_t index)
{
    return scene_get_file(scene, index);
}

const char *facet_scene_get_decoder(const facet_scene *scene, uint32_t index)
{
    unsigned needs = model_needs_of_scene(scene);
    for (unsigned bit = 0; bit < MODEL_NEED_COUNT; bit++)
        if (needs >> bit & 1 && index-- == 0)
            return model_need_name((model_need)(1u << bit));
    return NULL;
}

const char *facet_image_find_decoder(const void *bytes, size_t size)
{
    unsigned needs = model_needs_of_image(bytes, size);
    return needs ? model_need_name((model_need)needs) : NULL;
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

/* Finds a name among count names by name_at(), or parses it as an index. what: "scene", "camera". */
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
    return (facet_animation){.name = animation->name,
                             .begin_s = (double)animation->begin_s,
                             .end_s = (double)animation->end_s,
                             .is_external = animation->is_external};
}

facet_result facet_scene_place(facet_scene *scene, const float matrix[16], facet_error *error)
{
    return scene_place(scene, 0, matrix, error);
}

facet_result facet_scene_place_part(facet_scene *scene, uint32_t part, const float matrix[16],
                                    facet_error *error)
{
    return scene_place(scene, part, matrix, error);
}

facet_result facet_scene_append(facet_scene *scene, facet_scene *other, facet_error *error)
{
    return scene_append(scene, other, error);
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

/* ---- cameras ---- */

facet_orbit facet_orbit_default(void)
{
    return scene_orbit_default();
}

facet_result facet_camera_from_orbit(const facet_scene *scene, const facet_pose_desc *pose_desc,
                                     const facet_orbit *orbit, float aspect, facet_camera *camera,
                                     facet_error *error)
{
    return scene_fit_orbit(scene, pose_desc, orbit, aspect, camera, error);
}

facet_result facet_camera_from_scene(const facet_scene *scene, const facet_pose_desc *pose_desc,
                                     uint32_t index, facet_camera *camera, facet_error *error)
{
    *camera = (facet_camera){0};
    if (index >= scene->camera_count)
        return fail(error, FACET_ERROR_ARGUMENT, "%s: there is no camera %u; the file has %u", scene->source,
                    index, scene->camera_count);
    scene_pose pose;
    facet_result result =
        scene_pose_create(scene, pose_desc, &scene->allocator, scene->thread_count, &pose, error);
    if (result != FACET_OK)
        return result;
    const scene_posed_camera *found = NULL;
    for (uint32_t i = 0; i < pose.camera_count && !found; i++)
        if (pose.cameras[i].index == index)
            found = &pose.cameras[i];
    if (found) {
        const scene_camera *c = &found->camera;
        const float *m = found->world.m;
        *camera = (facet_camera){.fov_y_rad = c->is_orthographic ? 0.0f : c->fov_y_rad,
                                 .ortho_height = c->ortho_height,
                                 .aspect = c->is_orthographic ? c->ortho_width / c->ortho_height : c->aspect,
                                 .near_m = c->near_m,
                                 .far_m = c->far_m};
        double length =
            sqrt((double)m[8] * (double)m[8] + (double)m[9] * (double)m[9] + (double)m[10] * (double)m[10]);
        /* far from the origin, a target 1 m away would round to the eye */
        double distance =
            fmax(1.0, fmax(fabs((double)m[12]), fmax(fabs((double)m[13]), fabs((double)m[14]))));
        for (int k = 0; k < 3; k++) {
            camera->eye[k] = m[12 + k];
            camera->target[k] = (float)((double)m[12 + k] - distance * (double)m[8 + k] / length);
            camera->up[k] = m[4 + k];
        }
        if (!(length > 0.0))
            result = fail(error, FACET_ERROR_INVALID,
                          "%s: camera %u \"%s\": the matrix of its node gives it no direction", scene->source,
                          index, c->name);
    } else {
        result =
            fail(error, FACET_ERROR_ARGUMENT, "%s: camera %u \"%s\" is not attached to a node of the scene",
                 scene->source, index, scene->cameras[index].name);
    }
    scene_pose_destroy(&pose);
    return result;
}

/* ---- legacy materials ---- */

facet_result facet_scene_convert_materials(facet_scene *scene, facet_material_model to,
                                           const facet_legacy_desc *desc, const facet_log *log,
                                           facet_error *error)
{
    const facet_legacy_desc defaults = {0};
    const facet_log silent = {0};
    return legacy_convert(scene, to, desc ? desc : &defaults, log ? log : &silent, error);
}

bool facet_scene_has_legacy_materials(const facet_scene *scene)
{
    return scene_has_legacy_materials(scene);
}

uint32_t facet_scene_get_conversion_count(const facet_scene *scene)
{
    return scene->conversion ? scene->conversion->material_count : 0;
}

facet_conversion facet_scene_get_conversion(const facet_scene *scene, uint32_t index)
{
    if (index >= facet_scene_get_conversion_count(scene))
        return (facet_conversion){0};
    return scene->conversion->materials[index].summary;
}

facet_result facet_scene_report_conversion(const facet_scene *scene, facet_report_format format, char **out,
                                           facet_error *error)
{
    *out = NULL;
    text t = {.allocator = scene->allocator};
    facet_result result = FACET_OK;
    if (format == FACET_REPORT_FORMAT_HTML)
        result = report_html(scene, &t, error);
    else
        legacy_report_json(scene, &t);
    if (result == FACET_OK && t.has_failed)
        result = fail_memory(error, "report", t.capacity);
    if (result != FACET_OK) {
        text_destroy(&t);
        return result;
    }
    *out = t.data;
    return FACET_OK;
}
