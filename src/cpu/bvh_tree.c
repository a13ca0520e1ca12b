/* bvh_tree.c - see bvh_tree.h. Ranges of many items are split one after another, each by all threads; the ranges that this
 * leaves are subtrees that threads build on their own. */
#include "cpu/bvh_tree.h"

#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "base/result.h"
#include "cpu/float4.h"

enum { BINS = 16, FEW_BINS = 8, FEW = 48, CHUNK = 1 << 14, LARGE = 1 << 15, LARGE_PARTS = 64 };

/* Limit of coordinates: areas are finite, and so are sums of them but for absurd numbers. */
static const float MAX_COORDINATE = 1.844e18f;

/* Lane 3 is undefined. */
typedef struct box {
    float4 lo, hi;
} box;

/* Items that become a subtree. Centers are those of boxes, doubled: lo + hi. */
typedef struct range {
    uint32_t first, count;
    box all, centers;
} range;

typedef struct bins {
    box boxes[3][BINS];
    uint32_t counts[3][BINS];
} bins;

/* From centers to bins along each axis: (center - low) * scale. */
typedef struct bin_scale {
    float4 low, scale;
    int4 last;
    uint32_t count;
} bin_scale;

typedef struct split {
    bool is_found;
    int axis;
    int32_t bin; /* the last one on the left */
} split;

/* ---- boxes ---- */

static const box EMPTY = {{INFINITY, INFINITY, INFINITY, INFINITY},
                          {-INFINITY, -INFINITY, -INFINITY, -INFINITY}};

static inline box item_box(const bvh_item *item)
{
    box b;
    memcpy(&b.lo, item->lo, sizeof b.lo);
    memcpy(&b.hi, item->hi, sizeof b.hi);
    return b;
}

/* Lane 3 is 0. */
static inline float4 center_of(box b)
{
    const int4 xyz = {-1, -1, -1, 0};
    return (float4)((int4)(b.lo + b.hi) & xyz);
}

static inline void widen(box *a, box b)
{
    a->lo = float4_min(b.lo, a->lo);
    a->hi = float4_max(b.hi, a->hi);
}

static inline float half_area(box b)
{
    float4 d = b.hi - b.lo;
    return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
}

bool bvh_item_is_valid(const bvh_item *item)
{
    bool is_valid = true;
    for (int i = 0; i < 3; i++)
        is_valid = is_valid && item->lo[i] >= -MAX_COORDINATE && item->hi[i] <= MAX_COORDINATE &&
                   item->lo[i] <= item->hi[i];
    return is_valid;
}

/* ---- splits ---- */

static bin_scale scale_bins(const range *r)
{
    const uint32_t count = r->count < FEW ? FEW_BINS : BINS;
    bin_scale s = {.low = center_of((box){r->centers.lo, float4_all(0.0f)}), .count = count};
    s.last = (int4){(int32_t)count - 1, (int32_t)count - 1, (int32_t)count - 1, 0};
    for (int i = 0; i < 3; i++) {
        const float width = r->centers.hi[i] - r->centers.lo[i];
        s.scale[i] = width > 0.0f ? (float)count / width : 0.0f;
        if (!(s.scale[i] < INFINITY))
            s.scale[i] = 0.0f; /* a width so small has no middle */
    }
    return s;
}

static inline int4 bin_of(const bin_scale *s, float4 center)
{
    const int4 bin = __builtin_convertvector((center - s->low) * s->scale, int4);
    const int4 is_beyond = bin > s->last;
    return (is_beyond & s->last) | (~is_beyond & bin);
}

static void clear_bins(bins *b, uint32_t count)
{
    for (int axis = 0; axis < 3; axis++)
        for (uint32_t i = 0; i < count; i++) {
            b->boxes[axis][i] = EMPTY;
            b->counts[axis][i] = 0;
        }
}

static void fill_bins(bins *b, const bin_scale *s, const bvh_item *items, size_t count)
{
    clear_bins(b, s->count);
    for (size_t i = 0; i < count; i++) {
        const box item = item_box(&items[i]);
        const int4 bin = bin_of(s, center_of(item));
        for (int axis = 0; axis < 3; axis++) {
            widen(&b->boxes[axis][bin[axis]], item);
            b->counts[axis][bin[axis]]++;
        }
    }
}

/* Leaves are tested four items at a time. */
static inline float leaf_cost(uint32_t count)
{
    return (float)((count + BVH_LEAF_ITEMS - 1) / BVH_LEAF_ITEMS);
}

