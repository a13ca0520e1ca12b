/* sheen_test.c - light filtered for sheen: against closed forms, against sums over all texels with the filter, and
 * against sums with the whole lobe, which is what the filter approximates. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "ibl/dfg_integrate.h"
#include "ibl/light_fixture.h"

#include "shade/shade.h"

static const double pi = 3.14159265358979323846;

static const ibl_light_desc all_sheen = {.needs_sheen = true, .max_sheen_roughness = 1.0f};

/* Charlie's lobe around R at x = N.L, of integral 1 over the hemisphere: (1 - x)^q x with q = 1 / (2 alpha), as D is
 * a power of sin(h) = sqrt((1 - x) / 2) and the integral of (1 - x)^q x over x is 1 / ((q + 1)(q + 2)). */
static double ring(double x, double roughness)
{
    double q = 0.5 / (roughness * roughness);
    return x > 0.0 ? (q + 1.0) * (q + 2.0) * pow(1.0 - x, q) * x / (2.0 * pi) : 0.0;
}

/* The mean of the lobe over views at x = N.L, of integral 1: E(x) x, with E by quadrature, linear between 4096 nodes of
 * sqrt(x). */
static double lobe(double x, double roughness)
{
    enum { NODES = 4096 };
    static double table[NODES + 2], of_table;
    if (of_table != roughness) {
        static sheen_nodes nodes;
        double whole = 0.0;
        sheen_prepare((float)roughness, &nodes);
        for (int i = 0; i < NODES + 2; i++) {
            double root = (double)i / NODES;
            table[i] = sheen_integrate(&nodes, fmin(root * root, 1.0)).charlie * root * root;
            whole += i < NODES + 1 ? 2.0 * pi * table[i] * 2.0 * root / NODES : 0.0; /* dx = 2 root droot */
        }
        for (int i = 0; i < NODES + 2; i++)
            table[i] /= whole;
        of_table = roughness;
    }
    double place = NODES * sqrt(fmax(x, 0.0));
    int i = (int)fmin(place, NODES);
    return table[i] + (table[i + 1] - table[i]) * (place - i);
}

/* k_l of the ring by quadrature in long double. */
static void kernels_equal_golden_values(void **state)
{
    (void)state;
    static const double golden[5][5] = {
        {0.10, 0.037735849057, -0.496855345912, -0.056222603392, 0.367197922622},
        {0.25, 0.181818181818, -0.431818181818, -0.237762237762, 0.226398601399},
        {0.50, 0.4, -0.2, -0.314285714286, -0.0625},
        {0.75, 0.514285714286, -0.026623376623, -0.235530507229, -0.127764581736},
        {1.00, 0.571428571429, 0.071428571429, -0.164502164502, -0.121170496170}};
    for (int i = 0; i < 5; i++) {
        float kernel[PREFILTER_DEGREE + 1];
        prefilter_kernel(PREFILTER_CHARLIE, (float)golden[i][0], PREFILTER_DEGREE, kernel);
        assert_near(kernel[0], 1.0, 0.0);
        for (int l = 1; l <= 4; l++)
            assert_near(kernel[l], golden[i][l], 1e-6);
    }
}

/* High degrees, down to roughness where D is below any float, against many midpoints of the lobe in x. */
static void check_kernel(prefilter_lobe which, double (*weight)(double x, double roughness), double roughness,
                         double tolerance)
{
    float kernel[PREFILTER_DEGREE + 1];
    prefilter_kernel(which, (float)roughness, PREFILTER_DEGREE, kernel);
    double sum[PREFILTER_DEGREE + 1] = {0.0};
    const int count = 40000;
    for (int i = 0; i < count; i++) {
        double x = (i + 0.5) / count, p = 1.0, before = 0.0, w = weight(x, roughness);
        for (int l = 0; l <= PREFILTER_DEGREE; l++) {
            sum[l] += 2.0 * pi * w * p / count;
            double next = ((2.0 * l + 1.0) * x * p - l * before) / (l + 1.0);
            before = p;
            p = next;
        }
    }
    for (int l = 0; l <= PREFILTER_DEGREE; l++)
        assert_near(kernel[l], sum[l], tolerance);
}

