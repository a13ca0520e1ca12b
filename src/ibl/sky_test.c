/* sky_test.c - the atmosphere against illuminances at sea level, a spectral computation in 10 nm steps,
 * and Monte Carlo photon tracing. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "ibl/sky_monte_carlo_test.h"

#include "ibl/equirect.h"
#include "ibl/sky_image.h"

static const double degree = 0.017453292519943295;
enum { HEIGHT = 256 };

/* Air, its tables, and an image of its sky without the sun. */
typedef struct scene {
    Atmosphere air[SKY_HALVES];
    sky_luts tables;
    image panorama;
} scene;

static void make_air(scene *s, bool is_very_clear)
{
    s->air[0] = atmosphere_earth(SKY_BANDS_FIRST);
    s->air[1] = atmosphere_earth(SKY_BANDS_SECOND);
    for (int half = 0; half < SKY_HALVES && is_very_clear; half++)
        s->air[half] = atmosphere_with_haze(s->air[half], 4.44e-3f * 1.2f, 0.0f, 0.9f, 0.8f);
    assert_int_equal(sky_luts_create(s->air, NULL, 0, &s->tables, NULL), FACET_OK);
    assert_int_equal(image_create(NULL, 2 * HEIGHT, HEIGHT, 3, IMAGE_F32, &s->panorama, NULL), FACET_OK);
}

static void destroy(scene *s)
{
    sky_luts_destroy(&s->tables);
    image_destroy(&s->panorama);
}

/* The sun towards +Z. */
static void draw(scene *s, double elevation)
{
    sky_view view;
    assert_int_equal(sky_view_create(&s->tables, 0.0f, (float)elevation, NULL, 0, &view, NULL), FACET_OK);
    assert_int_equal(sky_image_atmosphere(&view, 0.0f, NULL, 0, &s->panorama, NULL), FACET_OK);
    sky_view_destroy(&view);
}

/* Angles in degrees, azimuth from the sun. */
static double luminance_at(const scene *s, double elevation, double azimuth)
{
    double e = elevation * degree, a = azimuth * degree;
    float d[3] = {(float)(cos(e) * sin(a)), (float)sin(e), (float)(cos(e) * cos(a))}, c[3];
    equirect_lookup(&s->panorama, d, c);
    return (double)luminance(vec3(c[0], c[1], c[2]));
}

/* Illuminance of level ground by the image. */
static void sum_sky(const scene *s, double out[3])
{
    out[0] = out[1] = out[2] = 0.0;
    for (uint32_t y = 0; y < HEIGHT / 2; y++) {
        double weight = equirect_texel_solid_angle(2 * HEIGHT, HEIGHT, y) * cos((y + 0.5) * MC_PI / HEIGHT);
        for (uint32_t x = 0; x < 2 * HEIGHT; x++)
            for (uint32_t i = 0; i < 3; i++)
                out[i] +=
                    weight * (double)((float *)s->panorama.pixels)[((size_t)y * 2 * HEIGHT + x) * 3 + i];
    }
}

static double relative(double value, double expected)
{
    return value / expected - 1.0;
}

/* The table's sun: elevation, E_n and its color, E_sky and its color, luminances at the zenith, 30 degrees
 * opposite and aside, 5 and 2 degrees aside. */
static const double reference[7][14] = {
    {5, 19130, 1.707, 0.870, 0.210, 4130, 0.88, 1.00, 1.30, 544, 1430, 1040, 2460, 2240},
    {10, 45640, 1.402, 0.936, 0.449, 6650, 0.85, 1.00, 1.40, 799, 1990, 1540, 3850, 3790},
    {20, 75730, 1.245, 0.962, 0.653, 9500, 0.78, 1.02, 1.49, 1137, 2290, 1990, 5140, 5310},
    {30, 90130, 1.195, 0.969, 0.738, 10910, 0.86, 0.99, 1.53, 1370, 2270, 2220, 5700, 5980},
    {45, 100810, 1.164, 0.972, 0.797, 12170, 0.82, 1.00, 1.55, 1964, 2220, 2530, 6200, 6520},
    {60, 105980, 1.151, 0.973, 0.824, 12610, 0.78, 1.00, 1.62, 3203, 2240, 2730, 6410, 6840},
    {90, 109190, 1.143, 0.974, 0.841, 13260, 0.82, 0.99, 1.60, 17500, 2980, 2970, 6600, 7050}};