static split find_split(const bins *b, uint32_t bin_count, uint32_t count)
{
    split best = {.is_found = false};
    float best_cost = INFINITY;
    for (int axis = 0; axis < 3; axis++) {
        float right_cost[BINS];
        box right = EMPTY;
        uint32_t right_count = 0;
        for (uint32_t i = bin_count - 1; i > 0; i--) {
            widen(&right, b->boxes[axis][i]);
            right_count += b->counts[axis][i];
            right_cost[i] = right_count ? half_area(right) * leaf_cost(right_count) : INFINITY;
        }
        box left = EMPTY;
        uint32_t left_count = 0;
        for (uint32_t i = 0; i + 1 < bin_count; i++) {
            widen(&left, b->boxes[axis][i]);
            left_count += b->counts[axis][i];
            if (left_count == 0 || left_count == count)
                continue;
            const float cost = half_area(left) * leaf_cost(left_count) + right_cost[i + 1];
            if (cost < best_cost) {
                best_cost = cost;
                best = (split){.is_found = true, .axis = axis, .bin = (int32_t)i};
            }
        }
    }
    return best;
}

/* Levels of inner nodes that a balanced tree of count items has. */
static uint32_t balanced_depth(uint32_t count)
{
    uint32_t depth = 0;
    while (((uint64_t)BVH_LEAF_ITEMS << depth) < count)
        depth++;
    return depth;
}

static void measure(const bvh_item *items, range *r)
{
    r->all = r->centers = EMPTY;
    for (uint32_t i = 0; i < r->count; i++) {
        const box item = item_box(&items[r->first + i]);
        const float4 center = center_of(item);
        widen(&r->all, item);
        widen(&r->centers, (box){center, center});
    }
}

/* Halves the range where no plane divides it (centers coincide), or where the tree would get too deep. */
static void halve(const bvh_item *items, const range *r, range sides[2])
{
    const uint32_t half = r->count / 2;
    sides[0] = (range){.first = r->first, .count = half};
    sides[1] = (range){.first = r->first + half, .count = r->count - half};
    measure(items, &sides[0]);
    measure(items, &sides[1]);
}

/* Moves the items of the left side to the front. */
static void partition_range(bvh_item *items, const range *r, const bin_scale *scale, split s, range sides[2])
{
    box centers[2] = {EMPTY, EMPTY};
    bvh_item *left = items + r->first;
    bvh_item *right = left + r->count;
    while (left < right) {
        const float4 center = center_of(item_box(left));
        const bool is_right = bin_of(scale, center)[s.axis] > s.bin;
        widen(&centers[is_right], (box){center, center});
        if (!is_right) {
            left++;
            continue;
        }
        right--;
        const bvh_item swap = *left;
        *left = *right;
        *right = swap;
    }
    const uint32_t count = (uint32_t)(left - (items + r->first));
    sides[0] = (range){.first = r->first, .count = count, .centers = centers[0]};
    sides[1] = (range){.first = r->first + count, .count = r->count - count, .centers = centers[1]};
}

/* Divides a range of more than a leaf, given its filled bins. depth: of its node. */
static void divide(bvh_item *items, const range *r, const bins *b, const bin_scale *scale, uint32_t depth,
                   range sides[2])
{
    const split s = find_split(b, scale->count, r->count);
    uint32_t left_count = 0;
    for (int32_t i = 0; s.is_found && i <= s.bin; i++)
        left_count += b->counts[s.axis][i];
    const uint32_t larger = left_count > r->count - left_count ? left_count : r->count - left_count;
    if (!s.is_found || depth + 1 + balanced_depth(larger) > BVH_MAX_DEPTH) {
        halve(items, r, sides);
        return;
    }
    partition_range(items, r, scale, s, sides);
    sides[0].all = sides[1].all = EMPTY;
    for (int32_t i = 0; i < (int32_t)scale->count; i++)
        widen(&sides[i > s.bin].all, b->boxes[s.axis][i]);
}

/* ---- subtrees ---- */

/* Nodes in an array that grows. */
typedef struct subtree {
    const facet_allocator *allocator;
    bvh_item *items;
    range all;
    uint32_t depth;
    bvh_node *nodes;
    size_t count, capacity;
    int32_t root;
    uint32_t parent, side; /* of the nodes above */
    bool has_failed;
} subtree;

static bvh_child make_child(const range *r, int32_t child)
{
    return (bvh_child){.lo = {r->all.lo[0], r->all.lo[1], r->all.lo[2]},
                       .child = child,
                       .hi = {r->all.hi[0], r->all.hi[1], r->all.hi[2]}};
}

