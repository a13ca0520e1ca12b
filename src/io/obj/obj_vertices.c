/* obj_vertices.c - merges corners of a primitive that share position, texture coordinate and normal.
 *
 * Large primitives are processed in blocks of positions, so that the table of a block stays in a core's
 * cache; vertices are in the order of the blocks, within each in order of first use. Flat triangles share
 * no vertices. */
#include <string.h>

#include "base/parallel.h"
#include "io/obj/obj_reader.h"
#include "io/obj/obj_table.h"
#include "scene/box.h"
#include "scene/unit.h"

enum {
    LARGE = 1 << 17, /* corners of a primitive that is processed in parts */
    PART_CORNERS =
        3 << 14 /* corners per part, if they are not sorted; parts with so few corners share a task */
};

/* A set of corners among which vertices are shared. */
typedef struct part {
    size_t begin, end; /* of order */
    uint32_t primitive;
    uint32_t vertex, vertex_count; /* index of the first vertex in the primitive */
    bool is_sorted;                /* order holds the corners; otherwise they are begin .. end */
    bool has_texcoords, has_colors, is_flat;
    size_t missing_texcoords;
    box bounds;
} part;

typedef struct sharing {
    obj_reader *r;
    part *parts;
    size_t part_count, part_capacity;
    size_t *tasks; /* the first part of each task, and the end */
    size_t task_count;
    uint32_t *order; /* corners by part; then, per part, one corner per vertex */
} sharing;

/* ---- parts ---- */

static bool add_part(sharing *s, part p)
{
    if (!mem_reserve(s->r->allocator, (void **)&s->parts, &s->part_capacity, s->part_count + 1,
                     sizeof *s->parts))
        return obj_fail_memory(s->r, "vertices", (s->part_count + 1) * sizeof *s->parts);
    s->parts[s->part_count++] = p;
    return true;
}

/* Blocks of a large primitive: its corners sorted by position. */
static bool add_sorted_parts(sharing *s, uint32_t number)
{
    obj_reader *r = s->r;
    obj_primitive *primitive = &r->primitives[number];
    obj_partition p = {
        .v = r->v, .begin = primitive->begin, .end = primitive->begin + primitive->count, .order = s->order};
    obj_partition_plan(&p, primitive->v_minimum, primitive->v_maximum);
    primitive->shift = p.shift;
    primitive->part = s->part_count;
    p.block_begins = mem_alloc(r->allocator, (size_t)p.block_count + 1, sizeof *p.block_begins);
    if (p.block_begins)
        p.block_begins[0] = p.begin;
    bool is_ok = (p.block_begins && obj_partition_run(&p, r->thread_count, r->allocator)) ||
                 obj_fail_memory(r, "vertices", p.block_count * sizeof *p.block_begins);
    for (uint32_t b = 0; is_ok && b < p.block_count; b++)
        is_ok = add_part(s, (part){.begin = p.block_begins[b],
                                   .end = p.block_begins[b + 1],
                                   .primitive = number,
                                   .is_sorted = true});
    mem_free(p.block_begins);
    return is_ok;
}

/* Flat triangles share nothing, so that nothing is sorted. */
static bool add_parts(sharing *s, uint32_t number)
{
    const obj_primitive *p = &s->r->primitives[number];
    bool is_flat = p->mode == SCENE_TRIANGLES && !s->r->n;
    if (p->count > LARGE && !is_flat)
        return add_sorted_parts(s, number);
    size_t end = p->begin + p->count;
    for (size_t begin = p->begin; begin < end;) {
        size_t next = p->count > LARGE && end - begin > PART_CORNERS ? begin + PART_CORNERS : end;
        if (!add_part(s, (part){.begin = begin, .end = next, .primitive = number}))
            return false;
        begin = next;
    }
    return true;
}

/* Small parts share a task, so that millions of tiny ones do not cost a table each. */
static bool make_tasks(sharing *s)
{
    s->tasks = mem_alloc(s->r->allocator, s->part_count + 1, sizeof *s->tasks);
    if (!s->tasks)
        return obj_fail_memory(s->r, "vertices", (s->part_count + 1) * sizeof *s->tasks);
    size_t corners = 0;
    s->tasks[0] = 0;
    for (size_t i = 0; i < s->part_count; i++) {
        corners += s->parts[i].end - s->parts[i].begin;
        if (corners >= PART_CORNERS || i + 1 == s->part_count) {
            s->tasks[++s->task_count] = i + 1;
            corners = 0;
        }
    }
    return true;
}

/* ---- sharing ---- */

