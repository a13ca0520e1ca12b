/* bake_test.c - baked cube maps against closed forms, and properties of all of them. */
#include <float.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "bake/bake_fixture.h"

#include "bake/bake_area.h"
#include "bake/bake_lobe.h"
#include "tests/support/support.h"
#include "base/memory.h"
#include "ibl/gauss.h"

static const double pi = 3.14159265358979323846;

/* ---- uniform light ---- */

static void uniform_light_stays_uniform(void **state)
{
    (void)state;
    static const float radiance[3] = {0.3f, 1.0f, 1234.5f};
    facet_environment *e = NULL;
    assert_int_equal(facet_environment_create_constant(radiance, NULL, &e, NULL), FACET_OK);
    for (int lobe = 0; lobe <= FACET_LOBE_NONE; lobe++)
        for (int method = 0; method <= FACET_BAKE_METHOD_REFERENCE; method++) {
            if (is_slow_ring(lobe, method))
                continue;
            facet_cube *c = bake(e, (facet_bake_desc){.lobe = (facet_lobe)lobe,
                                                      .method = (facet_bake_method)method,
                                                      .size = 16,
                                                      .level_count = 5,
                                                      .samples = 128,
                                                      .rotation_rad = 0.3f,
                                                      .ev = 1.0f});
            for (uint32_t level = 0; level < 5; level++)
                for (uint32_t i = 0; i < texel_count(&c->levels[level]); i++)
                    for (int k = 0; k < 3; k++)
                        assert_near(texel_of(&c->levels[level], i)[k] / radiance[k], 2.0, 2e-6);
            facet_cube_destroy(c);
        }
    facet_environment_destroy(e);
}

/* ---- bands ---- */

static double legendre_of(int l, double x)
{
    double p[5] = {1.0, x, 1.5 * x * x - 0.5, 2.5 * x * x * x - 1.5 * x,
                   (35.0 * x * x * x * x - 30.0 * x * x + 3.0) / 8.0};
    return p[l];
}

/* Around an axis that no grid has. */
static double tilt(const double d[3])
{
    return 0.48 * d[0] + 0.6 * d[1] + 0.64 * d[2];
}

/* Bands 1, 2 and 3, or 3, 4 and 4, in red, green and blue. */
static void low_bands(const float d[3], float out[3])
{
    double e[3] = {(double)d[0], (double)d[1], (double)d[2]};
    for (int k = 0; k < 3; k++)
        out[k] = (float)(1.5 + legendre_of(1 + k, tilt(e)));
}

static void high_bands(const float d[3], float out[3])
{
    double e[3] = {(double)d[0], (double)d[1], (double)d[2]};
    for (int k = 0; k < 3; k++)
        out[k] = (float)(1.5 + legendre_of(k ? 4 : 3, tilt(e)));
}

/* k_1 to k_4 of roughness 0.25, 0.5, 0.75 and 1: quadrature in long double. */
static const double golden[2][4][4] = {{{0.976092604298, 0.933738270618, 0.880606983182, 0.822958863625},
                                        {0.867395662812, 0.662405687279, 0.460387585347, 0.305538297757},
                                        {0.745131342455, 0.398824737791, 0.140121157544, 0.028984607620},
                                        {0.666666666667, 0.25, 0.0, -0.041666666667}},
                                       {{0.181818181818, -0.431818181818, -0.237762237762, 0.226398601399},
                                        {0.400000000000, -0.200000000000, -0.314285714286, -0.062500000000},
                                        {0.514285714286, -0.026623376623, -0.235530507229, -0.127764581736},
                                        {0.571428571429, 0.071428571429, -0.164502164502, -0.121170496170}}};

