/* Tests of transmission: furnaces, Snell's law, absorption, nested volumes, colors. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "cpu/preview_fixture.h"

static const double DEGREE = 3.14159265358979 / 180.0;

static void assert_near(float value, double expected, double tolerance)
{
    if (!(fabs((double)value - expected) <= tolerance))
        fail_msg("%g instead of %g", (double)value, expected);
}

static scene_material glass(float ior)
{
    scene_material m = scene_material_default();
    m.extensions = SCENE_TRANSMISSION | SCENE_IOR;
    m.metallic = 0.0f;
    m.perceptual_roughness = 0.0f;
    m.transmission = 1.0f;
    m.ior = ior;
    return m;
}

static scene_material glass_volume(float ior)
{
    scene_material m = glass(ior);
    m.extensions |= SCENE_VOLUME;
    m.thickness = 0.1f;
    return m;
}

/* Emits (x, y, 1) mapped from [-scale, scale] m to [0, 1]: its image shows where rays went. */
static void add_ruler(fixture *f, float z, float scale)
{
    static const float colors[16] = {0, 0, 1, 1, 1, 0, 1, 1, 0, 1, 1, 1, 1, 1, 1, 1};
    scene_material m = scene_material_default();
    m.extensions = SCENE_UNLIT;
    uint32_t mesh = fixture_add_quad(f, fixture_add_material(f, m));
    fixture_primitive(f, mesh)->colors = colors;
    fixture_place(f, mesh, 0, 0, z, scale);
}

/* Two faces of a slab around the origin, turned around +Y, 2 scale m wide. */
static void add_slab(fixture *f, scene_material material, float thickness, double angle, float scale)
{
    uint32_t mesh = fixture_add_quad(f, fixture_add_material(f, material));
    for (int side = 0; side < 2; side++) {
        double turned = angle + (side ? 180.0 * DEGREE : 0.0);
        float offset = 0.5f * thickness;
        scene_node *node =
            fixture_place(f, mesh, offset * (float)sin(turned), 0.0f, offset * (float)cos(turned), scale);
        node->rotation[1] = (float)sin(0.5 * turned);
        node->rotation[3] = (float)cos(0.5 * turned);
    }
}

static float *pixel(film *rendered, uint32_t x, uint32_t y)
{
    return rendered->layers[0].pixels + 4 * ((size_t)y * rendered->width + x);
}

/* The position on the ruler, m, that the middle pixel sees; per channel of a white ruler the position that
 * is red. */
static double ruler_x(const float *rgba, double scale)
{
    return ((double)rgba[0] / (double)rgba[2] * 2.0 - 1.0) * scale;
}

/* ---- furnaces ---- */

static void glass_vanishes_in_a_constant_environment(void **state)
{
    (void)state;
    static const float roughnesses[] = {0.0f, 0.08f, 0.3f, 0.7f, 1.0f};
    for (int i = 0; i < 5; i++)
        for (int is_volume = 0; is_volume < 2; is_volume++)
            for (int quality = 0; quality < 3; quality++) {
                fixture f = fixture_create();
                f.desc.width = f.desc.height = 32;
                f.desc.energy = FACET_ENERGY_CONSERVING;
                f.desc.quality = (facet_quality)quality;
                f.desc.background = FACET_BACKGROUND_ENVIRONMENT;
                scene_material m = is_volume ? glass_volume(1.5f) : glass(1.5f);
                m.perceptual_roughness = roughnesses[i];
                fixture_place(&f, fixture_add_sphere(&f, 32, fixture_add_material(&f, m)), 0, 0, 0, 0.9f);
                film rendered = fixture_render(&f);
                for (uint32_t p = 0; p < 32 * 32; p++)
                    assert_near(rendered.layers[0].pixels[4 * p + 1], 1.0, 2.0 / 255.0);
                film_destroy(&rendered);
                fixture_destroy(&f);
            }
}