/* Assigns vertices to the corners of a part, and sets order to one corner per vertex. */
static bool share_part(const sharing *s, obj_table *t, part *p)
{
    const obj_reader *r = s->r;
    const bool is_triangles = r->primitives[p->primitive].mode == SCENE_TRIANGLES;
    const uint32_t *n = is_triangles ? r->n : NULL;
    uint32_t count = 0;
    size_t without = 0;
    bool has_shared = false;
    if (!obj_table_reset(t, p->end - p->begin))
        return false;
    for (size_t i = p->begin; i < p->end; i++) {
        uint32_t c = p->is_sorted ? s->order[i] : (uint32_t)i;
        const obj_key k = {r->v[c], r->t ? r->t[c] : OBJ_ABSENT, n ? n[c] : OBJ_ABSENT, count};
        without += k.t == OBJ_ABSENT;
        uint32_t vertex = count;
        if (!is_triangles || k.n != OBJ_ABSENT) {
            vertex = obj_table_find(t, k);
            has_shared = true;
            if (vertex == UINT32_MAX)
                return false;
        }
        if (vertex == count) { /* already processed by the loop */
            s->order[p->begin + count++] = c;
            p->has_colors |= r->colors && r->colors[4 * (size_t)k.v] >= 0.0f;
        }
        r->indices[c] = vertex;
    }
    p->vertex_count = count;
    p->is_flat = is_triangles && !has_shared;
    p->missing_texcoords = without;
    p->has_texcoords = without < p->end - p->begin;
    return true;
}

static void share_tasks(void *context, size_t begin, size_t end)
{
    const sharing *s = context;
    obj_table t = {.allocator = s->r->allocator};
    for (size_t i = s->tasks[begin]; i < s->tasks[end] && !atomic_load(&s->r->has_failed); i++)
        if (!share_part(s, &t, &s->parts[i]))
            atomic_store(&s->r->has_failed, true);
    obj_table_release(&t);
}

/* Concatenates the vertices of the parts, and combines their properties. */
static void sum_up(sharing *s)
{
    obj_reader *r = s->r;
    for (uint32_t i = 0; i < r->primitive_count; i++)
        r->primitives[i].has_flat_normals = r->primitives[i].mode == SCENE_TRIANGLES;
    for (size_t i = 0; i < s->part_count; i++) {
        part *p = &s->parts[i];
        obj_primitive *primitive = &r->primitives[p->primitive];
        p->vertex = primitive->vertex_count;
        primitive->vertex_count += p->vertex_count;
        if (p->begin == p->end)
            continue;
        primitive->has_texcoords |= p->has_texcoords;
        primitive->has_colors |= p->has_colors;
        primitive->has_flat_normals &= p->is_flat;
        primitive->missing_texcoords += p->missing_texcoords;
    }
}

/* ---- indices ---- */

typedef struct shifting {
    const sharing *s;
    const obj_primitive *primitive;
} shifting;

static void shift_corners(void *context, size_t begin, size_t end)
{
    const shifting *k = context;
    const obj_primitive *p = k->primitive;
    const obj_reader *r = k->s->r;
    for (size_t c = p->begin + begin; c < p->begin + end; c++)
        r->indices[c] += k->s->parts[p->part + ((r->v[c] - p->v_minimum) >> p->shift)].vertex;
}

/* From vertices of a part to vertices of the primitive, for sorted corners; fill_part() does the others. */
static void shift_sorted(const sharing *s)
{
    const obj_reader *r = s->r;
    for (size_t i = 0; i < s->part_count; i++)
        if (s->parts[i].is_sorted && (i == 0 || s->parts[i - 1].primitive != s->parts[i].primitive)) {
            shifting k = {.s = s, .primitive = &r->primitives[s->parts[i].primitive]};
            parallel_for(r->thread_count, k.primitive->count, PART_CORNERS, shift_corners, &k);
        }
}

/* ---- arrays ---- */

/* The normal of a corner's triangle; +Y if it has no area and is invisible. */
static void flat_normal(const obj_reader *r, uint32_t corner, float out[3])
{
    const uint32_t *v = r->v + (corner - corner % 3);
    const float *p = r->positions + 3 * (size_t)v[0];
    const float *q = r->positions + 3 * (size_t)v[1];
    const float *s = r->positions + 3 * (size_t)v[2];
    double a[3];
    double b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = (double)q[k] - (double)p[k];
        b[k] = (double)s[k] - (double)p[k];
    }
    const double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    out[0] = out[2] = 0.0f;
    out[1] = 1.0f;
    unit_from_double(n, out);
}

static void fill_normal(const obj_reader *r, uint32_t corner, float out[3])
{
    static const float up[3] = {0.0f, 1.0f, 0.0f};
    uint32_t n = r->n ? r->n[corner] : OBJ_ABSENT;
    if (n == OBJ_ABSENT)
        flat_normal(r, corner, out);
    else if (n < r->normal_count)
        unit_or(r->normals + 3 * (size_t)n, up, out);
    else
        memcpy(out, r->more_normals + 3 * (n - r->normal_count), 3 * sizeof *out);
}

static void fill_texcoord(const obj_reader *r, uint32_t corner, float out[2])
{
    uint32_t t = r->t[corner];
    out[0] = t == OBJ_ABSENT ? 0.0f : r->texcoords[2 * (size_t)t];
    out[1] = t == OBJ_ABSENT ? 0.0f : r->texcoords[2 * (size_t)t + 1];
    if (t != OBJ_ABSENT && !r->desc->has_flipped_texcoords)
        out[1] = 1.0f - out[1];
}

