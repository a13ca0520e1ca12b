/* compare_test.c - the Compare* models of Khronos' sample assets about surfaces: two or three objects side
 * by side that differ by one material property. Each test states the physics of that property and checks
 * for it. Images are orthographic, so that the pixels of both sides correspond; where the sides differ by
 * more than the property, the one that has it is compared with itself without it. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "model_image.h"

static facet_environment *white; /* radiance 1 from everywhere */
static facet_environment *black;

static int create_environments(void **state)
{
    (void)state;
    facet_result result = facet_environment_create_constant((float[3]){1, 1, 1}, NULL, &white, NULL);
    return result || facet_environment_create_constant((float[3]){0, 0, 0}, NULL, &black, NULL);
}

static int destroy_environments(void **state)
{
    (void)state;
    facet_environment_destroy(white);
    facet_environment_destroy(black);
    return 0;
}

static model_image render_sphere(const char *path, float x, const char *text, const char *by,
                                 facet_environment *light)
{
    model_image p = model_image_of_sphere(path, x, &(facet_render_desc){.environment = light}, text, by);
    if (p.count == 0)
        skip();
    return p;
}

/* Metals reflect specularly only, dielectrics 4 %, the rest diffusely: reflections of metals have many times
 * the contrast. */
static void metal_reflects_its_environment(void **state)
{
    (void)state;
    model_image paint = render_sphere("materials/CompareMetallic.glb", -0.55f, NULL, NULL, NULL);
    model_image metal = render_sphere("materials/CompareMetallic.glb", 0.55f, NULL, NULL, NULL);
    assert_true(model_image_detail(&metal, 1) > 2.0 * model_image_detail(&paint, 0));
    assert_true(model_image_percentile(&metal, 1, 0.99) > 2.0 * model_image_percentile(&paint, 0, 0.99));
    assert_true(model_image_percentile(&metal, 1, 0.05) < model_image_percentile(&paint, 0, 0.05));
    model_image_destroy(&paint);
    model_image_destroy(&metal);
}

/* Roughness spreads highlights: their peak decreases and their edges blur. In uniform light there is
 * nothing to spread: only the rim, where a smooth surface reflects all, is darker. */
static void roughness_spreads_highlights(void **state)
{
    (void)state;
    const char *model = "materials/CompareRoughness.glb";
    model_image smooth = render_sphere(model, -0.55f, NULL, NULL, NULL),
                rough = render_sphere(model, 0.55f, NULL, NULL, NULL);
    assert_true(model_image_percentile(&rough, 1, 0.99) < 0.75 * model_image_percentile(&smooth, 0, 0.99));
    assert_true(model_image_detail(&rough, 1) < 0.6 * model_image_detail(&smooth, 0));
    model_image_destroy(&smooth);
    model_image_destroy(&rough);
    smooth = render_sphere(model, -0.55f, NULL, NULL, white);
    rough = render_sphere(model, 0.55f, NULL, NULL, white);
    double inner[2] = {model_image_ring(&smooth, 0, 0, 0, 0.6), model_image_ring(&rough, 1, 0, 0, 0.6)};
    assert_float_equal((float)inner[1], (float)inner[0], 0.02f);
    assert_true(model_image_ring(&rough, 1, 0, 0.97, 1) < model_image_ring(&smooth, 0, 0, 0.97, 1) - 0.05);
    model_image_destroy(&smooth);
    model_image_destroy(&rough);
}

/* A factor, a texture, and that texture times vertex colors around the circle of hues. In white light a
 * surface shows its albedo. */
static void vertex_colors_tint_the_texture(void **state)
{
    (void)state;
    facet_scene *scene = model_load("materials/CompareBaseColor.glb");
    if (!scene)
        skip();
    float low[3], high[3];
    assert_true(facet_scene_get_bounds(scene, NULL, low, high));
    facet_scene_destroy(scene);
    const char *model = "materials/CompareBaseColor.glb";
    float x = high[0] - 0.5f;
    model_image factor = render_sphere(model, -x, NULL, NULL, white),
                texture = render_sphere(model, 0, NULL, NULL, white),
                vertices = render_sphere(model, x, NULL, NULL, white);
    assert_true(model_image_hues(&vertices, 1) >= 8);
    assert_true(model_image_hues(&texture, 1) <= 4);
    assert_true(model_image_hues(&factor, 0) <= 4);
    assert_true(model_image_mean_luminance(&vertices, 1) < model_image_mean_luminance(&texture, 1));
    model_image_destroy(&factor);
    model_image_destroy(&texture);
    model_image_destroy(&vertices);
}

