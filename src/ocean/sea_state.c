/* sea_state.c - from wind, fetch, depth and swell to wave systems. */
#include "ocean/sea_state.h"

#include <math.h>

#include "base/result.h"

/* Fetch at which JONSWAP's variance equals that of Pierson and Moskowitz's fully developed sea: growth ends
 * there. */
static const double LARGEST_FETCH = 1.07e4; /* g F / U^2 */
/* Waves break where the significant height is 0.594 of the depth: H_rms = 0.42 H, Thornton and Guza 1982. */
static const double HEIGHT_OVER_DEPTH = 0.594;
/* Share of Cox and Munk's slope variance that waves in tiles may have; the rest belongs to shorter waves. */
static const double RESOLVED_SHARE = 0.9;

/* ---- what is asked for ---- */

static bool is_within(float value, float from, float to)
{
    return value >= from && value <= to; /* false for NaN */
}

static facet_result check_wind(const facet_sea_desc *d, facet_error *error)
{
    if (!is_within(d->wind_mps, 0.0f, 40.0f))
        return fail(error, FACET_ERROR_ARGUMENT, "wind: %g m/s is not within [0, 40]", (double)d->wind_mps);
    if (!isfinite(d->wind_direction_rad))
        return fail(error, FACET_ERROR_ARGUMENT, "wind: its direction is not finite");
    if (!(d->fetch_m >= 100.0f))
        return fail(error, FACET_ERROR_ARGUMENT, "fetch: %g m is not 100 m or more", (double)d->fetch_m);
    if ((unsigned)d->spectrum > FACET_SEA_SPECTRUM_ELFOUHAILY)
        return fail(error, FACET_ERROR_ARGUMENT, "spectrum: %d is not a facet_sea_spectrum",
                    (int)d->spectrum);
    if ((unsigned)d->spreading > FACET_SEA_SPREADING_COSINE)
        return fail(error, FACET_ERROR_ARGUMENT, "spreading: %d is not a facet_sea_spreading",
                    (int)d->spreading);
    if (!is_within(d->peakedness, 1.0f, 20.0f))
        return fail(error, FACET_ERROR_ARGUMENT, "peakedness: %g is not within [1, 20]",
                    (double)d->peakedness);
    return FACET_OK;
}

/* Steepness (height over length) limit of waves: Michell 1893. */
static const double STEEPEST = 0.142;

/* Wavelength in deep water, m. */
static double length_of(float period_s)
{
    return GRAVITY * (double)period_s * (double)period_s / 6.28318530717958647693;
}

static facet_result check_swell(const facet_swell *s, facet_error *error)
{
    if (!is_within(s->height_m, 0.0f, 30.0f))
        return fail(error, FACET_ERROR_ARGUMENT, "swell: a height of %g m is not within [0, 30]",
                    (double)s->height_m);
    if (s->height_m == 0.0f)
        return FACET_OK;
    if (!(s->period_s >= 0.1f && s->period_s <= 40.0f))
        return fail(error, FACET_ERROR_ARGUMENT, "swell: a period of %g s is not within [0.1, 40]",
                    (double)s->period_s);
    float highest = (float)(STEEPEST * length_of(s->period_s));
    if (s->height_m > highest)
        return fail(
            error, FACET_ERROR_ARGUMENT,
            "swell: with a period of %g s it breaks before it is %g m high; at most %.3g m are possible",
            (double)s->period_s, (double)s->height_m, (double)highest);
    if (!isfinite(s->direction_rad))
        return fail(error, FACET_ERROR_ARGUMENT, "swell: its direction is not finite");
    if (s->peakedness != 0.0f && !is_within(s->peakedness, 1.0f, 20.0f))
        return fail(error, FACET_ERROR_ARGUMENT, "swell: a peakedness of %g is not within [1, 20]",
                    (double)s->peakedness);
    if (!is_within(s->elongation, 0.0f, 1.0f))
        return fail(error, FACET_ERROR_ARGUMENT, "swell: an elongation of %g is not within [0, 1]",
                    (double)s->elongation);
    return FACET_OK;
}

