/* gl_glass_test.c - glass behind glass, and bodies inside it: OpenGL's rays show what the preview's do. Each scene is one
 * that a single layer of transmission gets wrong. Exits with 77 where there is no OpenGL. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "gl/scene/gl_fixture_test.h"
#include "shade/shade.h"

static gl_fixture_contexts contexts;

static scene_material glass(float ior, float thickness)
{
    scene_material m = scene_material_default();
    m.extensions |= SCENE_TRANSMISSION | SCENE_IOR;
    m.transmission = 1.0f;
    m.metallic = 0.0f;
    m.perceptual_roughness = 0.0f;
    m.ior = ior;
    if (thickness > 0.0f) {
        m.extensions |= SCENE_VOLUME;
        m.thickness = thickness;
    }
    return m;
}

static scene_material paint(float r, float g, float b)
{
    scene_material m = scene_material_default();
    const float color[3] = {r, g, b};
    memcpy(m.base_color, color, sizeof color);
    m.metallic = 0.0f;
    m.perceptual_roughness = 1.0f;
    return m;
}

static scene_node *add_sphere(fixture *f, scene_material m, float x, float z, float radius)
{
    return fixture_place(f, fixture_add_sphere(f, 48, fixture_add_material(f, m)), x, 0, z, radius);
}

static scene_node *add_quad(fixture *f, scene_material m, float x, float z, float radius)
{
    return fixture_place(f, fixture_add_quad(f, fixture_add_material(f, m)), x, 0, z, radius);
}

static double display(float linear)
{
    return 255.0 * (double)srgb_from_linear1(clamp(linear, 0.0f, 1.0f));
}

/* Mean difference in 8-bit codes. */
static double difference(const film *a, const film *b)
{
    double sum = 0.0;
    size_t count = (size_t)a->width * a->height * 3;
    for (size_t i = 0; i < (size_t)a->width * a->height; i++)
        for (size_t c = 0; c < 3; c++)
            sum += fabs(display(a->layers[0].pixels[4 * i + c]) - display(b->layers[0].pixels[4 * i + c]));
    return sum / (double)count;
}

/* most: mean difference of the images of rays, in 8-bit codes. least: of those of drafts, which have one layer. */
static void compare_with_preview(fixture *f, const char *what, double most, double least)
{
    f->desc.width = f->desc.height = 64;
    f->desc.energy = FACET_ENERGY_CONSERVING;
    f->desc.background = FACET_BACKGROUND_ENVIRONMENT;
    film wanted = fixture_render(f);
    for (int c = 0; c < contexts.count; c++) {
        f->desc.quality = FACET_QUALITY_NORMAL;
        film seen = gl_fixture_render(f, &contexts.items[c]);
        f->desc.quality = FACET_QUALITY_DRAFT;
        film draft = gl_fixture_render(f, &contexts.items[c]);
        double by_rays = difference(&seen, &wanted), by_layer = difference(&draft, &wanted);
        print_message("%s: %.3f codes from the preview, %.3f with one layer\n", what, by_rays, by_layer);
        assert_true(by_rays < most);
        assert_true(by_layer > least);
        film_destroy(&seen);
        film_destroy(&draft);
    }
    film_destroy(&wanted);
}

/* A body of glass with an air bubble and a red core in it. */
static void a_bubble_and_a_core_in_glass(void **state)
{
    (void)state;
    fixture f = fixture_create();
    scene_material body = glass(1.5f, 1.0f);
    const float color[3] = {0.4f, 0.8f, 0.6f};
    memcpy(body.attenuation_color, color, sizeof color);
    body.attenuation_distance = 1.0f;
    add_sphere(&f, body, 0, 0, 0.9f);
    add_sphere(&f, glass(1.0f, 0.5f), 0.3f, 0.2f, 0.3f);
    add_sphere(&f, paint(0.9f, 0.1f, 0.05f), -0.3f, -0.2f, 0.25f);
    add_quad(&f, paint(0.2f, 0.3f, 0.9f), 0, -2.0f, 1.0f);
    compare_with_preview(&f, "bubble and core", 2.5, 4.0); /* most at the rims of bodies */
    fixture_destroy(&f);
}

