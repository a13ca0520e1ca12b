/* Tests of light_environment.h: samples against densities, densities against radiance. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "ibl/environment.h"
#include "ibl/equirect.h"

#include "path/light_environment.h"
#include "tests/support/support.h"

static const double pi = 3.14159265358979323846;

static uint64_t random_state = 1;
static double random_number(void)
{
    return lcg64_double(&random_state);
}

/* ---- images ---- */

static image make_map(uint32_t width, uint32_t height)
{
    image map;
    assert_int_equal(image_create(NULL, width, height, 3, IMAGE_F32, &map, NULL), FACET_OK);
    memset(map.pixels, 0, (size_t)width * height * 3 * sizeof(float));
    return map;
}

static float *texel(image *map, uint32_t x, uint32_t y)
{
    return (float *)map->pixels + 3 * ((size_t)map->width * y + x);
}

/* Smooth, with bright_count bright texels and a black part. */
static image make_sky(uint32_t width, uint32_t height, int bright_count)
{
    image map = make_map(width, height);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            for (int c = 0; c < 3; c++) {
                double v = (y + 0.5) / height;
                double u = (x + 0.5) / width;
                texel(&map, x, y)[c] =
                    v < 0.7 ? (float)(0.2 + 0.1 * c + (1.0 - v) * (1.0 + cos(2.0 * pi * u))) : 0.0f;
            }
    for (int i = 0; i < bright_count; i++)
        texel(&map, (uint32_t)(random_number() * width), (uint32_t)(random_number() * height))[i % 3] +=
            (float)(30.0 * random_number());
    return map;
}

static light_setup placed(float rotation_rad, float scale)
{
    return (light_setup){
        .scale = scale, .rotation_cos = cosf(rotation_rad), .rotation_sin = sinf(rotation_rad)};
}

static light_environment *make_any(const image *map, float rotation_rad, float scale, bool is_compensated)
{
    light_setup light = placed(rotation_rad, scale);
    light_environment *e;
    assert_int_equal(light_environment_create(map, &light, is_compensated, NULL, 2, &e, NULL), FACET_OK);
    return e;
}

static light_environment *make_environment(const image *map, float rotation_rad, float scale)
{
    return make_any(map, rotation_rad, scale, false);
}

static vec3 random_direction(void)
{
    double z = 1.0 - 2.0 * random_number();
    double r = sqrt(1.0 - z * z);
    double phi = 2.0 * pi * random_number();
    return vec3((float)(r * cos(phi)), (float)(r * sin(phi)), (float)z);
}

/* {0}, then three directions. */
static vec3 normal_number(int i)
{
    vec3 normals[4] = {vec3(0.0f), vec3(0.0f, 1.0f, 0.0f), normalize(vec3(0.9f, -0.1f, 0.3f)),
                       normalize(vec3(-0.2f, -0.9f, 0.5f))};
    return normals[i];
}

/* ---- constants ---- */

static void a_constant_is_exact(void **state)
{
    (void)state;
    static const uint32_t sizes[5][2] = {{1, 1}, {2, 1}, {7, 5}, {64, 32}, {1000, 500}};
    for (int i = 0; i < 5; i++) {
        image map = make_map(sizes[i][0], sizes[i][1]);
        for (size_t k = 0; k < (size_t)3 * sizes[i][0] * sizes[i][1]; k++)
            ((float *)map.pixels)[k] = 3.0f;
        light_environment *e = make_environment(&map, 0.7f, 2.0f);
        light_environment_view view;
        light_environment_see(e, vec3(0.0f), &view);
        assert_true(fabs((double)view.irradiance / (24.0 * pi) - 1.0) < 4e-6);
        for (int k = 0; k < 2000; k++) {
            double u[2] = {random_number(), random_number()};
            vec3 d;
            float pdf = light_environment_sample(e, &view, u, &d);
            assert_true(fabsf(length(d) - 1.0f) < 1e-6f);
            vec3 radiance = light_environment_radiance(e, d);
            for (int c = 0; c < 3; c++)
                assert_true(fabs((double)(radiance[c] / pdf) / (24.0 * pi) - 1.0) < 2e-6);
        }
        light_environment_destroy(e);
        image_destroy(&map);
    }
}

