/* bounds.h - axis-aligned boxes around vertices. */
#ifndef SCENE_BOUNDS_H
#define SCENE_BOUNDS_H

#include <float.h>
#include <math.h>

#include "scene/scene.h"

typedef struct box {
    float minimum[3], maximum[3];
} box;

/* Minimum above maximum: what is added is the box. */
static inline box box_empty(void)
{
    return (box){{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};
}
static inline void box_add(box *b, const float p[3])
{
    for (int axis = 0; axis < 3; axis++) {
        b->minimum[axis] = p[axis] < b->minimum[axis] ? p[axis] : b->minimum[axis];
        b->maximum[axis] = p[axis] > b->maximum[axis] ? p[axis] : b->maximum[axis];
    }
}
static inline void box_join(box *b, const box *other)
{
    box_add(b, other->minimum);
    box_add(b, other->maximum);
}
/* Whether all of it is within SCENE_FARTHEST; an empty one is not. */
static inline bool box_is_near(const box *b)
{
    for (int axis = 0; axis < 3; axis++)
        if (!(fabsf(b->minimum[axis]) <= SCENE_FARTHEST && fabsf(b->maximum[axis]) <= SCENE_FARTHEST))
            return false;
    return true;
}

/* Finds the world bounds of the pose's instances, exactly, and drops those that leave the space where floats can be
 * squared. Fails with FACET_ERROR_MEMORY. */
facet_result bound_instances(scene_pose *pose, const facet_allocator *allocator, uint32_t thread_count,
                             facet_error *error);

#endif
