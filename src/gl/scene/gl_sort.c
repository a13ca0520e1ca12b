/* gl_sort.c - see gl_sort.h. */
#include "gl/scene/gl_sort.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"

enum {
    MAX_RUNS = 4096, /* of a cluster; a call takes 1 to 3 us */
    MIN_SLICES = 64,
    GRAIN = 1 << 14
};

static void clear(gl_sort *s)
{
    mem_free(s->units);
    mem_free(s->middles);
    mem_free(s->unit_of);
    mem_free(s->order);
    mem_free(s->scratch);
    s->units = NULL;
    s->middles = NULL;
    s->unit_of = s->order = s->scratch = NULL;
    s->unit_count = s->count = s->run_count = 0;
    s->revision = 0;
}

void gl_sort_destroy(gl_sort *s)
{
    clear(s);
    mem_free(s->runs);
    s->runs = NULL;
    s->run_capacity = 0;
}

/* ---- input ---- */

static uint32_t corner_count(const render_geometry *g)
{
    return g->primitive->mode == SCENE_TRIANGLES ? 3 : g->primitive->mode == SCENE_LINES ? 2 : 1;
}

typedef struct middle_job {
    const render_geometry *geometry;
    float *out;
} middle_job;

static void find_middles(void *context, size_t begin, size_t end)
{
    const middle_job *job = context;
    const render_geometry *g = job->geometry;
    uint32_t n = corner_count(g);
    for (size_t i = begin; i < end; i++) {
        float sum[3] = {0.0f};
        for (uint32_t k = 0; k < n; k++)
            for (int axis = 0; axis < 3; axis++)
                sum[axis] += g->positions[3 * (size_t)g->primitive->indices[n * i + k] + (size_t)axis];
        for (int axis = 0; axis < 3; axis++)
            sum[axis] /= (float)n;
        mat4_transform_point(g->world, sum, job->out + 3 * i);
    }
}

static facet_result collect(gl_sort *s, const gl_mesh_set *meshes, const gl_scene *scene,
                            uint32_t thread_count, facet_error *error)
{
    uint32_t batch_count;
    const gl_batch *batches = gl_mesh_batches(meshes, GL_PASS_BLENDED, &batch_count);
    uint64_t count = 0;
    uint32_t unit_count = 0;
    for (uint32_t b = 0; b < batch_count; b++) {
        const render_geometry *g = batches[b].geometry;
        uint32_t instances = batches[b].is_sprites ? 1 : batches[b].instance_count;
        unit_count += instances;
        count += (uint64_t)instances * (g->primitive->index_count / corner_count(g));
    }
    if (count > UINT32_MAX / 8)
        return fail(error, FACET_ERROR_LIMIT, "%s: %llu blended triangles; at most %u can be sorted",
                    scene->scene->source, (unsigned long long)count, UINT32_MAX / 8);
    s->units = mem_alloc(&s->allocator, unit_count, sizeof *s->units);
    s->middles = mem_alloc(&s->allocator, count, 3 * sizeof *s->middles);
    s->unit_of = mem_alloc(&s->allocator, count, sizeof *s->unit_of);
    s->order = mem_alloc(&s->allocator, count, sizeof *s->order);
    s->scratch = mem_alloc(&s->allocator, count, 5 * sizeof *s->scratch);
    if (!s->units || !s->middles || !s->unit_of || !s->order || !s->scratch)
        return fail_memory(error, "blended triangles", count * (11 * sizeof(uint32_t)));
    for (uint32_t b = 0; b < batch_count; b++)
        for (uint32_t i = 0; i < (batches[b].is_sprites ? 1 : batches[b].instance_count); i++) {
            gl_sort_unit *unit = &s->units[s->unit_count];
            uint32_t number = gl_mesh_instance_geometry(meshes, batches[b].first_instance + i);
            const render_geometry *g = &scene->geometries.items[number];
            *unit = (gl_sort_unit){.batch = b,
                                   .instance = batches[b].first_instance + i,
                                   .first = s->count,
                                   .count = g->primitive->index_count / corner_count(g)};
            gl_mesh_instance_box(&scene->pose.instances[number], unit->box[0], unit->box[1]);
            middle_job job = {.geometry = g, .out = s->middles + 3 * (size_t)s->count};
            parallel_for(thread_count, unit->count, GRAIN, find_middles, &job);
            for (uint32_t k = 0; k < unit->count; k++)
                s->unit_of[s->count + k] = s->unit_count;
            s->count += unit->count;
            s->unit_count++;
        }
    s->revision = scene->revision;
    return FACET_OK;
}

