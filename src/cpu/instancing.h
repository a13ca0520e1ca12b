/* instancing.h - which geometries of a pose are instanced in the BVH, and which are flattened into it. */
#ifndef CPU_INSTANCING_H
#define CPU_INSTANCING_H

#include "draw/render_geometry.h"

typedef struct instancing_desc {
    const facet_pose_desc *pose;
    uint64_t ray_count;   /* of the image: the cost of a slower BVH */
    bool is_within_reach; /* instancing_is_within_reach() */
} instancing_desc;

/* Whether rays of that camera, and from any surface of the pose, can be transformed into the space of
 * instances: Embree aborts the process for coordinates beyond 1.8e18. */
bool instancing_is_within_reach(const scene_pose *pose, const camera_rays *camera);

/* Chooses the roles of the set's geometries, and creates the shapes of those that are instanced. Depends
 * on the arguments alone: images are the same whether data was kept from the last image or not. Fails with
 * FACET_ERROR_MEMORY. */
facet_result instancing_choose(const facet_scene *scene, const scene_pose *pose, const instancing_desc *desc,
                               const facet_allocator *allocator, render_geometry_set *set,
                               facet_error *error);

/* Enough to cover the relevant pixels, also where some are occluded or face away. */
enum { NEAREST_COPIES = 64 };

/* Sets is_far_copy of instances of shapes that more than NEAREST_COPIES share: of those in the image of
 * width x height pixels, the NEAREST_COPIES that are seen largest keep it unset, at least one. Counting
 * the triangles of 100 000 copies would take seconds for the same result. Fails with FACET_ERROR_MEMORY. */
facet_result nearest_copies_choose(render_geometry_set *set, const camera_rays *camera, uint32_t width,
                                   uint32_t height, const facet_allocator *allocator, facet_error *error);

#endif
