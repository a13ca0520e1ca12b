/* ogl1_objects.c - which objects a material can be given by their names; see ogl1_writer.h. */
#include <stdlib.h>
#include <string.h>

#include "io/ogl1/ogl1_writer.h"

/* The one material of a node's mesh; SCENE_NONE: several, or none, or what is below the node would get it too. */
static uint32_t material_of(const facet_scene *scene, const scene_node *node)
{
    const scene_mesh *mesh = &scene->meshes[node->mesh];
    uint32_t material = mesh->primitive_count ? mesh->primitives[0].material : SCENE_NONE;
    for (uint32_t i = 1; i < mesh->primitive_count; i++)
        if (mesh->primitives[i].material != material)
            return SCENE_NONE;
    return node->child_count ? SCENE_NONE : material;
}

static int by_name(const void *a, const void *b)
{
    const ogl1_object *x = a;
    const ogl1_object *y = b;
    int order = strcmp(x->name, y->name);
    return order ? order : (x->node > y->node) - (x->node < y->node);
}

static int by_material(const void *a, const void *b)
{
    const ogl1_object *x = a;
    const ogl1_object *y = b;
    if (x->material != y->material)
        return x->material < y->material ? -1 : 1;
    return (x->node > y->node) - (x->node < y->node);
}

/* Of objects sorted by name: one of each name, and none where they differ. */
static size_t keep_clear(ogl1_object *objects, size_t count)
{
    size_t kept = 0;
    for (size_t i = 0; i < count;) {
        size_t end = i + 1;
        bool is_clear = objects[i].material != SCENE_NONE;
        for (; end < count && strcmp(objects[i].name, objects[end].name) == 0; end++)
            is_clear &= objects[end].material == objects[i].material;
        if (is_clear)
            objects[kept++] = objects[i];
        i = end;
    }
    return kept;
}

bool ogl1_objects_create(const facet_scene *scene, const facet_allocator *allocator, ogl1_object **out,
                         size_t *count)
{
    ogl1_object *objects = mem_alloc(allocator, scene->node_count, sizeof *objects);
    size_t n = 0;
    if (!objects)
        return false;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const scene_node *node = &scene->nodes[i];
        if (node->mesh == SCENE_NONE)
            continue;
        const char *name = node->name[0] ? node->name : scene->meshes[node->mesh].name;
        if (name[0])
            objects[n++] = (ogl1_object){.name = name, .material = material_of(scene, node), .node = i};
    }
    qsort(objects, n, sizeof *objects, by_name);
    n = keep_clear(objects, n);
    qsort(objects, n, sizeof *objects, by_material);
    *out = objects;
    *count = n;
    return true;
}
