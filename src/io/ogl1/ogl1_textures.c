/* ogl1_textures.c - the pictures that materials name, found beside the document or below the root, not decoded. R gives
 * whole paths of its own machine: what is not allowed or not there by that path is looked for beside the document by its
 * name alone. */
#include <stdio.h>
#include <string.h>

#include "io/image_kind.h"
#include "io/obj/mtl_parts.h"
#include "io/ogl1/ogl1_reader.h"

/* What is appended to the scene. */
typedef struct findings {
    mtl_files files; /* for its scope */
    scene_image *images;
    size_t image_count, image_capacity;
    scene_texture *textures;
    size_t texture_count, texture_capacity;
    index_table images_by_file, textures_by_hash;
} findings;

static void warn(io_reader *r, const char *path, const char *what)
{
    io_warn(r, NULL, NULL, "texture \"%.200s\": %.400s; it is left out", path, what);
}

/* Number of the image among those found, SCENE_NONE: there is none; a warning says so. */
static uint32_t find_image(io_reader *r, findings *f, const char *path)
{
    uri_bytes bytes;
    const char *found;
    image header;
    facet_error error;
    if (!mtl_files_open(&f->files, "", path, &bytes, &found)) {
        if (f->files.has_failed)
            io_fail_memory(r, "texture", 0);
        else
            warn(r, path, bytes.message);
        return SCENE_NONE;
    }
    uint32_t there = index_table_find(&f->images_by_file, bytes.file);
    if (there != INDEX_TABLE_NONE)
        return there;
    const image_kind *kind = image_kind_of_bytes(bytes.data, bytes.size);
    if (!kind) {
        const char *foreign = image_foreign_kind(bytes.data, bytes.size, path);
        char what[160];
        snprintf(what, sizeof what, "is a %s file; " IMAGE_KINDS_TEXT " was expected",
                 foreign ? foreign : "");
        warn(r, path, foreign ? what : "is no " IMAGE_KINDS_TEXT " file");
        return SCENE_NONE;
    }
    if (image_probe(bytes.data, bytes.size, path, &header, NULL, &error) != FACET_OK) {
        warn(r, path, error.message);
        return SCENE_NONE;
    }
    if (!mem_reserve(r->allocator, (void **)&f->images, &f->image_capacity, f->image_count + 1,
                     sizeof *f->images) ||
        !index_table_add(&f->images_by_file, r->allocator, bytes.file, (uint32_t)f->image_count)) {
        io_fail_memory(r, "images", 0);
        return SCENE_NONE;
    }
    f->images[f->image_count] = (scene_image){.name = found,
                                              .mime_type = kind->mime_type,
                                              .bytes = bytes.data,
                                              .size = bytes.size,
                                              .width = header.width,
                                              .height = header.height,
                                              .uri = found};
    return (uint32_t)f->image_count++;
}

/* Number of the texture among those found. */
static uint32_t find_texture(io_reader *r, findings *f, const scene_texture *like)
{
    uint32_t hash = mtl_hash_texture(like);
    size_t cursor = 0;
    for (uint32_t i; (i = index_table_next(&f->textures_by_hash, hash, &cursor)) != INDEX_TABLE_NONE;)
        if (f->textures[i].image == like->image && f->textures[i].mag_filter == like->mag_filter &&
            f->textures[i].min_filter == like->min_filter && f->textures[i].mip_filter == like->mip_filter)
            return i;
    if (!mem_reserve(r->allocator, (void **)&f->textures, &f->texture_capacity, f->texture_count + 1,
                     sizeof *f->textures) ||
        !index_table_add(&f->textures_by_hash, r->allocator, hash, (uint32_t)f->texture_count)) {
        io_fail_memory(r, "textures", 0);
        return SCENE_NONE;
    }
    f->textures[f->texture_count] = *like;
    return (uint32_t)f->texture_count++;
}

/* old and, behind it, more, in the arena. */
static void *joined(io_reader *r, const void *old, size_t old_count, const void *more, size_t count,
                    size_t size)
{
    char *all = io_alloc_raw(r, "textures", old_count + count, size);
    if (all && old_count)
        memcpy(all, old, old_count * size);
    if (all && count)
        memcpy(all + old_count * size, more, count * size);
    return all;
}

static void append(io_reader *r, findings *f)
{
    facet_scene *scene = r->scene;
    for (size_t i = 0; i < f->texture_count; i++)
        f->textures[i].image += scene->image_count;
    scene_image *images =
        joined(r, scene->images, scene->image_count, f->images, f->image_count, sizeof *images);
    scene_texture *textures =
        joined(r, scene->textures, scene->texture_count, f->textures, f->texture_count, sizeof *textures);
    if (!io_is_ok(r))
        return;
    scene->images = images;
    scene->image_count += (uint32_t)f->image_count;
    scene->textures = textures;
    scene->texture_count += (uint32_t)f->texture_count;
}

void ogl1_find_textures(ogl1_document *d)
{
    io_reader *r = &d->r;
    uint32_t first = r->scene->texture_count;
    findings f = {.files = {.scope = {.scene = r->scene,
                                      .allocator = r->allocator,
                                      .folder = r->folder,
                                      .root = r->root,
                                      .log = r->log,
                                      .max_file_bytes = r->max_file_bytes,
                                      .allows_absolute = true}}};
    for (uint32_t i = 0; i < d->entry_count && io_is_ok(r); i++) {
        legacy_map *map = &d->entries[i].material.maps[LEGACY_DIFFUSE_MAP];
        scene_texture like = d->entries[i].sampler;
        like.image = map->path ? find_image(r, &f, map->path) : SCENE_NONE;
        uint32_t texture = like.image == SCENE_NONE ? SCENE_NONE : find_texture(r, &f, &like);
        map->ref.texture = texture == SCENE_NONE ? SCENE_NONE : first + texture;
    }
    if (io_is_ok(r) && f.image_count)
        append(r, &f);
    mtl_files_destroy(&f.files);
    mem_free(f.images);
    mem_free(f.textures);
    index_table_release(&f.images_by_file);
    index_table_release(&f.textures_by_hash);
}