static facet_result check_bed(const facet_sea_bed *b, facet_error *error)
{
    if (!(b->depth_m >= 0.0f) || !isfinite(b->depth_m))
        return fail(error, FACET_ERROR_ARGUMENT, "bed: a depth of %g m is not above 0 (0: there is no bed)",
                    (double)b->depth_m);
    if (b->depth_m == 0.0f)
        return FACET_OK;
    if (b->depth_m < 0.001f)
        return fail(error, FACET_ERROR_ARGUMENT, "bed: a depth of %g m is less than 1 mm",
                    (double)b->depth_m);
    if (!is_within(b->slope, 0.0f, 1.0f) || !isfinite(b->direction_rad))
        return fail(error, FACET_ERROR_ARGUMENT, "bed: a slope of %g towards %g rad is not within [0, 1]",
                    (double)b->slope, (double)b->direction_rad);
    for (int i = 0; i < 3; i++)
        if (!is_within(b->albedo[i], 0.0f, 1.0f))
            return fail(error, FACET_ERROR_ARGUMENT, "bed: an albedo of %g is not within [0, 1]",
                        (double)b->albedo[i]);
    return FACET_OK;
}

static facet_result check_tiles(const facet_sea_desc *d, facet_error *error)
{
    if (!is_within(d->choppiness, 0.0f, 2.0f))
        return fail(error, FACET_ERROR_ARGUMENT, "choppiness: %g is not within [0, 2]",
                    (double)d->choppiness);
    if (d->loop_s != 0.0 && !(d->loop_s >= 0.1 && d->loop_s <= 1e6))
        return fail(error, FACET_ERROR_ARGUMENT, "loop: %g s is neither 0 nor within [0.1, 1e6]", d->loop_s);
    if (d->resolution < 32 || d->resolution > 1024 || (d->resolution & (d->resolution - 1)))
        return fail(error, FACET_ERROR_ARGUMENT, "resolution: %u is no power of two within [32, 1024]",
                    (unsigned)d->resolution);
    if (d->cascade_count < 1 || d->cascade_count > SEA_MAX_BANDS)
        return fail(error, FACET_ERROR_ARGUMENT, "cascades: %u is not within [1, 4]",
                    (unsigned)d->cascade_count);
    return FACET_OK;
}

/* ---- systems ---- */

/* Elfouhaily's inverse age by fetch: 0.84 tanh((X / 2.2e4)^0.4)^-0.75, [0.84, 5]. */
static double elfouhaily_age(double chi)
{
    return fmin(0.84 * pow(tanh(pow(chi / 2.2e4, 0.4)), -0.75), 5.0);
}

static wave_system wind_sea(const facet_sea_desc *d)
{
    double U = (double)d->wind_mps;
    wave_system w = {.spectrum = d->spectrum,
                     .spreading = d->spreading,
                     .direction = (double)d->wind_direction_rad,
                     .wind_mps = U,
                     .scale = 1.0};
    if (!(U > 0.0))
        return w;
    double chi = GRAVITY * (double)d->fetch_m / (U * U);
    switch (d->spectrum) {
    case FACET_SEA_SPECTRUM_JONSWAP:
        chi = fmin(chi, LARGEST_FETCH);
        w.alpha = 0.076 * pow(chi, -0.22);
        w.inverse_age = 22.0 * pow(chi, -1.0 / 3.0);
        w.gamma = (double)d->peakedness;
        break;
    case FACET_SEA_SPECTRUM_PIERSON_MOSKOWITZ:
        w.alpha = 0.0081;
        w.inverse_age = 0.855;
        w.gamma = 1.0;
        break;
    case FACET_SEA_SPECTRUM_ELFOUHAILY:
        w.inverse_age = elfouhaily_age(chi);
        break;
    }
    w.peak_omega = w.inverse_age * GRAVITY / U;
    /* No wave is slower than 0.23 m/s, and a wind slower than that raises none. */
    if (U < pow(4.0 * GRAVITY * SURFACE_TENSION_OVER_DENSITY, 0.25))
        w.peak_omega = 0.0;
    return w;
}

