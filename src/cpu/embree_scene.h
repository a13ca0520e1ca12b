/* embree_scene.h - the bounding volume hierarchy (BVH) of a scene. */
#ifndef CPU_EMBREE_SCENE_H
#define CPU_EMBREE_SCENE_H

#include <stdatomic.h>

#include "cpu/embree.h"
#include "cpu/embree_version.h"
#include "draw/render_geometry.h"

/* Embree's own memory, counted against the budget of the allocator where there is one. */
typedef struct embree_memory {
    facet_allocator allocator;
    _Atomic ptrdiff_t used;
} embree_memory;

/* Triangles that are instanced in the traced scene, in a scene of their own. */
typedef struct embree_part {
    RTCScene scene; /* NULL: not built */
    enum RTCBuildQuality quality;
} embree_part;

/* Stays where it is between create and destroy: Embree keeps its address. */
typedef struct embree_scene {
    RTCDevice device;
    RTCScene scene;
    enum RTCBuildQuality quality;          /* of scene */
    const render_geometry_set *geometries; /* which hits index */
    embree_part still, *shapes;            /* of RENDER_STILL; per shape of the set */
    uint32_t shape_count;
    bool has_instances;
    ptrdiff_t object_bytes; /* counted for Embree's own objects */
    uint32_t packet_width;  /* 16, 8 or 4: rays that this machine traces at once */
    embree_memory memory;
} embree_scene;

/* The index of the instance that holds all of RENDER_STILL; hits inside of it have indices of their own. */
static inline uint32_t embree_still_number(const render_geometry_set *set)
{
    return set->count;
}

/* Builds the BVH of the geometries, which have their vertices and outlive it, with the quality that
 * ray_count rays are worth. It does not depend on thread_count. Fails with FACET_ERROR_MEMORY,
 * FACET_ERROR_SYSTEM where Embree, or that instruction set of it, does not run. */
facet_result embree_scene_create(const render_geometry_set *set, const facet_allocator *allocator,
                                 uint64_t ray_count, uint32_t thread_count, facet_isa isa, embree_scene *out,
                                 facet_error *error);
/* Rebuilds what has changed in the set, which has replaced the last one at the same address. likeness:
 * RENDER_SAME with has_moved_sprites where only points and lines have moved. The result is that of
 * embree_scene_create(). On failure the scene is empty: as after embree_scene_destroy(). */
facet_result embree_scene_update(embree_scene *scene, render_likeness likeness, bool has_moved_sprites,
                                 uint64_t ray_count, facet_error *error);
void embree_scene_destroy(embree_scene *scene); /* {0} is allowed */

#endif
