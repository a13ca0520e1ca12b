/* gl_shadow_test.c - shadow maps: where the shadow of a square falls for each kind of light, what casts
 * none, no self-shadowing; and the ground's shadow against the form factor of a rectangle. Exits with 77
 * where there is no OpenGL. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "gl/scene/gl_fixture_test.h"

static gl_fixture_contexts contexts;

enum { SIZE = 256 };
static const float PIXEL_M = 2.0f / SIZE; /* the camera looks along -z at 2 m */

/* White and diffuse, without a specular lobe. */
static scene_material matte_material(void)
{
    scene_material m = scene_material_default();
    m.metallic = 0.0f;
    return m;
}

/* A white wall of 8 m at z = 0 and, optionally, a square of 0.5 m at z = 1; no light but the test's. */
static fixture wall_fixture(bool has_square)
{
    fixture f = fixture_create();
    f.desc.width = f.desc.height = SIZE;
    f.desc.samples = 1;
    f.desc.environment_ev = -60.0f;
    scene_material matte = matte_material();
    uint32_t quad = fixture_add_quad(&f, fixture_add_material(&f, matte));
    fixture_place(&f, quad, 0.0f, 0.0f, 0.0f, 4.0f);
    if (has_square)
        fixture_place(&f, quad, 0.0f, 0.0f, 1.0f, 0.25f);
    return f;
}

static scene_light make_light(scene_light_type type)
{
    return (scene_light){.type = type,
                         .color = {1.0f, 1.0f, 1.0f},
                         .intensity = 30.0f,
                         .inner_cone_rad = 0.4f,
                         .outer_cone_rad = 0.5f};
}

/* Visibility of the light: the image with shadows over that without. -1: unlit. */
typedef struct shares {
    float at[SIZE][SIZE]; /* rows from the top */
} shares;

static shares image;

static void find_shares_by(fixture *f, gl_renderer *renderer)
{
    f->desc.gl.has_shadows = false;
    film open = gl_fixture_draw(f, renderer);
    f->desc.gl.has_shadows = true;
    film shadowed = gl_fixture_draw(f, renderer);
    for (uint32_t y = 0; y < SIZE; y++)
        for (uint32_t x = 0; x < SIZE; x++) {
            float without = fixture_pixel(&open, "", x, y)[1];
            image.at[y][x] = without > 1e-4f ? fixture_pixel(&shadowed, "", x, y)[1] / without : -1.0f;
        }
    film_destroy(&open);
    film_destroy(&shadowed);
}

static void find_shares(fixture *f, gl_context *context)
{
    gl_renderer *renderer = gl_fixture_renderer(f, context);
    find_shares_by(f, renderer);
    gl_renderer_destroy(renderer);
}

static uint32_t column_of(float x_m)
{
    return (uint32_t)(x_m / PIXEL_M + 0.5f * SIZE);
}

static uint32_t row_of(float y_m)
{
    return (uint32_t)(0.5f * SIZE - y_m / PIXEL_M);
}

/* Position (m) of a shadow's edge along a row or column, from dark to light: where an edge without width
 * would pass as much light. */
static float edge_along(bool is_row, float across_m, float dark_m, float light_m)
{
    float step = light_m > dark_m ? 1.0f : -1.0f;
    float dark = 0.0f;
    int count = (int)(fabsf(light_m - dark_m) / PIXEL_M);
    uint32_t first = is_row ? column_of(dark_m) : row_of(dark_m);
    for (int i = 0; i < count; i++) {
        uint32_t at = is_row ? first + (uint32_t)(i * (int)step) : first - (uint32_t)(i * (int)step);
        float share = is_row ? image.at[row_of(across_m)][at] : image.at[at][column_of(across_m)];
        if (i == 0)
            assert_near(share, 0.0f, 1e-6f);
        if (i == count - 1)
            assert_near(share, 1.0f, 1e-5f);
        dark += 1.0f - share;
    }
    /* From the near border of the first pixel. */
    float border = is_row ? ((float)first - 0.5f * SIZE) * PIXEL_M : (0.5f * SIZE - (float)first) * PIXEL_M;
    if (is_row && step < 0.0f)
        border += PIXEL_M;
    if (!is_row && step > 0.0f)
        border -= PIXEL_M;
    return border + step * dark * PIXEL_M;
}

/* A light 3 m before the wall and 2 m before the square enlarges its shadow 1.5 times. Texels are 2 * 3 m
 * / 1357 and 2 * 3 m tan(0.5) / 2040 wide; pixels 7.8 mm, and a sum over an edge resolves a tenth of one. */
