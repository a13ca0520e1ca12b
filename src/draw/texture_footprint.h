/* texture_footprint.h - where a pixel lands in a texture: how large, how stretched, at which levels.
 * Inlined into each lookup. */
#ifndef DRAW_TEXTURE_FOOTPRINT_H
#define DRAW_TEXTURE_FOOTPRINT_H

#include <math.h>
#include <string.h>

#include "draw/texture_pyramid.h"

#define INLINE static inline __attribute__((always_inline))

enum { MAX_PROBES = 16 };

/* Two levels and the weight of the second one. */
typedef struct level_pair {
    uint32_t first, second;
    float fraction;
} level_pair;

/* The lod log2(sqrt(width_2)) as levels that are there; width_2 > 0 and normal.
 *
 * Which levels they are comes from the exponent of width_2 alone, so that fetching need not wait for the logarithm.
 * That is right to 6e-5: far below what a lod shows. With the mantissa 1 + t it is t and a correction that vanishes
 * at both ends, so that octaves join. */
INLINE level_pair get_levels(const texture_pyramid *p, float width_2)
{
    uint32_t bits;
    memcpy(&bits, &width_2, sizeof bits);
    int32_t exponent = (int32_t)(bits >> 23) - 127;
    int32_t first = exponent >> 1; /* rounded down */
    bits = (bits & 0x007fffff) | 0x3f800000;
    float t;
    memcpy(&t, &bits, sizeof t);
    t -= 1.0f;
    float mantissa_log2 = t + t * (1.0f - t) * (0.438726f + t * (-0.239058f + t * 0.082131f));
    float fraction = 0.5f * ((float)(exponent & 1) + mantissa_log2);
    if (first < (int32_t)p->first_level)
        return (level_pair){.first = p->first_level, .second = p->first_level};
    if (first + 1 >= (int32_t)p->level_count)
        return (level_pair){.first = p->level_count - 1, .second = p->level_count - 1};
    return (level_pair){.first = (uint32_t)first, .second = (uint32_t)first + 1, .fraction = fraction};
}

/* Where the pixel lands in the texture: an ellipse. Lengths in texels of the full image, squared. */
typedef struct footprint {
    float longest_2;        /* of the derivatives along x and y: rho of OpenGL */
    float major_2, minor_2; /* of the axes */
    float axis[2];          /* along the major axis, of any length, in texels */
} footprint;

/* False: it has no finite size. */
INLINE bool get_footprint(const texture_pyramid *p, const float duv_dx[2], const float duv_dy[2],
                          footprint *f)
{
    float width = (float)p->width;
    float height = (float)p->height;
    float ux = duv_dx[0] * width;
    float vx = duv_dx[1] * height;
    float uy = duv_dy[0] * width;
    float vy = duv_dy[1] * height;
    /* J J^T of the derivatives J = (ux uy; vx vy): its eigenvalues are the squared axes. */
    float a = ux * ux + uy * uy;
    float b = ux * vx + uy * vy;
    float c = vx * vx + vy * vy;
    float mean = 0.5f * (a + c);
    float half = 0.5f * (a - c);
    float spread = sqrtf(half * half + b * b);
    f->major_2 = mean + spread;
    f->minor_2 = mean - spread;
    float x_2 = ux * ux + vx * vx;
    float y_2 = uy * uy + vy * vy;
    f->longest_2 = x_2 > y_2 ? x_2 : y_2;
    /* The eigenvector of major_2, by the row of the matrix that is farther from 0. */
    f->axis[0] = half > 0.0f ? half + spread : b;
    f->axis[1] = half > 0.0f ? b : spread - half;
    return mean < 1e18f; /* whose square is finite; false for NaN */
}

/* Trilinear lookups in a row along the major axis, around the middle. */
typedef struct probe_row {
    uint32_t count;
    float width_2; /* texels, squared */
    float step[2]; /* du, dv */
} probe_row;

/* Covers the footprint with probes (after McCormack et al. 1999, "Feline").
 *
 * As many as the axes' ratio asks for, up to 16, each as wide as the minor axis. Up to a ratio of 1.5 one probe as
 * wide as the major axis does; from there to 2 two of them part while their width shrinks to the minor axis. n probes
 * of width w that are s apart have the second moment (w^2 + (n^2 - 1) s^2) / 12; s is such that it is major^2 / 12,
 * that of the footprint, so that hardly anything jumps where one more probe comes in. */
INLINE probe_row place_probes(const texture_pyramid *p, const footprint *f)
{
    /* Nothing is finer than a texel of the finest level. */
    float finest = (float)(1u << p->first_level);
    float minor_2 = f->minor_2 > finest * finest ? f->minor_2 : finest * finest;
    if (f->major_2 <= 2.25f * minor_2)
        return (probe_row){.count = 1, .width_2 = f->major_2};

    const float most = (float)(MAX_PROBES * MAX_PROBES);
    minor_2 = f->major_2 > most * minor_2 ? f->major_2 / most : minor_2;
    float ratio = sqrtf(f->major_2 / minor_2);
    uint32_t count = 2;
    float width_2 = minor_2;
    if (ratio > 2.0f)
        count = (uint32_t)(ratio + 0.75f); /* one more than ratio - 1.25, rounded down: they overlap enough */
    else
        width_2 *= (3.0f - ratio) * (3.0f - ratio);
    if (count > MAX_PROBES)
        count = MAX_PROBES;
    float axis_2 = f->axis[0] * f->axis[0] + f->axis[1] * f->axis[1];
    float scale = sqrtf((f->major_2 - width_2) / (axis_2 * (float)(count * count - 1)));
    return (probe_row){
        .count = count,
        .width_2 = width_2,
        .step = {f->axis[0] * scale * p->texel_size[0], f->axis[1] * scale * p->texel_size[1]}};
}

#endif