/* alpha such that the height is the requested one, including the depth's effect. */
static wave_system swell_sea(const facet_swell *d, double depth_m)
{
    wave_system w = {.spectrum = FACET_SEA_SPECTRUM_JONSWAP,
                     .spreading = FACET_SEA_SPREADING_HASSELMANN,
                     .direction = (double)d->direction_rad,
                     .gamma = d->peakedness > 0.0f ? (double)d->peakedness : 7.0,
                     .inverse_age = 1.17,
                     .elongation = (double)d->elongation,
                     .scale = 1.0};
    if (!(d->height_m > 0.0f))
        return w;
    w.peak_omega = 6.28318530717958647693 / (double)d->period_s;
    w.alpha = 1.0;
    sea_state alone = {.systems = {{0}, w}, .depth_m = depth_m, .taper_k = ENDLESS, .taper = 1.0};
    double height = 4.0 * sqrt(sea_state_moments(&alone, 0.0, ENDLESS).height);
    double ratio = height > 0.0 ? (double)d->height_m / height : 0.0;
    w.alpha = ratio * ratio;
    return w;
}

/* ---- limits ---- */

static void limit_by_depth(sea_state *s)
{
    if (!isfinite(s->depth_m))
        return;
    double height = 4.0 * sqrt(sea_state_moments(s, 0.0, ENDLESS).height);
    double ratio = HEIGHT_OVER_DEPTH * s->depth_m / height;
    if (height > 0.0 && ratio < 1.0)
        for (int i = 0; i < SEA_SYSTEMS; i++)
            s->systems[i].scale = ratio * ratio;
}

static double wind_slopes(const sea_state *s, double from, double to)
{
    sea_moments m = sea_system_moments(s, 0, from, to);
    return m.slope[0] + m.slope[1];
}

/* Light airs: the density beyond ten peak wavenumbers is scaled by one factor so that the slopes of all tiles
 * are a share of the measured ones; where even 0 is too much (below 2.5 m/s), the cutoff moves towards the
 * peak. */
static void limit_slopes(sea_state *s)
{
    const wave_system *w = &s->systems[0];
    if (!(w->peak_omega > 0.0) || !s->bands.count)
        return;
    double seen[2];
    cox_munk_slopes(s->wind_mps, seen);
    double share = RESOLVED_SHARE * (seen[0] + seen[1]);
    double k_end = s->bands.k_to[s->bands.count - 1];
    double k_peak = wave_k(w->peak_omega, s->depth_m);
    double cut = fmin(10.0 * k_peak, k_end);
    double below = wind_slopes(s, 0.0, cut), beyond = wind_slopes(s, cut, k_end);
    if (below + beyond <= share)
        return;
    double low = 0.1 * k_peak, high = cut;
    for (int i = 0; below > share && i < 30; i++) { /* by bisection in ln k */
        cut = sqrt(low * high);
        if (wind_slopes(s, 0.0, cut) > share)
            high = cut;
        else
            low = cut;
    }
    s->taper_k = cut;
    s->taper = below > share ? 0.0 : (share - below) / beyond;
}

static double longest_peak(const sea_state *s)
{
    double k = 0.0;
    for (int i = 0; i < SEA_SYSTEMS; i++) {
        double peak = wave_k(s->systems[i].peak_omega, s->depth_m);
        if (peak > 0.0 && (k == 0.0 || peak < k))
            k = peak;
    }
    return k;
}

facet_result sea_state_create(const facet_sea_desc *desc, sea_state *out, facet_error *error)
{
    facet_result result = check_wind(desc, error);
    if (!result)
        result = check_swell(&desc->swell, error);
    if (!result)
        result = check_bed(&desc->bed, error);
    if (!result)
        result = check_tiles(desc, error);
    if (result)
        return result;
    *out = (sea_state){.depth_m = sea_has_bed(&desc->bed) ? (double)desc->bed.depth_m : ENDLESS,
                       .wind_mps = (double)desc->wind_mps,
                       .wind_direction = (double)desc->wind_direction_rad,
                       .taper_k = ENDLESS,
                       .taper = 1.0};
    out->systems[0] = wind_sea(desc);
    out->systems[1] = swell_sea(&desc->swell, out->depth_m);
    limit_by_depth(out);
    out->bands = sea_bands_make(longest_peak(out), desc->resolution, desc->cascade_count);
    limit_slopes(out);
    return FACET_OK;
}
