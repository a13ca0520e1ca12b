/* water_march.h - where a ray meets the sea.
 *
 * A ray is followed in steps that no wave is steep enough to be in: the height over the surface divided by how fast the ray and the steepest
 * wave can close it. Where it is far above all waves near by (water_crests.h), it goes on to where that ends. The surface is read as wide as
 * the ray is there, so far away it is smooth, and then flat.
 *
 * The Earth is round: seen from the eye, the sea falls away by r^2 / (2 R) at the distance r, and the ray is bent upwards by as much
 * instead. */
#ifndef WATER_WATER_MARCH_H
#define WATER_WATER_MARCH_H

#include "water/water_crests.h"

typedef struct water_march {
    const waves *waves;
    const slope_filter *slopes;
    double fall;       /* 1/m: 1 / (2 R); 0: the sea is a plane */
    float deviation_m; /* standard deviation of heights */
    water_crests crests;
} water_march;

/* Of waves that outlive it, at their time, for rays that begin near eye. FACET_ERROR_MEMORY. */
facet_result water_march_create(const waves *w, const slope_filter *slopes, const float eye[3], bool is_round,
                                const facet_allocator *allocator, water_march *out, facet_error *error);
void water_march_destroy(water_march *m); /* {0} is allowed */

/* origin + t direction, direction of unit length. What it stands for is width + t spread m wide across it. */
typedef struct march_ray {
    double origin[3], direction[3];
    double near_m, far_m;
    float width, spread;
    bool is_below; /* it begins in the water */
} march_ray;

typedef struct march_hit {
    double t;
    double X, Z;
    float width_m;         /* of the ray, across it */
    float footprint_m;     /* with which the surface was read */
    float displacement[2]; /* of the water there */
} march_hit;

/* Whether the ray meets the surface, and where first: within a twentieth of the footprint across the surface. */
bool water_march_find(const water_march *m, const march_ray *ray, march_hit *hit);

/* Height of the ray over still water at t, the Earth's curvature included, and how fast it rises. */
static inline double march_height(const water_march *m, const march_ray *ray, double t)
{
    double level2 = 1.0 - ray->direction[1] * ray->direction[1];
    return ray->origin[1] + t * (ray->direction[1] + t * level2 * m->fall);
}
static inline double march_rise(const water_march *m, const march_ray *ray, double t)
{
    double level2 = 1.0 - ray->direction[1] * ray->direction[1];
    return ray->direction[1] + 2.0 * t * level2 * m->fall;
}

#endif
