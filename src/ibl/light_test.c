/* light_test.c - prepared lights: filtered radiance, and parts that are prepared once, lazily and equally. */
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "tests/support/support.h"
#include "ibl/environment.h"
#include "ibl/equirect.h"
#include "ibl/ibl.h"
#include "ibl/light_fixture.h"
#include "ibl/studio_draw.h"

static const double pi = 3.14159265358979323846;

static const ibl_light_desc all_ggx = {
    .needs_irradiance = true, .needs_specular = true, .max_roughness = 1.0f, .needs_background = true};

static void uniform_light_stays_uniform(void **state)
{
    (void)state;
    static const float radiance[3] = {0.3f, 1.0f, 1234.5f};
    facet_environment *e = NULL;
    assert_int_equal(facet_environment_create_constant(radiance, NULL, &e, NULL), FACET_OK);
    const ibl_light *light = prepare(e, all_ggx);
    for (int i = 0; i < 500; i++) {
        float d[3], out[3];
        test_direction(i, 500, d);
        for (int r = 0; r <= 50; r++) {
            ibl_specular(light, d, (float)r / 50.0f, out);
            for (int k = 0; k < 3; k++)
                assert_near(out[k] / radiance[k], 1.0, 1e-6);
        }
        ibl_irradiance_over_pi(light, d, out);
        for (int k = 0; k < 3; k++)
            assert_near(out[k] / radiance[k], 1.0, 1e-6);
        ibl_background(light, d, 0.0f, out);
        for (int k = 0; k < 3; k++)
            assert_near(out[k] / radiance[k], 1.0, 1e-6);
    }
    ibl_light_release(light);
    facet_environment_destroy(e);
}

/* ---- bands ---- */

static void tilted_band(const float d[3], int l, double *out)
{
    /* Legendre polynomial around an axis that no grid has: every m of degree l at once */
    double x = 0.48 * (double)d[0] + 0.6 * (double)d[1] + 0.64 * (double)d[2];
    double p[5] = {1.0, x, 1.5 * x * x - 0.5, 2.5 * x * x * x - 1.5 * x,
                   (35.0 * x * x * x * x - 30.0 * x * x + 3.0) / 8.0};
    *out = p[l];
}

static void bands_1_2_3(const float d[3], float out[3])
{
    for (int k = 0; k < 3; k++) {
        double p;
        tilted_band(d, k + 1, &p);
        out[k] = (float)(1.0 + p);
    }
}

static void band_4(const float d[3], float out[3])
{
    double p;
    tilted_band(d, 4, &p);
    out[0] = out[1] = out[2] = (float)(1.0 + p);
}

/* k_l by quadrature in long double. */
static void kernels_equal_golden_values(void **state)
{
    (void)state;
    static const double golden[5][5] = {
        {0.10, 0.998693503699, 0.996229938117, 0.992824773157, 0.988665743355},
        {0.25, 0.976092604298, 0.933738270618, 0.880606983182, 0.822958863625},
        {0.50, 0.867395662812, 0.662405687279, 0.460387585347, 0.305538297757},
        {0.75, 0.745131342455, 0.398824737791, 0.140121157544, 0.028984607620},
        {1.00, 0.666666666667, 0.25, 0.0, -0.041666666667}};
    for (int i = 0; i < 5; i++) {
        float kernel[PREFILTER_DEGREE + 1];
        prefilter_kernel(PREFILTER_GGX, (float)golden[i][0], PREFILTER_DEGREE, kernel);
        assert_near(kernel[0], 1.0, 0.0);
        for (int l = 1; l <= 4; l++)
            assert_near(kernel[l], golden[i][l], 1e-6);
    }
}

/* Each level scales each band by k_l, in its texels and, with a slightly larger error, in lookups between
 * them. */