static void volumes_in_equal_volumes_are_invisible(void **state)
{
    (void)state;
    fixture f = fixture_create();
    f.desc.background = FACET_BACKGROUND_ENVIRONMENT;
    f.desc.energy = FACET_ENERGY_CONSERVING;
    static const float iors[3] = {1.5f, 1.33f, 2.4f};
    for (int i = 0; i < 3; i++)
        fixture_place(&f, fixture_add_sphere(&f, 48, fixture_add_material(&f, glass_volume(iors[i]))), 0, 0,
                      0, 0.9f - 0.25f * (float)i);
    film rendered = fixture_render(&f);
    for (uint32_t p = 0; p < 64 * 64; p++)
        assert_near(rendered.layers[0].pixels[4 * p], 1.0, 1.0 / 255.0);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

static void an_eye_in_glass_sees_out(void **state)
{
    (void)state;
    fixture f = fixture_create();
    f.camera = (facet_camera){.eye = {0.0f, 0.0f, 0.3f}, .fov_y_rad = 1.5f};
    f.desc.energy = FACET_ENERGY_CONSERVING;
    fixture_place(&f, fixture_add_sphere(&f, 64, fixture_add_material(&f, glass_volume(1.5f))), 0, 0, 0,
                  1.0f);
    film rendered = fixture_render(&f);
    for (uint32_t p = 0; p < 64 * 64; p++)
        assert_near(rendered.layers[0].pixels[4 * p], 1.0, 1.0 / 255.0);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

/* A white scattering volume loses no energy. */
static void white_scattering_loses_nothing(void **state)
{
    (void)state;
    fixture f = fixture_create();
    f.desc.energy = FACET_ENERGY_CONSERVING;
    scene_material m = glass_volume(1.3f);
    m.extensions |= SCENE_VOLUME_SCATTER;
    m.attenuation_distance = 0.3f;
    for (int c = 0; c < 3; c++) {
        m.attenuation_color[c] = 0.2f * (float)(c + 1);
        m.multiscatter_color[c] = 1.0f;
    }
    m.scatter_anisotropy = 0.4f;
    fixture_place(&f, fixture_add_sphere(&f, 48, fixture_add_material(&f, m)), 0, 0, 0, 0.9f);
    film rendered = fixture_render(&f);
    for (int c = 0; c < 3; c++)
        assert_near(pixel(&rendered, 30, 40)[c], 1.0, 1.0 / 255.0);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

/* ---- directions ---- */

/* Lateral offset, as the camera sees it, of a ray behind a slab: t sin(a - b) / cos b. */
static double slab_shift(double thickness, double angle, double ior)
{
    double b = asin(sin(angle) / ior);
    return thickness * sin(angle - b) / cos(b);
}

static void a_slab_shifts_what_is_behind_it(void **state)
{
    (void)state;
    static const double angles[] = {0.0, 20.0, 45.0, -60.0};
    static const float iors[] = {1.0f, 1.33f, 1.5f, 2.4f};
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 4; k++) {
            fixture f = fixture_create();
            fixture_remove_environment(&f);
            f.desc.width = f.desc.height = 33; /* a pixel in the middle */
            f.desc.samples = 1;                /* and its ray */
            add_ruler(&f, -3.0f, 2.0f);
            add_slab(&f, glass_volume(iors[k]), 0.4f, angles[i] * DEGREE, 4.0f);
            film rendered = fixture_render(&f);
            /* Turned to +X, the front face sends the ray to -X; internal reflection adds a little. */
            double expected = -slab_shift(0.4, angles[i] * DEGREE, (double)iors[k]);
            assert_near((float)ruler_x(pixel(&rendered, 16, 16), 2.0), expected,
                        1e-4 + 0.08 * fabs(expected) * (iors[k] > 1.0f));
            film_destroy(&rendered);
            fixture_destroy(&f);
        }
}

/* The ray through (x, 0) of a ball leaves across the axis; Snell's law twice. */
static double ball_x(double x, double ior, double z)
{
    double a = asin(x);
    double b = asin(x / ior);
    double out = a - 2.0 * (a - b); /* polar angle of the exit, behind the ball */
    double turn = 2.0 * (a - b);
    return sin(out) - tan(turn) * (-z - cos(out));
}

static void a_ball_turns_the_image_around(void **state)
{
    (void)state;
    fixture f = fixture_create();
    fixture_remove_environment(&f);
    f.camera.ortho_height = 2.0f;
    f.desc.width = f.desc.height = 64;
    add_ruler(&f, -2.0f, 4.0f);
    fixture_place(&f, fixture_add_sphere(&f, 512, fixture_add_material(&f, glass_volume(1.5f))), 0, 0, 0,
                  1.0f);
    film rendered = fixture_render(&f);
    for (uint32_t i = 20; i < 44; i += 3) {
        double x = (i + 0.5 - 32.0) / 32.0;
        double y = 0.5 / 32.0;
        double r = sqrt(x * x + y * y);
        double expected = ball_x(r, 1.5, -2.0) * x / r;
        assert_near((float)ruler_x(pixel(&rendered, i, 31), 4.0), expected, 0.03);
    }
    film_destroy(&rendered);
    fixture_destroy(&f);
}

static void thin_walls_do_not_bend(void **state)
{
    (void)state;
    fixture f = fixture_create();
    fixture_remove_environment(&f);
    f.desc.samples = 1;
    add_ruler(&f, -2.0f, 1.0f);
    scene_material m = glass(1.5f);
    m.is_double_sided = true;
    fixture_place(&f, fixture_add_sphere(&f, 64, fixture_add_material(&f, m)), 0, 0, 0, 1.0f);
    film rendered = fixture_render(&f);
    for (uint32_t i = 12; i < 52; i += 3)
        assert_near((float)ruler_x(pixel(&rendered, i, 31), 1.0), (i + 0.5 - 32.0) / 32.0, 1e-3);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

/* ---- colors ---- */

static void absorption_follows_the_real_path(void **state)
{
    (void)state;
    static const double thicknesses[] = {0.1, 0.5, 2.0};
    for (int i = 0; i < 3; i++)
        for (int is_bent = 0; is_bent < 2; is_bent++) {
            fixture f = fixture_create();
            fixture_remove_environment(&f);
            scene_material light = scene_material_default();
            light.extensions = SCENE_UNLIT;
            fixture_place(&f, fixture_add_quad(&f, fixture_add_material(&f, light)), 0, 0, -5.0f, 8.0f);
            scene_material m = glass_volume(is_bent ? 1.5f : 1.0f);
            m.attenuation_distance = 0.5f;
            m.attenuation_color[0] = 0.25f;
            m.attenuation_color[1] = 0.7f;
            m.attenuation_color[2] = 1.0f;
            double angle = is_bent ? 40.0 * DEGREE : 0.0;
            add_slab(&f, m, (float)thicknesses[i], angle, 6.0f);
            film rendered = fixture_render(&f);
            const float *p = pixel(&rendered, 32, 32);
            double path = thicknesses[i] / cos(asin(sin(angle) / (double)m.ior));
            for (int c = 0; c < 2; c++) {
                double T = pow((double)m.attenuation_color[c], path / 0.5);
                /* blue is not absorbed: it has the transmittance of the boundaries; twice through F is 0.2
                 * % */
                assert_near(p[c] / p[2], T, is_bent ? 4e-3 : 2e-4);
            }
            film_destroy(&rendered);
            fixture_destroy(&f);
        }
}

/* The base color applies at each boundary. */
static void boundaries_tint(void **state)
{
    (void)state;
    for (int is_volume = 0; is_volume < 2; is_volume++) {
        fixture f = fixture_create();
        fixture_remove_environment(&f);
        add_ruler(&f, -3.0f, 2.0f);
        scene_material m = is_volume ? glass_volume(1.0f) : glass(1.0f);
        m.base_color[2] = 0.6f;
        add_slab(&f, m, 0.2f, 0.0,
                 3.0f); /* of the thin ones only the front is double sided: back faces are culled */
        film rendered = fixture_render(&f);
        assert_near(pixel(&rendered, 32, 32)[2], is_volume ? 0.36 : 0.6, 1e-4);
        film_destroy(&rendered);
        fixture_destroy(&f);
    }
}

/* The ruler's x in all channels, or white. */
static film render_dispersive(float dispersion, facet_quality quality, bool is_white)
{
    fixture f = fixture_create();
    fixture_remove_environment(&f);
    f.desc.width = f.desc.height = 33;
    f.desc.samples = 1;
    f.desc.quality = quality;
    static const float colors[16] = {0, 0, 0, 1, 1, 1, 1, 1, 0, 0, 0, 1, 1, 1, 1, 1};
    scene_material m = scene_material_default();
    m.extensions = SCENE_UNLIT;
    uint32_t mesh = fixture_add_quad(&f, fixture_add_material(&f, m));
    fixture_primitive(&f, mesh)->colors = is_white ? NULL : colors;
    fixture_place(&f, mesh, 0, 0, -3.0f, 2.0f);
    m = glass_volume(1.5f);
    m.extensions |= dispersion >= 0.0f ? SCENE_DISPERSION : 0u;
    m.dispersion = fmaxf(dispersion, 0.0f);
    add_slab(&f, m, 0.8f, 45.0 * DEGREE, 4.0f);
    film rendered = fixture_render(&f);
    fixture_destroy(&f);
    return rendered;
}

static void no_dispersion_is_none(void **state)
{
    (void)state;
    film a = render_dispersive(-1.0f, FACET_QUALITY_NORMAL, false);
    film b = render_dispersive(0.0f, FACET_QUALITY_NORMAL, false);
    assert_memory_equal(a.layers[0].pixels, b.layers[0].pixels, 33 * 33 * 4 * sizeof(float));
    film_destroy(&a);
    film_destroy(&b);
}

/* ior -+ (ior - 1) 0.025 dispersion; each channel as if it had that ior alone. */
static void colors_part_by_their_ior(void **state)
{
    (void)state;
    const double dispersion = 4.0;
    for (int quality = 0; quality < 3; quality++) {
        film rendered = render_dispersive((float)dispersion, (facet_quality)quality, false);
        film white = render_dispersive((float)dispersion, (facet_quality)quality, true);
        for (int c = 0; c < 3; c++) {
            double ior = 1.5 + 0.5 * 0.025 * dispersion * (c - 1);
            double expected = 0.5 - slab_shift(0.8, 45.0 * DEGREE, ior) / 4.0;
            assert_near(pixel(&rendered, 16, 16)[c] / pixel(&white, 16, 16)[c], expected, 1e-3);
        }
        /* red and blue are 0.01 apart */
        assert_true(pixel(&rendered, 16, 16)[0] - pixel(&rendered, 16, 16)[2] > 0.01f);
        film_destroy(&rendered);
        film_destroy(&white);
    }
}

/* ---- surfaces behind ---- */

/* A masked and a blended quad before a ruler. */
static void add_leaves(fixture *f)
{
    static const float alphas[16] = {1, 1, 1, 0, 1, 1, 1, 1, 1, 1, 1, 0, 1, 1, 1, 1};
    scene_material leaf = scene_material_default();
    leaf.extensions = SCENE_UNLIT;
    leaf.alpha_mode = SCENE_ALPHA_MASK;
    leaf.base_color[1] = 0.0f;
    uint32_t mesh = fixture_add_quad(f, fixture_add_material(f, leaf));
    fixture_primitive(f, mesh)->colors = alphas;
    fixture_place(f, mesh, 0, 0.5f, -1.5f, 0.4f);
    leaf.alpha_mode = SCENE_ALPHA_BLEND;
    leaf.base_color[0] = 0.0f;
    mesh = fixture_add_quad(f, fixture_add_material(f, leaf));
    fixture_primitive(f, mesh)->colors = alphas;
    fixture_place(f, mesh, 0, -0.5f, -1.0f, 0.4f);
    add_ruler(f, -3.0f, 2.0f);
}

/* Glass of ior 1 facing the camera is invisible: masked, blended, culled surfaces behind it look as
 * without. */
static void all_is_seen_through_glass(void **state)
{
    (void)state;
    film films[3];
    for (int kind = 0; kind < 3; kind++) {
        fixture f = fixture_create();
        fixture_remove_environment(&f);
        f.desc.samples = 1;
        add_leaves(&f);
        scene_material m = kind == 1 ? glass(1.0f) : glass_volume(1.0f);
        if (kind)
            add_slab(&f, m, 0.3f, 0.0, 3.0f);
        films[kind] = fixture_render(&f);
        fixture_destroy(&f);
    }
    for (int kind = 1; kind < 3; kind++)
        for (uint32_t p = 0; p < 64 * 64; p++)
            for (int c = 0; c < 4; c++) {
                float bare = films[0].layers[0].pixels[4 * p + (uint32_t)c];
                float behind = films[kind].layers[0].pixels[4 * p + (uint32_t)c];
                assert_near(behind, (double)bare, 1e-4);
            }
    for (int kind = 0; kind < 3; kind++)
        film_destroy(&films[kind]);
}

/* Glass is opaque in the image, whatever is behind it. */
static void alpha_is_coverage(void **state)
{
    (void)state;
    fixture f = fixture_create();
    fixture_place(&f, fixture_add_quad(&f, fixture_add_material(&f, glass(1.5f))), 0, 0, 0, 0.5f);
    film rendered = fixture_render(&f);
    assert_true(pixel(&rendered, 32, 32)[3] == 1.0f && pixel(&rendered, 32, 32)[0] > 0.9f);
    assert_true(pixel(&rendered, 3, 3)[3] == 0.0f);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

/* A volume without far side: rays end in it, absorbed over the thickness of its material. */
static void an_open_volume_shows_the_environment(void **state)
{
    (void)state;
    fixture f = fixture_create();
    f.desc.energy = FACET_ENERGY_CONSERVING;
    scene_material m = glass_volume(1.5f);
    m.thickness = 0.4f;
    m.attenuation_distance = 0.2f;
    m.attenuation_color[0] = 0.5f;
    m.specular = 0.0f;
    /* 0.4 m, with the scale of the node 0.2 m of the distance of transmittance one half */
    fixture_place(&f, fixture_add_quad(&f, fixture_add_material(&f, m)), 0, 0, 0, 0.5f);
    film rendered = fixture_render(&f);
    assert_near(pixel(&rendered, 32, 32)[0], 0.5, 1e-3);
    assert_near(pixel(&rendered, 32, 32)[1], 1.0, 1e-3);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

/* A liquid whose surface coincides with that of its glass, and one that overlaps it, both look like an
 * exact nesting: glass, liquid, glass. */
static void liquids_touch_their_glass(void **state)
{
    (void)state;
    double seen[3];
    for (int kind = 0; kind < 3; kind++) {
        fixture f = fixture_create();
        fixture_remove_environment(&f);
        f.desc.width = f.desc.height = 33;
        add_ruler(&f, -3.0f, 2.0f);
        /* The liquid alone, or with walls of the same ior in the same places, or reaching into them by
         * 0.05. */
        double angle = 30.0 * DEGREE;
        scene_material liquid = glass_volume(1.4f);
        scene_material wall = glass_volume(1.4f);
        add_slab(&f, liquid, kind == 2 ? 0.5f : 0.4f, angle, 4.0f);
        if (kind) {
            uint32_t material = fixture_add_material(&f, wall);
            for (int side = -1; side <= 1; side += 2)
                for (int face = 0; face < 2; face++) {
                    float away = (float)side * (face ? 0.2f : 0.4f);
                    bool faces_front = face ? side < 0 : side > 0;
                    double turned = angle + (faces_front ? 0.0 : 180.0 * DEGREE);
                    scene_node *node =
                        fixture_place(&f, fixture_add_quad(&f, material), away * (float)sin(angle), 0,
                                      away * (float)cos(angle), 4.0f);
                    node->rotation[1] = (float)sin(0.5 * turned);
                    node->rotation[3] = (float)cos(0.5 * turned);
                }
        }
        film rendered = fixture_render(&f);
        seen[kind] = ruler_x(pixel(&rendered, 16, 16), 2.0);
        film_destroy(&rendered);
        fixture_destroy(&f);
    }
    assert_near((float)seen[0], -slab_shift(0.4, 30.0 * DEGREE, 1.4), 5e-3);
    for (int kind = 1; kind < 3; kind++) /* as one slab of 0.8 m */
        assert_near((float)seen[kind], -slab_shift(0.8, 30.0 * DEGREE, 1.4), 5e-3);
}

/* ---- repeatability ---- */

static void add_many_kinds(fixture *f)
{
    add_leaves(f);
    scene_material m = glass_volume(1.6f);
    m.perceptual_roughness = 0.4f;
    m.extensions |= SCENE_DISPERSION;
    m.dispersion = 2.0f;
    m.attenuation_distance = 1.0f;
    m.attenuation_color[0] = 0.5f;
    fixture_place(f, fixture_add_sphere(f, 24, fixture_add_material(f, m)), -0.4f, 0, 0, 0.5f);
    m = glass(1.5f);
    m.perceptual_roughness = 0.2f;
    fixture_place(f, fixture_add_sphere(f, 24, fixture_add_material(f, m)), 0.5f, 0.2f, 0.3f, 0.4f);
}

static void glass_is_the_same_for_all_threads_and_crops(void **state)
{
    (void)state;
    for (int quality = 0; quality < 3; quality++) {
        film whole = {0};
        for (uint32_t threads = 1; threads <= 3; threads++) {
            fixture f = fixture_create();
            add_many_kinds(&f);
            f.desc.quality = (facet_quality)quality;
            f.desc.thread_count = threads;
            film rendered = fixture_render(&f);
            if (threads == 1)
                whole = rendered;
            else
                assert_memory_equal(whole.layers[0].pixels, rendered.layers[0].pixels,
                                    64 * 64 * 4 * sizeof(float));
            if (threads > 1)
                film_destroy(&rendered);
            fixture_destroy(&f);
        }
        fixture f = fixture_create();
        add_many_kinds(&f);
        f.desc.quality = (facet_quality)quality;
        memcpy(f.desc.crop, (uint32_t[4]){21, 17, 30, 30}, sizeof f.desc.crop);
        film part = fixture_render(&f);
        for (uint32_t y = 0; y < 30; y++)
            assert_memory_equal(pixel(&part, 0, y), pixel(&whole, 21, 17 + y), 30 * 4 * sizeof(float));
        film_destroy(&part);
        film_destroy(&whole);
        fixture_destroy(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(glass_vanishes_in_a_constant_environment),
        cmocka_unit_test(volumes_in_equal_volumes_are_invisible),
        cmocka_unit_test(an_eye_in_glass_sees_out),
        cmocka_unit_test(white_scattering_loses_nothing),
        cmocka_unit_test(a_slab_shifts_what_is_behind_it),
        cmocka_unit_test(a_ball_turns_the_image_around),
        cmocka_unit_test(thin_walls_do_not_bend),
        cmocka_unit_test(absorption_follows_the_real_path),
        cmocka_unit_test(boundaries_tint),
        cmocka_unit_test(no_dispersion_is_none),
        cmocka_unit_test(colors_part_by_their_ior),
        cmocka_unit_test(all_is_seen_through_glass),
        cmocka_unit_test(alpha_is_coverage),
        cmocka_unit_test(an_open_volume_shows_the_environment),
        cmocka_unit_test(liquids_touch_their_glass),
        cmocka_unit_test(glass_is_the_same_for_all_threads_and_crops),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
