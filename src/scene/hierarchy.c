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

static dmat4 far_local_matrix(const scene_node *node)
{
    return node->has_matrix ? node->matrix : dmat4_from_trs(node->translation, node->rotation, node->scale);
}

/* parent: its world is known; SCENE_NONE: none. */
static void set_world(hierarchy *h, uint32_t node, uint32_t parent)
{
    h->has_world[node] = 1;
    if (h->far_worlds) {
        dmat4 local = far_local_matrix(&h->nodes[node]);
        h->far_worlds[node] = parent == SCENE_NONE ? local : dmat4_multiply(&h->far_worlds[parent], &local);
    } else {
        mat4 root = mat4_identity();
        h->worlds[node] =
            mat4_multiply(parent == SCENE_NONE ? root : h->worlds[parent], local_matrix(&h->nodes[node]));
    }
}

/* A node that is listed twice is shown once. */
static void show(hierarchy *h, uint32_t node, uint32_t parent)
{
    if (h->has_world[node] || h->nodes[node].is_hidden)
        return;
    set_world(h, node, parent);
    h->shown[h->count++] = node;
}

/* Breadth first; the list of shown nodes is the queue. */
static void show_scene(hierarchy *h, const facet_scene *scene, uint32_t index)
{
    if (scene->scene_count == 0) {
        for (uint32_t i = 0; i < scene->node_count; i++)
            if (h->nodes[i].parent == SCENE_NONE)
                show(h, i, SCENE_NONE);
    } else {
        const scene_root *root = &scene->scenes[index];
        for (uint32_t i = 0; i < root->node_count; i++)
            show(h, root->nodes[i], SCENE_NONE);
    }
    for (uint32_t i = 0; i < h->count; i++) {
        uint32_t parent = h->shown[i];
        for (uint32_t k = 0; k < h->nodes[parent].child_count; k++)
            show(h, h->nodes[parent].children[k], parent);
    }
}

bool hierarchy_create(const facet_scene *scene, const scene_state *state, uint32_t index,
                      const facet_allocator *allocator, hierarchy *out)
{
    *out = (hierarchy){.nodes = state->nodes,
                       .origin = scene->origin,
                       .shown = mem_alloc(allocator, scene->node_count, sizeof *out->shown),
                       .has_world = mem_zalloc(allocator, scene->node_count, sizeof *out->has_world)};
    if (scene->is_far)
        out->far_worlds = mem_alloc(allocator, scene->node_count, sizeof *out->far_worlds);
    else
        out->worlds = mem_alloc(allocator, scene->node_count, sizeof *out->worlds);
    if (!out->shown || !out->has_world || (!out->worlds && !out->far_worlds)) {
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
    mem_free(h->far_worlds);
    mem_free(h->has_world);
    *h = (hierarchy){0};
}

dmat4 hierarchy_shown_world(const hierarchy *h, uint32_t node)
{
    if (!h->far_worlds)
        return dmat4_from_float(&h->worlds[node]);
    dmat4 world = h->far_worlds[node];
    for (int axis = 0; axis < 3; axis++)
        world.m[12 + axis] -= h->origin[axis];
    return world;
}

dmat4 hierarchy_world(hierarchy *h, uint32_t node)
{
    /* The path up to a node whose world is known; none of it is shown, so that there is room behind the
     * shown nodes. */
    uint32_t *path = h->shown + h->count;
    size_t length = 0;
    for (uint32_t up = node; up != SCENE_NONE && !h->has_world[up]; up = h->nodes[up].parent)
        path[length++] = up;
    for (; length > 0; length--)
        set_world(h, path[length - 1], h->nodes[path[length - 1]].parent);
    return hierarchy_shown_world(h, node);
}

copy_place hierarchy_copy(const scene_instancing *instancing, uint32_t i)
{
    static const float nowhere[3] = {0, 0, 0};
    static const float unturned[4] = {0, 0, 0, 1};
    static const float unscaled[3] = {1, 1, 1};
    return (copy_place){instancing->translations ? instancing->translations + 3 * (size_t)i : nowhere,
                        instancing->rotations ? instancing->rotations + 4 * (size_t)i : unturned,
                        instancing->scales ? instancing->scales + 3 * (size_t)i : unscaled};
}

dmat4 copy_place_matrix(const copy_place *place)
{
    const double translation[3] = {(double)place->translation[0], (double)place->translation[1],
                                   (double)place->translation[2]};
    return dmat4_from_trs(translation, place->rotation, place->scale);
}
