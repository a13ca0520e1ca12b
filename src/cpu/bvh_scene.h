/* bvh_scene.h - facet's own bounding volume hierarchy (BVH) of a scene: what embree_scene.h does where Embree is missing.
 *
 * Hits at equal distances are ordered by geometry and primitive, so that the nearest one depends neither on the tree nor on
 * the number of threads; nor does it depend on the machine. */
#ifndef CPU_BVH_SCENE_H
#define CPU_BVH_SCENE_H

#include "cpu/bvh4.h"
#include "cpu/ray_scene.h"

/* Triangles in one space. */
typedef struct bvh_mesh {
    bvh4 tree;
    bvh4_triangles *blocks; /* per leaf */
} bvh_mesh;

/* Items that are not triangles: lines and points, or instances. */
typedef struct bvh_list {
    bvh4 tree;
    bvh4_others *blocks; /* per leaf */
} bvh_list;

/* Where an instance is: rows of the matrix from world space to that of its shape. */
typedef struct bvh_instance {
    float to_object[12];
} bvh_instance;

typedef struct bvh_scene {
    facet_allocator allocator;
    const render_geometry_set *geometries;
    bvh_mesh flat, still, *shapes; /* of RENDER_FLAT, RENDER_STILL; per shape of the set */
    bvh_list sprites, instances;
    bvh_instance *places; /* per geometry; NULL: no instances */
    uint32_t shape_count;
    bool has_still;      /* still is built */
    uint8_t *has_shapes; /* shapes that are built */
} bvh_scene;

/* ---- rays: bvh_trace.c ---- */

bool bvh_nearest(const bvh_scene *scene, const ray_segment *ray, visibility_hit *hit);
bool bvh_nearest_filtered(const bvh_scene *scene, const ray_segment *ray, ray_filter filter, void *context,
                          visibility_hit *hit);
bool bvh_occluded(const bvh_scene *scene, const ray_segment *ray);
bool bvh_occluded_filtered(const bvh_scene *scene, const ray_segment *ray, ray_filter filter, void *context);

#endif