static void kernels_are_accurate_at_high_degrees(void **state)
{
    (void)state;
    for (int r = 1; r <= 20; r++)
        check_kernel(PREFILTER_CHARLIE, ring, 0.05 * r, 2e-5);
    for (int r = 2; r <= 20; r += 2) /* E from the LUT of 128 nodes, against quadrature */
        check_kernel(PREFILTER_SHEEN, lobe, 0.05 * r, 2e-3);
}

static void uniform_light_stays_uniform(void **state)
{
    (void)state;
    static const float radiance[3] = {0.3f, 1.0f, 1234.5f};
    facet_environment *e = NULL;
    assert_int_equal(facet_environment_create_constant(radiance, NULL, &e, NULL), FACET_OK);
    const ibl_light *light = prepare(e, all_sheen);
    for (int i = 0; i < 200; i++)
        for (int r = 0; r <= 50; r++) {
            float d[3], out[3];
            test_direction(i, 200, d);
            ibl_sheen(light, d, (float)r / 50.0f, out);
            for (int k = 0; k < 3; k++)
                assert_near(out[k] / radiance[k], 1.0, 1e-6);
        }
    ibl_light_release(light);
    facet_environment_destroy(e);
}

/* ---- a sun: the lobe itself ---- */

static void nothing(const float d[3], float out[3])
{
    (void)d;
    out[0] = out[1] = out[2] = 0.0f;
}

/* At each level, around a sun of one texel: the ring, no light behind its edge, none negative. */
static void a_sun_becomes_the_lobe(void **state)
{
    (void)state;
    const uint32_t width = 1024, height = 512, sun_x = 614, sun_y = 139;
    facet_environment *e = make_environment(width, height, nothing);
    double omega = equirect_texel_solid_angle(width, height, sun_y);
    float *sun = (float *)e->panorama.pixels + 3 * ((size_t)sun_y * width + sun_x);
    sun[0] = sun[1] = sun[2] = (float)(1.0 / omega);
    float L[3];
    equirect_direction(width, height, sun_x, sun_y, L);
    const ibl_light *light = prepare(e, all_sheen);
    for (uint32_t level = 1; level < prefilter_level_count(PREFILTER_SHEEN); level++) {
        double roughness = (double)prefilter_roughness(PREFILTER_SHEEN, level);
        double peak = 0.0;
        for (int i = 0; i < 1000; i++)
            peak = fmax(peak, lobe(i / 1000.0, roughness));
        double worst = 0.0, square = 0.0, energy = 0.0;
        const int count = 20000;
        for (int i = 0; i < count; i++) {
            float R[3], out[3];
            test_direction(i, count, R);
            ibl_sheen(light, R, (float)roughness, out);
            assert_true(out[0] >= 0.0f && out[1] == out[0]);
            double expected = lobe((double)(L[0] * R[0] + L[1] * R[1] + L[2] * R[2]), roughness);
            worst = fmax(worst, fabs((double)out[0] - expected) / peak);
            square += pow(((double)out[0] - expected) / peak, 2.0);
            energy += 4.0 * pi / count * (double)out[0];
        }
        print_message("roughness %.2f: peak %.3f, largest error %.2f %% of it, RMS %.2f %%, energy %.4f\n",
                      roughness, peak, 100.0 * worst, 100.0 * sqrt(square / count), energy);
        /* the largest at the horizon, where a ring ends in an edge; energy: of nonnegative values */
        assert_true(worst < 0.05 + 0.035 / roughness && sqrt(square / count) < 0.02);
        assert_near(energy, 1.0, 0.003 / roughness);
    }
    ibl_light_release(light);
    facet_environment_destroy(e);
}

/* ---- brute force ---- */

