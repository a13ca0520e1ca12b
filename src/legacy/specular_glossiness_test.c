/* specular_glossiness_test.c - specular and ior are lossless; the loss of core glTF is reported; and the
 * reverse. */
#include "legacy/convert_test_support.h"
#include "legacy/specular_glossiness.h"

static const facet_legacy_desc PLAIN = {0};
static const facet_legacy_desc CORE = {.profile = FACET_LEGACY_PROFILE_CORE};

static scene_material glossy(void)
{
    scene_material m = scene_material_default();
    m.name = "glossy";
    m.extensions = SCENE_SPECULAR_GLOSSINESS;
    set_color(m.base_color, .6f, .3f, .2f);
    set_color(m.specular_color, .3f, .2f, .1f);
    m.glossiness = .7f;
    return m;
}

static void specular_and_ior_lose_nothing(void **state)
{
    (void)state;
    facet_scene *scene = gltf_scene(1);
    scene->materials[0] = glossy();
    convert(scene, &PLAIN);
    const scene_material *m = &scene->materials[0];
    assert_int_equal(m->extensions, SCENE_SPECULAR | SCENE_IOR);
    const facet_conversion *c = &scene->conversion->materials[0].summary;
    assert_string_equal(c->method, "exact");
    assert_string_equal(c->source, "specular-glossiness");
    assert_string_equal(c->profile, "specular+ior");
    assert_near(c->error, 0, 0);
    assert_near(scene->conversion->light_scale, 1, 0);
    /* shade/specular_glossiness.h makes this surface from the former. */
    assert_near(m->metallic, 0, 0);
    assert_near(m->ior, 0, 0);
    assert_near(m->specular, 1, 0);
    assert_near(m->perceptual_roughness, 1.0f - .7f, 0);
    assert_color(m->base_color, .6f, .3f, .2f, 0);
    assert_color(m->specular_color, .3f, .2f, .1f, 0);
    scene_destroy(scene);
}

static const uint8_t DIFFUSE[] = {200, 150, 100, 180, 120, 80, 90, 60, 30, 250, 240, 230};
static const uint8_t GLOSS[] = {255, 200, 100, 255, 60, 60, 60, 128, 10, 20, 30, 0, 255, 255, 255, 200};

static void textures_are_reused_or_inverted(void **state)
{
    (void)state;
    facet_scene *scene = gltf_scene(1);
    scene_material m = glossy();
    uint32_t diffuse = add_texels(scene, 2, 2, 3, DIFFUSE);
    uint32_t gloss = add_texels(scene, 2, 2, 4, GLOSS);
    m.textures[SCENE_BASE_COLOR_TEXTURE].texture = diffuse;
    m.textures[SCENE_SPECULAR_GLOSSINESS_TEXTURE].texture = gloss;
    m.glossiness = 1;
    scene->materials[0] = m;
    convert(scene, &PLAIN);
    const scene_material *out = &scene->materials[0];
    assert_int_equal(out->textures[SCENE_BASE_COLOR_TEXTURE].texture, diffuse);
    assert_int_equal(out->textures[SCENE_SPECULAR_COLOR_TEXTURE].texture, gloss);
    assert_false(scene_material_has(out, SCENE_SPECULAR_GLOSSINESS_TEXTURE));
    assert_near(out->perceptual_roughness, 1, 0);
    for (size_t i = 0; i < 4; i++) {
        uint8_t t[4];
        texel_at(scene, out->textures[SCENE_METALLIC_ROUGHNESS_TEXTURE].texture, i, t);
        assert_int_equal(t[1], 255 - GLOSS[i * 4 + 3]); /* exact in 8 bits */
    }
    scene_destroy(scene);
}

