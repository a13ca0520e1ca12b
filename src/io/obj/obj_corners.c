/* obj_corners.c - elements as triangles, lines and points, sorted by primitive; and the partition of
 * corners into blocks of positions, so that the work per position stays in the cache of one core and
 * threads share no data. */
#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "io/obj/obj_reader.h"
#include "io/obj/obj_triangulate.h"

/* ---- blocks of positions ---- */

enum {
    RANGE = 1 << 16,         /* corners per work item */
    BLOCK_CORNERS = 1 << 15, /* approximate corners per block */
    MAX_BLOCKS = 4096
};

typedef struct sorting {
    obj_partition *p;
    uint32_t *counts; /* per work item and block: corners, then their position in the block */
} sorting;

static inline bool is_left_out(const obj_partition *p, size_t corner)
{
    return (p->taken_n && p->taken_n[corner] != OBJ_ABSENT) || (p->groups && p->groups[corner / 3] == 0);
}

static inline uint32_t block_of(const obj_partition *p, size_t corner)
{
    return (p->v[corner] - p->v_minimum) >> p->shift;
}

static void count_ranges(void *context, size_t begin, size_t end)
{
    const sorting *s = context;
    const obj_partition *p = s->p;
    for (size_t range = begin; range < end; range++) {
        uint32_t *counts = s->counts + range * p->block_count;
        size_t first = p->begin + range * RANGE;
        size_t last = p->end - first > RANGE ? first + RANGE : p->end;
        for (uint32_t b = 0; b < p->block_count; b++)
            counts[b] = 0;
        for (size_t i = first; i < last; i++)
            if (!is_left_out(p, i))
                counts[block_of(p, i)]++;
    }
}

static void sort_ranges(void *context, size_t begin, size_t end)
{
    const sorting *s = context;
    const obj_partition *p = s->p;
    for (size_t range = begin; range < end; range++) {
        uint32_t *places = s->counts + range * p->block_count;
        size_t first = p->begin + range * RANGE;
        size_t last = p->end - first > RANGE ? first + RANGE : p->end;
        for (size_t i = first; i < last; i++)
            if (!is_left_out(p, i)) {
                uint32_t b = block_of(p, i);
                p->order[p->block_begins[b] + places[b]++] = (uint32_t)i;
            }
    }
}

void obj_partition_plan(obj_partition *p, uint32_t v_minimum, uint32_t v_maximum)
{
    size_t wanted = (p->end - p->begin) / BLOCK_CORNERS + 1;
    wanted = wanted < MAX_BLOCKS ? wanted : MAX_BLOCKS;
    uint32_t span = v_maximum - v_minimum;
    p->v_minimum = v_minimum;
    p->shift = 0;
    while ((span >> p->shift) + 1 > wanted)
        p->shift++;
    p->block_count = (span >> p->shift) + 1;
}

bool obj_partition_run(obj_partition *p, uint32_t thread_count, const facet_allocator *allocator)
{
    size_t ranges = (p->end - p->begin + RANGE - 1) / RANGE;
    sorting s = {.p = p, .counts = mem_alloc(allocator, ranges * p->block_count, sizeof *s.counts)};
    if (!s.counts)
        return false;
    parallel_for(thread_count, ranges, 1, count_ranges, &s);
    size_t sum = p->block_begins[0];
    for (uint32_t b = 0; b < p->block_count; b++) {
        uint32_t in_block = 0;
        p->block_begins[b] = sum;
        for (size_t range = 0; range < ranges; range++) {
            uint32_t count = s.counts[range * p->block_count + b];
            s.counts[range * p->block_count + b] = in_block;
            in_block += count;
        }
        sum += in_block;
    }
    p->block_begins[p->block_count] = sum;
    parallel_for(thread_count, ranges, 1, sort_ranges, &s);
    mem_free(s.counts);
    return true;
}

/* ---- corners ---- */

/* Source and destination of the corners of one run. */
typedef struct writer {
    const obj_reader *r;
    const uint32_t *v, *t, *n; /* of the chunk; t, n NULL: none */
    size_t out;
    uint32_t minimum, maximum; /* positions */
    obj_polygon polygon;
    uint32_t *triangles; /* of the polygon */
    size_t triangle_capacity;
    size_t rough_count;
} writer;

/* n exists for triangles only, which come first. */
static inline void put(writer *w, size_t corner)
{
    const obj_reader *r = w->r;
    uint32_t v = w->v[corner];
    r->v[w->out] = v;
    w->minimum = v < w->minimum ? v : w->minimum;
    w->maximum = v > w->maximum ? v : w->maximum;
    if (r->t)
        r->t[w->out] = w->t ? w->t[corner] : OBJ_ABSENT;
    if (r->n && w->out < r->triangle_corner_count)
        r->n[w->out] = w->n ? w->n[corner] : OBJ_ABSENT;
    w->out++;
}

static const float *position(const writer *w, size_t corner)
{
    return w->r->positions + 3 * (size_t)w->v[corner];
}

static bool put_polygon(writer *w, size_t corner, uint32_t count)
{
    if (!mem_reserve(&w->polygon.allocator, (void **)&w->triangles, &w->triangle_capacity,
                     3 * ((size_t)count - 2), sizeof *w->triangles) ||
        !obj_polygon_reserve(&w->polygon, count))
        return false;
    for (size_t i = 0; i < count; i++)
        memcpy(w->polygon.points + 3 * i, position(w, corner + i), 3 * sizeof(float));
    obj_triangulate(&w->polygon, count, w->triangles);
    w->rough_count += w->polygon.is_rough;
    for (size_t i = 0; i < 3 * ((size_t)count - 2); i++)
        put(w, corner + w->triangles[i]);
    return true;
}

