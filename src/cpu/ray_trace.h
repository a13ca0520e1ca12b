/* ray_trace.h - single rays that go anywhere: what they meet, and whether something is in between. Holds shared shading
 * text: include it last. */
#ifndef CPU_RAY_TRACE_H
#define CPU_RAY_TRACE_H

#include "cpu/surface_point.h"

/* Rays of the camera do not meet the culled sides of single-sided surfaces (shading_is_visible_side()); all others meet
 * both sides of everything: a wall that the camera looks through still keeps light out, from either side. */

/* The surface that a ray of the camera meets, or one of those in a row that alpha lets it see. */
typedef struct ray_first {
    float opacity;      /* [0, 1]: of all of them together, by alpha alone; 0: none */
    visibility_hit hit; /* one of them, drawn with the probability of its share of that opacity */
    uint32_t rays;
} ray_first;

/* u: uniform in [0, 1). */
ray_first ray_trace_first(const shading_scene *scene, const shading_ray *ray, float u);

/* The nearest surface, of either side. One with opacity a is there with the probability a: random decides, other bits for
 * every triangle. Alpha is read at its finest. */
bool ray_trace_nearest(const shading_scene *scene, const shading_ray *ray, uint32_t random,
                       visibility_hit *hit);

/* The share of light that alpha lets pass along the ray, [0, 1]. */
float ray_trace_opening(const shading_scene *scene, const shading_ray *ray);

#endif
