/* ogl1_save.c - the document and the images that it names, as files that appear together or not at all. */
#include <stdio.h>
#include <string.h>

#include "base/result.h"
#include "io/file_set.h"
#include "io/image_kind.h"
#include "io/ogl1/ogl1_json.h"

/* What is written. */
typedef struct saving {
    const facet_scene *scene;
    const char *path;
    const facet_scene_save_desc *desc;
    const facet_allocator *allocator;
    facet_error *error;
    char **image_names; /* per image; NULL: not written. Blocks of mem_alloc() */
} saving;

/* ---- what has no place in the document ---- */

static void warn_lost(const facet_scene *scene, const facet_log *log)
{
    for (uint32_t i = 0; i < scene->material_count; i++) {
        const legacy_material *m = &scene->legacy->materials[i];
        const legacy_map *map = &m->maps[LEGACY_DIFFUSE_MAP];
        int others = 0;
        for (int slot = 0; slot < LEGACY_MAP_COUNT; slot++)
            others += slot != LEGACY_DIFFUSE_MAP &&
                      (legacy_has_map(m, (legacy_map_slot)slot) || m->maps[slot].path);
        if (others)
            log_warning(log, "material \"%s\": rgl has one texture, that of the color; %d other%s left out",
                        m->name, others, others == 1 ? " is" : "s are");
        if (map->ref.has_transform || map->base != 0.0f || map->gain != 1.0f)
            log_warning(log,
                        "material \"%s\": rgl cannot move, scale or recolor a texture; it is used as it is",
                        m->name);
    }
}

/* ---- images ---- */

static facet_result name_image(saving *s, uint32_t number, const char *extension)
{
    const char *base = path_base_name(s->path);
    size_t stem = strlen(base) - (path_extension(base)[0] ? strlen(path_extension(base)) + 1 : 0);
    size_t size = stem + strlen(extension) + 32;
    char *name = mem_alloc(s->allocator, size, 1);
    if (!name)
        return fail_memory(s->error, "name of an image", size);
    snprintf(name, size, "%.*s_image%u.%s", (int)stem, base, number, extension);
    s->image_names[number] = name;
    return FACET_OK;
}

static facet_result name_images(saving *s, const facet_log *log)
{
    facet_result result = FACET_OK;
    for (uint32_t i = 0; i < s->scene->material_count && result == FACET_OK; i++) {
        const legacy_material *m = &s->scene->legacy->materials[i];
        uint32_t texture = m->maps[LEGACY_DIFFUSE_MAP].ref.texture;
        uint32_t number = texture != SCENE_NONE ? s->scene->textures[texture].image : SCENE_NONE;
        const scene_image *source = number != SCENE_NONE ? &s->scene->images[number] : NULL;
        const image_kind *kind =
            source && source->bytes ? image_kind_of_bytes(source->bytes, source->size) : NULL;
        if (!kind || s->image_names[number])
            continue;
        if (kind->codec != IMAGE_CODEC_PNG)
            log_warning(log, "material \"%s\": its texture is a %s file; rgl reads PNG only", m->name,
                        kind->name);
        result = name_image(s, number, kind->file_extension);
    }
    return result;
}

/* ---- files ---- */

/* The document comes last: where it is, all that it names is. */
static facet_result write_files(const saving *s, const text *document)
{
    file_set files = file_set_begin(s->scene, s->path, s->desc);
    files.inputs = s->scene;
    facet_result result = FACET_OK;
    for (uint32_t i = 0; i < s->scene->image_count && result == FACET_OK; i++)
        if (s->image_names[i])
            result = file_set_add(&files, s->image_names[i], s->scene->images[i].bytes,
                                  s->scene->images[i].size, s->error);
    if (result == FACET_OK)
        result = file_set_add(&files, NULL, document->data, document->length, s->error);
    if (result == FACET_OK)
        result = file_set_commit(&files, s->error);
    file_set_destroy(&files);
    return result;
}

facet_result ogl1_json_save(const facet_scene *scene, const char *path, const char *generator,
                            const facet_scene_save_desc *desc, facet_error *error)
{
    const facet_scene_save_desc defaults = {0};
    desc = desc ? desc : &defaults;
    saving s = {.scene = scene, .path = path, .desc = desc, .allocator = &desc->allocator, .error = error};
    text document = {.allocator = desc->allocator};
    facet_result result = FACET_OK;
    s.image_names = mem_zalloc(s.allocator, scene->image_count, sizeof *s.image_names);
    if (!s.image_names)
        return fail_memory(error, "images", scene->image_count * sizeof *s.image_names);
    result = name_images(&s, &desc->log);
    if (result == FACET_OK)
        ogl1_json_write(scene, generator, (const char *const *)s.image_names, &document);
    if (document.has_failed)
        result = fail_memory(error, "parameters", document.capacity);
    if (result == FACET_OK)
        result = write_files(&s, &document);
    if (result == FACET_OK)
        warn_lost(scene, &desc->log);
    for (uint32_t i = 0; i < scene->image_count; i++)
        mem_free(s.image_names[i]);
    mem_free(s.image_names);
    text_destroy(&document);
    return result;
}
