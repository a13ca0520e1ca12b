/* waves_foam.c - see waves_foam.h. */
#include "ocean/waves_foam.h"

#include <math.h>
#include <string.h>

#include "base/result.h"
#include "ocean/foam_plane.h"
#include "ocean/wave_patches.h"
#include "ocean/waves.h"

double foam_decay_s(double salinity)
{
    return 2.5 + 1.2 * fmin(salinity / 35.0, 1.0);
}

/* Scales all shares by a factor, clamped to 1, such that the mean is the requested one. Newton's method from
 * below: the sum is concave in the factor, so no step overshoots, and piecewise linear, so few steps are
 * needed. count: of groups of eight. */
static void scale_share(float *share, size_t count, double mean)
{
    enum { MAX_STEPS = 50, LANES = 8 }; /* parallel sums in a machine-independent order */
    double factor = 0.0, wanted = mean * (double)count;
    for (int step = 0; step < MAX_STEPS; step++) {
        double sums[LANES] = {0.0}, slopes[LANES] = {0.0}, sum = 0.0, slope = 0.0;
        for (size_t i = 0; i + LANES <= count; i += LANES)
            for (size_t k = 0; k < LANES; k++) {
                double s = (double)share[i + k], scaled = factor * s;
                sums[k] += scaled < 1.0 ? scaled : 1.0;
                slopes[k] += scaled < 1.0 ? s : 0.0;
            }
        for (size_t k = 0; k < LANES; k++) {
            sum += sums[k];
            slope += slopes[k];
        }
        double missing = wanted - sum;
        if (!(slope > 0.0) || missing <= 1e-9 * wanted)
            break;
        factor = fmin(factor + missing / slope, 1e6);
    }
    for (size_t i = 0; i < count; i++)
        share[i] = (float)fmin(factor * (double)share[i], 1.0);
}

/* Mapping of patterns to the water: wide ones scale with the waves, the finest cells hardly. They are
 * stretched along the wind, with its speed: foam gathers in windrows. */
static void place_readings(const waves *w, foam_reading *readings)
{
    double size = (double)w->tiles[0].size, wind = w->state.wind_mps;
    double scale = fmin(fmax(sqrt(w->tiles[0].length_m / 2000.0), 0.1), 1.5), rows = 1.0 + wind / 8.0;
    const struct {
        uint32_t pattern;
        double samples_per_m, stretch, turn;
        float weight;
    } all[FOAM_READINGS] = {
        {FOAM_CLOUDS, size / (70.0 * scale), rows, 0.0, 0.5f},
        {FOAM_CELLS, FOAM_CELL_SAMPLES / (3.7 * scale), 0.5 + 0.5 * rows, 0.13, 0.45f},
        {FOAM_CELLS, FOAM_CELL_SAMPLES / (1.1 * scale), 0.75 + 0.25 * rows, -0.4, 0.6f},
        {FOAM_CELLS, FOAM_CELL_SAMPLES / (0.3 * sqrt(scale)), 1.0, 1.1, 0.43f},
    };
    for (uint32_t i = 0; i < FOAM_READINGS; i++) {
        double turn = w->state.wind_direction + all[i].turn, along = all[i].samples_per_m / all[i].stretch;
        readings[i] =
            (foam_reading){.pattern = all[i].pattern,
                           .along = {along * cos(turn), along * sin(turn)},
                           .across = {-all[i].samples_per_m * sin(turn), all[i].samples_per_m * cos(turn)},
                           .samples_per_m = (float)all[i].samples_per_m,
                           .weight = all[i].weight};
    }
}

void waves_foam_destroy(waves_foam *f)
{
    foam_plane_destroy(&f->share);
    *f = (waves_foam){.w = NULL};
}

facet_result waves_foam_create(const waves *w, const foam_rule *rule, double decay_s,
                               const facet_allocator *allocator, foam_history **history, waves_foam *out,
                               facet_error *error)
{
    *out = (waves_foam){.w = w};
    if (!w->tile_count || !(rule->active_threshold < INFINITY) || !(rule->active_threshold > 0.0f))
        return FACET_OK;
    uint32_t size = w->tiles[0].size;
    facet_result result = FACET_OK;
    if (!*history)
        result = foam_history_create(w, (double)rule->active_threshold, decay_s, allocator, history, error);
    if (result == FACET_OK && !foam_plane_create(allocator, size, &out->share))
        result = fail_memory(error, "foam", (size_t)size * size * sizeof(float));
    if (result == FACET_OK)
        result = foam_history_gather(*history, w, out->share.levels[0], error);
    if (result != FACET_OK) {
        waves_foam_destroy(out);
        return result;
    }
    memcpy(out->patterns, (*history)->patterns, sizeof out->patterns);
    place_readings(w, out->readings);
    scale_share(out->share.levels[0], (size_t)size * size, (double)rule->coverage);
    foam_plane_reduce(&out->share);
    return FACET_OK;
}