static void black_environments_have_no_light(void **state)
{
    (void)state;
    image map = make_map(16, 8);
    assert_null(make_environment(&map, 0.0f, 1.0f));
    texel(&map, 3, 3)[1] = 1.0f;
    assert_null(make_environment(&map, 0.0f, 0.0f));
    light_environment_destroy(NULL);
    image_destroy(&map);
}

/* ---- densities ---- */

/* Where radiance is above 0 above the horizon, so is the density, and it integrates to 1; so does that of
 * one lit texel at the seam, at a pole, anywhere. */
static void densities_integrate_to_one(void **state)
{
    (void)state;
    for (int map_number = 0; map_number < 8; map_number++) {
        static const uint32_t single[5][2] = {{0, 8}, {31, 8}, {4, 0}, {17, 15}, {13, 6}};
        image map = map_number < 5 ? make_map(32, 16)
                                   : make_sky(map_number < 7 ? 40 : 331, map_number < 7 ? 20 : 170, 20);
        if (map_number < 5)
            texel(&map, single[map_number][0], single[map_number][1])[map_number % 3] = 1.0f;
        light_environment *e = make_environment(&map, (float)map_number, 0.5f);
        for (int i = 0; i < 4; i++) {
            enum { SIDE = 700 };
            vec3 N = normal_number(i);
            light_environment_view view;
            light_environment_see(e, N, &view);
            if (!(view.irradiance > 0.0f))
                continue;
            double sum = 0.0;
            for (int k = 0; k < SIDE * SIDE; k++) {
                double z = 1.0 - 2.0 * (k / SIDE + random_number()) / SIDE;
                double phi = 2.0 * pi * (k % SIDE + random_number()) / SIDE;
                double r = sqrt(1.0 - z * z);
                vec3 d = vec3((float)(r * cos(phi)), (float)z, (float)(r * sin(phi)));
                float pdf = light_environment_pdf(e, &view, d);
                sum += (double)pdf;
                vec3 radiance = light_environment_radiance(e, d);
                if (max3(radiance) > 1e-5f && (i == 0 || dot(d, N) > 0.0f))
                    assert_true(pdf > 0.0f);
            }
            double integral = sum * 4.0 * pi / (SIDE * SIDE);
            if (fabs(integral - 1.0) > (map_number < 5 ? 3e-2 : 3e-3)) /* few points hit one texel */
                fail_msg("map %d, normal %d: %.6f", map_number, i, integral);
        }
        light_environment_destroy(e);
        image_destroy(&map);
    }
}

/* Samples have the returned pdf, that of light_environment_pdf(): chi-square over a grid of the sphere, whose
 * cells' expectations are integrals of the density. */
