/* bvh_items.c - see bvh_items.h. */
#include "cpu/bvh_items.h"

#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "base/result.h"

enum { ITEM_GRAIN = 1 << 13, LEAF_GRAIN = 1 << 11 };

/* ---- items ---- */

typedef struct items_job {
    const bvh_source *sources;
    uint32_t source_count;
    bvh_item *items;
} items_job;

static uint32_t indices_per_item(const scene_primitive *primitive)
{
    switch (primitive->mode) {
    case SCENE_TRIANGLES:
        return 3;
    case SCENE_LINES:
        return 2;
    case SCENE_POINTS:
        break;
    }
    return 1;
}

static void include_point(bvh_item *item, const float *p, float radius)
{
    for (int i = 0; i < 3; i++) {
        /* Comparisons that a NaN fails leave it in the box, which makes the item invalid. */
        if (!(p[i] - radius >= item->lo[i]))
            item->lo[i] = p[i] - radius;
        if (!(p[i] + radius <= item->hi[i]))
            item->hi[i] = p[i] + radius;
    }
}

static bvh_item make_item(const bvh_source *source, uint32_t number)
{
    const scene_primitive *primitive = source->primitive;
    const uint32_t n = indices_per_item(primitive);
    bvh_item item = {.geometry = source->geometry, .primitive = number};
    for (uint32_t i = 0; i < n; i++) {
        const size_t index = (size_t)number * n + i;
        const bool is_mesh = primitive->mode == SCENE_TRIANGLES;
        const float *p = source->vertices + (is_mesh ? 3 * (size_t)primitive->indices[index] : 4 * index);
        const float radius = is_mesh ? 0.0f : p[3];
        if (i == 0)
            for (int axis = 0; axis < 3; axis++) {
                item.lo[axis] = p[axis] - radius;
                item.hi[axis] = p[axis] + radius;
            }
        else
            include_point(&item, p, radius);
    }
    return item;
}

static void make_items(void *context, size_t begin, size_t end)
{
    const items_job *job = context;
    uint32_t low = 0;
    uint32_t high = job->source_count;
    while (high - low > 1) { /* the last source that begins at or before begin */
        const uint32_t middle = low + (high - low) / 2;
        if (job->sources[middle].first <= begin)
            low = middle;
        else
            high = middle;
    }
    for (size_t i = begin; i < end; i++) {
        while (low + 1 < job->source_count && job->sources[low + 1].first <= i)
            low++;
        job->items[i] = make_item(&job->sources[low], (uint32_t)(i - job->sources[low].first));
    }
}

/* The valid items of the sources. */
static facet_result collect_items(bvh_source *sources, uint32_t count, uint32_t threads,
                                  const facet_allocator *allocator, bvh_item **items, size_t *item_count,
                                  facet_error *error)
{
    size_t total = 0;
    for (uint32_t i = 0; i < count; i++) {
        sources[i].first = total;
        total += sources[i].primitive->index_count / indices_per_item(sources[i].primitive);
    }
    *item_count = 0;
    *items = mem_alloc(allocator, total, sizeof **items);
    if (!*items)
        return fail(error, FACET_ERROR_MEMORY, "out of memory: bounding volume hierarchy");
    items_job job = {.sources = sources, .source_count = count, .items = *items};
    parallel_for(threads, total, ITEM_GRAIN, make_items, &job);
    size_t kept = 0;
    for (size_t i = 0; i < total; i++)
        if (bvh_item_is_valid(&(*items)[i])) {
            if (kept != i)
                (*items)[kept] = (*items)[i];
            kept++;
        }
    *item_count = kept;
    return FACET_OK;
}

/* ---- leaves ---- */

typedef struct leaves_job {
    const bvh_item *items;
    const int32_t *leaves;
    const bvh_source *sources;
    uint32_t source_count;
    bvh4_triangles *triangles;
    bvh4_others *others;
} leaves_job;

static const bvh_source *find_source(const leaves_job *job, uint32_t geometry)
{
    uint32_t low = 0;
    uint32_t high = job->source_count;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (job->sources[middle].geometry <= geometry)
            low = middle;
        else
            high = middle;
    }
    return &job->sources[low];
}