/* ---- clusters: units that must be sorted together ---- */

/* Extent of a unit: in the image, [-1, 1] where it is visible, and along the axis. */
typedef struct extent {
    float low[3], high[3];
    uint32_t unit, cluster;
} extent;

static extent extent_of(const gl_sort_unit *unit, const gl_frame_block *frame)
{
    const float *m = frame->view_projection;
    extent e = {.low = {INFINITY, INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY, -INFINITY}};
    for (int corner = 0; corner < 8; corner++) {
        float p[3], clip[3], depth = 0.0f;
        for (int k = 0; k < 3; k++) {
            p[k] = unit->box[corner >> k & 1][k] - frame->eye[k];
            depth += p[k] * frame->forward[k];
        }
        for (int k = 0; k < 3; k++) {
            int row = k == 2 ? 3 : k;
            clip[k] = m[row] * p[0] + m[4 + row] * p[1] + m[8 + row] * p[2] + m[12 + row];
        }
        bool is_in_front = clip[2] > 0.0f;
        for (int k = 0; k < 2; k++) {
            e.low[k] = fminf(e.low[k], is_in_front ? clip[k] / clip[2] : -INFINITY);
            e.high[k] = fmaxf(e.high[k], is_in_front ? clip[k] / clip[2] : INFINITY);
        }
        e.low[2] = fminf(e.low[2], depth);
        e.high[2] = fmaxf(e.high[2], depth);
    }
    return e;
}

static bool overlap(const extent *a, const extent *b, int axis)
{
    return a->low[axis] <= b->high[axis] && b->low[axis] <= a->high[axis];
}

static int by_low_end(const void *x, const void *y)
{
    const extent *a = x, *b = y;
    return (a->low[0] > b->low[0]) - (a->low[0] < b->low[0]);
}

static uint32_t root_of(extent *clusters, uint32_t i)
{
    while (clusters[i].cluster != i)
        i = clusters[i].cluster = clusters[clusters[i].cluster].cluster;
    return i;
}

/* Merges units into clusters until any two clusters are disjoint in the image or in depth. clusters: by
 * unit; each root gets the range of depths. */
static void join(const extent *extents, extent *clusters, uint32_t count)
{
    bool is_done = false;
    while (!is_done) {
        is_done = true;
        for (uint32_t i = 0; i < count; i++)
            for (uint32_t k = i + 1; k < count && extents[k].low[0] <= extents[i].high[0]; k++) {
                uint32_t a = root_of(clusters, extents[i].unit), b = root_of(clusters, extents[k].unit);
                if (a == b || !overlap(&extents[i], &extents[k], 1) ||
                    !overlap(&clusters[a], &clusters[b], 2))
                    continue;
                clusters[b].cluster = a;
                clusters[a].low[2] = fminf(clusters[a].low[2], clusters[b].low[2]);
                clusters[a].high[2] = fmaxf(clusters[a].high[2], clusters[b].high[2]);
                is_done = false;
            }
    }
}

static int from_the_back(const void *x, const void *y)
{
    const extent *a = x, *b = y;
    if (a->high[2] < b->high[2] || a->high[2] > b->high[2])
        return a->high[2] > b->high[2] ? -1 : 1;
    return (a->cluster > b->cluster) - (a->cluster < b->cluster);
}

