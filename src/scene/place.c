/* place.c - a model is put somewhere else: a node above the roots of its default scene. */
#include <math.h>
#include <string.h>

#include "base/result.h"
#include "scene/scene.h"

static bool is_affine(const float m[16])
{
    for (int i = 0; i < 16; i++)
        if (!isfinite(m[i]))
            return false;
    return m[3] == 0.0f && m[7] == 0.0f && m[11] == 0.0f && m[15] == 1.0f;
}

/* A file without scenes shows all that has no parent. False: no memory. */
static bool find_roots(facet_scene *s, scene_root *out)
{
    if (s->scene_count) {
        *out = s->scenes[s->default_scene == SCENE_NONE ? 0 : s->default_scene];
        return true;
    }
    uint32_t *nodes = arena_alloc(s->arena, (size_t)s->node_count + 1, sizeof *nodes);
    if (!nodes)
        return false;
    *out = (scene_root){.name = "", .nodes = nodes, .image_light = SCENE_NONE};
    for (uint32_t i = 0; i < s->node_count; i++)
        if (s->nodes[i].parent == SCENE_NONE)
            nodes[out->node_count++] = i;
    return true;
}

static facet_result add_root(facet_scene *s, facet_error *error)
{
    scene_root roots;
    bool fits = find_roots(s, &roots);
    scene_node *nodes = arena_alloc(s->arena, (size_t)s->node_count + 1, sizeof *nodes);
    scene_root *scenes = arena_alloc(s->arena, (size_t)s->scene_count + 1, sizeof *scenes);
    uint32_t *list = arena_alloc(s->arena, 1, sizeof *list);
    if (!fits || !nodes || !scenes || !list)
        return fail_memory(error, "a place for a model", ((size_t)s->node_count + 1) * sizeof *nodes);
    uint32_t own = s->node_count, index = s->default_scene == SCENE_NONE ? 0 : s->default_scene;
    if (own)
        memcpy(nodes, s->nodes, own * sizeof *nodes);
    if (s->scene_count)
        memcpy(scenes, s->scenes, s->scene_count * sizeof *scenes);
    for (uint32_t i = 0; i < roots.node_count; i++)
        nodes[roots.nodes[i]].parent = own;
    nodes[own] = (scene_node){.name = "place",
                              .parent = SCENE_NONE,
                              .child_count = roots.node_count,
                              .children = roots.nodes,
                              .has_matrix = true,
                              .rotation = {0, 0, 0, 1},
                              .scale = {1, 1, 1},
                              .mesh = SCENE_NONE,
                              .camera = SCENE_NONE,
                              .light = SCENE_NONE,
                              .skin = SCENE_NONE};
    *list = own;
    scenes[index] = roots;
    scenes[index].nodes = list;
    scenes[index].node_count = 1;
    s->nodes = nodes;
    s->node_count++;
    s->scenes = scenes;
    s->scene_count += s->scene_count == 0;
    s->is_placed = true;
    memcpy(s->placed_origin, s->origin, sizeof s->origin);
    memset(s->origin, 0, sizeof s->origin);
    return FACET_OK;
}

facet_result scene_place(facet_scene *scene, const float matrix[16], facet_error *error)
{
    if (!is_affine(matrix))
        return fail(error, FACET_ERROR_ARGUMENT, "%s: a matrix whose last row is 0 0 0 1 was expected",
                    scene->source);
    facet_result result = scene->is_placed ? FACET_OK : add_root(scene, error);
    if (result != FACET_OK)
        return result;
    dmat4 place;
    for (int i = 0; i < 16; i++)
        place.m[i] = (double)matrix[i];
    const double back[3] = {-scene->placed_origin[0], -scene->placed_origin[1], -scene->placed_origin[2]};
    dmat4 to_world = dmat4_translation(back);
    scene->nodes[scene->node_count - 1].matrix = dmat4_multiply(&place, &to_world);
    return FACET_OK;
}
