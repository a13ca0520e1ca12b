/* cube.h - cube maps of radiance: mapping of directions, seamless lookup.
 *
 * Faces are +X -X +Y -Y +Z -Z. Position (s, t) on a face, both in [-1, 1], t downwards, is the direction of
 *   +X (1, -t, -s)   -X (-1, -t, s)   +Y (s, 1, t)   -Y (s, -1, -t)   +Z (s, -t, 1)   -Z (-s, -t, -1)
 * normalised, as in Direct3D and OpenGL. Texel (x, y) of a face of size n has its center at s = (2 x + 1) / n
 * - 1, t = (2 y + 1) / n - 1. */
#ifndef IBL_CUBE_H
#define IBL_CUBE_H

#include <math.h>

#include "facet/facet.h"
#include "ibl/rgbx.h"

/* Six faces of size x size texels, each with a border of one texel that repeats the adjacent faces, so that
 * bilinear lookup is continuous across edges without special cases. */
typedef struct cube {
    uint32_t size;
    rgbx *texels; /* 6 (size + 2)^2; a block of mem_alloc() */
} cube;

/* A position on a cube. */
typedef struct cube_point {
    uint32_t face;
    float s, t;
} cube_point;

facet_result cube_create(uint32_t size, const facet_allocator *allocator, cube *out, facet_error *error);
void cube_destroy(cube *c); /* {0} is allowed; leaves {0} */
/* Fills the borders from the faces. */
void cube_fill_borders(cube *c);

/* The texel (x, y), each in [-1, size], of a face. */
static inline rgbx *cube_texel(const cube *c, uint32_t face, int x, int y)
{
    size_t stride = (size_t)c->size + 2;
    return c->texels + ((size_t)face * stride + (size_t)(y + 1)) * stride + (size_t)(x + 1);
}

/* The direction of (s, t) on a face, not normalised: its largest component is 1 or -1. */
void cube_direction(uint32_t face, double s, double t, double d[3]);

/* Position of the direction (x, y, z) of any length but 0. */
static inline cube_point cube_locate(float x, float y, float z)
{
    float ax = fabsf(x);
    float ay = fabsf(y);
    float az = fabsf(z);
    if (ax >= ay && ax >= az) {
        float q = 1.0f / ax;
        return (cube_point){x < 0.0f, (x < 0.0f ? z : -z) * q, -y * q};
    }
    if (ay >= az) {
        float q = 1.0f / ay;
        return (cube_point){2 + (y < 0.0f), x * q, (y < 0.0f ? -z : z) * q};
    }
    float q = 1.0f / az;
    return (cube_point){4 + (z < 0.0f), (z < 0.0f ? -x : x) * q, -y * q};
}

/* Bilinear, seamless. */
static inline rgbx cube_fetch(const cube *c, cube_point p)
{
    float half = 0.5f * (float)c->size;
    float x = p.s * half + (half + 0.5f); /* in the bordered face */
    float y = p.t * half + (half + 0.5f);
    int x0 = (int)x;
    int y0 = (int)y;
    float wx = x - (float)x0;
    float wy = y - (float)y0;
    size_t stride = (size_t)c->size + 2;
    const rgbx *a = c->texels + ((size_t)p.face * stride + (size_t)y0) * stride + (size_t)x0;
    const rgbx *b = a + stride;
    rgbx top = a[0] + (a[1] - a[0]) * wx;
    rgbx bottom = b[0] + (b[1] - b[0]) * wx;
    return top + (bottom - top) * wy;
}

/* Solid angle of a texel, sr; those of six faces add up to 4 pi. Exact: differences of
 * atan2(s t, sqrt(s^2 + t^2 + 1)) at the corners (Driscoll 2012, "Cubemap Texel Solid Angle"). */
double cube_texel_solid_angle(uint32_t size, uint32_t x, uint32_t y);
/* Solid angle of the face from its center to (s, t); those of texels are differences of these. */
double cube_corner_angle(double s, double t);
/* Mean radiance over the sphere, weighted by solid angle. */
void cube_mean(const cube *c, double mean[3]);

#endif
