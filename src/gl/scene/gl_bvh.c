/* gl_bvh.c - see gl_bvh.h. */
#include "gl/scene/gl_bvh.h"

#include <math.h>

#include "base/memory.h"
#include "base/result.h"

enum { BINS = 12 };

/* ---- boxes ---- */

typedef struct box {
    float low[3], high[3];
} box;

static box empty_box(void)
{
    return (box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
}

static void widen(box *b, const float low[3], const float high[3])
{
    for (int i = 0; i < 3; i++) {
        b->low[i] = fminf(b->low[i], low[i]);
        b->high[i] = fmaxf(b->high[i], high[i]);
    }
}

static float half_area(const box *b)
{
    float x = b->high[0] - b->low[0], y = b->high[1] - b->low[1], z = b->high[2] - b->low[2];
    return x >= 0.0f ? x * y + y * z + z * x : 0.0f;
}

/* ---- splits ---- */

typedef struct range {
    uint32_t first, count, parent, depth;
} range;

typedef struct builder {
    const float *boxes;
    gl_bvh *bvh;
    uint32_t *parents; /* per node */
} builder;

static float center_of(const builder *b, uint32_t item, int axis)
{
    const float *at = b->boxes + 6 * (size_t)item;
    return 0.5f * (at[axis] + at[3 + axis]);
}

/* The bounds of a range, and those of the centers of its items. */
static void find_bounds(const builder *b, const range *r, box *bounds, box *centers)
{
    *bounds = *centers = empty_box();
    for (uint32_t i = r->first; i < r->first + r->count; i++) {
        const uint32_t item = b->bvh->order[i];
        const float *at = b->boxes + 6 * (size_t)item;
        const float center[3] = {center_of(b, item, 0), center_of(b, item, 1), center_of(b, item, 2)};
        widen(bounds, at, at + 3);
        widen(centers, center, center);
    }
}

typedef struct bin {
    box bounds;
    uint32_t count;
} bin;

static int bin_of(float center, float low, float per_m)
{
    int i = (int)((center - low) * per_m);
    return i < 0 ? 0 : i >= BINS ? BINS - 1 : i;
}

/* The number of bins on the near side of the cheapest split; 0: none separates anything. */
static int choose_bin(const bin bins[BINS])
{
    float cost[BINS] = {0.0f};
    box near = empty_box(), far = empty_box();
    uint32_t count = 0;
    for (int i = 1; i < BINS; i++) {
        widen(&near, bins[i - 1].bounds.low, bins[i - 1].bounds.high);
        count += bins[i - 1].count;
        cost[i] = count ? half_area(&near) * (float)count : INFINITY;
    }
    count = 0;
    int best = 0;
    for (int i = BINS - 1; i > 0; i--) {
        widen(&far, bins[i].bounds.low, bins[i].bounds.high);
        count += bins[i].count;
        cost[i] += count ? half_area(&far) * (float)count : INFINITY;
        if (cost[i] < INFINITY && (!best || cost[i] <= cost[best]))
            best = i;
    }
    return best;
}

/* Most items below a node at a depth: so many fit if ranges are halved from there on. */
static uint64_t most_below(uint32_t depth)
{
    return (uint64_t)GL_BVH_LEAF << (GL_BVH_DEPTH - depth);
}

/* Moves the items of the nearer bins to the front; returns their number, or half of all where no bins differ or the
 * tree would become too deep. */
static uint32_t split(const builder *b, const range *r, const box *centers)
{
    int axis = 0;
    for (int i = 1; i < 3; i++)
        if (centers->high[i] - centers->low[i] > centers->high[axis] - centers->low[axis])
            axis = i;
    float extent = centers->high[axis] - centers->low[axis], per_m = (float)BINS / extent;
    if (!(extent > 0.0f) || !isfinite(per_m))
        return r->count / 2;
    bin bins[BINS];
    for (int i = 0; i < BINS; i++)
        bins[i] = (bin){empty_box(), 0};
    uint32_t *order = b->bvh->order;
    for (uint32_t i = r->first; i < r->first + r->count; i++) {
        const float *at = b->boxes + 6 * (size_t)order[i];
        bin *to = &bins[bin_of(center_of(b, order[i], axis), centers->low[axis], per_m)];
        widen(&to->bounds, at, at + 3);
        to->count++;
    }
    int limit = choose_bin(bins);
    uint32_t near = r->first;
    for (uint32_t i = r->first; i < r->first + r->count && limit; i++)
        if (bin_of(center_of(b, order[i], axis), centers->low[axis], per_m) < limit) {
            uint32_t swap = order[i];
            order[i] = order[near];
            order[near++] = swap;
        }
    uint32_t count = near - r->first, larger = count > r->count - count ? count : r->count - count;
    return larger < r->count && larger <= most_below(r->depth + 1) ? count : r->count / 2;
}

/* ---- all ---- */

static void build(const builder *b, range *stack)
{
    gl_bvh *bvh = b->bvh;
    uint32_t waiting = 0;
    stack[waiting++] = (range){.count = bvh->count};
    while (waiting) {
        range r = stack[--waiting];
        box bounds, centers;
        uint32_t number = bvh->node_count++;
        find_bounds(b, &r, &bounds, &centers);
        gl_bvh_node *node = &bvh->nodes[number];
        *node = (gl_bvh_node){.next = 1};
        for (int i = 0; i < 3; i++) {
            node->low[i] = bounds.low[i];
            node->high[i] = bounds.high[i];
        }
        b->parents[number] = r.parent;
        if (r.count <= GL_BVH_LEAF) {
            node->first = r.first;
            node->count = r.count;
            continue;
        }
        uint32_t near = split(b, &r, &centers);
        stack[waiting++] = (range){r.first + near, r.count - near, number, r.depth + 1};
        stack[waiting++] = (range){r.first, near, number, r.depth + 1};
    }
    for (uint32_t i = bvh->node_count; i-- > 1;) /* sizes of subtrees, then where they end */
        bvh->nodes[b->parents[i]].next += bvh->nodes[i].next;
    for (uint32_t i = 0; i < bvh->node_count; i++)
        bvh->nodes[i].next += i;
}

facet_result gl_bvh_build(const float *boxes, uint32_t count, const facet_allocator *allocator, gl_bvh *out,
                          facet_error *error)
{
    range stack[GL_BVH_DEPTH + 1];
    size_t most = 2 * (size_t)count;
    *out = (gl_bvh){.count = count};
    out->order = mem_alloc(allocator, count, sizeof *out->order);
    out->nodes = mem_alloc(allocator, most, sizeof *out->nodes);
    builder b = {boxes, out, mem_alloc(allocator, most, sizeof *b.parents)};
    bool has_memory = out->order && out->nodes && b.parents;
    if (has_memory) {
        for (uint32_t i = 0; i < count; i++)
            out->order[i] = i;
        if (count)
            build(&b, stack);
    }
    mem_free(b.parents);
    if (has_memory)
        return FACET_OK;
    gl_bvh_destroy(out);
    return fail_memory(error, "triangles", most * sizeof *out->nodes);
}

void gl_bvh_destroy(gl_bvh *bvh)
{
    mem_free(bvh->nodes);
    mem_free(bvh->order);
    *bvh = (gl_bvh){.nodes = NULL};
}
