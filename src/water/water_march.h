/* water_march.h - intersection of rays with the sea.
 *
 * A ray advances in steps that no wave is steep enough to be hit within: the height above the surface,
 * divided by the rate at which the ray and the steepest wave approach. The surface is filtered to the
 * ray's width, so that it gets smooth and finally flat with distance. water_profile.h is faster for many
 * rays from one eye.
 *
 * The Earth is round: seen from the eye, the sea drops by r^2 / (2 R) at the distance r; instead of the sea,
 * the ray is bent, upwards. */
#ifndef WATER_WATER_MARCH_H
#define WATER_WATER_MARCH_H

#include "ocean/waves.h"

typedef struct water_march {
    const waves *waves;
    const slope_filter *slopes;
    double fall;       /* 1/m: 1 / (2 R); 0: the sea is a plane */
    float deviation_m; /* standard deviation of heights */
} water_march;

/* Refers to w at its current time. */
water_march water_march_of(const waves *w, const slope_filter *slopes, bool is_round);

/* origin + t direction, direction of unit length. The ray is width + t spread m wide. */
typedef struct march_ray {
    double origin[3], direction[3];
    double near_m, far_m;
    float width, spread;
    bool is_below; /* starts in the water */
} march_ray;

typedef struct march_hit {
    double t;
    double X, Z;
    float width_m;         /* of the ray */
    float footprint_m;     /* of the surface lookup */
    float displacement[2]; /* of the water at the hit */
} march_hit;

/* Finds the first intersection beyond near_m from the side that the ray comes from, to within some hundredths of
 * the ray's width. */
bool water_march_find(const water_march *m, const march_ray *ray, march_hit *hit);

/* Footprint of the surface lookup where a ray of width_m that rises by `rise` hits it: that width, as long as
 * waves are higher than the ray is wide. Beyond, only their slopes are resolved, over a footprint that grows
 * for grazing rays, up to the ray's projected length on still water. */
float water_march_footprint(const water_march *m, float width_m, double rise);

/* The hit at t; displacement: an estimate of that of the water there, {0, 0} if unknown. *clearance:
 * height of the ray above the surface at t, positive on the side that it comes from. */
march_hit water_march_hit_at(const water_march *m, const march_ray *ray, double t,
                             const float displacement[2], double *clearance);

/* Height of the ray above still water at t, including the Earth's curvature, and its slope. */
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

/* Smallest t >= from at which the ray reaches height_m from the side that it starts on; HUGE_VAL: never. */
double water_march_reach(const water_march *m, const march_ray *ray, double height_m, double from);
/* Whether the ray starts behind still water at height_m: cut off by the near plane, or by that of parallel rays. */
bool water_march_is_cut(const water_march *m, const march_ray *ray, double height_m);

#endif
