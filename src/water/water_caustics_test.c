/* water_caustics_test.c - sunlight on the bed: a sine against its analytic irradiance and focus, still
 * water, means under seas and low suns, threads; the maps of images, and where there is none. */
#include <stdlib.h>
#include <string.h>

#include "water/water_fixture.h"

#include "tests/support/support.h"
#include "ocean/sea.h"
#include "water/water_caustics.h"
#include "water/water_trace.h"

static const float X_AXIS[2] = {1.0f, 0.0f};

static void expect_about(double found, double expected, double bound, const char *what)
{
    if (!(fabs(found - expected) <= bound))
        fail_msg("%s: %g, expected %g within %g", what, found, expected, bound);
}

/* ---- one sine ---- */

enum { SINE_SIZE = 256, SINE_LEVELS = 9 };
static const double SINE_LENGTH_M = 8.0, SINE_WAVES = 4.0;

/* Heights a cos kx in one tile, without displacement. */
typedef struct sine {
    waves waves;
    float *texels[SINE_LEVELS];
    double k, a;
} sine;

static void make_sine(sine *s, double amplitude_m)
{
    memset(s, 0, sizeof *s);
    s->a = amplitude_m;
    s->k = 2.0 * 3.14159265358979 * SINE_WAVES / SINE_LENGTH_M;
    wave_tile *t = &s->waves.tiles[0];
    s->waves.tile_count = 1;
    *t = (wave_tile){.length_m = SINE_LENGTH_M,
                     .size = SINE_SIZE,
                     .level_count = SINE_LEVELS,
                     .samples_per_m = SINE_SIZE / SINE_LENGTH_M,
                     .cos_per_m = SINE_SIZE / SINE_LENGTH_M,
                     .cos_turn = 1.0f};
    for (uint32_t l = 0; l < SINE_LEVELS; l++) {
        size_t edge = SINE_SIZE >> l;
        t->levels[l] = s->texels[l] = calloc(edge * edge * WAVE_FIELDS, sizeof(float));
        assert_non_null(s->texels[l]);
        for (size_t i = 0; i < edge * edge * WAVE_FIELDS; i++) {
            size_t field = i % WAVE_FIELDS, x = i / WAVE_FIELDS % edge, z = i / WAVE_FIELDS / edge;
            const float *from =
                l ? s->texels[l - 1] + (4 * z * edge + 2 * x) * WAVE_FIELDS + field : s->texels[0];
            double kx = s->k * (double)x / t->samples_per_m;
            if (l)
                s->texels[l][i] = 0.25f * (from[0] + from[WAVE_FIELDS] + from[2 * edge * WAVE_FIELDS] +
                                           from[(2 * edge + 1) * WAVE_FIELDS]);
            else if (field == WAVE_ETA)
                s->texels[l][i] = (float)(s->a * cos(kx));
            else if (field == WAVE_ETA_X)
                s->texels[l][i] = (float)(-s->a * s->k * sin(kx));
        }
    }
}

static void free_sine(sine *s)
{
    for (uint32_t l = 0; l < SINE_LEVELS; l++)
        free(s->texels[l]);
}

static Water clear_water(void)
{
    return (Water){.ior = 1.34f};
}

/* Layers of that finest texel around the origin; the sun's disc blurs them by a texel. */
static void fill_plain(const waves *w, vec3 L, double depth_m, float texel_m, float margin_m,
                       uint32_t threads, caustic_map *map)
{
    caustic_source source = {
        .waves = w, .water = clear_water(), .L = L, .bed_height = -depth_m, .thread_count = threads};
    caustic_plan plans[CAUSTIC_LAYERS];
    for (uint32_t l = 0; l < CAUSTIC_LAYERS; l++, texel_m *= CAUSTIC_WIDER)
        plans[l] = (caustic_plan){.texel_m = texel_m, .sigma_m = {texel_m, texel_m}, .margin_m = margin_m};
    assert_int_equal(water_caustics_fill(&source, X_AXIS, plans, map, NULL), FACET_OK);
    assert_true(map->is_there);
}

/* Before the focus, where rays are still in order, light at x + h (n - 1) / n eta_x is 1 / (1 - C cos kx),
 * C = h a k^2 (n - 1) / n. */
