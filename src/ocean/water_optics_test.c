/* water_optics_test.c - colors of water against independently computed tables, and invariants. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <setjmp.h>

#include <cmocka.h>

#include <math.h>

#include "ocean/water_optics.h"

static void expect_near(double value, double expected, double tolerance, const char *what, double of,
                        int channel)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%s of %g, channel %d: %g, expected %g within %g", what, of, channel, value, expected,
                 tolerance);
}

static const facet_water clear_sea = {.kind = FACET_WATER_KIND_CHLOROPHYLL,
                                      .chlorophyll_mg_m3 = 0.2f,
                                      .salinity = 35.0f,
                                      .temperature_C = 20.0f,
                                      .foam_albedo = 0.4f};

static water_optics optics_of(facet_water water)
{
    water_optics o;
    facet_error error;
    if (water_optics_create(&water, &o, &error))
        fail_msg("%s", error.message);
    return o;
}

/* The table was searched in steps of 0.0005 1/m, larger values printed to three digits. */
static double step_of(double value)
{
    return value < 0.1 ? 0.0005 : fmax(0.00051, 0.005 * value);
}

static const struct case1_row {
    double chlorophyll, a[3], c[3], b[3], b_b[3], reflectance[3];
} case1_rows[] = {
    {0,
     {0.328, 0.0505, 0.0045},
     {0.328, 0.0525, 0.0090},
     {0.0009, 0.0019, 0.0048},
     {0.00045, 0.00097, 0.00241},
     {0.0021, 0.0000, 0.0521}},
    {0.03,
     {0.332, 0.0555, 0.0125},
     {0.356, 0.0915, 0.0585},
     {0.030, 0.036, 0.047},
     {0.00094, 0.00165, 0.00342},
     {0.0000, 0.0034, 0.0341}},
    {0.1,
     {0.332, 0.0585, 0.0205},
     {0.384, 0.133, 0.113},
     {0.062, 0.075, 0.094},
     {0.00135, 0.00221, 0.00425},
     {0.0000, 0.0053, 0.0280}},
    {0.2,
     {0.332, 0.0620, 0.0290},
     {0.412, 0.175, 0.169},
     {0.095, 0.114, 0.142},
     {0.00171, 0.00271, 0.00498},
     {0.0000, 0.0064, 0.0242}},
    {0.3,
     {0.332, 0.0645, 0.0360},
     {0.438, 0.209, 0.215},
     {0.122, 0.146, 0.182},
     {0.00198, 0.00308, 0.00552},
     {0.0000, 0.0071, 0.0221}},
    {1,
     {0.332, 0.0785, 0.0720},
     {0.570, 0.382, 0.448},
     {0.256, 0.305, 0.378},
     {0.00312, 0.00463, 0.00777},
     {0.0000, 0.0089, 0.0161}},
    {3,
     {0.332, 0.105, 0.143},
     {0.826, 0.704, 0.884},
     {0.506, 0.601, 0.742},
     {0.00471, 0.00676, 0.01083},
     {0.0012, 0.0097, 0.0114}},
    {10,
     {0.340, 0.167, 0.312},
     {1.42, 1.43, 1.87},
     {1.07, 1.26, 1.56},
     {0.00708, 0.00986, 0.01515},
     {0.0031, 0.0089, 0.0073}},
};

static void chlorophyll_has_the_tabulated_coefficients(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof case1_rows / sizeof *case1_rows; i++) {
        const struct case1_row *row = &case1_rows[i];
        double C = row->chlorophyll;
        water_spectrum s = water_spectrum_case1(C, 35.0);
        double sum[SPECTRUM_COUNT], a[3], c[3];
        for (int k = 0; k < SPECTRUM_COUNT; k++)
            sum[k] = s.a[k] + s.b[k];
        spectrum_attenuation(s.a, 20.0, a);
        spectrum_attenuation(sum, 20.0, c);
        facet_water water = clear_sea;
        water.chlorophyll_mg_m3 = (float)C;
        water_optics o = optics_of(water);
        for (int k = 0; k < 3; k++) {
            expect_near(a[k], row->a[k], step_of(row->a[k]), "absorption", C, k);
            expect_near(c[k], row->c[k], step_of(row->c[k]), "a + b", C, k);
            expect_near((double)o.scattering[k], row->b[k],
                        row->b[k] < 0.01 ? 5.1e-5 : step_of(row->b[k]) + 1e-4, "scattering", C, k);
            expect_near((double)o.backscattering[k], row->b_b[k], 1.1e-5, "backscattering", C, k);
            expect_near((double)o.reflectance[k], row->reflectance[k],
                        (k == 0 ? 0.05 : 0.012) * row->reflectance[k] + 5.1e-5, "reflectance", C, k);
            /* red is a small difference of what the color matching functions see on either side of 0 */
            if (C > 0.0)
                expect_near((double)o.absorption[k], a[k], 1e-6, "absorption that is used", C, k);
        }
    }
}