static uint32_t add_node(subtree *t)
{
    if (t->count == t->capacity &&
        !mem_reserve(t->allocator, (void **)&t->nodes, &t->capacity, t->count + 1, sizeof *t->nodes)) {
        t->has_failed = true;
        return 0;
    }
    return (uint32_t)t->count++;
}

/* Recursion ends at BVH_MAX_DEPTH. */
static int32_t build_range(subtree *t, const range *r, uint32_t depth)
{
    if (r->count <= BVH_LEAF_ITEMS)
        return bvh_leaf(r->first, r->count);
    const uint32_t number = add_node(t);
    if (t->has_failed)
        return BVH_EMPTY;
    range sides[2];
    {
        bins b;
        const bin_scale scale = scale_bins(r);
        fill_bins(&b, &scale, t->items + r->first, r->count);
        divide(t->items, r, &b, &scale, depth, sides);
    }
    for (int i = 0; i < 2; i++) {
        const int32_t child = build_range(t, &sides[i], depth + 1);
        if (t->has_failed)
            return BVH_EMPTY;
        t->nodes[number].children[i] = make_child(&sides[i], child);
    }
    return (int32_t)number;
}

static void build_subtrees(void *context, size_t begin, size_t end)
{
    subtree *subtrees = context;
    for (size_t i = begin; i < end; i++)
        subtrees[i].root = build_range(&subtrees[i], &subtrees[i].all, subtrees[i].depth);
}

/* ---- large ranges ---- */

typedef struct builder {
    const facet_allocator *allocator;
    uint32_t thread_count;
    bvh_item *items;
    uint32_t large; /* ranges of more items are divided by all threads */
    subtree top;    /* its nodes */
    subtree *subtrees;
    size_t subtree_count, subtree_capacity;
    void *parts; /* per chunk of the items: bins, or a range */
} builder;

typedef struct chunk_job {
    const bvh_item *items;
    uint32_t count;
    const bin_scale *scale;
    bins *bins;
    range *ranges;
} chunk_job;

static uint32_t chunk_count(uint32_t count)
{
    return (count + CHUNK - 1) / CHUNK;
}

static uint32_t chunk_size(const chunk_job *job, size_t chunk)
{
    const uint32_t left = job->count - (uint32_t)chunk * CHUNK;
    return left < CHUNK ? left : CHUNK;
}

static void measure_chunks(void *context, size_t begin, size_t end)
{
    const chunk_job *job = context;
    for (size_t i = begin; i < end; i++) {
        job->ranges[i] = (range){.first = (uint32_t)i * CHUNK, .count = chunk_size(job, i)};
        measure(job->items, &job->ranges[i]);
    }
}

static void bin_chunks(void *context, size_t begin, size_t end)
{
    const chunk_job *job = context;
    for (size_t i = begin; i < end; i++)
        fill_bins(&job->bins[i], job->scale, job->items + i * CHUNK, chunk_size(job, i));
}

static range measure_all(const builder *b, uint32_t count)
{
    const uint32_t chunks = chunk_count(count);
    chunk_job job = {.items = b->items, .count = count, .ranges = b->parts};
    parallel_for(b->thread_count, chunks, 1, measure_chunks, &job);
    range all = {.first = 0, .count = count, .all = EMPTY, .centers = EMPTY};
    for (uint32_t i = 0; i < chunks; i++) {
        widen(&all.all, job.ranges[i].all);
        widen(&all.centers, job.ranges[i].centers);
    }
    return all;
}

/* Minima, maxima and counts are exact, so that their order is of no consequence. */
static void bin_all(const builder *b, const range *r, const bin_scale *scale)
{
    const uint32_t chunks = chunk_count(r->count);
    chunk_job job = {.items = b->items + r->first, .count = r->count, .scale = scale, .bins = b->parts};
    parallel_for(b->thread_count, chunks, 1, bin_chunks, &job);
    for (uint32_t k = 1; k < chunks; k++)
        for (int axis = 0; axis < 3; axis++)
            for (uint32_t i = 0; i < scale->count; i++) {
                widen(&job.bins[0].boxes[axis][i], job.bins[k].boxes[axis][i]);
                job.bins[0].counts[axis][i] += job.bins[k].counts[axis][i];
            }
}

/* Divides what is large and lists the rest as subtrees. Returns the index of the node, or BVH_EMPTY for a subtree, whose
 * parent and side get the child when it is built. */
