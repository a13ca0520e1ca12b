/* water_model_test.c - a sphere in and over still water: its mirror image, its shadow, what it looks like
 * below, where it keeps water out; and memory that runs out. */
#include "water/water_fixture.h"

#include "tests/support/support.h"
#include "cpu/preview_fixture.h"
#include "water/water_setup.h"

static const float black[3] = {0.0f, 0.0f, 0.0f};

/* A sphere of radius 1 that shines with 1000 cd/m^2 and reflects nothing. */
static fixture shining_sphere(float x, float y, float z)
{
    fixture f = fixture_create();
    scene_material material = scene_material_default();
    material.base_color[0] = material.base_color[1] = material.base_color[2] = 0.0f;
    material.emissive[0] = material.emissive[1] = material.emissive[2] = 1.0f;
    material.emissive_strength = 1000.0f;
    fixture_place(&f, fixture_add_sphere(&f, 96, fixture_add_material(&f, material)), x, y, z, 1.0f);
    return f;
}

static facet_sea *still_sea(void)
{
    facet_sea_desc d = sea_default();
    d.wind_mps = 0.0f;
    d.resolution = 32;
    return make_sea(&d);
}

/* In the dark, unless there is a sun. */
static void make_dark_shot(shot *s, uint32_t size, float eye_m, float down_rad, const facet_scene *scene)
{
    make_shot(s, size, size, eye_m, down_rad);
    s->scene = scene;
    s->desc.energy = (facet_energy){0};
    assert_int_equal(facet_environment_create_constant(black, NULL, &s->desc.environment, NULL), FACET_OK);
}

static void end_shot(shot *s)
{
    facet_environment_destroy(s->desc.environment);
    film_destroy(&s->film);
}

static double fresnel(double c, double n)
{
    double g = sqrt(n * n + c * c - 1.0), a = (g - c) / (g + c),
           b = (c * (g + c) - 1.0) / (c * (g - c) + 1.0);
    return 0.5 * a * a * (1.0 + b * b);
}

/* Half-way between the eye and the sphere, both 3 m over the water, it is mirrored at 45 degrees; straight
 * on it is as bright as it is. */
static void still_water_reflects_a_sphere_by_fresnel(void **state)
{
    (void)state;
    fixture f = shining_sphere(0.0f, 3.0f, -6.0f);
    facet_sea *sea = still_sea();
    shot s;
    make_dark_shot(&s, 33, 3.0f, 0.78539816f, f.scene);
    draw_shot(sea, &s);
    double F = fresnel(sqrt(0.5), (double)sea->optics.ior);
    assert_true(fabs((double)shot_pixel(&s, 16, 16)[1] / (1000.0 * F) - 1.0) < 2e-3);
    assert_true(shot_pixel(&s, 16, 32)[1] == 0.0f); /* under the eye there is but dark water */
    s.camera.target[1] = 3.0f;
    draw_shot(sea, &s);
    assert_true(fabs((double)shot_pixel(&s, 16, 16)[1] / 1000.0 - 1.0) < 2e-3);
    end_shot(&s);
    sea_destroy(sea);
    fixture_destroy(&f);
}

/* From inside of a sphere the camera sees it only if it is double-sided; a third of its opacity shows a third
 * of it. */
static void camera_rays_see_the_drawn_sides(void **state)
{
    (void)state;
    facet_sea *sea = still_sea();
    for (int k = 0; k < 3; k++) {
        fixture f = shining_sphere(0.0f, 3.0f, 0.0f);
        shot s;
        f.scene->materials[0].is_double_sided = k > 0;
        if (k == 2) {
            f.scene->materials[0].alpha_mode = SCENE_ALPHA_BLEND;
            f.scene->materials[0].base_color[3] = 1.0f / 3.0f;
        }
        make_dark_shot(&s, 9, 3.0f, -0.1f, f.scene);
        s.desc.samples = 64;
        draw_shot(sea, &s);
        double mean = 0.0;
        for (uint32_t i = 0; i < 81; i++)
            mean += (double)shot_pixel(&s, i % 9, i / 9)[1] / 81.0;
        const double expected[] = {0.0, 1000.0, 1000.0 / 3.0};
        assert_true(fabs(mean - expected[k]) <= 0.02 * expected[k]);
        end_shot(&s);
        fixture_destroy(&f);
    }
    sea_destroy(sea);
}

