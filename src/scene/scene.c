/* scene.c - a scene as an object: making, warnings, lookups. What it draws is in pose.c. */
#include "scene/scene.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/result.h"

scene_material scene_material_default(void)
{
    const scene_texture_ref none = {.texture = SCENE_NONE};
    return (scene_material){
        .name = "",
        .base_color = {1, 1, 1, 1},
        .metallic = 1.0f,
        .perceptual_roughness = 1.0f,
        .normal_scale = 1.0f,
        .occlusion_strength = 1.0f,
        .alpha_cutoff = 0.5f,
        .ior = 1.5f,
        .specular = 1.0f,
        .specular_color = {1, 1, 1},
        .base_color_texture = none,
        .metallic_roughness_texture = none,
        .normal_texture = none,
        .occlusion_texture = none,
        .emissive_texture = none,
        .specular_texture = none,
        .specular_color_texture = none,
    };
}

/* The scene and what must not move while it grows: lists of warnings and files, and the default material. */
typedef struct scene_store {
    facet_scene scene; /* first: the public pointer is this one */
    scene_material default_material;
    size_t warning_capacity;
    size_t file_capacity;
} scene_store;

facet_result scene_create(const facet_allocator *allocator, const char *source, facet_scene **out,
                          facet_error *error)
{
    *out = NULL;
    scene_store *store = mem_zalloc(allocator, 1, sizeof *store);
    if (!store)
        return fail_memory(error, "scene", sizeof *store);
    facet_scene *scene = &store->scene;
    if (allocator)
        scene->allocator = *allocator;
    scene->arena = arena_create(allocator);
    scene->source = scene->arena ? arena_strdup(scene->arena, source) : NULL;
    if (!scene->source) {
        scene_destroy(scene);
        return fail_memory(error, "scene", sizeof *store);
    }
    scene->generator = scene->version = scene->copyright = "";
    scene->default_scene = SCENE_NONE;
    store->default_material = scene_material_default();
    *out = scene;
    return FACET_OK;
}

void scene_destroy(facet_scene *scene)
{
    if (!scene)
        return;
    for (uint32_t i = 0; i < scene->file_count; i++)
        file_close(&scene->files[i]);
    mem_free(scene->files);
    mem_free(scene->warnings);
    arena_destroy(scene->arena);
    mem_free(scene);
}

bool scene_keep_file(facet_scene *scene, file_bytes *file)
{
    scene_store *store = (scene_store *)scene;
    if (!mem_reserve(&scene->allocator, (void **)&scene->files, &store->file_capacity,
                     (size_t)scene->file_count + 1, sizeof *scene->files))
        return false;
    scene->files[scene->file_count++] = *file;
    *file = (file_bytes){0};
    return true;
}

void scene_warn(facet_scene *scene, const facet_log *log, const char *format, ...)
{
    char message[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    /* A broken file can say the same thing for each of a million elements: such a list has an end. */
    enum { MOST_WARNINGS = 1000 };
    if (scene->warning_count >= MOST_WARNINGS)
        return;
    for (uint32_t i = 0; i < scene->warning_count; i++)
        if (strcmp(scene->warnings[i], message) == 0)
            return;
    if (scene->warning_count + 1 == MOST_WARNINGS)
        snprintf(message, sizeof message, "%s: has more to warn about; this is the last one", scene->source);
    log_warning(log, "%s", message);

    scene_store *store = (scene_store *)scene;
    const char *copy = arena_strdup(scene->arena, message);
    if (copy && mem_reserve(&scene->allocator, (void **)&scene->warnings, &store->warning_capacity,
                            (size_t)scene->warning_count + 1, sizeof *scene->warnings))
        scene->warnings[scene->warning_count++] = copy;
}

const scene_material *scene_get_material(const facet_scene *scene, uint32_t index)
{
    if (index == SCENE_NONE)
        return &((const scene_store *)scene)->default_material;
    return &scene->materials[index];
}