/* From blue to green with chlorophyll; up to 1 mg/m^3 red < green < blue. */
static void chlorophyll_turns_blue_to_green(void **state)
{
    (void)state;
    double last = 0.0;
    for (float C = 0.02f; C < 30.0f; C *= 1.4f) {
        facet_water water = clear_sea;
        water.chlorophyll_mg_m3 = C;
        water_optics o = optics_of(water);
        double greenness = (double)(o.reflectance[1] / o.reflectance[2]);
        assert_true(greenness > last);
        last = greenness;
        assert_true(C > 1.0f || (o.reflectance[0] < o.reflectance[1] && o.reflectance[1] < o.reflectance[2]));
        for (int k = 0; k < 3; k++)
            assert_true(o.backscattering[k] < o.scattering[k] && o.pure_share[k] > 0.0f &&
                        o.pure_share[k] < 1.0f);
    }
    assert_true(last > 1.0);
}

static void pure_water_has_the_tabulated_transmittance(void **state)
{
    (void)state;
    const double distances_m[5] = {1, 5, 10, 20, 50};
    const double golden[5][3] = {{0.740, 0.953, 1.000},
                                 {0.182, 0.779, 0.989},
                                 {0, 0.602, 0.965},
                                 {0, 0.362, 0.903},
                                 {0, 0.079, 0.713}};
    for (int i = 0; i < 5; i++) {
        double T[3];
        pure_water_transmittance(distances_m[i], T);
        for (int k = 0; k < 3;
             k++) /* the golden table's spectrum was finer below 500 nm, where 10 nm steps cost 0.002 */
            expect_near(fmax(T[k], 0.0), golden[i][k], 0.0025, "transmittance", distances_m[i], k);
    }
    facet_water water = clear_sea;
    water.chlorophyll_mg_m3 = 0.0f;
    water_optics o = optics_of(water);
    const double a[3] = {0.3275, 0.0505, 0.0060};
    for (int k = 0; k < 3; k++) {
        expect_near((double)o.absorption[k], a[k], 0.0005, "absorption of pure water", 0.0, k);
        expect_near((double)o.pure_share[k], 1.0, 1e-5, "its own scattering", 0.0, k);
    }
    /* exponentials against the spectrum, root mean square from 0.5 to 50 m: 0.015 */
    double sum = 0.0;
    int count = 0;
    for (double d = 0.5; d <= 50.0; d *= 1.1, count++) {
        double T[3];
        pure_water_transmittance(d, T);
        for (int k = 0; k < 3; k++)
            sum += pow(exp(-(double)o.absorption[k] * d) - fmax(T[k], 0.0), 2.0) / 3.0;
    }
    assert_true(sqrt(sum / count) < 0.0175);
    /* fresh water scatters 1.3 times less */
    water.salinity = 0.0f;
    water_optics fresh = optics_of(water);
    expect_near((double)(o.scattering[2] / fresh.scattering[2]), 1.3, 1e-4, "sea over fresh water", 0.0, 2);
}

static const double jerlov_rows[JERLOV_COUNT][3] = {
    {.368, .0605, .0140}, {.370, .0640, .0220}, {.372, .0685, .0315}, {.380, .0840, .0670},
    {.392, .114, .134},   {.408, .144, .201},   {.416, .193, .404},   {.484, .304, .588},
    {.524, .466, .948},   {.582, .680, 1.67}};

static void jerlov_types_have_their_attenuation(void **state)
{
    (void)state;
    double last = 0.0;
    for (int type = 0; type < JERLOV_COUNT; type++) {
        double K_d[SPECTRUM_COUNT], rgb[3];
        jerlov_attenuation(type, K_d);
        spectrum_attenuation(K_d, 20.0, rgb);
        facet_water water = clear_sea;
        water.kind = (facet_water_kind)((int)FACET_WATER_KIND_JERLOV_I + type);
        water_optics o = optics_of(water);
        for (int k = 0; k < 3; k++) {
            expect_near(rgb[k], jerlov_rows[type][k], fmax(0.001, 0.004 * rgb[k]), "K_d of Jerlov's type",
                        type, k);
            /* what absorbs and scatters so attenuates so */
            double K = (double)(o.absorption[k] + o.backscattering[k]) / 0.86;
            expect_near(K, rgb[k], 0.10 * rgb[k] + 0.001, "K_d from a and b_b of type", type, k);
            assert_true(o.backscattering[k] < o.scattering[k]);
        }
        assert_true((double)o.scattering[1] >= last); /* each is as turbid as the one before, or more */
        last = (double)o.scattering[1];
    }
    water_spectrum I =
        water_spectrum_case1(0.03, 35.0); /* the clearest type is the open ocean's clearest water */
    double K_d[SPECTRUM_COUNT], rgb[3];
    for (int i = 0; i < SPECTRUM_COUNT; i++)
        K_d[i] = (I.a[i] + I.b_b[i]) / 0.86;
    spectrum_attenuation(K_d, 20.0, rgb);
    const double golden[3] = {0.388, 0.0665, 0.0185};
    for (int k = 0; k < 3; k++)
        expect_near(rgb[k], golden[k], 0.0006, "K_d of chlorophyll", 0.03, k);
}