/* The sum over all texels, the lobe in the middle of each. */
static void filter_by_sum(const image *panorama, const float R[3], double roughness, double out[3])
{
    double whole = 0.0;
    out[0] = out[1] = out[2] = 0.0;
    for (uint32_t y = 0; y < panorama->height; y++) {
        double omega = equirect_texel_solid_angle(panorama->width, panorama->height, y);
        for (uint32_t x = 0; x < panorama->width; x++) {
            float d[3];
            equirect_direction(panorama->width, panorama->height, x, y, d);
            double w = omega * lobe((double)(d[0] * R[0] + d[1] * R[1] + d[2] * R[2]), roughness);
            const float *texel = (const float *)panorama->pixels + 3 * ((size_t)y * panorama->width + x);
            whole += w;
            for (int k = 0; k < 3; k++)
                out[k] += w * (double)texel[k];
        }
    }
    for (int k = 0; k < 3; k++)
        out[k] /= whole;
}

/* RMS error over directions, relative to the mean of the expected values. */
static double compare(facet_environment *e, const char *name, double roughness, int count)
{
    const ibl_light *light = prepare(e, all_sheen);
    double square = 0.0, worst = 0.0, mean = 0.0;
    for (int i = 0; i < count; i++) {
        float R[3], out[3];
        double expected[3];
        test_direction(i, count, R);
        ibl_sheen(light, R, (float)roughness, out);
        filter_by_sum(&e->panorama, R, roughness, expected);
        for (int k = 0; k < 3; k++) {
            double error = (double)out[k] - expected[k];
            mean += expected[k] / (3.0 * count);
            square += error * error / (3.0 * count);
            worst = fmax(worst, fabs(error));
        }
    }
    print_message("%s, sheen roughness %.2f: error relative to the mean: RMS %.2f %%, largest %.2f %%\n",
                  name, roughness, 100.0 * sqrt(square) / mean, 100.0 * worst / mean);
    ibl_light_release(light);
    return sqrt(square) / mean;
}

static void room(const float d[3], float out[3])
{
    bool is_light = d[1] > 0.9f && d[0] > 0.0f;
    out[0] = is_light ? 30.0f : 0.6f + 0.4f * d[0];
    out[1] = 1.0f + sinf(5.0f * d[2]) * sinf(3.0f * d[0]) * 0.8f;
    out[2] = d[2] > 0.2f ? 4.0f : 0.5f;
}

static void analytic_environments_are_filtered_accurately(void **state)
{
    (void)state;
    facet_environment *e = make_environment(512, 256, room);
    static const double roughness[8] = {0.1, 0.12, 0.17, 0.25, 0.34, 0.5, 0.7, 0.95};
    for (int i = 0; i < 8; i++)
        assert_true(compare(e, "room", roughness[i], 60) < 0.02);
    facet_environment_destroy(e);
}

static void real_environments_are_filtered_accurately(void **state)
{
    (void)state;
    /* two rings stand for the one between them: a sun shows both, the more the sharper they are */
    static const struct {
        const char *name;
        double at_level, between;
    } environments[3] = {{"leadenhall_market_1k", 0.01, 0.015},
                         {"qwantani_afternoon_puresky_1k", 0.025, 0.08},
                         {"studio_small_03_1k", 0.01, 0.03}};
    const char *folder = test_data();
    for (int i = 0; i < 3; i++) {
        const char *name = environments[i].name;
        char path[1024];
        snprintf(path, sizeof path, "%s/env/%s.hdr", folder, name);
        facet_environment *e = NULL;
        assert_int_equal(facet_environment_load(path, NULL, &e, NULL), FACET_OK);
        for (uint32_t level = 1; level < prefilter_level_count(PREFILTER_SHEEN); level += 4)
            assert_true(compare(e, name, (double)prefilter_roughness(PREFILTER_SHEEN, level), 12) <
                        environments[i].at_level);
        static const double roughness[4] = {0.107, 0.187, 0.33, 0.47};
        for (int k = 0; k < 4; k++)
            assert_true(compare(e, name, roughness[k], 12) < environments[i].between);
        facet_environment_destroy(e);
    }
}

/* ---- against the whole lobe ---- */

/* What sheen of color 1 with normal N reflects to V, over E(V): the sum over all texels of Charlie's lobe. ring_out:
 * the same of the ring around reflect(-V, N). */
