/* instancing.h - what of a pose is instanced in the bounding volume hierarchy, and what is flattened into it. */
#ifndef CPU_INSTANCING_H
#define CPU_INSTANCING_H

#include "draw/render_geometry.h"

typedef struct instancing_desc {
    const facet_pose_desc *pose;
    uint64_t ray_count;   /* of the picture: what a hierarchy that is traversed more slowly costs */
    bool is_within_reach; /* instancing_is_within_reach() */
} instancing_desc;

/* Whether rays of that camera, and from any surface of the pose, can be turned into the space of instances: Embree ends
 * the process for coordinates beyond 1.8e18. */
bool instancing_is_within_reach(const scene_pose *pose, const camera_rays *camera);

/* Chooses the roles of the set's geometries, and makes the shapes of those that are instanced. Depends on nothing but
 * the arguments: pictures are the same whether something was kept from the picture before or not. Fails with
 * FACET_ERROR_MEMORY. */
facet_result instancing_choose(const facet_scene *scene, const scene_pose *pose, const instancing_desc *desc,
                               const facet_allocator *allocator, render_geometry_set *set,
                               facet_error *error);

/* Enough to cover the pixels that count, also where some are hidden or turned away. */
enum { NEAREST_COPIES = 64 };

/* Sets is_far_copy of instances of shapes that more than NEAREST_COPIES share: of those in the picture of
 * width x height pixels, that many whose surface is seen largest stay, at least one. Counting the triangles of 100 000 copies takes
 * seconds, and says no more. Fails with FACET_ERROR_MEMORY. */
facet_result nearest_copies_choose(render_geometry_set *set, const camera_rays *camera, uint32_t width,
                                   uint32_t height, const facet_allocator *allocator, facet_error *error);

#endif