/* A sphere of glass in front of another, before a wall of two colors. */
static void glass_in_front_of_glass(void **state)
{
    (void)state;
    fixture f = fixture_create();
    scene_material near = glass(1.5f, 0.5f), far = glass(1.5f, 0.5f);
    near.base_color[2] = 0.7f;
    far.base_color[0] = 0.4f;
    add_sphere(&f, near, 0.2f, 1.0f, 0.5f);
    add_sphere(&f, far, -0.2f, -0.6f, 0.6f);
    add_quad(&f, paint(0.1f, 0.5f, 0.1f), -0.5f, -2.0f, 0.5f);
    add_quad(&f, paint(0.6f, 0.3f, 0.1f), 0.5f, -2.0f, 0.5f);
    compare_with_preview(&f, "glass before glass", 1.0, 4.0);
    fixture_destroy(&f);
}

/* Two tinted panes, and something colored behind them. */
static void a_window_of_two_panes(void **state)
{
    (void)state;
    fixture f = fixture_create();
    scene_material near = glass(1.5f, 0.0f), far = glass(1.5f, 0.0f);
    near.base_color[0] = 0.5f;
    far.base_color[1] = 0.5f;
    add_quad(&f, near, 0, 0.5f, 0.9f);
    add_quad(&f, far, 0, 0, 0.7f);
    add_sphere(&f, paint(0.9f, 0.8f, 0.1f), 0, -1.0f, 0.5f);
    compare_with_preview(&f, "two panes", 1.0, 4.0);
    fixture_destroy(&f);
}

/* A textured board that something hides from the eye, but not from refracted rays: what is not in the image is shaded with
 * the material's texture. */
static void what_the_image_lacks_is_shaded(void **state)
{
    (void)state;
    static const unsigned char halves[16] = {250, 30, 30, 255, 30, 60, 250, 255,
                                             250, 30, 30, 255, 30, 60, 250, 255};
    fixture f = fixture_create();
    scene_material board = paint(1, 1, 1);
    board.is_double_sided = true;
    uint32_t texture = fixture_add_texture(&f, 2, 2, halves);
    board.textures[SCENE_BASE_COLOR_TEXTURE].texture = texture;
    f.scene->textures[texture].mag_filter = SCENE_FILTER_NEAREST;
    f.scene->textures[texture].min_filter = SCENE_FILTER_NEAREST;
    add_quad(&f, paint(0.2f, 0.2f, 0.2f), 0, 0.8f, 0.3f); /* hides the board from the eye */
    add_quad(&f, board, 0, -1.5f, 0.9f);
    add_sphere(&f, glass(1.5f, 1.0f), 0, -0.2f, 0.8f);
    compare_with_preview(&f, "beside the image", 1.5, 4.0);
    fixture_destroy(&f);
}

/* Radiance and what shows of a white background. */
static double mean_over_white(const film *a)
{
    double sum = 0.0;
    size_t count = (size_t)a->width * a->height;
    for (size_t i = 0; i < 4 * count; i++)
        sum += (double)(i % 4 < 3 ? a->layers[0].pixels[i] / 3.0f : 1.0f - a->layers[0].pixels[i]);
    return sum / (double)count;
}

/* What glass shows of the background is opacity, too, which no longer is coverage then. */
static void masked_glass_before_the_background(void **state)
{
    (void)state;
    static const unsigned char gray[16] = {160, 160, 160, 255, 160, 160, 160, 200,
                                           160, 160, 160, 255, 160, 160, 160, 255};
    fixture f = fixture_create();
    scene_material pane = glass(1.5f, 0.0f);
    pane.alpha_mode = SCENE_ALPHA_MASK;
    pane.alpha_cutoff = 0.5f;
    pane.textures[SCENE_BASE_COLOR_TEXTURE].texture = fixture_add_texture(&f, 2, 2, gray);
    add_quad(&f, pane, 0, 0, 0.9f);
    f.desc.width = f.desc.height = 32;
    f.desc.samples = 4;
    f.desc.background = FACET_BACKGROUND_TRANSPARENT;
    film wanted = fixture_render(&f);
    for (int c = 0; c < contexts.count; c++) {
        film seen = gl_fixture_render(&f, &contexts.items[c]);
        print_message("masked glass: %.4f, the preview's %.4f\n", mean_over_white(&seen),
                      mean_over_white(&wanted));
        assert_true(fabs(mean_over_white(&seen) - mean_over_white(&wanted)) < 0.01);
        film_destroy(&seen);
    }
    film_destroy(&wanted);
    fixture_destroy(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_bubble_and_a_core_in_glass),
        cmocka_unit_test(glass_in_front_of_glass),
        cmocka_unit_test(a_window_of_two_panes),
        cmocka_unit_test(what_the_image_lacks_is_shaded),
        cmocka_unit_test(masked_glass_before_the_background),
    };
    if (gl_fixture_open(&contexts) == 0)
        return 77;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    gl_fixture_close(&contexts);
    return failed;
}