/* In a legacy style a model hides the water behind it, with its own light, and not the water in front of it. */
static void the_legacy_style_has_models(void **state)
{
    (void)state;
    facet_sea *sea = still_sea();
    for (int k = 0; k < 2; k++) {
        fixture f = shining_sphere(0.0f, k ? -3.0f : 0.0f, 0.0f);
        shot s;
        make_dark_shot(&s, 9, 3.0f, 1.5707963f, f.scene);
        draw_shot(sea, &s);
        float physical = shot_pixel(&s, 4, 4)[0];
        s.desc.sea_shading.style = FACET_SEA_STYLE_LEGACY_INTENDED;
        draw_shot(sea, &s);
        float with = shot_pixel(&s, 4, 4)[0];
        s.scene = NULL;
        draw_shot(sea, &s);
        float without = shot_pixel(&s, 4, 4)[0];
        assert_true(k ? with == without : with != without && with > 0.99f * physical);
        end_shot(&s);
        fixture_destroy(&f);
    }
    sea_destroy(sea);
}

/* Under water it gets darker, and red goes first. */
static void deeper_spheres_are_darker_and_lose_red_first(void **state)
{
    (void)state;
    facet_sea *sea = still_sea();
    float before[3] = {1e9f, 1e9f, 1e9f};
    for (int k = 0; k < 3; k++) {
        fixture f = shining_sphere(0.0f, -2.0f - 2.0f * (float)k, 0.0f);
        shot s;
        make_dark_shot(&s, 9, 3.0f, 1.5707963f, f.scene);
        draw_shot(sea, &s);
        const float *p = shot_pixel(&s, 4, 4);
        assert_true(p[0] > 0.0f && p[0] < p[1] && p[1] < p[2]);
        for (int i = 0; i < 3; i++) {
            assert_true(p[i] < before[i]);
            before[i] = p[i];
        }
        end_shot(&s);
        fixture_destroy(&f);
    }
    sea_destroy(sea);
}

/* The sun's image in the water goes out where the sphere is before the sun. */
static void a_sphere_blocks_the_reflection_of_the_sun(void **state)
{
    (void)state;
    facet_sea *sea = still_sea();
    fixture f = shining_sphere(
        0.0f, 10.0f,
        -14.0f); /* 4 m beyond where the ray of 45 degrees is mirrored, and as far up as that asks */
    float brightest[2];
    for (int k = 0; k < 2; k++) {
        shot s;
        make_dark_shot(&s, 33, 4.0f, 0.78539816f, k ? f.scene : NULL);
        s.camera.fov_y_rad = 0.03f;
        s.desc.sun = (facet_sun){
            .azimuth_rad = 3.14159265f, .elevation_rad = 0.78539816f, .illuminance_lux = {1e5f, 1e5f, 1e5f}};
        draw_shot(sea, &s);
        brightest[k] = scan_shot(&s, "the sun in the water");
        end_shot(&s);
    }
    double disc = 1e5 / (3.14159265358979 * 0.00465305 * 0.00465305),
           F = fresnel(sqrt(0.5), (double)sea->optics.ior);
    assert_true(fabs((double)brightest[0] / (F * disc) - 1.0) < 0.03);
    assert_true((double)brightest[1] < 1e-3 * F * disc);
    sea_destroy(sea);
    fixture_destroy(&f);
}

static void only_open_hulls_are_dry(void **state)
{
    (void)state;
    fixture f = shining_sphere(0.0f, 0.0f, 0.0f);
    facet_sea *sea = still_sea();
    shot s;
    water_setup setup;
    make_dark_shot(&s, 8, 3.0f, 0.5f, f.scene);
    s.desc.camera = &s.camera;
    assert_int_equal(
        water_setup_create(shot_in(sea, &s), f.scene, &s.desc, WATER_SETUP_ALL, &setup, &s.stats, NULL),
        FACET_OK);
    assert_true(water_model_is_dry(&setup.model, (const double[3]){0.1, 0.0, 0.2}));
    assert_false(
        water_model_is_dry(&setup.model, (const double[3]){0.9, 0.0, 0.9})); /* within the box around it */
    assert_false(water_model_is_dry(&setup.model, (const double[3]){3.0, 0.0, 0.0}));
    water_setup_destroy(&setup);
    water_cache_clear(&s.cache);
    end_shot(&s);
    sea_destroy(sea);
    fixture_destroy(&f);
}

