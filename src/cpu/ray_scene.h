/* ray_scene.h - rays through a scene: one interface to the bounding volume hierarchies (BVH) of Embree and of facet. */
#ifndef CPU_RAY_SCENE_H
#define CPU_RAY_SCENE_H

#include "cpu/visibility_hit.h"
#include "draw/render_geometry.h"

/* Points origin + t direction with near_t <= t <= far_t. */
typedef struct ray_segment {
    float origin[3], direction[3]; /* m; direction of any length, the unit of t */
    float near_t, far_t;
} ray_segment;

/* Decides about a hit, whose geometry and normal are those of the scene: false, and the ray goes on. Hits come in any
 * order, those behind an accepted one only where they are found before it. */
typedef bool (*ray_filter)(void *context, const visibility_hit *hit);

/* What a BVH is built for. */
typedef struct ray_scene_desc {
    uint64_t
        ray_count; /* that its quality is worth; hits do not depend on it but where Embree's triangles touch */
    uint32_t thread_count;
    facet_isa isa; /* of Embree */
} ray_scene_desc;

struct visibility_pattern; /* cpu/visibility.h */

typedef enum facet_bvh {
    FACET_BVH_AUTO,   /* Embree's where it is installed, else facet's own */
    FACET_BVH_EMBREE, /* FACET_ERROR_SYSTEM where Embree is not installed, or facet was built without it */
    FACET_BVH_OWN     /* gives the same bytes on every x86-64 processor */
} facet_bvh;

/* The functions of a kind of BVH, which is what they get as bvh. */
typedef struct ray_tracer {
    /* For geometries that have their vertices and outlive the BVH. The result does not depend on thread_count. Fails with
     * FACET_ERROR_MEMORY, FACET_ERROR_LIMIT; Embree with FACET_ERROR_SYSTEM where it, or that instruction set, does not
     * run. */
    facet_result (*create)(const render_geometry_set *set, const ray_scene_desc *desc,
                           const facet_allocator *allocator, void **bvh, facet_error *error);
    /* Rebuilds what has changed in the set, which has replaced the last one at the same address. likeness: RENDER_SAME with
     * has_moved_sprites where only points and lines have moved. The result is that of create(). After a failure the BVH can
     * only be destroyed. */
    facet_result (*update)(void *bvh, const ray_scene_desc *desc, render_likeness likeness,
                           bool has_moved_sprites, facet_error *error);
    void (*destroy)(void *bvh);
    /* Of all geometries, m. */
    void (*bounds)(const void *bvh, float minimum[3], float maximum[3]);
    /* The nearest hit; one that the filter accepts. False: none. */
    bool (*nearest)(const void *bvh, const ray_segment *ray, visibility_hit *hit);
    bool (*nearest_filtered)(const void *bvh, const ray_segment *ray, ray_filter filter, void *context,
                             visibility_hit *hit);
    /* Whether there is a hit; one that the filter accepts. */
    bool (*occluded)(const void *bvh, const ray_segment *ray);
    bool (*occluded_filtered)(const void *bvh, const ray_segment *ray, ray_filter filter, void *context);
    /* visibility_trace_block() */
    void (*block)(const void *bvh, const camera_rays *camera, uint32_t x, uint32_t y,
                  const struct visibility_pattern *pattern, visibility_hit *hits);
} ray_tracer;

extern const ray_tracer bvh_tracer; /* bvh_scene.h */

/* Embree's: embree_trace.c. FACET_ERROR_SYSTEM: it is not installed, or this build is without it (embree_none.c). */
facet_result embree_find_tracer(const ray_tracer **out, facet_error *error);

/* The functions of a kind. Fails as embree_find_tracer() for FACET_BVH_EMBREE. */
facet_result ray_tracer_choose(facet_bvh kind, const ray_tracer **out, facet_error *error);

/* A BVH and its functions. {0}: none is built. */
typedef struct ray_scene {
    const ray_tracer *tracer;
    void *bvh;
} ray_scene;

static inline void ray_scene_destroy(ray_scene *scene) /* leaves {0}, which is allowed */
{
    if (scene->bvh)
        scene->tracer->destroy(scene->bvh);
    *scene = (ray_scene){0};
}

/* Converts the normal of a hit inside of an instance, which is in the instance's space, and its geometry. The normal matrix
 * keeps it outward; a mirrored instance's is negated to follow the winding. */
static inline void ray_leave_instance(const render_geometry_set *geometries, uint32_t instance,
                                      visibility_hit *hit)
{
    hit->geometry = instance;
    const render_geometry *g = &geometries->items[instance];
    const float *m = g->normal_matrix;
    const float sign = g->is_mirrored ? -1.0f : 1.0f;
    const float n[3] = {hit->normal[0] * sign, hit->normal[1] * sign, hit->normal[2] * sign};
    for (int i = 0; i < 3; i++)
        hit->normal[i] = m[3 * i] * n[0] + m[3 * i + 1] * n[1] + m[3 * i + 2] * n[2];
}

#endif
