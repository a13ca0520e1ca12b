/* waves_velocity.c - how fast water goes up: no field of the tiles, as only what floats asks for it. */
#include "ocean/waves.h"

#include <math.h>

#include "ocean/wave_amplitudes.h"
#include "ocean/wave_patches.h"

static const double FARTHEST = 0x1p40; /* m */

enum { MAX_REACH = 1 << (WAVES_MAX_LEVELS - 2) };

/* e^(i n phase), n from 0 to reach. */
static void powers_of(double phase, int32_t reach, double out[][2])
{
    for (int32_t n = 0; n <= reach; n++) {
        out[n][0] = cos(n * phase);
        out[n][1] = sin(n * phase);
    }
}

/* Twice the real part of the sum over half of the plane; (u, v): the place in lengths of the tile. */
static double tile_velocity(const wave_amplitudes *a, double u, double v)
{
    double x[MAX_REACH + 1][2], z[MAX_REACH + 1][2], sum = 0.0;
    powers_of(6.28318530717958647693 * (u - floor(u)), a->reach, x);
    powers_of(6.28318530717958647693 * (v - floor(v)), a->reach, z);
    for (size_t i = 0; i < a->count; i++) {
        const wave_mode *m = &a->modes[i];
        const double *ex = x[m->n_x < 0 ? -m->n_x : m->n_x], *ez = z[m->n_z];
        double sx = m->n_x < 0 ? -ex[1] : ex[1];
        double c = ex[0] * ez[0] - sx * ez[1], s = ex[0] * ez[1] + sx * ez[0];
        sum += (double)a->rate[i][0] * c - (double)a->rate[i][1] * s;
    }
    return 2.0 * sum;
}

double waves_velocity(const waves *w, double x, double z)
{
    double sum = 0.0;
    if (!(fabs(x) < FARTHEST && fabs(z) < FARTHEST))
        x = z = 0.0;
    for (uint32_t i = 0; i < w->tile_count; i++) {
        const wave_tile *t = &w->tiles[i];
        double u = (x * t->cos_per_m + z * t->sin_per_m) / t->size;
        double v = (z * t->cos_per_m - x * t->sin_per_m) / t->size;
        wave_patch patches[WAVES_MAX_PATCHES];
        uint32_t patch_count = wave_patches_at(w, i, x, z, patches);
        for (uint32_t p = 0; p < patch_count; p++)
            sum += (double)patches[p].weight * tile_velocity(w->amplitudes[i],
                                                             u + (double)patches[p].u / t->size,
                                                             v + (double)patches[p].v / t->size);
    }
    return sum;
}
