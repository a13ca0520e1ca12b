/* convert_back_test.c - glTF materials to OpenGL 1, and round trips. */
#include "legacy/convert_test_support.h"

static const facet_legacy_desc PLAIN = {0};
static const facet_legacy_desc LINEAR = {.colors = FACET_LEGACY_COLORS_LINEAR,
                                         .target = FACET_LEGACY_TARGET_LINEAR};

static void to_ogl1(facet_scene *scene, const facet_legacy_desc *desc)
{
    convert_to(scene, FACET_MATERIAL_MODEL_OGL1, desc);
    assert_non_null(scene->legacy);
}

static scene_material plastic(void)
{
    scene_material m = scene_material_default();
    m.name = "plastic";
    set_color(m.base_color, .5f, .5f, .5f);
    m.metallic = 0;
    m.perceptual_roughness = .5f;
    return m;
}

static const uint8_t WOOD[] = {200, 150, 100, 180, 120, 80, 90, 60, 30, 250, 240, 230};

/* ---- factors ---- */

static void a_dielectric_is_fitted(void **state)
{
    (void)state;
    facet_scene *scene = gltf_scene(1);
    scene->materials[0] = plastic();
    to_ogl1(scene, &LINEAR);
    const legacy_material *m = &scene->legacy->materials[0];
    const facet_conversion *c = &scene->conversion->materials[0].summary;
    assert_false(scene->legacy->is_source);
    /* an independent fit: roughness .5, grey */
    assert_near(m->shininess, 39.1, 2);
    assert_near(m->diffuse[0], .486, .005);
    assert_near(m->specular[0], .184, .01);
    assert_near(c->error, .071, .004 + .003);
    assert_string_equal(c->method, "fit");
    assert_string_equal(c->source, "metallic-roughness");
    assert_string_equal(c->profile, "ogl1");
    assert_true(isnan(c->error_core));
    assert_int_equal(m->illum, 2);
    assert_true(m->is_culled);
    assert_true(legacy_has(m, LEGACY_ROUGHNESS | LEGACY_METALLIC));
    assert_near(m->roughness, .5, 0);
    /* The glTF materials stay. */
    assert_near(scene->materials[0].base_color[0], .5, 0);
    assert_null(scene->materials[0].meta.extras);
    scene_destroy(scene);
}

static void metals_have_remarks(void **state)
{
    (void)state;
    facet_scene *scene = gltf_scene(1);
    scene->materials[0].perceptual_roughness = .1f;
    to_ogl1(scene, &LINEAR);
    assert_true(has_warning(scene, 0, "specular-clamped"));
    assert_true(has_warning(scene, 0, "shininess-clamped") || has_warning(scene, 0, "metal-without-diffuse"));
    assert_true(has_warning(scene, SCENE_NONE, "legacy-light-pi"));
    scene->materials[0].perceptual_roughness = .8f;
    to_ogl1(scene, &LINEAR);
    assert_true(has_warning(scene, 0, "metal-without-diffuse"));
    assert_near(scene->legacy->materials[0].shininess, 6.7, .5); /* an independent fit */
    scene_destroy(scene);
}

static void colors_are_encoded(void **state)
{
    (void)state;
    facet_scene *scene = gltf_scene(1);
    scene->materials[0] = plastic();
    set_color(scene->materials[0].emissive, .5f, .25f, 0);
    scene->materials[0].emissive_strength = 2;
    to_ogl1(scene, &LINEAR);
    float diffuse = scene->legacy->materials[0].diffuse[0];
    assert_color(scene->legacy->materials[0].emission, 1, .5f, 0, 1e-6);
    to_ogl1(scene, &(facet_legacy_desc){
                       .target = FACET_LEGACY_TARGET_LINEAR}); /* fitted again: the existing colors stay */
    assert_int_equal(scene->legacy->colors, FACET_LEGACY_COLORS_LINEAR);
    to_ogl1(scene,
            &(facet_legacy_desc){.colors = FACET_LEGACY_COLORS_SRGB, .target = FACET_LEGACY_TARGET_LINEAR});
    assert_near(scene->legacy->materials[0].diffuse[0], srgb_encode((double)diffuse), 1e-5);
    assert_near(scene->legacy->materials[0].emission[1], srgb_encode(.5), 1e-5);
    scene_destroy(scene);
}