static void reflect_by_sum(const image *panorama, vec3 N, vec3 V, double roughness, double out[3],
                           double ring_out[3])
{
    float alpha = sheen_alpha((float)roughness), NdotV = dot(N, V);
    vec3 R = reflect(-V, N);
    double whole = 0.0, ring_whole = 0.0;
    for (int k = 0; k < 3; k++)
        out[k] = ring_out[k] = 0.0;
    for (uint32_t i = 0; i < panorama->width * panorama->height; i++) {
        float d[3];
        equirect_direction(panorama->width, panorama->height, i % panorama->width, i / panorama->width, d);
        double omega = equirect_texel_solid_angle(panorama->width, panorama->height, i / panorama->width);
        vec3 L = vec3(d[0], d[1], d[2]);
        float NdotL = dot(N, L);
        double w = 0.0, r = omega * ring((double)dot(R, L), roughness);
        if (NdotL > 0.0f)
            w = omega *
                (double)(brdf_sheen(NdotL, NdotV, clamp(dot(N, normalize(V + L)), 0.0f, 1.0f), alpha) *
                         NdotL);
        whole += w;
        ring_whole += r;
        for (int k = 0; k < 3; k++) {
            double texel = (double)((const float *)panorama->pixels)[3 * (size_t)i + (size_t)k];
            out[k] += w * texel;
            ring_out[k] += r * texel;
        }
    }
    for (int k = 0; k < 3; k++) {
        out[k] /= whole;
        ring_out[k] /= ring_whole;
    }
}

typedef struct view_errors {
    double filter, ring; /* RMS over normals, relative to the mean of the sums */
} view_errors;

static view_errors compare_views(facet_environment *e, const char *name, double roughness, double NdotV)
{
    enum { NORMALS = 24 };
    const ibl_light *light = prepare(e, all_sheen);
    double mean = 0.0;
    view_errors square = {0.0, 0.0};
    for (int i = 0; i < NORMALS; i++) {
        float n[3], out[3];
        double expected[3], of_ring[3];
        test_direction(i, NORMALS, n);
        vec3 N = vec3(n[0], n[1], n[2]);
        float z = (float)NdotV, across = sqrt(1.0f - z * z), turn = 2.4f * (float)i;
        vec3 V = mul(basis_from_normal(N), vec3(across * cos(turn), across * sin(turn), z));
        reflect_by_sum(&e->panorama, N, V, roughness, expected, of_ring);
        ibl_sheen(light, n, (float)roughness, out);
        for (int k = 0; k < 3; k++) {
            mean += expected[k] / (3.0 * NORMALS);
            square.filter += pow((double)out[k] - expected[k], 2.0) / (3.0 * NORMALS);
            square.ring += pow(of_ring[k] - expected[k], 2.0) / (3.0 * NORMALS);
        }
    }
    ibl_light_release(light);
    view_errors r = {sqrt(square.filter) / mean, sqrt(square.ring) / mean};
    print_message("%s, sheen roughness %.2f, N.V %.2f: off the whole lobe by %.2f, a ring around R by %.2f\n",
                  name, roughness, NdotV, r.filter, r.ring);
    return r;
}

static const double view_cosines[4] = {0.1, 0.4, 0.7, 0.95};

/* Small lights: the filter is to be nearer to the whole lobe than the ring, and twice as near on average. */
static void check_views(facet_environment *e, const char *name)
{
    double ratios = 0.0;
    for (int r = 0; r < 4; r++)
        for (int v = 0; v < 4; v++) {
            view_errors error = compare_views(e, name, 0.25 * (r + 1), view_cosines[v]);
            assert_true(error.filter < 1.4 * error.ring);
            ratios += log(error.ring / error.filter) / 16.0;
        }
    print_message("%s: %.2f times as near\n", name, exp(ratios));
    assert_true(exp(ratios) > 1.5);
}

static void the_filter_approximates_the_whole_lobe(void **state)
{
    (void)state;
    facet_environment *e = make_environment(256, 128, room);
    check_views(e, "room");
    facet_environment_destroy(e);
}