/* A normal map tilts the surface locally and adds neither light nor shadow: the total reflected light hardly
 * changes, its detail does. */
static void normal_maps_add_relief_but_no_light(void **state)
{
    (void)state;
    const char *model = "materials/CompareNormal.glb";
    facet_scene *scene = model_load(model);
    if (!scene)
        skip();
    float low[3], high[3];
    assert_true(facet_scene_get_bounds(scene, NULL, low, high));
    facet_scene_destroy(scene);
    float x = high[0] - 0.5f;
    model_image plain = render_sphere(model, -x, NULL, NULL, NULL),
                relief = render_sphere(model, x, NULL, NULL, NULL);
    assert_true(model_image_detail(&relief, 1) > 1.5 * model_image_detail(&plain, 0));
    double ratio = model_image_mean_luminance(&relief, 1) / model_image_mean_luminance(&plain, 0);
    assert_float_equal((float)ratio, 1.0f, 0.06f);
    model_image_destroy(&plain);
    model_image_destroy(&relief);
}

/* A coat of index 1.5 reflects Fc = 0.04 + 0.96 (1 - NdotV)^5 specularly and transmits 1 - Fc. In uniform
 * light of 1 that is all: coated = Fc + (1 - Fc) bare, pixel by pixel; near the rim a pixel covers too
 * many angles. */
static void a_clearcoat_reflects_its_fresnel_share(void **state)
{
    (void)state;
    const char *model = "materials/CompareClearcoat.glb";
    model_image coated = render_sphere(model, 1.1f, NULL, NULL, white);
    model_image bare = render_sphere(model, 1.1f, "\"clearcoatFactor\":1", "\"clearcoatFactor\":0", white);
    double worst = 0.0;
    for (uint32_t i = 0; i < coated.count; i++) {
        double cosine = model_image_cosine(&coated, i), Fc = 0.04 + 0.96 * pow(1.0 - cosine, 5.0);
        for (uint32_t c = 0; c < 3 && coated.material[i] == 2 && model_image_radius(&coated, i) < 0.8; c++) {
            double wanted = Fc + (1.0 - Fc) * (double)bare.rgba[4 * i + c];
            worst = fmax(worst, fabs((double)coated.rgba[4 * i + c] - wanted));
        }
    }
    print_message("clearcoat: off by %.2g at most\n", worst);
    assert_true(worst < 0.003);
    model_image_destroy(&bare);
    model_image_destroy(&coated);
}

/* Three spheres, smooth, rough, and rough with a smooth coat: the coated one has the sharp highlights of the
 * first over the blurred ones of the second. */
static void a_clearcoat_has_sharp_highlights(void **state)
{
    (void)state;
    const char *model = "materials/CompareClearcoat.glb";
    model_image smooth = render_sphere(model, -1.1f, NULL, NULL, NULL),
                rough = render_sphere(model, 0, NULL, NULL, NULL),
                coated = render_sphere(model, 1.1f, NULL, NULL, NULL);
    assert_true(model_image_detail(&coated, 2) > 1.3 * model_image_detail(&rough, 1));
    assert_true(model_image_percentile(&coated, 2, 0.995) > 1.1 * model_image_percentile(&rough, 1, 0.995));
    assert_true(model_image_detail(&smooth, 0) > model_image_detail(&rough, 1));
    model_image_destroy(&smooth);
    model_image_destroy(&rough);
    model_image_destroy(&coated);
}

/* Sheen of color (1, 0, 0) over a base attenuated by 1 - E(NdotV): green and blue decrease by the same
 * factor, most at the rim, where fibers scatter most; red returns there. */