/* The sample code of the extension, in double. */
static void the_core_follows_the_sample_code(void **state)
{
    (void)state;
    const float diffuse[3] = {.6f, .3f, .2f};
    const float specular[3] = {.3f, .2f, .1f};
    float base[3];
    float metallic;
    core_from_glossiness(diffuse, specular, base, &metallic);
    double bd = sqrt(.299 * .36 + .587 * .09 + .114 * .04);
    double bs = sqrt(.299 * .09 + .587 * .04 + .114 * .01);
    double b = bd * .7 / .96 + bs - .08;
    double m = (-b + sqrt(b * b - .16 * (.04 - bs))) / .08;
    assert_near(metallic, m, 1e-5);
    for (int k = 0; k < 3; k++) {
        double from_diffuse = (double)diffuse[k] * .7 / .96 / (1 - m);
        double from_specular = ((double)specular[k] - .04 * (1 - m)) / m;
        assert_near(base[k], from_diffuse + m * m * (from_specular - from_diffuse), 1e-5);
    }
    /* A dielectric and a metal are unchanged. */
    core_from_glossiness(diffuse, (const float[3]){.04f, .04f, .04f}, base, &metallic);
    assert_near(metallic, 0, 1e-5);
    assert_color(base, .6f, .3f, .2f, 1e-5);
    core_from_glossiness((const float[3]){0, 0, 0}, (const float[3]){.9f, .7f, .3f}, base, &metallic);
    assert_near(metallic, 1, .02);
    assert_color(base, .9f, .7f, .3f, .02);
}

static void core_materials_report_their_error(void **state)
{
    (void)state;
    facet_scene *scene = gltf_scene(2);
    scene->materials[0] = glossy();
    scene->materials[1] = glossy();
    set_color(scene->materials[1].specular_color, .04f, .04f, .04f);
    convert(scene, &CORE);
    const facet_conversion *c = &scene->conversion->materials[0].summary;
    assert_int_equal(scene->materials[0].extensions, 0);
    assert_string_equal(c->profile, "core");
    assert_true(c->error > .05 && c->error < .5);
    assert_true(scene->materials[0].metallic > 0);
    assert_near(scene->conversion->materials[1].summary.error, 0, 1e-4);
    assert_near(scene->materials[1].metallic, 0, 1e-5);
    scene_destroy(scene);
}

static void the_core_bakes_textures(void **state)
{
    (void)state;
    facet_scene *scene = gltf_scene(1);
    scene_material m = glossy();
    set_color(m.base_color, 1, 1, 1);
    set_color(m.specular_color, 1, 1, 1);
    m.textures[SCENE_BASE_COLOR_TEXTURE].texture = add_texels(scene, 2, 2, 3, DIFFUSE);
    m.textures[SCENE_SPECULAR_GLOSSINESS_TEXTURE].texture = add_texels(scene, 2, 2, 4, GLOSS);
    scene->materials[0] = m;
    convert(scene, &CORE);
    for (size_t i = 0; i < 4; i++) {
        float diffuse[3];
        float specular[3];
        float base[3];
        float metallic;
        for (size_t k = 0; k < 3; k++) {
            diffuse[k] = light_of(DIFFUSE[i * 3 + k]);
            specular[k] = light_of(GLOSS[i * 4 + k]);
        }
        core_from_glossiness(diffuse, specular, base, &metallic);
        pbr_surface s = surface_at(scene, 0, i);
        assert_color(s.base_color, base[0], base[1], base[2], .005);
        assert_near(s.metallic, metallic, .5 / 255 + 1e-6);
        assert_near(s.perceptual_roughness, 1 - .7 * GLOSS[i * 4 + 3] / 255.0, .5 / 255 + 1e-6);
    }
    scene_destroy(scene);
}

/* ---- back to specular-glossiness ---- */

static void metals_and_dielectrics_are_exact(void **state)
{
    (void)state;
    for (int metal = 0; metal <= 4; metal++) {
        pbr_surface in = pbr_surface_default();
        pbr_surface out = pbr_surface_default();
        in.base_color[0] = .5f;
        in.base_color[1] = .3f;
        in.base_color[2] = .1f;
        in.metallic = (float)metal * .25f;
        in.perceptual_roughness = .4f;
        assert_true(glossiness_from_surface(&in, out.base_color, out.specular_color));
        out.ior = 0;
        out.perceptual_roughness = .4f;
        fit_error error = compare_pbr(&in, &out);
        assert_near(error.E, 0, 1e-5);
    }
}

