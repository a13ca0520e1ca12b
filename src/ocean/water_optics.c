/* water_optics.c - tabulated optical properties of water, the colors of spectra, and coefficients for shading
 * from a facet_water. */
#include "ocean/water_optics.h"

#include <math.h>

#include "base/result.h"
#include "image/primaries.h"

/* ---- tables, every 10 nm from 380 to 720 ---- */

enum { TABLE_STEP_NM = 10, TABLE_COUNT = 35 };

/* Absorption of pure water, 1/m. Pope and Fry 1997, table 3. */
static const double pure_absorption[TABLE_COUNT] = {
    0.01137, 0.00851, 0.00663, 0.00473, 0.00454, 0.00495, 0.00635, 0.00922, 0.00979,
    0.01060, 0.01270, 0.01500, 0.02040, 0.03250, 0.04090, 0.04340, 0.04740, 0.05650,
    0.06190, 0.06950, 0.08960, 0.13510, 0.22240, 0.26440, 0.27550, 0.29160, 0.31080,
    0.34000, 0.41000, 0.43900, 0.46500, 0.51600, 0.62400, 0.82700, 1.23100};

/* Absorption of chlorophyll over that at 440 nm. Prieur and Sathyendranath 1981, table 3; beyond 400 and
 * 700 nm the value there. */
static const double chlorophyll_absorption[TABLE_COUNT] = {
    0.687, 0.687, 0.687, 0.828, 0.913, 0.973, 1.000, 0.944, 0.917, 0.870, 0.798, 0.750,
    0.668, 0.618, 0.528, 0.474, 0.416, 0.357, 0.294, 0.276, 0.291, 0.282, 0.236, 0.252,
    0.276, 0.317, 0.334, 0.356, 0.441, 0.595, 0.502, 0.329, 0.215, 0.215, 0.215};

/* Every 25 nm from 400 to 700, types I IA IB II III 1C 3C 5C 7C 9C. */
enum { JERLOV_FIRST_NM = 400, JERLOV_STEP_NM = 25, JERLOV_SAMPLES = 13 };
static const double jerlov[JERLOV_COUNT][JERLOV_SAMPLES] = {
    {0.0217, 0.0185, 0.0176, 0.0184, 0.028, 0.0504, 0.064, 0.0931, 0.2408, 0.3174, 0.3559, 0.4372, 0.6513},
    {0.0316, 0.028, 0.0257, 0.025, 0.0332, 0.0545, 0.0674, 0.096, 0.2437, 0.3206, 0.3601, 0.441, 0.653},
    {0.0438, 0.0395, 0.0355, 0.033, 0.0396, 0.0596, 0.0715, 0.0995, 0.2471, 0.3245, 0.3652, 0.4457, 0.655},
    {0.0878, 0.0814, 0.0714, 0.062, 0.0627, 0.0779, 0.0863, 0.1122, 0.2595, 0.3389, 0.3837, 0.4626, 0.6623},
    {0.1697, 0.1594, 0.1381, 0.116, 0.1056, 0.112, 0.1139, 0.1359, 0.2826, 0.3655, 0.4181, 0.4942, 0.676},
    {0.2516, 0.2374, 0.2048, 0.17, 0.1486, 0.1461, 0.1415, 0.1596, 0.3057, 0.3922, 0.4525, 0.5257, 0.6896},
    {0.78, 0.54, 0.39, 0.29, 0.22, 0.2, 0.19, 0.21, 0.33, 0.4, 0.46, 0.56, 0.71},
    {1.1, 0.78, 0.56, 0.43, 0.36, 0.31, 0.3, 0.33, 0.4, 0.48, 0.54, 0.65, 0.8},
    {1.6, 1.2, 0.89, 0.71, 0.58, 0.49, 0.46, 0.46, 0.48, 0.54, 0.63, 0.78, 0.92},
    {2.4, 1.9, 1.6, 1.23, 0.99, 0.78, 0.63, 0.58, 0.6, 0.65, 0.76, 0.92, 1.1}};

