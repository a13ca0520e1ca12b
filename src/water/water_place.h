/* water_place.h - a point of the surface as one ray sees it, or several rays of a pixel together. */
#ifndef WATER_WATER_PLACE_H
#define WATER_WATER_PLACE_H

#include "water/water_setup.h"

/* A point of the surface as seen by an eye. */
typedef struct water_place {
    double P[3];         /* m */
    double rest[2];      /* rest position of the water, m */
    vec3 V;              /* unit, towards the eye, relative to the local sea level */
    float footprint_m;   /* across the ray */
    float pixel_m;       /* footprint of the whole pixel, for glints */
    water_slopes slopes; /* that the footprint does not resolve */
    WaterPoint point;    /* N faces V */
    float height_m;      /* of the waves */
    /* approximately N.V over waves of all lengths: foreshortening of the footprint on the water */
    float cosine;
} water_place;

/* Foam coverage of a footprint (m) at the rest position. */
float water_foam_at(const water_setup *s, const double rest[2], float footprint_m);

/* For a ray from above or below and its hit; footprint: the ray's width relative to a pixel. */
water_place water_place_of(const water_setup *s, const march_ray *ray, const march_hit *hit, float footprint);

/* Approximate intersection of a sample with the water. */
typedef struct water_sight {
    double direction[3]; /* of the ray, unit */
    profile_place place;
} water_sight;

/* For a ray from above through the center of all samples that hit one patch of water, as wide as all of them.
 * The slope is the mean over the samples, and their variance adds to the roughness. hit: t, X and Z of the
 * center, and width_m. */
water_place water_place_of_samples(const water_setup *s, const march_ray *ray,
                                   const water_sight *const *sights, uint32_t count, march_hit *hit);

#endif
