/* bvh_items.h - from geometries to the trees of bvh_scene.h. */
#ifndef CPU_BVH_ITEMS_H
#define CPU_BVH_ITEMS_H

#include "cpu/bvh_scene.h"

/* A primitive whose triangles, lines or points become items. */
typedef struct bvh_source {
    const scene_primitive *primitive;
    const float *vertices; /* as render_geometry.vertices */
    uint32_t geometry;     /* of its items */
    size_t first;          /* number of its first item; set by these functions */
} bvh_source;

/* Sources are in the order of their geometries. What no ray can hit, since coordinates are not finite or beyond 1.8e18, is left
 * out. The results depend on the sources alone. Fail as bvh_tree_build(); *out is empty then. */
facet_result bvh_build_mesh(bvh_source *sources, uint32_t count, uint32_t thread_count,
                            const facet_allocator *allocator, bvh_mesh *out, facet_error *error);
facet_result bvh_build_sprites(bvh_source *sources, uint32_t count, uint32_t thread_count,
                               const facet_allocator *allocator, bvh_list *out, facet_error *error);
facet_result bvh_build_list(bvh_item *items, size_t count, uint32_t thread_count,
                            const facet_allocator *allocator, bvh_list *out, facet_error *error);

#endif