/* Linear between samples, constant outside. */
static double table_at(const double *table, int count, double first_nm, double step_nm, double nm)
{
    double x = fmin(fmax((nm - first_nm) / step_nm, 0.0), count - 1);
    int i = (int)fmin(x, count - 2);
    return table[i] + (table[i + 1] - table[i]) * (x - i);
}

static double wavelength(int i)
{
    return SPECTRUM_FIRST_NM + SPECTRUM_STEP_NM * i;
}

/* ---- what is in the water ---- */

/* Pure sea water, 1/m. Morel 1974. */
static double pure_scattering(double nm, double salinity)
{
    double sea = 0.00288 * pow(500.0 / nm, 4.32);
    return sea * (1.0 + 0.3 * fmin(salinity / 35.0, 1.0)) / 1.3;
}

water_spectrum water_spectrum_case1(double chlorophyll, double salinity)
{
    water_spectrum s;
    double C = chlorophyll;
    for (int i = 0; i < SPECTRUM_COUNT; i++) {
        double nm = wavelength(i);
        double a_w = table_at(pure_absorption, TABLE_COUNT, SPECTRUM_FIRST_NM, TABLE_STEP_NM, nm);
        double A_c = table_at(chlorophyll_absorption, TABLE_COUNT, SPECTRUM_FIRST_NM, TABLE_STEP_NM, nm);
        double dissolved = 1.0 + 0.2 * exp(-0.014 * (nm - 440.0));
        double b_p = 0.30 * pow(C, 0.62) * 550.0 / nm;
        double back = C > 0.0 ? 0.002 + 0.02 * (0.5 - 0.25 * log10(C)) * 550.0 / nm : 0.0;
        s.b_pure[i] = pure_scattering(nm, salinity);
        s.a[i] = C > 0.0 ? (a_w + 0.06 * A_c * pow(C, 0.65)) * dissolved : a_w;
        s.b[i] = s.b_pure[i] + b_p;
        s.b_b[i] = 0.5 * s.b_pure[i] + back * b_p;
    }
    return s;
}

void jerlov_attenuation(int type, double K_d[SPECTRUM_COUNT])
{
    for (int i = 0; i < SPECTRUM_COUNT; i++)
        K_d[i] = table_at(jerlov[type], JERLOV_SAMPLES, JERLOV_FIRST_NM, JERLOV_STEP_NM, wavelength(i));
}

/* Mean cosine of downward light: K_d = (a + b_b) / this. */
static const double mean_cosine = 0.86;

/* Squared distance of logarithms from 440 to 560 nm, where types differ. */
static double distance_from(const double K_d[SPECTRUM_COUNT], const water_spectrum *s)
{
    double sum = 0.0;
    for (int i = 12; i <= 36; i++) {
        double d = log((s->a[i] + s->b_b[i]) / (mean_cosine * K_d[i]));
        sum += d * d;
    }
    return sum;
}

water_spectrum water_spectrum_jerlov(int type, double salinity)
{
    double K_d[SPECTRUM_COUNT];
    jerlov_attenuation(type, K_d);
    water_spectrum pure = water_spectrum_case1(0.0, salinity), nearest = pure;
    for (int i = 0; i <= 120; i++) { /* 0.01 to 30 mg/m^3 */
        water_spectrum s = water_spectrum_case1(0.01 * pow(3000.0, i / 120.0), salinity);
        if (distance_from(K_d, &s) < distance_from(K_d, &nearest))
            nearest = s;
    }
    for (int i = 0; i < SPECTRUM_COUNT; i++)
        nearest.a[i] = fmax(mean_cosine * K_d[i] - nearest.b_b[i], pure.a[i]);
    return nearest;
}

