/* sky_image_test.c - images of skies: the sun's energy in any of them, symmetry, seams, numbers that stay
 * numbers, exposure, arguments; and gradients. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "ibl/environment.h"

#include "ibl/equirect.h"
#include "ibl/sky_image.h"

static const double degree = 0.017453292519943295;
static const double pi = 3.14159265358979323846;

static facet_environment *create(facet_sky_desc sky)
{
    facet_environment *e = NULL;
    facet_error error = {0};
    facet_result result = facet_environment_create_sky(&sky, NULL, &e, &error);
    if (result != FACET_OK)
        print_error("%s\n", error.message);
    assert_int_equal(result, FACET_OK);
    return e;
}

static const float *texel(const image *p, uint32_t x, uint32_t y)
{
    return (const float *)p->pixels + ((size_t)y * p->width + x) * 3;
}

static double luminance_of(const float *c)
{
    return (double)luminance(vec3(c[0], c[1], c[2]));
}

/* Illuminance of a surface of normal n. */
static double illuminance(const image *p, const double n[3])
{
    double sum = 0.0;
    for (uint32_t y = 0; y < p->height; y++)
        for (uint32_t x = 0; x < p->width; x++) {
            float d[3];
            equirect_direction(p->width, p->height, x, y, d);
            double cosine = n[0] * (double)d[0] + n[1] * (double)d[1] + n[2] * (double)d[2];
            sum += luminance_of(texel(p, x, y)) * fmax(cosine, 0.0) *
                   equirect_texel_solid_angle(p->width, p->height, y);
        }
    return sum;
}

/* ---- the disc ---- */

/* All of the sun's light is in an image of any size, at any height of the sun: 0.05 %, for sums of float. */
static void the_disc_keeps_its_energy_at_any_resolution(void **state)
{
    (void)state;
    static const uint32_t heights[] = {2, 3, 16, 64, 257, 512, 1024};
    static const double elevations[] = {0.1, 5.0, 40.0, 89.9, 90.0};
    Atmosphere air[SKY_HALVES] = {atmosphere_earth(SKY_BANDS_FIRST), atmosphere_earth(SKY_BANDS_SECOND)};
    for (size_t h = 0; h < sizeof heights / sizeof *heights; h++)
        for (size_t e = 0; e < sizeof elevations / sizeof *elevations; e++) {
            image p = {0};
            assert_int_equal(image_create(NULL, 2 * heights[h], heights[h], 3, IMAGE_F32, &p, NULL),
                             FACET_OK);
            memset(p.pixels, 0, p.height * image_row_size(&p));
            sky_sun_light sun = sky_sun_through_air(air, 0.0f, (float)(elevations[e] * degree), 1.0f);
            sky_sun_draw(&sun, &p);
            double sum[3] = {0.0, 0.0, 0.0};
            for (uint32_t y = 0; y < p.height; y++)
                for (uint32_t x = 0; x < p.width; x++)
                    for (int i = 0; i < 3; i++)
                        sum[i] +=
                            (double)texel(&p, x, y)[i] * equirect_texel_solid_angle(p.width, p.height, y);
            vec3 expected = sky_sun_illuminance(&sun);
            for (int i = 0; i < 3; i++) /* the blue of an orange sun may be 0 */
                assert_near(sum[i], (double)expected[i], 5e-4 * (double)luminance(expected));
            image_destroy(&p);
        }
}

