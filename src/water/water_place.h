/* water_place.h - a place of the surface: what one ray sees of it, or some that share a pixel. */
#ifndef WATER_WATER_PLACE_H
#define WATER_WATER_PLACE_H

#include "water/water_setup.h"

/* A place of the surface as an eye sees it. */
typedef struct water_place {
    double P[3];         /* m */
    double rest[2];      /* of the water there, m */
    vec3 V;              /* unit, to the eye, against the level of the sea there */
    float footprint_m;   /* across the ray */
    float pixel_m;       /* of all samples of the pixel; so wide are glints */
    water_slopes slopes; /* beyond the footprint */
    WaterPoint point;    /* N faces V */
    float height_m;      /* of the waves */
    /* about N.V, waves of all lengths considered: how much longer the footprint is on the water */
    float cosine;
} water_place;

/* Share of a footprint (m) that foam hides; of water that rests at (x, z). */
float water_foam_at(const water_setup *s, const double rest[2], float footprint_m);

/* Of a ray (from above or below) and its hit. */
water_place water_place_of(const water_setup *s, const march_ray *ray, const march_hit *hit);

/* Where a sample meets the water, about. */
typedef struct water_sight {
    double direction[3]; /* of its ray, unit */
    profile_place place;
} water_sight;

/* Of a ray from above through the middle of all samples that meet one piece of water, as wide as they are together. Its slope is the mean of those
 * that samples see, and by as much as these differ it is rougher. hit: t, X and Z of their middle, and width_m. */
water_place water_place_of_samples(const water_setup *s, const march_ray *ray,
                                   const water_sight *const *sights, uint32_t count, march_hit *hit);

#endif