static void fill_color(const float *color, float out[4])
{
    for (int k = 0; k < 4; k++)
        out[k] = color[0] < 0.0f ? 1.0f : color[k];
}

static void fill_part(const sharing *s, part *p)
{
    const obj_reader *r = s->r;
    const obj_primitive *primitive = &r->primitives[p->primitive];
    const uint32_t *corners = s->order + p->begin;
    p->bounds = box_empty();
    for (size_t c = p->begin; c < p->end && !p->is_sorted && p->vertex > 0; c++)
        r->indices[c] += p->vertex;
    for (size_t i = 0; i < p->vertex_count; i++) {
        size_t vertex = p->vertex + i;
        const float *position = r->positions + 3 * (size_t)r->v[corners[i]];
        memcpy(primitive->positions + 3 * vertex, position, 3 * sizeof *position);
        box_add(&p->bounds, position);
        if (primitive->normals)
            fill_normal(r, corners[i], primitive->normals + 3 * vertex);
        if (primitive->texcoords)
            fill_texcoord(r, corners[i], primitive->texcoords + 2 * vertex);
        if (primitive->colors)
            fill_color(r->colors + 4 * (size_t)r->v[corners[i]], primitive->colors + 4 * vertex);
    }
}

static void fill_tasks(void *context, size_t begin, size_t end)
{
    const sharing *s = context;
    for (size_t i = s->tasks[begin]; i < s->tasks[end]; i++)
        fill_part(s, &s->parts[i]);
}

/* One block per attribute for all primitives, which may be millions of small ones. */
static float *take(obj_reader *r, const char *what, size_t count, size_t width)
{
    if (count == 0)
        return NULL;
    float *block = arena_alloc(r->scene->arena, count, width * sizeof *block);
    if (!block)
        obj_fail_memory(r, what, count * width * sizeof *block);
    return block;
}

static bool take_arrays(obj_reader *r)
{
    size_t counts[4] = {0, 0, 0, 0};
    for (uint32_t i = 0; i < r->primitive_count; i++) {
        const obj_primitive *p = &r->primitives[i];
        counts[0] += p->vertex_count;
        counts[1] += p->mode == SCENE_TRIANGLES ? p->vertex_count : 0;
        counts[2] += p->has_texcoords ? p->vertex_count : 0;
        counts[3] += p->has_colors ? p->vertex_count : 0;
    }
    float *positions = take(r, "positions", counts[0], 3);
    float *normals = take(r, "normals", counts[1], 3);
    float *texcoords = take(r, "texture coordinates", counts[2], 2);
    float *colors = take(r, "vertex colors", counts[3], 4);
    for (uint32_t i = 0; i < r->primitive_count && obj_is_ok(r); i++) {
        obj_primitive *p = &r->primitives[i];
        p->positions = positions;
        p->normals = p->mode == SCENE_TRIANGLES ? normals : NULL;
        p->texcoords = p->has_texcoords ? texcoords : NULL;
        p->colors = p->has_colors ? colors : NULL;
        positions += 3 * (size_t)p->vertex_count;
        if (p->normals)
            normals += 3 * (size_t)p->vertex_count;
        if (p->texcoords)
            texcoords += 2 * (size_t)p->vertex_count;
        if (p->colors)
            colors += 4 * (size_t)p->vertex_count;
    }
    return obj_is_ok(r);
}

static void join_bounds(const sharing *s)
{
    box b = box_empty();
    for (size_t i = 0; i < s->part_count; i++) {
        obj_primitive *p = &s->r->primitives[s->parts[i].primitive];
        if (i == 0 || s->parts[i - 1].primitive != s->parts[i].primitive)
            b = box_empty();
        if (s->parts[i].vertex_count)
            box_join(&b, &s->parts[i].bounds);
        memcpy(p->bounds_min, b.minimum, sizeof p->bounds_min);
        memcpy(p->bounds_max, b.maximum, sizeof p->bounds_max);
    }
}

static bool share(sharing *s)
{
    obj_reader *r = s->r;
    s->order = mem_alloc(r->allocator, r->corner_count, sizeof *s->order);
    if (!s->order)
        return obj_fail_memory(r, "vertices", r->corner_count * sizeof *s->order);
    for (uint32_t i = 0; i < r->primitive_count; i++)
        if (!add_parts(s, i))
            return false;
    if (!make_tasks(s))
        return false;
    parallel_for(r->thread_count, s->task_count, 1, share_tasks, s);
    if (!obj_check_memory(r, "vertices"))
        return false;
    sum_up(s);
    shift_sorted(s);
    return true;
}

void obj_make_vertices(obj_reader *r)
{
    sharing s = {.r = r};
    if (share(&s) && take_arrays(r)) {
        parallel_for(r->thread_count, s.task_count, 1, fill_tasks, &s);
        join_bounds(&s);
    }
    mem_free(s.parts);
    mem_free(s.tasks);
    mem_free(s.order);
}