/* E_n to 0.5 %, as the reference requires, and its color to 0.004. */
static void sunlight_equals_the_reference(void **state)
{
    (void)state;
    static const double very_clear[7] = {34810, 62070, 88640, 100390, 108810, 112800, 115250};
    for (int i = 0; i < 7; i++) {
        const double *r = reference[i];
        scene s;
        s.air[0] = atmosphere_earth(SKY_BANDS_FIRST);
        s.air[1] = atmosphere_earth(SKY_BANDS_SECOND);
        sky_sun_light sun = sky_sun_through_air(s.air, 0.0f, (float)(r[0] * degree), 0.0f);
        vec3 E = sky_sun_illuminance(&sun);
        double Y = (double)luminance(E);
        assert_near(relative(Y, r[1]), 0.0, 0.005);
        for (int c = 0; c < 3; c++)
            assert_near((double)E[c] / Y, r[2 + c], 0.004);
        for (int half = 0; half < SKY_HALVES; half++)
            s.air[half] = atmosphere_with_haze(s.air[half], 4.44e-3f * 1.2f, 0.0f, 0.9f, 0.8f);
        sun = sky_sun_through_air(s.air, 0.0f, (float)(r[0] * degree), 0.0f);
        assert_near(relative((double)luminance(sky_sun_illuminance(&sun)), very_clear[i]), 0.0, 0.005);
    }
}

/* E_sky and luminances to 10 %, as the reference requires: measured, 7 % at most. Colors of E_sky per Y:
 * the reference's own are good to 3 % each, and differ by up to 5 % from a smooth curve over the sun's
 * elevation: 7 %. */
static void skylight_equals_the_reference(void **state)
{
    (void)state;
    static const double directions[5][2] = {{90, 0}, {30, 180}, {30, 90}, {5, 90}, {2, 90}};
    scene s;
    make_air(&s, false);
    for (int i = 0; i < 7; i++) {
        const double *r = reference[i];
        double E[3];
        draw(&s, r[0] * degree);
        sum_sky(&s, E);
        double Y = 0.2126 * E[0] + 0.7152 * E[1] + 0.0722 * E[2];
        assert_near(relative(Y, r[5]), 0.0, 0.1);
        for (int c = 0; c < 3; c++)
            assert_near(relative(E[c] / Y, r[6 + c]), 0.0, 0.07);
        for (int d = 0; d < 5; d++)
            assert_near(relative(luminance_at(&s, directions[d][0], directions[d][1]), r[9 + d]), 0.0, 0.1);
    }
    destroy(&s);
}

static void very_clear_skies_equal_the_reference(void **state)
{
    (void)state;
    static const double expected[7] = {3340, 4770, 6090, 6850, 7360, 7750, 8010};
    scene s;
    make_air(&s, true);
    for (int i = 0; i < 7; i++) {
        double E[3];
        draw(&s, reference[i][0] * degree);
        sum_sky(&s, E);
        assert_near(relative(0.2126 * E[0] + 0.7152 * E[1] + 0.0722 * E[2], expected[i]), 0.0, 0.1);
    }
    destroy(&s);
}

/* ---- one wavelength, in double ---- */

static mc_air band(const Atmosphere *a, int c)
{
    return (mc_air){(double)a->rayleigh[c], (double)a->haze_scattering[c], (double)a->haze_extinction[c],
                    (double)a->haze_g,      (double)a->ozone[c],           (double)a->ground_albedo[c]};
}

typedef struct sight {
    double sun, elevation, azimuth; /* degrees */
} sight;

static void aim(sight v, double d[3], double sun[3])
{
    double e = v.elevation * degree, a = v.azimuth * degree, s = v.sun * degree;
    d[0] = cos(e) * sin(a), d[1] = sin(e), d[2] = cos(e) * cos(a);
    sun[0] = 0.0, sun[1] = sin(s), sun[2] = cos(s);
}

