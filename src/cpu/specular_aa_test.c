/* specular_aa_test.c - specular anti-aliasing: lobes widened by the change of the normal over a pixel. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "cpu/preview_fixture.h"

enum { SIZE = 32 };

static const float TANGENTS[16] = {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1};

/* The normal of a ball of radius R pixels changes by 1 / R per pixel in the middle: alpha^2 grows by 1/2
 * (1 / R^2 + 1 / R^2). */
static float highlight(float perceptual_roughness, bool is_antialiased)
{
    fixture f = fixture_create();
    fixture_remove_environment(&f);
    f.desc.width = f.desc.height = 9;
    f.desc.samples = 1;
    f.desc.has_specular_antialiasing = is_antialiased;
    scene_material m = scene_material_default();
    m.perceptual_roughness = perceptual_roughness;
    fixture_place(&f, fixture_add_sphere(&f, 512, fixture_add_material(&f, m)), 0, 0, 0, 20.0f / 9.0f);
    scene_light sun = {.name = "", .type = SCENE_LIGHT_DIRECTIONAL, .color = {1, 1, 1}, .intensity = 1.0f};
    fixture_add_light(&f, sun, 0, 0, 0);
    f.camera.eye[2] = 20.0f;
    film rendered = fixture_render(&f);
    float brightness = fixture_pixel(&rendered, "", 4, 4)[0];
    film_destroy(&rendered);
    fixture_destroy(&f);
    return brightness;
}

static void highlights_of_curved_surfaces_widen(void **state)
{
    (void)state;
    float alpha = 0.3f * 0.3f;
    float widened = sqrtf(alpha * alpha + 1.0f / (10.0f * 10.0f));
    float expected = highlight(sqrtf(widened), false);
    assert_true(fabsf(highlight(0.3f, true) - expected) < 0.01f * expected);
    assert_true(highlight(0.3f, false) > 1.5f * expected);
}

static void flat_surfaces_stay_as_they_are(void **state)
{
    (void)state;
    film films[2];
    for (int i = 0; i < 2; i++) {
        fixture f = fixture_create();
        f.desc.width = f.desc.height = SIZE;
        f.desc.has_specular_antialiasing = i;
        scene_material m = scene_material_default();
        m.metallic = 0.3f;
        m.perceptual_roughness = 0.45f;
        fixture_place(&f, fixture_add_quad(&f, fixture_add_material(&f, m)), 0, 0, 0, 1.0f);
        scene_light light = {.name = "", .type = SCENE_LIGHT_POINT, .color = {1, 1, 1}, .intensity = 3.0f};
        fixture_add_light(&f, light, 0.3f, 0.1f, 1.0f);
        films[i] = fixture_render(&f);
        fixture_destroy(&f);
    }
    for (uint32_t i = 0; i < SIZE * SIZE * 4; i++)
        assert_true(fabsf(films[0].layers[0].pixels[i] - films[1].layers[0].pixels[i]) < 1e-6f);
    film_destroy(&films[0]);
    film_destroy(&films[1]);
}

/* Bumps narrower than a pixel widen the lobe. */
static void bumps_narrower_than_a_pixel_widen_the_lobe(void **state)
{
    (void)state;
    unsigned char bumps[4 * 64 * 64];
    for (uint32_t i = 0; i < 64 * 64; i++) {
        bool is_left = (i / 2) % 2;
        memcpy(bumps + 4 * i,
               is_left ? (unsigned char[4]){108, 128, 254, 255} : (unsigned char[4]){148, 128, 254, 255}, 4);
    }
    float brightness[2];
    for (int i = 0; i < 2; i++) {
        fixture f = fixture_create();
        fixture_remove_environment(&f);
        f.desc.width = f.desc.height = 33;
        f.desc.has_specular_antialiasing = i;
        scene_material m = scene_material_default();
        m.perceptual_roughness = 0.3f;
        m.textures[SCENE_NORMAL_TEXTURE].texture = fixture_add_texture(&f, 64, 64, bumps);
        f.scene->textures[0].mip_filter = SCENE_MIP_NONE;
        uint32_t mesh = fixture_add_quad(&f, fixture_add_material(&f, m));
        fixture_primitive(&f, mesh)->tangents = TANGENTS;
        fixture_place(&f, mesh, 0, 0, 0, 1.0f);
        scene_light sun = {
            .name = "", .type = SCENE_LIGHT_DIRECTIONAL, .color = {1, 1, 1}, .intensity = 1.0f};
        fixture_add_light(&f, sun, 0, 0, 0);
        film rendered = fixture_render(&f);
        brightness[i] = 0.0f;
        for (uint32_t p = 0; p < 33; p++)
            brightness[i] = fmaxf(brightness[i], fixture_pixel(&rendered, "", p, 16)[0]);
        film_destroy(&rendered);
        fixture_destroy(&f);
    }
    assert_true(brightness[1] < 0.8f * brightness[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(highlights_of_curved_surfaces_widen),
        cmocka_unit_test(flat_surfaces_stay_as_they_are),
        cmocka_unit_test(bumps_narrower_than_a_pixel_widen_the_lobe),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
