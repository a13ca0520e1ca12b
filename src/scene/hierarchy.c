/* hierarchy.c - see hierarchy.h. */
#include "scene/hierarchy.h"

static mat4 local_matrix(const scene_node *node)
{
    if (node->has_matrix)
        return mat4_from_double(&node->matrix);
    const float translation[3] = {(float)node->translation[0], (float)node->translation[1],
                                  (float)node->translation[2]};
    return mat4_from_trs(translation, node->rotation, node->scale);
}

static void set_world(hierarchy *h, uint32_t node, const mat4 *parent)
{
    h->worlds[node] = mat4_multiply(*parent, local_matrix(&h->nodes[node]));
    h->has_world[node] = 1;
}

/* A node that is named twice is shown once. */
static void show(hierarchy *h, uint32_t node, const mat4 *parent)
{
    if (h->has_world[node] || h->nodes[node].is_hidden)
        return;
    set_world(h, node, parent);
    h->shown[h->count++] = node;
}

/* Breadth first: what was shown is the queue. */
static void show_scene(hierarchy *h, const facet_scene *scene, uint32_t index)
{
    const mat4 identity = mat4_identity();
    if (scene->scene_count == 0) {
        for (uint32_t i = 0; i < scene->node_count; i++)
            if (h->nodes[i].parent == SCENE_NONE)
                show(h, i, &identity);
    } else {
        const scene_root *root = &scene->scenes[index];
        for (uint32_t i = 0; i < root->node_count; i++)
            show(h, root->nodes[i], &identity);
    }
    for (uint32_t i = 0; i < h->count; i++) {
        uint32_t parent = h->shown[i];
        for (uint32_t k = 0; k < h->nodes[parent].child_count; k++)
            show(h, h->nodes[parent].children[k], &h->worlds[parent]);
    }
}

bool hierarchy_create(const facet_scene *scene, const scene_state *state, uint32_t index,
                      const facet_allocator *allocator, hierarchy *out)
{
    *out = (hierarchy){.nodes = state->nodes,
                       .shown = mem_alloc(allocator, scene->node_count, sizeof *out->shown),
                       .worlds = mem_alloc(allocator, scene->node_count, sizeof *out->worlds),
                       .has_world = mem_zalloc(allocator, scene->node_count, sizeof *out->has_world)};
    if (!out->shown || !out->worlds || !out->has_world) {
        hierarchy_destroy(out);
        return false;
    }
    show_scene(out, scene, index);
    return true;
}

void hierarchy_destroy(hierarchy *h)
{
    mem_free(h->shown);
    mem_free(h->worlds);
    mem_free(h->has_world);
    *h = (hierarchy){0};
}

const mat4 *hierarchy_world(hierarchy *h, uint32_t node)
{
    /* The way up to a node whose world is known; none of it is shown, so there is room behind those that are. */
    uint32_t *path = h->shown + h->count;
    size_t length = 0;
    for (uint32_t up = node; up != SCENE_NONE && !h->has_world[up]; up = h->nodes[up].parent)
        path[length++] = up;
    const mat4 identity = mat4_identity();
    for (; length > 0; length--) {
        uint32_t parent = h->nodes[path[length - 1]].parent;
        set_world(h, path[length - 1], parent == SCENE_NONE ? &identity : &h->worlds[parent]);
    }
    return &h->worlds[node];
}