static void fill_triangles(void *context, size_t begin, size_t end)
{
    const leaves_job *job = context;
    for (size_t i = begin; i < end; i++) {
        const bvh_item *items = job->items + bvh_leaf_first(job->leaves[i]);
        const uint32_t count = bvh_leaf_count(job->leaves[i]);
        bvh4_triangles *block = &job->triangles[i];
        memset(block, 0, sizeof *block);
        for (int corner = 0; corner < 3; corner++)
            for (int axis = 0; axis < 3; axis++)
                block->corners[corner][axis] = float4_all(NAN);
        for (uint32_t lane = 0; lane < count; lane++) {
            const bvh_source *source = find_source(job, items[lane].geometry);
            const uint32_t *indices = source->primitive->indices + 3 * (size_t)items[lane].primitive;
            for (int corner = 0; corner < 3; corner++)
                for (int axis = 0; axis < 3; axis++)
                    block->corners[corner][axis][lane] =
                        source->vertices[3 * (size_t)indices[corner] + (size_t)axis];
            block->geometry[lane] = items[lane].geometry;
            block->primitive[lane] = items[lane].primitive;
        }
    }
}

static void fill_others(void *context, size_t begin, size_t end)
{
    const leaves_job *job = context;
    for (size_t i = begin; i < end; i++) {
        const bvh_item *items = job->items + bvh_leaf_first(job->leaves[i]);
        bvh4_others *block = &job->others[i];
        *block = (bvh4_others){.count = bvh_leaf_count(job->leaves[i])};
        for (uint32_t lane = 0; lane < block->count; lane++) {
            block->geometry[lane] = items[lane].geometry;
            block->primitive[lane] = items[lane].primitive;
        }
    }
}

/* ---- trees ---- */

/* leaves: a block that the caller releases. */
static facet_result build_tree(bvh_item *items, size_t count, uint32_t threads,
                               const facet_allocator *allocator, bvh4 *out, int32_t **leaves,
                               facet_error *error)
{
    bvh_tree binary;
    *leaves = NULL;
    *out = (bvh4){.root = {.child = BVH_EMPTY}};
    facet_result result = bvh_tree_build(items, count, threads, allocator, &binary, error);
    if (result == FACET_OK)
        result = bvh4_create(&binary, allocator, out, leaves, error);
    bvh_tree_destroy(&binary);
    return result;
}

facet_result bvh_build_mesh(bvh_source *sources, uint32_t count, uint32_t thread_count,
                            const facet_allocator *allocator, bvh_mesh *out, facet_error *error)
{
    bvh_item *items = NULL;
    int32_t *leaves = NULL;
    size_t item_count = 0;
    *out = (bvh_mesh){.tree = {.root = {.child = BVH_EMPTY}}};
    facet_result result = collect_items(sources, count, thread_count, allocator, &items, &item_count, error);
    if (result == FACET_OK)
        result = build_tree(items, item_count, thread_count, allocator, &out->tree, &leaves, error);
    if (result == FACET_OK && item_count) {
        out->blocks = mem_alloc(allocator, out->tree.leaf_count, sizeof *out->blocks);
        leaves_job job = {.items = items,
                          .leaves = leaves,
                          .sources = sources,
                          .source_count = count,
                          .triangles = out->blocks};
        if (out->blocks) {
            parallel_for(thread_count, out->tree.leaf_count, LEAF_GRAIN, fill_triangles, &job);
        } else {
            bvh4_destroy(&out->tree);
            result = fail(error, FACET_ERROR_MEMORY, "out of memory: bounding volume hierarchy");
        }
    }
    mem_free(leaves);
    mem_free(items);
    return result;
}

facet_result bvh_build_list(bvh_item *items, size_t count, uint32_t thread_count,
                            const facet_allocator *allocator, bvh_list *out, facet_error *error)
{
    int32_t *leaves = NULL;
    *out = (bvh_list){.tree = {.root = {.child = BVH_EMPTY}}};
    facet_result result = build_tree(items, count, thread_count, allocator, &out->tree, &leaves, error);
    if (result == FACET_OK && count) {
        out->blocks = mem_alloc(allocator, out->tree.leaf_count, sizeof *out->blocks);
        leaves_job job = {.items = items, .leaves = leaves, .others = out->blocks};
        if (out->blocks) {
            fill_others(&job, 0, out->tree.leaf_count);
        } else {
            bvh4_destroy(&out->tree);
            result = fail(error, FACET_ERROR_MEMORY, "out of memory: bounding volume hierarchy");
        }
    }
    mem_free(leaves);
    return result;
}

facet_result bvh_build_sprites(bvh_source *sources, uint32_t count, uint32_t thread_count,
                               const facet_allocator *allocator, bvh_list *out, facet_error *error)
{
    bvh_item *items = NULL;
    size_t item_count = 0;
    *out = (bvh_list){.tree = {.root = {.child = BVH_EMPTY}}};
    facet_result result = collect_items(sources, count, thread_count, allocator, &items, &item_count, error);
    if (result == FACET_OK)
        result = bvh_build_list(items, item_count, thread_count, allocator, out, error);
    mem_free(items);
    return result;
}
