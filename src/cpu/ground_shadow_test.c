/* Tests of the preview's shadow on the ground: against a closed formula, at the border, in crops, over backgrounds. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "cpu/preview_fixture.h"
#include "tests/support/support.h"

static const float HEIGHT = 12.0f; /* of the view, m */

/* A black sphere of radius 1 on the ground y = 0, under uniform light, seen from 45 degrees. */
static fixture sphere_on_ground(void)
{
    fixture f = fixture_create();
    scene_material black = scene_material_default();
    memset(black.base_color, 0, 3 * sizeof *black.base_color);
    black.perceptual_roughness = 1.0f;
    fixture_place(&f, fixture_add_sphere(&f, 128, fixture_add_material(&f, black)), 0.0f, 1.0f, 0.0f, 1.0f);
    f.camera.eye[0] = 0.0f;
    f.camera.eye[1] = f.camera.eye[2] = 8.0f;
    f.camera.ortho_height = HEIGHT;
    f.desc.ground = FACET_GROUND_SHADOW;
    return f;
}

/* Distance from the point of contact of the ground in the middle of a pixel. */
static double distance_at(uint32_t x, uint32_t y, uint32_t size)
{
    double across = ((double)x + 0.5 - 0.5 * size) * (double)HEIGHT / size;
    double along = ((double)y + 0.5 - 0.5 * size) * (double)HEIGHT / size * sqrt(2.0);
    return sqrt(across * across + along * along);
}

/* A sphere of radius 1 at height 1 hides (1 + d^2)^(-3/2) of uniform light from the ground at distance d. */
static void a_sphere_hides_its_form_factor(void **state)
{
    (void)state;
    fixture f = sphere_on_ground();
    f.desc.width = f.desc.height = 256; /* the filter is 0.3 m wide */
    film rendered = fixture_render(&f);
    int count = 0;
    double sum = 0.0;
    for (uint32_t y = 144; y < 204; y += 3)
        for (uint32_t x = 54; x < 202; x += 3) {
            double d = distance_at(x, y, 256);
            if (d < 1.5)
                continue;
            double off = (double)fixture_pixel(&rendered, "", x, y)[3] - pow(1.0 + d * d, -1.5);
            if (fabs(off) > 0.02)
                fail_msg("at %u, %u, distance %g: off by %g", x, y, d, off);
            sum += off;
            count++;
        }
    assert_true(count > 200 && fabs(sum / count) < 0.002);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

/* In a white furnace a white model sends as much light to the ground as it blocks. */
static void a_white_model_leaves_no_shadow_in_uniform_light(void **state)
{
    (void)state;
    fixture f = sphere_on_ground();
    for (int c = 0; c < 3; c++)
        f.scene->materials[0].base_color[c] = 1.0f;
    film rendered = fixture_render(&f);
    assert_true((double)fixture_pixel(&rendered, "", 32, 46)[3] < 0.002);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

static void nothing_is_drawn_at_the_border(void **state)
{
    (void)state;
    for (int has_sun = 0; has_sun < 2; has_sun++) {
        fixture f = sphere_on_ground();
        f.camera.ortho_height = 5.0f; /* the shadow reaches beyond the image */
        f.desc.width = f.desc.height = 256;
        if (has_sun)
            f.desc.sun = (facet_sun){.elevation_rad = 0.2f, .illuminance_lux = {9.0f, 9.0f, 9.0f}};
        film rendered = fixture_render(&f);
        float largest = 0.0f;
        for (uint32_t i = 0; i < 256; i++) {
            const float *pixels[] = {fixture_pixel(&rendered, "", i, 0), fixture_pixel(&rendered, "", i, 255),
                                     fixture_pixel(&rendered, "", 0, i),
                                     fixture_pixel(&rendered, "", 255, i)};
            for (int k = 0; k < 4; k++)
                assert_true(pixels[k][3] < 0.5f / 255.0f);
            largest = fmaxf(largest, fixture_pixel(&rendered, "", i, 190)[3]);
        }
        assert_true(largest > 0.05f);
        film_destroy(&rendered);
        fixture_destroy(&f);
    }
}

static void a_crop_has_the_pixels_of_the_image(void **state)
{
    (void)state;
    fixture f = sphere_on_ground();
    film whole = fixture_render(&f);
    const uint32_t crop[4] = {9, 30, 21, 17};
    memcpy(f.desc.crop, crop, sizeof crop);
    f.desc.thread_count = 5;
    film part = fixture_render(&f);
    fixture_assert_crop(&whole, &part, crop);
    film_destroy(&part);
    film_destroy(&whole);
    fixture_destroy(&f);
}

static void threads_do_not_change_it(void **state)
{
    (void)state;
    fixture f = sphere_on_ground();
    f.desc.thread_count = 1;
    film one = fixture_render(&f);
    f.desc.thread_count = 7;
    film seven = fixture_render(&f);
    fixture_assert_same(&one, &seven);
    film_destroy(&one);
    film_destroy(&seven);
    fixture_destroy(&f);
}

/* The shadow dims the environment behind it. */
static void it_is_between_model_and_background(void **state)
{
    (void)state;
    fixture f = sphere_on_ground();
    film clear = fixture_render(&f);
    f.desc.background = FACET_BACKGROUND_ENVIRONMENT;
    film full = fixture_render(&f);
    for (uint32_t y = 0; y < 64; y++)
        for (uint32_t x = 0; x < 64; x++) {
            const float *a = fixture_pixel(&clear, "", x, y);
            const float *b = fixture_pixel(&full, "", x, y);
            assert_true(b[3] == 1.0f && fabsf(b[0] - (a[0] + 1.0f - a[3])) < 1e-5f);
        }
    film_destroy(&clear);
    film_destroy(&full);
    fixture_destroy(&f);
}

static void the_ground_is_visible_from_above_only(void **state)
{
    (void)state;
    fixture f = sphere_on_ground();
    f.camera.eye[1] = -8.0f;
    film rendered = fixture_render(&f);
    for (uint32_t x = 0; x < 64; x++)
        assert_true(fixture_pixel(&rendered, "", x, 50)[3] == 0.0f);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

/* Without an environment the sun's shadow is all there is: black, and next to it nothing. */
static void the_sun_casts_a_black_shadow_alone(void **state)
{
    (void)state;
    fixture f = sphere_on_ground();
    fixture_remove_environment(&f);
    f.desc.sun =
        (facet_sun){.azimuth_rad = 1.5707963f, .elevation_rad = 0.785398f, .illuminance_lux = {1, 1, 1}};
    film rendered = fixture_render(&f);
    /* light from +X at 45 degrees: the middle of the shadow is at x = -1 - 0.4 .. */
    assert_true(fixture_pixel(&rendered, "", 22, 32)[3] > 0.98f);
    assert_true(fixture_pixel(&rendered, "", 46, 32)[3] < 0.001f);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sphere_hides_its_form_factor),
        cmocka_unit_test(a_white_model_leaves_no_shadow_in_uniform_light),
        cmocka_unit_test(nothing_is_drawn_at_the_border),
        cmocka_unit_test(a_crop_has_the_pixels_of_the_image),
        cmocka_unit_test(threads_do_not_change_it),
        cmocka_unit_test(it_is_between_model_and_background),
        cmocka_unit_test(the_ground_is_visible_from_above_only),
        cmocka_unit_test(the_sun_casts_a_black_shadow_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