/* The disc is as wide as the sun, in the right place, darker at its limb, without holes. */
static void the_disc_has_the_size_and_limb_of_the_sun(void **state)
{
    (void)state;
    enum { SIZE = 4096 };
    image p = {0};
    Atmosphere air[SKY_HALVES] = {atmosphere_earth(SKY_BANDS_FIRST), atmosphere_earth(SKY_BANDS_SECOND)};
    assert_int_equal(image_create(NULL, 2 * SIZE, SIZE, 3, IMAGE_F32, &p, NULL), FACET_OK);
    memset(p.pixels, 0, p.height * image_row_size(&p));
    double elevation = 50.0 * degree, azimuth = 0.7;
    sky_sun_light sun = sky_sun_through_air(air, 0.0f, (float)elevation, (float)azimuth);
    sky_sun_draw(&sun, &p);
    double towards[3] = {cos(elevation) * sin(azimuth), sin(elevation), cos(elevation) * cos(azimuth)};
    double mean = (double)luminance(sky_sun_illuminance(&sun)) / (double)SUN_SOLID_ANGLE;
    uint32_t top = (uint32_t)(0.95 * (0.5 * pi - elevation) / pi * SIZE);
    uint32_t middle = (uint32_t)((0.5 + (0.5 * pi - azimuth) / (2.0 * pi)) * p.width);
    for (uint32_t y = 0; y < p.height; y++) /* nothing far from it */
        for (uint32_t x = 0; x < p.width; x += (y >= top && y < 2 * SIZE / 7 ? 1 : 61))
            if (x < middle - 50 || x > middle + 50)
                assert_true(*texel(&p, x, y) == 0.0f);
    for (uint32_t y = top; y < 2 * SIZE / 7; y++)
        for (uint32_t x = middle - 50; x <= middle + 50; x++) {
            float d[3];
            equirect_direction(p.width, p.height, x, y, d);
            double cosine = towards[0] * (double)d[0] + towards[1] * (double)d[1] + towards[2] * (double)d[2];
            double r = acos(fmin(cosine, 1.0)) / (double)SUN_RADIUS; /* 1: the edge; a texel is 0.17 wide */
            double L = luminance_of(texel(&p, x, y)) / mean;
            if (r > 1.13)
                assert_true(L == 0.0);
            if (r < 0.85) { /* linear limb darkening of 0.6 */
                double expected = (1.0 - 0.6 * (1.0 - sqrt(1.0 - r * r))) / 0.8;
                assert_near(L / expected, 1.0, 0.03);
            }
        }
    image_destroy(&p);
}

/* The difference of skies with and without the disc is the sun. */
static void skies_contain_the_disc(void **state)
{
    (void)state;
    for (int model = 0; model < 2; model++) {
        facet_sky_desc sky = {.model = (facet_sky_model)model,
                              .sun_elevation_rad = (float)(35.0 * degree),
                              .sun_azimuth_rad = -2.0f,
                              .turbidity = 2.0f,
                              .height = 128};
        double n[3] = {cos(35.0 * degree) * sin(-2.0), sin(35.0 * degree), cos(35.0 * degree) * cos(-2.0)};
        facet_environment *with = create(sky);
        sky.omits_disc = true;
        facet_environment *without = create(sky);
        double sun = illuminance(&with->panorama, n) - illuminance(&without->panorama, n);
        assert_true(sun > 80000.0 && sun < 96000.0); /* 90 to 100 klx above a sea; this sky is hazier */
        facet_environment_destroy(with);
        facet_environment_destroy(without);
    }
}

/* At sunset half of the disc is visible, below the horizon nothing. */
static void the_disc_sets(void **state)
{
    (void)state;
    Atmosphere air[SKY_HALVES] = {atmosphere_earth(SKY_BANDS_FIRST), atmosphere_earth(SKY_BANDS_SECOND)};
    double before = (double)INFINITY;
    for (int i = 4; i >= -4; i--) {
        sky_sun_light sun = sky_sun_through_air(air, 0.0f, (float)(0.07 * degree * i), 0.0f);
        double E = (double)luminance(sky_sun_illuminance(&sun));
        assert_true(E >= 0.0 && (E < before || before == 0.0));
        assert_true((E == 0.0) == (0.07 * i <= -0.2666));
        before = E;
    }
}

/* ---- the sky ---- */

