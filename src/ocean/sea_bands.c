/* sea_bands.c - how wave numbers are shared among tiles.
 *
 * Eight waves of the peak lie along the first tile: fewer show how few directions a tile has. Each next one is
 * 0.9137 N / 24 times shorter, N its samples: it takes over where it holds six waves, and the one before has 4.4 samples for
 * each. The factor is no ratio of small numbers, so that the tiles do not repeat together. The last ends at four samples per
 * wave: with less, interpolation shows. */
#include "ocean/sea_state.h"

#include <math.h>

static const double TWO_PI = 6.28318530717958647693;
enum { PEAK_WAVES = 8, FIRST_WAVES = 6, SAMPLES_PER_WAVE = 4 };

sea_bands sea_bands_make(double peak_k, uint32_t resolution, uint32_t count)
{
    sea_bands b = {0};
    if (!(peak_k > 0.0) || !(peak_k < SHORTEST_WAVE_K))
        return b;
    double shrink = 0.9137 * resolution / (SAMPLES_PER_WAVE * FIRST_WAVES);
    double length = PEAK_WAVES * TWO_PI / peak_k;
    for (uint32_t i = 0; i < count && i < SEA_MAX_BANDS; i++) {
        double from = i ? FIRST_WAVES * TWO_PI / length : 0.0;
        if (from >= SHORTEST_WAVE_K)
            break;
        if (i)
            b.k_to[i - 1] = from;
        b.length_m[i] = length;
        b.k_from[i] = from;
        b.k_to[i] = fmin(TWO_PI * resolution / (SAMPLES_PER_WAVE * length), SHORTEST_WAVE_K);
        b.count = i + 1;
        length /= shrink;
    }
    return b;
}