/* Index of each unit's cluster, the farthest first. */
static bool find_clusters(const gl_sort *s, const gl_frame_block *frame, uint32_t *cluster_of,
                          uint32_t *cluster_count)
{
    uint32_t n = s->unit_count;
    extent *extents = mem_alloc(&s->allocator, 2 * (size_t)n, sizeof *extents);
    if (!extents)
        return false;
    extent *clusters = extents + n;
    for (uint32_t i = 0; i < n; i++) {
        extents[i] = extent_of(&s->units[i], frame);
        extents[i].unit = extents[i].cluster = i;
        clusters[i] = extents[i];
    }
    if (n > 1)
        qsort(extents, n, sizeof *extents, by_low_end);
    join(extents, clusters, n);
    for (uint32_t i = 0; i < n; i++) {
        uint32_t root = root_of(clusters, i);
        extents[i] = clusters[root];
        extents[i].unit = i;
    }
    if (n > 1)
        qsort(extents, n, sizeof *extents, from_the_back);
    *cluster_count = 0;
    for (uint32_t i = 0; i < n; i++) {
        *cluster_count += i == 0 || extents[i].cluster != extents[i - 1].cluster;
        cluster_of[extents[i].unit] = *cluster_count - 1;
    }
    mem_free(extents);
    return true;
}

/* ---- sorting ---- */

/* Stable sort of items and keys by the lowest bits of the keys, with scratch arrays of the same size
 * (other_*). */
static void radix_sort(uint32_t *items, uint32_t *keys, uint32_t *other_items, uint32_t *other_keys,
                       uint32_t count, int bits)
{
    enum { DIGIT = 8, DIGITS = 1 << DIGIT };
    for (int shift = 0; shift < bits; shift += 2 * DIGIT)
        for (int half = 0; half < 2; half++) {
            uint32_t at[DIGITS] = {0}, sum = 0;
            int s = shift + half * DIGIT;
            const uint32_t *from = half ? other_items : items, *from_keys = half ? other_keys : keys;
            uint32_t *to = half ? items : other_items, *to_keys = half ? keys : other_keys;
            for (uint32_t i = 0; i < count; i++)
                at[from_keys[i] >> s & (DIGITS - 1)]++;
            for (int d = 0; d < DIGITS; d++) {
                uint32_t n = at[d];
                at[d] = sum;
                sum += n;
            }
            for (uint32_t i = 0; i < count; i++) {
                uint32_t place = at[from_keys[i] >> s & (DIGITS - 1)]++;
                to[place] = from[i];
                to_keys[place] = from_keys[i];
            }
        }
}

/* Greater depths give smaller keys. */
static uint32_t depth_key(float depth)
{
    uint32_t bits;
    memcpy(&bits, &depth, sizeof bits);
    return ~(bits & 0x80000000u ? ~bits : bits | 0x80000000u);
}

typedef struct order_job {
    gl_sort *sort;
    const gl_frame_block *frame;
    uint32_t *items, *keys;
} order_job;

static void set_keys(void *context, size_t begin, size_t end)
{
    const order_job *job = context;
    const gl_frame_block *f = job->frame;
    for (size_t i = begin; i < end; i++) {
        const float *p = job->sort->middles + 3 * i;
        float depth = (p[0] - f->eye[0]) * f->forward[0] + (p[1] - f->eye[1]) * f->forward[1] +
                      (p[2] - f->eye[2]) * f->forward[2];
        job->items[i] = (uint32_t)i;
        job->keys[i] = depth_key(depth);
    }
}

static uint32_t count_runs(const gl_sort *s, const uint32_t *items, uint32_t count)
{
    uint32_t runs = 0;
    for (uint32_t i = 0; i < count; i++)
        runs += i == 0 || s->unit_of[items[i]] != s->unit_of[items[i - 1]];
    return runs;
}

static float depth_at(const gl_sort *s, const gl_frame_block *f, uint32_t item)
{
    const float *p = s->middles + 3 * (size_t)item;
    float depth = 0.0f;
    for (int k = 0; k < 3; k++)
        depth += (p[k] - f->eye[k]) * f->forward[k];
    return depth;
}

/* Reduces the number of runs of a sorted cluster. */
static void take_turns(gl_sort *s, const gl_frame_block *frame, uint32_t *items, uint32_t *keys,
                       uint32_t count, uint32_t unit_count)
{
    uint32_t slices = MAX_RUNS / unit_count;
    slices = slices < MIN_SLICES ? MIN_SLICES : slices;
    float far = depth_at(s, frame, items[0]), near = depth_at(s, frame, items[count - 1]);
    float scale = far > near ? (float)slices / (far - near) : 0.0f;
    uint32_t *other = s->scratch + 2 * (size_t)s->count, *other_keys = s->scratch + 3 * (size_t)s->count;
    for (uint32_t i = 0; i < count; i++)
        keys[i] = s->unit_of[items[i]];
    radix_sort(items, keys, other, other_keys, count, 32);
    for (uint32_t i = 0; i < count; i++)
        keys[i] = (uint32_t)((far - depth_at(s, frame, items[i])) * scale);
    radix_sort(items, keys, other, other_keys, count, 16);
}