static void real_environments_approximate_the_whole_lobe(void **state)
{
    (void)state;
    static const char *const names[2] = {"leadenhall_market_1k", "studio_small_03_1k"};
    const char *folder = test_data();
    for (int i = 0; i < 2; i++) {
        char path[1024];
        snprintf(path, sizeof path, "%s/env/%s.hdr", folder, names[i]);
        facet_environment *full = NULL, *e = make_environment(1, 1, nothing);
        assert_int_equal(facet_environment_load(path, NULL, &full, NULL), FACET_OK);
        image_destroy(&e->panorama);
        assert_int_equal(equirect_resize(&full->panorama, 256, 128, NULL, 0, &e->panorama, NULL), FACET_OK);
        check_views(e, names[i]);
        facet_environment_destroy(e);
        facet_environment_destroy(full);
    }
}

/* ---- parts ---- */

/* Without sheen no level is prepared; a range of roughness prepares the levels around it. */
static void only_needed_levels_are_prepared(void **state)
{
    (void)state;
    facet_environment *e = make_environment(64, 32, room);
    ibl_light_release(prepare(
        e, (ibl_light_desc){.needs_irradiance = true, .needs_specular = true, .max_roughness = 1.0f}));
    for (uint32_t level = 0; level < prefilter_level_count(PREFILTER_SHEEN); level++)
        assert_null(e->parts.levels[PREFILTER_SHEEN][level].texels);
    const ibl_light *light = prepare(
        e, (ibl_light_desc){.needs_sheen = true, .min_sheen_roughness = 0.32f, .max_sheen_roughness = 0.35f});
    for (uint32_t level = 0; level < prefilter_level_count(PREFILTER_SHEEN); level++) {
        float roughness = prefilter_roughness(PREFILTER_SHEEN, level);
        assert_int_equal(e->parts.levels[PREFILTER_SHEEN][level].texels != NULL,
                         roughness >= 0.3f && roughness <= 0.38f);
    }
    float d[3] = {0.0f, 0.6f, 0.8f};
    float inside[3], outside[3];
    ibl_sheen(light, d, 0.38f, inside); /* beyond the prepared levels: the nearest one */
    ibl_sheen(light, d, 1.0f, outside);
    assert_memory_equal(inside, outside, sizeof inside);
    ibl_light_release(light);
    facet_environment_destroy(e);
}

/* Below the first level, and at no roughness at all, the lobe is that of the first level. */
static void low_roughness_is_clamped_to_the_first_level(void **state)
{
    (void)state;
    facet_environment *e = make_environment(64, 32, room);
    const ibl_light *light = prepare(e, (ibl_light_desc){.needs_sheen = true});
    const ibl_light *whole = prepare(e, all_sheen);
    float d[3] = {0.36f, -0.48f, 0.8f};
    float first[3], out[3];
    ibl_sheen(whole, d, prefilter_roughness(PREFILTER_SHEEN, 1), first);
    for (int i = 0; i < 10; i++) {
        ibl_sheen(i & 1 ? light : whole, d, 0.01f * (float)i, out);
        assert_memory_equal(first, out, sizeof out);
    }
    ibl_sheen(light, d, NAN, out);
    assert_memory_equal(first, out, sizeof out);
    ibl_light_release(light);
    ibl_light_release(whole);
    facet_environment_destroy(e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kernels_equal_golden_values),
        cmocka_unit_test(kernels_are_accurate_at_high_degrees),
        cmocka_unit_test(uniform_light_stays_uniform),
        cmocka_unit_test(a_sun_becomes_the_lobe),
        cmocka_unit_test(analytic_environments_are_filtered_accurately),
        cmocka_unit_test(real_environments_are_filtered_accurately),
        cmocka_unit_test(the_filter_approximates_the_whole_lobe),
        cmocka_unit_test(real_environments_approximate_the_whole_lobe),
        cmocka_unit_test(only_needed_levels_are_prepared),
        cmocka_unit_test(low_roughness_is_clamped_to_the_first_level),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