static double worst_of_bands(facet_environment *e, facet_lobe lobe, facet_bake_method method, bool is_high)
{
    facet_cube *c =
        bake(e, (facet_bake_desc){
                    .lobe = lobe, .method = method, .size = 32, .level_count = 5, .rotation_rad = 0.7f});
    double worst = 0.0;
    for (uint32_t level = 1; level < 5; level++)
        for (uint32_t i = 0; i < texel_count(&c->levels[level]); i++) {
            double d[3];
            texel_direction(&c->levels[level], i, d);
            double turned[3] = {d[0] * cos(0.7) - d[2] * sin(0.7), d[1], d[0] * sin(0.7) + d[2] * cos(0.7)};
            for (int k = 0; k < 3; k++) {
                int l = is_high ? (k ? 4 : 3) : 1 + k;
                double expected = 1.5 + golden[lobe][level - 1][l - 1] * legendre_of(l, tilt(turned));
                worst = fmax(worst, fabs((double)texel_of(&c->levels[level], i)[k] - expected));
            }
        }
    facet_cube_destroy(c);
    return worst;
}

static void bands_of_harmonics_are_scaled(void **state)
{
    (void)state;
    /* an image of texels 0.025 rad wide has l (l + 1) width^2 / 24 = 5e-4 less of band 4; samples blur a
     * little more */
    static const double tolerance[2] = {6e-4, 2e-2};
    facet_environment *low = make_environment(256, 128, low_bands);
    facet_environment *high = make_environment(256, 128, high_bands);
    for (int lobe = 0; lobe < (IS_SLOW ? 1 : 2); lobe++)
        for (int method = 0; method < 2; method++) {
            double a = worst_of_bands(low, (facet_lobe)lobe, (facet_bake_method)method, false);
            double b = is_slow_ring(lobe, method)
                           ? 0.0
                           : worst_of_bands(high, (facet_lobe)lobe, (facet_bake_method)method, true);
            print_message("lobe %d, method %d: largest deviation %.1e, %.1e\n", lobe, method, a, b);
            assert_true(fmax(a, b) < tolerance[method]);
        }
    facet_environment_destroy(low);
    facet_environment_destroy(high);
    low = make_environment(64, 32, low_bands);
    for (int lobe = IS_SLOW; lobe < 2; lobe++) {
        double a = worst_of_bands(low, (facet_lobe)lobe, FACET_BAKE_METHOD_REFERENCE, false);
        print_message("lobe %d, reference, 64 x 32: largest deviation %.1e\n", lobe, a);
        assert_true(a < 5e-3); /* the image's texels are 0.1 rad wide */
    }
    facet_environment_destroy(low);
}

static void upper_half(const float d[3], float out[3])
{
    out[0] = out[1] = out[2] = d[2] > 0.0f ? d[2] : 0.0f;
}

/* Lambert's lobe of the clamped cosine: (2 / 3) ((pi - t) cos(t) + sin(t)) / pi. */
static void irradiance_is_that_of_the_clamped_cosine(void **state)
{
    (void)state;
    facet_environment *e = make_environment(256, 128, upper_half);
    for (int method = 0; method < 2; method++) {
        facet_cube *c = bake(
            e,
            (facet_bake_desc){.lobe = FACET_LOBE_LAMBERT, .method = (facet_bake_method)method, .size = 16});
        assert_int_equal(facet_cube_get_level_count(c), 1);
        for (uint32_t i = 0; i < texel_count(&c->levels[0]); i++) {
            double d[3];
            texel_direction(&c->levels[0], i, d);
            double t = acos(d[2]);
            double expected = 2.0 / 3.0 * ((pi - t) * cos(t) + sin(t)) / pi;
            assert_near(texel_of(&c->levels[0], i)[0], expected, method ? 6e-3 : 3e-4);
        }
        facet_cube_destroy(c);
    }
    facet_environment_destroy(e);
}

/* ---- a sun ---- */

enum { SUN_WIDTH = 1024, SUN_HEIGHT = 512 };