static void sheen_is_strongest_at_the_rim(void **state)
{
    (void)state;
    const char *model = "materials/CompareSheen.glb";
    model_image fabric = render_sphere(model, 0.55f, NULL, NULL, white);
    model_image plain =
        render_sphere(model, 0.55f, "\"sheenColorFactor\":[1,0,0]", "\"sheenColorFactor\":[0,0,0]", white);
    double transmitted[3] = {0}, count = 0.0; /* fraction of the base, by green: center, between, rim */
    static const double edges[4] = {0.0, 0.5, 0.85, 0.98};
    for (int r = 0; r < 3; r++)
        transmitted[r] = model_image_ring(&fabric, 1, 1, edges[r], edges[r + 1]) /
                         model_image_ring(&plain, 1, 1, edges[r], edges[r + 1]);
    for (uint32_t i = 0; i < plain.count; i++) {
        const float *p = plain.rgba + 4 * i, *f = fabric.rgba + 4 * i;
        if (plain.material[i] != 1 || model_image_radius(&plain, i) > 0.98)
            continue;
        assert_float_equal(f[1] * p[2], f[2] * p[1], 1e-3f * p[1] * p[2] + 1e-6f);
        assert_true(f[1] < p[1] && f[0] / p[0] > f[1] / p[1]);
        count++;
    }
    print_message("sheen transmits %.3f, %.3f, %.3f to the base\n", transmitted[0], transmitted[1],
                  transmitted[2]);
    assert_true(count > 1000.0 && transmitted[2] < transmitted[1] && transmitted[1] < transmitted[0]);
    assert_true(model_image_ring(&fabric, 1, 0, 0.85, 0.98) >
                1.5 * model_image_ring(&plain, 1, 0, 0.85, 0.98));
    model_image_destroy(&fabric);
    model_image_destroy(&plain);
}

/* A color factor of 10 raises F0 from 0.04 to 0.4 where the texture of small specks is white: highlights
 * there are stronger; without specular there are none. */
static void a_specular_color_strengthens_reflections(void **state)
{
    (void)state;
    const char *model = "materials/CompareSpecular.glb", *ten = "\"specularColorFactor\":[10,10,10]";
    model_image strong = render_sphere(model, 0.525f, NULL, NULL, NULL);
    model_image weak = render_sphere(model, 0.525f, ten, "\"specularColorFactor\":[1,1,1]", NULL);
    model_image none = render_sphere(model, 0.525f, "\"specularFactor\":1", "\"specularFactor\":0", NULL);
    assert_true(model_image_percentile(&strong, 1, 0.9995) > 1.5 * model_image_percentile(&weak, 1, 0.9995));
    assert_true(model_image_detail(&none, 1) < model_image_detail(&weak, 1));
    assert_true(model_image_detail(&weak, 1) < model_image_detail(&strong, 1));
    model_image_destroy(&strong);
    model_image_destroy(&weak);
    model_image_destroy(&none);
}

/* Reflection of a thin film depends on wavelength and angle: a gray surface shows many hues. Where the film's
 * texture is 0, at the logo, both sides are equal. */
static void a_thin_film_shows_many_hues(void **state)
{
    (void)state;
    const char *model = "materials/CompareIridescence.glb";
    model_image plain = render_sphere(model, -0.55f, NULL, NULL, NULL),
                film = render_sphere(model, 0.55f, NULL, NULL, NULL);
    assert_true(model_image_hues(&plain, 0) <= 2);
    assert_true(model_image_hues(&film, 1) >= 5);
    assert_true(model_image_mean_chroma(&film, 1) > 2.0 * model_image_mean_chroma(&plain, 0));
    model_image off = render_sphere(model, 0.55f, "\"iridescenceFactor\":1", "\"iridescenceFactor\":0",
                                    NULL); /* the same rays */
    double logo = 0.0, count = 0.0;
    for (uint32_t i = 0; i < off.count; i++) {
        const float *c = off.rgba + 4 * i;
        if (off.material[i] == 1 && c[1] > 0.3f && c[1] > 1.5f * c[2] && model_image_radius(&off, i) < 0.6) {
            logo += fabs(model_image_luminance(&film, i) - model_image_luminance(&off, i));
            count++;
        }
    }
    assert_true(count > 50.0 && logo / count < 0.03);
    model_image_destroy(&plain);
    model_image_destroy(&film);
    model_image_destroy(&off);
}

/* In the dark only emission is visible, and a strength of 3 triples it. */
static void emission_grows_with_its_strength(void **state)
{
    (void)state;
    const char *model = "materials/CompareEmissiveStrength.glb";
    model_image one = render_sphere(model, -0.55f, NULL, NULL, black),
                three = render_sphere(model, 0.55f, NULL, NULL, black);
    double most = 0.0;
    for (uint32_t i = 0; i < one.count * 4; i++) {
        most = fmax(most, (double)one.rgba[i]);
        if (i % 4 < 3) /* a pixel at the rim may lose a sample */
            assert_float_equal(three.rgba[i], 3.0f * one.rgba[i], 0.02f);
    }
    assert_true(most > 0.5);
    model_image_destroy(&one);
    model_image_destroy(&three);
}