static void a_sine_wave_has_the_closed_form(void **state)
{
    (void)state;
    const double n = 1.34, a = 0.005, depth = 12.0;
    sine s;
    make_sine(&s, a);
    caustic_map map;
    fill_plain(&s.waves, vec3(0.0f, 1.0f, 0.0f), depth, 1.0f / 64.0f, 0.5f, 2, &map);
    double C = depth * a * s.k * s.k * (n - 1.0) / n, worst = 0.0;
    assert_true(C > 0.1 && C < 0.3);
    for (int i = 0; i < 100; i++) {
        double x = -2.0 + 0.04 * i, on_bed = x - C / s.k * sin(s.k * x);
        double expected = 1.0 / (1.0 - C * cos(s.k * x));
        double found = (double)caustic_map_at(&map, on_bed, 0.3, 0.0f);
        worst = fmax(worst, fabs(found / expected - 1.0));
    }
    expect_about(worst, 0.0, 0.01, "worst of 100 places");
    caustic_map_destroy(&map);
    free_sine(&s);
}

/* Light below a crest: 1 / |1 - C cos kx| of each x with kx = C sin kx, which are one before the focus and
 * three behind it. */
static double below_crest(double C)
{
    double sum = 1.0 / fabs(1.0 - C), low = 0.0, high = 3.14159265;
    if (C <= 1.0)
        return sum;
    for (int i = 0; i < 60; i++) {
        double middle = 0.5 * (low + high);
        if (middle < C * sin(middle))
            low = middle;
        else
            high = middle;
    }
    return sum + 2.0 / fabs(1.0 - C * cos(low));
}

/* Crests focus at the depth n / ((n - 1) a k^2), where C is 1: light below them is brightest there. */
static void crests_focus_at_the_computed_depth(void **state)
{
    (void)state;
    const double n = 1.34, a = 0.005;
    static const double parts[4] = {1.0, 0.5, 0.8, 1.4};
    double brightest = 0.0;
    sine s;
    make_sine(&s, a);
    double focus = n / ((n - 1.0) * a * s.k * s.k);
    for (int i = 0; i < 4; i++) {
        caustic_map map;
        fill_plain(&s.waves, vec3(0.0f, 1.0f, 0.0f), parts[i] * focus, 1.0f / 256.0f, 0.6f, 2, &map);
        double found = (double)caustic_map_at(&map, 0.0, 0.0, 0.0f);
        if (i == 0)
            brightest = found;
        else
            expect_about(found / below_crest(parts[i]), 1.0, 0.02, "below a crest");
        assert_true(i == 0 || brightest > 2.0 * found);
        caustic_map_destroy(&map);
    }
    free_sine(&s);
}

/* ---- conservation ---- */

static double mean_of(const caustic_layer *l)
{
    return (double)l->mips[CAUSTIC_MIPS - 1][0];
}

static void still_water_has_a_factor_of_one(void **state)
{
    (void)state;
    waves still = {.tile_count = 0};
    caustic_map map;
    fill_plain(&still, normalize(vec3(0.6f, 0.5f, -0.3f)), 7.0, 0.05f, 0.5f, 2, &map);
    for (uint32_t l = 0; l < CAUSTIC_LAYERS; l++)
        for (size_t i = 0; i < (size_t)CAUSTIC_SIZE * CAUSTIC_SIZE; i++)
            if (fabsf(map.layers[l].mips[0][i] - 1.0f) > 5e-5f) /* places are rounded to 3e-5 texels */
                fail_msg("layer %u, texel %zu: %g", l, i, (double)map.layers[l].mips[0][i]);
    caustic_map_destroy(&map);
}

static facet_sea_desc lagoon(void)
{
    facet_sea_desc d;
    assert_int_equal(sea_preset("lagoon", &d, NULL), FACET_OK);
    d.resolution = 128;
    return d;
}

/* Over a wide map none is lost, at all heights of the sun; it is bright and dark there. Threads make no
 * difference. */