static void inexact_conversions_are_reported(void **state)
{
    (void)state;
    facet_scene *scene = gltf_scene(3);
    scene->materials[0].metallic = 0;
    scene->materials[1].metallic = 0;
    scene->materials[1].extensions = SCENE_SPECULAR | SCENE_CLEARCOAT;
    scene->materials[1].specular = .5f; /* F90 of 1/2 has no counterpart */
    scene->materials[1].perceptual_roughness = .3f;
    scene->materials[2].extensions = SCENE_UNLIT;
    convert_to(scene, FACET_MATERIAL_MODEL_SPECULAR_GLOSSINESS, &PLAIN);
    const struct scene_conversion *c = scene->conversion;
    assert_int_equal(scene->materials[0].extensions, SCENE_SPECULAR_GLOSSINESS);
    assert_string_equal(c->materials[0].summary.method, "exact");
    assert_color(scene->materials[0].specular_color, .04f, .04f, .04f, 1e-6);
    assert_int_equal(scene->materials[1].extensions, SCENE_SPECULAR_GLOSSINESS);
    assert_string_equal(c->materials[1].summary.method, "closed");
    assert_true(c->materials[1].summary.error > 1e-4);
    assert_true(has_warning(scene, 1, "extension-not-written"));
    assert_int_equal(scene->materials[2].extensions, SCENE_UNLIT);
    assert_string_equal(c->materials[2].summary.method, "none");
    scene_destroy(scene);
}

static void textures_round_trip(void **state)
{
    (void)state;
    const uint8_t packed[] = {0, 100, 255, 0, 150, 0, 0, 200, 255, 0, 250, 0};
    facet_scene *scene = gltf_scene(1);
    scene_material m = scene_material_default();
    m.textures[SCENE_BASE_COLOR_TEXTURE].texture = add_texels(scene, 2, 2, 3, DIFFUSE);
    m.textures[SCENE_METALLIC_ROUGHNESS_TEXTURE].texture = add_texels(scene, 2, 2, 3, packed);
    scene->materials[0] = m;
    pbr_surface before[4];
    for (size_t i = 0; i < 4; i++)
        before[i] = surface_at(scene, 0, i);
    convert_to(scene, FACET_MATERIAL_MODEL_SPECULAR_GLOSSINESS, &PLAIN);
    assert_true(scene_material_has(&scene->materials[0], SCENE_SPECULAR_GLOSSINESS_TEXTURE));
    convert(scene, &PLAIN);
    assert_int_equal(scene->materials[0].extensions, SCENE_SPECULAR | SCENE_IOR);
    for (size_t i = 0; i < 4; i++) {
        pbr_surface after = surface_at(scene, 0, i);
        assert_true(compare_pbr(&before[i], &after).E < .01); /* 8 bits */
    }
    scene_destroy(scene);
}

/* An independent grid over the hemisphere of L. */
static double grid_error(const pbr_surface *a, const pbr_surface *b)
{
    double difference = 0;
    double source = 0;
    for (int view = 0; view < 3; view++) {
        const float V[3] = {sinf((float)view * .5235988f), 0, cosf((float)view * .5235988f)};
        for (int i = 0; i < 200; i++)
            for (int j = 0; j < 200; j++) { /* cosine-weighted */
                float r = sqrtf(((float)i + .5f) / 200.0f);
                float phi = 6.2831853f * ((float)j + .5f) / 200.0f;
                const float L[3] = {r * cosf(phi), r * sinf(phi), sqrtf(1 - r * r)};
                float T[3];
                float M[3];
                pbr_radiance(a, PBR_CORRELATED, V, L, T);
                pbr_radiance(b, PBR_CORRELATED, V, L, M);
                for (int k = 0; k < 3; k++) {
                    difference += (double)((M[k] - T[k]) * (M[k] - T[k]));
                    source += (double)(T[k] * T[k]);
                }
            }
    }
    return sqrt(difference / source);
}

static void the_error_is_that_of_a_plain_grid(void **state)
{
    (void)state;
    pbr_surface a = pbr_surface_default();
    pbr_surface b = pbr_surface_default();
    for (int k = 0; k < 3; k++)
        a.base_color[k] = b.base_color[k] = .5f;
    a.perceptual_roughness = .6f;
    b.perceptual_roughness = .7f;
    b.metallic = .3f;
    assert_near(compare_pbr(&a, &b).E, grid_error(&a, &b), 2e-3 * grid_error(&a, &b));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(specular_and_ior_lose_nothing),
        cmocka_unit_test(textures_are_reused_or_inverted),
        cmocka_unit_test(the_core_follows_the_sample_code),
        cmocka_unit_test(core_materials_report_their_error),
        cmocka_unit_test(the_core_bakes_textures),
        cmocka_unit_test(metals_and_dielectrics_are_exact),
        cmocka_unit_test(inexact_conversions_are_reported),
        cmocka_unit_test(textures_round_trip),
        cmocka_unit_test(the_error_is_that_of_a_plain_grid),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