static void skies_are_symmetric_about_the_sun(void **state)
{
    (void)state;
    enum { SIZE = 64 };
    for (int model = 0; model < 2; model++) {
        facet_sky_desc sky = {.model = (facet_sky_model)model,
                              .sun_elevation_rad = 0.3f,
                              .ground_albedo = {0.2f, 0.3f, 0.1f},
                              .altitude_m = model ? 0.0f : 2000.0f,
                              .omits_disc = true, /* which may cross a texel's edge here and not there */
                              .height = SIZE};
        facet_environment *e = create(sky); /* the sun between columns 3/4 - 1 and 3/4 of the width */
        sky.sun_azimuth_rad = (float)(-0.5 * pi);
        facet_environment *turned = create(sky); /* at the seam, where both ends of rows meet */
        const image *p = &e->panorama, *q = &turned->panorama;
        uint32_t width = p->width, axis = 3 * width / 4;
        for (uint32_t y = 0; y < SIZE; y++)
            for (uint32_t x = 0; x < width; x++)
                for (int i = 0; i < 3; i++) {
                    double a = (double)texel(p, x, y)[i];
                    double mirrored = (double)texel(p, (2 * axis - 1 - x) % width, y)[i];
                    double shifted = (double)texel(q, (x + width / 4) % width, y)[i];
                    assert_near(a, mirrored, 2e-4 * a);
                    assert_near(a, shifted, 2e-4 * a);
                }
        facet_environment_destroy(e);
        facet_environment_destroy(turned);
    }
}

/* Neighbors differ little: no bands, no seam at azimuths of +-180 degrees, except at the horizon. */
static void skies_are_smooth(void **state)
{
    (void)state;
    enum { SIZE = 192 };
    facet_sky_desc sky = {.sun_elevation_rad = 0.2f,
                          .sun_azimuth_rad = 1.0f,
                          .ground_albedo = {0.2f, 0.2f, 0.2f},
                          .omits_disc = true,
                          .height = SIZE};
    facet_environment *e = create(sky);
    const image *p = &e->panorama;
    const double row = pi / SIZE; /* rad */
    for (uint32_t y = 0; y < SIZE; y++)
        for (uint32_t x = 0; x < p->width; x++) {
            double here = luminance_of(texel(p, x, y));
            double next = luminance_of(texel(p, (x + 1) % p->width, y));
            double after = luminance_of(texel(p, (x + 2) % p->width, y));
            assert_near(next / here, 1.0,
                        5.4 * pi / SIZE); /* haze's phase function falls by that per rad at most */
            /* no kinks: haze's phase function, the sharpest thing there, bends by 3 g / (1 - g)^2 per
             * rad^2 at most */
            assert_near((here - 2.0 * next + after) / here, 0.0, 39.6 * row * row);
            if (y + 2 < SIZE && (y + 2 < SIZE / 2 || y >= SIZE / 2)) {
                double below = luminance_of(texel(p, x, y + 1)), under = luminance_of(texel(p, x, y + 2));
                double elevation =
                    fabs(0.5 * SIZE - (y + 1.5)) * row; /* thickness of air goes with its inverse */
                double slope = 5.4 * row + row / elevation;
                assert_near(below / here, 1.0, slope);
                assert_near((here - 2.0 * below + under) / here, 0.0,
                            39.6 * row * row + 2.0 * row * row / (elevation * elevation));
            }
        }
    facet_environment_destroy(e);
}

