/* deform.c - which primitives move, what they share, and memory for them. */
#include "scene/deform.h"

#include <string.h>

#include "base/result.h"

enum { MAX_VERTICES = 1 << 27, MAX_ITEMS = 1 << 22 };

/* ---- what moves ---- */

/* Whether anything in the scene could: most scenes are done with this question. */
static bool can_move(const facet_scene *scene)
{
    for (uint32_t i = 0; i < scene->mesh_count && scene->skin_count == 0; i++)
        if (scene->meshes[i].weight_count > 0)
            return true;
    return scene->skin_count > 0;
}

static bool moves(const facet_scene *scene, const scene_state *state, uint32_t index)
{
    const scene_node *node = &state->nodes[index];
    if (node->mesh == SCENE_NONE)
        return false;
    if (node->skin != SCENE_NONE)
        return true;
    uint32_t count = scene->meshes[node->mesh].weight_count;
    const float *weights = count ? scene_state_weights(scene, state, index) : NULL;
    for (uint32_t i = 0; i < count; i++)
        if (weights[i] != 0.0f)
            return true;
    return false;
}

/* What the nodes of one mesh have in common with the last one of them that moves. */
typedef struct last_user {
    uint32_t node; /* SCENE_NONE: none yet */
    uint32_t first;
} last_user;

static bool is_same_motion(const facet_scene *scene, const scene_state *state, uint32_t a, uint32_t b)
{
    if (state->nodes[a].skin != state->nodes[b].skin)
        return false;
    uint32_t count = scene->meshes[state->nodes[a].mesh].weight_count;
    const float *x = count ? scene_state_weights(scene, state, a) : NULL;
    const float *y = count ? scene_state_weights(scene, state, b) : NULL;
    return x == y || memcmp(x, y, count * sizeof *x) == 0;
}

/* Appends the primitives of a node's mesh. */
static void add_items(deform_set *set, const facet_scene *scene, const scene_state *state, uint32_t index)
{
    const scene_node *node = &state->nodes[index];
    const scene_mesh *mesh = &scene->meshes[node->mesh];
    const float *weights = mesh->weight_count ? scene_state_weights(scene, state, index) : NULL;
    for (uint32_t k = 0; k < mesh->primitive_count; k++) {
        const scene_primitive *primitive = &mesh->primitives[k];
        deformed *item = &set->items[set->count++];
        *item = (deformed){.primitive = primitive, .weights = weights, .weight_count = mesh->weight_count};
        if (node->skin != SCENE_NONE && primitive->influence_count > 0)
            item->skin = &set->skins[node->skin];
        morph_use use = morph_get_use(primitive, weights, mesh->weight_count);
        item->is_moved =
            primitive->index_count > 0 && (item->skin || use.positions || use.normals || use.tangents);
    }
}

/* Lists what moves; false: no memory, or (is_limit) more than instances may be. */
static bool plan(deform_set *set, const facet_scene *scene, const scene_state *state, const hierarchy *h,
                 const facet_allocator *allocator, bool *is_limit)
{
    size_t most = 0;
    for (uint32_t i = 0; i < h->count; i++)
        if (moves(scene, state, h->shown[i]))
            most += scene->meshes[state->nodes[h->shown[i]].mesh].primitive_count;
    *is_limit = most > MAX_ITEMS;
    if (most == 0 || *is_limit)
        return !*is_limit;
    last_user *last = mem_alloc(allocator, scene->mesh_count, sizeof *last);
    set->items = mem_alloc(allocator, most, sizeof *set->items);
    set->first = mem_alloc(allocator, h->count, sizeof *set->first);
    set->skins = mem_zalloc(allocator, scene->skin_count, sizeof *set->skins);
    set->skin_count = scene->skin_count;
    bool is_ok = last && set->items && set->first && set->skins;
    for (uint32_t i = 0; is_ok && i < scene->mesh_count; i++)
        last[i].node = SCENE_NONE;
    for (uint32_t i = 0; is_ok && i < h->count; i++) {
        uint32_t index = h->shown[i];
        set->first[i] = SCENE_NONE;
        if (!moves(scene, state, index))
            continue;
        last_user *user = &last[state->nodes[index].mesh];
        if (user->node == SCENE_NONE || !is_same_motion(scene, state, user->node, index)) {
            *user = (last_user){.node = index, .first = (uint32_t)set->count};
            add_items(set, scene, state, index);
        }
        set->first[i] = user->first;
    }
    mem_free(last);
    return is_ok;
}

