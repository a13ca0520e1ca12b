/* slope_filter.c - what a footprint hides of the waves: total less resolved, for each component of the
 * slopes' covariance (Bruneton, Neyret and Holzschuch 2010).
 *
 * The total is Cox and Munk's along the wind, with the swell's own. The resolved part is what
 * waves_query.c leaves of each wave on average, squared. Along one axis, with texels of width b and K = k
 * b:
 *     level l, between texels    A_l^2 (2 + cos K) / 3,              A_l: mean of 2^l samples
 *     level l times level l + 1  A_l A_(l+1) (70 cos K/2 + 25 cos 3K/2 + cos 5K/2) / 96
 *     level 0, cubics            (228 + 71 cos K - 20 cos 2K + cos 3K) / 280
 *     level 0, linear times cubic    (22 + 9 cos K - cos 2K) / 30
 * all means over places within a texel; both axes multiply. */
#include "ocean/waves.h"

#include <math.h>
#include <string.h>

static const double PI_D = 3.14159265358979323846;
static const double SHORTEST_FOOTPRINT = 1e-3, FOOTPRINT_RANGE = 1e8; /* m; 1 mm to 100 km */
static const double STEP = 0.04;                                      /* of ln k */
enum { FOOTPRINTS = 64, DIRECTIONS = 32 };

float slope_filter_footprint(uint32_t i)
{
    return (float)(SHORTEST_FOOTPRINT * pow(FOOTPRINT_RANGE, i / (FOOTPRINTS - 1.0)));
}

float slope_filter_place(float footprint_m)
{
    if (!(footprint_m > (float)SHORTEST_FOOTPRINT))
        return 0.0f;
    const float per_octave = (FOOTPRINTS - 1) / 26.575425f; /* log2 of the range */
    return fminf(log2f(footprint_m * 1000.0f) * per_octave, FOOTPRINTS - 1);
}

/* ---- what reading leaves of a wave ---- */

/* Along one axis, of each level. */
typedef struct axis_gain {
    double alone[WAVES_MAX_LEVELS + 1], with_next[WAVES_MAX_LEVELS];
    double cubic, linear_and_cubic; /* of level 0 */
} axis_gain;

static axis_gain axis_gain_of(double K, uint32_t level_count) /* K: k times the sample spacing */
{
    axis_gain g = {.cubic = (228.0 + 71.0 * cos(K) - 20.0 * cos(2.0 * K) + cos(3.0 * K)) / 280.0,
                   .linear_and_cubic = (22.0 + 9.0 * cos(K) - cos(2.0 * K)) / 30.0};
    double mean = 1.0;
    for (uint32_t l = 0; l < level_count; l++, K *= 2.0) {
        double next = mean * cos(0.5 * K);
        g.alone[l] = mean * mean * (2.0 + cos(K)) / 3.0;
        g.with_next[l] = mean * next * (70.0 * cos(0.5 * K) + 25.0 * cos(1.5 * K) + cos(2.5 * K)) / 96.0;
        mean = next;
    }
    return g;
}

/* Mean square, with the blending of levels in waves_query.c. */
static double gain_of(const axis_gain *x, const axis_gain *z, uint32_t level_count, double texels)
{
    uint32_t l = 0;
    while (texels >= 2.0 && l < level_count) {
        texels *= 0.5;
        l++;
    }
    if (l + 1 >= level_count)
        return 0.0;
    if (texels < 1.0) {
        double c = fmin(2.0 - 2.0 * texels, 1.0);
        return (1.0 - c) * (1.0 - c) * x->alone[0] * z->alone[0] + c * c * x->cubic * z->cubic +
               2.0 * c * (1.0 - c) * x->linear_and_cubic * z->linear_and_cubic;
    }
    double t = texels - 1.0;
    return (1.0 - t) * (1.0 - t) * x->alone[l] * z->alone[l] + t * t * x->alone[l + 1] * z->alone[l + 1] +
           2.0 * t * (1.0 - t) * x->with_next[l] * z->with_next[l];
}

/* ---- sums over waves ---- */

