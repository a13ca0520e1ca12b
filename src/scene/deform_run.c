/* deform_run.c - moves the vertices of a deform_set: two loops over parts of all its primitives, one by vertices, then
 * one by indices for what needs whole triangles. */
#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "base/result.h"
#include "scene/deform.h"
#include "scene/unit.h"

enum {
    GRAIN = 1 << 12,            /* vertices that one thread takes at once */
    INDEX_GRAIN = 3 * (1 << 12) /* indices: whole triangles and lines */
};

/* A range of vertices or of indices of one item. */
typedef struct part {
    deformed *item;
    size_t begin, end;
    box bounds;
    bool is_endless;
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
        p->is_endless = !skin_vertices(item->skin, primitive, &in, p->begin, p->end, out);
        return;
    }
    p->is_endless = out->positions && !is_near(out->positions, p->begin, p->end);
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

/* The normal of a triangle whose corners nobody shares; one without area keeps what it has. */
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

/* All items in parts, by vertices or by indices; returns how many. */
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

facet_result deform_run(deform_set *set, const facet_allocator *allocator, uint32_t thread_count,
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
        parts[i].item->is_endless |= parts[i].is_endless;
    count = divide(set, true, parts);
    parallel_for(thread_count, count, 1, finish_body, parts);
    for (size_t i = 0; i < set->count; i++)
        set->items[i].bounds = box_empty();
    for (size_t i = 0; i < count; i++)
        box_join(&parts[i].item->bounds, &parts[i].bounds);
    mem_free(parts);
    return FACET_OK;
}