static void check_bands(facet_environment *e, int first_band, int band_step)
{
    const ibl_light *light = prepare(e, all_ggx);
    double worst = 0.0;
    double worst_between = 0.0;
    for (uint32_t level = 1; level < prefilter_level_count(PREFILTER_GGX); level++) {
        const cube *c = &e->parts.levels[PREFILTER_GGX][level];
        float kernel[5];
        prefilter_kernel(PREFILTER_GGX, prefilter_roughness(PREFILTER_GGX, level), 4, kernel);
        for (uint32_t i = 0; i < 6 * c->size * c->size; i++) {
            double d[3], p;
            uint32_t x = i % c->size;
            uint32_t y = i / c->size % c->size;
            cube_direction(i / c->size / c->size, (2.0 * x + 1.0) / c->size - 1.0,
                           (2.0 * y + 1.0) / c->size - 1.0, d);
            double scale = 1.0 / sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
            float f[3] = {(float)(d[0] * scale), (float)(d[1] * scale), (float)(d[2] * scale)};
            rgbx t = *cube_texel(c, i / c->size / c->size, (int)x, (int)y);
            for (int k = 0; k < 3; k++) {
                tilted_band(f, first_band + k * band_step, &p);
                worst =
                    fmax(worst, fabs((double)t[k] - (1.0 + (double)kernel[first_band + k * band_step] * p)));
            }
        }
        for (int i = 0; i < 300; i++) {
            float d[3], out[3];
            double p;
            test_direction(i, 300, d);
            ibl_specular(light, d, prefilter_roughness(PREFILTER_GGX, level), out);
            for (int k = 0; k < 3; k++) {
                tilted_band(d, first_band + k * band_step, &p);
                double expected = 1.0 + (double)kernel[first_band + k * band_step] * p;
                worst_between = fmax(worst_between, fabs((double)out[k] - expected));
            }
        }
    }
    print_message("largest deviation: %.2e, between texels %.2e\n", worst, worst_between);
    assert_true(worst < 2e-3);
    assert_true(worst_between < 3e-3);
    ibl_light_release(light);
    facet_environment_destroy(e);
}

static void bands_of_harmonics_are_scaled(void **state)
{
    (void)state;
    check_bands(make_environment(1024, 512, bands_1_2_3), 1, 1);
    check_bands(make_environment(1024, 512, band_4), 4, 0);
}

/* ---- irradiance ---- */

static void upper_half(const float d[3], float out[3])
{
    out[0] = out[1] = out[2] = d[2] > 0.0f ? d[2] : 0.0f;
}

/* Of the clamped cosine: (2 / 3) ((pi - t) cos(t) + sin(t)). */
static void irradiance_is_that_of_the_clamped_cosine(void **state)
{
    (void)state;
    facet_environment *e = make_environment(512, 256, upper_half);
    const ibl_light *light = prepare(e, (ibl_light_desc){.needs_irradiance = true});
    for (int i = 0; i < 400; i++) {
        float N[3], out[3];
        test_direction(i, 400, N);
        double c = (double)N[2];
        double t = acos(c);
        ibl_irradiance_over_pi(light, N, out);
        assert_near((double)out[1] * pi, 2.0 / 3.0 * ((pi - t) * c + sin(t)),
                    5e-3); /* of 2.1: between texels, at edges */
    }
    ibl_light_release(light);
    facet_environment_destroy(e);
}

/* ---- a sun of one texel ---- */

static void sky(const float d[3], float out[3])
{
    out[0] = 0.2f;
    out[1] = 0.3f + 0.1f * d[1];
    out[2] = 0.4f;
}

/* No fireflies: nothing is brighter than the sun's energy times the lobe's peak, or darker than the
 * darkest sky minus the remaining ringing. No energy is lost. */