static void unlit_and_double_sided_materials_are_kept(void **state)
{
    (void)state;
    facet_scene *scene = gltf_scene(2);
    uint32_t wood = add_texels(scene, 2, 2, 3, WOOD);
    scene->materials[0] = plastic();
    scene->materials[0].extensions = SCENE_UNLIT;
    scene->materials[0].is_double_sided = true;
    scene->materials[0].textures[SCENE_BASE_COLOR_TEXTURE].texture = wood;
    scene->materials[1] = plastic();
    scene->materials[1].specular = 0; /* no highlight */
    scene->materials[1].extensions = SCENE_SPECULAR;
    to_ogl1(scene, &LINEAR);
    const legacy_material *m = scene->legacy->materials;
    assert_false(m[0].is_lit);
    assert_false(m[0].is_culled);
    assert_int_equal(m[0].illum, 0);
    assert_color(m[0].diffuse, .5f, .5f, .5f, 1e-6);
    assert_int_equal(m[0].maps[LEGACY_DIFFUSE_MAP].ref.texture, wood);
    assert_string_equal(scene->conversion->materials[0].summary.method, "exact");
    assert_int_equal(m[1].illum, highest_of(m[1].specular) > 0 ? 2 : 1);
    assert_near(highest_of(m[1].specular), 0, .01);
    scene_destroy(scene);
}

static void extensions_with_mtl_statements_are_written(void **state)
{
    (void)state;
    facet_scene *scene = gltf_scene(1);
    scene_material m = plastic();
    m.extensions =
        SCENE_CLEARCOAT | SCENE_SHEEN | SCENE_ANISOTROPY | SCENE_IOR | SCENE_TRANSMISSION | SCENE_VOLUME;
    m.clearcoat = .7f;
    m.clearcoat_roughness = .2f;
    set_color(m.sheen_color, .1f, .3f, .2f);
    m.anisotropy = .4f;
    m.anisotropy_rotation = -1.5707963f;
    m.ior = 1.4f;
    m.transmission = 1;
    uint32_t normals = add_texels(scene, 2, 2, 3, WOOD);
    m.textures[SCENE_NORMAL_TEXTURE].texture = normals;
    m.normal_scale = .6f;
    scene->materials[0] = m;
    to_ogl1(scene, &LINEAR);
    const legacy_material *out = &scene->legacy->materials[0];
    assert_true(legacy_has(out, LEGACY_CLEARCOAT | LEGACY_CLEARCOAT_ROUGHNESS | LEGACY_SHEEN |
                                    LEGACY_ANISOTROPY | LEGACY_ANISOTROPY_ROTATION | LEGACY_IOR));
    assert_near(out->clearcoat, .7, 1e-6);
    assert_near(out->clearcoat_roughness, .2, 1e-6);
    assert_near(out->sheen, .3, 1e-6);
    assert_near(out->anisotropy, .4, 1e-6);
    assert_near(out->anisotropy_rotation, .75, 1e-6);
    assert_near(out->ior, 1.4, 1e-6);
    assert_near(out->opacity, .1, 1e-6);
    assert_int_equal(out->maps[LEGACY_NORMAL_MAP].ref.texture, normals);
    assert_near(out->maps[LEGACY_NORMAL_MAP].bump_multiplier, .6, 1e-6);
    assert_true(has_warning(scene, 0, "extension-not-written"));
    scene_destroy(scene);
}

/* ---- textures ---- */