double water_reflectance(double a, double b_b)
{
    double u = b_b > 0.0 ? b_b / (a + b_b) : 0.0;
    double r_rs = (0.0895 + 0.1247 * u) * u;
    double lee = 3.14159265358979324 * 0.52 * r_rs / (1.0 - 1.7 * r_rs);
    /* 1 / (1 + K / S + ..) is 1 + K / S - .. without cancelling */
    double K_S = b_b > 0.0 ? a / (2.0 * 3.14159265358979324 * 0.0895 * b_b) : HUGE_VAL;
    double R = 1.0 / (1.0 + K_S + sqrt(K_S * (K_S + 2.0)));
    return fmax(lee, 0.52 * R / (1.0 - 0.48 * R));
}

/* ---- colors ---- */

void spectrum_color(const double spectrum[SPECTRUM_COUNT], double rgb[3])
{
    double sum[3] = {0, 0, 0}, white[3] = {0, 0, 0}, white_rgb[3];
    for (int i = 0; i < SPECTRUM_COUNT; i++) {
        double xyz[3];
        cie_match_color(wavelength(i), xyz);
        double light = table_at(cie_d65, CIE_D65_COUNT, CIE_D65_FIRST, CIE_D65_STEP, wavelength(i));
        for (int k = 0; k < 3; k++) {
            sum[k] += xyz[k] * light * spectrum[i];
            white[k] += xyz[k] * light;
        }
    }
    cie_rec709_from_xyz(sum, rgb);
    cie_rec709_from_xyz(white, white_rgb);
    for (int k = 0; k < 3; k++)
        rgb[k] /= white_rgb[k];
}

void spectrum_transmittance(const double attenuation[SPECTRUM_COUNT], double distance_m, double rgb[3])
{
    double transmitted[SPECTRUM_COUNT];
    for (int i = 0; i < SPECTRUM_COUNT; i++)
        transmitted[i] = exp(-attenuation[i] * distance_m);
    spectrum_color(transmitted, rgb);
}

static const double distances_m[] = {0.5, 1, 2, 3, 5, 7, 10, 15, 20, 30, 50};
enum { DISTANCES = sizeof distances_m / sizeof *distances_m };

static double misfit(const double *truth, int count, double k)
{
    double sum = 0.0;
    for (int i = 0; i < count; i++) {
        double d = exp(-k * distances_m[i]) - truth[i];
        sum += d * d;
    }
    return sum;
}

/* Minimizes the misfit over k, which has one minimum, by ternary search. */
static double fit_exponential(const double *truth, int count)
{
    double low = 0.0, high = 20.0;
    for (int i = 0; i < 100; i++) {
        double third = (high - low) / 3.0;
        if (misfit(truth, count, low + third) < misfit(truth, count, high - third))
            high -= third;
        else
            low += third;
    }
    return 0.5 * (low + high);
}

void spectrum_attenuation(const double attenuation[SPECTRUM_COUNT], double longest_m, double rgb[3])
{
    double truth[3][DISTANCES];
    int count = 0;
    for (; count < DISTANCES && distances_m[count] <= longest_m; count++) {
        double color[3];
        spectrum_transmittance(attenuation, distances_m[count], color);
        for (int k = 0; k < 3; k++)
            truth[k][count] = fmax(color[k], 0.0);
    }
    for (int k = 0; k < 3; k++)
        rgb[k] = fit_exponential(truth[k], count);
}

/* ---- of a facet_water ---- */

double water_ior(double lambda_nm, double salinity, double temperature_C)
{
    double S = salinity, T = temperature_C, l = lambda_nm;
    return 1.31405 + (1.779e-4 - 1.05e-6 * T + 1.6e-8 * T * T) * S - 2.02e-6 * T * T +
           (15.868 + 0.01155 * S - 0.00423 * T) / l - 4382.0 / (l * l) + 1.1455e6 / (l * l * l);
}

void pure_water_transmittance(double distance_m, double out[3])
{
    water_spectrum s = water_spectrum_case1(0.0, 0.0);
    spectrum_transmittance(s.a, distance_m, out);
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
