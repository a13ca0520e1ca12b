/* deform.c - vertices moved by morph targets and skins: which primitives are deformed, what they share and
 * the memory for them; and the computation, two loops over parts of all primitives, one by vertices, one
 * by indices for whole triangles. */
#include "scene/deform.h"

#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "base/result.h"
#include "scene/unit.h"

/* ---- the work ---- */

enum {
    GRAIN = 1 << 12,            /* vertices per work item */
    INDEX_GRAIN = 3 * (1 << 12) /* indices per work item: whole triangles and lines */
};

/* A range of vertices or of indices of one item. */
typedef struct part {
    deformed *item;
    size_t begin, end;
    box bounds;
    bool is_unbounded;
} part;

static bool is_near(const float *positions, size_t begin, size_t end)
{
    bool is_ok = true;
    for (size_t i = 3 * begin; i < 3 * end; i++)
        is_ok &= fabsf(positions[i]) <= SCENE_FARTHEST;
    return is_ok;
}

static void unit_directions(float *directions, const float *otherwise, size_t stride, size_t begin,
                            size_t end)
{
    for (size_t i = stride * begin; i < stride * end; i += stride)
        unit_or(directions + i, otherwise + i, directions + i);
}

static void move_part(part *p)
{
    const deformed *item = p->item;
    const scene_primitive *primitive = item->primitive;
    const vertex_arrays *out = &item->arrays;
    vertex_source in = {primitive->positions, primitive->normals, primitive->tangents};
    morph_use use = morph_get_use(primitive, item->weights, item->weight_count);
    if (use.positions || use.normals || use.tangents) {
        morph_vertices(primitive, item->weights, item->weight_count, p->begin, p->end, out);
        in = (vertex_source){out->positions, out->normals, out->tangents};
    }
    if (item->skin) {
        p->is_unbounded = !skin_vertices(item->skin, primitive, &in, p->begin, p->end, out);
        return;
    }
    p->is_unbounded = out->positions && !is_near(out->positions, p->begin, p->end);
    if (out->normals)
        unit_directions(out->normals, primitive->normals, 3, p->begin, p->end);
    if (out->tangents)
        unit_directions(out->tangents, primitive->tangents, 4, p->begin, p->end);
}

static void move_body(void *context, size_t begin, size_t end)
{
    part *parts = context;
    for (size_t i = begin; i < end; i++)
        move_part(&parts[i]);
}

/* The normal of a triangle with unshared corners; one without area keeps its normals. */
static void flatten(const float *positions, const uint32_t corners[3], float *normals)
{
    const float *a = positions + 3 * (size_t)corners[0];
    const float *b = positions + 3 * (size_t)corners[1];
    const float *c = positions + 3 * (size_t)corners[2];
    double u[3];
    double v[3];
    for (int k = 0; k < 3; k++) {
        u[k] = (double)b[k] - (double)a[k];
        v[k] = (double)c[k] - (double)a[k];
    }
    const double cross[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    float normal[3];
    if (!unit_from_double(cross, normal))
        return;
    for (int k = 0; k < 3; k++)
        memcpy(normals + 3 * (size_t)corners[k], normal, sizeof normal);
}

/* After all vertices: boxes, and flat normals. */
static void finish_part(part *p)
{
    const scene_primitive *primitive = p->item->primitive;
    const vertex_arrays *arrays = &p->item->arrays;
    if (primitive->has_flat_normals && primitive->mode == SCENE_TRIANGLES && arrays->positions &&
        arrays->normals)
        for (size_t i = p->begin; i < p->end; i += 3)
            flatten(arrays->positions, primitive->indices + i, arrays->normals);
    const float *positions = arrays->positions ? arrays->positions : primitive->positions;
    p->bounds = box_empty();
    for (size_t i = p->begin; i < p->end; i++)
        box_add(&p->bounds, positions + 3 * (size_t)primitive->indices[i]);
}

static void finish_body(void *context, size_t begin, size_t end)
{
    part *parts = context;
    for (size_t i = begin; i < end; i++)
        finish_part(&parts[i]);
}

static size_t part_count(const deformed *item, bool is_indices)
{
    if (!item->is_moved)
        return 0;
    return is_indices ? (item->primitive->index_count + (size_t)INDEX_GRAIN - 1) / INDEX_GRAIN
                      : (item->primitive->vertex_count + (size_t)GRAIN - 1) / GRAIN;
}

/* Splits all items into parts, by vertices or by indices; returns their number. */
static size_t divide(const deform_set *set, bool is_indices, part *parts)
{
    size_t count = 0;
    for (size_t i = 0; i < set->count; i++) {
        const scene_primitive *p = set->items[i].primitive;
        size_t grain = is_indices ? INDEX_GRAIN : GRAIN;
        size_t all = is_indices ? p->index_count : p->vertex_count;
        for (size_t k = 0; k < part_count(&set->items[i], is_indices); k++)
            parts[count++] = (part){.item = &set->items[i],
                                    .begin = k * grain,
                                    .end = (k + 1) * grain < all ? (k + 1) * grain : all};
    }
    return count;
}

/* The second half of deform_create(): fills the arrays, bounds and is_unbounded. */
static facet_result run(deform_set *set, const facet_allocator *allocator, uint32_t thread_count,
                        facet_error *error)
{
    size_t most = 0;
    for (size_t i = 0; i < set->count; i++)
        most += part_count(&set->items[i], false) + part_count(&set->items[i], true);
    part *parts = mem_alloc(allocator, most, sizeof *parts);
    if (!parts)
        return fail_memory(error, "deformed vertices", most * sizeof *parts);
    size_t count = divide(set, false, parts);
    parallel_for(thread_count, count, 1, move_body, parts);
    for (size_t i = 0; i < count; i++)
        parts[i].item->is_unbounded |= parts[i].is_unbounded;
    count = divide(set, true, parts);
    parallel_for(thread_count, count, 1, finish_body, parts);
    for (size_t i = 0; i < set->count; i++)
        set->items[i].bounds = box_empty();
    for (size_t i = 0; i < count; i++)
        box_join(&parts[i].item->bounds, &parts[i].bounds);
    mem_free(parts);
    return FACET_OK;
}

/* ---- which primitives ---- */

enum { MAX_VERTICES = 1 << 27, MAX_ITEMS = 1 << 22 };

/* ---- what moves ---- */

/* Whether anything in the scene can be deformed, false for most scenes. */
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

/* State shared by the nodes of one mesh: the last deformed one. */
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

/* Lists deformed primitives; false: no memory, or (is_limit) more than allowed. */
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

/* Points the arrays of an item at floats from *next on; next NULL: counts floats only. */
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
        result = run(set, allocator, thread_count, error);
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
