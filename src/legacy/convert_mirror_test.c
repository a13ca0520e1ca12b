/* convert_mirror_test.c - illum 3, 5, 7 and 8: Ks as a reflectance if mirrors are enabled, and the notes
 * if not. */
#include "legacy/convert_test_support.h"

#include <math.h>

static const facet_legacy_desc PLAIN = {0};
static const facet_legacy_desc MIRRORS = {.has_mirrors = true};

/* The sphere of CornellBox-Sphere, in linear light. */
static legacy_material mirror(void)
{
    legacy_material m = legacy_material_default();
    m.fields = LEGACY_DIFFUSE | LEGACY_SPECULAR | LEGACY_SHININESS | LEGACY_ILLUM;
    set_color(m.diffuse, .01f, .01f, .01f);
    set_color(m.specular, .95f, .94f, .9f);
    m.shininess = 1000;
    m.illum = 5;
    return m;
}

static void a_mirror_without_color_is_a_metal(void **state)
{
    (void)state;
    facet_scene *scene = convert_one(mirror(), &MIRRORS);
    const scene_material *m = &scene->materials[0];
    const facet_conversion *c = &scene->conversion->materials[0].summary;
    assert_int_equal(m->extensions, 0); /* visible in viewers without extensions */
    assert_near(m->metallic, 1, 0);
    assert_color(m->base_color, .95f, .94f, .9f, 1e-6);
    assert_near(m->perceptual_roughness, 0, 0);
    assert_true(isnan(c->error) && isnan(c->error_display));
    assert_string_equal(c->method, "closed");
    assert_false(has_warning(scene, 0, "mirror-ignored"));
    /* The reverse: the originals are known, and a mirror has no highlight to compare. */
    convert_to(scene, FACET_MATERIAL_MODEL_OGL1, &PLAIN);
    assert_string_equal(scene->conversion->materials[0].summary.method, "source");
    assert_true(!(scene->conversion->materials[0].summary.error > 0));
    assert_near(scene->legacy->materials[0].specular[0], .95, 1e-6);
    assert_int_equal(scene->legacy->materials[0].illum, 5);
    scene_destroy(scene);
}

/* F0 of the scene's material 0. */
static float reflectance(const facet_scene *scene, int k)
{
    const scene_material *m = &scene->materials[0];
    assert_near(m->ior, 0, 0);
    return m->specular * m->specular_color[k];
}

static void light_that_a_mirror_does_not_reflect_is_diffuse(void **state)
{
    (void)state;
    legacy_material in = mirror();
    const int illums[] = {3, 5, 7, 8};
    set_color(in.diffuse, .3f, .2f, .1f);
    set_color(in.specular, .5f, .4f, .2f);
    for (int i = 0; i < 4; i++) {
        in.illum = illums[i];
        facet_scene *scene = convert_one(in, &MIRRORS);
        const scene_material *m = &scene->materials[0];
        assert_int_equal(m->extensions, SCENE_SPECULAR | SCENE_IOR);
        assert_near(m->metallic, 0, 0);
        for (int k = 0; k < 3; k++) {
            assert_near(reflectance(scene, k), in.specular[k], 1e-6);
            /* glTF weights the base color with 1 - max(F0). */
            assert_near(m->base_color[k] * (1 - .5f), in.diffuse[k], 1e-6);
        }
        /* Fresnel applies to 5 and 7. */
        assert_near(m->specular, in.illum == 5 || in.illum == 7 ? 1 : .5, 1e-6);
        assert_false(has_warning(scene, 0, "energy-gain"));
        scene_destroy(scene);
    }
}

/* No surface reflects more than it receives: the color is reduced, its hue kept. */
static void reflectances_sum_to_at_most_one(void **state)
{
    (void)state;
    legacy_material in = mirror();
    set_color(in.diffuse, .8f, .4f, .2f);
    set_color(in.specular, 1.5f, .9f, .9f);
    facet_scene *scene = convert_one(in, &MIRRORS);
    const scene_material *m = &scene->materials[0];
    assert_near(reflectance(scene, 0), 1, 0);
    assert_color(m->base_color, 1, .5f, .25f, 1e-6);
    assert_true(has_warning(scene, 0, "energy-gain"));
    scene_destroy(scene);
}

static void large_exponents_are_smooth(void **state)
{
    (void)state;
    const float exponents[] = {5, 20, 60, 100, 150, 300, 499};
    legacy_material in = mirror();
    float last = 2;
    for (size_t i = 0; i < sizeof exponents / sizeof *exponents; i++) {
        in.shininess = exponents[i];
        facet_scene *scene = convert_one(in, &MIRRORS);
        float roughness = scene->materials[0].perceptual_roughness;
        assert_true(roughness < last && roughness > 0);
        if (exponents[i] <= 100)
            assert_near(roughness, perceptual_roughness_from_shininess(exponents[i]), 1e-6);
        last = roughness;
        scene_destroy(scene);
    }
    assert_true(last < .01f); /* no step at 500 */
    for (int stated = 0; stated < 2; stated++) {
        in.shininess = 500;
        in.fields = stated ? in.fields : in.fields & ~(uint32_t)LEGACY_SHININESS;
        facet_scene *scene = convert_one(in, &MIRRORS);
        assert_near(scene->materials[0].perceptual_roughness, 0, 0);
        scene_destroy(scene);
        in.fields |= LEGACY_SHININESS;
    }
}