static void a_plain_base_texture_stays(void **state)
{
    (void)state;
    facet_scene *scene = gltf_scene(1);
    uint32_t wood = add_texels(scene, 2, 2, 3, WOOD);
    scene->materials[0] = plastic();
    scene_texture_ref *ref = &scene->materials[0].textures[SCENE_BASE_COLOR_TEXTURE];
    ref->texture = wood;
    ref->scale[0] = 2;
    ref->offset[1] = .5f;
    scene_texture_ref_update(ref);
    to_ogl1(scene, &LINEAR);
    const legacy_material *m = &scene->legacy->materials[0];
    assert_int_equal(m->maps[LEGACY_DIFFUSE_MAP].ref.texture, wood);
    assert_near(m->maps[LEGACY_DIFFUSE_MAP].ref.scale[0], 2, 0);
    assert_near(m->maps[LEGACY_DIFFUSE_MAP].ref.offset[1], .5, 0);
    assert_true(m->maps[LEGACY_DIFFUSE_MAP].ref.has_transform);
    assert_false(legacy_has_map(m, LEGACY_SPECULAR_MAP));
    assert_int_equal(scene->texture_count, 1);
    assert_near(m->diffuse[0] / .5f, .97, .02);
    assert_false(has_warning(scene, 0, "texture-option-dropped"));
    ref = &scene->materials[0].textures[SCENE_BASE_COLOR_TEXTURE];
    ref->rotation_rad = 1;
    to_ogl1(scene, &LINEAR);
    assert_true(has_warning(scene, 0, "texture-option-dropped"));
    scene_destroy(scene);
}

static void metallic_roughness_is_baked_and_split(void **state)
{
    (void)state;
    const uint8_t packed[] = {0, 100, 255, 0, 150, 0, 0, 200, 128, 0, 250, 255};
    facet_scene *scene = gltf_scene(1);
    scene_material m = scene_material_default();
    m.textures[SCENE_BASE_COLOR_TEXTURE].texture = add_texels(scene, 2, 2, 3, WOOD);
    m.textures[SCENE_METALLIC_ROUGHNESS_TEXTURE].texture = add_texels(scene, 2, 2, 3, packed);
    scene->materials[0] = m;
    to_ogl1(scene, &LINEAR);
    const legacy_material *out = &scene->legacy->materials[0];
    assert_string_equal(scene->conversion->materials[0].summary.method, "closed");
    assert_true(has_warning(scene, 0, "shininess-spread"));
    assert_color(out->diffuse, 1, 1, 1, 0);
    assert_color(out->specular, 1, 1, 1, 0);
    for (size_t i = 0; i < 4; i++) {
        uint8_t t[4];
        pbr_surface in = pbr_surface_default();
        ogl1_surface wanted;
        for (size_t k = 0; k < 3; k++)
            in.base_color[k] = light_of(WOOD[i * 3 + k]);
        in.perceptual_roughness = (float)packed[i * 3 + 1] / 255.0f;
        in.metallic = (float)packed[i * 3 + 2] / 255.0f;
        pbr_to_ogl1_closed_at(&in, out->shininess, &wanted);
        texel_at(scene, out->maps[LEGACY_DIFFUSE_MAP].ref.texture, i, t);
        for (int k = 0; k < 3; k++)
            assert_near(light_of(t[k]), unit_of(wanted.diffuse[k]), .005);
        texel_at(scene, out->maps[LEGACY_SPECULAR_MAP].ref.texture, i, t);
        for (int k = 0; k < 3; k++)
            assert_near(light_of(t[k]), unit_of(wanted.specular[k]), .005);
        texel_at(scene, out->maps[LEGACY_ROUGHNESS_MAP].ref.texture, i, t);
        assert_int_equal(t[0], packed[i * 3 + 1]);
        texel_at(scene, out->maps[LEGACY_METALLIC_MAP].ref.texture, i, t);
        assert_int_equal(t[0], packed[i * 3 + 2]);
    }
    scene_destroy(scene);
}