/* Of the resolved waves, or of the unresolved ones. */
typedef struct sums {
    double slope[SEA_SYSTEMS][3]; /* xx, zz, xz */
    double slopes, k4, omega2_k2, convergence;
} sums;

/* Waves along one direction and against it. */
typedef struct wave_node {
    double density[SEA_SYSTEMS]; /* times the area in the wave vector plane that it represents */
    double k, c, s, omega, stretch;
} wave_node;

static void add_node(sums *sum, const wave_node *n, double share)
{
    double k2 = n->k * n->k, both = 0.0;
    for (int i = 0; i < SEA_SYSTEMS; i++) {
        double slope = share * n->density[i] * k2;
        sum->slope[i][0] += slope * n->c * n->c;
        sum->slope[i][1] += slope * n->s * n->s;
        sum->slope[i][2] += slope * n->c * n->s;
        both += slope;
    }
    sum->slopes += both;
    sum->k4 += both * k2;
    sum->omega2_k2 += both * n->omega * n->omega;
    sum->convergence += both * n->stretch * n->stretch;
}

typedef struct tables {
    double footprints_m[FOOTPRINTS];
    sums resolved[FOOTPRINTS], hidden[FOOTPRINTS];
} tables;

static void add_wave(tables *all, const wave_tile *t, const wave_node *n)
{
    double sample = 1.0 / t->samples_per_m, c = cos(t->turn), s = sin(t->turn);
    axis_gain x = axis_gain_of(n->k * (c * n->c + s * n->s) * sample, t->level_count);
    axis_gain z = axis_gain_of(n->k * (c * n->s - s * n->c) * sample, t->level_count);
    for (uint32_t i = 0; i < FOOTPRINTS; i++) {
        double gain = gain_of(&x, &z, t->level_count, all->footprints_m[i] * t->samples_per_m);
        add_node(&all->resolved[i], n, gain);
        add_node(&all->hidden[i], n, 1.0 - gain);
    }
}

static void add_ring(tables *all, const waves *w, const wave_tile *t, double k, double step)
{
    const sea_state *s = &w->state;
    sea_ring ring = sea_ring_at(s, k);
    wave_node n = {.k = k, .omega = wave_omega(k, s->depth_m), .stretch = wave_stretch(k, s->depth_m)};
    for (int d = 0; d < DIRECTIONS; d++) {
        double theta = PI_D * (d + 0.5) / DIRECTIONS;
        n.c = cos(theta);
        n.s = sin(theta);
        for (int i = 0; i < SEA_SYSTEMS; i++) {
            double both = wave_directions_density(&ring.directions[i], theta - ring.direction[i]) +
                          wave_directions_density(&ring.directions[i], theta + PI_D - ring.direction[i]);
            n.density[i] =
                ring.density[i] > 0.0 ? ring.density[i] * both * k * k * step * PI_D / DIRECTIONS : 0.0;
        }
        add_wave(all, t, &n);
    }
}

static void add_tile(tables *all, const waves *w, const wave_tile *t, double lowest_k)
{
    double from = fmax(t->k_from, lowest_k);
    double span = log(t->k_to / from);
    int count = (int)ceil(span / STEP);
    for (int i = 0; i < count; i++)
        add_ring(all, w, t, from * exp(span * (i + 0.5) / count), span / count);
}

/* ---- the rest ---- */

/* Waves in no tile. Their curvature is not that of the wave system's own spectrum, which has no capillary
 * waves, but that of Elfouhaily's at the same wind. */
static sea_moments beyond_tiles(const sea_state *s, double k_from)
{
    sea_state capillary = *s;
    wave_system *w = &capillary.systems[0];
    if (w->spectrum != FACET_SEA_SPECTRUM_ELFOUHAILY && s->wind_mps > 0.0) {
        w->spectrum = FACET_SEA_SPECTRUM_ELFOUHAILY;
        w->inverse_age = 0.84;
        w->peak_omega = 0.84 * GRAVITY / s->wind_mps;
        w->scale = 1.0;
        capillary.taper_k = ENDLESS;
    }
    return sea_state_moments(&capillary, k_from, SHORTEST_WAVE_K);
}

