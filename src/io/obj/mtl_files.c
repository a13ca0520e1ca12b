/* mtl_files.c - the files that MTL names: where they are searched, image formats by content, shared
 * textures. */
#include <string.h>

#include "io/image_kind.h"
#include "io/obj/mtl_parts.h"

/* An image file that was searched for. */
typedef struct mtl_image {
    scene_image image;
    uint32_t index; /* in the scene; SCENE_NONE: not a readable image */
} mtl_image;

/* ---- where a name may lead ---- */

/* The name behind the last separator, of Windows as well, and behind a drive ("C:a.png"). */
static const char *base_name(const char *name)
{
    const char *base = name;
    for (const char *c = name; *c; c++)
        if (*c == '/' || *c == '\\' || (*c == ':' && c == name + 1))
            base = c + 1;
    return base;
}

/* Removes the last folder from [path, end), for "..". False: there is none. */
static bool go_up(const char *path, char **end)
{
    char *start = *end;
    if (start == path)
        return false;
    for (start--; start > path && start[-1] != '/';)
        start--;
    if (*start == '/' || strncmp(start, "../", 3) == 0)
        return false;
    *end = start;
    return true;
}

/* Joins folder and name with slashes, without "./", doubled slashes and "folder/../", so that a file has
 * one name; in the arena. */
static const char *join(mtl_files *f, const char *folder, const char *name)
{
    size_t folder_length = name[0] == '/' ? 0 : strlen(folder);
    char *path = arena_alloc(f->scope.scene->arena, folder_length + strlen(name) + 2, 1);
    if (!path) {
        f->has_failed = true;
        return NULL;
    }
    memcpy(path, folder, folder_length);
    char *out = path + folder_length;
    for (const char *c = name; *c;) {
        size_t length = strcspn(c, "/");
        bool is_up = length == 2 && c[0] == '.' && c[1] == '.';
        bool is_here = length == 1 && c[0] == '.' && c[1];
        bool is_empty = length == 0 && out > path;
        if (!is_here && !is_empty && !(is_up && c[2] && go_up(path, &out))) {
            memcpy(out, c, length);
            out += length;
            if (c[length])
                *out++ = '/';
        }
        c += length + (c[length] != 0);
    }
    *out = 0;
    return path;
}

/* Tries one location. The first failure message stays, since it is about the name in the file. */
static bool try_place(mtl_files *f, const char *folder, const char *name, const char *shown, uri_bytes *out,
                      const char **found)
{
    const char *path = join(f, folder, name);
    if (!path)
        return false;
    uri_bytes bytes;
    if (file_scope_open(&f->scope, path, shown, &bytes)) {
        *out = bytes;
        *found = join(f, "", bytes.name);
        return *found != NULL;
    }
    f->has_failed = f->has_failed || bytes.result == FACET_ERROR_MEMORY;
    if (out->result == FACET_OK)
        *out = bytes;
    return false;
}

bool mtl_files_open_named(mtl_files *f, const char *folder, const char *name, uri_bytes *out,
                          const char **found)
{
    *out = (uri_bytes){0};
    *found = NULL;
    return try_place(f, folder, name, name, out, found) ||
           (folder[0] && try_place(f, "", name, name, out, found));
}

bool mtl_files_open(mtl_files *f, const char *folder, const char *name, uri_bytes *out, const char **found)
{
    const char *base = base_name(name);
    return mtl_files_open_named(f, folder, name, out, found) ||
           (base > name && base[0] &&
            (try_place(f, folder, base, name, out, found) ||
             (folder[0] && try_place(f, "", base, name, out, found))));
}

/* ---- images ---- */

static void warn_foreign(mtl_parser *p, const uri_bytes *bytes, const char *name)
{
    const char *kind = image_foreign_kind(bytes->data, bytes->size, name);
    if (kind)
        mtl_warn(
            p, "\"%.200s\" is a %s file, which facet does not read; a " IMAGE_KINDS_TEXT " file was expected",
            name, kind);
    else
        mtl_warn(p, "\"%.200s\" is no " IMAGE_KINDS_TEXT " file; the map is left out", name);
}

