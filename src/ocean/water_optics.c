/* water_optics.c - from facet_water to shading coefficients. */
#include "ocean/water_optics.h"

#include <math.h>

#include "base/result.h"
#include "ocean/water_spectrum.h"

double water_ior(double lambda_nm, double salinity, double temperature_C)
{
    double S = salinity, T = temperature_C, l = lambda_nm;
    return 1.31405 + (1.779e-4 - 1.05e-6 * T + 1.6e-8 * T * T) * S - 2.02e-6 * T * T +
           (15.868 + 0.01155 * S - 0.00423 * T) / l - 4382.0 / (l * l) + 1.1455e6 / (l * l * l);
}

void pure_water_transmittance(double way_m, double out[3])
{
    water_spectrum s = water_spectrum_case1(0.0, 0.0);
    spectrum_transmittance(s.a, way_m, out);
}

/* Scattering colors are means over daylight; absorption colors are fitted to exponentials over distances in
 * water. */
static void from_spectrum(const water_spectrum *s, double longest_m, water_optics *out)
{
    double a[3], b[3], b_b[3], b_pure[3], deep[3], reflectance[SPECTRUM_COUNT];
    for (int i = 0; i < SPECTRUM_COUNT; i++)
        reflectance[i] = water_reflectance(s->a[i], s->b_b[i]);
    spectrum_attenuation(s->a, longest_m, a);
    spectrum_color(s->b, b);
    spectrum_color(s->b_b, b_b);
    spectrum_color(s->b_pure, b_pure);
    spectrum_color(reflectance, deep);
    for (int k = 0; k < 3; k++) {
        out->absorption[k] = (float)a[k];
        out->scattering[k] = (float)b[k];
        out->backscattering[k] = (float)b_b[k];
        out->pure_share[k] = (float)fmin(fmax(b_pure[k] / b[k], 0.0), 1.0);
        out->reflectance[k] = (float)fmax(deep[k], 0.0);
    }
}

static void from_coefficients(const facet_water *water, water_optics *out)
{
    for (int k = 0; k < 3; k++) {
        out->absorption[k] = water->absorption[k];
        out->scattering[k] = water->scattering[k];
        out->backscattering[k] = water->backscattering[k];
        /* Half of molecular scattering goes backwards, hardly any of that by particles. */
        out->pure_share[k] = water->scattering[k] > 0.0f
                                 ? fminf(2.0f * water->backscattering[k] / water->scattering[k], 1.0f)
                                 : 0.0f;
        out->reflectance[k] =
            (float)water_reflectance((double)water->absorption[k], (double)water->backscattering[k]);
    }
}

static facet_result check_range(const char *name, double value, double low, double high, facet_error *error)
{
    if (value >= low && value <= high)
        return FACET_OK;
    return fail(error, FACET_ERROR_ARGUMENT, "water: %s is %g; expected %g to %g", name, value, low, high);
}

static facet_result check_coefficients(const facet_water *water, facet_error *error)
{
    static const char channels[3] = {'R', 'G', 'B'};
    for (int k = 0; k < 3; k++) {
        float a = water->absorption[k], b = water->scattering[k], b_b = water->backscattering[k];
        if (!(a >= 0.0f && b >= 0.0f && b_b >= 0.0f && isfinite(a) && isfinite(b)) || b_b > b)
            return fail(error, FACET_ERROR_ARGUMENT,
                        "water: %c of absorption, scattering, backscattering is %g, %g, %g 1/m; expected "
                        "numbers from 0, "
                        "and backscattering of at most scattering",
                        channels[k], (double)a, (double)b, (double)b_b);
    }
    return FACET_OK;
}

static facet_result check(const facet_water *water, facet_error *error)
{
    facet_result result = check_range("salinity", (double)water->salinity, 0.0, 40.0, error);
    if (!result)
        result = check_range("chlorophyll", (double)water->chlorophyll_mg_m3, 0.0, 30.0, error);
    if (!result)
        result = check_range("temperature", (double)water->temperature_C, -10.0, 100.0, error);
    if (!result && !(water->ior == 0.0f))
        result = check_range("index of refraction", (double)water->ior, 1.0, 2.0, error);
    if (!result)
        result = check_range("foam albedo", (double)water->foam_albedo, 0.0, 1.0, error);
    if (!result && (unsigned)water->kind > FACET_WATER_KIND_COEFFICIENTS)
        result =
            fail(error, FACET_ERROR_ARGUMENT, "water: kind %d is not a facet_water_kind", (int)water->kind);
    if (!result && water->kind == FACET_WATER_KIND_COEFFICIENTS)
        result = check_coefficients(water, error);
    return result;
}

facet_result water_optics_create(const facet_water *water, water_optics *out, facet_error *error)
{
    *out = (water_optics){0};
    facet_result result = check(water, error);
    if (result)
        return result;
    double salinity = (double)water->salinity;
    out->ior =
        water->ior != 0.0f ? water->ior : (float)water_ior(550.0, salinity, (double)water->temperature_C);
    out->foam_albedo = water->foam_albedo;
    if (water->kind == FACET_WATER_KIND_COEFFICIENTS) {
        from_coefficients(water, out);
        return FACET_OK;
    }
    bool is_jerlov = water->kind != FACET_WATER_KIND_CHLOROPHYLL;
    bool is_pure = !is_jerlov && water->chlorophyll_mg_m3 == 0.0f;
    water_spectrum s =
        is_jerlov ? water_spectrum_jerlov((int)water->kind - (int)FACET_WATER_KIND_JERLOV_I, salinity)
                  : water_spectrum_case1((double)water->chlorophyll_mg_m3, salinity);
    from_spectrum(&s, is_pure ? 50.0 : 20.0, out); /* visibility is higher in pure water */
    return FACET_OK;
}