/* One texel of 1e5 in the dark. */
static facet_environment *make_sun(uint32_t x, uint32_t y, double d[3])
{
    facet_environment *e = NULL;
    assert_int_equal(facet_environment_create_constant((float[3]){0.0f, 0.0f, 0.0f}, NULL, &e, NULL),
                     FACET_OK);
    image_destroy(&e->panorama);
    assert_int_equal(image_create(NULL, SUN_WIDTH, SUN_HEIGHT, 3, IMAGE_F32, &e->panorama, NULL), FACET_OK);
    float *p = e->panorama.pixels;
    memset(p, 0, sizeof(float) * 3 * SUN_WIDTH * SUN_HEIGHT);
    for (size_t k = 0; k < 3; k++)
        p[3 * ((size_t)y * SUN_WIDTH + x) + k] = 1e5f;
    float f[3];
    equirect_direction(SUN_WIDTH, SUN_HEIGHT, x, y, f);
    for (int k = 0; k < 3; k++)
        d[k] = (double)f[k];
    return e;
}

/* Weight over its integral, 1 / sr, by Gauss and Legendre's rule in panels that double in width. */
static double density(const bake_lobe *lobe, double s2)
{
    double whole = 0.0;
    double width = 1e-4 * lobe->alpha * lobe->alpha;
    if (lobe->kind == FACET_LOBE_CHARLIE)
        width = 1e-3;
    for (double from = 0.0; from < 0.5;) {
        double to = fmin(from + width, 0.5);
        for (int i = 0; i < 8; i++) {
            double w;
            double at = gauss_8(i, from, to, &w);
            whole += 4.0 * pi * w * bake_lobe_weight(lobe, at);
        }
        from = to;
        width *= lobe->kind == FACET_LOBE_CHARLIE ? 1.0 : 1.5;
    }
    return s2 < 0.5 ? bake_lobe_weight(lobe, s2) / whole : 0.0;
}

/* Each level shows the lobe, and no energy is lost. Tolerances are relative to the largest texel and to
 * the root mean square. */
static void check_sun(facet_lobe kind, facet_bake_method method, uint32_t x, uint32_t y, double tolerance,
                      double rms_tolerance)
{
    double sun[3];
    facet_environment *e = make_sun(x, y, sun);
    double light = 1e5 * equirect_texel_solid_angle(SUN_WIDTH, SUN_HEIGHT, y);
    facet_cube *c = bake(e, (facet_bake_desc){.lobe = kind, .method = method, .size = 128, .level_count = 4});
    for (uint32_t level = 0; level < 4; level++) {
        const cube *texels = &c->levels[level];
        double mean[3];
        cube_mean(texels, mean);
        double energy = 4.0 * pi * mean[1] / light;
        double worst = 0.0;
        double peak = 0.0;
        double square = 0.0;
        double whole = 1e-30;
        if (!bake_level_is_sharp(c, level)) {
            bake_lobe lobe = bake_lobe_create(kind, c->roughness[level]);
            double largest = density(&lobe, 0.0);
            double scale = largest > 0.0 ? largest / bake_lobe_weight(&lobe, 0.0)
                                         : density(&lobe, 0.3) / bake_lobe_weight(&lobe, 0.3);
            for (uint32_t i = 0; i < texel_count(texels); i++) {
                double d[3];
                texel_direction(texels, i, d);
                double s2 =
                    0.25 * (pow(d[0] - sun[0], 2.0) + pow(d[1] - sun[1], 2.0) + pow(d[2] - sun[2], 2.0));
                double expected = s2 < 0.5 ? light * scale * bake_lobe_weight(&lobe, s2) : 0.0;
                peak = fmax(peak, expected);
                square += pow((double)texel_of(texels, i)[1] - expected, 2.0);
                whole += expected * expected;
                worst = fmax(worst, fabs((double)texel_of(texels, i)[1] - expected));
            }
        }
        print_message("lobe %d, method %d, level %u: energy %.6f, largest error %.2e of %g, RMS %.2e\n",
                      (int)kind, (int)method, level, energy, peak > 0.0 ? worst / peak : 0.0, peak,
                      sqrt(square / whole));
        assert_true(worst <= tolerance * peak);
        assert_true(sqrt(square / whole) <= rms_tolerance);
        /* samples of a lone sun are 4 % noise, and a sum over 16^2 texels is no integral */
        assert_near(energy, 1.0,
                    method == FACET_BAKE_METHOD_SAMPLING ? 4e-3
                    : texels->size < 32                  ? 2e-3
                                                         : 1e-3);
    }
    facet_cube_destroy(c);
    facet_environment_destroy(e);
}