/* Sum of the differences along x, over that along y. */
static double variation_ratio(const model_image *p)
{
    double x = 0.0, y = 0.0;
    for (uint32_t i = 0; i + p->width < p->count; i++) {
        if (i % p->width + 1 == p->width || model_image_radius(p, i) > 0.75 || p->material[i] < 0)
            continue;
        double here = model_image_luminance(p, i);
        x += fabs(model_image_luminance(p, i + 1) - here);
        y += fabs(model_image_luminance(p, i + p->width) - here);
    }
    assert_true(y > 0.0);
    return x / y;
}

/* Anisotropy stretches highlights along the tangent, here around the sphere's axis: from a strength of 1/2 on
 * at least half of the variation along x of a sphere's image disappears, and the variation along y remains.
 * Paths (1024 samples per pixel) decide how much is left at each strength. */
static void anisotropy_stretches_highlights(void **state)
{
    (void)state;
    facet_scene *scene = model_load("materials/AnisotropyStrengthTest.glb");
    if (!scene)
        skip();
    static const float by_paths[7] = {0.938f, 0.773f, 0.524f, 0.327f, 0.252f, 0.233f, 0.234f};
    for (int row = 0; row < 7; row++) { /* strengths from 0 to 1 at roughness 1/6 */
        model_image p = model_image_render(scene, &(view){.x = -2, .y = (float)row, .height = 0.816f}, NULL);
        float ratio = (float)variation_ratio(&p);
        assert_float_equal(ratio, by_paths[row], 0.15f);
        assert_true(row < 3 || ratio < 0.5f);
        model_image_destroy(&p);
    }
    facet_scene_destroy(scene);
}

/* The half without anisotropy equals the other one with a strength of 0. The brushed lid reflects the
 * lights as radial streaks instead of spots: more of it is bright. */
static void brushed_metal_shows_streaks(void **state)
{
    (void)state;
    const char *model = "materials/CompareAnisotropy.glb";
    model_image brushed = render_sphere(model, 0.5f, NULL, NULL, NULL),
                plain = render_sphere(model, -0.5f, NULL, NULL, NULL);
    model_image off =
        render_sphere(model, 0.5f, "\"anisotropyStrength\":0.5", "\"anisotropyStrength\":0", NULL);
    assert_true(model_image_distance(&plain, &off) < 0.001);
    assert_true(model_image_distance(&plain, &brushed) > 0.2);
    assert_true(model_image_percentile(&brushed, 1, 0.95) > 1.5 * model_image_percentile(&plain, 3, 0.95));
    model_image_destroy(&brushed);
    model_image_destroy(&plain);
    model_image_destroy(&off);
}

/* The occlusion texture dims ambient light, so nothing is brighter, and the gaps between the fruit are
 * darker. */
static void occlusion_only_darkens(void **state)
{
    (void)state;
    facet_scene *scene = model_load("materials/CompareAmbientOcclusion.glb");
    if (!scene)
        skip();
    model_image open = model_image_render(scene, &(view){.x = -0.16f, .height = 0.4f}, NULL);
    model_image closed = model_image_render(scene, &(view){.x = 0.16f, .height = 0.4f}, NULL);
    uint32_t brighter = 0, darker = 0, count = 0;
    for (uint32_t i = 0; i < open.count; i++) {
        if (open.material[i] < 3 || closed.material[i] != open.material[i] - 3)
            continue;
        double a = model_image_luminance(&open, i), b = model_image_luminance(&closed, i);
        count++;
        brighter += b > a * 1.02 + 0.002;
        darker += b < 0.7 * a;
    }
    print_message("occlusion: of %u pixels %u are darker, %u brighter\n", count, darker, brighter);
    assert_true(count > 1000 && darker * 10 > count && brighter * 50 < count);
    model_image_destroy(&open);
    model_image_destroy(&closed);
    facet_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(metal_reflects_its_environment),
        cmocka_unit_test(roughness_spreads_highlights),
        cmocka_unit_test(vertex_colors_tint_the_texture),
        cmocka_unit_test(normal_maps_add_relief_but_no_light),
        cmocka_unit_test(a_clearcoat_reflects_its_fresnel_share),
        cmocka_unit_test(a_clearcoat_has_sharp_highlights),
        cmocka_unit_test(sheen_is_strongest_at_the_rim),
        cmocka_unit_test(a_specular_color_strengthens_reflections),
        cmocka_unit_test(a_thin_film_shows_many_hues),
        cmocka_unit_test(emission_grows_with_its_strength),
        cmocka_unit_test(anisotropy_stretches_highlights),
        cmocka_unit_test(brushed_metal_shows_streaks),
        cmocka_unit_test(occlusion_only_darkens),
    };
    return cmocka_run_group_tests(tests, create_environments, destroy_environments);
}
