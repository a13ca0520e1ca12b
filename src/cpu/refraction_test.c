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

/* Without environment. 33 pixels and 1 sample: a ray along the axis. */
static fixture dark_fixture(uint32_t size, uint32_t samples)
{
    fixture f = fixture_create();
    fixture_remove_environment(&f);
    f.desc.width = f.desc.height = size;
    f.desc.samples = samples;
    return f;
}

/* Renders and destroys the fixture. */
static film last_image(fixture *f)
{
    film rendered = fixture_render(f);
    fixture_destroy(f);
    return rendered;
}

/* The same; the pixel in the middle. */
static void last_pixel(fixture *f, float rgba[4])
{
    film rendered = last_image(f);
    memcpy(rgba, fixture_pixel(&rendered, "", rendered.width / 2, rendered.height / 2), 4 * sizeof *rgba);
    film_destroy(&rendered);
}

/* The same; every pixel is 1. */
static void check_furnace(fixture *f, double tolerance)
{
    film rendered = last_image(f);
    for (size_t p = 0; p < (size_t)rendered.width * rendered.height; p++)
        assert_near(rendered.layers[0].pixels[4 * p + 1], 1.0, tolerance);
    film_destroy(&rendered);
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

/* An emitter that faces +Z, 2 scale m wide; colors of its vertices, NULL: white. */
static void add_emitter(fixture *f, const float colors[16], float z, float scale)
{
    scene_material m = scene_material_default();
    m.extensions = SCENE_UNLIT;
    uint32_t mesh = fixture_add_quad(f, fixture_add_material(f, m));
    fixture_primitive(f, mesh)->colors = colors;
    fixture_place(f, mesh, 0, 0, z, scale);
}

/* Emits (x, y, 1) mapped from [-scale, scale] m to [0, 1]: its image shows where rays went. */
static void add_ruler(fixture *f, float z, float scale)
{
    static const float colors[16] = {0, 0, 1, 1, 1, 0, 1, 1, 0, 1, 1, 1, 1, 1, 1, 1};
    add_emitter(f, colors, z, scale);
}

/* Two faces of a slab, turned around +Y, 2 scale m wide; center: m from the origin along its normal. */
static void add_slab_at(fixture *f, uint32_t material, float center, float thickness, double angle,
                        float scale)
{
    uint32_t mesh = fixture_add_quad(f, material);
    for (int is_back = 0; is_back < 2; is_back++) {
        double turned = angle + (is_back ? 180.0 * DEGREE : 0.0);
        float distance = center + (is_back ? -0.5f : 0.5f) * thickness;
        scene_node *node =
            fixture_place(f, mesh, distance * (float)sin(angle), 0.0f, distance * (float)cos(angle), scale);
        node->rotation[1] = (float)sin(0.5 * turned);
        node->rotation[3] = (float)cos(0.5 * turned);
    }
}

static void add_slab(fixture *f, scene_material material, float thickness, double angle, float scale)
{
    add_slab_at(f, fixture_add_material(f, material), 0.0f, thickness, angle, scale);
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
                check_furnace(&f, 2.0 / 255.0);
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
    check_furnace(&f, 1.0 / 255.0);
}

static void an_eye_in_glass_sees_out(void **state)
{
    (void)state;
    fixture f = fixture_create();
    f.camera = (facet_camera){.eye = {0.0f, 0.0f, 0.3f}, .fov_y_rad = 1.5f};
    f.desc.energy = FACET_ENERGY_CONSERVING;
    f.desc.background = FACET_BACKGROUND_ENVIRONMENT;
    fixture_place(&f, fixture_add_sphere(&f, 64, fixture_add_material(&f, glass_volume(1.5f))), 0, 0, 0,
                  1.0f);
    check_furnace(&f, 1.0 / 255.0);
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
    film rendered = last_image(&f);
    for (int c = 0; c < 3; c++)
        assert_near(fixture_pixel(&rendered, "", 30, 40)[c], 1.0, 1.0 / 255.0);
    film_destroy(&rendered);
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
            fixture f = dark_fixture(33, 1);
            add_ruler(&f, -3.0f, 2.0f);
            add_slab(&f, glass_volume(iors[k]), 0.4f, angles[i] * DEGREE, 4.0f);
            float seen[4];
            last_pixel(&f, seen);
            /* Turned to +X, the front face sends the ray to -X; internal reflection adds a little. */
            double expected = -slab_shift(0.4, angles[i] * DEGREE, (double)iors[k]);
            assert_near((float)ruler_x(seen, 2.0), expected, 1e-4 + 0.08 * fabs(expected) * (iors[k] > 1.0f));
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
    fixture f = dark_fixture(64, 4);
    f.camera.ortho_height = 2.0f;
    add_ruler(&f, -2.0f, 4.0f);
    fixture_place(&f, fixture_add_sphere(&f, 512, fixture_add_material(&f, glass_volume(1.5f))), 0, 0, 0,
                  1.0f);
    film rendered = last_image(&f);
    for (uint32_t i = 20; i < 44; i += 3) {
        double x = (i + 0.5 - 32.0) / 32.0;
        double y = 0.5 / 32.0;
        double r = sqrt(x * x + y * y);
        double expected = ball_x(r, 1.5, -2.0) * x / r;
        assert_near((float)ruler_x(fixture_pixel(&rendered, "", i, 31), 4.0), expected, 0.03);
    }
    film_destroy(&rendered);
}

static void thin_walls_do_not_bend(void **state)
{
    (void)state;
    fixture f = dark_fixture(64, 1);
    add_ruler(&f, -2.0f, 1.0f);
    scene_material m = glass(1.5f);
    m.is_double_sided = true;
    fixture_place(&f, fixture_add_sphere(&f, 64, fixture_add_material(&f, m)), 0, 0, 0, 1.0f);
    film rendered = last_image(&f);
    for (uint32_t i = 12; i < 52; i += 3)
        assert_near((float)ruler_x(fixture_pixel(&rendered, "", i, 31), 1.0), (i + 0.5 - 32.0) / 32.0, 1e-3);
    film_destroy(&rendered);
}

/* ---- colors ---- */

static void absorption_follows_the_real_path(void **state)
{
    (void)state;
    static const double thicknesses[] = {0.1, 0.5, 2.0};
    for (int i = 0; i < 3; i++)
        for (int is_bent = 0; is_bent < 2; is_bent++) {
            fixture f = dark_fixture(64, 4);
            add_emitter(&f, NULL, -5.0f, 8.0f);
            scene_material m = glass_volume(is_bent ? 1.5f : 1.0f);
            m.attenuation_distance = 0.5f;
            m.attenuation_color[0] = 0.25f;
            m.attenuation_color[1] = 0.7f;
            m.attenuation_color[2] = 1.0f;
            double angle = is_bent ? 40.0 * DEGREE : 0.0;
            add_slab(&f, m, (float)thicknesses[i], angle, 6.0f);
            float p[4];
            last_pixel(&f, p);
            double path = thicknesses[i] / cos(asin(sin(angle) / (double)m.ior));
            for (int c = 0; c < 2; c++) {
                double T = pow((double)m.attenuation_color[c], path / 0.5);
                /* Blue is not absorbed: it has the transmittance of the boundaries. F twice is 0.2 %. */
                assert_near(p[c] / p[2], T, is_bent ? 4e-3 : 2e-4);
            }
        }
}

/* The base color applies at each boundary. */
static void boundaries_tint(void **state)
{
    (void)state;
    for (int is_volume = 0; is_volume < 2; is_volume++) {
        fixture f = dark_fixture(64, 4);
        add_ruler(&f, -3.0f, 2.0f);
        scene_material m = is_volume ? glass_volume(1.0f) : glass(1.0f);
        m.base_color[2] = 0.6f;
        add_slab(&f, m, 0.2f, 0.0, 3.0f); /* the back face of a thin wall is culled */
        float seen[4];
        last_pixel(&f, seen);
        assert_near(seen[2], is_volume ? 0.36 : 0.6, 1e-4);
    }
}

/* The ruler's x in all channels, or white. */
static film render_dispersive(float dispersion, facet_quality quality, bool is_white)
{
    fixture f = dark_fixture(33, 1);
    f.desc.quality = quality;
    static const float colors[16] = {0, 0, 0, 1, 1, 1, 1, 1, 0, 0, 0, 1, 1, 1, 1, 1};
    add_emitter(&f, is_white ? NULL : colors, -3.0f, 2.0f);
    scene_material m = glass_volume(1.5f);
    m.extensions |= dispersion >= 0.0f ? SCENE_DISPERSION : 0u;
    m.dispersion = fmaxf(dispersion, 0.0f);
    add_slab(&f, m, 0.8f, 45.0 * DEGREE, 4.0f);
    return last_image(&f);
}

static void no_dispersion_is_none(void **state)
{
    (void)state;
    film a = render_dispersive(-1.0f, FACET_QUALITY_NORMAL, false);
    film b = render_dispersive(0.0f, FACET_QUALITY_NORMAL, false);
    fixture_assert_same(&a, &b);
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
        const float *seen = fixture_pixel(&rendered, "", 16, 16);
        const float *seen_white = fixture_pixel(&white, "", 16, 16);
        for (int c = 0; c < 3; c++) {
            double ior = 1.5 + 0.5 * 0.025 * dispersion * (c - 1);
            double expected = 0.5 - slab_shift(0.8, 45.0 * DEGREE, ior) / 4.0;
            assert_near(seen[c] / seen_white[c], expected, 1e-3);
        }
        /* red and blue are 0.01 apart */
        assert_true(seen[0] - seen[2] > 0.01f);
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

/* kind: 0 the leaves alone; behind 1 a thin wall, 2 a volume of ior 1 */
static film render_leaves(int kind)
{
    fixture f = dark_fixture(64, 1);
    add_leaves(&f);
    if (kind)
        add_slab(&f, kind == 1 ? glass(1.0f) : glass_volume(1.0f), 0.3f, 0.0, 3.0f);
    return last_image(&f);
}

/* Masked, blended and culled surfaces behind glass of ior 1, which is invisible, look as without it. */
static void all_is_seen_through_glass(void **state)
{
    (void)state;
    film bare = render_leaves(0);
    for (int kind = 1; kind < 3; kind++) {
        film behind = render_leaves(kind);
        for (size_t i = 0; i < (size_t)64 * 64 * 4; i++)
            assert_near(behind.layers[0].pixels[i], (double)bare.layers[0].pixels[i], 1e-4);
        film_destroy(&behind);
    }
    film_destroy(&bare);
}

/* Glass lacks the opacity with which it shows the background: composited over light of the environment's radiance, it
 * looks as in front of the environment. Its color is kept. */
static void glass_shows_the_background(void **state)
{
    (void)state;
    for (int is_volume = 0; is_volume < 2; is_volume++) {
        fixture f = fixture_create();
        f.desc.energy = FACET_ENERGY_CONSERVING;
        scene_material m = is_volume ? glass_volume(1.5f) : glass(1.5f);
        m.base_color[0] = 0.4f;
        m.base_color[2] = 0.7f;
        fixture_place(&f, fixture_add_sphere(&f, 64, fixture_add_material(&f, m)), 0, 0, 0, 0.8f);
        f.desc.background = FACET_BACKGROUND_ENVIRONMENT;
        film around = fixture_render(&f);
        f.desc.background = FACET_BACKGROUND_TRANSPARENT;
        film clear = fixture_render(&f);
        f.desc.background = FACET_BACKGROUND_COLOR;
        f.desc.exposure_ev = 1.0f;
        for (int c = 0; c < 3; c++)
            f.desc.background_color[c] = 2.0f; /* radiance 1, exposed */
        film colored = fixture_render(&f);
        float least = 1.0f;
        for (uint32_t x = 0; x < 64; x++) {
            const float *a = fixture_pixel(&around, "", x, 30);
            const float *b = fixture_pixel(&clear, "", x, 30);
            const float *d = fixture_pixel(&colored, "", x, 30);
            for (int c = 0; c < 3; c++) {
                assert_near(b[c] + 1.0f - b[3], (double)a[c], 1e-4);
                assert_near(0.5f * d[c] + 1.0f - d[3], (double)a[c], 1e-4);
            }
            if (x > 20 && x < 44)
                least = fminf(least, b[3]);
        }
        assert_true(least > 0.4f && least < 0.95f); /* 0.4 passes once, or at each side */
        film_destroy(&around);
        film_destroy(&clear);
        film_destroy(&colored);
        fixture_destroy(&f);
    }
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
    f.desc.background = FACET_BACKGROUND_ENVIRONMENT;
    /* 0.4 m, with the scale of the node 0.2 m of the distance of transmittance one half */
    fixture_place(&f, fixture_add_quad(&f, fixture_add_material(&f, m)), 0, 0, 0, 0.5f);
    float seen[4];
    last_pixel(&f, seen);
    assert_near(seen[0], 0.5, 1e-3);
    assert_near(seen[1], 1.0, 1e-3);
}

/* A liquid of 0.4 m whose surfaces coincide with those of its glass, and one that reaches 0.05 m into it, look
 * like one slab of 0.8 m of their common ior. */
static void liquids_touch_their_glass(void **state)
{
    (void)state;
    const double angle = 30.0 * DEGREE;
    for (int kind = 0; kind < 3; kind++) {
        fixture f = dark_fixture(33, 4);
        add_ruler(&f, -3.0f, 2.0f);
        scene_material m = glass_volume(1.4f);
        add_slab(&f, m, kind == 2 ? 0.5f : 0.4f, angle, 4.0f);
        if (kind) {
            uint32_t wall = fixture_add_material(&f, m);
            add_slab_at(&f, wall, 0.3f, 0.2f, angle, 4.0f);
            add_slab_at(&f, wall, -0.3f, 0.2f, angle, 4.0f);
        }
        float seen[4];
        last_pixel(&f, seen);
        assert_near((float)ruler_x(seen, 2.0), -slab_shift(kind ? 0.8 : 0.4, angle, 1.4), 5e-3);
    }
}

/* ---- repeatability ---- */

/* crop: NULL: the whole image. */
static film render_many_kinds(facet_quality quality, uint32_t thread_count, const uint32_t crop[4])
{
    fixture f = fixture_create();
    f.desc.quality = quality;
    f.desc.thread_count = thread_count;
    if (crop)
        memcpy(f.desc.crop, crop, sizeof f.desc.crop);
    add_leaves(&f);
    scene_material m = glass_volume(1.6f);
    m.perceptual_roughness = 0.4f;
    m.extensions |= SCENE_DISPERSION;
    m.dispersion = 2.0f;
    m.attenuation_distance = 1.0f;
    m.attenuation_color[0] = 0.5f;
    fixture_place(&f, fixture_add_sphere(&f, 24, fixture_add_material(&f, m)), -0.4f, 0, 0, 0.5f);
    m = glass(1.5f);
    m.perceptual_roughness = 0.2f;
    fixture_place(&f, fixture_add_sphere(&f, 24, fixture_add_material(&f, m)), 0.5f, 0.2f, 0.3f, 0.4f);
    return last_image(&f);
}

static void glass_is_the_same_for_all_threads_and_crops(void **state)
{
    (void)state;
    static const uint32_t crop[4] = {21, 17, 30, 30};
    for (int quality = 0; quality < 3; quality++) {
        film whole = render_many_kinds((facet_quality)quality, 1, NULL);
        for (uint32_t threads = 2; threads <= 3; threads++) {
            film again = render_many_kinds((facet_quality)quality, threads, NULL);
            fixture_assert_same(&whole, &again);
            film_destroy(&again);
        }
        film part = render_many_kinds((facet_quality)quality, 2, crop);
        fixture_assert_crop(&whole, &part, crop);
        film_destroy(&part);
        film_destroy(&whole);
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
        cmocka_unit_test(glass_shows_the_background),
        cmocka_unit_test(an_open_volume_shows_the_environment),
        cmocka_unit_test(liquids_touch_their_glass),
        cmocka_unit_test(glass_is_the_same_for_all_threads_and_crops),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