static void shadow_edges_of_lights_match_geometry(void **state)
{
    (void)state;
    for (int i = 0; i < contexts.count; i++)
        for (int is_spot = 0; is_spot < 2; is_spot++) {
            fixture f = wall_fixture(true);
            fixture_add_light(&f, make_light(is_spot ? SCENE_LIGHT_SPOT : SCENE_LIGHT_POINT), 0.0f, 0.0f,
                              3.0f);
            find_shares(&f, &contexts.items[i]);
            float texel = is_spot ? 6.0f * tanf(0.5f) / 2040.0f : 6.0f / 1357.0f;
            float tolerance = texel + 0.1f * PIXEL_M;
            assert_near(edge_along(true, 0.0f, 0.3f, 0.45f), 0.375f, tolerance);
            assert_near(edge_along(true, 0.1f, -0.3f, -0.45f), -0.375f, tolerance);
            assert_near(edge_along(false, 0.0f, 0.3f, 0.45f), 0.375f, tolerance);
            assert_near(edge_along(false, -0.1f, -0.3f, -0.45f), -0.375f, tolerance);
            fixture_destroy(&f);
        }
}

/* A sun 0.5 rad above the horizon moves the square's shadow tan(0.5) m down; a texel is 8 m / 2040. */
static void shadow_edges_of_the_sun_match_geometry(void **state)
{
    (void)state;
    fixture f = wall_fixture(true);
    f.desc.sun = (facet_sun){.elevation_rad = 0.5f, .illuminance_lux = {3.0f, 3.0f, 3.0f}};
    find_shares(&f, &contexts.items[0]);
    float middle = -tanf(0.5f);
    float tolerance = 8.0f * 1.1f / 2040.0f + 0.1f * PIXEL_M;
    assert_near(edge_along(true, middle, 0.15f, 0.35f), 0.25f, tolerance);
    assert_near(edge_along(true, middle, -0.15f, -0.35f), -0.25f, tolerance);
    assert_near(edge_along(false, 0.0f, middle - 0.15f, middle - 0.35f), middle - 0.25f, tolerance);
    fixture_destroy(&f);
}

/* The wall, and a sphere of flat triangles, at any angle of the light. */
static void surfaces_do_not_shadow_themselves(void **state)
{
    (void)state;
    fixture f = wall_fixture(false);
    gl_renderer *renderer = gl_fixture_renderer(&f, &contexts.items[0]);
    for (int degrees = 0; degrees < 90; degrees += 22) {
        f.desc.sun =
            (facet_sun){.azimuth_rad = (float)degrees * 0.01745329f, .illuminance_lux = {3.0f, 3.0f, 3.0f}};
        find_shares_by(&f, renderer);
        for (uint32_t y = 0; y < SIZE; y++)
            for (uint32_t x = 0; x < SIZE; x++)
                assert_near(image.at[y][x], 1.0f, 1e-5f);
    }
    gl_renderer_destroy(renderer);
    fixture_destroy(&f);
}

static void spheres_are_lit_up_to_the_terminator(void **state)
{
    (void)state;
    enum { COLUMNS = 64 };
    fixture f = fixture_create();
    f.desc.width = f.desc.height = SIZE;
    f.desc.environment_ev = -60.0f;
    f.camera.ortho_height = 2.2f;
    scene_material matte = matte_material();
    fixture_place(&f, fixture_add_sphere(&f, COLUMNS, fixture_add_material(&f, matte)), 0.0f, 0.0f, 0.0f,
                  1.0f);
    f.desc.sun =
        (facet_sun){.azimuth_rad = 1.0f, .elevation_rad = 0.3f, .illuminance_lux = {3.0f, 3.0f, 3.0f}};
    find_shares(&f, &contexts.items[0]);
    const float L[3] = {cosf(0.3f) * sinf(1.0f), sinf(0.3f), cosf(0.3f) * cosf(1.0f)};
    for (uint32_t y = 0; y < SIZE; y++)
        for (uint32_t x = 0; x < SIZE; x++) {
            float px = ((float)x + 0.5f - 0.5f * SIZE) * 2.2f / SIZE,
                  py = (0.5f * SIZE - (float)y - 0.5f) * 2.2f / SIZE;
            float z2 = 1.0f - px * px - py * py;
            if (z2 < 0.02f)
                continue;
            /* Normals of neighboring triangles differ by 360 / 64 degrees: at least one behind the terminator
             * shadows itself. */
            if (px * L[0] + py * L[1] + sqrtf(z2) * L[2] > 0.1f)
                assert_near(image.at[y][x], 1.0f, 1e-5f);
        }
    fixture_destroy(&f);
}

/* A square that stands on the wall, lit at 45 degrees: its shadow begins at its foot and is as long as it
 * is high. */
