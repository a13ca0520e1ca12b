/* sea_moments.c - moments of the spectrum, measured statistics of seas, and the bands of the tiles. */
#include "ocean/sea_state.h"

#include <math.h>

static const double PI_D = 3.14159265358979323846;
/* The peak is 0.14 wide in ln k, directions of the narrowest swell 0.4 rad: the midpoint rule is exact to
 * 1e-6 with these. */
static const double STEP = 0.02;
enum { DIRECTIONS = 90 };

/* Adds the integral over one ring, with its width in k as weight. */
static void add_ring(sea_moments *m, const sea_state *s, const sea_ring *ring, double k, double weight)
{
    double mean = 0.0, xx = 0.0, xz = 0.0; /* of 1, cos^2, cos sin */
    for (int i = 0; i < DIRECTIONS; i++) {
        double theta = (2.0 * (i + 0.5) / DIRECTIONS - 1.0) * PI_D;
        double density = sea_ring_density(ring, theta);
        mean += density;
        xx += density * cos(theta) * cos(theta);
        xz += density * cos(theta) * sin(theta);
    }
    double area = weight * 2.0 * PI_D / DIRECTIONS;
    double k2 = k * k, omega = wave_omega(k, s->depth_m), stretch = wave_stretch(k, s->depth_m);
    m->height += mean * area;
    m->k += k * stretch * mean * area;
    m->slope[0] += k2 * xx * area;
    m->slope[1] += k2 * (mean - xx) * area;
    m->slope[2] += k2 * xz * area;
    m->k4 += k2 * k2 * mean * area;
    m->omega2_k2 += omega * omega * k2 * mean * area;
    m->convergence += k2 * stretch * stretch * mean * area;
}

/* Cutoff that loses nothing. */
static void add_range(sea_moments *m, const sea_state *s, double from, double to)
{
    if (!(to > from))
        return;
    double span = log(to / from);
    int count = (int)ceil(span / STEP);
    for (int i = 0; i < count; i++) {
        double k = from * exp(span * (i + 0.5) / count);
        sea_ring ring = sea_ring_at(s, k);
        add_ring(m, s, &ring, k, k * k * span / count); /* k dk = k^2 d ln k */
    }
}

sea_moments sea_state_moments(const sea_state *s, double from, double to)
{
    sea_moments m = {0};
    double lowest = 0.0; /* of the peaks */
    for (int i = 0; i < SEA_SYSTEMS; i++) {
        double omega = s->systems[i].peak_omega;
        if (omega > 0.0 && (lowest == 0.0 || omega < lowest))
            lowest = omega;
    }
    if (lowest == 0.0)
        return m;
    from = fmax(from, wave_k(0.3 * lowest, s->depth_m)); /* exp(-1.25 / 0.3^4) = 1e-67 */
    to = fmin(to, SHORTEST_WAVE_K);
    double cut = fmin(fmax(s->taper_k, from), to);
    add_range(&m, s, from, cut);
    add_range(&m, s, cut, to);
    return m;
}

sea_moments sea_system_moments(const sea_state *s, uint32_t system, double from, double to)
{
    sea_state one = *s;
    for (uint32_t i = 0; i < SEA_SYSTEMS; i++)
        if (i != system)
            one.systems[i].peak_omega = 0.0;
    return sea_state_moments(&one, from, to);
}

void cox_munk_slopes(double wind_mps, double out[2])
{
    double constant = 0.003 * fmin(wind_mps, 1.0);
    double along = 3.16e-3 * wind_mps, across = constant + 1.92e-3 * wind_mps; /* two fits, whose sum is */
    double total = constant + 5.12e-3 * wind_mps;                              /* not quite the third */
    double scale = along + across > 0.0 ? total / (along + across) : 0.0;
    out[0] = along * scale;
    out[1] = across * scale;
}

double whitecap_coverage(double wind_mps)
{
    const double onset_mps = 3.7, full_mps = 5.0;
    const double most = 0.9; /* Beaufort 12: white with foam, with streaks in it */
    double t = fmin(fmax((wind_mps - onset_mps) / (full_mps - onset_mps), 0.0), 1.0);
    return fmin(3.84e-6 * pow(wind_mps, 3.41), most) * t * t * (3.0 - 2.0 * t);
}

double sea_state_peak_k(const sea_state *s)
{
    double highest = 0.0, omega = 0.0;
    for (uint32_t i = 0; i < SEA_SYSTEMS; i++) {
        double height = s->systems[i].peak_omega > 0.0 ? sea_system_moments(s, i, 0.0, ENDLESS).height : 0.0;
        if (height > highest) {
            highest = height;
            omega = s->systems[i].peak_omega;
        }
    }
    return omega > 0.0 ? wave_k(omega, s->depth_m) : 0.0;
}

/* ---- bands of the tiles ---- */

/* Partition of wavenumbers among tiles.
 *
 * Eight peak wavelengths span the first tile: fewer would show how few directions a tile has. Each next
 * one is
 * 0.9137 N / 24 times shorter, with N its samples: it takes over where it holds six waves and the previous tile
 * has 4.4 samples per wave. The factor is not a ratio of small integers, so that the tiles do not repeat
 * together. The last tile ends at four samples per wave: fewer would show the interpolation. */

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
