/* embree_scene.h - the bounding volume hierarchy over what is drawn. */
#ifndef CPU_EMBREE_SCENE_H
#define CPU_EMBREE_SCENE_H

#include <stdatomic.h>

#include "cpu/embree.h"
#include "cpu/render_geometry.h"

/* Embree's own memory, counted against the budget of the allocator where there is one. */
typedef struct embree_memory {
    facet_allocator allocator;
    _Atomic ptrdiff_t used;
} embree_memory;

/* Stays where it is between create and destroy: Embree keeps its address. */
typedef struct embree_scene {
    RTCDevice device;
    RTCScene scene;
    uint32_t packet_width; /* 16, 8 or 4: what this machine traces at once */
    embree_memory memory;
} embree_scene;

/* Builds over the geometries, which have their vertices and outlive it, as well as ray_count rays are worth it. The
 * hierarchy does not depend on thread_count. Fails with FACET_ERROR_MEMORY, FACET_ERROR_ENVIRONMENT where Embree does not run. */
facet_result embree_scene_create(const render_geometry_set *set, const facet_allocator *allocator,
                                 uint64_t ray_count, uint32_t thread_count, embree_scene *out,
                                 facet_error *error);
void embree_scene_destroy(embree_scene *scene); /* {0} is allowed */

#endif
