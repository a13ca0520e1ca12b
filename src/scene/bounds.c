/* bounds.c - see bounds.h. */
#include "scene/bounds.h"

#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "base/result.h"
#include "scene/unseen.h"
#include "scene/vertex_tree.h"

enum {
    BOUNDS_GRAIN = 1 << 15, /* indices per work item */
    FEW_INDICES = 24        /* examining them is as fast as the box around them */
};

/* Whether each world axis depends on one local axis only. Then the transform is monotone along each axis,
 * and the box of the transformed vertices equals the transformed box, to the last bit. */
static bool keeps_boxes(const mat4 *m)
{
    for (int row = 0; row < 3; row++) {
        int used = 0;
        for (int column = 0; column < 3; column++)
            used += m->m[4 * column + row] != 0.0f;
        if (used > 1)
            return false;
    }
    return true;
}

wide_box box_enclose(const scene_instance *instance, const float local_min[3], const float local_max[3])
{
    const float *m = instance->world.m;
    wide_box out;
    for (int row = 0; row < 3; row++) {
        double middle = (double)m[12 + row];
        double half = 0.0;
        double size = fabs(middle);
        for (int k = 0; k < 3; k++) {
            double factor = (double)m[4 * k + row];
            double low = (double)local_min[k];
            double high = (double)local_max[k];
            middle += factor * 0.5 * (low + high);
            half += fabs(factor) * 0.5 * (high - low);
            size += fabs(factor) * (fabs(low) > fabs(high) ? fabs(low) : fabs(high));
        }
        half += 1e-6 * size;
        out.minimum[row] = middle - half;
        out.maximum[row] = middle + half;
    }
    return out;
}

/* How far the contents of a box of an instance may reach out of b. In scenes of many instances most are
 * inside. */
static double excess(const scene_instance *instance, const box *local, const box *b)
{
    wide_box w = box_enclose(instance, local->minimum, local->maximum);
    double most = 0.0;
    for (int row = 0; row < 3; row++) {
        double below = (double)b->minimum[row] - w.minimum[row];
        double above = w.maximum[row] - (double)b->maximum[row];
        most = below > most ? below : most;
        most = above > most ? above : most;
    }
    return most;
}

static box local_box(const scene_instance *instance)
{
    box b;
    memcpy(b.minimum, instance->bounds_min, sizeof b.minimum);
    memcpy(b.maximum, instance->bounds_max, sizeof b.maximum);
    return b;
}

/* Whether all of an instance is within SCENE_FARTHEST by its box alone. */
static bool is_clearly_near(const scene_instance *instance)
{
    wide_box w = box_enclose(instance, instance->bounds_min, instance->bounds_max);
    for (int row = 0; row < 3; row++)
        if (!(w.minimum[row] > -0.99 * (double)SCENE_FARTHEST &&
              w.maximum[row] < 0.99 * (double)SCENE_FARTHEST))
            return false;
    return true;
}

/* ---- in full ---- */

typedef struct bounds_job {
    const scene_instance *instance;
    box *boxes; /* one per work item */
} bounds_job;

static void bounds_body(void *context, size_t begin, size_t end)
{
    const bounds_job *job = context;
    const scene_primitive *primitive = job->instance->primitive;
    box b = box_empty();
    for (size_t i = begin; i < end; i++) {
        float p[3];
        if (primitive->has_flat_triangles &&
            unseen_is_flat(job->instance->positions, primitive->indices + i / 3 * 3))
            continue;
        mat4_transform_point(&job->instance->world,
                             job->instance->positions + 3 * (size_t)primitive->indices[i], p);
        box_add(&b, p);
    }
    job->boxes[begin / BOUNDS_GRAIN] = b;
}

/* World bounds of one instance, exact. boxes has room for the largest primitive. */
static box instance_bounds(const scene_instance *instance, box *boxes, uint32_t thread_count)
{
    box b = box_empty();
    if (keeps_boxes(&instance->world)) {
        float p[3];
        mat4_transform_point(&instance->world, instance->bounds_min, p);
        box_add(&b, p);
        mat4_transform_point(&instance->world, instance->bounds_max, p);
        box_add(&b, p);
        return b;
    }
    size_t count = instance->primitive->index_count;
    bounds_job job = {.instance = instance, .boxes = boxes};
    parallel_for(thread_count, count, BOUNDS_GRAIN, bounds_body, &job);
    for (size_t i = 0; i < (count + BOUNDS_GRAIN - 1) / BOUNDS_GRAIN; i++)
        box_join(&b, &boxes[i]);
    return b;
}

/* ---- by branch and bound ---- */

typedef struct bounds_search {
    const scene_instance *instance;
    box *all;
} bounds_search;

static double gain(void *context, const box *local)
{
    const bounds_search *s = context;
    return excess(s->instance, local, s->all);
}

typedef float float4 __attribute__((vector_size(16)));
typedef int32_t mask4 __attribute__((vector_size(16)));

