/* Tests of the preview's ambient occlusion: against closed formulas, beside occlusion textures, in crops. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "cpu/preview_fixture.h"
#include "tests/support/support.h"

static const double PI_2 = 1.57079632679489662;
enum { SIZE = 256 }; /* a pixel is 0.031 m wide */

/* Diffuse: no interface reflects. */
static scene_material matte(float albedo)
{
    scene_material m = scene_material_default();
    for (int c = 0; c < 3; c++)
        m.base_color[c] = albedo;
    m.metallic = 0.0f;
    m.perceptual_roughness = 1.0f;
    m.specular = 0.0f;
    return m;
}

/* A plane z = 0 from -8 to 8 under uniform light, seen from +Z: 8 m of it. */
static fixture plane(float albedo)
{
    fixture f = fixture_create();
    fixture_place(&f, fixture_add_quad(&f, fixture_add_material(&f, matte(albedo))), 0.0f, 0.0f, 0.0f, 8.0f);
    f.camera.eye[2] = 40.0f;
    f.camera.ortho_height = 8.0f;
    f.desc.width = f.desc.height = SIZE;
    f.desc.ambient_occlusion = FACET_AMBIENT_OCCLUSION_ON;
    return f;
}

static double place_of(uint32_t pixel)
{
    return ((double)pixel + 0.5 - 0.5 * SIZE) * 8.0 / SIZE;
}

/* The plane reflects albedo times this, for surroundings that are as bright as itself. */
static double lit(double openness, double albedo)
{
    return openness / (1.0 - albedo * (1.0 - openness));
}

/* A sphere of radius 1 that touches the plane hides (1 + d^2)^(-3/2) of the hemisphere at distance d. The error
 * is below 0.006 in the mean of squares. */
static void a_sphere_hides_its_form_factor(void **state)
{
    (void)state;
    static const float albedos[] = {0.02f, 0.5f, 0.9f};
    for (int i = 0; i < 3; i++) {
        fixture f = plane(albedos[i]);
        fixture_place(&f, fixture_add_sphere(&f, 128, 0), 0.0f, 0.0f, 1.0f, 1.0f);
        film rendered = fixture_render(&f);
        double sum = 0.0;
        double squares = 0.0;
        int count = 0;
        for (uint32_t y = 1; y < SIZE; y += 3)
            for (uint32_t x = 1; x < SIZE; x += 3) {
                double d = hypot(place_of(x), place_of(y));
                if (d < 1.2)
                    continue;
                double expected = lit(1.0 - pow(1.0 + d * d, -1.5), (double)albedos[i]);
                double off = (double)(fixture_pixel(&rendered, "", x, y)[0] / albedos[i]) - expected;
                if (fabs(off) > 0.03)
                    fail_msg("albedo %g, distance %g: off by %g", (double)albedos[i], d, off);
                sum += off;
                squares += off * off;
                count++;
            }
        assert_true(count > 1000 && fabs(sum / count) < 0.002 && squares / count < 0.006 * 0.006);
        film_destroy(&rendered);
        fixture_destroy(&f);
    }
}

/* The share of the hemisphere around +Z at distance a from the middle of the foot of a wall 2 s high and 2 s wide, by
 * the integral of cos cos' / (pi r^2) over the wall. */
static double hidden_by_wall(double a, double s)
{
    enum { STEPS = 1000 };
    double sum = 0.0;
    double step = 2.0 * s / STEPS;
    for (int i = 0; i < STEPS; i++)
        for (int k = 0; k < STEPS; k++) {
            double z = (i + 0.5) * step;
            double y = (k + 0.5) * step - s;
            double r2 = a * a + y * y + z * z;
            sum += z * a / (r2 * r2);
        }
    return sum * step * step / (2.0 * PI_2);
}

/* In the corner half of the hemisphere is hidden; farther away the integral over the wall says how much. The wall faces
 * away from its front, which hides as well. */
