/* bounds.c - see bounds.h. */
#include "scene/bounds.h"

#include <math.h>

#include "base/parallel.h"
#include "base/result.h"

enum {
    BOUNDS_GRAIN = 1 << 15, /* indices that one thread takes at once */
    FEW_INDICES = 24        /* as quick to go through as the box around them */
};

/* Whether each world axis depends on one local axis only. Then the transform is monotone along each axis, and the
 * box of the transformed vertices is the transformed box, to the last bit. */
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

/* Whether the box of an instance cannot widen b, judged by the box around its corners. The margin covers the rounding
 * of vertices and corners. Most instances of a scene of many are inside. */
static bool is_inside(const scene_instance *instance, const box *b)
{
    const float *m = instance->world.m;
    for (int row = 0; row < 3; row++) {
        double middle = (double)m[12 + row];
        double half = 0.0;
        double size = fabs(middle);
        for (int k = 0; k < 3; k++) {
            double factor = (double)m[4 * k + row];
            double low = (double)instance->bounds_min[k];
            double high = (double)instance->bounds_max[k];
            middle += factor * 0.5 * (low + high);
            half += fabs(factor) * 0.5 * (high - low);
            size += fabs(factor) * fmax(fabs(low), fabs(high));
        }
        half += 1e-6 * size;
        if (!(middle - half >= (double)b->minimum[row] && middle + half <= (double)b->maximum[row]))
            return false;
    }
    return true;
}

typedef struct bounds_job {
    const scene_instance *instance;
    box *boxes; /* one per BOUNDS_GRAIN indices */
} bounds_job;

static void bounds_body(void *context, size_t begin, size_t end)
{
    const bounds_job *job = context;
    const scene_primitive *primitive = job->instance->primitive;
    box b = box_empty();
    for (size_t i = begin; i < end; i++) {
        float p[3];
        mat4_transform_point(&job->instance->world,
                             job->instance->positions + 3 * (size_t)primitive->indices[i], p);
        box_add(&b, p);
    }
    job->boxes[begin / BOUNDS_GRAIN] = b;
}

/* World bounds of one instance; exact. boxes has room for the largest primitive. */
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

facet_result bound_instances(scene_pose *pose, const facet_allocator *allocator, uint32_t thread_count,
                             facet_error *error)
{
    size_t most = 0;
    for (uint32_t i = 0; i < pose->instance_count; i++)
        if (pose->instances[i].primitive->index_count > most)
            most = pose->instances[i].primitive->index_count;
    size_t box_count = most / BOUNDS_GRAIN + 1;
    box *boxes = mem_alloc(allocator, box_count, sizeof *boxes);
    if (!boxes)
        return fail_memory(error, "bounds", box_count * sizeof *boxes);
    box all = box_empty();
    uint32_t kept = 0;
    for (uint32_t i = 0; i < pose->instance_count; i++) {
        bool is_small = pose->instances[i].primitive->index_count <= FEW_INDICES;
        if (is_small || !is_inside(&pose->instances[i], &all)) {
            box b = instance_bounds(&pose->instances[i], boxes, thread_count);
            if (!box_is_near(&b))
                continue;
            box_join(&all, &b);
        }
        if (kept != i)
            pose->instances[kept] = pose->instances[i];
        kept++;
    }
    mem_free(boxes);
    pose->instance_count = kept;
    pose->has_bounds = kept > 0;
    for (int axis = 0; axis < 3; axis++) {
        pose->bounds_min[axis] = kept ? all.minimum[axis] : 0.0f;
        pose->bounds_max[axis] = kept ? all.maximum[axis] : 0.0f;
    }
    return FACET_OK;
}
