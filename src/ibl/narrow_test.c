/* narrow_test.c - lookups between roughness 0 and 0.16 against the lobe itself. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "ibl/environment.h"
#include "ibl/equirect.h"
#include "ibl/ibl.h"
#include "ibl/light_fixture.h"
#include "ibl/narrow.h"
#include "tests/support/support.h"

static const double pi = 3.14159265358979323846;

static const ibl_light_desc nearly_smooth = {.needs_specular = true, .max_roughness = NARROW_END};

static const float some_roughness[] = {0.02f, 0.04f, 0.06f, 0.08f, 0.1f, 0.12f, 0.14f};
enum { ROUGHNESS_COUNT = sizeof some_roughness / sizeof *some_roughness };

/* ---- the lobe itself ---- */

/* D N.l at a squared distance from R of directions of length 1, times any constant: 2 (1 - N.l) = 4 (1 -
 * (N.h)^2). */
static inline float lobe_weight(float distance2, float a2)
{
    float t = a2 * (1.0f - 0.25f * distance2) + 0.25f * distance2;
    return a2 * (1.0f - 0.5f * distance2) / (t * t);
}

static float squared_distance(const float a[3], const float b[3])
{
    float x = a[0] - b[0];
    float y = a[1] - b[1];
    float z = a[2] - b[2];
    return x * x + y * y + z * z;
}

static void add_sample(double sum[4], double weight, const float L[3])
{
    for (int k = 0; k < 3; k++)
        sum[k] += weight * (double)L[k];
    sum[3] += weight;
}

/* The part of the lobe up to rad from R, by quadrature: half vectors with density D N.h, tan^2(t) = a^2 u
 * / (1 - u), of which dl = 4 N.h dh makes 4 N.l each. */
static void add_core(const image *panorama, const float R[3], float a2, double rad, double sum[4])
{
    enum { RINGS = 96, SECTORS = 96 };
    double T[3] = {0.0}, B[3];
    T[fabsf(R[1]) < 0.7f ? 1 : 0] = 1.0;
    double along = T[0] * (double)R[0] + T[1] * (double)R[1];
    double length = sqrt(1.0 - along * along);
    for (int k = 0; k < 3; k++)
        T[k] = (T[k] - along * (double)R[k]) / length;
    for (int k = 0; k < 3; k++)
        B[k] = (double)R[(k + 1) % 3] * T[(k + 2) % 3] - (double)R[(k + 2) % 3] * T[(k + 1) % 3];
    double tangent = tan(0.5 * rad);
    double share = tangent * tangent / ((double)a2 + tangent * tangent);
    for (int i = 0; i < RINGS * SECTORS; i++) {
        double u = share * (i / SECTORS + 0.5) / RINGS;
        double phi = 2.0 * pi * (i % SECTORS + 0.5 + 0.618 * (i / SECTORS)) / SECTORS;
        double angle = 2.0 * atan(sqrt((double)a2 * u / (1.0 - u)));
        float d[3], L[3];
        for (int k = 0; k < 3; k++)
            d[k] = (float)(cos(angle) * (double)R[k] + sin(angle) * (cos(phi) * T[k] + sin(phi) * B[k]));
        equirect_lookup(panorama, d, L);
        add_sample(sum, 4.0 * pi * cos(angle) * share / (RINGS * SECTORS), L);
    }
}

/* A texel in parts x parts pieces, without those nearer to R than near2. */
static void add_pieces(const image *panorama, uint32_t x, uint32_t y, int parts, const float R[3], float a2,
                       float near2, double sum[4])
{
    double omega = equirect_texel_solid_angle(panorama->width, panorama->height, y) / (parts * parts);
    for (int i = 0; i < parts * parts; i++) {
        float d[3], L[3];
        equirect_direction(panorama->width, panorama->height, x - 0.5 + (i % parts + 0.5) / parts,
                           y - 0.5 + (i / parts + 0.5) / parts, d);
        float distance2 = squared_distance(d, R);
        if (distance2 < near2 || distance2 > 2.0f)
            continue;
        equirect_lookup(panorama, d, L);
        add_sample(sum, omega * (double)lobe_weight(distance2, a2), L);
    }
}

/* Mean of the environment over the lobe: integral of D N.l L dl over that of D N.l. The middle by
 * quadrature over the lobe, texels near it in pieces, the rest as they are. */
