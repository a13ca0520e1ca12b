/* obj_scene.c - nodes and meshes: one of each per object, with its primitives. */
#include <string.h>

#include "base/utf8.h"
#include "io/obj/obj_reader.h"

static void *take(obj_reader *r, size_t count, size_t size)
{
    void *block = arena_zalloc(r->scene->arena, count, size);
    if (!block)
        obj_fail_memory(r, "nodes", count * size);
    return block;
}

char *obj_copy_name(obj_reader *r, const char *bytes, size_t size)
{
    const char *end = size ? memchr(bytes, 0, size) : NULL;
    size = end ? (size_t)(end - bytes) : size;
    char *copy = arena_alloc(r->scene->arena, 2 * size + 1, 1);
    if (copy)
        copy[utf8_from_latin1(bytes, size, copy)] = 0;
    else
        obj_fail_memory(r, "names", 2 * size + 1);
    return copy;
}

static scene_primitive make_primitive(const obj_reader *r, const obj_primitive *p, const float **texcoords)
{
    scene_primitive out = {
        .mode = p->mode,
        .vertex_count = p->vertex_count,
        .index_count = (uint32_t)p->count,
        .indices = r->indices + p->begin,
        .positions = p->positions,
        .normals = p->normals,
        .colors = p->colors,
        .material = p->material == SCENE_NONE ? SCENE_NONE : r->material_numbers[p->material],
        .has_flat_normals = p->has_flat_normals,
    };
    memcpy(out.bounds_min, p->bounds_min, sizeof out.bounds_min);
    memcpy(out.bounds_max, p->bounds_max, sizeof out.bounds_max);
    if (p->texcoords) {
        *texcoords = p->texcoords;
        out.texcoord_count = 1;
        out.texcoords = texcoords;
    }
    return out;
}

/* Which mesh an object becomes, in the order of their first primitives; SCENE_NONE: it has none. */
static uint32_t *number_meshes(obj_reader *r)
{
    uint32_t *meshes = mem_alloc(r->allocator, r->objects.count, sizeof *meshes);
    if (!meshes) {
        obj_fail_memory(r, "meshes", r->objects.count * sizeof *meshes);
        return NULL;
    }
    memset(meshes, 0xff, r->objects.count * sizeof *meshes);
    for (uint32_t i = 0; i < r->primitive_count; i++) {
        uint32_t *mesh = &meshes[r->primitives[i].object];
        if (*mesh == SCENE_NONE)
            *mesh = r->scene->mesh_count++;
    }
    return meshes;
}

/* Primitives of each mesh behind one another, in each as they come. */
static void make_meshes(obj_reader *r, const uint32_t *numbers)
{
    facet_scene *scene = r->scene;
    scene->meshes = take(r, scene->mesh_count, sizeof *scene->meshes);
    scene_primitive *primitives = take(r, r->primitive_count, sizeof *primitives);
    const float **texcoords = take(r, r->primitive_count, sizeof *texcoords);
    if (!obj_is_ok(r))
        return;
    for (uint32_t i = 0; i < r->primitive_count; i++)
        scene->meshes[numbers[r->primitives[i].object]].primitive_count++;
    for (uint32_t i = 0; i < scene->mesh_count; i++) {
        scene->meshes[i].primitives = primitives;
        primitives += scene->meshes[i].primitive_count;
        scene->meshes[i].primitive_count = 0;
    }
    for (uint32_t i = 0; i < r->primitive_count; i++) {
        const obj_primitive *p = &r->primitives[i];
        scene_mesh *mesh = &scene->meshes[numbers[p->object]];
        mesh->primitives[mesh->primitive_count++] = make_primitive(r, p, texcoords++);
        if (!mesh->name) {
            size_t size;
            const char *name = obj_names_get(&r->objects, p->object, &size);
            mesh->name = obj_copy_name(r, name, size);
            if (!mesh->name)
                return;
        }
    }
}

static void make_nodes(obj_reader *r)
{
    facet_scene *scene = r->scene;
    scene->nodes = take(r, scene->mesh_count, sizeof *scene->nodes);
    scene->scenes = take(r, 1, sizeof *scene->scenes);
    uint32_t *roots = take(r, scene->mesh_count, sizeof *roots);
    if (!obj_is_ok(r))
        return;
    for (uint32_t i = 0; i < scene->mesh_count; i++) {
        roots[i] = i;
        scene->nodes[i] = (scene_node){.name = scene->meshes[i].name,
                                       .parent = SCENE_NONE,
                                       .translation = {r->origin[0], r->origin[1], r->origin[2]},
                                       .rotation = {0, 0, 0, 1},
                                       .scale = {1, 1, 1},
                                       .mesh = i,
                                       .camera = SCENE_NONE,
                                       .light = SCENE_NONE,
                                       .skin = SCENE_NONE};
    }
    scene->node_count = scene->mesh_count;
    scene->scenes[0] =
        (scene_root){.name = "", .node_count = scene->node_count, .nodes = roots, .image_light = SCENE_NONE};
    scene->scene_count = 1;
    scene->default_scene = 0;
}

void obj_make_scene(obj_reader *r)
{
    uint32_t *numbers = number_meshes(r);
    if (numbers)
        make_meshes(r, numbers);
    if (obj_is_ok(r))
        make_nodes(r);
    mem_free(numbers);
}