/* All radiances are finite for any arguments. */
static void all_radiances_are_finite(void **state)
{
    (void)state;
    static const float elevations[] = {-90, -18, -6, -0.3f, 0, 3, 45, 90};
    static const float turbidities[] = {1, 2.5f, 10};
    static const float altitudes[] = {0, 1, 3000, 50000};
    for (size_t i = 0; i < sizeof elevations / sizeof *elevations; i++)
        for (int model = 0; model < (elevations[i] < 0 ? 1 : 2); model++) {
            float turbidity = turbidities[i % 3];
            facet_sky_desc sky = {.model = (facet_sky_model)model,
                                  .sun_elevation_rad = (float)((double)elevations[i] * degree),
                                  .turbidity = model && turbidity < 1.7f ? 1.7f : turbidity,
                                  .altitude_m = altitudes[(i + i / 4) % 4],
                                  .ground_albedo = {0.0f, 0.5f, 1.0f},
                                  .height = 32};
            facet_environment *e = create(sky);
            const float *c = e->panorama.pixels;
            for (size_t k = 0; k < (size_t)64 * 32 * 3; k++)
                assert_true(c[k] >= 0.0f && c[k] < ENVIRONMENT_MAX_RADIANCE);
            facet_environment_destroy(e);
        }
}

/* Twilight fades to 3.4 lx where civil twilight ends (-6 degrees) and 0.008 lx at -12 (Explanatory
 * Supplement to the Astronomical Almanac 1992), to a factor of 3 and of 5. Starlight is not modeled. */
static void twilight_fades_as_measured(void **state)
{
    (void)state;
    static const double expected[4][3] = {
        {0, 300, 1100}, {-6, 1.1, 10.2}, {-12, 0.0016, 0.04}, {-30, 0.0, 1e-6}};
    for (int i = 0; i < 4; i++) {
        facet_environment *e = create((facet_sky_desc){
            .sun_elevation_rad = (float)(expected[i][0] * degree), .turbidity = 1.55f, .height = 64});
        double E = illuminance(&e->panorama, (double[3]){0.0, 1.0, 0.0});
        if (!(E >= expected[i][1] && E <= expected[i][2]))
            print_error("%g degrees: %g lx\n", expected[i][0], E);
        assert_true(E >= expected[i][1] && E <= expected[i][2]);
        facet_environment_destroy(e);
    }
}

/* The sky scatters light of the ground back; the radiance of the ground is proportional to its albedo. */
static void the_ground_lights_the_sky(void **state)
{
    (void)state;
    double before = 0.0;
    for (int i = 0; i <= 2; i++) {
        float albedo = 0.45f * (float)i;
        facet_environment *e = create((facet_sky_desc){.sun_elevation_rad = 0.7f,
                                                       .ground_albedo = {albedo, albedo, albedo},
                                                       .omits_disc = true,
                                                       .height = 64});
        double sky = illuminance(&e->panorama, (double[3]){0.0, 1.0, 0.0});
        double up = illuminance(&e->panorama, (double[3]){0.0, -1.0, 0.0});
        Atmosphere air[SKY_HALVES];
        sky_atmosphere(2.5f, (float[3]){0.0f, 0.0f, 0.0f}, air);
        sky_sun_light sun = sky_sun_through_air(air, 0.0f, 0.7f, 0.0f);
        double direct = (double)luminance(sky_sun_illuminance(&sun)) * sin(0.7);
        assert_near(up, (double)albedo * (sky + direct), 0.01 * up);
        assert_true(sky > before * 1.02 && (i == 0 || sky < before * 1.35));
        before = sky;
        facet_environment_destroy(e);
    }
}

/* From a mountain the sky is darker and the horizon lower. */
static void skies_are_darker_from_a_mountain(void **state)
{
    (void)state;
    facet_sky_desc sky = {.sun_elevation_rad = 0.7f, .ground_albedo = {0.3f, 0.3f, 0.3f}, .height = 180};
    facet_environment *low = create(sky);
    sky.altitude_m = 30000.0f;
    facet_environment *high = create(sky);
    double a = luminance_of(texel(&low->panorama, 0, 20)), b = luminance_of(texel(&high->panorama, 0, 20));
    assert_true(b < 0.1 * a && b > 0.0);
    /* dips by acos(R / (R + h)) = 5.55 degrees: rows of a degree; the ground is seen through in-scattering */
    double limb = luminance_of(texel(&high->panorama, 0, 94)),
           space = luminance_of(texel(&high->panorama, 0, 86));
    assert_true(limb > 2.0 * space);
    facet_environment_destroy(low);
    facet_environment_destroy(high);
}