static int32_t divide_large(builder *b, const range *r, uint32_t depth, uint32_t parent, uint32_t side)
{
    if (r->count <= b->large) {
        if (!mem_reserve(b->allocator, (void **)&b->subtrees, &b->subtree_capacity, b->subtree_count + 1,
                         sizeof *b->subtrees)) {
            b->top.has_failed = true;
            return BVH_EMPTY;
        }
        b->subtrees[b->subtree_count++] = (subtree){.allocator = b->allocator,
                                                    .items = b->items,
                                                    .all = *r,
                                                    .depth = depth,
                                                    .parent = parent,
                                                    .side = side};
        return BVH_EMPTY;
    }
    const uint32_t number = add_node(&b->top);
    const bin_scale scale = scale_bins(r);
    range sides[2];
    bin_all(b, r, &scale);
    divide(b->items, r, b->parts, &scale, depth, sides);
    for (uint32_t i = 0; i < 2 && !b->top.has_failed; i++) {
        const int32_t child = divide_large(b, &sides[i], depth + 1, number, i);
        if (!b->top.has_failed)
            b->top.nodes[number].children[i] = make_child(&sides[i], child);
    }
    return (int32_t)number;
}

/* ---- the whole ---- */

static size_t count_nodes(const builder *b)
{
    size_t count = b->top.count;
    bool has_failed = b->top.has_failed;
    for (size_t i = 0; i < b->subtree_count; i++) {
        count += b->subtrees[i].count;
        has_failed = has_failed || b->subtrees[i].has_failed;
    }
    return has_failed ? SIZE_MAX : count;
}

/* Appends the nodes of subtrees to those above them. */
static bool join(builder *b, size_t count, bvh_tree *out)
{
    bvh_node *nodes = mem_alloc(b->allocator, count, sizeof *nodes);
    if (!nodes)
        return false;
    if (b->top.count)
        memcpy(nodes, b->top.nodes, b->top.count * sizeof *nodes);
    size_t place = b->top.count;
    for (size_t i = 0; i < b->subtree_count; i++) {
        const subtree *t = &b->subtrees[i];
        const int32_t offset = (int32_t)place;
        const int32_t root = bvh_is_leaf(t->root) ? t->root : t->root + offset;
        for (size_t k = 0; k < t->count; k++) {
            bvh_node node = t->nodes[k];
            for (int side = 0; side < 2; side++)
                if (!bvh_is_leaf(node.children[side].child))
                    node.children[side].child += offset;
            nodes[place++] = node;
        }
        if (b->top.count)
            nodes[t->parent].children[t->side].child = root;
        else
            out->root.child = root;
    }
    out->nodes = nodes;
    out->node_count = (uint32_t)count;
    return true;
}

facet_result bvh_tree_build(bvh_item *items, size_t count, uint32_t thread_count,
                            const facet_allocator *allocator, bvh_tree *out, facet_error *error)
{
    *out = (bvh_tree){.root = {.child = BVH_EMPTY}};
    if (count > BVH_MAX_ITEMS)
        return fail(error, FACET_ERROR_LIMIT,
                    "bounding volume hierarchy: %zu triangles; at most %u are supported", count,
                    (unsigned)BVH_MAX_ITEMS);
    if (count == 0)
        return FACET_OK;
    const uint32_t n = (uint32_t)count;
    builder b = {.allocator = allocator, .thread_count = thread_count, .items = items};
    b.large = n / LARGE_PARTS > LARGE ? n / LARGE_PARTS : LARGE;
    b.top.allocator = allocator;
    b.parts = mem_alloc(allocator, chunk_count(n), sizeof(bins));
    bool has_memory = b.parts != NULL;
    if (has_memory) {
        const range all = measure_all(&b, n);
        const int32_t root = divide_large(&b, &all, 0, 0, 0);
        if (!b.top.has_failed)
            parallel_for(thread_count, b.subtree_count, 1, build_subtrees, b.subtrees);
        out->root = make_child(&all, root);
        const size_t node_count = count_nodes(&b);
        has_memory = node_count != SIZE_MAX && join(&b, node_count, out);
    }
    for (size_t i = 0; i < b.subtree_count; i++)
        mem_free(b.subtrees[i].nodes);
    mem_free(b.subtrees);
    mem_free(b.top.nodes);
    mem_free(b.parts);
    if (has_memory)
        return FACET_OK;
    *out = (bvh_tree){.root = {.child = BVH_EMPTY}};
    return fail(error, FACET_ERROR_MEMORY, "out of memory: bounding volume hierarchy");
}

void bvh_tree_destroy(bvh_tree *tree)
{
    mem_free(tree->nodes);
    *tree = (bvh_tree){.root = {.child = BVH_EMPTY}};
}
