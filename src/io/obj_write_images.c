/* obj_write_images.c - the images of an OBJ file: beside it, by their own names where those are plain and nothing else
 * bears them there, else as STEM_image0.png. */
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "io/image_kind.h"
#include "io/obj_write.h"

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
        bool has_gltf = !desc->without_mtl_pbr && (!legacy->is_source || m->is_gltf_restored);
        for (int slot = 0; slot < (desc->without_mtl_pbr ? (int)LEGACY_NORMAL_MAP : (int)LEGACY_MAP_COUNT);
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

static bool is_taken(const obj_images *images, uint32_t count, const char *name)
{
    for (uint32_t i = 0; i < count; i++)
        if (images->names[i] && strcasecmp(images->names[i], name) == 0)
            return true;
    return false;
}

typedef enum presence { NOT_THERE, SAME, OTHER, NO_MEMORY } presence;

/* Whether a file of that name stands beside path, and holds the image. */
static presence look_beside(const char *path, const char *name, const scene_image *source,
                            const facet_allocator *allocator)
{
    file_bytes file = {0};
    char *folder = path_folder(allocator, path);
    char *beside = folder ? path_join(allocator, folder, name) : NULL;
    presence found = NO_MEMORY;
    if (beside) {
        facet_error error;
        facet_result result = file_open(beside, 0, allocator, &file, &error);
        found = result == FACET_ERROR_MEMORY                                                       ? NO_MEMORY
                : result != FACET_OK                                                               ? NOT_THERE
                : file.size == source->size && memcmp(file.data, source->bytes, source->size) == 0 ? SAME
                                                                                                   : OTHER;
    }
    file_close(&file);
    mem_free(beside);
    mem_free(folder);
    return found;
}

/* Adds the name of an image to *at, which has room for it. False: no memory. */
static bool name_image(const facet_scene *scene, uint32_t index, const char *path, const char *stem,
                       const facet_allocator *allocator, obj_images *out, char *at)
{
    const scene_image *source = &scene->images[index];
    const image_kind *kind = image_kind_of_mime_type(source->mime_type);
    const char *own = path_base_name(source->uri ? source->uri : source->name);
    if (is_plain(own, kind) && !is_taken(out, index, own)) {
        presence found = look_beside(path, own, source, allocator);
        if (found == NO_MEMORY)
            return false;
        if (found != OTHER) {
            strcpy(at, own);
            out->is_there[index] = found == SAME;
            out->names[index] = at;
            return true;
        }
    }
    sprintf(at, "%s_image%u.%s", stem, index, kind->file_extension);
    for (uint32_t again = scene->image_count; is_taken(out, index, at); again++)
        sprintf(at, "%s_image%u.%s", stem, again, kind->file_extension);
    out->names[index] = at;
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
    bool is_done = is_used && out->names && out->is_there && out->storage;
    if (is_done)
        find_used(scene, desc, is_used);
    for (uint32_t i = 0; i < scene->image_count && is_done; i++) {
        const scene_image *source = &scene->images[i];
        if (is_used[i] && source->bytes && image_kind_of_mime_type(source->mime_type))
            is_done = name_image(scene, i, path, stem, &desc->allocator, out, out->storage + i * room);
    }
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