static bool put_face(writer *w, size_t corner, uint32_t count)
{
    if (count == 4) {
        const uint32_t *order = obj_split_quad(position(w, corner), position(w, corner + 1),
                                               position(w, corner + 2), position(w, corner + 3));
        for (int i = 0; i < 6; i++)
            put(w, corner + order[i]);
        return true;
    }
    if (count > 4)
        return put_polygon(w, corner, count);
    for (size_t i = 0; i < 3; i++)
        put(w, corner + i);
    return true;
}

static bool put_run(writer *w, const obj_chunk *c, const obj_run *run)
{
    scene_mode mode = w->r->primitives[run->primitive].mode;
    size_t corner = run->corner;
    size_t begin = run->out;
    w->out = begin;
    for (uint32_t e = run->element; e < run->element_end; e++) {
        uint32_t count = c->sizes.data[e];
        if (mode == SCENE_TRIANGLES) {
            if (!put_face(w, corner, count))
                return false;
        } else {
            for (size_t i = 0; i < count;
                 i++) { /* inner points of a polyline end one segment and begin the next */
                put(w, corner + i);
                if (mode == SCENE_LINES && i > 0 && i + 1 < count)
                    put(w, corner + i);
            }
        }
        corner += count;
    }
    if (w->r->groups && mode == SCENE_TRIANGLES)
        for (size_t i = begin / 3; i < w->out / 3; i++)
            w->r->groups[i] = run->smoothing;
    return true;
}

static void write_chunks(void *context, size_t begin, size_t end)
{
    obj_reader *r = context;
    for (size_t i = begin; i < end && !atomic_load(&r->has_failed); i++) {
        obj_chunk *c = &r->chunks[i];
        writer w = {
            .r = r, .v = c->v.data, .t = c->t.data, .n = c->n.data, .polygon.allocator = *r->allocator};
        for (size_t k = c->run_begin; k < c->run_end; k++) {
            w.minimum = UINT32_MAX;
            w.maximum = 0;
            if (!put_run(&w, c, &r->runs[k]))
                atomic_store(&r->has_failed, true);
            r->runs[k].v_minimum = w.minimum;
            r->runs[k].v_maximum = w.maximum;
        }
        c->remarks.counts[OBJ_POLYGON_ROUGH] += w.rough_count;
        mem_free(w.triangles);
        obj_polygon_release(&w.polygon);
        obj_chunk_release(c);
    }
}

static uint32_t *take(obj_reader *r, size_t count)
{
    uint32_t *list = mem_alloc(r->allocator, count, sizeof *list);
    if (!list)
        obj_fail_memory(r, "corners", count * sizeof *list);
    return list;
}

void obj_make_corners(obj_reader *r)
{
    bool has_texcoords = false;
    bool has_normals = false;
    bool is_flat = r->desc->obj_normals == FACET_OBJ_NORMALS_FLAT;
    for (size_t i = 0; i < r->chunk_count; i++) {
        has_texcoords |= r->chunks[i].t.data != NULL;
        has_normals |= r->chunks[i].n.data != NULL;
    }
    r->v = take(r, r->corner_count);
    if (has_texcoords)
        r->t = take(r, r->corner_count);
    if (has_normals || !is_flat)
        r->n = take(r, r->triangle_corner_count);
    if (r->desc->obj_normals == FACET_OBJ_NORMALS_AUTO && r->has_smoothing)
        r->groups = take(r, r->triangle_corner_count / 3);
    if (!obj_is_ok(r))
        return;
    parallel_for(r->thread_count, r->chunk_count, 1, write_chunks, r);
    if (!obj_check_memory(r, "polygons"))
        return;
    for (size_t i = 0; i < r->run_count; i++) {
        obj_primitive *p = &r->primitives[r->runs[i].primitive];
        p->v_minimum = r->runs[i].v_minimum < p->v_minimum ? r->runs[i].v_minimum : p->v_minimum;
        p->v_maximum = r->runs[i].v_maximum > p->v_maximum ? r->runs[i].v_maximum : p->v_maximum;
    }
}

void obj_make_cloud(obj_reader *r)
{
    bool is_new;
    r->v = take(r, r->position_count);
    r->primitives = mem_zalloc(r->allocator, 1, sizeof *r->primitives);
    if (!obj_is_ok(r))
        return;
    if (!r->primitives || obj_names_add(&r->objects, "", 0, &is_new) == UINT32_MAX) {
        obj_fail_memory(r, "primitives", sizeof *r->primitives);
        return;
    }
    for (size_t i = 0; i < r->position_count; i++) {
        const float *p = r->positions + 3 * i;
        if (fabsf(p[0]) <= SCENE_FARTHEST && fabsf(p[1]) <= SCENE_FARTHEST && fabsf(p[2]) <= SCENE_FARTHEST)
            r->v[r->corner_count++] = (uint32_t)i;
    }
    r->primitive_count = r->corner_count > 0;
    r->primitives[0] = (obj_primitive){.material = SCENE_NONE,
                                       .mode = SCENE_POINTS,
                                       .count = r->corner_count,
                                       .v_maximum = r->position_count ? (uint32_t)r->position_count - 1 : 0};
}