/* ---- exposure, threads, arguments ---- */

static void skies_have_the_requested_illuminance(void **state)
{
    (void)state;
    static const double elevations[] = {60, 10, 1, -3};
    for (int i = 0; i < 4; i++) {
        double largest = 0.0, s = elevations[i] * degree;
        facet_environment *e = create((facet_sky_desc){.sun_elevation_rad = (float)s,
                                                       .sun_azimuth_rad = 0.5f,
                                                       .ground_albedo = {0.2f, 0.2f, 0.2f},
                                                       .height = 48,
                                                       .illuminance_lux = 100.0f});
        for (int k = 0; k < 60; k++) {
            double a = k * 6.0 * degree;
            double n[3] = {cos(a) * sin(0.5), sin(a), cos(a) * cos(0.5)};
            largest = fmax(largest, illuminance(&e->panorama, n));
        }
        assert_near(largest, 100.0, 0.5); /* cos 3 degrees is 0.9986 */
        facet_environment_destroy(e);
    }
    facet_environment *night = create((facet_sky_desc){
        .sun_elevation_rad = (float)(-20.0 * degree), .height = 16, .illuminance_lux = 100.0f});
    assert_true(illuminance(&night->panorama, (double[3]){0.0, 1.0, 0.0}) < 1.0); /* night stays night */
    facet_environment_destroy(night);
}

static void skies_do_not_depend_on_threads(void **state)
{
    (void)state;
    for (int model = 0; model < 2; model++) {
        facet_sky_desc sky = {.model = (facet_sky_model)model,
                              .sun_elevation_rad = 0.4f,
                              .sun_azimuth_rad = 0.3f,
                              .altitude_m = model ? 0.0f : 500.0f,
                              .height = 50,
                              .illuminance_lux = 3.0f};
        facet_environment *e[2] = {NULL, NULL};
        for (uint32_t i = 0; i < 2; i++)
            assert_int_equal(facet_environment_create_sky(
                                 &sky, &(facet_environment_desc){.thread_count = 1 + 4 * i}, &e[i], NULL),
                             FACET_OK);
        assert_memory_equal(e[0]->panorama.pixels, e[1]->panorama.pixels, (size_t)100 * 50 * 12);
        facet_environment_destroy(e[0]);
        facet_environment_destroy(e[1]);
    }
}

