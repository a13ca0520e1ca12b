/* obj_write.c - a scene at rest as an OBJ file with its MTL file and images: they appear together or not at all. */
#include <stdio.h>
#include <string.h>

#include "base/result.h"
#include "io/file_set.h"
#include "io/obj/mtl.h"
#include "io/name_table.h"
#include "io/obj/obj_write.h"

/* What is written, and what it is made of. */
typedef struct obj_writer {
    const facet_scene *scene;
    const facet_scene_save_desc *desc;
    const char *path, *generator;
    char *stem; /* of the OBJ file's name */
    scene_pose pose;
    obj_piece *pieces;       /* one per instance of the pose; those without a material come first */
    text *headings;          /* the same: "o ..", "usemtl .." */
    const char **names;      /* of materials */
    name_table object_names; /* those written */
    arena *strings;
    obj_images images;
} obj_writer;

/* ---- names ---- */

/* A name that no object has yet, of one line; NULL: no memory. */
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

/* The set of texture coordinates that a material's maps use. OBJ has one: that of the first map counts. */
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

/* "usemtl" cannot be taken back: what has no material comes first. */
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

/* The node of an instance begins an object, and so does each of its copies. One without a name that comes first has none,
 * as in files without "o". */
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

/* The OBJ file is printed before any file is begun, as it takes long, and is the last to be in its place: where it is, all
 * that it names is. */
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

/* The file's name without its end, as a statement can name it: on one line, and without blanks at its front, where a
 * reader skips them, or quotes. */
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
