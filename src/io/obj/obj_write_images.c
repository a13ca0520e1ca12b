/* obj_write_images.c - the images of an OBJ file: beside it, by their own names where those are plain and nothing else
 * bears them there, else as STEM_image0.png. */
#define _POSIX_C_SOURCE 200809L
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "io/image_kind.h"
#include "io/name_table.h"
#include "io/obj/obj_write.h"

/* ---- which ones ---- */

static void use_texture(const facet_scene *scene, uint32_t texture, bool *is_used)
{
    if (texture != SCENE_NONE && scene->textures[texture].image != SCENE_NONE)
        is_used[scene->textures[texture].image] = true;
}

/* Those of the maps, and of the glTF materials that are written as comments. */
static void find_used(const facet_scene *scene, const facet_scene_save_desc *desc, bool *is_used)
{
    const scene_legacy *legacy = scene->legacy;
    for (uint32_t i = 0; i < scene->material_count; i++) {
        const legacy_material *m = &legacy->materials[i];
        bool has_gltf = !desc->omits_mtl_pbr && (!legacy->is_source || m->is_gltf_restored);
        for (int slot = 0; slot < (desc->omits_mtl_pbr ? (int)LEGACY_NORMAL_MAP : (int)LEGACY_MAP_COUNT);
             slot++)
            use_texture(scene, m->maps[slot].ref.texture, is_used);
        for (int slot = 0; has_gltf && slot < SCENE_TEXTURE_SLOT_COUNT; slot++)
            use_texture(scene, scene->materials[i].textures[slot].texture, is_used);
    }
}

/* ---- names ---- */

/* Names that every program reads, on every system, with the end that their kind has. */
static bool is_plain(const char *name, const image_kind *kind)
{
    const char *extension = path_extension(name);
    bool is_right = strcasecmp(extension, kind->file_extension) == 0 ||
                    (strcmp(kind->file_extension, "jpg") == 0 && strcasecmp(extension, "jpeg") == 0);
    return is_right && name[0] != '.' && name[0] != '-' && strlen(name) < 200 &&
           name[strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-")] == 0;
}

typedef enum presence { NOT_THERE, SAME, OTHER, NO_MEMORY } presence;

/* Whether the file at path holds the image. Only a regular file of its size is opened: a pipe would keep the reader waiting,
 * a device might never end. */
static presence look_at(const char *path, const scene_image *source, const facet_allocator *allocator)
{
    struct stat status;
    if (stat(path, &status) != 0)
        return lstat(path, &status) != 0 && (errno == ENOENT || errno == ENOTDIR) ? NOT_THERE : OTHER;
    if (!S_ISREG(status.st_mode) || (uint64_t)status.st_size != source->size)
        return OTHER;
    file_bytes file = {0};
    facet_result result = file_open(path, 0, allocator, &file, NULL);
    bool is_same = result == FACET_OK && file.size == source->size &&
                   memcmp(file.data, source->bytes, source->size) == 0;
    file_close(&file);
    return result == FACET_ERROR_MEMORY ? NO_MEMORY : is_same ? SAME : OTHER;
}

/* The same, by its name beside path. */
static presence look_beside(const char *path, const char *name, const scene_image *source,
                            const facet_allocator *allocator)
{
    char *folder = path_folder(allocator, path);
    char *beside = folder ? path_join(allocator, folder, name) : NULL;
    presence found = beside ? look_at(beside, source, allocator) : NO_MEMORY;
    mem_free(beside);
    mem_free(folder);
    return found;
}

/* What names are found with. */
typedef struct image_namer {
    const facet_scene *scene;
    const char *path, *stem;
    const facet_allocator *allocator;
    name_table taken;
    uint32_t next; /* numbers from that of the images on and below it are taken */
} image_namer;

/* Adds the name of an image to *at, which has room for it. False: no memory. */
static bool name_image(image_namer *namer, uint32_t index, obj_images *out, char *at)
{
    const scene_image *source = &namer->scene->images[index];
    const image_kind *kind = image_kind_of_mime_type(source->mime_type);
    const char *own = path_base_name(source->uri ? source->uri : source->name);
    out->names[index] = at;
    if (is_plain(own, kind) && !name_table_has(&namer->taken, own)) {
        presence found = look_beside(namer->path, own, source, namer->allocator);
        if (found == NO_MEMORY)
            return false;
        if (found != OTHER) {
            strcpy(at, own);
            out->is_there[index] = found == SAME;
            return name_table_add(&namer->taken, at);
        }
    }
    sprintf(at, "%s_image%u.%s", namer->stem, index, kind->file_extension);
    while (!name_table_add(&namer->taken, at))
        sprintf(at, "%s_image%u.%s", namer->stem, namer->next++, kind->file_extension);
    return true;
}

bool obj_images_create(const facet_scene *scene, const char *path, const char *stem,
                       const facet_scene_save_desc *desc, obj_images *out)
{
    *out = (obj_images){0};
    enum { NUMBER_ROOM = 32 };
    const size_t own_room = 200 + NUMBER_ROOM;
    size_t room = own_room + strlen(stem);
    bool *is_used = mem_zalloc(&desc->allocator, scene->image_count, sizeof *is_used);
    out->names = mem_zalloc(&desc->allocator, scene->image_count, sizeof *out->names);
    out->is_there = mem_zalloc(&desc->allocator, scene->image_count, sizeof *out->is_there);
    out->storage = mem_alloc(&desc->allocator, scene->image_count, room);
    image_namer namer = {.scene = scene,
                         .path = path,
                         .stem = stem,
                         .allocator = &desc->allocator,
                         .next = scene->image_count};
    bool is_done = is_used && out->names && out->is_there && out->storage &&
                   name_table_create(&namer.taken, scene->image_count, true, &desc->allocator);
    if (is_done)
        find_used(scene, desc, is_used);
    for (uint32_t i = 0; i < scene->image_count && is_done; i++) {
        const scene_image *source = &scene->images[i];
        if (is_used[i] && source->bytes && image_kind_of_mime_type(source->mime_type))
            is_done = name_image(&namer, i, out, out->storage + i * room);
    }
    name_table_destroy(&namer.taken);
    mem_free(is_used);
    if (!is_done)
        obj_images_destroy(out);
    return is_done;
}

void obj_images_destroy(obj_images *images)
{
    mem_free(images->names);
    mem_free(images->is_there);
    mem_free(images->storage);
    *images = (obj_images){0};
}