static void invalid_arguments_are_refused(void **state)
{
    (void)state;
    const struct {
        facet_sky_desc sky;
        const char *says;
    } cases[] = {
        {{.sun_elevation_rad = 1.6f}, "91.6"},
        {{.sun_elevation_rad = NAN}, "the sun is"},
        {{.sun_azimuth_rad = INFINITY}, "the sun is"},
        {{.model = FACET_SKY_MODEL_PREETHAM, .sun_elevation_rad = -0.1f}, "5.73 degrees below the horizon"},
        {{.model = FACET_SKY_MODEL_PREETHAM, .sun_elevation_rad = 0.1f, .turbidity = 1.5f}, "1.7 to 10"},
        {{.turbidity = 0.5f}, "1 to 10"},
        {{.turbidity = NAN}, "turbidity"},
        {{.ground_albedo = {0.0f, 1.5f, 0.0f}}, "albedo"},
        {{.altitude_m = -1.0f}, "altitude"},
        {{.altitude_m = 50001.0f}, "50000"},
        {{.illuminance_lux = -1.0f}, "illuminance"},
        {{.height = 1}, "height"},
        {{.height = 16385}, "16384"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        facet_environment *e = NULL;
        facet_error error = {0};
        assert_int_equal(facet_environment_create_sky(&cases[i].sky, NULL, &e, &error), FACET_ERROR_ARGUMENT);
        assert_null(e);
        assert_non_null(strstr(error.message, cases[i].says));
    }
}

static void running_out_of_memory_leaks_nothing(void **state)
{
    (void)state;
    for (int model = 0; model < 3; model++)
        for (long n = 0;; n = next_failure(n)) {
            failing_allocator failing = {.fail_at = n};
            facet_environment *e = NULL;
            facet_environment_desc desc = {.allocator = failing_allocator_get(&failing)};
            facet_sky_desc sky = {.model = (facet_sky_model)(model % 2),
                                  .sun_elevation_rad = 0.4f,
                                  .height = 8,
                                  .illuminance_lux = 3.0f};
            const float c[3] = {1.0f, 2.0f, 3.0f};
            facet_result result = model < 2 ? facet_environment_create_sky(&sky, &desc, &e, NULL)
                                            : facet_environment_create_gradient(c, c, c, &desc, &e, NULL);
            assert_true(result == FACET_OK || (result == FACET_ERROR_MEMORY && !e));
            facet_environment_destroy(e);
            assert_int_equal(failing.blocks, 0);
            if (result == FACET_OK)
                break;
        }
}

/* ---- gradients ---- */

static void gradients_interpolate_three_colors(void **state)
{
    (void)state;
    const float zenith[3] = {1.0f, 2.0f, 4.0f}, horizon[3] = {3.0f, 3.0f, 1.0f},
                nadir[3] = {0.0f, 1.0f, 0.5f};
    facet_environment *e = NULL;
    assert_int_equal(facet_environment_create_gradient(zenith, horizon, nadir, NULL, &e, NULL), FACET_OK);
    for (int i = -10; i <= 10; i++) {
        double y = 0.1 * i;
        float d[3] = {(float)sqrt(fmax(1.0 - y * y, 0.0)), (float)y, 0.0f}, c[3];
        equirect_lookup(&e->panorama, d, c);
        for (int k = 0; k < 3; k++) {
            double end = (double)(i < 0 ? nadir : zenith)[k];
            assert_near((double)c[k], (double)horizon[k] + (end - (double)horizon[k]) * fabs(y), 0.02);
        }
    }
    double sum[3] = {0.0, 0.0, 0.0};
    for (uint32_t y = 0; y < e->panorama.height; y++)
        for (uint32_t x = 0; x < e->panorama.width; x++)
            for (int k = 0; k < 3; k++)
                sum[k] += (double)texel(&e->panorama, x, y)[k] *
                          equirect_texel_solid_angle(e->panorama.width, e->panorama.height, y);
    for (int k = 0; k < 3; k++) /* d.y is spread evenly over the sphere */
        assert_near(sum[k] / (4.0 * pi), 0.25 * (double)(zenith[k] + 2.0f * horizon[k] + nadir[k]), 1e-5);
    facet_environment_destroy(e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_disc_keeps_its_energy_at_any_resolution),
                                       cmocka_unit_test(the_disc_has_the_size_and_limb_of_the_sun),
                                       cmocka_unit_test(skies_contain_the_disc),
                                       cmocka_unit_test(the_disc_sets),
                                       cmocka_unit_test(skies_are_symmetric_about_the_sun),
                                       cmocka_unit_test(skies_are_smooth),
                                       cmocka_unit_test(all_radiances_are_finite),
                                       cmocka_unit_test(twilight_fades_as_measured),
                                       cmocka_unit_test(the_ground_lights_the_sky),
                                       cmocka_unit_test(skies_are_darker_from_a_mountain),
                                       cmocka_unit_test(skies_have_the_requested_illuminance),
                                       cmocka_unit_test(skies_do_not_depend_on_threads),
                                       cmocka_unit_test(invalid_arguments_are_refused),
                                       cmocka_unit_test(running_out_of_memory_leaks_nothing),
                                       cmocka_unit_test(gradients_interpolate_three_colors)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