static void wide_maps_conserve_light(void **state)
{
    (void)state;
    facet_sea_desc d = lagoon();
    facet_sea *sea = make_sea(&d);
    static const float heights[] = {1.55f, 0.7f, 0.2f};
    for (uint32_t i = 0; i < 3; i++) {
        float e = heights[i];
        caustic_map map;
        fill_plain(&sea->waves, vec3(cos(e), sin(e), 0.0f), 3.0, 0.05f, 2.0f, 1 + i, &map);
        const caustic_layer *widest = &map.layers[CAUSTIC_LAYERS - 1];
        expect_about(mean_of(widest), 1.0, 1e-3, "mean");
        float least = INFINITY, most = 0.0f;
        for (size_t k = 0; k < (size_t)CAUSTIC_SIZE * CAUSTIC_SIZE; k++) {
            least = fminf(least, map.layers[0].mips[0][k]);
            most = fmaxf(most, map.layers[0].mips[0][k]);
        }
        assert_true(least >= 0.0f && least < 0.5f && most > 3.0f && most < 1e4f);
        caustic_map_destroy(&map);
    }
    caustic_map one;
    fill_plain(&sea->waves, vec3(0.6f, 0.8f, 0.0f), 3.0, 0.02f, 1.0f, 1, &one);
    for (uint32_t threads = IS_SLOW ? 4 : 2; threads <= 4; threads++) {
        caustic_map other;
        fill_plain(&sea->waves, vec3(0.6f, 0.8f, 0.0f), 3.0, 0.02f, 1.0f, threads, &other);
        for (uint32_t l = 0; l < CAUSTIC_LAYERS; l++)
            assert_memory_equal(one.layers[l].mips[0], other.layers[l].mips[0],
                                (size_t)CAUSTIC_SIZE * CAUSTIC_SIZE * sizeof(float));
        caustic_map_destroy(&other);
    }
    caustic_map_destroy(&one);
    sea_destroy(sea);
}

/* ---- images ---- */

/* By three colors and a sun, which take less time than a sky does. */
static void light_by_environment(shot *s, float elevation_rad)
{
    static const float zenith[3] = {1000.0f, 2000.0f, 4000.0f}, horizon[3] = {5000.0f, 5500.0f, 6000.0f};
    static const float nadir[3] = {100.0f, 100.0f, 100.0f};
    facet_render_desc *r = &s->desc;
    assert_int_equal(facet_environment_create_gradient(zenith, horizon, nadir, NULL, &r->environment, NULL),
                     FACET_OK);
    r->sun = (facet_sun){
        .azimuth_rad = 1.0f, .elevation_rad = elevation_rad, .illuminance_lux = {1e5f, 9e4f, 8e4f}};
    s->desc.sea_shading.omits_glints = s->desc.sea_shading.omits_foam = true;
}

/* Sums over all pixels, per channel. */
static void sum_shot(const shot *s, double sums[3])
{
    for (int k = 0; k < 3; k++)
        sums[k] = 0.0;
    for (uint32_t i = 0; i < s->film.width * s->film.height; i++)
        for (int k = 0; k < 3; k++)
            sums[k] += (double)s->film.layers[0].pixels[4 * i + (uint32_t)k];
}

/* Waves move light on the bed, and neither add nor take any. */
static void waves_conserve_light_on_the_bed(void **state)
{
    (void)state;
    facet_sea_desc d = lagoon();
    facet_sea *sea = make_sea(&d);
    shot s;
    make_shot(&s, 120, 120, 20.0f, 1.5707f);
    light_by_environment(&s, 0.9f);
    double with[3], without[3], apart = 0.0;
    draw_shot(sea, &s);
    sum_shot(&s, with);
    float *pixels = malloc((size_t)120 * 120 * 4 * sizeof(float));
    assert_non_null(pixels);
    memcpy(pixels, s.film.layers[0].pixels, (size_t)120 * 120 * 4 * sizeof(float));
    s.desc.sea_shading.omits_caustics = true;
    draw_shot(sea, &s);
    sum_shot(&s, without);
    for (size_t i = 1; i < (size_t)120 * 120 * 4; i += 4)
        apart += fabs((double)(pixels[i] - s.film.layers[0].pixels[i]));
    for (int k = 0; k < 3; k++)
        expect_about(with[k] / without[k], 1.0, 0.005, "mean of a channel");
    assert_true(apart > 0.03 * without[1]); /* and they are seen */
    free(pixels);
    facet_environment_destroy(s.desc.environment);
    film_destroy(&s.film);
    sea_destroy(sea);
}