/* Paths draw the model themselves, by textures of their own. */
static void a_model_that_is_not_shaded_decodes_opacity_only(void **state)
{
    (void)state;
    static const unsigned char texel[4] = {255, 255, 255, 128};
    facet_sea *sea = still_sea();
    for (int is_masked = 0; is_masked < 2; is_masked++) {
        fixture f = fixture_create();
        scene_material material = scene_material_default();
        material.alpha_mode = is_masked ? SCENE_ALPHA_MASK : SCENE_ALPHA_OPAQUE;
        uint32_t number = fixture_add_material(&f, material);
        uint32_t texture = fixture_add_texture(&f, 1, 1, texel);
        f.scene->materials[number].textures[SCENE_BASE_COLOR_TEXTURE].texture = texture;
        f.scene->materials[number].textures[SCENE_EMISSIVE_TEXTURE].texture =
            fixture_add_texture(&f, 1, 1, texel);
        f.scene->materials[number].emissive[0] = 1.0f;
        fixture_place(&f, fixture_add_quad(&f, number), 0.0f, 0.0f, -6.0f, 1.0f);
        for (uint32_t needs = 0; needs <= WATER_SETUP_MODEL_LIGHT; needs += WATER_SETUP_MODEL_LIGHT) {
            shot s;
            water_setup setup;
            make_dark_shot(&s, 8, 3.0f, 0.5f, f.scene);
            s.desc.camera = &s.camera;
            assert_int_equal(
                water_setup_create(shot_in(sea, &s), f.scene, &s.desc, needs, &setup, &s.stats, NULL),
                FACET_OK);
            assert_int_equal(s.stats.decoded_texels, needs ? 2 : is_masked);
            water_setup_destroy(&setup);
            water_cache_clear(&s.cache);
            end_shot(&s);
        }
        fixture_destroy(&f);
    }
    sea_destroy(sea);
}

static void running_out_of_memory_leaks_nothing(void **state)
{
    (void)state;
    fixture f = shining_sphere(0.0f, 0.0f, -6.0f);
    facet_sea_desc d = sea_default();
    d.resolution = 32;
    d.bed = (facet_sea_bed){.depth_m = 3.0f, .albedo = {0.5f, 0.5f, 0.5f}};
    facet_sea *sea = make_sea(&d);
    int refused = 0;
    for (long at = 0; at < 4000; at += 1 + at / 4) {
        failing_allocator memory = {.fail_at = at};
        shot s;
        facet_error error;
        make_dark_shot(&s, 4, 3.0f, 0.3f, f.scene);
        s.desc.allocator = failing_allocator_get(&memory);
        s.desc.aovs = FACET_AOV_OBJECT_ID | FACET_AOV_CRYPTO_MATERIAL;
        facet_result result = try_shot(sea, &s, &error);
        assert_true(result == FACET_OK || result == FACET_ERROR_MEMORY);
        refused += result == FACET_ERROR_MEMORY;
        end_shot(&s);
        assert_int_equal(atomic_load(&memory.blocks), 0);
    }
    assert_in_range(refused, 8, 100);
    sea_destroy(sea);
    fixture_destroy(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(still_water_reflects_a_sphere_by_fresnel),
        cmocka_unit_test(camera_rays_see_the_drawn_sides),
        cmocka_unit_test(the_legacy_style_has_models),
        cmocka_unit_test(deeper_spheres_are_darker_and_lose_red_first),
        cmocka_unit_test(a_sphere_blocks_the_reflection_of_the_sun),
        cmocka_unit_test(only_open_hulls_are_dry),
        cmocka_unit_test(a_model_that_is_not_shaded_decodes_opacity_only),
        cmocka_unit_test(running_out_of_memory_leaks_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