static void a_sun_becomes_the_lobe(void **state)
{
    (void)state;
    check_sun(FACET_LOBE_GGX, FACET_BAKE_METHOD_AUTO, 768, 5, 0.01, 5e-3); /* at a pole */
    if (IS_SLOW)
        return;
    check_sun(FACET_LOBE_GGX, FACET_BAKE_METHOD_AUTO, 200, 154, 0.01, 5e-3);
    check_sun(FACET_LOBE_GGX, FACET_BAKE_METHOD_SAMPLING, 200, 154, 0.2, 0.06);
    check_sun(FACET_LOBE_NONE, FACET_BAKE_METHOD_AUTO, 666, 505, 0.0, 0.0);
}

static void a_sun_becomes_the_ring_of_charlie(void **state)
{
    (void)state;
    /* harmonics round the outer edge of a ring off, where it falls to nothing within a texel or two */
    check_sun(FACET_LOBE_CHARLIE, FACET_BAKE_METHOD_AUTO, 200, 154, 0.2, 0.02);
}

/* ---- means over texels ---- */

/* For all sizes of source and target and any rotation, energy is kept and uniform radiance stays uniform. */
static void areas_keep_energy_at_any_size_and_rotation(void **state)
{
    (void)state;
    static const uint32_t sizes[5] = {1, 2, 4, 16, 64};
    static const uint32_t panoramas[4][2] = {{2, 1}, {7, 5}, {64, 32}, {333, 150}};
    for (int i = 0; i < 4; i++) {
        image panorama;
        assert_int_equal(image_create(NULL, panoramas[i][0], panoramas[i][1], 3, IMAGE_F32, &panorama, NULL),
                         FACET_OK);
        uint32_t random = 1;
        float *p = panorama.pixels;
        for (uint32_t k = 0; k < 3 * panoramas[i][0] * panoramas[i][1]; k++) {
            p[k] = (float)(lcg_next(&random) >> 20);
            p[k] = k % 97 == 0 ? 1e9f : k % 3 == 2 ? 5.0f : p[k]; /* suns, and blue that is nearly uniform */
        }
        double whole[3];
        assert_int_equal(equirect_mean(&panorama, NULL, 1, whole, NULL), FACET_OK);
        for (int k = 0; k < 5; k++)
            for (int turn = 0; turn < 3; turn++) {
                bake_area area;
                cube c;
                double mean[3];
                assert_int_equal(bake_area_create(&panorama, turn * 0.77, NULL, 1, &area, NULL), FACET_OK);
                assert_int_equal(cube_create(sizes[k], NULL, &c, NULL), FACET_OK);
                bake_area_fill(&area, false, 1.0f, 1, &c);
                cube_mean(&c, mean);
                for (int j = 0; j < 3; j++)
                    assert_near(mean[j] / whole[j], 1.0, 1e-6);
                cube_destroy(&c);
                bake_area_destroy(&area);
            }
        image_destroy(&panorama);
    }
}

/* ---- directions ---- */

static void smooth(const float d[3], float out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = 2.0f + sinf(3.0f * d[k]) * cosf(5.0f * d[(k + 1) % 3] + 1.0f);
}

