/* ray_trace.h - single rays: nearest hits, transmittance, all surfaces along a ray. */
#ifndef CPU_RAY_TRACE_H
#define CPU_RAY_TRACE_H

#include "cpu/surface_point.h"
#include "cpu/visibility.h"

/* Camera rays skip the culled sides of single-sided surfaces (ray_trace_is_visible_side()); all others hit
 * both sides: a wall that the camera looks through still blocks light, from either side. */

/* The first surface that a camera ray hits, or one of several alpha-blended ones in a row. */
typedef struct ray_first {
    float opacity;      /* [0, 1]: of all of them together, by alpha alone; 0: no hit */
    visibility_hit hit; /* one of them, sampled in proportion to its share of that opacity */
    uint32_t rays;
} ray_first;

/* u: uniform in [0, 1). */
ray_first ray_trace_first(const shading_scene *scene, const shading_ray *ray, float u);

/* The nearest surface, of either side. A surface of opacity a is hit with probability a, decided by
 * `random` and the triangle. Alpha is read at full resolution. */
bool ray_trace_nearest(const shading_scene *scene, const shading_ray *ray, uint32_t random,
                       visibility_hit *hit);

enum { RAY_CROSSINGS = 32 };

/* Transmissive surfaces along a ray, left to the caller. */
typedef struct ray_crossings {
    bool takes_all; /* all transmissive ones; else those that the plan lets light pass straight */
    bool is_cut;    /* there are more, farther away */
    uint32_t count;
    visibility_hit hits[RAY_CROSSINGS]; /* nearest first */
} ray_crossings;

/* Transmittance of alpha along the ray, [0, 1]. crossings: takes_all is set by the caller; gets the
 * surfaces that are not part of the result. NULL: none are left out. */
float ray_trace_transmittance(const shading_scene *scene, const shading_ray *ray, ray_crossings *crossings);

/* The same for light of a wide environment, of which glass lets a share pass without a change of direction: that is
 * nearly what lenses and bodies of glass do to it. */
float ray_trace_daylight(const shading_scene *scene, const shading_ray *ray);

/* ---- all surfaces along a ray ---- */

/* More than RAY_TRACE_LAYERS transparent surfaces in a row are of no practical use; the farther ones are
 * ignored. */
enum { RAY_TRACE_LAYERS = 64 };

/* Writes the hits of the ray, nearest first, and returns their number: surfaces with opacity between 0 and
 * 1, and behind them the nearest opaque one. Culled sides and masked texels are not among them. Hits at
 * the same distance are ordered by geometry and primitive; the result does not depend on the order in
 * which Embree finds them. */
uint32_t ray_trace_layers(const shading_scene *scene, const shading_ray *ray,
                          visibility_hit hits[RAY_TRACE_LAYERS + 1]);

/* ---- a hit ---- */

/* Whether the side that was hit is drawn: the front, or any of a double-sided surface. direction is the
 * ray's. */
bool ray_trace_is_visible_side(const shading_scene *scene, const visibility_hit *hit,
                               const float direction[3]);
/* Coverage of the surface at the hit, [0, 1]; MASK gives 0 or 1. Cheaper than a shade. */
float ray_trace_opacity(const shading_scene *scene, const shading_point *point);

/* ---- a ray ---- */

static inline ray_segment ray_trace_segment(const shading_ray *ray)
{
    return (ray_segment){.origin = {ray->origin[0], ray->origin[1], ray->origin[2]},
                         .direction = {ray->direction[0], ray->direction[1], ray->direction[2]},
                         .near_t = ray->near_t,
                         .far_t = ray->far_t};
}

#endif
