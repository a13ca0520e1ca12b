/* corner_slopes.h - the normals by which a triangle refracts, at its corners.
 *
 * Smooth normals are often wrong: a modeled rim averages them over its sharp edge. On an arc from a to b the
 * normals lean by the same angle at both ends. So along each edge the slopes of the two normals against the
 * triangle are replaced by one, of opposite sign at the ends: the smaller of the two, or 0 where they disagree
 * in sign (the minmod limiter, Roe 1986). Normals of smooth surfaces are unchanged; those that lean towards a
 * sharp edge are straightened. */
#ifndef DRAW_CORNER_SLOPES_H
#define DRAW_CORNER_SLOPES_H

#include "shade/shade.h"

/* Cosine at which the lean of a normal from the triangle is clamped. */
#define CORNER_MIN_COS 0.2f

static inline float corner_slope_limit(float a, float b)
{
    if (!(a * b > 0.0f))
        return 0.0f;
    return abs(a) < abs(b) ? a : b;
}

/* The vector in the plane of the triangle whose dot products with e and f are a and b. */
static inline vec3 corner_slope_solve(vec3 e, vec3 f, float a, float b)
{
    float ee = dot(e, e);
    float ef = dot(e, f);
    float ff = dot(f, f);
    float determinant = ee * ff - ef * ef;
    if (!(determinant > 1e-12f * ee * ff))
        return vec3(0.0f);
    return e * ((a * ff - b * ef) / determinant) + f * ((b * ee - a * ef) / determinant);
}

/* Limited slopes at the corners p with unit normals n, in the plane of the triangle, whose unit normal is Ng:
 * the normal at a corner is parallel to Ng + slope. */
static inline void corner_slopes(const vec3 p[3], const vec3 n[3], vec3 Ng, vec3 slopes[3])
{
    vec3 lean[3];
    float along[3]; /* of the edge from i to i + 1 */
    for (int i = 0; i < 3; i++) {
        float cos_n = dot(n[i], Ng);
        lean[i] = (n[i] - Ng * cos_n) * (1.0f / max(cos_n, CORNER_MIN_COS));
    }
    for (int i = 0; i < 3; i++) {
        int k = (i + 1) % 3;
        vec3 edge = p[k] - p[i];
        along[i] = corner_slope_limit(-dot(lean[i], edge), dot(lean[k], edge));
    }
    for (int i = 0; i < 3; i++) {
        int next = (i + 1) % 3;
        int last = (i + 2) % 3;
        slopes[i] = corner_slope_solve(p[next] - p[i], p[last] - p[i], -along[i], -along[last]);
    }
}

#endif