/* ---- reading ---- */

static float share_at(const waves_foam *f, double x, double z, float footprint_m)
{
    const wave_tile *t = &f->w->tiles[0];
    double u = x * t->cos_per_m + z * t->sin_per_m, v = z * t->cos_per_m - x * t->sin_per_m;
    wave_patch patches[WAVES_MAX_PATCHES];
    uint32_t count = wave_patches_at(f->w, 0, x, z, patches);
    float sum = 0.0f; /* squares of the weights sum to 1 */
    for (uint32_t i = 0; i < count; i++)
        sum += patches[i].weight * patches[i].weight *
               foam_plane_read(&f->share, u + (double)patches[i].u, v + (double)patches[i].v,
                               footprint_m * (float)t->samples_per_m)
                   .mean;
    return fminf(fmaxf(sum, 0.0f), 1.0f);
}

static foam_plane_value read_pattern(const waves_foam *f, uint32_t reading, double x, double z,
                                     float footprint_m)
{
    const foam_reading *r = &f->readings[reading];
    return foam_plane_read(&f->patterns[r->pattern], x * r->along[0] + z * r->along[1],
                           x * r->across[0] + z * r->across[1], footprint_m * r->samples_per_m);
}

foam_seen waves_foam_at(const waves_foam *f, double x, double z, float footprint_m)
{
    if (!f->share.level_count)
        return (foam_seen){0.0f, 0.0f};
    float amount = share_at(f, x, z, footprint_m);
    if (amount <= 1e-4f || amount >= 0.999f)
        return (foam_seen){amount, amount};
    float mean = 0.0f, hidden = 0.0f;
    for (uint32_t i = 0; i < FOAM_READINGS; i++) {
        float weight = f->readings[i].weight;
        foam_plane_value value = read_pattern(f, i, x, z, footprint_m);
        mean += weight * value.mean;
        hidden += weight * weight * value.hidden;
    }
    return (foam_seen){wave_foam_lace(amount, mean, hidden), amount};
}

/* ---- where crests break ---- */

/* Where crests break: thresholds of the convergence q = -(D_xx + D_zz), which is Gaussian as the waves are,
 * calibrated such that foam covers what Monahan and O'Muircheartaigh saw.
 *
 * Coverage is an area seen from above, and where water converges there is less of it: the tail is weighted
 * with the Jacobian, whose mean at a given q is 1 - q + (q^2 - sigma^2) / 4 for waves from all sides:
 *     W(z) = Q(z) - sigma phi(z) (1 - sigma z / 4),  q = z sigma. */

static const double ACTIVE_SHARE = 0.1; /* active crests, as a share of all foam */

static double upper_tail(double z)
{
    return 0.5 * erfc(z * 0.70710678118654752440);
}

static double normal_density(double z)
{
    return 0.39894228040143267794 * exp(-0.5 * z * z);
}

static double area_beyond(double z, double sigma)
{
    return upper_tail(z) - sigma * normal_density(z) * (1.0 - 0.25 * sigma * z);
}

/* Beyond z = 2 / sigma - 1 the mean Jacobian is negative, and the area would grow again. */
static double threshold_of(double coverage, double sigma)
{
    if (!(coverage > 0.0) || !(sigma > 0.0))
        return ENDLESS;
    double low = -6.0, high = fmin(8.0, 2.0 / sigma - 1.0);
    for (int i = 0; i < 60; i++) {
        double z = 0.5 * (low + high);
        if (area_beyond(z, sigma) > coverage)
            low = z;
        else
            high = z;
    }
    return 0.5 * (low + high) * sigma;
}

foam_rule foam_rule_create(const waves *w)
{
    const sea_state *s = &w->state;
    double coverage = whitecap_coverage(s->wind_mps), variance = 0.0;
    if (w->tile_count)
        variance = sea_state_moments(s, 0.0, s->bands.k_to[s->bands.count - 1]).convergence;
    double sigma = w->choppiness * sqrt(variance);
    return (foam_rule){.threshold = (float)threshold_of(coverage, sigma),
                       .active_threshold = (float)threshold_of(ACTIVE_SHARE * coverage, sigma),
                       .sigma = (float)sigma,
                       .coverage = (float)coverage};
}
