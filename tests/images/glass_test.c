/* glass_test.c - the Compare* models of Khronos' sample assets that transmit light: alpha, transmission,
 * volume, index of refraction, dispersion. See compare_test.c for the method. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "model_image.h"

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

static model_image render_sphere(const char *path, float x, const char *text, const char *by,
                                 facet_environment *light)
{
    facet_render_desc desc = {
        .environment = light, .background = FACET_BACKGROUND_ENVIRONMENT, .samples = 16};
    model_image p = model_image_of_sphere(path, x, &desc, text, by);
    if (p.count == 0)
        skip();
    return p;
}

/* Alpha fades the whole surface, reflections included; transmission replaces diffuse light only, so that
 * fully transmissive glass keeps its highlights. */
static void transmissive_glass_keeps_its_highlights(void **state)
{
    (void)state;
    const char *model = "materials/CompareTransmission.glb";
    model_image faded = render_sphere(model, -0.55f, NULL, NULL, NULL),
                glass = render_sphere(model, 0.55f, NULL, NULL, NULL);
    assert_true(model_image_percentile(&glass, 3, 0.99) > 1.7 * model_image_percentile(&faded, 1, 0.99));
    assert_true(model_image_detail(&glass, 3) > 2.0 * model_image_detail(&faded, 1));
    double middle[2] = {model_image_percentile(&glass, 3, 0.5), model_image_percentile(&faded, 1, 0.5)};
    assert_float_equal((float)(middle[0] / middle[1]), 1.0f,
                       0.2f); /* the same wall is visible through both */
    model_image_destroy(&faded);
    model_image_destroy(&glass);
}

/* Transmittance is c^(x / d) per channel over a path length x (Beer-Lambert): green is not absorbed where
 * c is (0.15, 1, 0.5), and red is absorbed most. Small losses of two channels are proportional to their
 * logarithms for any mix of path lengths in a pixel. Glass without a volume, the other half, is as
 * colorless as its environment. */
static void volumes_absorb_by_beer_lambert(void **state)
{
    (void)state;
    const char *model = "materials/CompareVolume.glb", *color = "\"attenuationColor\":[0.15,1,0.5]";
    model_image thin = render_sphere(model, -0.55f, NULL, NULL, white),
                green = render_sphere(model, 0.55f, NULL, NULL, white),
                clear = render_sphere(model, 0.55f, color, "\"attenuationColor\":[1,1,1]", white),
                faint = render_sphere(model, 0.55f, color, "\"attenuationColor\":[0.98,1,0.995]", white);
    assert_true(model_image_mean_chroma(&thin, 1) < 0.02);
    assert_true(model_image_mean(&green, 3, 1) > 1.5 * model_image_mean(&green, 3, 0));
    assert_true(model_image_mean(&green, 3, 2) > 1.1 * model_image_mean(&green, 3, 0));
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
    model_image_destroy(&thin);
    model_image_destroy(&green);
    model_image_destroy(&clear);
    model_image_destroy(&faint);
}

/* A gem disperses a gray environment into all hues; without dispersion there are none. The total light is the
 * same. */
static void dispersion_splits_gray_light_into_hues(void **state)
{
    (void)state;
    const char *model = "materials/CompareDispersion.glb", *five = "\"dispersion\":5";
    model_image plain = render_sphere(model, -0.55f, NULL, NULL, NULL),
                fire = render_sphere(model, 0.55f, NULL, NULL, NULL),
                off = render_sphere(model, 0.55f, five, "\"dispersion\":0", NULL),
                little = render_sphere(model, 0.55f, five, "\"dispersion\":0.5", NULL);
    double chroma[4] = {model_image_mean_chroma(&plain, 1), model_image_mean_chroma(&fire, 2),
                        model_image_mean_chroma(&off, 2), model_image_mean_chroma(&little, 2)};
    print_message("dispersion: chroma %.3f; %.3f without, %.3f with a tenth\n", chroma[1], chroma[2],
                  chroma[3]);
    assert_true(chroma[0] < 0.01 && chroma[2] < 0.01);
    assert_true(chroma[1] > 0.2 && chroma[3] > 0.03 && chroma[3] < 0.7 * chroma[1]);
    assert_true(model_image_hues(&fire, 2) >= 8 && model_image_hues(&plain, 1) == 0);
    double total = model_image_mean_luminance(&fire, 2) / model_image_mean_luminance(&off, 2);
    assert_float_equal((float)total, 1.0f, 0.1f);
    model_image_destroy(&plain);
    model_image_destroy(&fire);
    model_image_destroy(&off);
    model_image_destroy(&little);
}

/* A larger index reflects more: F0 is 0.04 for 1.5, 0.17 for diamond's 2.42; and it refracts more, so that
 * the object gathers light from all around. */
static void a_larger_index_reflects_and_refracts_more(void **state)
{
    (void)state;
    const char *model = "materials/CompareIor.glb", *diamond = "\"ior\":2.42";
    model_image thin = render_sphere(model, -0.55f, NULL, NULL, NULL),
                body = render_sphere(model, 0.55f, NULL, NULL, NULL),
                glass = render_sphere(model, 0.55f, diamond, "\"ior\":1.5", NULL);
    double peaks[3] = {model_image_percentile(&thin, 0, 0.99), model_image_percentile(&glass, 1, 0.99),
                       model_image_percentile(&body, 1, 0.99)};
    assert_true(peaks[2] > 1.4 * peaks[1] && peaks[1] > peaks[0]);
    assert_true(model_image_mean_luminance(&body, 1) > 1.4 * model_image_mean_luminance(&glass, 1));
    assert_true(model_image_distance(&glass, &body) > 0.3);
    model_image_destroy(&thin);
    model_image_destroy(&body);
    model_image_destroy(&glass);
}

/* Fur in three alpha modes: opaque shows the hidden texels, which are red; mask cuts them off; blend shows
 * the floor through nearly transparent ones, so that the fur's edges are softer than the mask's. */
static void alpha_modes_cover_differently(void **state)
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
    model_image opaque = render_sphere(model, -x, NULL, NULL, white),
                mask = render_sphere(model, 0, NULL, NULL, white),
                blend = render_sphere(model, x, NULL, NULL, white);
    double red[3] = {model_image_mean(&opaque, -1, 0) / model_image_mean(&opaque, -1, 1),
                     model_image_mean(&mask, -1, 0) / model_image_mean(&mask, -1, 1),
                     model_image_mean(&blend, -1, 0) / model_image_mean(&blend, -1, 1)};
    print_message("alpha: red over green %.2f opaque, %.2f mask, %.2f blend\n", red[0], red[1], red[2]);
    assert_true(red[0] > 1.5 * red[1]);
    assert_float_equal((float)red[1], (float)red[2], 0.15f);
    assert_true(model_image_distance(&mask, &blend) > 0.02);
    for (uint32_t i = 0; i < mask.count; i++) /* the floor is opaque: no hole through both */
        assert_true(mask.material[i] < 0 || mask.rgba[4 * i + 3] > 0.2f);
    model_image_destroy(&opaque);
    model_image_destroy(&mask);
    model_image_destroy(&blend);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(transmissive_glass_keeps_its_highlights),
        cmocka_unit_test(volumes_absorb_by_beer_lambert),
        cmocka_unit_test(dispersion_splits_gray_light_into_hues),
        cmocka_unit_test(a_larger_index_reflects_and_refracts_more),
        cmocka_unit_test(alpha_modes_cover_differently),
    };
    return cmocka_run_group_tests(tests, create_environments, destroy_environments);
}
