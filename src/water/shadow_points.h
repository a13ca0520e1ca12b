/* shadow_points.h - sample points for a model's shadow: over the area of a grid point, and over the sun's
 * disc. All points of a grid share them, so that the shadow of a straight edge depends only on the
 * distance from the edge: neither the grid nor noise shows. */
#ifndef WATER_SHADOW_POINTS_H
#define WATER_SHADOW_POINTS_H

#include "shade/shade.h"

/* The first few detect an edge; all of them measure the visibility there. */
enum { SHADOW_POINTS = 64 };

typedef struct shadow_point {
    float aside[2]; /* in grid steps, (-1, 1), distributed as a tent: overlapping tents sum to a constant */
    vec3 L;         /* towards a point of the sun's disc, unit */
} shadow_point;

/* Coordinate `axis` < 4 of point i beside the two of `aside`, in (0, 1): the last four of six powers of
 * the root of x^7 = x + 1. Roberts 2018, "The unreasonable effectiveness of quasirandom sequences". */
static inline float shadow_point_coordinate(uint i, uint axis)
{
    static const float steps[4] = {0.725735f, 0.652185f, 0.586090f, 0.526694f};
    return clamp(fract(0.5f + (float)i * steps[axis]), 1e-4f, 1.0f - 1e-4f);
}

static inline float shadow_tent(float u)
{
    return u < 0.5f ? sqrt(2.0f * u) - 1.0f : 1.0f - sqrt(2.0f - 2.0f * u);
}

/* L: towards the sun's center. Coordinates 0 and 1 sample the disc. */
static inline shadow_point shadow_point_at(uint i, vec3 L)
{
    uint turn = i * 25u % SHADOW_POINTS; /* spreads the first few, too */
    vec2 u = hammersley(turn, SHADOW_POINTS) + 0.5f / (float)SHADOW_POINTS;
    float r = SUN_RADIUS * sqrt(shadow_point_coordinate(i, 0)),
          phi = 2.0f * PI * shadow_point_coordinate(i, 1);
    return (shadow_point){.aside = {shadow_tent(u[0]), shadow_tent(u[1])},
                          .L = normalize(mul(basis_from_normal(L), vec3(r * cos(phi), r * sin(phi), 1.0f)))};
}

#endif
