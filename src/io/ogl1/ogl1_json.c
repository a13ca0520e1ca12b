/* ogl1_json.c - see ogl1_json.h: a document of rgl's parameters as a scene of its own. */
#include "io/ogl1/ogl1_json.h"

#include <string.h>

#include "base/result.h"
#include "io/ogl1/ogl1_reader.h"

void ogl1_set_surroundings(const ogl1_document *d, const facet_legacy_desc *desc)
{
    scene_legacy *legacy = d->r.scene->legacy;
    facet_legacy_colors stated = desc->colors ? desc->colors : d->colors;
    if (d->has_lights) {
        legacy->light_count = d->light_count;
        legacy->lights = d->lights;
    }
    if (d->has_fog)
        legacy->fog = d->fog;
    if (stated || !legacy->colors)
        legacy->colors = stated ? stated : FACET_LEGACY_COLORS_SRGB;
    if (!legacy->dialect)
        legacy->dialect = FACET_MTL_DIALECT_SPEC;
    legacy->is_source = true;
}

static void read_scene(ogl1_document *d, const facet_scene_desc *desc)
{
    io_reader *r = &d->r;
    if (io_is_ok(r) && d->entry_count == 0)
        io_fail(r, NULL, NULL, FACET_ERROR_INVALID,
                "has neither \"materials\" nor \"material3d\", so there is nothing to show");
    if (io_is_ok(r))
        ogl1_find_textures(d);
    if (io_is_ok(r))
        ogl1_make_balls(d);
    if (!io_is_ok(r))
        return;
    r->scene->generator = d->generator;
    r->scene->legacy->fog.scale = 1.0f;
    ogl1_set_surroundings(d, &desc->legacy);
}

static facet_result load(const char *bytes, size_t size, const char *source, const char *folder,
                         const facet_scene_desc *desc, facet_scene **out, facet_error *error)
{
    facet_scene *scene = NULL;
    ogl1_document d;
    facet_result result = scene_create(&desc->allocator, source, &scene, error);
    if (result != FACET_OK)
        return result;
    scene->max_texture_size = desc->max_texture_size;
    scene->thread_count = desc->thread_count;
    ogl1_document_read(&d, scene, bytes, size, folder, desc, error);
    read_scene(&d, desc);
    if (d.r.result != FACET_OK) {
        scene_destroy(scene);
        return d.r.result;
    }
    *out = scene;
    return FACET_OK;
}

facet_result ogl1_json_load(const char *path, const facet_scene_desc *desc, facet_scene **scene,
                            facet_error *error)
{
    const facet_scene_desc defaults = {0};
    desc = desc ? desc : &defaults;
    *scene = NULL;
    file_bytes file = {0};
    facet_result result = file_open(path, desc->max_file_bytes ? desc->max_file_bytes : (uint64_t)1 << 32,
                                    &desc->allocator, &file, error);
    if (result != FACET_OK)
        return result;
    char *folder = path_folder(&desc->allocator, path);
    if (folder)
        result = load((const char *)file.data, file.size, path, folder, desc, scene, error);
    else
        result = fail_memory(error, "path", strlen(path));
    if (result == FACET_OK && !scene_note_file(*scene, &file)) {
        scene_destroy(*scene);
        *scene = NULL;
        result = fail_memory(error, "files", sizeof file);
    }
    mem_free(folder);
    file_close(&file);
    return result;
}

facet_result ogl1_json_load_memory(const void *bytes, size_t size, const char *name,
                                   const facet_scene_desc *desc, facet_scene **scene, facet_error *error)
{
    const facet_scene_desc defaults = {0};
    desc = desc ? desc : &defaults;
    *scene = NULL;
    uint64_t most = desc->max_file_bytes ? desc->max_file_bytes : (uint64_t)1 << 32;
    if (size > most)
        return fail(error, FACET_ERROR_LIMIT, "%s: %zu bytes is larger than the limit of %llu", name, size,
                    (unsigned long long)most);
    return load(bytes, size, name, NULL, desc, scene, error);
}
