/* water_march.h - where a ray meets the sea.
 *
 * A ray is followed in steps that no wave is steep enough to be in: the height over the surface divided by how fast the ray and the
 * steepest wave can close it. The surface is read as wide as the ray is there, so far away it is smooth, and then flat. Many rays from one eye go
 * faster by water_profile.h.
 *
 * The Earth is round: seen from the eye, the sea falls away by r^2 / (2 R) at the distance r, and the ray is bent upwards by as much
 * instead. */
#ifndef WATER_WATER_MARCH_H
#define WATER_WATER_MARCH_H

#include "ocean/waves.h"

typedef struct water_march {
    const waves *waves;
    const slope_filter *slopes;
    double fall;       /* 1/m: 1 / (2 R); 0: the sea is a plane */
    float deviation_m; /* standard deviation of heights */
} water_march;

/* Of waves that outlive it, at their time. */
water_march water_march_of(const waves *w, const slope_filter *slopes, bool is_round);

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

/* Whether the ray meets the surface, and where first, to some hundredths of its width across it. */
bool water_march_find(const water_march *m, const march_ray *ray, march_hit *hit);

/* How wide the surface is read where a ray of width_m meets it that rises by `rise` over the level: as wide, until waves are not even a width high.
 * Then no longer they but their slopes are seen, and as much more of them at once as rays are flat: up to the ray's length on
 * still water. */
float water_march_footprint(const water_march *m, float width_m, double rise);

/* The hit at t; displacement: about that of the water there, {0, 0} where it is not known. *clearance: of the ray over the surface at t, which is
 * positive on the side that it comes from. */
march_hit water_march_hit_at(const water_march *m, const march_ray *ray, double t,
                             const float displacement[2], double *clearance);

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

/* Smallest t >= from at which the ray's height is height_m, coming from the side that it begins on; HUGE_VAL: never. */
double water_march_reach(const water_march *m, const march_ray *ray, double height_m, double from);

#endif