static void samples_have_their_density(void **state)
{
    (void)state;
    enum { ROWS = 24, COLUMNS = 48, SAMPLES = 400000, INNER = 24 };
    image map = make_sky(96, 48, 20);
    light_environment *e = make_environment(&map, 0.4f, 3.0f);
    for (int i = 0; i < 4; i++) {
        static double counts[ROWS * COLUMNS];
        light_environment_view view;
        light_environment_see(e, normal_number(i), &view);
        memset(counts, 0, sizeof counts);
        int other = 0;
        for (int k = 0; k < SAMPLES; k++) {
            double u[2] = {random_number(), random_number()};
            vec3 d;
            float pdf = light_environment_sample(e, &view, u, &d);
            assert_true(pdf > 0.0f && pdf < INFINITY);
            other += fabsf(pdf / light_environment_pdf(e, &view, d) - 1.0f) > 2e-4f;
            int row = (int)((1.0f - d[1]) * 0.5f * ROWS);
            int column = (int)((atan2f(d[2], d[0]) / (2.0f * PI) + 0.5f) * COLUMNS);
            row = row < ROWS ? row : ROWS - 1;
            counts[row * COLUMNS + (column < COLUMNS ? column : COLUMNS - 1)] += 1.0;
        }
        assert_true(other < SAMPLES / 5000); /* rounding at the borders of texels */
        double chi2 = 0.0;
        int freedom = -1;
        for (int cell = 0; cell < ROWS * COLUMNS; cell++) {
            double expected = 0.0;
            for (int k = 0; k < INNER * INNER; k++) {
                double z = 1.0 - 2.0 * (cell / COLUMNS + (k / INNER + 0.5) / INNER) / ROWS;
                double phi = 2.0 * pi * ((cell % COLUMNS + (k % INNER + 0.5) / INNER) / COLUMNS - 0.5);
                double r = sqrt(1.0 - z * z);
                expected += (double)light_environment_pdf(
                    e, &view, vec3((float)(r * cos(phi)), (float)z, (float)(r * sin(phi))));
            }
            expected *= SAMPLES * 4.0 * pi / ((double)ROWS * COLUMNS * INNER * INNER);
            if (expected < 20.0) {
                assert_true(counts[cell] < 20.0 + 12.0 * sqrt(expected + 1.0));
                continue;
            }
            /* the integral over texels that a cell cuts is off by up to half a percent */
            double slack = 0.005 * expected;
            double off = fmax(fabs(counts[cell] - expected) - slack, 0.0);
            chi2 += off * off / expected;
            freedom++;
        }
        assert_true(freedom > 100);
        if (chi2 > freedom + 4.0 * sqrt(2.0 * freedom))
            fail_msg("normal %d: chi2 %.1f with %d degrees of freedom", i, chi2, freedom);
    }
    light_environment_destroy(e);
    image_destroy(&map);
}

/* ---- estimates ---- */

typedef struct estimate {
    double mean, error;
} estimate;

static estimate irradiance(const light_environment *e, vec3 N, int count)
{
    light_environment_view view;
    light_environment_see(e, N, &view);
    double sum = 0.0;
    double sum2 = 0.0;
    for (int k = 0; k < count; k++) {
        double u[2] = {random_number(), random_number()};
        vec3 d;
        float pdf = light_environment_sample(e, &view, u, &d);
        double x = (double)(light_environment_radiance(e, d)[0] * max(dot(d, N), 0.0f) / pdf);
        sum += x;
        sum2 += x * x;
    }
    double mean = sum / count;
    return (estimate){mean, sqrt(fmax(sum2 / count - mean * mean, 0.0) / count)};
}

/* By a sum over 64 points of each texel of an image of 96 x 48. */
static double irradiance_by_sum(const light_environment *e, vec3 N)
{
    enum { WIDTH = 96, HEIGHT = 48, FINE = 8 };
    double sum = 0.0;
    for (uint32_t y = 0; y < HEIGHT * FINE; y++)
        for (uint32_t x = 0; x < WIDTH * FINE; x++) {
            float d[3];
            equirect_direction(WIDTH * FINE, HEIGHT * FINE, x, y, d);
            vec3 direction = vec3(d[0], d[1], d[2]);
            sum += (double)(light_environment_radiance(e, direction)[0] * max(dot(direction, N), 0.0f)) *
                   equirect_texel_solid_angle(WIDTH * FINE, HEIGHT * FINE, y);
        }
    return sum;
}

/* A sun of 1e5 in the map costs no noise, and little where it is behind the surface: sampling the map
 * alone would have deviations of hundreds there. */
