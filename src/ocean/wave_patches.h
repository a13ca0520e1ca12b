/* wave_patches.h - a tile without visible repetition: the plane is covered with blended patches from
 * random places of the tile. For Gaussian fields, a blend whose squared weights sum to 1 is again
 * Gaussian, with the same variance and spectrum (Heitz and Neyret 2018). The longest tile and those with a
 * spectral peak are read this way: they have nearly all of the elevation. The others have a twentieth, and
 * repeat.
 *
 * Patches lie around the vertices of equilateral triangles with edges of one tile length; the weight of a
 * vertex is the square of its barycentric coordinate above a quarter: half of the plane blends two patches, a
 * twentieth three. The gradients of the weights, up to 0.01 of the elevation per metre where waves have 0.15,
 * are left out of slopes and derivatives. */
#ifndef OCEAN_WAVE_PATCHES_H
#define OCEAN_WAVE_PATCHES_H

#include <math.h>

#include "base/hash.h"
#include "ocean/waves.h"

enum { WAVES_MAX_PATCHES = 3 };

typedef struct wave_patch {
    float weight;
    uint32_t u, v; /* source position in samples of the tile */
} wave_patch;

/* For vertex (i, j). Lower and upper half: u, v of a patch, modulo the tile's size. */
static inline uint64_t wave_patch_hash(uint64_t seed, int64_t i, int64_t j)
{
    return mix64(seed ^ ((uint64_t)i * MIX64_STEP) ^ ((uint64_t)j * 0xc2b2ae3d27d4eb4fu));
}

/* A position in triangle axes: the vertex of its rhombus, and the fraction, [0, 1)^2. */
typedef struct wave_rhombus {
    int64_t i, j;
    float a, b;
} wave_rhombus;
static inline wave_rhombus wave_rhombus_at(const wave_tile *t, double x, double z)
{
    double b = z / t->length_m * 1.15470053837925153, a = x / t->length_m - 0.5 * b;
    if (!(fabs(a) < 0x1p40 && fabs(b) < 0x1p40))
        a = b = 0.0;
    int64_t i = (int64_t)a, j = (int64_t)b;
    i -= a < (double)i;
    j -= b < (double)j;
    return (wave_rhombus){i, j, (float)(a - (double)i), (float)(b - (double)j)};
}

/* Patches at (x, z); returns the count. Squares of the weights sum to 1. */
uint32_t wave_patches_at(const waves *w, uint32_t tile, double x, double z,
                         wave_patch out[WAVES_MAX_PATCHES]);

#endif