static void a_wall_hides_its_integral(void **state)
{
    (void)state;
    fixture f = plane(0.5f);
    scene_node *wall = fixture_place(&f, 0, 0.0f, 0.0f, 8.0f, 8.0f);
    wall->rotation[1] = wall->rotation[3] = sqrtf(0.5f);
    film rendered = fixture_render(&f);
    for (uint32_t x = SIZE / 2 + 1; x < SIZE; x += 4) {
        double mean = 0.0;
        for (uint32_t y = SIZE / 2 - 8; y < SIZE / 2 + 8; y++)
            mean += (double)fixture_pixel(&rendered, "", x, y)[0] / 0.5 / 16.0;
        double expected = lit(1.0 - hidden_by_wall(place_of(x), 8.0), 0.5);
        assert_near(mean, expected, 0.01);
    }
    film_destroy(&rendered);
    fixture_destroy(&f);
}

/* On the pale floor of a well, 8 m wide and deep, little of the sky is seen, and interreflection brightens the noise of its share.
 * Away from the walls a pixel is as bright as the mean of those 16 pixels away, but for a curvature of 0.004. */
static void dark_pale_surfaces_are_not_mottled(void **state)
{
    (void)state;
    fixture f = plane(0.73f);
    for (int i = 0; i < 4; i++) {
        const float side = i % 2 ? 4.0f : -4.0f;
        scene_node *wall = fixture_place(&f, 0, i / 2 ? side : 0.0f, i / 2 ? 0.0f : side, 4.0f, 4.0f);
        wall->rotation[i / 2] = wall->rotation[3] = sqrtf(0.5f);
    }
    film rendered = fixture_render(&f);
    double squares = 0.0;
    double sum = 0.0;
    int count = 0;
    for (uint32_t y = 48; y < SIZE - 48; y++)
        for (uint32_t x = 48; x < SIZE - 48; x++, count++) {
            float around =
                fixture_pixel(&rendered, "", x - 16, y)[0] + fixture_pixel(&rendered, "", x + 16, y)[0] +
                fixture_pixel(&rendered, "", x, y - 16)[0] + fixture_pixel(&rendered, "", x, y + 16)[0];
            double off = (double)(fixture_pixel(&rendered, "", x, y)[0] - 0.25f * around);
            squares += off * off;
            sum += (double)fixture_pixel(&rendered, "", x, y)[0];
        }
    print_message("deviation %.4f of the mean, %.3f\n", sqrt(squares / count) / (sum / count), sum / count);
    assert_true(sqrt(squares / count) < 0.008 * sum / count);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

/* Both are the occlusion of one place: the darker counts, and the texture alone where the model hides nothing. */
static void a_texture_counts_once(void **state)
{
    (void)state;
    static const unsigned char texels[] = {64, 64, 64, 255};
    for (int has_texture = 0; has_texture < 2; has_texture++) {
        fixture f = plane(0.02f);
        fixture_place(&f, fixture_add_sphere(&f, 128, fixture_add_material(&f, matte(0.02f))), 0.0f, 0.0f,
                      1.0f, 1.0f);
        if (has_texture)
            f.scene->materials[0].textures[SCENE_OCCLUSION_TEXTURE].texture =
                fixture_add_texture(&f, 1, 1, texels);
        film rendered = fixture_render(&f);
        double texture = has_texture ? 64.0 / 255.0 : 1.0;
        for (uint32_t x = SIZE / 2 + 36; x < SIZE; x++) {
            double d = hypot(place_of(x), place_of(SIZE / 2));
            double expected = fmin(texture, lit(1.0 - pow(1.0 + d * d, -1.5), 0.02));
            assert_near(fixture_pixel(&rendered, "", x, SIZE / 2)[0] / 0.02f, expected, 0.03);
        }
        film_destroy(&rendered);
        fixture_destroy(&f);
    }
}

/* White surfaces in uniform light are as bright as the light, whatever they hide from each other. */
static void a_white_furnace_stays_white(void **state)
{
    (void)state;
    fixture f = plane(1.0f);
    fixture_place(&f, fixture_add_sphere(&f, 64, 0), 0.0f, 0.0f, 1.0f, 1.0f);
    film rendered = fixture_render(&f);
    for (uint32_t y = 0; y < SIZE; y += 3)
        for (uint32_t x = 0; x < SIZE; x += 3)
            assert_near(fixture_pixel(&rendered, "", x, y)[0], 1.0, 1e-3);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

/* A convex surface alone hides nothing: its smooth normals lean away from its triangles. */
static void a_sphere_alone_is_not_dimmed(void **state)
{
    (void)state;
    film images[2];
    for (int i = 0; i < 2; i++) {
        fixture f = fixture_create();
        fixture_place(&f, fixture_add_sphere(&f, 12, fixture_add_material(&f, matte(0.5f))), 0.0f, 0.0f, 0.0f,
                      0.8f);
        f.desc.ambient_occlusion = i ? FACET_AMBIENT_OCCLUSION_ON : FACET_AMBIENT_OCCLUSION_OFF;
        images[i] = fixture_render(&f);
        fixture_destroy(&f);
    }
    fixture_assert_same(&images[0], &images[1]);
    film_destroy(&images[0]);
    film_destroy(&images[1]);
}

/* Reflections and punctual lights are left as they are. */
static void only_diffuse_light_of_the_environment_is_dimmed(void **state)
{
    (void)state;
    film images[2];
    for (int i = 0; i < 2; i++) {
        fixture f = plane(0.0f); /* black below its interface */
        f.scene->materials[0].specular = 1.0f;
        f.scene->materials[0].perceptual_roughness = 0.0f; /* no scattering between facets */
        fixture_place(&f, fixture_add_sphere(&f, 32, 0), 0.0f, 0.0f, 1.0f, 1.0f);
        f.desc.sun = (facet_sun){.elevation_rad = 0.5f, .illuminance_lux = {1, 1, 1}};
        f.desc.ambient_occlusion = i ? FACET_AMBIENT_OCCLUSION_ON : FACET_AMBIENT_OCCLUSION_OFF;
        images[i] = fixture_render(&f);
        fixture_destroy(&f);
    }
    for (uint32_t y = 0; y < SIZE; y++)
        for (uint32_t x = 0; x < SIZE; x++)
            assert_near(fixture_pixel(&images[0], "", x, y)[0], fixture_pixel(&images[1], "", x, y)[0], 1e-4);
    film_destroy(&images[0]);
    film_destroy(&images[1]);
}

static void a_crop_has_the_pixels_of_the_image_whatever_the_threads(void **state)
{
    (void)state;
    fixture f = plane(0.5f);
    fixture_place(&f, fixture_add_sphere(&f, 64, 0), 0.0f, 0.0f, 1.0f, 1.0f);
    f.desc.thread_count = 1;
    film whole = fixture_render(&f);
    const uint32_t crop[4] = {29, 30, 41, 37};
    memcpy(f.desc.crop, crop, sizeof crop);
    f.desc.thread_count = 5;
    film part = fixture_render(&f);
    fixture_assert_crop(&whole, &part, crop);
    film_destroy(&part);
    film_destroy(&whole);
    fixture_destroy(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sphere_hides_its_form_factor),
        cmocka_unit_test(a_wall_hides_its_integral),
        cmocka_unit_test(dark_pale_surfaces_are_not_mottled),
        cmocka_unit_test(a_texture_counts_once),
        cmocka_unit_test(a_white_furnace_stays_white),
        cmocka_unit_test(a_sphere_alone_is_not_dimmed),
        cmocka_unit_test(only_diffuse_light_of_the_environment_is_dimmed),
        cmocka_unit_test(a_crop_has_the_pixels_of_the_image_whatever_the_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