static bool add_runs(gl_sort *s, const uint32_t *items)
{
    size_t runs = count_runs(s, items, s->count);
    if (!mem_reserve(&s->allocator, (void **)&s->runs, &s->run_capacity, runs, sizeof *s->runs))
        return false;
    uint32_t *done = s->scratch + 4 * (size_t)s->count; /* per unit; there are at most as many as items */
    for (uint32_t i = 0; i < s->unit_count; i++)
        if (s->units[i].count)
            done[s->units[i].first] = 0;
    s->run_count = 0;
    for (uint32_t i = 0; i < s->count; i++) {
        uint32_t unit = s->unit_of[items[i]], first = s->units[unit].first;
        if (i == 0 || unit != s->unit_of[items[i - 1]])
            s->runs[s->run_count++] = (gl_sort_run){.unit = unit, .first = done[first]};
        s->order[first + done[first]++] = items[i] - first;
        s->runs[s->run_count - 1].count++;
    }
    return true;
}

static bool put_in_order(gl_sort *s, const gl_frame_block *frame, uint32_t thread_count)
{
    uint32_t *items = s->scratch, *keys = s->scratch + s->count;
    uint32_t *other = s->scratch + 2 * (size_t)s->count, *other_keys = s->scratch + 3 * (size_t)s->count;
    uint32_t cluster_count;
    uint32_t *cluster_of = mem_alloc(&s->allocator, s->unit_count, sizeof *cluster_of);
    if (!cluster_of || !find_clusters(s, frame, cluster_of, &cluster_count)) {
        mem_free(cluster_of);
        return false;
    }
    order_job job = {.sort = s, .frame = frame, .items = items, .keys = keys};
    parallel_for(thread_count, s->count, GRAIN, set_keys, &job);
    radix_sort(items, keys, other, other_keys, s->count, 32);
    if (cluster_count > 1) {
        for (uint32_t i = 0; i < s->count; i++)
            keys[i] = cluster_of[s->unit_of[items[i]]];
        radix_sort(items, keys, other, other_keys, s->count, cluster_count > 1u << 16 ? 32 : 16);
    }
    for (uint32_t i = 0, end = 0; i < s->count; i = end) {
        uint32_t cluster = cluster_of[s->unit_of[items[i]]], units = 0;
        while (end < s->count && cluster_of[s->unit_of[items[end]]] == cluster)
            end++;
        if (count_runs(s, items + i, end - i) <= MAX_RUNS)
            continue;
        for (uint32_t k = 0; k < s->unit_count; k++)
            units += cluster_of[k] == cluster;
        take_turns(s, frame, items + i, keys + i, end - i, units);
    }
    mem_free(cluster_of);
    return add_runs(s, items);
}

facet_result gl_sort_update(gl_sort *s, const gl_mesh_set *meshes, const gl_scene *scene,
                            const gl_frame_block *frame, uint32_t thread_count, bool *is_new,
                            facet_error *error)
{
    *is_new = true;
    if (s->revision != scene->revision) {
        clear(s);
        facet_result result = collect(s, meshes, scene, thread_count, error);
        if (result != FACET_OK) {
            clear(s);
            return result;
        }
    } else if (memcmp(s->view_projection, frame->view_projection, sizeof s->view_projection) == 0 &&
               memcmp(s->eye, frame->eye, sizeof s->eye) == 0) {
        *is_new = false;
        return FACET_OK;
    }
    memcpy(s->view_projection, frame->view_projection, sizeof s->view_projection);
    memcpy(s->eye, frame->eye, sizeof s->eye);
    if (put_in_order(s, frame, thread_count))
        return FACET_OK;
    clear(s);
    return fail_memory(error, "order of blended triangles", s->run_count * sizeof *s->runs);
}