static void shadows_begin_at_the_contact(void **state)
{
    (void)state;
    fixture f = wall_fixture(false);
    scene_material matte = matte_material();
    matte.is_double_sided = true;
    scene_node *node =
        fixture_place(&f, fixture_add_quad(&f, fixture_add_material(&f, matte)), 0.0f, 0.0f, 0.25f, 0.25f);
    gl_fixture_turn(node, 0.0f, 0.70710678f, 0.0f, 0.70710678f);
    f.desc.sun = (facet_sun){.azimuth_rad = 0.78539816f, .illuminance_lux = {3.0f, 3.0f, 3.0f}};
    find_shares(&f, &contexts.items[0]);
    float texel = 8.0f / 2040.0f, dark = 0.0f;
    for (uint32_t x = column_of(-0.7f); x < column_of(0.3f); x++)
        dark += (1.0f - image.at[row_of(0.05f)][x]) * PIXEL_M;
    /* The point is raised by up to 3 sqrt(2) sin(45) + 0.1 texels, which shortens the shadow, and moved
     * towards the light by 1.5 sin(45) across the wall, which delays its beginning. */
    assert_near(dark, 0.5f, 4.2f * texel);
    assert_near(edge_along(true, 0.05f, -0.4f, -0.6f), -0.5f, 3.2f * texel);
    assert_near(image.at[row_of(0.05f)][column_of(-4.0f * texel)], 0.0f, 1e-6f);
    fixture_destroy(&f);
}

/* One of two texels is transparent; between their centers alpha crosses the cutoff in the middle of the
 * square. */
static void masked_texels_cast_and_blended_surfaces_do_not(void **state)
{
    (void)state;
    static const unsigned char texels[] = {255, 255, 255, 255, 255, 255, 255, 0};
    for (int is_blended = 0; is_blended < 2; is_blended++) {
        fixture f = wall_fixture(false);
        scene_material m = matte_material();
        m.alpha_mode = is_blended ? SCENE_ALPHA_BLEND : SCENE_ALPHA_MASK;
        m.textures[SCENE_BASE_COLOR_TEXTURE].texture = fixture_add_texture(&f, 2, 1, texels);
        fixture_place(&f, fixture_add_quad(&f, fixture_add_material(&f, m)), 0.0f, 0.0f, 1.0f, 0.25f);
        fixture_add_light(&f, make_light(SCENE_LIGHT_SPOT), 0.0f, 0.0f, 3.0f);
        find_shares(&f, &contexts.items[0]);
        float texel = 6.0f * tanf(0.5f) / 2040.0f;
        assert_near(image.at[row_of(0.0f)][column_of(0.3f)], 1.0f, 1e-5f);
        if (is_blended)
            assert_near(image.at[row_of(0.0f)][column_of(-0.3f)], 1.0f, 1e-5f);
        else
            assert_near(edge_along(true, 0.0f, -0.3f, -0.45f), -0.375f, texel + 0.1f * PIXEL_M);
        fixture_destroy(&f);
    }
}

/* ---- selection of lights ---- */

typedef struct warnings {
    int count;
    char last[200];
} warnings;

static void note_warning(void *user, facet_log_level level, const char *message)
{
    warnings *w = user;
    if (level != FACET_LOG_LEVEL_WARNING || !strstr(message, "shadows: "))
        return;
    w->count++;
    snprintf(w->last, sizeof w->last, "%s", message);
}

/* 50 point lights need 300 tiles; the map has 256. The last light is the brightest. */
static void too_many_lights_are_reported_once(void **state)
{
    (void)state;
    fixture f = wall_fixture(true);
    warnings seen = {0};
    f.desc.log = (facet_log){.message = note_warning, .user = &seen};
    f.desc.gl.has_shadows = true;
    f.desc.width = f.desc.height = 32;
    for (int i = 0; i < 50; i++) {
        scene_light l = make_light(SCENE_LIGHT_POINT);
        l.intensity = i == 49 ? 1e6f : 1e-3f * (float)(50 - i);
        fixture_add_light(&f, l, 0.0f, 0.0f, 3.0f + 0.01f * (float)i);
    }
    gl_renderer *renderer = gl_fixture_renderer(&f, &contexts.items[0]);
    film a = gl_fixture_draw(&f, renderer), b = gl_fixture_draw(&f, renderer);
    assert_int_equal(seen.count, 1);
    assert_string_equal(seen.last,
                        "shadows: 8 of 50 lights cast none; the shadow map has room for the 42 brightest");
    /* (0.28, 0) is in the shadow of the brightest light, a few of its large texels from the edge. */
    assert_true(fixture_pixel(&a, "", 20, 16)[1] < 0.1f * fixture_pixel(&a, "", 28, 16)[1]);
    assert_memory_equal(a.layers[0].pixels, b.layers[0].pixels, 32 * 32 * 4 * sizeof(float));
    film_destroy(&a);
    film_destroy(&b);
    gl_renderer_destroy(renderer);
    fixture_destroy(&f);
}