static void march(const scene *s, const double d[3], const double sun[3], AirLight light[SKY_HALVES])
{
    sky_ray ray = {0.0f, (float)d[1], (float)sun[1], (float)mc_dot(d, sun)};
    sky_march(&s->tables, &ray, ray_to_top(0.0f, ray.mu), 48, light);
}

/* Single scattering agrees to 2 %, the error of the steps; the air here has hardly any haze, so that
 * haze_forward_share() does not matter. */
static void single_scattering_equals_monte_carlo(void **state)
{
    (void)state;
    static const sight sights[] = {{60, 80, 0}, {60, 45, 180}, {30, 10, 90},
                                   {10, 3, 30}, {5, 5, 0},     {0.5, 20, 120}};
    scene s;
    make_air(&s, true); /* haze of so little depth that its forward share is less than 0.1 % */
    for (size_t i = 0; i < sizeof sights / sizeof *sights; i++)
        for (int c = 0; c < 3; c++) {
            double d[3], sun[3], eye[3] = {0.0, MC_GROUND + 1e-6, 0.0};
            AirLight light[SKY_HALVES];
            mc_air air = band(&s.air[0], c);
            aim(sights[i], d, sun);
            march(&s, d, sun, light);
            light[0].multiple = vec3(0.0f);
            vec3 L = air_radiance(s.air[0], light[0], (float)mc_dot(d, sun));
            assert_near(relative((double)L[c], mc_single(&air, eye, d, sun)), 0.0, 0.02);
        }
    destroy(&s);
}

/* All orders at 574 and 465 nm, over a bright ground: 12 % plus four standard deviations of the Monte
 * Carlo estimate (1 to 2 % each). The error of the approximation is largest at single wavelengths;
 * luminance is better, see above. */
static void multiple_scattering_is_close_to_monte_carlo(void **state)
{
    (void)state;
    static const sight sights[] = {{60, 2, 90},  {60, 30, 90}, {30, 5, 90},
                                   {30, 30, 45}, {10, 10, 90}, {5, 30, 90}};
    enum { PATHS = 8000 };
    scene s = {.air = {atmosphere_earth(SKY_BANDS_FIRST), atmosphere_earth(SKY_BANDS_SECOND)}};
    sky_atmosphere(1.55f, (float[3]){0.3f, 0.3f, 0.3f}, s.air);
    assert_int_equal(sky_luts_create(s.air, NULL, 0, &s.tables, NULL), FACET_OK);
    for (size_t i = 0; i < sizeof sights / sizeof *sights; i++)
        for (int c = 1; c < 3; c++) {
            double d[3], sun[3], eye[3] = {0.0, MC_GROUND + 1e-6, 0.0}, deviation;
            AirLight light[SKY_HALVES];
            mc_air air = band(&s.air[0], c);
            aim(sights[i], d, sun);
            march(&s, d, sun, light);
            vec3 L = air_radiance(s.air[0], light[0], (float)mc_dot(d, sun));
            double truth = mc_radiance(&air, eye, d, sun, PATHS, 88172645463325252u + i, &deviation);
            assert_near((double)L[c], truth, 0.12 * truth + 4.0 * deviation);
        }
    sky_luts_destroy(&s.tables);
}

/* The sky scatters light of the ground back: E_sky over grounds from black to snow at 574 and 465 nm,
 * within 12 % of the Monte Carlo estimate. */
