/* octahedron.h - octahedral images: the sphere on the faces of an octahedron, unfolded into a square
 * (Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit Vectors").
 *
 * Position (u, v), both in [-1, 1], v downwards. Where |u| + |v| <= 1 it is the direction of (u, 1 - |u| -
 * |v|, v), the upper half with +X to the right and +Z below, as the face +Y of a cube map has it; the
 * lower half is folded outwards over the diagonals, -Y in the corners. A small area du dv is seen under
 * the solid angle du dv / |p|^3, p the point of the octahedron. */
#ifndef IBL_OCTAHEDRON_H
#define IBL_OCTAHEDRON_H

#include <math.h>

#include "facet/facet.h"

/* The point of (u, v): |x| + |y| + |z| is 1. */
static inline void octahedron_direction(float u, float v, float p[3])
{
    float y = 1.0f - fabsf(u) - fabsf(v);
    float fold =
        y < 0.0f ? -y : 0.0f; /* lower half: folded inside by as much as it is outside of the diagonal */
    p[0] = u - copysignf(fold, u);
    p[1] = y;
    p[2] = v - copysignf(fold, v);
}

/* Solid angle, sr, of the square of edge step centered at (u, v), to second order in step. The folds may cut
 * it only from corner to corner, where it is split in two. */
static inline float octahedron_solid_angle(float u, float v, float step)
{
    float sum = 0.0f;
    for (int i = 0; i < 2; i++) {
        float aside = i ? step / 6.0f : step / -6.0f; /* offset of a half's centroid */
        float p[3];
        octahedron_direction(u + copysignf(aside, u * aside), v + copysignf(aside, v * aside), p);
        float q = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
        sum += 0.5f * step * step / (q * sqrtf(q));
    }
    return sum;
}

/* Position of direction d (any length but 0). */
static inline void octahedron_locate(const float d[3], float uv[2])
{
    float scale = 1.0f / (fabsf(d[0]) + fabsf(d[1]) + fabsf(d[2]));
    float u = d[0] * scale;
    float v = d[2] * scale;
    bool is_lower = d[1] < 0.0f;
    uv[0] = is_lower ? copysignf(1.0f - fabsf(v), u) : u;
    uv[1] = is_lower ? copysignf(1.0f - fabsf(u), v) : v;
}

/* Index of texel (x, y), both in [-1, n], of an image of n x n: outside of an edge lies the same edge,
 * rotated around its center. */
static inline size_t octahedron_texel(uint32_t n, int x, int y)
{
    int last = (int)n - 1;
    if (x < 0 || x > last) {
        x = x < 0 ? 0 : last;
        y = last - y;
    }
    if (y < 0 || y > last) {
        y = y < 0 ? 0 : last;
        x = last - x;
    }
    return (size_t)y * n + (size_t)x;
}

#endif