static void mirrors_without_extensions_are_approximated(void **state)
{
    (void)state;
    legacy_material in = mirror();
    set_color(in.diffuse, .05f, .05f, .05f);
    set_color(in.specular, .8f, .6f, .4f);
    facet_scene *scene =
        convert_one(in, &(facet_legacy_desc){.has_mirrors = true, .profile = FACET_LEGACY_PROFILE_CORE});
    const scene_material *m = &scene->materials[0];
    assert_int_equal(m->extensions, 0);
    assert_true(m->metallic > .9f);
    for (int k = 0; k < 3; k++) { /* F0 of glTF's mix */
        float F0 = .04f + m->metallic * (m->base_color[k] - .04f);
        assert_near(F0, in.specular[k], .04);
    }
    scene_destroy(scene);
}

static void maps_of_mirrors_are_converted(void **state)
{
    (void)state;
    static const uint8_t texels[] = {200, 150, 100, 180, 120, 80, 90, 60, 30, 250, 240, 230};
    legacy_material in = mirror();
    facet_scene *scene = legacy_scene(2);
    uint32_t texture = add_texels(scene, 2, 2, 3, texels);
    set_map(&in, LEGACY_SPECULAR_MAP, texture);
    scene->legacy->materials[0] = in; /* a metal: its color is the reflectance */
    set_color(in.diffuse, .3f, .2f, .1f);
    scene->legacy->materials[1] = in;
    set_map(&scene->legacy->materials[1], LEGACY_SHININESS_MAP, texture);
    convert(scene, &MIRRORS);
    assert_int_equal(scene->materials[0].textures[SCENE_BASE_COLOR_TEXTURE].texture, texture);
    assert_near(scene->materials[0].metallic, 1, 0);
    assert_int_equal(scene->materials[1].textures[SCENE_SPECULAR_COLOR_TEXTURE].texture, texture);
    assert_false(scene_material_has(&scene->materials[1], SCENE_METALLIC_ROUGHNESS_TEXTURE));
    assert_true(has_warning(scene, 1, "map-dropped"));
    scene_destroy(scene);
}

/* Always in the report; logged if it is visible. */
static void ignored_mirrors_are_reported(void **state)
{
    (void)state;
    const struct {
        int illum;
        float Ks;
        bool is_noted, is_told;
    } cases[] = {{5, .95f, true, true},   {3, .6f, true, true},    {8, .51f, true, true},
                 {7, .95f, true, false},  {3, .5f, true, false},   {5, .1f, true, false},
                 {2, .95f, false, false}, {6, .95f, false, false}, {5, 0, false, false}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        captured_messages log = {0};
        const facet_log capture = capture_log(&log);
        facet_scene *scene = legacy_scene(1);
        legacy_material m = mirror();
        set_color(m.specular, cases[i].Ks, cases[i].Ks, cases[i].Ks);
        set_color(m.diffuse, 0, 0, 0);
        m.illum = cases[i].illum;
        scene->legacy->materials[0] = m;
        assert_int_equal(
            legacy_convert(scene, FACET_MATERIAL_MODEL_METALLIC_ROUGHNESS, &PLAIN, &capture, NULL), FACET_OK);
        assert_int_equal(has_warning(scene, 0, "mirror-ignored"), cases[i].is_noted);
        assert_int_equal(log.count, cases[i].is_told);
        scene_destroy(scene);
    }
    /* Blender's illum 3 is a metal with a metallic. */
    legacy_material m = mirror();
    m.illum = 3;
    facet_scene *scene =
        convert_one(m, &(facet_legacy_desc){.dialect = FACET_MTL_DIALECT_BLENDER3, .has_mirrors = true});
    assert_false(has_warning(scene, 0, "mirror-ignored"));
    assert_near(scene->materials[0].metallic, 0, 0); /* of Ka, which is black */
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_mirror_without_color_is_a_metal),
        cmocka_unit_test(light_that_a_mirror_does_not_reflect_is_diffuse),
        cmocka_unit_test(reflectances_sum_to_at_most_one),
        cmocka_unit_test(large_exponents_are_smooth),
        cmocka_unit_test(mirrors_without_extensions_are_approximated),
        cmocka_unit_test(maps_of_mirrors_are_converted),
        cmocka_unit_test(ignored_mirrors_are_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
