/* bounds.h - bounds of instances and of a pose, in world space. */
#ifndef SCENE_BOUNDS_H
#define SCENE_BOUNDS_H

#include "scene/box.h"

/* A box in world space around `local` of the instance, in double, with a margin for the rounding of
 * vertices. */
typedef struct wide_box {
    double minimum[3], maximum[3];
} wide_box;
wide_box box_enclose(const scene_instance *instance, const float local_min[3], const float local_max[3]);

/* Whether an instance is included in framing. */
static inline bool bounds_count(const scene_pose *pose, const scene_instance *instance)
{
    return !instance->is_unseen || pose->is_unseen;
}

/* Finds unseen instances and the bounds of the pose, and removes instances beyond SCENE_FARTHEST. The pose
 * has its materials. Fails with FACET_ERROR_MEMORY. */
facet_result bound_instances(const facet_scene *scene, scene_pose *pose, const facet_allocator *allocator,
                             uint32_t thread_count, facet_error *error);

#endif