static void lobe_mean(const image *panorama, const float R[3], float perceptual_roughness, double mean[3])
{
    enum { MAX_WIDTH = 1024 };
    uint32_t width = panorama->width;
    float a2 = powf(perceptual_roughness, 4.0f);
    double texel = pi / panorama->height;
    double sum[4] = {0.0};
    float near2 = (float)(2.25 * texel * texel);
    float column_cos[MAX_WIDTH], column_sin[MAX_WIDTH];
    assert_true(width <= MAX_WIDTH);
    for (uint32_t x = 0; x < width; x++) {
        float d[3];
        equirect_direction(width, 1, x, 0.0, d);
        column_cos[x] = d[0];
        column_sin[x] = d[2];
    }
    add_core(panorama, R, a2, 2.0 * asin(0.75 * texel), sum);
    for (uint32_t y = 0; y < panorama->height; y++) {
        float ring = (float)sin(pi * (y + 0.5) / panorama->height);
        float dy = (float)cos(pi * (y + 0.5) / panorama->height) - R[1];
        float distance2[MAX_WIDTH], row[4] = {0.0f};
        for (uint32_t x = 0; x < width; x++) {
            float dx = ring * column_cos[x] - R[0];
            float dz = ring * column_sin[x] - R[2];
            distance2[x] = dx * dx + dy * dy + dz * dz;
        }
        for (uint32_t x = 0; x < width; x++) {
            double texels2 = (double)distance2[x] / (texel * texel);
            if (texels2 < 900.0) {
                add_pieces(panorama, x, y, texels2 < 64.0 ? 12 : 3, R, a2, near2, sum);
            } else if (distance2[x] < 2.0f) {
                const float *L = (const float *)panorama->pixels + 3 * ((size_t)y * width + x);
                float w = lobe_weight(distance2[x], a2);
                for (int k = 0; k < 3; k++)
                    row[k] += w * L[k];
                row[3] += w;
            }
        }
        double omega = equirect_texel_solid_angle(width, panorama->height, y);
        for (int k = 0; k < 4; k++)
            sum[k] += (double)row[k] * omega;
    }
    for (int k = 0; k < 3; k++)
        mean[k] = sum[k] / sum[3];
}

/* Root mean square of the error over that of the lobe itself, at directions spread over the sphere. */
static double error_over_sphere(const ibl_light *light, const image *panorama, float roughness, int count)
{
    double square = 0.0;
    double reference = 0.0;
    for (int i = 0; i < count; i++) {
        float d[3], out[3];
        double mean[3];
        test_direction(i, count, d);
        lobe_mean(panorama, d, roughness, mean);
        ibl_specular(light, d, roughness, out);
        for (int k = 0; k < 3; k++) {
            square += ((double)out[k] - mean[k]) * ((double)out[k] - mean[k]);
            reference += mean[k] * mean[k];
        }
    }
    return sqrt(square / reference);
}

/* ---- weights ---- */

/* Weights are never negative and add up to 1; only the sharp image counts at one end, only the rough lobe
 * at the other, with smooth transitions; the lobe of NARROW_END has at least the weight of the tail. */
static void weights_are_smooth_and_add_up(void **state)
{
    (void)state;
    static const double rows[] = {512.0, 400.0, 256.0, 100.0};
    for (uint32_t count = 0; count <= NARROW_COUNT; count++)
        for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
            narrow n = {.count = count};
            narrow_fit(count, pi / rows[k], n.weights);
            float before[NARROW_PARTS] = {1.0f};
            for (int i = 0; i <= 160; i++) {
                float w[NARROW_PARTS];
                double r = 0.001 * i;
                narrow_weights(&n, (float)r, w);
                double sum = 0.0;
                for (uint32_t part = 0; part < NARROW_PARTS; part++) {
                    sum += (double)w[part];
                    assert_true(w[part] >= 0.0f);
                    assert_near(w[part], before[part], 0.05);
                    if (part > count && part < NARROW_LOBE)
                        assert_true(w[part] == 0.0f);
                    before[part] = w[part];
                }
                assert_near(sum, 1.0, 1e-6);
                assert_true((double)w[NARROW_LOBE] >= pow(r / 0.16, 4.0) - 1e-6);
            }
            assert_true(before[NARROW_LOBE] == 1.0f);
        }
}

/* ---- images ---- */