static void occlusion_darkens_on_request(void **state)
{
    (void)state;
    const uint8_t dark[] = {255, 128, 64, 0};
    facet_scene *scene = gltf_scene(1);
    scene->materials[0] = plastic();
    scene->materials[0].textures[SCENE_BASE_COLOR_TEXTURE].texture = add_texels(scene, 2, 2, 3, WOOD);
    scene->materials[0].textures[SCENE_OCCLUSION_TEXTURE].texture = add_texels(scene, 2, 2, 1, dark);
    scene->materials[0].occlusion_strength = .5f;
    to_ogl1(scene, &LINEAR);
    assert_true(has_warning(scene, 0, "map-dropped"));
    assert_int_equal(scene->texture_count, 2);
    to_ogl1(scene, &(facet_legacy_desc){.bakes_occlusion = true, .colors = FACET_LEGACY_COLORS_LINEAR});
    assert_false(has_warning(scene, 0, "map-dropped"));
    const legacy_material *m = &scene->legacy->materials[0];
    uint8_t open[4];
    uint8_t shut[4];
    texel_at(scene, m->maps[LEGACY_DIFFUSE_MAP].ref.texture, 0, open);
    texel_at(scene, m->maps[LEGACY_DIFFUSE_MAP].ref.texture, 3, shut);
    assert_near(light_of(open[0]), .97 * .5 * (double)light_of(200), .02);
    assert_near(light_of(shut[0]), .97 * .5 * .5 * (double)light_of(250), .02);
    assert_false(legacy_has_map(m, LEGACY_SPECULAR_MAP));
    assert_true(highest_of(m->specular) > .1f);
    scene_destroy(scene);
}

static void alpha_tests_and_blending(void **state)
{
    (void)state;
    const uint8_t leaf[] = {10, 200, 10, 255, 20, 100, 20, 100, 30, 90, 30, 200, 40, 80, 40, 0};
    facet_scene *scene = gltf_scene(3);
    uint32_t texture = add_texels(scene, 2, 2, 4, leaf);
    for (int i = 0; i < 3; i++) {
        scene->materials[i] = plastic();
        scene->materials[i].base_color[3] = .8f;
        scene->materials[i].textures[SCENE_BASE_COLOR_TEXTURE].texture = texture;
        scene->materials[i].alpha_mode = (scene_alpha_mode)i;
    }
    to_ogl1(scene, &LINEAR);
    const legacy_material *m = scene->legacy->materials;
    assert_near(m[0].opacity, 1, 0);
    assert_false(legacy_has_map(&m[0], LEGACY_OPACITY_MAP));
    assert_near(m[1].opacity, 1, 0);
    assert_near(m[2].opacity, .8, 1e-6);
    for (size_t i = 0; i < 4; i++) {
        uint8_t t[4];
        texel_at(scene, m[1].maps[LEGACY_OPACITY_MAP].ref.texture, i, t);
        assert_int_equal(t[0], .8 * leaf[i * 4 + 3] / 255.0 >= .5 ? 255 : 0);
        texel_at(scene, m[2].maps[LEGACY_OPACITY_MAP].ref.texture, i, t);
        assert_int_equal(t[0], leaf[i * 4 + 3]);
    }
    scene_destroy(scene);
}

/* ---- round trips ---- */

static legacy_material teapot(void)
{
    legacy_material m = legacy_material_default();
    m.name = "brass";
    m.fields = LEGACY_DIFFUSE | LEGACY_SPECULAR | LEGACY_SHININESS | LEGACY_AMBIENT;
    set_color(m.diffuse, .780392f, .568627f, .113725f);
    set_color(m.specular, .992157f, .941176f, .807843f);
    set_color(m.ambient, .3f, .2f, .03f);
    m.shininess = 27.8974f;
    return m;
}

/* A scene as read from glTF, whose extras state the originals. */
static void as_read_again(facet_scene *scene)
{
    scene->legacy->is_source = false;
    scene->conversion = NULL;
}