static void check_sun(uint32_t sun_x, uint32_t sun_y)
{
    const uint32_t width = 1024;
    facet_environment *e = make_environment(width, 512, sky);
    float *p = (float *)e->panorama.pixels + 3 * ((size_t)sun_y * width + sun_x);
    p[0] = p[1] = p[2] = 1e5f;
    const ibl_light *light = prepare(e, all_ggx);
    double omega = equirect_texel_solid_angle(width, 512, sun_y);
    double expected = 1e5 * omega / (4.0 * pi) + 0.3;
    for (uint32_t level = 1; level < prefilter_level_count(PREFILTER_GGX); level++) {
        const cube *c = &e->parts.levels[PREFILTER_GGX][level];
        double mean[3];
        cube_mean(c, mean);
        assert_near(mean[1] / expected, 1.0, 0.01);
        double a2 = pow((double)prefilter_roughness(PREFILTER_GGX, level), 4.0);
        /* peak of D N.l / (4 m0): D(1) = 1 / (pi a^2); m0 >= 1/4 is the mean of N.l */
        double peak = 0.55 + 1e5 * omega / (pi * a2 * 4.0) * (level < 5 ? 1.4 : 4.0);
        for (uint32_t face = 0; face < 6; face++)
            for (int y = 0; y < (int)c->size; y++)
                for (int x = 0; x < (int)c->size; x++) {
                    rgbx t = *cube_texel(c, face, x, y);
                    for (int k = 0; k < 3; k++)
                        assert_true((double)t[k] >= 0.0 && (double)t[k] < peak);
                }
    }
    /* on the far side of the sun a lobe of roughness 0.16 or 0.3 sees sky only */
    float d[3], out[3];
    equirect_direction(width, 512, sun_x, sun_y, d);
    for (int k = 0; k < 3; k++)
        d[k] = -d[k];
    ibl_specular(light, d, 0.16f, out);
    assert_near(out[0], 0.2, 0.01);
    ibl_specular(light, d, 0.3f, out);
    assert_near(out[0], 0.2, 0.01);
    ibl_light_release(light);
    facet_environment_destroy(e);
}

static void a_sun_becomes_the_lobe(void **state)
{
    (void)state;
    check_sun(614, 139); /* anywhere */
    check_sun(0, 256);   /* on the image's own seam */
    check_sun(511, 20);  /* near a pole */
    check_sun(384, 255); /* near the middle of an edge of the cube */
}

/* ---- rotation, seams, roughness 0 ---- */

static float rotation_phase;

static void pattern(const float d[3], float out[3])
{
    float c = cosf(rotation_phase);
    float s = sinf(rotation_phase);
    float x = c * d[0] + s * d[2];
    float z = c * d[2] - s * d[0];
    out[0] = x > 0.7f ? 20.0f : 0.5f + 0.5f * z;
    out[1] = d[1] > 0.8f && x > 0.1f ? 5.0f : 0.1f;
    out[2] = 1.0f + sinf(9.0f * x) * sinf(7.0f * z);
}

static void check_rotation(float phase, double tolerance)
{
    rotation_phase = 0.0f;
    facet_environment *straight = make_environment(512, 256, pattern);
    rotation_phase = phase;
    facet_environment *turned = make_environment(512, 256, pattern);
    const ibl_light *a = prepare(straight, all_ggx);
    const ibl_light *b = prepare(turned, all_ggx);
    float c = cosf(phase);
    float s = sinf(phase);
    for (int i = 0; i < 400; i++) {
        float d[3], p[3], q[3];
        test_direction(i, 400, d);
        float r[3] = {c * d[0] - s * d[2], d[1], c * d[2] + s * d[0]};
        static const float roughness[4] = {0.25f, 0.4f, 0.6f, 1.0f};
        for (int k = 0; k < 4; k++) {
            ibl_specular(a, d, roughness[k], p);
            ibl_specular(b, r, roughness[k], q);
            for (int j = 0; j < 3; j++)
                assert_near(p[j], q[j], tolerance);
        }
        ibl_irradiance_over_pi(a, d, p);
        ibl_irradiance_over_pi(b, r, q);
        for (int j = 0; j < 3; j++)
            assert_near(p[j], q[j], tolerance);
    }
    ibl_light_release(a);
    ibl_light_release(b);
    facet_environment_destroy(straight);
    facet_environment_destroy(turned);
}

static void rotated_environments_give_rotated_light(void **state)
{
    (void)state;
    check_rotation((float)(0.5 * pi), 2e-4);
    check_rotation(0.7f, 0.15); /* of radiance up to 20: edges of the pattern fall on other texels */
}

/* Along each edge of the cube, lookups on both sides of it differ by no more than lookups as far apart
 * elsewhere. */