static void irradiance_agrees_with_a_sum_over_the_map(void **state)
{
    (void)state;
    for (int with_sun = 0; with_sun < 2; with_sun++) {
        image map = make_sky(96, 48, 20);
        if (with_sun)
            texel(&map, 33, 15)[0] = texel(&map, 33, 15)[1] = texel(&map, 33, 15)[2] = 1e5f;
        light_environment *e = make_environment(&map, 1.1f, 0.25f);
        double worst = 0.0;
        for (int i = 0; i < 24; i++) {
            vec3 N = random_direction();
            double expected = irradiance_by_sum(e, N);
            estimate found = irradiance(e, N, 20000);
            if (fabs(found.mean - expected) > 4.0 * found.error + 2e-4 * expected)
                fail_msg("%.6g +- %.2g, expected %.6g", found.mean, found.error, expected);
            light_environment_view view;
            light_environment_see(e, N, &view);
            assert_true(view.irradiance > 0.0f);
            worst = fmax(worst, found.error * sqrt(20000.0) / expected);
        }
        assert_true(worst < (with_sun ? 2.5 : 1.0));
        light_environment_destroy(e);
        image_destroy(&map);
    }
}

/* Nearby random numbers, nearby directions: 32 x 32 stratified ones leave much less noise than random
 * ones. */
static void stratified_numbers_reduce_noise(void **state)
{
    (void)state;
    enum { SIDE = 32, REPEATS = 40 };
    image map = make_sky(96, 48, 0);
    light_environment *e = make_environment(&map, 0.0f, 1.0f);
    vec3 N = vec3(0.0f, 1.0f, 0.0f);
    light_environment_view view;
    light_environment_see(e, vec3(0.0f), &view);
    double variance[2] = {0.0, 0.0};
    double expected = irradiance_by_sum(e, N);
    for (int repeat = 0; repeat < REPEATS; repeat++)
        for (int is_stratified = 0; is_stratified < 2; is_stratified++) {
            double sum = 0.0;
            for (int k = 0; k < SIDE * SIDE; k++) {
                double u[2] = {random_number(), random_number()};
                if (is_stratified) {
                    u[0] = (k % SIDE + u[0]) / SIDE;
                    u[1] = (k / SIDE + u[1]) / SIDE;
                }
                vec3 d;
                float pdf = light_environment_sample(e, &view, u, &d);
                sum += (double)(light_environment_radiance(e, d)[0] * max(d[1], 0.0f) / pdf);
            }
            double off = sum / (SIDE * SIDE) - expected;
            variance[is_stratified] += off * off;
        }
    assert_true(variance[1] < 0.01 * variance[0]);
    light_environment_destroy(e);
    image_destroy(&map);
}

/* ---- limits ---- */

static float mean_of(vec3 channels)
{
    return (channels[0] + channels[1] + channels[2]) * (1.0f / 3.0f);
}

/* One light sample and one cosine sample, weighted by the power heuristic. */
static estimate irradiance_by_both(const light_environment *e, vec3 N, int count)
{
    light_environment_view view;
    light_environment_see(e, N, &view);
    mat3 frame = basis_from_normal(N);
    double sum = 0.0;
    double sum2 = 0.0;
    for (int k = 0; k < count; k++) {
        double x = 0.0;
        for (int strategy = 0; strategy < 2; strategy++) {
            double u[2] = {random_number(), random_number()};
            vec3 d = mul(frame, sample_cosine(vec2((float)u[0], (float)u[1])));
            double pdfs[2];
            pdfs[0] = (double)(strategy ? light_environment_pdf(e, &view, d)
                                        : light_environment_sample(e, &view, u, &d));
            pdfs[1] = (double)pdf_cosine(max(dot(N, d), 0.0f));
            double squares = pdfs[0] * pdfs[0] + pdfs[1] * pdfs[1];
            x += (double)(light_environment_radiance(e, d)[0] * max(dot(N, d), 0.0f)) * pdfs[strategy] /
                 squares;
        }
        sum += x;
        sum2 += x * x;
    }
    double mean = sum / count;
    return (estimate){mean, sqrt(fmax(sum2 / count - mean * mean, 0.0) / count)};
}