/* Along and across the wind, minus the resolved part. Where one would be negative, the other compensates. */
static void wind_residual(const sea_state *s, const double seen[2], const double resolved[3], double out[2])
{
    double c = cos(s->wind_direction), z = sin(s->wind_direction);
    out[0] = seen[0] - (c * c * resolved[0] + z * z * resolved[1] + 2.0 * c * z * resolved[2]);
    out[1] = seen[1] - (z * z * resolved[0] + c * c * resolved[1] - 2.0 * c * z * resolved[2]);
    double sum = fmax(out[0] + out[1], 0.0);
    for (int i = 0; i < 2; i++)
        if (out[i] < 0.0) {
            out[i] = 0.0;
            out[1 - i] = sum;
        }
}

static slope_covariance covariance_of(const sea_state *s, const double wind[2], const double swell[3])
{
    double c = cos(s->wind_direction), z = sin(s->wind_direction);
    return (slope_covariance){.xx = (float)(c * c * wind[0] + z * z * wind[1] + swell[0]),
                              .zz = (float)(z * z * wind[0] + c * c * wind[1] + swell[1]),
                              .xz = (float)(c * z * (wind[0] - wind[1]) + swell[2])};
}

/* Curvature of slopes that Cox and Munk measured but no spectrum has: those of light winds have no capillary
 * waves. The unresolved ones are shorter than twice the footprint and than all waves in tiles, with curvature
 * k^2 times slope; at most as short as the slowest waves. */
static double curvature_unknown(double slopes, double footprint_m, double k_end)
{
    const double slowest = 370.0; /* rad/m; sqrt(g / 7.2e-5) */
    double k = fmin(fmin(PI_D / footprint_m, k_end), slowest);
    return k * k * fmax(slopes, 0.0);
}

void slope_filter_create(const waves *w, slope_filter *out)
{
    const sea_state *s = &w->state;
    tables all;
    memset(&all, 0, sizeof all);
    for (uint32_t i = 0; i < FOOTPRINTS; i++)
        all.footprints_m[i] = (double)slope_filter_footprint(i);
    double lowest = ENDLESS;
    for (int i = 0; i < SEA_SYSTEMS; i++)
        if (s->systems[i].peak_omega > 0.0)
            lowest = fmin(lowest, wave_k(0.3 * s->systems[i].peak_omega, s->depth_m));
    for (uint32_t i = 0; i < w->tile_count; i++)
        add_tile(&all, w, &w->tiles[i], lowest);
    double k_end = w->tile_count ? w->tiles[w->tile_count - 1].k_to : 0.0;
    sea_moments beyond = beyond_tiles(s, k_end);
    double seen[2];
    cox_munk_slopes(s->wind_mps, seen);
    double swell[3];
    for (int j = 0; j < 3; j++)
        swell[j] = all.resolved[0].slope[1][j] + all.hidden[0].slope[1][j];
    out->total = covariance_of(s, seen, swell);
    for (uint32_t i = 0; i < FOOTPRINTS; i++) {
        const sums *hidden = &all.hidden[i];
        double wind[2];
        wind_residual(s, seen, all.resolved[i].slope[0], wind);
        out->residual[i] = covariance_of(s, wind, hidden->slope[1]);
        double slopes = hidden->slopes + beyond.slope[0] + beyond.slope[1];
        double unknown = (double)out->residual[i].xx + (double)out->residual[i].zz - slopes;
        out->curvature[i] =
            (float)(hidden->k4 + beyond.k4 + curvature_unknown(unknown, all.footprints_m[i], k_end));
        if (i) /* a wider footprint resolves no more than a narrower one */
            out->curvature[i] = fmaxf(out->curvature[i], out->curvature[i - 1]);
        out->rate[i] = slopes > 0.0 ? (float)sqrt((hidden->omega2_k2 + beyond.omega2_k2) / slopes) : 0.0f;
        out->convergence_variance[i] = (float)(w->choppiness * w->choppiness * hidden->convergence);
    }
}