static void lookups_are_seamless(void **state)
{
    (void)state;
    rotation_phase = 0.3f;
    facet_environment *e = make_environment(512, 256, pattern);
    const ibl_light *light = prepare(e, all_ggx);
    for (int axis = 0; axis < 3; axis++)
        for (int corner = 0; corner < 4; corner++)
            for (int i = 0; i <= 100; i++)
                for (uint32_t level = 1; level < prefilter_level_count(PREFILTER_GGX); level++) {
                    float a[3], b[3], p[3], q[3];
                    int u = (axis + 1) % 3;
                    int v = (axis + 2) % 3;
                    a[axis] = b[axis] = (float)i / 50.0f - 1.0f;
                    a[u] = b[u] = corner & 1 ? 1.0f : -1.0f;
                    a[v] = b[v] = corner & 2 ? 1.0f : -1.0f;
                    a[u] *= 1.00001f;
                    b[v] *= 1.00001f;
                    ibl_specular(light, a, prefilter_roughness(PREFILTER_GGX, level), p);
                    ibl_specular(light, b, prefilter_roughness(PREFILTER_GGX, level), q);
                    for (int k = 0; k < 3; k++)
                        assert_near(p[k], q[k], 0.005);
                }
    ibl_light_release(light);
    facet_environment_destroy(e);
}

/* Roughness 0 is the image: at the middle of a texel, that texel. */
static void roughness_zero_gives_the_panorama(void **state)
{
    (void)state;
    facet_environment *e = make_environment(256, 128, pattern);
    const ibl_light *light = prepare(e, all_ggx);
    const float *pixels = e->panorama.pixels;
    for (uint32_t i = 0; i < 256 * 128; i += 37) {
        float d[3], out[3];
        equirect_direction(256, 128, i % 256, i / 256, d);
        ibl_specular(light, d, 0.0f, out);
        for (uint32_t k = 0; k < 3; k++)
            assert_near(out[k], pixels[3 * i + k], 0.01);
    }
    ibl_light_release(light);
    facet_environment_destroy(e);
}

/* No mean of an image is below its darkest texel: next to a sun, harmonics alone would be. */
static void sun_in_grey(const float d[3], float out[3])
{
    bool is_sun = d[0] > 0.5f && d[1] > 0.5f && d[2] > 0.5f && d[0] < 0.62f && d[1] < 0.62f && d[2] < 0.62f;
    for (int k = 0; k < 3; k++)
        out[k] = is_sun ? 1e5f : 1.0f + (float)k;
}

static void light_is_never_below_the_least_radiance(void **state)
{
    (void)state;
    facet_environment *e = make_environment(64, 32, sun_in_grey);
    ibl_light_desc desc = all_ggx;
    desc.needs_sheen = true;
    desc.max_sheen_roughness = 1.0f;
    const ibl_light *light = prepare(e, desc);
    for (int i = 0; i < 2000; i++)
        for (float roughness = 0.0f; roughness <= 1.0f; roughness += 0.05f) {
            float d[3], out[3], sheen[3];
            test_direction(i, 2000, d);
            ibl_specular(light, d, roughness, out);
            ibl_sheen(light, d, roughness, sheen);
            for (int k = 0; k < 3; k++) {
                assert_true(out[k] >= (1.0f + (float)k) * 0.99999f);
                assert_true(sheen[k] >= (1.0f + (float)k) * 0.99999f);
            }
        }
    ibl_light_release(light);
    facet_environment_destroy(e);
}

/* Continuous in roughness, too. */
static void light_is_continuous_in_roughness(void **state)
{
    (void)state;
    facet_environment *e = make_environment(256, 128, sky);
    const ibl_light *light = prepare(e, all_ggx);
    for (uint32_t level = 1; level + 1 < prefilter_level_count(PREFILTER_GGX); level++) {
        float d[3] = {0.6f, 0.64f, 0.48f};
        float below[3], above[3];
        ibl_specular(light, d, prefilter_roughness(PREFILTER_GGX, level) - 1e-6f, below);
        ibl_specular(light, d, prefilter_roughness(PREFILTER_GGX, level) + 1e-6f, above);
        for (int k = 0; k < 3; k++)
            assert_near(below[k], above[k], 1e-4);
    }
    ibl_light_release(light);
    facet_environment_destroy(e);
}