static void the_ior_is_that_of_quan_and_fry(void **state)
{
    (void)state;
    const double nm[7] = {400, 450, 500, 550, 589.3, 650, 700};
    const double fresh[7] = {1.34321, 1.33925, 1.33644, 1.33434, 1.33300, 1.33132, 1.33019};
    const double cold[7] = {1.35147, 1.34737, 1.34446, 1.34226, 1.34087, 1.33911, 1.33792};
    const double warm[7] = {1.34994, 1.34586, 1.34297, 1.34079, 1.33941, 1.33766, 1.33648};
    for (int i = 0; i < 7; i++) {
        expect_near(water_ior(nm[i], 0.0, 20.0), fresh[i], 6e-6, "ior, fresh", nm[i], 0);
        expect_near(water_ior(nm[i], 35.0, 0.0), cold[i], 6e-6, "ior, cold", nm[i], 0);
        expect_near(water_ior(nm[i], 35.0, 20.0), warm[i], 6e-6, "ior, warm", nm[i], 0);
    }
    expect_near((double)optics_of(clear_sea).ior, 1.34079, 1e-5, "ior by itself", 550, 0);
    facet_water water = clear_sea;
    water.ior = 1.4f;
    assert_true(optics_of(water).ior == 1.4f);
}

/* What absorbs nothing sends all back; and as far as seas go nothing but Lee's equation is asked. */
static void reflectance_follows_lee_and_is_one_without_absorption(void **state)
{
    (void)state;
    expect_near(water_reflectance(0.0, 0.003), 1.0, 1e-12, "reflectance without absorption", 0.0, 0);
    assert_true(water_reflectance(0.0, 0.0) == 0.0 && water_reflectance(1.0, 0.0) == 0.0);
    double last = 1.0;
    for (double a = 1e-6; a < 100.0; a *= 1.1) {
        double is = water_reflectance(a, 0.01), u = 0.01 / (a + 0.01), r = (0.0895 + 0.1247 * u) * u;
        assert_true(is < last && is > 0.0);
        if (u < 0.9)
            expect_near(is, 3.14159265358979 * 0.52 * r / (1.0 - 1.7 * r), 1e-12, "Lee's", a, 0);
        last = is;
    }
}

static void expect_refused(facet_water water, const char *word)
{
    water_optics o;
    facet_error error = {0};
    assert_int_equal(water_optics_create(&water, &o, &error), FACET_ERROR_ARGUMENT);
    if (!strstr(error.message, word))
        fail_msg("'%s' does not name '%s'", error.message, word);
}

static void values_out_of_range_are_named(void **state)
{
    (void)state;
    facet_water w = clear_sea;
    w.chlorophyll_mg_m3 = -1.0f;
    expect_refused(w, "chlorophyll");
    w = clear_sea;
    w.salinity = NAN;
    expect_refused(w, "salinity");
    w = clear_sea;
    w.ior = 0.9f;
    expect_refused(w, "refraction");
    w = clear_sea;
    w.foam_albedo = 1.5f;
    expect_refused(w, "foam");
    w = clear_sea;
    w.kind = (facet_water_kind)99;
    expect_refused(w, "kind");
    w = (facet_water){.kind = FACET_WATER_KIND_COEFFICIENTS, .absorption = {0.1f, 0.2f, -0.3f}};
    expect_refused(w, "absorption");
    w = (facet_water){.kind = FACET_WATER_KIND_COEFFICIENTS,
                      .scattering = {0.1f, 0.2f, 0.3f},
                      .backscattering = {0.2f, 0.0f, 0.0f}};
    expect_refused(w, "scattering");
    w = (facet_water){.kind = FACET_WATER_KIND_COEFFICIENTS,
                      .absorption = {0.1f, 0.2f, 0.3f},
                      .scattering = {0.1f, 0.2f, 0.0f},
                      .backscattering = {0.05f, 0.002f, 0.0f}};
    water_optics o = optics_of(w);
    assert_true(o.absorption[2] == 0.3f && o.pure_share[0] == 1.0f && o.pure_share[2] == 0.0f &&
                o.reflectance[2] == 0.0f);
    expect_near((double)o.reflectance[0], water_reflectance(0.1, 0.05), 1e-6, "reflectance of coefficients",
                0.0, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chlorophyll_has_the_tabulated_coefficients),
        cmocka_unit_test(chlorophyll_turns_blue_to_green),
        cmocka_unit_test(pure_water_has_the_tabulated_transmittance),
        cmocka_unit_test(jerlov_types_have_their_attenuation),
        cmocka_unit_test(the_ior_is_that_of_quan_and_fry),
        cmocka_unit_test(reflectance_follows_lee_and_is_one_without_absorption),
        cmocka_unit_test(values_out_of_range_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