/* ---- memory ---- */

/* Points arrays of an item at floats from *next on; next NULL: only counts them. */
static size_t place(deformed *item, float *next)
{
    const scene_primitive *p = item->primitive;
    size_t count = p->vertex_count;
    morph_use use = morph_get_use(p, item->weights, item->weight_count);
    bool is_skinned = item->skin != NULL;
    size_t sizes[3] = {
        is_skinned || use.positions ? 3 * count : 0,
        p->normals && (is_skinned || use.normals || (use.positions && p->has_flat_normals)) ? 3 * count : 0,
        p->tangents && (is_skinned || use.tangents) ? 4 * count : 0};
    float **arrays[3] = {&item->arrays.positions, &item->arrays.normals, &item->arrays.tangents};
    for (int i = 0; i < 3 && next; i++) {
        *arrays[i] = sizes[i] ? next : NULL;
        next += sizes[i];
    }
    return sizes[0] + sizes[1] + sizes[2];
}

static facet_result allocate(deform_set *set, const facet_scene *scene, const facet_allocator *allocator,
                             facet_error *error)
{
    size_t vertices = 0;
    size_t floats = 0;
    for (size_t i = 0; i < set->count; i++) {
        if (!set->items[i].is_moved)
            continue;
        vertices += set->items[i].primitive->vertex_count;
        if (vertices > MAX_VERTICES)
            return fail(error, FACET_ERROR_LIMIT, "%s: skins and morph targets move more than %d vertices",
                        scene->source, (int)MAX_VERTICES);
        floats += place(&set->items[i], NULL);
    }
    set->block = mem_alloc(allocator, floats, sizeof *set->block);
    if (!set->block)
        return fail_memory(error, "deformed vertices", floats * sizeof *set->block);
    float *next = set->block;
    for (size_t i = 0; i < set->count; i++)
        if (set->items[i].is_moved)
            next += place(&set->items[i], next);
    return FACET_OK;
}

static bool pose_skins(deform_set *set, const facet_scene *scene, hierarchy *h,
                       const facet_allocator *allocator)
{
    for (size_t i = 0; i < set->count; i++) {
        if (!set->items[i].skin || set->items[i].skin->matrices)
            continue;
        size_t skin = (size_t)(set->items[i].skin - set->skins);
        if (!skin_pose_create(&scene->skins[skin], h, allocator, &set->skins[skin]))
            return false;
    }
    return true;
}

facet_result deform_create(const facet_scene *scene, const scene_state *state, hierarchy *h,
                           const facet_allocator *allocator, uint32_t thread_count, deform_set *set,
                           facet_error *error)
{
    *set = (deform_set){0};
    if (!can_move(scene))
        return FACET_OK;
    bool is_limit = false;
    facet_result result = FACET_OK;
    if (!plan(set, scene, state, h, allocator, &is_limit) || !pose_skins(set, scene, h, allocator))
        result = is_limit ? fail(error, FACET_ERROR_LIMIT,
                                 "%s: skins and morph targets move more than %d primitives", scene->source,
                                 (int)MAX_ITEMS)
                          : fail_memory(error, "skins", scene->node_count * sizeof *set->first);
    if (result == FACET_OK && set->count > 0)
        result = allocate(set, scene, allocator, error);
    if (result == FACET_OK && set->count > 0)
        result = deform_run(set, allocator, thread_count, error);
    if (result != FACET_OK)
        deform_destroy(set);
    return result;
}

void deform_destroy(deform_set *set)
{
    for (uint32_t i = 0; set->skins && i < set->skin_count; i++)
        skin_pose_destroy(&set->skins[i]);
    mem_free(set->items);
    mem_free(set->first);
    mem_free(set->block);
    mem_free(set->skins);
    *set = (deform_set){0};
}
