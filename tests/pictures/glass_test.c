/* glass_test.c - the Compare* models of Khronos' sample assets about transmitted light: alpha, transmission,
 * volume, index of refraction, dispersion. As in compare_test.c. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "picture.h"

static facet_environment *white; /* radiance 1 from everywhere */

static int create_environments(void **state)
{
    (void)state;
    return facet_environment_create_constant((float[3]){1, 1, 1}, NULL, &white, NULL) != FACET_OK;
}

static int destroy_environments(void **state)
{
    (void)state;
    facet_environment_destroy(white);
    return 0;
}

static picture take(const char *path, float x, const char *text, const char *by, facet_environment *light)
{
    facet_render_desc desc = {.environment = light, .samples = 16};
    picture p = picture_of_sphere(path, x, &desc, text, by);
    if (p.count == 0)
        skip();
    return p;
}

/* Alpha fades the whole surface, reflections included; transmission replaces diffuse light only, so that
 * fully transmissive glass keeps its highlights. */
static void glass_keeps_its_reflections(void **state)
{
    (void)state;
    const char *model = "materials/CompareTransmission.glb";
    picture faded = take(model, -0.55f, NULL, NULL, NULL), glass = take(model, 0.55f, NULL, NULL, NULL);
    assert_true(picture_percentile(&glass, 3, 0.99) > 2.0 * picture_percentile(&faded, 1, 0.99));
    assert_true(picture_detail(&glass, 3) > 2.0 * picture_detail(&faded, 1));
    double middle[2] = {picture_percentile(&glass, 3, 0.5), picture_percentile(&faded, 1, 0.5)};
    assert_float_equal((float)(middle[0] / middle[1]), 1.0f,
                       0.2f); /* the same wall is visible through both */
    picture_destroy(&faded);
    picture_destroy(&glass);
}

/* Transmittance is c^(x / d) per channel over a path length x (Beer-Lambert): green is not absorbed where
 * c is (0.15, 1, 0.5), and red is absorbed most. Small losses of two channels are proportional to their
 * logarithms for any mix of path lengths in a pixel. Glass without a volume, the other half, is as
 * colorless as its environment. */
static void a_volume_absorbs_by_beer_and_lambert(void **state)
{
    (void)state;
    const char *model = "materials/CompareVolume.glb", *color = "\"attenuationColor\":[0.15,1,0.5]";
    picture thin = take(model, -0.55f, NULL, NULL, white), green = take(model, 0.55f, NULL, NULL, white),
            clear = take(model, 0.55f, color, "\"attenuationColor\":[1,1,1]", white),
            faint = take(model, 0.55f, color, "\"attenuationColor\":[0.98,1,0.995]", white);
    assert_true(picture_mean_chroma(&thin, 1) < 0.02);
    assert_true(picture_mean(&green, 3, 1) > 1.5 * picture_mean(&green, 3, 0));
    assert_true(picture_mean(&green, 3, 2) > 1.1 * picture_mean(&green, 3, 0));
    double red = 0.0, blue = 0.0, count = 0.0;
    for (uint32_t i = 0; i < green.count; i++) {
        const float *g = green.rgba + 4 * i, *c = clear.rgba + 4 * i, *f = faint.rgba + 4 * i;
        if (green.material[i] != 3 || clear.material[i] != 3)
            continue;
        assert_float_equal(g[1], c[1], 0.002f * c[1] + 1e-5f);
        assert_true(g[0] <= c[0] && g[2] <= c[2]);
        red += 1.0 - (double)f[0] / (double)c[0];
        blue += 1.0 - (double)f[2] / (double)c[2];
        count++;
    }
    print_message("volume: red loses %.3f, blue %.3f of that\n", red / count, blue / red);
    assert_true(count > 1000.0 && red / count > 0.01);
    assert_float_equal((float)(blue / red), (float)(log(0.995) / log(0.98)), 0.01f);
    picture_destroy(&thin);
    picture_destroy(&green);
    picture_destroy(&clear);
    picture_destroy(&faint);
}

/* A gem disperses a gray environment into all hues; without dispersion there are none. The total light is the
 * same. */