/* A quarter turn moves light from face to face and changes nothing else. */
static void a_quarter_turn_moves_light_between_faces(void **state)
{
    (void)state;
    facet_environment *e = make_environment(256, 128, smooth);
    for (int lobe = 0; lobe <= FACET_LOBE_NONE; lobe++) {
        if (is_slow_ring(lobe, FACET_BAKE_METHOD_AUTO))
            continue;
        facet_bake_desc desc = {.lobe = (facet_lobe)lobe, .size = 32, .level_count = 3};
        facet_cube *straight = bake(e, desc);
        desc.rotation_rad = (float)(0.5 * pi);
        facet_cube *turned = bake(e, desc);
        for (uint32_t level = 0; level < 3; level++)
            for (uint32_t i = 0; i < texel_count(&turned->levels[level]); i++) {
                double d[3];
                texel_direction(&turned->levels[level], i, d);
                /* light turns from +Z to +X: the texel at +X has the value of the one at +Z */
                cube_point p = cube_locate((float)-d[2], (float)d[1], (float)d[0]);
                rgbx was = cube_fetch(&straight->levels[level], p);
                for (int k = 0; k < 3; k++)
                    assert_near(texel_of(&turned->levels[level], i)[k], was[k], 2e-4);
            }
        facet_cube_destroy(straight);
        facet_cube_destroy(turned);
    }
    facet_environment_destroy(e);
}

/* Texels on both sides of an edge are half a texel from it: they differ by no more than neighbours on a
 * face do. */
static void faces_are_seamless(void **state)
{
    (void)state;
    facet_environment *e = make_environment(256, 128, smooth);
    for (int lobe = 0; lobe < 2; lobe++)
        for (int method = 0; method < 2; method++) {
            if (is_slow_ring(lobe, method))
                continue;
            facet_cube *c = bake(e, (facet_bake_desc){.lobe = (facet_lobe)lobe,
                                                      .method = (facet_bake_method)method,
                                                      .size = 32,
                                                      .level_count = 3,
                                                      .samples = 256});
            for (uint32_t level = 0; level < 3; level++) {
                const cube *texels = &c->levels[level];
                int n = (int)texels->size;
                double inside = 0.0;
                double across = 0.0;
                for (uint32_t face = 0; face < 6; face++)
                    for (int y = 0; y < n; y++) {
                        for (int x = 0; x + 1 < n; x++)
                            for (int k = 0; k < 3; k++)
                                inside =
                                    fmax(inside, fabs((double)((*cube_texel(texels, face, x, y))[k] -
                                                               (*cube_texel(texels, face, x + 1, y))[k])));
                        for (int k = 0; k < 3; k++) /* borders are texels of the face across */
                            across = fmax(across, fabs((double)((*cube_texel(texels, face, 0, y))[k] -
                                                                (*cube_texel(texels, face, -1, y))[k])));
                    }
                assert_true(across < inside);
            }
            facet_cube_destroy(c);
        }
    facet_environment_destroy(e);
}

/* ---- source ---- */

/* A source that was a cube map is copied, or averaged with solid angles. */
static void cube_maps_are_copied_or_averaged(void **state)
{
    (void)state;
    facet_environment *e = make_environment(64, 32, smooth);
    assert_int_equal(cube_create(32, NULL, &e->faces, NULL), FACET_OK);
    for (uint32_t i = 0; i < texel_count(&e->faces); i++)
        for (int k = 0; k < 3; k++)
            ((float *)(uintptr_t)texel_of(&e->faces, i))[k] = (float)((i * 2654435761u) >> 16);
    double whole[3], mean[3];
    cube_mean(&e->faces, whole);
    facet_cube *c =
        bake(e, (facet_bake_desc){.lobe = FACET_LOBE_NONE, .size = 32, .level_count = 3, .ev = -1.0f});
    for (uint32_t i = 0; i < texel_count(&e->faces); i++)
        assert_near(texel_of(&c->levels[0], i)[1], 0.5 * (double)texel_of(&e->faces, i)[1], 0.0);
    for (uint32_t level = 0; level < 3; level++) {
        cube_mean(&c->levels[level], mean);
        assert_near(mean[0] / whole[0], 0.5, 1e-6);
    }
    facet_cube_destroy(c);
    c = bake(e, (facet_bake_desc){.lobe = FACET_LOBE_GGX, .size = 8, .level_count = 1});
    cube_mean(&c->levels[0], mean);
    assert_near(mean[0] / whole[0], 1.0, 1e-6);
    facet_cube_destroy(c);
    facet_environment_destroy(e);
}

