/* ibl_sheet_test.c - sheets of baked cube maps: positions and values of their elements. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "base/memory.h"
#include "ibl/light_fixture.h"
#include "image/srgb.h"
#include "report/ibl_sheet.h"
#include "report/report.h"

static const float LIGHT[3] = {0.2f, 0.5f, 0.8f};

static void uniform(const float d[3], float out[3])
{
    (void)d;
    memcpy(out, LIGHT, sizeof LIGHT);
}

/* A color for each face of a cube. */
static void faces(const float d[3], float out[3])
{
    cube_point p = cube_locate(d[0], d[1], d[2]);
    out[0] = 0.1f + 0.1f * (float)p.face;
    out[1] = p.face & 1 ? 0.7f : 0.3f;
    out[2] = 0.9f - 0.1f * (float)p.face;
}

static facet_cube *bake(facet_environment *e, const facet_bake_desc *desc)
{
    facet_cube *c = NULL;
    facet_error error = {0};
    if (facet_cube_bake(e, desc, &c, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return c;
}

static image draw(const facet_cube *c, const facet_environment *e, const facet_sheet_desc *desc)
{
    image sheet = {0};
    facet_error error = {0};
    if (ibl_sheet_draw(c, e, desc, &sheet, &error) != FACET_OK)
        fail_msg("%s", error.message);
    assert_int_equal(sheet.channel_count, 4);
    assert_int_equal(sheet.type, IMAGE_F32);
    for (size_t i = 0; i < (size_t)sheet.width * sheet.height; i++) {
        const float *p = (const float *)sheet.pixels + 4 * i;
        assert_true(p[3] == 1.0f);
        for (int k = 0; k < 3; k++)
            assert_true(p[k] >= 0.0f && p[k] <= 1.0f + 1e-5f);
    }
    return sheet;
}

static const float *pixel(const image *i, uint32_t x, uint32_t y)
{
    return (const float *)i->pixels + 4 * ((size_t)y * i->width + x);
}

/* In uniform light crosses and spheres have its color, however they are lit, and cover the expected area. */
static void uniform_light_colors_all_elements(void **state)
{
    (void)state;
    facet_environment *e = make_environment(64, 32, uniform);
    static const struct {
        facet_lobe lobe;
        uint32_t levels;
        double least, most; /* share of the sheet with the color of the light */
    } kinds[] = {{FACET_LOBE_LAMBERT, 1, 0.13, 0.17},
                 {FACET_LOBE_NONE, 3, 0.24, 0.28},
                 {FACET_LOBE_GGX, 3, 0.26, 0.3}};
    for (int k = 0; k < 3; k++) {
        facet_bake_desc desc = {.lobe = kinds[k].lobe, .size = 64, .level_count = kinds[k].levels};
        facet_cube *c = bake(e, &desc);
        image sheet = draw(c, e, &(facet_sheet_desc){.bake = desc});
        assert_int_equal(sheet.width, 1600);
        size_t count = 0;
        for (uint32_t y = 0; y < sheet.height; y++)
            for (uint32_t x = 0; x < sheet.width; x++) {
                const float *p = pixel(&sheet, x, y);
                count += fabsf(p[0] - LIGHT[0]) < 2e-3f && fabsf(p[1] - LIGHT[1]) < 3e-3f &&
                         fabsf(p[2] - LIGHT[2]) < 4e-3f;
            }
        double share = (double)count / ((double)sheet.width * sheet.height);
        print_message("lobe %d: %u x %u, %.3f of it lit\n", (int)kinds[k].lobe, sheet.width, sheet.height,
                      share);
        assert_true(share > kinds[k].least && share < kinds[k].most);
        image_destroy(&sheet);
        facet_cube_destroy(c);
    }
    facet_environment_destroy(e);
}

/* The faces of the cross are in place and upright. */
static void crosses_show_upright_faces(void **state)
{
    (void)state;
    enum { EDGE = 42 }; /* pixel centers coincide with texel centers */
    static const struct {
        uint32_t face, column, row;
    } places[6] = {{0, 2, 1}, {1, 0, 1}, {2, 1, 0}, {3, 1, 2}, {4, 1, 1}, {5, 3, 1}};
    cube c;
    assert_int_equal(cube_create(2, NULL, &c, NULL), FACET_OK);
    for (uint32_t face = 0; face < 6; face++)
        for (int y = 0; y < 2; y++)
            for (int x = 0; x < 2; x++)
                *cube_texel(&c, face, x, y) = (rgbx){(float)face, (float)x, (float)y, 0.0f};
    cube_fill_borders(&c);
    film f;
    assert_int_equal(film_create(NULL, 4 * EDGE + 3, 3 * EDGE + 5, 0, &f, NULL), FACET_OK);
    sheet_canvas canvas = {&f, 2};
    sheet_draw_cross(&canvas, (sheet_place){3, 5, 4 * EDGE}, &c);
    size_t covered = 0;
    for (size_t i = 0; i < (size_t)f.width * f.height; i++)
        covered += f.layers[0].pixels[4 * i + 3] == 1.0f;
    assert_int_equal(covered, 6 * EDGE * EDGE);
    for (int k = 0; k < 6; k++)
        for (uint32_t y = 0; y < 2; y++)
            for (uint32_t x = 0; x < 2; x++) {
                uint32_t px = 3 + places[k].column * EDGE + 10 + x * EDGE / 2;
                uint32_t py = 5 + places[k].row * EDGE + 10 + y * EDGE / 2;
                const float *p = f.layers[0].pixels + 4 * ((size_t)py * f.width + px);
                assert_near(p[0], (float)places[k].face, 1e-4);
                assert_near(p[1], (float)x, 1e-4);
                assert_near(p[2], (float)y, 1e-4);
            }
    film_destroy(&f);
    cube_destroy(&c);
}

/* The center of a sphere mirrors +Z, the rim -Z; the center of a diffuse one faces +Z. */
static void spheres_read_the_right_directions(void **state)
{
    (void)state;
    enum { WIDTH = 101 };
    facet_environment *e = make_environment(256, 128, faces);
    facet_bake_desc desc = {.lobe = FACET_LOBE_NONE, .size = 64, .level_count = 1};
    facet_cube *c = bake(e, &desc);
    static float cube_values[WIDTH * WIDTH * 3], values[WIDTH * WIDTH * 3];
    sheet_ball made = {.kind = BALL_CUBE, .cube_map = c};
    sheet_ball exact = {
        .kind = BALL_IMAGE, .panorama = &e->panorama, .rotation_cos = 1.0f, .environment_scale = 1.0f};
    sheet_shade_ball(&made, WIDTH, 2, cube_values);
    sheet_shade_ball(&exact, WIDTH, 2, values);
    /* N = (u, v, ..): at 45 degrees the mirror direction is sideways */
    static const struct {
        double u, v;
        uint32_t face;
    } places[6] = {{0, 0, 4}, {0.7, 0, 0}, {-0.7, 0, 1}, {0, 0.7, 2}, {0, -0.7, 3}, {0.98, 0, 5}};
    for (int k = 0; k < 6; k++) {
        size_t x = (size_t)((places[k].u + 1.0) * 0.5 * WIDTH);
        size_t y = (size_t)((1.0 - places[k].v) * 0.5 * WIDTH);
        const float *p = values + 3 * (y * WIDTH + x);
        assert_near(p[0], 0.1 + 0.1 * places[k].face, 1e-3);
        assert_near(cube_values[3 * (y * WIDTH + x)], p[0], 0.02);
    }
    assert_true(values[0] == 0.0f && values[2] == 0.0f); /* outside */
    /* rotating the environment by a quarter turn moves +Z to +X */
    exact.rotation_cos = 0.0f;
    exact.rotation_sin = 1.0f;
    sheet_shade_ball(&exact, WIDTH, 1, values);
    assert_near(values[3 * ((WIDTH / 2) * WIDTH + (size_t)(0.85 * WIDTH))], 0.5, 1e-3);
    /* normals: the right side of a ball lit from +X alone */
    static const float right[9][3] = {{0}, {0}, {0}, {1.0f, 1.0f, 1.0f}};
    sheet_ball diffuse = {.kind = BALL_HARMONICS, .is_diffuse = true, .harmonics = right};
    sheet_shade_ball(&diffuse, WIDTH, 1, values);
    assert_near(values[3 * ((WIDTH / 2) * WIDTH + 3 * WIDTH / 4)], 0.5, 0.02);
    assert_true(values[3 * ((WIDTH / 2) * WIDTH + WIDTH / 4)] == 0.0f);
    facet_cube_destroy(c);
    facet_environment_destroy(e);
}

static void levels_are_interpolated(void **state)
{
    (void)state;
    facet_environment *e = make_environment(64, 32, faces);
    facet_cube *c = bake(e, &(facet_bake_desc){.size = 32, .level_count = 3});
    static float low[21 * 21 * 3], high[21 * 21 * 3], between[21 * 21 * 3], beyond[21 * 21 * 3];
    sheet_shade_ball(&(sheet_ball){.cube_map = c, .lod = 1.0f}, 21, 1, low);
    sheet_shade_ball(&(sheet_ball){.cube_map = c, .lod = 2.0f}, 21, 1, high);
    sheet_shade_ball(&(sheet_ball){.cube_map = c, .lod = 1.25f}, 21, 1, between);
    sheet_shade_ball(&(sheet_ball){.cube_map = c, .lod = 9.0f}, 21, 1, beyond);
    for (int k = 0; k < 21 * 21 * 3; k++)
        assert_near(between[k], 0.75f * low[k] + 0.25f * high[k], 1e-6);
    assert_memory_equal(high, beyond, sizeof high);
    facet_cube_destroy(c);
    facet_environment_destroy(e);
}

static void differences_are_rms_over_the_sphere(void **state)
{
    (void)state;
    static float a[10 * 10 * 3], b[10 * 10 * 3];
    for (int k = 0; k < 300; k++) {
        a[k] = 1.1f;
        b[k] = 1.0f;
    }
    assert_near(sheet_compare_balls(a, b, 10), 0.1, 1e-6);
    assert_true(sheet_compare_balls(b, b, 10) == 0.0);
    a[0] = 1e9f; /* corners are not part of the sphere */
    assert_near(sheet_compare_balls(a, b, 10), 0.1, 1e-6);
}

static void sheets_do_not_depend_on_threads(void **state)
{
    (void)state;
    facet_environment *e = make_environment(32, 16, faces);
    facet_bake_desc desc = {
        .lobe = FACET_LOBE_NONE, .size = 32, .rotation_rad = 0.5f, .ev = 1.0f, .clamp = 0.6f};
    facet_cube *c = bake(e, &desc);
    image a =
        draw(c, e, &(facet_sheet_desc){.bake = desc, .thread_count = 1, .tonemap = FACET_TONEMAP_NEUTRAL});
    image b =
        draw(c, e, &(facet_sheet_desc){.bake = desc, .thread_count = 3, .tonemap = FACET_TONEMAP_NEUTRAL});
    assert_int_equal(a.height, b.height);
    assert_memory_equal(a.pixels, b.pixels, image_row_size(&a) * a.height);
    image_destroy(&a);
    image_destroy(&b);
    facet_cube_destroy(c);
    facet_environment_destroy(e);
}

/* Mean sRGB value of the green channel, without the background of the sheet, of which green is 32 of 255. */
static double mean_code(const image *i)
{
    double sum = 0.0;
    double count = 0.0;
    for (size_t k = 0; k < (size_t)i->width * i->height; k++) {
        double code = srgb_encode((double)((const float *)i->pixels)[4 * k + 1]);
        bool is_background = fabs(code - 32.0 / 255.0) < 1e-4;
        sum += is_background ? 0.0 : code;
        count += is_background ? 0.0 : 1.0;
    }
    return sum / count;
}

static float strength = 1.0f;

/* A sky with a small sun. */
static void sunny(const float d[3], float out[3])
{
    float sun = d[1] > 0.98f ? 1e4f : 0.0f;
    out[0] = strength * (0.2f + sun);
    out[1] = strength * (0.5f + sun);
    out[2] = strength * (0.8f + sun);
}

/* A metered sheet is the same for light in any unit, and neither black nor white; exposure_ev comes on top. */
static void metered_sheets_are_readable(void **state)
{
    (void)state;
    static const float strengths[] = {1.0f, 65536.0f, 1.0f / 65536.0f, 0.0f};
    for (int i = 0; i < 4; i++) {
        strength = strengths[i];
        facet_environment *e = make_environment(64, 32, sunny);
        facet_bake_desc desc = {.lobe = FACET_LOBE_GGX, .size = 64, .level_count = 3};
        facet_cube *c = bake(e, &desc);
        facet_sheet_desc sheet_desc = {
            .bake = desc, .tonemap = FACET_TONEMAP_NEUTRAL, .meters_exposure = true};
        image sheet = draw(c, e, &sheet_desc);
        double mean = mean_code(&sheet);
        image_destroy(&sheet);
        sheet_desc.exposure_ev = 1.0f;
        image brighter = draw(c, e, &sheet_desc);
        if (strength > 0.0f) {
            assert_true(mean > 0.25 && mean < 0.55);
            assert_true(mean_code(&brighter) > mean + 0.03);
        } else {
            assert_true(mean < 0.2); /* black has no exposure */
        }
        image_destroy(&brighter);
        facet_cube_destroy(c);
        facet_environment_destroy(e);
    }
}

/* The opening of a lamp in a dark room. */
static void lamp(const float d[3], float out[3])
{
    out[0] = out[1] = out[2] = d[1] > 0.95f && d[0] > 0.0f ? 200.0f : 0.05f;
}

/* Small lights leave rough levels and diffuse spheres readable: 2.3 % of the pixels are white, and 4.7 % by the log average alone. */
static void small_lights_do_not_fill_the_sheet_with_white(void **state)
{
    (void)state;
    facet_environment *e = make_environment(64, 32, lamp);
    facet_bake_desc desc = {.lobe = FACET_LOBE_GGX, .size = 64, .level_count = 3};
    facet_cube *c = bake(e, &desc);
    image sheet = draw(
        c, e, &(facet_sheet_desc){.bake = desc, .tonemap = FACET_TONEMAP_NEUTRAL, .meters_exposure = true});
    size_t white = 0;
    const size_t count = (size_t)sheet.width * sheet.height;
    for (size_t k = 0; k < count; k++)
        white += ((const float *)sheet.pixels)[4 * k + 1] > 0.97f;
    print_message("%.3f of the sheet is white\n", (double)white / (double)count);
    assert_true((double)white < 0.035 * (double)count);
    image_destroy(&sheet);
    facet_cube_destroy(c);
    facet_environment_destroy(e);
}

/* Text is drawn in place, over the image. */
static void text_is_drawn_in_place(void **state)
{
    (void)state;
    image i;
    assert_int_equal(image_create(NULL, 200, 60, 4, IMAGE_F32, &i, NULL), FACET_OK);
    for (size_t k = 0; k < 200 * 60 * 4; k++)
        ((float *)i.pixels)[k] = k % 4 == 3 ? 1.0f : 0.25f;
    const sheet_word words[2] = {
        {.x = 100, .y = 40, .size = 20, .strength = 1, .align = WORD_CENTER, .text = "HI"},
        {.x = 20, .y = 50, .width = 30, .strength = 0.5f}};
    const facet_allocator allocator = {0};
    facet_error error = {0};
    facet_result result = sheet_write_words(words, 2, &allocator, &i, &error);
    if (result == FACET_ERROR_UNSUPPORTED || result == FACET_ERROR_SYSTEM) {
        print_message("there is no cairo: %s\n", error.message);
        image_destroy(&i);
        skip();
    }
    assert_int_equal(result, FACET_OK);
    float brightest = 0.0f;
    for (uint32_t y = 0; y < 60; y++)
        for (uint32_t x = 0; x < 200; x++) {
            const float *p = pixel(&i, x, y);
            bool may_change = (y == 50 && x >= 20 && x < 50) || (y > 22 && y <= 41 && x > 80 && x < 120);
            assert_true(may_change || (p[0] == 0.25f && p[1] == 0.25f));
            brightest = fmaxf(brightest, p[0]);
        }
    assert_near(brightest, 1.0, 1e-3);
    assert_near(pixel(&i, 30, 50)[0], 0.5521, 2e-3); /* half-way to white in sRGB: 0.7686 */
    image_destroy(&i);
}

static void progress_is_reported_and_can_cancel(void **state)
{
    (void)state;
    facet_environment *e = make_environment(32, 16, uniform);
    static const facet_lobe lobes[2] = {FACET_LOBE_GGX, FACET_LOBE_LAMBERT};
    for (int k = 0; k < 2; k++) {
        facet_bake_desc desc = {.lobe = lobes[k], .size = 16};
        facet_cube *c = bake(e, &desc);
        captured_progress w = {0};
        facet_sheet_desc sheet_desc = {.bake = desc, .progress = capture_progress(&w)};
        image sheet = {0};
        if (lobes[k] == FACET_LOBE_LAMBERT) {
            sheet = draw(c, e, &sheet_desc);
            assert_true(w.fraction == 1.0);
            assert_string_equal(w.stage, "sheet");
            image_destroy(&sheet);
        }
        w = (captured_progress){.stops_at = 3};
        facet_error error = {0};
        assert_int_equal(ibl_sheet_draw(c, e, &sheet_desc, &sheet, &error), FACET_ERROR_CANCELLED);
        assert_null(sheet.pixels);
        assert_true(strstr(error.message, "sheet: cancelled after 3 of ") == error.message);
        facet_cube_destroy(c);
    }
    facet_environment_destroy(e);
}

static void running_out_of_memory_leaks_nothing(void **state)
{
    (void)state;
    facet_environment *e = make_environment(32, 16, uniform);
    facet_bake_desc desc = {.lobe = FACET_LOBE_NONE, .size = 16, .clamp = 1.0f};
    facet_cube *c = bake(e, &desc);
    facet_result result = FACET_ERROR_MEMORY;
    for (long n = 0; result != FACET_OK && n < 40; n++) {
        failing_allocator failing = {.fail_at = n};
        image sheet = {0};
        facet_sheet_desc sheet_desc = {.bake = desc, .allocator = failing_allocator_get(&failing)};
        facet_error error = {0};
        result = ibl_sheet_draw(c, e, &sheet_desc, &sheet, &error);
        assert_true(result == FACET_OK || (result == FACET_ERROR_MEMORY && !sheet.pixels));
        image_destroy(&sheet);
        assert_int_equal(failing.blocks, 0);
    }
    assert_int_equal(result, FACET_OK);
    facet_cube_destroy(c);
    facet_environment_destroy(e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(uniform_light_colors_all_elements),
        cmocka_unit_test(crosses_show_upright_faces),
        cmocka_unit_test(spheres_read_the_right_directions),
        cmocka_unit_test(levels_are_interpolated),
        cmocka_unit_test(differences_are_rms_over_the_sphere),
        cmocka_unit_test(sheets_do_not_depend_on_threads),
        cmocka_unit_test(metered_sheets_are_readable),
        cmocka_unit_test(small_lights_do_not_fill_the_sheet_with_white),
        cmocka_unit_test(text_is_drawn_in_place),
        cmocka_unit_test(progress_is_reported_and_can_cancel),
        cmocka_unit_test(running_out_of_memory_leaks_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