static void known_values_come_back_exactly(void **state)
{
    (void)state;
    facet_scene *scene = legacy_scene(2);
    scene->legacy->materials[0] = teapot();
    scene->legacy->materials[1] = teapot();
    set_map(&scene->legacy->materials[1], LEGACY_SPECULAR_MAP, add_texels(scene, 2, 2, 3, WOOD));
    convert(scene, &PLAIN);
    as_read_again(scene);
    to_ogl1(scene, &PLAIN);
    for (int i = 0; i < 2; i++) {
        const legacy_material wanted = teapot();
        const legacy_material *m = &scene->legacy->materials[i];
        assert_near(m->shininess, wanted.shininess, 0);
        for (int k = 0; k < 3; k++) {
            assert_near(m->diffuse[k], wanted.diffuse[k], 0);
            assert_near(m->specular[k], wanted.specular[k], 0);
            assert_near(m->ambient[k], wanted.ambient[k], 0);
        }
        assert_string_equal(scene->conversion->materials[i].summary.method, "source");
    }
    assert_true(scene->conversion->materials[0].summary.error < .3);
    /* Twice: the values are still the originals. */
    to_ogl1(scene, &PLAIN);
    assert_string_equal(scene->conversion->materials[0].summary.method, "source");
    scene_destroy(scene);
}

/* Lobes of the two models differ in shape, so values that are fitted again differ from the originals and
 * approximate the glTF material better. */
static void known_originals_lose_nothing_and_a_fit_little(void **state)
{
    (void)state;
    facet_scene *scene = legacy_scene(1);
    legacy_material in = teapot();
    set_color(in.diffuse, .5f, .4f, .3f);
    set_color(in.specular, .2f, .2f, .2f);
    scene->legacy->materials[0] = in;
    convert(scene, &(facet_legacy_desc){.method = FACET_LEGACY_METHOD_FIT});
    as_read_again(scene);
    to_ogl1(scene, &PLAIN);
    assert_string_equal(scene->conversion->materials[0].summary.method, "source");
    assert_true(scene->conversion->materials[0].summary.error == 0.0);
    to_ogl1(scene, &(facet_legacy_desc){.ignores_source = true});
    assert_string_equal(scene->conversion->materials[0].summary.method, "fit");
    assert_true(scene->conversion->materials[0].summary.error > 0.0);
    assert_true(scene->conversion->materials[0].summary.error < .1);
    const legacy_material *m = &scene->legacy->materials[0];
    assert_near(m->shininess / in.shininess, 1, .2);
    for (int k = 0; k < 3; k++)
        assert_near(m->diffuse[k], in.diffuse[k], .02);
    scene_destroy(scene);
}

/* A file of legacy materials is written as it was read. */
static void read_values_stay(void **state)
{
    (void)state;
    facet_scene *scene = legacy_scene(2);
    scene->legacy->materials[0] = teapot();
    scene->legacy->materials[1].is_gltf_restored = true; /* of a glTF model with parameters applied */
    scene->materials[1] = plastic();
    convert(scene, &PLAIN);
    to_ogl1(scene, &PLAIN);
    assert_true(scene->legacy->is_source);
    assert_near(scene->legacy->materials[0].shininess, 27.8974, 1e-4);
    assert_near(scene->legacy->materials[1].shininess, 39.1, 2);
    assert_true(scene->legacy->materials[1].is_gltf_restored);
    convert(scene, &PLAIN);
    assert_near(scene->materials[1].perceptual_roughness, .5, 0);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_dielectric_is_fitted),
        cmocka_unit_test(metals_have_remarks),
        cmocka_unit_test(colors_are_encoded),
        cmocka_unit_test(unlit_and_double_sided_materials_are_kept),
        cmocka_unit_test(extensions_with_mtl_statements_are_written),
        cmocka_unit_test(a_plain_base_texture_stays),
        cmocka_unit_test(metallic_roughness_is_baked_and_split),
        cmocka_unit_test(occlusion_darkens_on_request),
        cmocka_unit_test(alpha_tests_and_blending),
        cmocka_unit_test(known_values_come_back_exactly),
        cmocka_unit_test(known_originals_lose_nothing_and_a_fit_little),
        cmocka_unit_test(read_values_stay),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
