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

#include "ocean/waves.h"

enum { WAVES_MAX_PATCHES = 3 };

typedef struct wave_patch {
    float weight;
    uint32_t u, v; /* where it comes from, in samples of the tile */
} wave_patch;

/* Of the corner (i, j): a finaliser of 64 bits, as in wave_amplitudes.c. */
static inline uint64_t wave_patch_hash(uint64_t seed, int64_t i, int64_t j)
{
    uint64_t x = seed ^ ((uint64_t)i * 0x9e3779b97f4a7c15u) ^ ((uint64_t)j * 0xc2b2ae3d27d4eb4fu);
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

/* Those that are seen at (x, z); how many. Squares of the weights sum to 1. */
static inline uint32_t wave_patches_at(const waves *w, uint32_t tile, double x, double z,
                                       wave_patch out[WAVES_MAX_PATCHES])
{
    const wave_tile *t = &w->tiles[tile];
    if (!t->is_patched) {
        out[0] = (wave_patch){1.0f, 0, 0};
        return 1;
    }
    double b = z / t->length_m * 1.15470053837925153,
           a = x / t->length_m - 0.5 * b; /* in the triangles' axes */
    if (!(fabs(a) < 0x1p40 && fabs(b) < 0x1p40))
        a = b = 0.0;
    int64_t i = (int64_t)a, j = (int64_t)b;
    i -= a < (double)i;
    j -= b < (double)j;
    float fa = (float)(a - (double)i), fb = (float)(b - (double)j);
    int64_t upper = fa + fb > 1.0f; /* of the two triangles of a rhombus */
    float first = upper ? fa + fb - 1.0f : 1.0f - fa - fb;
    float barycentric[WAVES_MAX_PATCHES] = {first, upper ? 1.0f - fa : fb, upper ? 1.0f - fb : fa};
    int64_t corners[WAVES_MAX_PATCHES][2] = {{i + upper, j + upper}, {i, j + 1}, {i + 1, j}};
    uint32_t count = 0;
    float squares = 0.0f;
    for (int c = 0; c < WAVES_MAX_PATCHES; c++) {
        float over = barycentric[c] - 0.25f;
        if (over <= 0.0f)
            continue;
        uint64_t hash = wave_patch_hash(w->seed + tile, corners[c][0], corners[c][1]);
        out[count++] = (wave_patch){over * over, (uint32_t)hash & (t->size - 1u),
                                    (uint32_t)(hash >> 32) & (t->size - 1u)};
        squares += over * over * over * over;
    }
    float scale = 1.0f / sqrtf(squares);
    for (uint32_t c = 0; c < count; c++)
        out[c].weight *= scale;
    return count;
}

#endif