/* With BSDF samples the result is the same whether the mean is sampled or left to them. */
static void compensation_keeps_the_mean(void **state)
{
    (void)state;
    enum { COUNT = 200000 };
    image map = make_sky(96, 48, 20);
    light_environment *plain = make_any(&map, 0.4f, 3.0f, false);
    light_environment *compensated = make_any(&map, 0.4f, 3.0f, true);
    for (int i = 1; i < 4; i++) {
        estimate a = irradiance(plain, normal_number(i), COUNT);
        estimate b = irradiance_by_both(compensated, normal_number(i), COUNT);
        if (fabs(a.mean - b.mean) > 4.0 * hypot(a.error, b.error) || b.error > 2e-3 * b.mean)
            fail_msg("normal %d: %.5f +- %.5f, compensated %.5f +- %.5f", i, a.mean, a.error, b.mean,
                     b.error);
    }
    light_environment_destroy(plain);
    light_environment_destroy(compensated);
    image_destroy(&map);
}

/* Compensated, the density is positive above half of the mean radiance and 0 well below it; it integrates to 1, and
 * samples have it. That of a constant is uniform. */
static void compensated_densities_are_of_the_excess(void **state)
{
    (void)state;
    enum { COUNT = 400000 };
    image map = make_sky(96, 48, 0);
    double mean[3];
    assert_int_equal(equirect_mean(&map, NULL, 1, mean, NULL), FACET_OK);
    double floor = 0.5 * (mean[0] + mean[1] + mean[2]) / 3.0;
    light_environment *e = make_any(&map, 0.4f, 1.0f, true);
    light_environment_view view;
    light_environment_see(e, vec3(0.0f), &view);
    double sum = 0.0;
    int below = 0;
    for (int k = 0; k < COUNT; k++) {
        vec3 d = random_direction();
        float pdf = light_environment_pdf(e, &view, d);
        sum += (double)pdf;
        double radiance = (double)mean_of(light_environment_radiance(e, d));
        if (radiance > 1.001 * floor)
            assert_true(pdf > 0.0f);
        if (radiance < 0.95 * floor && d[1] > 0.0f) { /* away from the edge of the black part */
            assert_true(pdf == 0.0f);
            below++;
        }
        double u[2] = {random_number(), random_number()};
        pdf = light_environment_sample(e, &view, u, &d);
        assert_true(pdf > 0.0f && fabsf(pdf / light_environment_pdf(e, &view, d) - 1.0f) < 0.02f);
    }
    assert_true(fabs(sum * 4.0 * pi / COUNT - 1.0) < 5e-3);
    assert_true(below > 0);
    light_environment_destroy(e);
    for (size_t k = 0; k < (size_t)3 * 96 * 48; k++)
        ((float *)map.pixels)[k] = 0.7f;
    e = make_any(&map, 0.4f, 3.0f, true);
    light_environment_see(e, vec3(0.0f), &view);
    for (int k = 0; k < 100; k++) {
        vec3 d = random_direction();
        assert_true(fabs((double)light_environment_pdf(e, &view, d) * 4.0 * pi - 1.0) < 1e-4);
        assert_true(fabsf(light_environment_radiance(e, d)[1] - 2.1f) < 1e-5f);
    }
    light_environment_destroy(e);
    image_destroy(&map);
}