/* ---- parts ---- */

static void only_needed_parts_are_prepared(void **state)
{
    (void)state;
    facet_environment *e = make_environment(64, 32, sky);
    const ibl_light *light = prepare(e, (ibl_light_desc){.needs_irradiance = true});
    ibl_light_release(light);
    for (uint32_t level = 0; level < prefilter_level_count(PREFILTER_GGX); level++)
        assert_int_equal(e->parts.levels[PREFILTER_GGX][level].texels != NULL,
                         level == prefilter_level_count(PREFILTER_GGX) - 1);
    facet_environment_destroy(e);

    e = make_environment(64, 32, sky);
    light = prepare(e, (ibl_light_desc){.needs_specular = true}); /* roughness 0 only */
    assert_null(e->parts.harmonics.coefficients);
    assert_false(e->parts.has_narrow);
    ibl_light_release(light);

    light =
        prepare(e, (ibl_light_desc){.needs_specular = true, .min_roughness = 0.45f, .max_roughness = 0.5f});
    for (uint32_t level = 0; level < prefilter_level_count(PREFILTER_GGX); level++)
        assert_int_equal(e->parts.levels[PREFILTER_GGX][level].texels != NULL,
                         level > 0 && prefilter_roughness(PREFILTER_GGX, level) >= 0.4f &&
                             prefilter_roughness(PREFILTER_GGX, level) <= 0.52f);
    rgbx *texels = e->parts.levels[PREFILTER_GGX][4].texels;
    assert_non_null(texels);
    assert_null(e->parts.harmonics.spectra); /* scratch memory is not kept */
    assert_false(e->parts.has_narrow);
    ibl_light_release(light);

    light = prepare(e, all_ggx); /* keeps the prepared parts */
    assert_ptr_equal(e->parts.levels[PREFILTER_GGX][4].texels, texels);
    facet_environment_destroy(e); /* the light keeps it */
    float d[3] = {0.0f, 1.0f, 0.0f};
    float out[3];
    ibl_specular(light, d, 0.45f, out);
    assert_near(out[0], 0.2, 1e-4);
    ibl_light_release(light);
}

/* A level depends neither on the other parts that are prepared nor on the number of threads. */
static void levels_do_not_depend_on_other_parts_or_threads(void **state)
{
    (void)state;
    rotation_phase = 0.1f;
    facet_environment *a = make_environment(333, 150, pattern);
    facet_environment *b = make_environment(333, 150, pattern);
    ibl_light_desc desc = all_ggx;
    desc.thread_count = 1;
    const ibl_light *one = prepare(a, desc);
    desc.thread_count = 5;
    for (int r = 10; r >= 0; r--) {
        desc.min_roughness = (float)r / 10.0f;
        desc.max_roughness = desc.min_roughness;
        ibl_light_release(prepare(b, desc));
    }
    for (uint32_t level = 1; level < prefilter_level_count(PREFILTER_GGX); level++) {
        size_t edge = a->parts.levels[PREFILTER_GGX][level].size + 2;
        assert_int_equal(a->parts.levels[PREFILTER_GGX][level].size,
                         b->parts.levels[PREFILTER_GGX][level].size);
        assert_memory_equal(a->parts.levels[PREFILTER_GGX][level].texels,
                            b->parts.levels[PREFILTER_GGX][level].texels, 6 * edge * edge * sizeof(rgbx));
    }
    ibl_light_release(one);
    facet_environment_destroy(a);
    facet_environment_destroy(b);
}

static void *prepare_in_thread(void *argument)
{
    const ibl_light *light = NULL;
    ibl_light_desc desc = all_ggx;
    desc.thread_count = 2;
    if (ibl_light_prepare(argument, &desc, &light, NULL) != FACET_OK)
        return NULL;
    return (void *)(uintptr_t)light;
}