static double image_mean(const image *panorama)
{
    double sum = 0.0;
    for (uint32_t y = 0; y < panorama->height; y++) {
        double row = 0.0;
        for (uint32_t x = 0; x < panorama->width; x++)
            row += (double)((const float *)panorama->pixels)[3 * ((size_t)y * panorama->width + x)];
        sum += row * equirect_texel_solid_angle(panorama->width, panorama->height, y);
    }
    return sum / (4.0 * pi);
}

static void dark(const float d[3], float out[3])
{
    (void)d;
    out[0] = out[1] = out[2] = 0.0f;
}

/* A sun of one texel keeps its energy wherever it is, poles included, and nothing is negative. */
static void a_sun_keeps_its_energy(void **state)
{
    (void)state;
    static const uint32_t places[][2] = {{0, 0},   {700, 1},   {3, 5},      {1023, 30},
                                         {0, 200}, {511, 256}, {1023, 300}, {17, 511}};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        facet_environment *e = make_environment(1024, 512, dark);
        ((float *)e->panorama.pixels)[3 * (1024 * (size_t)places[i][1] + places[i][0])] = 1e5f;
        double expected = image_mean(&e->panorama);
        narrow n;
        assert_int_equal(narrow_create(&e->panorama, NULL, 2, &n, NULL), FACET_OK);
        assert_int_equal(n.count, NARROW_COUNT);
        for (uint32_t k = 0; k < n.count; k++) {
            assert_int_equal(n.blurred[k].width, 1024 >> k);
            assert_near(image_mean(&n.blurred[k]) / expected, 1.0, 1e-5);
            const float *p = n.blurred[k].pixels;
            for (size_t j = 0; j < 3 * (size_t)n.blurred[k].width * n.blurred[k].height; j++)
                assert_true(p[j] >= 0.0f);
        }
        narrow_destroy(&n);
        facet_environment_destroy(e);
    }
}

static void uniform(const float d[3], float out[3])
{
    (void)d;
    out[0] = 0.3f;
    out[1] = 1.0f;
    out[2] = 1e6f;
}

/* At any size uniform light stays uniform, and bytes do not depend on threads. */
static void all_sizes_keep_uniform_light(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{1, 1},     {2, 1},     {5, 3},     {16, 16},
                                        {64, 32},   {100, 50},  {333, 150}, {1000, 700},
                                        {2048, 64}, {64, 2048}, {1030, 515}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        facet_environment *e = make_environment(sizes[i][0], sizes[i][1], uniform);
        narrow n;
        assert_int_equal(narrow_create(&e->panorama, NULL, 1, &n, NULL), FACET_OK);
        for (uint32_t k = 0; k < n.count; k++) {
            const float *p = n.blurred[k].pixels;
            for (size_t j = 0; j < (size_t)n.blurred[k].width * n.blurred[k].height; j++) {
                assert_near(p[3 * j] / 0.3f, 1.0, 1e-6);
                assert_near(p[3 * j + 2] / 1e6f, 1.0, 1e-6);
            }
        }
        narrow_destroy(&n);
        uint32_t seed = 1;
        float *pixels = e->panorama.pixels;
        for (size_t j = 0; j < 3 * (size_t)sizes[i][0] * sizes[i][1]; j++) {
            lcg_next(&seed);
            pixels[j] = (float)(seed >> 8);
        }
        narrow m;
        assert_int_equal(narrow_create(&e->panorama, NULL, 1, &n, NULL), FACET_OK);
        assert_int_equal(narrow_create(&e->panorama, NULL, 3, &m, NULL), FACET_OK);
        assert_int_equal(n.count, m.count);
        assert_memory_equal(n.weights, m.weights, sizeof n.weights);
        for (uint32_t k = 0; k < n.count; k++)
            assert_memory_equal(n.blurred[k].pixels, m.blurred[k].pixels,
                                image_row_size(&n.blurred[k]) * n.blurred[k].height);
        narrow_destroy(&n);
        narrow_destroy(&m);
        facet_environment_destroy(e);
    }
}

/* ---- lookups ---- */

static float blob_middle[3];

/* A Gaussian light of 1.2 degrees in a dim sky. */
static void blob(const float d[3], float out[3])
{
    float x = d[0] - blob_middle[0];
    float y = d[1] - blob_middle[1];
    float z = d[2] - blob_middle[2];
    out[0] = out[1] = out[2] = 0.2f + 100.0f * expf((x * x + y * y + z * z) * -1100.0f);
}