/* A renderer that has drawn shadows draws the image without them as a fresh one does. */
static void turning_shadows_off_leaves_no_trace(void **state)
{
    (void)state;
    fixture f = wall_fixture(true);
    f.desc.width = f.desc.height = 32;
    fixture_add_light(&f, make_light(SCENE_LIGHT_POINT), 0.3f, 0.0f, 3.0f);
    film fresh = gl_fixture_render(&f, &contexts.items[0]);
    gl_renderer *renderer = gl_fixture_renderer(&f, &contexts.items[0]);
    f.desc.gl.has_shadows = true;
    film shadowed = gl_fixture_draw(&f, renderer);
    f.desc.gl.has_shadows = false;
    film again = gl_fixture_draw(&f, renderer);
    size_t size = 32 * 32 * 4 * sizeof(float);
    assert_memory_equal(fresh.layers[0].pixels, again.layers[0].pixels, size);
    assert_memory_not_equal(fresh.layers[0].pixels, shadowed.layers[0].pixels, size);
    film_destroy(&fresh);
    film_destroy(&shadowed);
    film_destroy(&again);
    gl_renderer_destroy(renderer);
    fixture_destroy(&f);
}

/* ---- the ground ---- */

/* Form factor of a surface element to a parallel rectangle of x by y, with a corner above it at distance 1.
 * Hamilton and Morgan 1952. */
static float corner_factor(float x, float y)
{
    float a = sqrtf(1.0f + x * x), b = sqrtf(1.0f + y * y);
    return (x / a * atanf(y / a) + y / b * atanf(x / b)) / (2.0f * 3.14159265f);
}

/* Opacity of the ground at (x, -0.5, 0), seen at 30 degrees from above (or from below). */
static float ground_at(fixture *f, gl_renderer *renderer, float x, float elevation)
{
    f->camera.eye[0] = f->camera.target[0] = x;
    f->camera.target[1] = -0.5f;
    f->camera.eye[1] = -0.5f + 10.0f * sinf(elevation);
    f->camera.eye[2] = 10.0f * cosf(elevation);
    film p = gl_fixture_draw(f, renderer);
    const float *rgba = fixture_pixel(&p, "", 4, 4);
    float opacity = rgba[3];
    for (int c = 0; c < 3; c++)
        assert_near(rgba[c], 0.0f, 1e-6f);
    film_destroy(&p);
    return opacity;
}

/* A plate of 0.5 m hangs 0.5 m above the ground, whose height is given by a speck far away. */
static void ground_occlusion_equals_the_hidden_solid_angle(void **state)
{
    (void)state;
    for (int i = 0; i < contexts.count; i++) {
        fixture f = fixture_create();
        f.desc.width = f.desc.height = 8;
        f.desc.ground = FACET_GROUND_SHADOW;
        f.camera.ortho_height = 0.02f;
        scene_material m = {
            .perceptual_roughness = 1.0f, .base_color = {0.8f, 0.8f, 0.8f, 1.0f}, .ior = 1.5f};
        uint32_t quad = fixture_add_quad(&f, fixture_add_material(&f, m));
        scene_node *plate = fixture_place(&f, quad, 0.0f, 0.0f, 0.0f, 0.25f);
        gl_fixture_turn(plate, -0.70710678f, 0.0f, 0.0f, 0.70710678f);
        fixture_place(&f, quad, -0.6f, -0.499f, 0.0f, 0.001f);
        gl_renderer *renderer = gl_fixture_renderer(&f, &contexts.items[i]);
        float middle = 4.0f * corner_factor(0.5f, 0.5f);
        float beside = 2.0f * (corner_factor(1.5f, 0.5f) - corner_factor(0.5f, 0.5f));
        assert_near(ground_at(&f, renderer, 0.0f, 0.52f), middle, 0.02f);
        assert_near(ground_at(&f, renderer, 0.5f, 0.52f), beside, 0.015f);
        assert_near(ground_at(&f, renderer, 5.0f, 0.52f), 0.0f, 1e-6f);
        assert_near(ground_at(&f, renderer, 0.0f, -0.52f), 0.0f, 1e-6f);
        gl_renderer_destroy(renderer);
        fixture_destroy(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shadow_edges_of_lights_match_geometry),
        cmocka_unit_test(shadow_edges_of_the_sun_match_geometry),
        cmocka_unit_test(surfaces_do_not_shadow_themselves),
        cmocka_unit_test(spheres_are_lit_up_to_the_terminator),
        cmocka_unit_test(shadows_begin_at_the_contact),
        cmocka_unit_test(masked_texels_cast_and_blended_surfaces_do_not),
        cmocka_unit_test(too_many_lights_are_reported_once),
        cmocka_unit_test(turning_shadows_off_leaves_no_trace),
        cmocka_unit_test(ground_occlusion_equals_the_hidden_solid_angle),
    };
    if (gl_fixture_open(&contexts) == 0)
        return 77;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    gl_fixture_close(&contexts);
    return failed;
}