static void clamped_light_is_reported(void **state)
{
    (void)state;
    double sun[3];
    facet_environment *e = make_sun(17, 256, sun);
    float *p = e->panorama.pixels;
    for (size_t i = 0; i < 3 * SUN_WIDTH * SUN_HEIGHT; i++)
        p[i] += 1.0f;
    double share = equirect_texel_solid_angle(SUN_WIDTH, SUN_HEIGHT, 256) / (4.0 * pi);
    facet_cube *c = bake(e, (facet_bake_desc){.size = 16, .level_count = 2, .clamp = 50.0f});
    double lost = share * (100001.0 - 50.0);
    assert_near(facet_cube_get_stats(c).clamped_share, lost / (1.0 + share * 1e5), 1e-6);
    for (uint32_t level = 0; level < 2; level++) {
        double mean[3];
        cube_mean(&c->levels[level], mean);
        assert_near(mean[2], 1.0 + share * 49.0, 1e-4);
    }
    facet_cube_destroy(c);
    c = bake(e, (facet_bake_desc){.size = 16, .level_count = 2, .clamp = 2e5f});
    assert_near(facet_cube_get_stats(c).clamped_share, 0.0, 0.0);
    facet_cube_destroy(c);
    facet_environment_destroy(e);
}

/* ---- runs ---- */

static void cube_maps_do_not_depend_on_threads(void **state)
{
    (void)state;
    facet_environment *e = make_environment(200, 100, smooth);
    for (int method = 0; method <= FACET_BAKE_METHOD_REFERENCE; method++)
        for (int lobe = 0; lobe < 2; lobe++) {
            if (is_slow_ring(lobe, method))
                continue;
            facet_bake_desc desc = {.lobe = (facet_lobe)lobe,
                                    .method = (facet_bake_method)method,
                                    .size = method == FACET_BAKE_METHOD_REFERENCE ? 8 : 32,
                                    .level_count = 3,
                                    .samples = 64,
                                    .thread_count = 1};
            facet_cube *one = bake(e, desc);
            for (desc.thread_count = 2; desc.thread_count <= 3; desc.thread_count++) {
                facet_cube *more = bake(e, desc);
                for (uint32_t level = 0; level < 3; level++)
                    for (uint32_t i = 0; i < texel_count(&one->levels[level]); i++)
                        assert_memory_equal(texel_of(&one->levels[level], i),
                                            texel_of(&more->levels[level], i), 3 * sizeof(float));
                facet_cube_destroy(more);
            }
            facet_cube_destroy(one);
        }
    facet_environment_destroy(e);
}

typedef struct patience {
    int left;
    double last;
} patience;

static bool report(void *user, const char *stage, double fraction)
{
    patience *p = user;
    assert_string_equal(stage, "bake");
    assert_true(fraction >= p->last && fraction <= 1.0);
    p->last = fraction;
    return p->left-- > 0;
}

static void baking_can_be_cancelled(void **state)
{
    (void)state;
    facet_environment *e = make_environment(64, 32, smooth);
    for (int method = 0; method <= FACET_BAKE_METHOD_REFERENCE; method++)
        for (int left = 0; left < 1000; left = 3 * left + 1) {
            failing_allocator f = {.fail_at = -1};
            patience p = {.left = left};
            facet_cube *c = NULL;
            facet_error error;
            facet_result result = facet_cube_bake(e,
                                                  &(facet_bake_desc){.allocator = failing_allocator_get(&f),
                                                                     .progress = {&p, report},
                                                                     .method = (facet_bake_method)method,
                                                                     .size = 16,
                                                                     .level_count = 3,
                                                                     .samples = 64},
                                                  &c, &error);
            if (result != FACET_OK) {
                assert_int_equal(result, FACET_ERROR_CANCELLED);
                assert_null(c);
            } else {
                assert_true(p.left >= 0);
                assert_near(p.last, 1.0, 0.02);
                left = 1000;
            }
            facet_cube_destroy(c);
            assert_int_equal(atomic_load(&f.blocks), 0);
        }
    facet_environment_destroy(e);
}