/* Widens row `row` of b by all vertices, to the last bit as mat4_transform_point() computes it. */
static void widen_row(const float *m, int row, const vertex_block *blocks, uint32_t count, box *b)
{
    const float4 zero = {0.0f};
    float4 low = zero + b->minimum[row];
    float4 high = zero + b->maximum[row];
    for (uint32_t k = 0; k < count; k++) {
        float4 xyz[3];
        memcpy(xyz, blocks[k].xyz, sizeof xyz);
        float4 p = m[row] * xyz[0] + m[4 + row] * xyz[1] + m[8 + row] * xyz[2] + m[12 + row];
        mask4 is_lower = p<low, is_higher = p> high;
        low = (float4)((is_lower & (mask4)p) | (~is_lower & (mask4)low));
        high = (float4)((is_higher & (mask4)p) | (~is_higher & (mask4)high));
    }
    for (int i = 0; i < VERTEX_LANES; i++) {
        b->minimum[row] = low[i] < b->minimum[row] ? low[i] : b->minimum[row];
        b->maximum[row] = high[i] > b->maximum[row] ? high[i] : b->maximum[row];
    }
}

static void widen(void *context, const vertex_block *blocks, uint32_t count)
{
    const bounds_search *s = context;
    for (int row = 0; row < 3; row++)
        widen_row(s->instance->world.m, row, blocks, count, s->all);
}

/* ---- a pose ---- */

typedef struct bounds_run {
    vertex_trees trees;
    box *boxes; /* room for instance_bounds() of any instance */
    uint32_t thread_count;
} bounds_run;

/* Widens all by an instance. False: the instance is out of range. */
static bool add_instance(bounds_run *run, const scene_instance *instance, box *all)
{
    const box local = local_box(instance);
    bool is_small = instance->primitive->index_count <= FEW_INDICES;
    if (!is_small && !(excess(instance, &local, all) > 0.0))
        return true;
    bool is_exact = keeps_boxes(&instance->world);
    const vertex_tree *tree =
        is_exact || !is_clearly_near(instance) ? NULL : vertex_trees_get(&run->trees, instance);
    if (tree) {
        bounds_search search = {instance, all};
        vertex_tree_visit(tree, &(vertex_visitor){&search, gain, widen});
        return true;
    }
    box b = instance_bounds(instance, run->boxes, run->thread_count);
    if (!box_is_near(&b))
        return false;
    box_join(all, &b);
    return true;
}

static box *make_boxes(const scene_pose *pose, const facet_allocator *allocator, facet_error *error)
{
    size_t most = 0;
    for (uint32_t i = 0; i < pose->instance_count; i++)
        if (pose->instances[i].primitive->index_count > most)
            most = pose->instances[i].primitive->index_count;
    box *boxes = mem_alloc(allocator, most / BOUNDS_GRAIN + 1, sizeof *boxes);
    if (!boxes)
        fail_memory(error, "bounds", (most / BOUNDS_GRAIN + 1) * sizeof *boxes);
    return boxes;
}

/* The box around the visible instances, or around all if none is visible. Removes instances out of range. */
static box bound(bounds_run *run, scene_pose *pose, bool of_unseen)
{
    box all = box_empty();
    uint32_t kept = 0;
    for (uint32_t i = 0; i < pose->instance_count; i++) {
        const scene_instance *instance = &pose->instances[i];
        bool counts = instance->is_unseen == of_unseen;
        box ignored = box_empty();
        if (counts ? !add_instance(run, instance, &all)
                   : !is_clearly_near(instance) && !add_instance(run, instance, &ignored))
            continue;
        if (kept != i)
            pose->instances[kept] = pose->instances[i];
        kept++;
    }
    pose->instance_count = kept;
    return all;
}

static void find_unseen(const facet_scene *scene, scene_pose *pose)
{
    for (uint32_t i = 0; i < pose->instance_count; i++) {
        scene_instance *instance = &pose->instances[i];
        const scene_instance *before = i ? instance - 1 : NULL;
        if (before && before->primitive == instance->primitive && before->material == instance->material)
            instance->is_unseen = before->is_unseen;
        else
            instance->is_unseen =
                instance->primitive->is_flat ||
                unseen_is_transparent(instance->primitive, scene_pose_material(scene, pose, instance));
    }
}

facet_result bound_instances(const facet_scene *scene, scene_pose *pose, const facet_allocator *allocator,
                             uint32_t thread_count, facet_error *error)
{
    bounds_run run = {.trees = {.scene = scene, .allocator = allocator},
                      .boxes = make_boxes(pose, allocator, error),
                      .thread_count = thread_count};
    if (!run.boxes)
        return FACET_ERROR_MEMORY;
    find_unseen(scene, pose);
    box all = bound(&run, pose, false);
    pose->is_unseen = pose->instance_count && box_is_empty(&all);
    if (pose->is_unseen)
        all = bound(&run, pose, true);
    vertex_trees_destroy(&run.trees);
    mem_free(run.boxes);
    pose->has_bounds = pose->instance_count > 0;
    for (int axis = 0; axis < 3; axis++) {
        pose->bounds_min[axis] = pose->has_bounds ? all.minimum[axis] : 0.0f;
        pose->bounds_max[axis] = pose->has_bounds ? all.maximum[axis] : 0.0f;
    }
    return FACET_OK;
}