/* Detects format and size of an image. False: not readable; p warns. */
static bool inspect_image(mtl_parser *p, const uri_bytes *bytes, const char *name, scene_image *out)
{
    const image_kind *kind = image_kind_of_bytes(bytes->data, bytes->size);
    image header;
    facet_error error;
    if (!kind) {
        warn_foreign(p, bytes, name);
        return false;
    }
    if (image_probe(bytes->data, bytes->size, name, &header, NULL, &error) != FACET_OK) {
        p->has_failed = p->has_failed || error.result == FACET_ERROR_MEMORY;
        mtl_warn(p, "%.400s; the map is left out", error.message);
        return false;
    }
    out->mime_type = kind->mime_type;
    out->width = header.width;
    out->height = header.height;
    return true;
}

uint32_t mtl_files_image(mtl_files *f, mtl_parser *p, const char *folder, const char *name)
{
    uri_bytes bytes;
    const char *found;
    if (!mtl_files_open(f, folder, name, &bytes, &found)) {
        if (!f->has_failed)
            mtl_warn(p, "%s; the map is left out", bytes.message);
        return SCENE_NONE;
    }
    uint32_t there = index_table_find(&f->images_by_file, bytes.file);
    if (there != INDEX_TABLE_NONE)
        return f->images[there].index;
    mtl_image new = {
        .image = {.name = found, .mime_type = "", .bytes = bytes.data, .size = bytes.size, .uri = found},
        .index = SCENE_NONE};
    if (inspect_image(p, &bytes, name, &new.image))
        new.index = f->readable_count++;
    if (!mem_reserve(f->scope.allocator, (void **)&f->images, &f->image_capacity, f->image_count + 1,
                     sizeof *f->images) ||
        !index_table_add(&f->images_by_file, f->scope.allocator, bytes.file, (uint32_t)f->image_count)) {
        f->has_failed = true;
        return SCENE_NONE;
    }
    f->images[f->image_count++] = new;
    return new.index;
}

/* ---- textures ---- */

static bool is_same_texture(const scene_texture *a, const scene_texture *b)
{
    return a->image == b->image && a->wrap_u == b->wrap_u && a->wrap_v == b->wrap_v &&
           a->mag_filter == b->mag_filter && a->min_filter == b->min_filter &&
           a->mip_filter == b->mip_filter && strcmp(a->name, b->name) == 0;
}

uint32_t mtl_hash_texture(const scene_texture *texture)
{
    const uint32_t fields[6] = {texture->image,
                                (uint32_t)texture->wrap_u,
                                (uint32_t)texture->wrap_v,
                                (uint32_t)texture->mag_filter,
                                (uint32_t)texture->min_filter,
                                (uint32_t)texture->mip_filter};
    uint32_t hash = index_table_hash(INDEX_TABLE_HASH, fields, sizeof fields);
    return texture->name ? index_table_hash(hash, texture->name, strlen(texture->name)) : hash;
}

uint32_t mtl_files_texture(mtl_files *f, const scene_texture *texture)
{
    uint32_t hash = mtl_hash_texture(texture);
    size_t cursor = 0;
    for (uint32_t i; (i = index_table_next(&f->textures_by_hash, hash, &cursor)) != INDEX_TABLE_NONE;)
        if (is_same_texture(&f->textures[i], texture))
            return i;
    if (!mem_reserve(f->scope.allocator, (void **)&f->textures, &f->texture_capacity, f->texture_count + 1,
                     sizeof *f->textures) ||
        !index_table_add(&f->textures_by_hash, f->scope.allocator, hash, (uint32_t)f->texture_count)) {
        f->has_failed = true;
        return SCENE_NONE;
    }
    f->textures[f->texture_count] = *texture;
    return (uint32_t)f->texture_count++;
}

bool mtl_files_finish(mtl_files *f)
{
    facet_scene *scene = f->scope.scene;
    scene->images = arena_alloc(scene->arena, f->readable_count, sizeof *scene->images);
    scene->textures = arena_alloc(scene->arena, f->texture_count, sizeof *scene->textures);
    if (!scene->images || !scene->textures)
        return false;
    for (size_t i = 0; i < f->image_count; i++)
        if (f->images[i].index != SCENE_NONE)
            scene->images[f->images[i].index] = f->images[i].image;
    if (f->texture_count)
        memcpy(scene->textures, f->textures, f->texture_count * sizeof *f->textures);
    scene->image_count = f->readable_count;
    scene->texture_count = (uint32_t)f->texture_count;
    return true;
}

void mtl_files_destroy(mtl_files *f)
{
    mem_free(f->images);
    mem_free(f->textures);
    index_table_release(&f->images_by_file);
    index_table_release(&f->textures_by_hash);
}
