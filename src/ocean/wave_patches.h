/* wave_patches.h - a tile without its repetition: the plane is laid out with patches of it, each from a random place, that blend
 * into each other. Of Gaussian fields a blend whose squared weights sum to 1 is again one, with the same variance and the same
 * spectrum (Heitz and Neyret 2018). The longest tile and those that have a peak of the spectrum are read so: they have nearly all of the
 * height. Others have a twentieth, and repeat.
 *
 * Patches lie around the corners of equilateral triangles with edges of one tile; a corner's weight is the square of what its
 * barycentric coordinate has over a quarter: half of the plane sees two patches, a twentieth three. The weights' own slopes, up
 * to 0.01 of the height over a metre where waves have 0.15, are left out of slopes and derivatives. */
#ifndef OCEAN_WAVE_PATCHES_H
#define OCEAN_WAVE_PATCHES_H

#include <math.h>

#include "base/hash.h"
#include "ocean/waves.h"

enum { WAVES_MAX_PATCHES = 3 };

typedef struct wave_patch {
    float weight;
    uint32_t u, v; /* where it comes from, in samples of the tile */
} wave_patch;

/* Of the corner (i, j). Lower and upper half: u, v of a patch, modulo the tile's size. */
static inline uint64_t wave_patch_hash(uint64_t seed, int64_t i, int64_t j)
{
    return mix64(seed ^ ((uint64_t)i * MIX64_STEP) ^ ((uint64_t)j * 0xc2b2ae3d27d4eb4fu));
}

/* A place in the axes of the triangles: the corner of its rhombus, and the rest, [0, 1)^2. */
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

/* Those that are seen at (x, z); how many. Squares of the weights sum to 1. */
uint32_t wave_patches_at(const waves *w, uint32_t tile, double x, double z,
                         wave_patch out[WAVES_MAX_PATCHES]);

#endif
