/* ray_trace.h - single rays that go anywhere: what they meet, and whether something is in between. Holds shared shading
 * text: include it last. */
#ifndef CPU_RAY_TRACE_H
#define CPU_RAY_TRACE_H

#include "cpu/media.h"
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

enum { RAY_CROSSINGS = 32 };

/* Surfaces on a ray whose say in what passes is the caller's. */
typedef struct ray_crossings {
    bool takes_all; /* all that transmit; else those of which the plan says that light may go straight on */
    bool is_cut;    /* there are more, farther away */
    uint32_t count;
    visibility_hit hits[RAY_CROSSINGS]; /* nearest first */
} ray_crossings;

/* The share of light that alpha lets pass along the ray, [0, 1]. crossings: comes with takes_all set, and gets the
 * surfaces that are left out of that share; NULL: none are. */
float ray_trace_opening(const shading_scene *scene, const shading_ray *ray, ray_crossings *crossings);

/* Enters the bodies that P is in, the outermost first as far as that can be told: those that are left more often than
 * entered on the way out, whichever way that is. Returns the number of rays. */
uint32_t ray_trace_media_at(const shading_scene *scene, const float P[3], media *m);

#endif