static void skies_over_bright_ground_agree_with_monte_carlo(void **state)
{
    (void)state;
    enum { PATHS = 20000 };
    for (int i = 0; i <= 2; i++)
        for (int c = 1; c < 3; c++) {
            float albedo = 0.45f * (float)i, mu_sun = 0.7f;
            scene s;
            vec3 sky[SKY_HALVES];
            sky_atmosphere(2.5f, (float[3]){albedo, albedo, albedo}, s.air);
            assert_int_equal(sky_luts_create(s.air, NULL, 0, &s.tables, NULL), FACET_OK);
            sky_irradiance(&s.tables, mu_sun, sky);
            mc_air air = band(&s.air[0], c);
            uint64_t random = 88172645463325252u;
            double eye[3] = {0.0, MC_GROUND + 1e-6, 0.0}, sum = 0.0;
            double sun[3] = {0.0, (double)mu_sun, sqrt(1.0 - (double)(mu_sun * mu_sun))};
            for (int k = 0; k < PATHS; k++) { /* directions by their cosine */
                double u = mc_random(&random), phi = 2.0 * MC_PI * mc_random(&random);
                double d[3] = {sqrt(u) * cos(phi), sqrt(1.0 - u), sqrt(u) * sin(phi)};
                sum += mc_path(&air, eye, d, sun, &random);
            }
            assert_near(relative((double)sky[0][c], MC_PI * sum / PATHS), 0.0, 0.12);
            sky_luts_destroy(&s.tables);
        }
}

/* sky_irradiance() equals the integral of the image. */
static void irradiance_of_the_ground_is_that_of_the_image(void **state)
{
    (void)state;
    scene s;
    make_air(&s, false);
    for (int elevation = -6; elevation <= 90; elevation += 24) {
        double E[3];
        vec3 halves[SKY_HALVES];
        draw(&s, elevation * degree);
        sum_sky(&s, E);
        sky_irradiance(&s.tables, sinf((float)(elevation * degree)), halves);
        vec3 sky = sky_color(&s.tables, halves);
        for (int c = 0; c < 3; c++)
            assert_near(relative((double)sky[c], E[c]), 0.0, 0.02);
    }
    destroy(&s);
}

/* Seen from above, in-scattering in front of the ground grows towards the horizon and continues into the
 * sky there. */
static void in_scattering_is_continuous_across_the_horizon(void **state)
{
    (void)state;
    scene s;
    make_air(&s, false);
    for (int half = 0; half < SKY_HALVES; half++)
        s.tables.air[half].ground_albedo = vec3(0.0f);
    sky_view view;
    assert_int_equal(sky_view_create(&s.tables, 0.3f, (float)(45.0 * degree), NULL, 0, &view, NULL),
                     FACET_OK);
    float horizon = acosf(horizon_mu(0.3f));
    sky_azimuth azimuth = sky_view_azimuth(1.0);
    double last = (double)luminance(sky_view_at(&view, horizon - 1e-5f, &azimuth, 0.5f));
    for (int i = 0; i < 40; i++) {
        float angle = horizon + 1e-5f + 5e-5f * (float)(i * i);
        double now = (double)luminance(sky_view_at(&view, angle, &azimuth, 0.5f));
        assert_near(now / last, 0.95, i == 0 ? 0.1 : 0.051);
        last = now;
    }
    sky_view_destroy(&view);
    destroy(&s);
}

/* Of any number of radians: nodes of the table, and weights that sum to one. */
static void azimuths_of_any_size_are_reduced(void **state)
{
    (void)state;
    for (int i = 0; i < 400; i++) {
        double radians =
            (i % 2 ? -1.0 : 1.0) * pow(10.0, 0.2 * i - 40.0); /* to 6e39, more than floats hold */
        sky_azimuth azimuth = sky_view_azimuth(radians);
        float sum = 0.0f;
        for (int k = 0; k < 4; k++) {
            assert_in_range(azimuth.nodes[k], 0, SKY_VIEW_AZIMUTHS - 1);
            sum += azimuth.weights[k];
        }
        assert_near((double)sum, 1.0, 1e-5);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(sunlight_equals_the_reference),
                                       cmocka_unit_test(skylight_equals_the_reference),
                                       cmocka_unit_test(very_clear_skies_equal_the_reference),
                                       cmocka_unit_test(single_scattering_equals_monte_carlo),
                                       cmocka_unit_test(multiple_scattering_is_close_to_monte_carlo),
                                       cmocka_unit_test(skies_over_bright_ground_agree_with_monte_carlo),
                                       cmocka_unit_test(irradiance_of_the_ground_is_that_of_the_image),
                                       cmocka_unit_test(in_scattering_is_continuous_across_the_horizon),
                                       cmocka_unit_test(azimuths_of_any_size_are_reduced)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