static void dispersion_splits_colors(void **state)
{
    (void)state;
    const char *model = "materials/CompareDispersion.glb", *five = "\"dispersion\":5";
    picture plain = take(model, -0.55f, NULL, NULL, NULL), fire = take(model, 0.55f, NULL, NULL, NULL),
            off = take(model, 0.55f, five, "\"dispersion\":0", NULL),
            little = take(model, 0.55f, five, "\"dispersion\":0.5", NULL);
    double chroma[4] = {picture_mean_chroma(&plain, 1), picture_mean_chroma(&fire, 2),
                        picture_mean_chroma(&off, 2), picture_mean_chroma(&little, 2)};
    print_message("dispersion: chroma %.3f; %.3f without, %.3f with a tenth\n", chroma[1], chroma[2],
                  chroma[3]);
    assert_true(chroma[0] < 0.01 && chroma[2] < 0.01);
    assert_true(chroma[1] > 0.2 && chroma[3] > 0.03 && chroma[3] < 0.7 * chroma[1]);
    assert_true(picture_hues(&fire, 2) >= 8 && picture_hues(&plain, 1) == 0);
    double total = picture_mean_luminance(&fire, 2) / picture_mean_luminance(&off, 2);
    assert_float_equal((float)total, 1.0f, 0.1f);
    picture_destroy(&plain);
    picture_destroy(&fire);
    picture_destroy(&off);
    picture_destroy(&little);
}

/* A larger index reflects more: F0 is 0.04 for 1.5, 0.17 for diamond's 2.42; and it refracts more, so that
 * the object gathers light from all around. */
static void a_larger_index_reflects_and_bends_more(void **state)
{
    (void)state;
    const char *model = "materials/CompareIor.glb", *diamond = "\"ior\":2.42";
    picture thin = take(model, -0.55f, NULL, NULL, NULL), body = take(model, 0.55f, NULL, NULL, NULL),
            glass = take(model, 0.55f, diamond, "\"ior\":1.5", NULL);
    double peaks[3] = {picture_percentile(&thin, 0, 0.99), picture_percentile(&glass, 1, 0.99),
                       picture_percentile(&body, 1, 0.99)};
    assert_true(peaks[2] > 1.4 * peaks[1] && peaks[1] > peaks[0]);
    assert_true(picture_mean_luminance(&body, 1) > 1.4 * picture_mean_luminance(&glass, 1));
    assert_true(picture_distance(&glass, &body) > 0.3);
    picture_destroy(&thin);
    picture_destroy(&body);
    picture_destroy(&glass);
}

/* Fur in three alpha modes: opaque shows the hidden texels, which are red; mask cuts them off; blend shows
 * the floor through nearly transparent ones, so that the fur's edges are softer than the mask's. */
static void alpha_covers_by_its_mode(void **state)
{
    (void)state;
    const char *model = "materials/CompareAlphaCoverage.glb";
    facet_scene *scene = model_load(model);
    if (!scene)
        skip();
    float low[3], high[3];
    assert_true(facet_scene_get_bounds(scene, NULL, low, high));
    float x = (high[0] - low[0]) / 2.0f - 0.5f;
    facet_scene_destroy(scene);
    picture opaque = take(model, -x, NULL, NULL, white), mask = take(model, 0, NULL, NULL, white),
            blend = take(model, x, NULL, NULL, white);
    double red[3] = {picture_mean(&opaque, -1, 0) / picture_mean(&opaque, -1, 1),
                     picture_mean(&mask, -1, 0) / picture_mean(&mask, -1, 1),
                     picture_mean(&blend, -1, 0) / picture_mean(&blend, -1, 1)};
    print_message("alpha: red over green %.2f opaque, %.2f mask, %.2f blend\n", red[0], red[1], red[2]);
    assert_true(red[0] > 1.5 * red[1]);
    assert_float_equal((float)red[1], (float)red[2], 0.15f);
    assert_true(picture_distance(&mask, &blend) > 0.02);
    for (uint32_t i = 0; i < mask.count; i++) /* the floor is opaque: no hole through both */
        assert_true(mask.material[i] < 0 || mask.rgba[4 * i + 3] > 0.2f);
    picture_destroy(&opaque);
    picture_destroy(&mask);
    picture_destroy(&blend);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(glass_keeps_its_reflections),
        cmocka_unit_test(a_volume_absorbs_by_beer_and_lambert),
        cmocka_unit_test(dispersion_splits_colors),
        cmocka_unit_test(a_larger_index_reflects_and_bends_more),
        cmocka_unit_test(alpha_covers_by_its_mode),
    };
    return cmocka_run_group_tests(tests, create_environments, destroy_environments);
}