/* Each failing allocation gives FACET_ERROR_MEMORY, and nothing leaks. */
static void running_out_of_memory_leaks_nothing(void **state)
{
    (void)state;
    facet_environment *e = make_environment(64, 32, smooth);
    for (int method = 0; method <= FACET_BAKE_METHOD_REFERENCE; method++)
        for (long fail_at = 0;; fail_at = next_failure(fail_at)) {
            failing_allocator f = {.fail_at = fail_at};
            facet_bake_desc desc = {.allocator = failing_allocator_get(&f),
                                    .thread_count = 1,
                                    .method = (facet_bake_method)method,
                                    .size = 8,
                                    .level_count = 3,
                                    .samples = 16,
                                    .clamp = 2.0f};
            facet_cube *c = NULL;
            facet_cube_error errors[3];
            facet_error error;
            facet_result result = facet_cube_bake(e, &desc, &c, &error);
            if (result == FACET_OK && method == 0)
                result = facet_cube_verify(c, e, &desc, errors, &error);
            if (result != FACET_OK)
                assert_int_equal(result, FACET_ERROR_MEMORY);
            facet_cube_destroy(c);
            assert_int_equal(atomic_load(&f.blocks), 0);
            if (result == FACET_OK) {
                print_message("method %d: %ld allocations\n", method, fail_at);
                assert_true(fail_at > 5);
                break;
            }
        }
    facet_environment_destroy(e);
}

static void invalid_arguments_are_refused(void **state)
{
    (void)state;
    static const facet_bake_desc bad[] = {{.size = 100},
                                          {.size = 16384},
                                          {.size = 16, .level_count = 6},
                                          {.lobe = (facet_lobe)4},
                                          {.method = (facet_bake_method)3},
                                          {.mapping = (facet_roughness_mapping)2},
                                          {.clamp = -1.0f},
                                          {.ev = INFINITY},
                                          {.rotation_rad = NAN},
                                          {.samples = 1u << 30}};
    facet_environment *e = make_environment(4, 2, smooth);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        facet_cube *c = NULL;
        facet_error error;
        assert_int_equal(facet_cube_bake(e, &bad[i], &c, &error), FACET_ERROR_ARGUMENT);
        assert_null(c);
        assert_true(strncmp(error.message, "bake: ", 6) == 0);
    }
    facet_cube *c = bake(e, (facet_bake_desc){.size = 0});
    assert_int_equal(facet_cube_get_level_count(c), 5);
    assert_int_equal(facet_cube_get_size(c, 4), 16);
    facet_cube_destroy(c);
    c = bake(e, (facet_bake_desc){.size = 64, .level_count = 4, .mapping = FACET_ROUGHNESS_MAPPING_FILAMENT});
    for (uint32_t k = 0; k < 4; k++) { /* k = (n - 1) r (2 - r) */
        double r = (double)facet_cube_get_roughness(c, k);
        assert_near(3.0 * r * (2.0 - r), k, 1e-6);
    }
    facet_cube_destroy(c);
    facet_environment_destroy(e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(uniform_light_stays_uniform),
        cmocka_unit_test(bands_of_harmonics_are_scaled),
        cmocka_unit_test(irradiance_is_that_of_the_clamped_cosine),
        cmocka_unit_test(a_sun_becomes_the_lobe),
        cmocka_unit_test(a_sun_becomes_the_ring_of_charlie),
        cmocka_unit_test(areas_keep_energy_at_any_size_and_rotation),
        cmocka_unit_test(a_quarter_turn_moves_light_between_faces),
        cmocka_unit_test(faces_are_seamless),
        cmocka_unit_test(cube_maps_are_copied_or_averaged),
        cmocka_unit_test(clamped_light_is_reported),
        cmocka_unit_test(cube_maps_do_not_depend_on_threads),
        cmocka_unit_test(baking_can_be_cancelled),
        cmocka_unit_test(running_out_of_memory_leaks_nothing),
        cmocka_unit_test(invalid_arguments_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
