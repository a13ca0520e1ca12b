/* obj_write.c - writes a scene at rest as an OBJ file with its MTL file and images, all or nothing. Images
 * keep their own names where those are plain and free, and are called STEM_image0.png otherwise. */
#define _POSIX_C_SOURCE 200809L
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "base/result.h"
#include "io/file_set.h"
#include "io/image_kind.h"
#include "io/name_table.h"
#include "io/obj/mtl.h"
#include "io/obj/obj_write.h"

/* ---- which ones ---- */

static void use_texture(const facet_scene *scene, uint32_t texture, bool *is_used)
{
    if (texture != SCENE_NONE && scene->textures[texture].image != SCENE_NONE)
        is_used[scene->textures[texture].image] = true;
}

/* Marks the images of maps, and of glTF materials that are written as comments. */
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

/* Whether a name is portable and has the extension of its format. */
static bool is_plain(const char *name, const image_kind *kind)
{
    const char *extension = path_extension(name);
    bool is_right = strcasecmp(extension, kind->file_extension) == 0 ||
                    (strcmp(kind->file_extension, "jpg") == 0 && strcasecmp(extension, "jpeg") == 0);
    return is_right && name[0] != '.' && name[0] != '-' && strlen(name) < 200 &&
           name[strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-")] == 0;
}

typedef enum presence { NOT_THERE, SAME, OTHER, NO_MEMORY } presence;

/* Whether the file at path holds the image. Only a regular file of the same size is opened: a pipe could
 * block, a device might never end. */
static presence compare_file(const char *path, const scene_image *source, const facet_allocator *allocator)
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

/* The same, for a file beside path. */
static presence compare_beside(const char *path, const char *name, const scene_image *source,
                               const facet_allocator *allocator)
{
    char *folder = path_folder(allocator, path);
    char *beside = folder ? path_join(allocator, folder, name) : NULL;
    presence found = beside ? compare_file(beside, source, allocator) : NO_MEMORY;
    mem_free(beside);
    mem_free(folder);
    return found;
}

/* The state of naming. */
typedef struct image_namer {
    const facet_scene *scene;
    const char *path, *stem;
    const facet_allocator *allocator;
    name_table taken;
    uint32_t next; /* suffixes from that of the images on and below it are taken */
} image_namer;

/* Writes the name of an image to *at, which has room for it. False: no memory. */
static bool name_image(image_namer *namer, uint32_t index, obj_images *out, char *at)
{
    const scene_image *source = &namer->scene->images[index];
    const image_kind *kind = image_kind_of_mime_type(source->mime_type);
    const char *own = path_base_name(source->uri ? source->uri : source->name);
    out->names[index] = at;
    if (is_plain(own, kind) && !name_table_has(&namer->taken, own)) {
        presence found = compare_beside(namer->path, own, source, namer->allocator);
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

/* The state of the writer. */
typedef struct obj_writer {
    const facet_scene *scene;
    const facet_scene_save_desc *desc;
    const char *path, *generator;
    char *stem; /* of the OBJ file's name, without extension */
    scene_pose pose;
    obj_piece *pieces;       /* one per instance of the pose; instances without a material come first */
    text *headings;          /* the same: "o ..", "usemtl .." */
    const char **names;      /* of materials */
    name_table object_names; /* those written */
    arena *strings;
    obj_images images;
} obj_writer;

/* ---- names ---- */

/* A unique object name on one line; NULL: no memory. */
static const char *object_name(obj_writer *w, const char *wanted, size_t number)
{
    size_t length = strlen(wanted);
    char *name = arena_alloc(w->strings, length + sizeof "object" + NAME_NUMBER_ROOM, 1);
    if (!name)
        return NULL;
    strcpy(name, length ? wanted : "object");
    for (char *c = name; *c; c++)
        if ((unsigned char)*c < 0x20 || *c == 0x7f || (*c == '\\' && !c[1]))
            *c = '_';
    name_table_add_numbered(&w->object_names, name, number + 1);
    return name;
}

/* ---- pieces ---- */

/* The set of texture coordinates of a material's maps. OBJ has one set: the first map decides. */
static uint32_t find_texcoord_set(const obj_writer *w, const scene_instance *instance)
{
    const scene_primitive *p = instance->primitive;
    uint32_t set = SCENE_NONE;
    if (instance->material != SCENE_NONE) {
        const legacy_material *m = &w->scene->legacy->materials[instance->material];
        for (int i = 0; i < LEGACY_MAP_COUNT; i++) {
            int slot = i == 0 ? LEGACY_DIFFUSE_MAP : i == LEGACY_DIFFUSE_MAP ? 0 : i;
            const scene_texture_ref *ref = &m->maps[slot].ref;
            if (ref->texture == SCENE_NONE || ref->texcoord >= p->texcoord_count)
                continue;
            if (set != SCENE_NONE && set != ref->texcoord)
                log_warning(
                    &w->desc->log,
                    "material \"%s\": its maps use several sets of texture coordinates; OBJ has one: set %u",
                    w->names[instance->material], set);
            else
                set = ref->texcoord;
        }
    }
    return set != SCENE_NONE ? set : p->texcoord_count > 0 ? 0 : SCENE_NONE;
}

/* Instances without a material come first, since "usemtl" cannot be undone. */
static void order_pieces(obj_writer *w)
{
    size_t count = 0;
    for (int has_material = 0; has_material < 2; has_material++)
        for (uint32_t i = 0; i < w->pose.instance_count; i++)
            if ((w->pose.instances[i].material != SCENE_NONE) == has_material) {
                w->pieces[count].instance = &w->pose.instances[i];
                w->pieces[count++].texcoord_set = find_texcoord_set(w, &w->pose.instances[i]);
            }
}

/* The node of an instance begins an object, and so does each of its copies. A first one without a name has no
 * heading, as in files without "o". */
static bool write_heading(obj_writer *w, size_t index)
{
    const scene_instance *now = w->pieces[index].instance;
    const scene_instance *before = index ? w->pieces[index - 1].instance : NULL;
    text *out = &w->headings[index];
    out->allocator = w->desc->allocator;
    if (!before || before->node != now->node || now->is_copy || before->is_copy) {
        const char *node = w->scene->nodes[now->node].name;
        const char *wanted = node[0] ? node : w->scene->meshes[now->mesh].name;
        if (wanted[0] || before) {
            const char *name = object_name(w, wanted, index);
            if (!name)
                return false;
            text_addf(out, "o %s\n", name);
        }
    }
    if (now->material != SCENE_NONE && (!before || before->material != now->material))
        text_addf(out, "usemtl %s\n", w->names[now->material]);
    return !out->has_failed;
}

static bool prepare(obj_writer *w)
{
    const facet_allocator *allocator = &w->desc->allocator;
    size_t count = w->pose.instance_count;
    w->pieces = mem_zalloc(allocator, count, sizeof *w->pieces);
    w->headings = mem_zalloc(allocator, count, sizeof *w->headings);
    w->names = mtl_names_create(w->scene, allocator);
    w->strings = arena_create(allocator);
    if (!w->pieces || !w->headings || !w->names || !w->strings ||
        !name_table_create(&w->object_names, count, false, allocator) ||
        !obj_images_create(w->scene, w->path, w->stem, w->desc, &w->images))
        return false;
    order_pieces(w);
    for (size_t i = 0; i < count; i++)
        if (!write_heading(w, i))
            return false;
    return obj_pieces_fill(w->pieces, count, w->scene, w->desc);
}

static void destroy(obj_writer *w)
{
    obj_pieces_destroy(w->pieces, w->pose.instance_count);
    for (size_t i = 0; w->headings && i < w->pose.instance_count; i++)
        text_destroy(&w->headings[i]);
    obj_images_destroy(&w->images);
    arena_destroy(w->strings);
    mem_free(w->headings);
    mem_free(w->names);
    name_table_destroy(&w->object_names);
    mem_free(w->stem);
    scene_pose_destroy(&w->pose);
}

/* ---- files ---- */

static facet_result add_images(const obj_writer *w, file_set *set, facet_error *error)
{
    facet_result result = FACET_OK;
    for (uint32_t i = 0; i < w->scene->image_count && result == FACET_OK; i++)
        if (w->images.names[i] && !w->images.is_there[i])
            result = file_set_add(set, w->images.names[i], w->scene->images[i].bytes,
                                  w->scene->images[i].size, error);
    return result;
}

static facet_result add_mtl(const obj_writer *w, const char *name, file_set *set, facet_error *error)
{
    text mtl = {.allocator = w->desc->allocator};
    mtl_write(w->scene, w->generator, w->images.names, w->desc, &mtl);
    facet_result result = mtl.has_failed ? fail_memory(error, name, mtl.length)
                                         : file_set_add(set, name, mtl.data, mtl.length, error);
    text_destroy(&mtl);
    return result;
}

/* The text of the OBJ file, a block of mem_alloc(); NULL: no memory. */
static char *print_obj(const obj_writer *w, const char *mtl_name, size_t *size)
{
    text begin = {.allocator = w->desc->allocator};
    text_addf(&begin, "# OBJ file written by %s\nmtllib %s\n", w->generator, mtl_name);
    char *obj = begin.has_failed ? NULL
                                 : obj_pieces_print(w->pieces, w->headings, w->pose.instance_count, &begin,
                                                    w->scene->origin, w->desc, size);
    text_destroy(&begin);
    return obj;
}

/* The OBJ file is printed before any file is created, as it takes long, and is committed last, so that its
 * presence implies that of all files that it names. */
static facet_result save(const obj_writer *w, facet_error *error)
{
    char *mtl_name = mem_alloc(&w->desc->allocator, strlen(w->stem) + sizeof ".mtl", 1);
    if (!mtl_name)
        return fail_memory(error, w->path, strlen(w->stem));
    strcpy(mtl_name, w->stem);
    strcat(mtl_name, ".mtl");
    size_t size = 0;
    char *obj = print_obj(w, mtl_name, &size);
    file_set set = file_set_begin(w->scene, w->path, w->desc);
    facet_result result = obj ? add_images(w, &set, error) : fail_memory(error, w->path, size);
    if (result == FACET_OK)
        result = add_mtl(w, mtl_name, &set, error);
    if (result == FACET_OK)
        result = file_set_add(&set, NULL, obj, size, error);
    if (result == FACET_OK)
        result = file_set_commit(&set, error);
    file_set_destroy(&set);
    mem_free(obj);
    mem_free(mtl_name);
    return result;
}

/* The file's name without its extension, as a statement can refer to it: on one line, without leading
 * blanks, which readers skip, and without quotes. */
static char *make_stem(const char *path, const facet_allocator *allocator)
{
    const char *base = path_base_name(path);
    const char *extension = path_extension(path);
    size_t length = strlen(base) - (extension[0] ? strlen(extension) + 1 : 0);
    char *stem = mem_alloc(allocator, length + 1, 1);
    if (!stem)
        return NULL;
    size_t blanks = strspn(base, " ");
    for (size_t i = 0; i < length; i++) {
        bool is_plain = (unsigned char)base[i] >= 0x20 && base[i] != 0x7f && base[i] != '"' && i >= blanks;
        stem[i] = is_plain ? base[i] : '_';
    }
    stem[length] = 0;
    return stem;
}

facet_result obj_save(const facet_scene *scene, const char *path, const char *generator,
                      const facet_scene_save_desc *desc, facet_error *error)
{
    const facet_scene_save_desc defaults = {0};
    obj_writer w = {.scene = scene, .desc = desc ? desc : &defaults, .path = path, .generator = generator};
    if (!scene->legacy)
        return fail(error, FACET_ERROR_ARGUMENT, "%s: the scene has no materials of OpenGL 1", path);
    facet_result result =
        scene_pose_create(scene, NULL, &w.desc->allocator, w.desc->thread_count, &w.pose, error);
    if (result != FACET_OK)
        return result;
    w.stem = make_stem(path, &w.desc->allocator);
    result = w.stem && prepare(&w) ? save(&w, error)
                                   : fail_memory(error, path, w.pose.instance_count * sizeof *w.pieces);
    destroy(&w);
    return result;
}