/* The lobe itself around a small light: the same at the poles, where texels are narrow, on the image's
 * seam and elsewhere. */
static void small_lights_become_the_lobe_anywhere(void **state)
{
    (void)state;
    static const float places[][3] = {{0.0f, 1.0f, 0.0f},
                                      {0.02f, -0.9998f, 0.0f},
                                      {0.1f, 0.99f, 0.1f},
                                      {-1.0f, 0.0f, 0.0f},
                                      {0.6f, 0.48f, 0.64f}};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        float length =
            sqrtf(places[i][0] * places[i][0] + places[i][1] * places[i][1] + places[i][2] * places[i][2]);
        for (int k = 0; k < 3; k++)
            blob_middle[k] = places[i][k] / length;
        facet_environment *e = make_environment(1024, 512, blob);
        const ibl_light *light = prepare(e, nearly_smooth);
        for (int r = 1; r < ROUGHNESS_COUNT; r += 2)
            for (int k = 0; k < 6; k++) {
                float d[3], out[3];
                double mean[3], sum = 0.0;
                for (int j = 0; j < 3; j++)
                    d[j] = blob_middle[j] + 0.008f * (float)k * (j == k % 3 ? 1.0f : -0.7f);
                for (int j = 0; j < 3; j++)
                    sum += (double)d[j] * (double)d[j];
                for (int j = 0; j < 3; j++)
                    d[j] /= (float)sqrt(sum);
                lobe_mean(&e->panorama, d, some_roughness[r], mean);
                ibl_specular(light, d, some_roughness[r], out);
                assert_near(out[1], mean[1],
                            3.0); /* of 100; a blend of the sharp image and the rough lobe: 11 */
            }
        ibl_light_release(light);
        facet_environment_destroy(e);
    }
}

/* A sun becomes duller and wider with roughness, without steps. */
static void a_sun_widens_continuously_with_roughness(void **state)
{
    (void)state;
    facet_environment *e = make_environment(1024, 512, dark);
    float *sun = (float *)e->panorama.pixels + 3 * (1024 * 200 + 77);
    sun[0] = sun[1] = sun[2] = 1e5f;
    const ibl_light *light = prepare(e, (ibl_light_desc){.needs_specular = true, .max_roughness = 0.2f});
    float d[3], first[3], out[3];
    equirect_direction(1024, 512, 77.0, 200.0, d);
    ibl_specular(light, d, 0.0f, first);
    float before = first[0];
    for (int i = 1; i <= 2000; i++) {
        ibl_specular(light, d, 1e-4f * (float)i, out);
        assert_true(out[0] <= before);
        assert_near(out[0], before, 0.004 * (double)first[0]);
        before = out[0];
    }
    ibl_light_release(light);
    facet_environment_destroy(e);
}

/* ---- real environments ---- */

enum { PROBES = 60 };

static void check_file(const char *name, double tolerance)
{
    const char *folder = test_data();
    char path[512];
    snprintf(path, sizeof path, "%s/env/%s", folder, name);
    facet_environment *e = NULL;
    facet_error error = {0};
    facet_result result = facet_environment_load(path, &(facet_environment_desc){0}, &e, &error);
    if (result != FACET_OK)
        print_error("%s\n", error.message);
    assert_int_equal(result, FACET_OK);
    const ibl_light *light = prepare(e, nearly_smooth);
    print_message("%s:", name);
    double worst = 0.0;
    for (int i = 0; i < ROUGHNESS_COUNT; i++) {
        double error_of_lobe = error_over_sphere(light, &e->panorama, some_roughness[i], PROBES);
        worst = fmax(worst, error_of_lobe);
        print_message("  %.2f: %.4f", (double)some_roughness[i], error_of_lobe);
    }
    print_message("\n");
    assert_true(worst < tolerance);
    ibl_light_release(light);
    facet_environment_destroy(e);
}

static void real_environments_are_blurred_accurately(void **state)
{
    (void)state;
    check_file("leadenhall_market_1k.hdr", 0.03);
    check_file("studio_small_03_1k.hdr", 0.045);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(weights_are_smooth_and_add_up),
        cmocka_unit_test(a_sun_keeps_its_energy),
        cmocka_unit_test(all_sizes_keep_uniform_light),
        cmocka_unit_test(small_lights_become_the_lobe_anywhere),
        cmocka_unit_test(a_sun_widens_continuously_with_roughness),
        cmocka_unit_test(real_environments_are_blurred_accurately),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