static void threads_share_prepared_parts(void **state)
{
    (void)state;
    facet_environment *e = make_environment(256, 128, sky);
    pthread_t threads[4];
    const ibl_light *lights[4];
    for (int i = 0; i < 4; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, prepare_in_thread, e), 0);
    for (int i = 0; i < 4; i++) {
        void *result = NULL;
        pthread_join(threads[i], &result);
        lights[i] = result;
        assert_non_null(result);
    }
    assert_int_equal(e->reference_count, 5);
    facet_environment_destroy(e);
    float d[3] = {0.36f, 0.48f, -0.8f};
    float first[3], other[3];
    ibl_specular(lights[0], d, 0.37f, first);
    for (int i = 1; i < 4; i++) {
        ibl_specular(lights[i], d, 0.37f, other);
        assert_memory_equal(first, other, sizeof first);
    }
    for (int i = 0; i < 4; i++)
        ibl_light_release(lights[i]);
}

/* The studio's harmonics, which are computed when facet is built, are those of its panorama. */
static void the_studio_has_its_harmonics(void **state)
{
    (void)state;
    image panorama;
    harmonics built, found;
    assert_int_equal(studio_draw(NULL, 1, &panorama, NULL), FACET_OK);
    assert_int_equal(studio_harmonics(&panorama, NULL, 1, &built, NULL), FACET_OK);
    assert_int_equal(harmonics_create(&panorama, STUDIO_DEGREE, NULL, 2, &found, NULL), FACET_OK);
    assert_int_equal(built.degree, found.degree);
    assert_int_equal(built.column_count, found.column_count);
    assert_memory_equal(built.mean, found.mean, sizeof built.mean);
    assert_memory_equal(built.least, found.least, sizeof built.least);
    assert_int_equal(mem_size(built.coefficients), mem_size(found.coefficients));
    const size_t count = mem_size(found.coefficients) / sizeof *found.coefficients;
    for (size_t i = 0; i < count; i++) /* of other machines' C libraries to rounding */
        assert_near(built.coefficients[i], found.coefficients[i], 1e-6);
    harmonics_destroy(&built);
    harmonics_destroy(&found);
    image_destroy(&panorama);
}

/* ---- memory ---- */

/* Each failing allocation gives FACET_ERROR_MEMORY, and nothing leaks. */
static void running_out_of_memory_leaks_nothing(void **state)
{
    (void)state;
    for (long limit = 0;; limit = next_failure(limit)) {
        failing_allocator c = {.fail_at = limit};
        facet_environment_desc desc = {
            .allocator = failing_allocator_get(&c), .thread_count = 1, .cache_folder = NULL};
        facet_environment *e = NULL;
        facet_error error;
        facet_result result = facet_environment_create_studio(&desc, &e, &error);
        const ibl_light *light = NULL;
        ibl_light_desc all = all_ggx;
        all.thread_count = 1;
        all.background_size = 8;
        if (result == FACET_OK)
            result = ibl_light_prepare(e, &all, &light, &error);
        if (result != FACET_OK) {
            assert_int_equal(result, FACET_ERROR_MEMORY);
            assert_null(light);
        }
        ibl_light_release(light);
        facet_environment_destroy(e);
        assert_int_equal(c.blocks, 0);
        if (result == FACET_OK) {
            print_message("%ld allocations\n", limit);
            return;
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(uniform_light_stays_uniform),
        cmocka_unit_test(kernels_equal_golden_values),
        cmocka_unit_test(bands_of_harmonics_are_scaled),
        cmocka_unit_test(irradiance_is_that_of_the_clamped_cosine),
        cmocka_unit_test(a_sun_becomes_the_lobe),
        cmocka_unit_test(rotated_environments_give_rotated_light),
        cmocka_unit_test(lookups_are_seamless),
        cmocka_unit_test(roughness_zero_gives_the_panorama),
        cmocka_unit_test(light_is_never_below_the_least_radiance),
        cmocka_unit_test(light_is_continuous_in_roughness),
        cmocka_unit_test(only_needed_parts_are_prepared),
        cmocka_unit_test(levels_do_not_depend_on_other_parts_or_threads),
        cmocka_unit_test(threads_share_prepared_parts),
        cmocka_unit_test(the_studio_has_its_harmonics),
        cmocka_unit_test(running_out_of_memory_leaks_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