/* Whether an image of a sea has a map, which must be finite. The sun of an environment stands for the
 * sky's. */
static bool has_map(const facet_sea_desc *d, float elevation_rad, float eye_m, float down_rad)
{
    facet_sea *sea = make_sea(d);
    shot s;
    make_shot(&s, 24, 16, eye_m, down_rad);
    light_by_environment(&s, elevation_rad);
    s.desc.camera = &s.camera;
    water_setup setup;
    facet_error error;
    if (water_setup_create(shot_in(sea, &s), NULL, &s.desc, WATER_SETUP_ALL, &setup, &s.stats, &error) !=
        FACET_OK)
        fail_msg("%s", error.message);
    bool is_there = setup.caustics.is_there;
    for (uint32_t l = 0; is_there && l < CAUSTIC_LAYERS; l++)
        for (size_t i = 0; i < (size_t)CAUSTIC_SIZE * CAUSTIC_SIZE; i += 7)
            assert_true(setup.caustics.layers[l].mips[0][i] >= 0.0f &&
                        isfinite(setup.caustics.layers[l].mips[0][i]));
    assert_true(is_there || caustic_map_at(&setup.caustics, 1.0, 2.0, 0.1f) == 1.0f);
    static const float middle[2] = {0.5f, 0.5f};
    for (uint32_t i = 0; i < 24 * 16; i++) {
        const water_pixel pixel = {.x = i % 24, .y = i / 24, .count = 1, .pattern = middle};
        vec3 L = water_pixel_trace(&setup, &pixel);
        assert_true(L[0] >= 0.0f && L[1] >= 0.0f && L[2] >= 0.0f && isfinite(L[0] + L[1] + L[2]));
    }
    water_setup_destroy(&setup);
    water_cache_clear(&s.cache);
    facet_environment_destroy(s.desc.environment);
    sea_destroy(sea);
    return is_there;
}

/* Where there is nothing to see, nothing is made. */
static void invisible_caustics_are_not_made(void **state)
{
    (void)state;
    facet_sea_desc d = lagoon();
    d.resolution = 32;
    assert_false(has_map(&d, -0.1f, 3.0f, 0.3f)); /* night */
    d.wind_mps = 0.0f;
    assert_false(has_map(&d, 0.8f, 3.0f, 0.3f));
    d.wind_mps = 4.0f;
    d.bed.depth_m = 0.0f;
    assert_false(has_map(&d, 0.8f, 3.0f, 0.3f));
    d.bed.depth_m = 400.0f; /* dark */
    assert_false(has_map(&d, 0.8f, 3.0f, 0.3f));
}

static void extreme_views_and_beds_are_finite(void **state)
{
    (void)state;
    facet_sea_desc d = lagoon();
    d.resolution = 32;
    assert_true(has_map(&d, 0.8f, -1.0f, -0.5f)); /* from below, and looking up */
    assert_true(has_map(&d, 0.002f, 3.0f, 0.3f)); /* the sun on the horizon */
    d.bed.depth_m = 0.003f;
    assert_true(has_map(&d, 0.8f, 3.0f, 0.3f));
    d.bed = (facet_sea_bed){.depth_m = 2.0f, .slope = 1.0f, .albedo = {0.5f, 0.5f, 0.5f}};
    assert_true(has_map(&d, 1.2f, 3.0f, 0.3f));
    d.bed = (facet_sea_bed){.depth_m = 20.0f, .albedo = {0.5f, 0.5f, 0.5f}};
    d.wind_mps = 25.0f;
    d.fetch_m = INFINITY;
    assert_true(has_map(&d, 0.8f, 10.0f, 0.3f));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sine_wave_has_the_closed_form),
        cmocka_unit_test(crests_focus_at_the_computed_depth),
        cmocka_unit_test(still_water_has_a_factor_of_one),
        cmocka_unit_test(wide_maps_conserve_light),
        cmocka_unit_test(waves_conserve_light_on_the_bed),
        cmocka_unit_test(invisible_caustics_are_not_made),
        cmocka_unit_test(extreme_views_and_beds_are_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
