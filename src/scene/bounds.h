/* bounds.h - axis-aligned boxes around vertices. */
#ifndef SCENE_BOUNDS_H
#define SCENE_BOUNDS_H

#include "scene/scene.h"

typedef struct box {
    float minimum[3], maximum[3];
} box;

box box_empty(void); /* minimum above maximum */
static inline void box_add(box *b, const float p[3])
{
    for (int axis = 0; axis < 3; axis++) {
        b->minimum[axis] = p[axis] < b->minimum[axis] ? p[axis] : b->minimum[axis];
        b->maximum[axis] = p[axis] > b->maximum[axis] ? p[axis] : b->maximum[axis];
    }
}
void box_join(box *b, const box *other);
bool box_is_near(const box *b); /* all of it within SCENE_FARTHEST; false where it is empty */

/* Finds the world bounds of the pose's instances, exactly, and drops those that leave the space where floats can be
 * squared. Fails with FACET_ERROR_MEMORY. */
facet_result bound_instances(scene_pose *pose, const facet_allocator *allocator, uint32_t thread_count,
                             facet_error *error);

#endif