static void results_do_not_depend_on_threads(void **state)
{
    (void)state;
    image map = make_sky(200, 100, 20);
    light_setup light = placed(0.3f, 1.0f);
    light_environment *e[2];
    assert_int_equal(light_environment_create(&map, &light, false, NULL, 1, &e[0], NULL), FACET_OK);
    assert_int_equal(light_environment_create(&map, &light, false, NULL, 7, &e[1], NULL), FACET_OK);
    for (int i = 0; i < 1000; i++) {
        double u[2] = {random_number(), random_number()};
        vec3 N = normal_number(i % 4);
        vec3 d[2];
        float pdf[2];
        for (int k = 0; k < 2; k++) {
            light_environment_view view;
            light_environment_see(e[k], N, &view);
            pdf[k] = light_environment_sample(e[k], &view, u, &d[k]);
        }
        assert_memory_equal(&pdf[0], &pdf[1], sizeof pdf[0]);
        assert_memory_equal(&d[0], &d[1], 3 * sizeof(float));
    }
    light_environment_destroy(e[0]);
    light_environment_destroy(e[1]);
    image_destroy(&map);
}

static void memory_is_a_third_of_the_map(void **state)
{
    (void)state;
    image map = make_sky(2048, 1024, 20);
    light_setup light = placed(0.0f, 1.0f);
    size_t bytes = (size_t)2048 * 1024 * 12;
    for (uint64_t limit = bytes / 2;; limit /= 4) {
        facet_budget *budget;
        assert_int_equal(facet_budget_create(limit, &budget, NULL), FACET_OK);
        facet_allocator allocator = facet_budget_allocator(budget);
        light_environment *e;
        facet_result result = light_environment_create(&map, &light, true, &allocator, 2, &e, NULL);
        assert_int_equal(result, limit == bytes / 2 ? FACET_OK : FACET_ERROR_MEMORY);
        if (result != FACET_OK)
            assert_null(e);
        light_environment_destroy(e);
        assert_int_equal(facet_budget_used_bytes(budget), 0);
        facet_budget_destroy(budget);
        if (limit < 1000)
            break;
    }
    image_destroy(&map);
}

/* Numbers at the very ends, and images of extremes. */
static void extremes_are_finite(void **state)
{
    (void)state;
    static const float values[4] = {1e-30f, 1.0f, 1e12f, 0.0f};
    static const double ends[3] = {0.0, 0.5, 1.0 - 0x1p-53};
    for (int map_number = 0; map_number < 6; map_number++) {
        image map = make_map(70, 33);
        for (uint32_t i = 0; i < 70 * 33 * 3; i++)
            ((float *)map.pixels)[i] =
                values[map_number < 3 ? (uint32_t)map_number : (uint32_t)(random_number() * 4.0)];
        light_environment *e = make_environment(&map, 0.3f, 1.0f);
        assert_non_null(e);
        for (int i = 0; i < 400; i++) {
            light_environment_view view;
            light_environment_see(e, normal_number(i % 4), &view);
            double u[2] = {i < 200 ? ends[i % 3] : random_number(),
                           i < 200 ? ends[i / 3 % 3] : random_number()};
            vec3 d;
            float pdf = light_environment_sample(e, &view, u, &d);
            assert_true((map_number < 3 ? pdf > 0.0f : pdf >= 0.0f) && isfinite(pdf));
            assert_true(fabsf(dot(d, d) - 1.0f) < 1e-5f);
            float asked = light_environment_pdf(e, &view, random_direction());
            assert_true(asked >= 0.0f && isfinite(asked));
        }
        light_environment_destroy(e);
        image_destroy(&map);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_constant_is_exact),
        cmocka_unit_test(black_environments_have_no_light),
        cmocka_unit_test(densities_integrate_to_one),
        cmocka_unit_test(samples_have_their_density),
        cmocka_unit_test(irradiance_agrees_with_a_sum_over_the_map),
        cmocka_unit_test(stratified_numbers_reduce_noise),
        cmocka_unit_test(compensation_keeps_the_mean),
        cmocka_unit_test(compensated_densities_are_of_the_excess),
        cmocka_unit_test(results_do_not_depend_on_threads),
        cmocka_unit_test(memory_is_a_third_of_the_map),
        cmocka_unit_test(extremes_are_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
