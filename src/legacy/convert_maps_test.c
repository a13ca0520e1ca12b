/* convert_maps_test.c - textures of legacy materials: images that stay unchanged, and the texels of
 * converted ones. */
#include "legacy/convert_test_support.h"

static const facet_legacy_desc PLAIN = {0};

static legacy_material shiny(void)
{
    legacy_material m = legacy_material_default();
    m.fields = LEGACY_DIFFUSE | LEGACY_SPECULAR | LEGACY_SHININESS;
    set_color(m.diffuse, .6f, .5f, .4f);
    set_color(m.specular, .3f, .3f, .3f);
    m.shininess = 40;
    return m;
}

/* The closed form for one texel: sf = max(Cs) g(s), base = Cd / (1 - sf). */
static pbr_surface closed(const float diffuse[3], const float specular[3], float shininess)
{
    pbr_surface out = pbr_surface_default();
    float most = highest_of(specular);
    out.ior = 0;
    out.perceptual_roughness = perceptual_roughness_from_shininess(shininess);
    out.specular = unit_of(most * reflectance_share_from_shininess(shininess));
    for (int k = 0; k < 3; k++) {
        out.specular_color[k] = most > 0 ? specular[k] / most : 1;
        out.base_color[k] = unit_of(diffuse[k] / (1 - out.specular));
    }
    return out;
}

/* An unchanged image is only scaled, which cannot follow the fit at the darkest and brightest texels. */
static void assert_scaled(const facet_scene *scene, size_t i, const float diffuse[3], const float specular[3],
                          float shininess)
{
    ogl1_surface in;
    pbr_surface wanted;
    pbr_surface found = surface_at(scene, 0, i);
    memcpy(in.diffuse, diffuse, sizeof in.diffuse);
    memcpy(in.specular, specular, sizeof in.specular);
    in.shininess = shininess;
    ogl1_to_pbr_closed(&in, &wanted);
    for (int k = 0; k < 3; k++)
        assert_near(found.base_color[k], wanted.base_color[k], .015);
    assert_near(found.specular, wanted.specular, .01);
}

/* Within half a code of 8 bits (of sRGB: by its slope at most 1.3 codes of light at white). */
static void assert_surface(const pbr_surface *found, const pbr_surface *wanted)
{
    for (int k = 0; k < 3; k++) {
        assert_near(found->base_color[k], wanted->base_color[k], .005);
        assert_near(found->specular * found->specular_color[k], wanted->specular * wanted->specular_color[k],
                    .004);
    }
    assert_near(found->perceptual_roughness, wanted->perceptual_roughness, .5 / 255 + 1e-6);
    assert_near(found->specular, wanted->specular, .5 / 255 + 1e-6);
    assert_near(found->metallic, wanted->metallic, .5 / 255 + 1e-6);
}

static const uint8_t WOOD[] = {200, 150, 100, 180, 120, 80, 90, 60, 30, 250, 240, 230};

/* ---- images that stay ---- */

static void a_plain_diffuse_map_stays_its_file(void **state)
{
    (void)state;
    facet_scene *scene = legacy_scene(1);
    uint32_t wood = add_texels(scene, 2, 2, 3, WOOD);
    scene->legacy->materials[0] = shiny();
    set_map(&scene->legacy->materials[0], LEGACY_DIFFUSE_MAP, wood);
    convert(scene, &PLAIN);
    const scene_material *m = &scene->materials[0];
    assert_int_equal(m->textures[SCENE_BASE_COLOR_TEXTURE].texture, wood);
    assert_int_equal(scene->texture_count, 1);
    for (size_t i = 0; i < 4; i++) {
        float diffuse[3];
        for (size_t k = 0; k < 3; k++)
            diffuse[k] = scene->legacy->materials[0].diffuse[k] * light_of(WOOD[i * 3 + k]);
        assert_scaled(scene, i, diffuse, scene->legacy->materials[0].specular, 40);
    }
    assert_true(highest_of(m->base_color) <= 1);
    scene_destroy(scene);
}

static void a_factor_above_one_is_baked(void **state)
{
    (void)state;
    facet_scene *scene = legacy_scene(1);
    uint32_t wood = add_texels(scene, 2, 2, 3, WOOD);
    legacy_material m = shiny();
    set_color(m.diffuse, 1, 1, 1);
    set_map(&m, LEGACY_DIFFUSE_MAP, wood);
    scene->legacy->materials[0] = m;
    convert(scene, &PLAIN);
    assert_true(highest_of(scene->materials[0].base_color) <= 1);
    assert_int_not_equal(scene->materials[0].textures[SCENE_BASE_COLOR_TEXTURE].texture, wood);
    for (size_t i = 0; i < 3; i++) { /* the last texel is clamped */
        float diffuse[3];
        for (size_t k = 0; k < 3; k++)
            diffuse[k] = light_of(WOOD[i * 3 + k]);
        assert_scaled(scene, i, diffuse, m.specular, 40);
    }
    scene_destroy(scene);
}

static void black_and_unstated_factors_are_white_with_a_map(void **state)
{
    (void)state;
    facet_scene *scene = legacy_scene(4);
    uint32_t wood = add_texels(scene, 2, 2, 3, WOOD);
    legacy_material m = legacy_material_default();
    set_map(&m, LEGACY_DIFFUSE_MAP, SCENE_NONE); /* lost maps */
    scene->legacy->materials[2] = m;
    m.fields = LEGACY_DIFFUSE | LEGACY_EMISSION | LEGACY_OPACITY;
    m.opacity = 0;
    set_color(m.diffuse, 0, 0, 0);
    set_map(&m, LEGACY_EMISSION_MAP, SCENE_NONE);
    scene->legacy->materials[3] = m;
    m = legacy_material_default();
    set_map(&m, LEGACY_DIFFUSE_MAP, wood);
    scene->legacy->materials[0] = m; /* nothing stated */
    m.fields = LEGACY_DIFFUSE | LEGACY_EMISSION;
    set_color(m.diffuse, 0, 0, 0);
    set_map(&m, LEGACY_EMISSION_MAP, wood);
    scene->legacy->materials[1] = m;
    convert(scene, &PLAIN);
    assert_false(has_warning(scene, 0, "black-kd-with-map"));
    assert_true(has_warning(scene, 1, "black-kd-with-map"));
    assert_true(has_warning(scene, 1, "black-ke-with-map"));
    assert_true(has_warning(scene, 3, "black-kd-with-map"));
    for (uint32_t i = 0; i < 4; i++)
        assert_color(scene->materials[i].base_color, 1, 1, 1, 1e-6);
    assert_near(scene->materials[3].base_color[3], 1, 0);
    assert_color(scene->materials[3].emissive, 0, 0, 0, 0);
    assert_color(scene->materials[1].emissive, 1, 1, 1, 1e-6);
    assert_int_equal(scene->materials[1].textures[SCENE_EMISSIVE_TEXTURE].texture, wood);
    scene_destroy(scene);
}

/* ---- texel by texel ---- */

static const uint8_t METAL[] = {255, 128, 0, 10, 20, 30, 255, 255, 255, 0, 0, 0};
static const uint8_t EXPONENTS[] = {255, 100, 20, 60};

static void check_blinn_phong_texels(bool has_diffuse, bool has_specular, bool has_shininess)
{
    facet_scene *scene = legacy_scene(1);
    legacy_material m = shiny();
    m.shininess = 100;
    if (has_diffuse)
        set_map(&m, LEGACY_DIFFUSE_MAP, add_texels(scene, 2, 2, 3, WOOD));
    if (has_specular)
        set_map(&m, LEGACY_SPECULAR_MAP, add_texels(scene, 2, 2, 3, METAL));
    if (has_shininess)
        set_map(&m, LEGACY_SHININESS_MAP, add_texels(scene, 2, 2, 1, EXPONENTS));
    scene->legacy->materials[0] = m;
    convert(scene, &PLAIN);
    for (size_t i = 0; i < 4; i++) {
        float diffuse[3];
        float specular[3];
        for (size_t k = 0; k < 3; k++) {
            diffuse[k] = m.diffuse[k] * (has_diffuse ? light_of(WOOD[i * 3 + k]) : 1.0f);
            specular[k] = m.specular[k] * (has_specular ? light_of(METAL[i * 3 + k]) : 1.0f);
        }
        pbr_surface wanted =
            closed(diffuse, specular, m.shininess * (has_shininess ? (float)EXPONENTS[i] / 255.0f : 1.0f));
        pbr_surface found = surface_at(scene, 0, i);
        assert_surface(&found, &wanted);
    }
    assert_int_equal(has_warning(scene, 0, "ks-map-used-as-specular"), has_specular);
    assert_near(scene->materials[0].metallic, 0, 0);
    scene_destroy(scene);
}

static void specular_and_shininess_maps_are_converted_by_texel(void **state)
{
    (void)state;
    for (int i = 2; i < 8; i++)
        check_blinn_phong_texels(i & 1, i & 2, i & 4);
}

static void the_core_profile_packs_metallic_and_roughness(void **state)
{
    (void)state;
    facet_scene *scene = legacy_scene(1);
    legacy_material m = shiny();
    set_map(&m, LEGACY_SPECULAR_MAP, add_texels(scene, 2, 2, 3, METAL));
    scene->legacy->materials[0] = m;
    convert(scene, &(facet_legacy_desc){.profile = FACET_LEGACY_PROFILE_CORE});
    assert_int_equal(scene->materials[0].extensions, 0);
    fit_metric *metric = NULL;
    assert_int_equal(fit_metric_create(NULL, PBR_CORRELATED, &metric, NULL), FACET_OK);
    for (size_t i = 0; i < 4; i++) {
        ogl1_surface in;
        pbr_surface wanted;
        memcpy(in.diffuse, m.diffuse, sizeof in.diffuse);
        for (size_t k = 0; k < 3; k++)
            in.specular[k] = m.specular[k] * light_of(METAL[i * 3 + k]);
        in.shininess = m.shininess;
        ogl1_to_pbr_core_closed(&in, &wanted);
        pbr_surface found = surface_at(scene, 0, i);
        /* Between the nodes of a grid of greys, in 8 bits: nearly as good as a fit of this texel. */
        double least = fit_compare(metric, &in, &wanted, FIT_FROM_OGL1).E;
        double E = fit_compare(metric, &in, &found, FIT_FROM_OGL1).E;
        assert_near(E, least, .02);
    }
    fit_metric_destroy(metric);
    scene_destroy(scene);
}

/* ---- sizes and places ---- */

static void smaller_maps_are_brought_to_the_size_of_the_largest(void **state)
{
    (void)state;
    const uint8_t grey[16] = {100, 100, 100, 100, 100, 100, 100, 100, 100, 100, 100, 100, 100, 100, 100, 100};
    facet_scene *scene = legacy_scene(1);
    legacy_material m = shiny();
    set_map(&m, LEGACY_DIFFUSE_MAP, add_texels(scene, 2, 2, 3, WOOD));
    set_map(&m, LEGACY_SPECULAR_MAP, add_texels(scene, 4, 4, 1, grey));
    scene->legacy->materials[0] = m;
    convert(scene, &PLAIN);
    image base = decode_texture(scene, scene->materials[0].textures[SCENE_BASE_COLOR_TEXTURE].texture);
    assert_int_equal(base.width, 4);
    assert_int_equal(base.height, 4);
    image_destroy(&base);
    scene_destroy(scene);
}

static void maps_with_other_coordinates_are_averaged(void **state)
{
    (void)state;
    const uint8_t halves[] = {0, 0, 255, 255};
    facet_scene *scene = legacy_scene(1);
    uint32_t wood = add_texels(scene, 2, 2, 3, WOOD);
    legacy_material m = shiny();
    set_map(&m, LEGACY_DIFFUSE_MAP, wood);
    set_map(&m, LEGACY_SPECULAR_MAP, add_texels(scene, 2, 2, 1, halves));
    m.maps[LEGACY_SPECULAR_MAP].ref.scale[0] = 3;
    scene_texture_ref_update(&m.maps[LEGACY_SPECULAR_MAP].ref);
    scene->legacy->materials[0] = m;
    convert(scene, &PLAIN);
    assert_true(has_warning(scene, 0, "texture-averaged"));
    assert_int_equal(scene->materials[0].textures[SCENE_BASE_COLOR_TEXTURE].texture, wood);
    assert_near(scene->materials[0].specular, .5f * .3f * reflectance_share_from_shininess(40), 1e-5);
    scene_destroy(scene);
}

static void places_and_samplers_are_kept(void **state)
{
    (void)state;
    facet_scene *scene = legacy_scene(1);
    uint32_t metal = add_texels(scene, 2, 2, 3, METAL);
    scene->textures[metal].wrap_u = SCENE_WRAP_CLAMP;
    legacy_material m = shiny();
    set_map(&m, LEGACY_SPECULAR_MAP, metal);
    m.maps[LEGACY_SPECULAR_MAP].ref.offset[1] = .25f;
    scene_texture_ref_update(&m.maps[LEGACY_SPECULAR_MAP].ref);
    scene->legacy->materials[0] = m;
    convert(scene, &PLAIN);
    const scene_texture_ref *ref = &scene->materials[0].textures[SCENE_SPECULAR_TEXTURE];
    assert_near(ref->offset[1], .25, 0);
    assert_true(ref->has_transform);
    assert_int_equal(scene->textures[ref->texture].wrap_u, SCENE_WRAP_CLAMP);
    assert_string_equal(scene->images[scene->textures[ref->texture].image].name, "image_specular");
    scene_destroy(scene);
}

static void equal_textures_are_made_once(void **state)
{
    (void)state;
    facet_scene *scene = legacy_scene(3);
    uint32_t metal = add_texels(scene, 2, 2, 3, METAL);
    for (int i = 0; i < 3; i++) {
        scene->legacy->materials[i] = shiny();
        scene->legacy->materials[i].shininess = i == 2 ? 80 : 40;
        set_map(&scene->legacy->materials[i], LEGACY_SPECULAR_MAP, metal);
    }
    convert(scene, &PLAIN);
    const scene_material *m = scene->materials;
    assert_int_equal(m[0].textures[SCENE_SPECULAR_TEXTURE].texture,
                     m[1].textures[SCENE_SPECULAR_TEXTURE].texture);
    assert_int_not_equal(m[0].textures[SCENE_SPECULAR_TEXTURE].texture,
                         m[2].textures[SCENE_SPECULAR_TEXTURE].texture);
    assert_int_equal(scene->texture_count, 1 + 2 * 2); /* base and specular, twice */
    scene_destroy(scene);
}

/* ---- options ---- */

static void map_options_base_gain_and_channel_apply(void **state)
{
    (void)state;
    facet_scene *scene = legacy_scene(1);
    legacy_material m = shiny();
    set_color(m.specular, 0, 0, 0);
    set_color(m.diffuse, 1, 1, 1);
    set_map(&m, LEGACY_DIFFUSE_MAP, add_texels(scene, 2, 2, 3, WOOD));
    m.maps[LEGACY_DIFFUSE_MAP].base = .2f;
    m.maps[LEGACY_DIFFUSE_MAP].gain = .5f;
    m.maps[LEGACY_DIFFUSE_MAP].channel = 'g';
    scene->legacy->materials[0] = m;
    convert(scene, &PLAIN);
    for (size_t i = 0; i < 4; i++) {
        pbr_surface s = surface_at(scene, 0, i);
        double wanted = srgb_decode(.2 + .5 * WOOD[i * 3 + 1] / 255.0);
        for (int k = 0; k < 3; k++)
            assert_near(s.base_color[k], wanted, .004);
    }
    scene_destroy(scene);
}

/* ---- opacity ---- */

static const uint8_t FADE[] = {255, 128, 64, 0};
static const uint8_t CUT[] = {255, 0, 0, 255};

static void opacity_maps_go_into_the_base_color(void **state)
{
    (void)state;
    facet_scene *scene = legacy_scene(3);
    legacy_material m = shiny();
    m.fields |= LEGACY_OPACITY;
    set_map(&m, LEGACY_DIFFUSE_MAP, add_texels(scene, 2, 2, 3, WOOD));
    set_map(&m, LEGACY_OPACITY_MAP, add_texels(scene, 2, 2, 1, FADE));
    m.opacity = .5f;
    scene->legacy->materials[0] = m;
    m.opacity = 0; /* would hide the image: a mistake of exporters */
    set_map(&m, LEGACY_OPACITY_MAP, add_texels(scene, 2, 2, 1, CUT));
    scene->legacy->materials[1] = m;
    m.maps[LEGACY_DIFFUSE_MAP] = legacy_map_default(); /* opacity alone */
    m.opacity = 1;
    set_map(&m, LEGACY_OPACITY_MAP, add_texels(scene, 2, 2, 1, FADE));
    scene->legacy->materials[2] = m;
    convert(scene, &PLAIN);
    const scene_material *out = scene->materials;
    assert_int_equal(out[0].alpha_mode, SCENE_ALPHA_BLEND);
    assert_near(out[0].base_color[3], .5, 1e-6);
    assert_int_equal(out[1].alpha_mode, SCENE_ALPHA_MASK);
    assert_near(out[1].alpha_cutoff, .5, 0);
    assert_true(has_warning(scene, 1, "zero-alpha"));
    assert_int_equal(out[2].alpha_mode, SCENE_ALPHA_BLEND);
    for (size_t i = 0; i < 4; i++) {
        uint8_t t[4];
        texel_at(scene, out[0].textures[SCENE_BASE_COLOR_TEXTURE].texture, i, t);
        assert_int_equal(t[3], FADE[i]);
        texel_at(scene, out[1].textures[SCENE_BASE_COLOR_TEXTURE].texture, i, t);
        assert_int_equal(t[3], CUT[i]);
        texel_at(scene, out[2].textures[SCENE_BASE_COLOR_TEXTURE].texture, i, t);
        assert_int_equal(t[3], FADE[i]);
        pbr_surface s = surface_at(scene, 2, i);
        pbr_surface wanted = closed(m.diffuse, m.specular, 40);
        assert_near(s.base_color[1], wanted.base_color[1], .01);
    }
    scene_destroy(scene);
}

static void a_shared_image_of_color_and_opacity_stays(void **state)
{
    (void)state;
    const uint8_t leaf[] = {10, 200, 10, 255, 20, 100, 20, 0, 30, 90, 30, 255, 40, 80, 40, 0};
    facet_scene *scene = legacy_scene(2);
    uint32_t shared = add_texels(scene, 2, 2, 4, leaf);
    legacy_material m = shiny();
    set_map(&m, LEGACY_DIFFUSE_MAP, shared);
    scene->legacy->materials[1] = m; /* without map_d alpha is ignored */
    set_map(&m, LEGACY_OPACITY_MAP, shared);
    scene->legacy->materials[0] = m;
    convert(scene, &PLAIN);
    assert_int_equal(scene->materials[0].textures[SCENE_BASE_COLOR_TEXTURE].texture, shared);
    assert_int_equal(scene->materials[0].alpha_mode, SCENE_ALPHA_MASK);
    assert_int_equal(scene->materials[1].textures[SCENE_BASE_COLOR_TEXTURE].texture, shared);
    assert_int_equal(scene->materials[1].alpha_mode, SCENE_ALPHA_OPAQUE);
    assert_int_equal(scene->texture_count, 1);
    scene_destroy(scene);
}

/* ---- relief ---- */

static void heights_become_normals(void **state)
{
    (void)state;
    enum { SIZE = 8 };
    uint16_t ramp[SIZE * SIZE]; /* 16 bits: steps far below one code of 8 */
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++)
            ramp[y * SIZE + x] = (uint16_t)(20000 + 100 * x + 300 * y);
    facet_scene *scene = legacy_scene(1);
    uint32_t texture = add_image_texture(scene, SIZE, SIZE, 1, ramp, IMAGE_U16);
    scene->textures[texture].wrap_u = scene->textures[texture].wrap_v = SCENE_WRAP_CLAMP;
    legacy_material m = shiny();
    set_map(&m, LEGACY_BUMP_MAP, texture);
    m.maps[LEGACY_BUMP_MAP].bump_multiplier = 100;
    scene->legacy->materials[0] = m;
    convert(scene, &PLAIN);
    assert_false(has_warning(scene, 0, "bump-as-normal"));
    /* The range rises by 0.02 bm of the width: 16 texels here. */
    double dx = 0.02 * 100 * SIZE * 100 / 65535.0;
    double dy = 0.02 * 100 * SIZE * 300 / 65535.0; /* downwards */
    double length = sqrt(dx * dx + dy * dy + 1);
    uint8_t t[4];
    texel_at(scene, scene->materials[0].textures[SCENE_NORMAL_TEXTURE].texture, 3 * SIZE + 3, t);
    assert_near(t[0] / 255.0 * 2 - 1, -dx / length, 1.0 / 255);
    assert_near(t[1] / 255.0 * 2 - 1, dy / length, 1.0 / 255);
    assert_near(t[2] / 255.0 * 2 - 1, 1 / length, 1.0 / 255);
    assert_near(scene->materials[0].normal_scale, 1, 0);
    scene_destroy(scene);
}

static void normals_under_bump_are_found(void **state)
{
    (void)state;
    const uint8_t normals[] = {128, 128, 255, 140, 120, 250, 120, 140, 250, 128, 128, 255};
    facet_scene *scene = legacy_scene(2);
    uint32_t texture = add_texels(scene, 2, 2, 3, normals);
    legacy_material m = shiny();
    set_map(&m, LEGACY_BUMP_MAP, texture);
    m.maps[LEGACY_BUMP_MAP].bump_multiplier = .5f;
    scene->legacy->materials[0] = m;
    set_map(&m, LEGACY_NORMAL_MAP, texture); /* norm overrides bump */
    scene->legacy->materials[1] = m;
    convert(scene, &PLAIN);
    assert_true(has_warning(scene, 0, "bump-as-normal"));
    assert_int_equal(scene->materials[0].textures[SCENE_NORMAL_TEXTURE].texture, texture);
    assert_near(scene->materials[0].normal_scale, .5, 0);
    assert_int_equal(scene->materials[1].textures[SCENE_NORMAL_TEXTURE].texture, texture);
    assert_near(scene->materials[1].normal_scale, 1, 0);
    assert_true(has_warning(scene, 1, "map-dropped"));
    scene_destroy(scene);
}

/* ---- maps of physically based statements ---- */

static void roughness_and_metallic_maps_are_packed(void **state)
{
    (void)state;
    const uint8_t rough[] = {10, 50, 100, 200};
    const uint8_t metal[] = {255, 0, 255, 0};
    facet_scene *scene = legacy_scene(2);
    legacy_material m = shiny();
    m.fields |= LEGACY_ROUGHNESS | LEGACY_SHEEN;
    m.roughness = .5f;
    m.sheen = 1;
    set_map(&m, LEGACY_ROUGHNESS_MAP, add_texels(scene, 2, 2, 1, rough));
    set_map(&m, LEGACY_METALLIC_MAP, add_texels(scene, 2, 2, 1, metal));
    set_map(&m, LEGACY_SHEEN_MAP, m.maps[LEGACY_ROUGHNESS_MAP].ref.texture);
    scene->legacy->materials[0] = m;
    m = shiny();
    set_map(&m, LEGACY_ORM_MAP, add_texels(scene, 2, 2, 3, WOOD));
    scene->legacy->materials[1] = m;
    convert(scene, &PLAIN);
    const scene_material *out = scene->materials;
    assert_near(out[0].perceptual_roughness, .5, 0);
    assert_near(out[0].metallic, 1, 0);
    for (size_t i = 0; i < 4; i++) {
        uint8_t t[4];
        texel_at(scene, out[0].textures[SCENE_METALLIC_ROUGHNESS_TEXTURE].texture, i, t);
        assert_int_equal(t[1], rough[i]);
        assert_int_equal(t[2], metal[i]);
        texel_at(scene, out[0].textures[SCENE_SHEEN_COLOR_TEXTURE].texture, i, t);
        assert_near(light_of(t[0]), rough[i] / 255.0, .004);
    }
    uint32_t orm = scene->legacy->materials[1].maps[LEGACY_ORM_MAP].ref.texture;
    assert_int_equal(out[1].textures[SCENE_METALLIC_ROUGHNESS_TEXTURE].texture, orm);
    assert_int_equal(out[1].textures[SCENE_OCCLUSION_TEXTURE].texture, orm);
    scene_destroy(scene);
}

static void rma_maps_are_reordered(void **state)
{
    (void)state;
    facet_scene *scene = legacy_scene(1);
    legacy_material m = shiny();
    set_map(&m, LEGACY_ORM_MAP, add_texels(scene, 2, 2, 3, WOOD));
    m.is_rma = true;
    scene->legacy->materials[0] = m;
    convert(scene, &PLAIN);
    for (size_t i = 0; i < 4; i++) {
        uint8_t t[4];
        texel_at(scene, scene->materials[0].textures[SCENE_OCCLUSION_TEXTURE].texture, i, t);
        assert_int_equal(t[0], WOOD[i * 3 + 2]);
        assert_int_equal(t[1], WOOD[i * 3]);
        assert_int_equal(t[2], WOOD[i * 3 + 1]);
    }
    scene_destroy(scene);
}

static void obj2gltf_maps_are_in_ks_and_ns(void **state)
{
    (void)state;
    const uint8_t values[] = {10, 50, 100, 200};
    facet_scene *scene = legacy_scene(1);
    legacy_material m = legacy_material_default();
    set_map(&m, LEGACY_SHININESS_MAP, add_texels(scene, 2, 2, 1, values));
    set_map(&m, LEGACY_SPECULAR_MAP, add_texels(scene, 2, 2, 3, METAL));
    scene->legacy->materials[0] = m;
    convert(scene, &(facet_legacy_desc){.dialect = FACET_MTL_DIALECT_OBJ2GLTF_MR});
    uint8_t t[4];
    assert_near(scene->materials[0].metallic, 1, 0);
    texel_at(scene, scene->materials[0].textures[SCENE_METALLIC_ROUGHNESS_TEXTURE].texture, 1, t);
    assert_int_equal(t[1], 50);
    assert_int_equal(t[2], 20);
    convert(scene, &(facet_legacy_desc){.dialect = FACET_MTL_DIALECT_OBJ2GLTF_SG});
    assert_int_equal(scene->materials[0].textures[SCENE_SPECULAR_COLOR_TEXTURE].texture,
                     scene->legacy->materials[0].maps[LEGACY_SPECULAR_MAP].ref.texture);
    pbr_surface s = surface_at(scene, 0, 1);
    assert_near(s.perceptual_roughness, 1 - 50 / 255.0, 1e-6);
    scene_destroy(scene);
}

static void ambient_maps_become_occlusion(void **state)
{
    (void)state;
    facet_scene *scene = legacy_scene(2);
    legacy_material m = shiny();
    set_map(&m, LEGACY_AMBIENT_MAP, add_texels(scene, 2, 2, 1, FADE));
    scene->legacy->materials[0] = scene->legacy->materials[1] = m;
    scene->legacy->materials[1].fields |= LEGACY_EMISSION;
    set_color(scene->legacy->materials[1].emission, .5f, .5f, .5f);
    convert(scene, &(facet_legacy_desc){.ambient = FACET_LEGACY_AMBIENT_OCCLUSION});
    assert_int_equal(scene->materials[0].textures[SCENE_OCCLUSION_TEXTURE].texture, 0);
    convert(scene, &(facet_legacy_desc){.ambient = FACET_LEGACY_AMBIENT_EMISSIVE});
    assert_false(scene_material_has(&scene->materials[0], SCENE_OCCLUSION_TEXTURE));
    assert_int_equal(scene->materials[0].textures[SCENE_EMISSIVE_TEXTURE].texture, 0);
    assert_false(has_warning(scene, 0, "ambient-dropped"));
    assert_true(has_warning(scene, 1, "ambient-dropped"));
    scene_destroy(scene);
}

/* ---- rgl ---- */

static void rgl_texture_modes_are_converted(void **state)
{
    (void)state;
    const uint8_t texels[] = {200, 100, 0, 128, 10, 20, 30, 255, 255, 255, 255, 0, 0, 0, 0, 255};
    facet_scene *scene = legacy_scene(6);
    scene->legacy->is_rgl = true;
    uint32_t texture = add_texels(scene, 2, 2, 4, texels);
    for (int i = 0; i < 6; i++) {
        legacy_material m = shiny();
        set_color(m.specular, 0, 0, 0);
        set_color(m.diffuse, 1, 1, 1);
        set_map(&m, LEGACY_DIFFUSE_MAP, texture);
        scene->legacy->materials[i] = m;
    }
    legacy_material *m = scene->legacy->materials;
    m[0].texture_type = LEGACY_RGBA;
    m[1].texture_mode = LEGACY_REPLACE;
    m[2].texture_mode = LEGACY_BLEND;
    m[3].texture_mode = LEGACY_ADD;
    m[4].texture_type = LEGACY_ALPHA;
    m[5].has_environment_map = true;
    convert(scene, &PLAIN);
    const scene_material *out = scene->materials;
    uint8_t t[4];
    assert_string_equal(scene->conversion->materials[0].summary.source, "ogl1");
    assert_int_equal(out[0].alpha_mode, SCENE_ALPHA_BLEND);
    assert_int_equal(out[0].textures[SCENE_BASE_COLOR_TEXTURE].texture, texture);
    assert_true(out[1].extensions & SCENE_UNLIT);
    texel_at(scene, out[2].textures[SCENE_BASE_COLOR_TEXTURE].texture, 0, t);
    for (int k = 0; k < 3; k++)
        assert_in_range(t[k] + 1, 255 - texels[k], 255 - texels[k] + 2);
    assert_int_equal(out[3].textures[SCENE_EMISSIVE_TEXTURE].texture, texture);
    assert_color(out[3].emissive, 1, 1, 1, 0);
    assert_false(scene_material_has(&out[3], SCENE_BASE_COLOR_TEXTURE));
    texel_at(scene, out[4].textures[SCENE_BASE_COLOR_TEXTURE].texture, 0, t);
    assert_int_equal(t[3], 100); /* the mean of 200, 100, 0 */
    assert_int_equal(out[4].alpha_mode, SCENE_ALPHA_BLEND);
    assert_true(has_warning(scene, 5, "map-dropped"));
    scene_destroy(scene);
}

static void rgl_textures_modulate_highlights(void **state)
{
    (void)state;
    facet_scene *scene = legacy_scene(1);
    scene->legacy->is_rgl = true;
    scene->legacy->materials[0] = shiny();
    set_map(&scene->legacy->materials[0], LEGACY_DIFFUSE_MAP, add_texels(scene, 2, 2, 3, METAL));
    convert(scene, &PLAIN);
    assert_false(has_warning(scene, 0, "ks-map-used-as-specular"));
    pbr_surface s = surface_at(scene, 0, 3); /* a black texel shows no highlight */
    assert_near(s.specular, 0, 1e-6);
    s = surface_at(scene, 0, 2);
    assert_near(s.specular, .3f * reflectance_share_from_shininess(40), .002);
    scene_destroy(scene);
}

static void vertex_colors_replace_rgls(void **state)
{
    (void)state;
    const float colors[4] = {1, 0, 0, 1};
    for (int is_rgl = 0; is_rgl < 2; is_rgl++) {
        facet_scene *scene = legacy_scene(1);
        scene->legacy->is_rgl = is_rgl;
        scene->legacy->materials[0] = shiny();
        set_color(scene->legacy->materials[0].specular, 0, 0, 0);
        scene_primitive primitive = {.colors = colors, .material = 0};
        scene_mesh mesh = {.name = "", .primitive_count = 1, .primitives = &primitive};
        scene->meshes = &mesh;
        scene->mesh_count = 1;
        convert(scene, &PLAIN);
        assert_near(scene->materials[0].base_color[0], is_rgl ? 1 : .6, 1e-6);
        scene_destroy(scene);
    }
}

/* ---- broken images ---- */

static void broken_images_count_as_absent(void **state)
{
    (void)state;
    facet_scene *scene = legacy_scene(1);
    uint32_t wood = add_texels(scene, 2, 2, 3, WOOD);
    scene->images[0].size /= 2;
    legacy_material m = shiny();
    set_map(&m, LEGACY_DIFFUSE_MAP, wood);
    set_map(&m, LEGACY_BUMP_MAP, wood);
    scene->legacy->materials[0] = m;
    convert(scene, &PLAIN);
    assert_true(has_warning(scene, 0, "texture-missing"));
    assert_false(scene_material_has(&scene->materials[0], SCENE_BASE_COLOR_TEXTURE));
    assert_false(scene_material_has(&scene->materials[0], SCENE_NORMAL_TEXTURE));
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plain_diffuse_map_stays_its_file),
        cmocka_unit_test(a_factor_above_one_is_baked),
        cmocka_unit_test(black_and_unstated_factors_are_white_with_a_map),
        cmocka_unit_test(specular_and_shininess_maps_are_converted_by_texel),
        cmocka_unit_test(the_core_profile_packs_metallic_and_roughness),
        cmocka_unit_test(smaller_maps_are_brought_to_the_size_of_the_largest),
        cmocka_unit_test(maps_with_other_coordinates_are_averaged),
        cmocka_unit_test(places_and_samplers_are_kept),
        cmocka_unit_test(equal_textures_are_made_once),
        cmocka_unit_test(map_options_base_gain_and_channel_apply),
        cmocka_unit_test(opacity_maps_go_into_the_base_color),
        cmocka_unit_test(a_shared_image_of_color_and_opacity_stays),
        cmocka_unit_test(heights_become_normals),
        cmocka_unit_test(normals_under_bump_are_found),
        cmocka_unit_test(roughness_and_metallic_maps_are_packed),
        cmocka_unit_test(rma_maps_are_reordered),
        cmocka_unit_test(obj2gltf_maps_are_in_ks_and_ns),
        cmocka_unit_test(ambient_maps_become_occlusion),
        cmocka_unit_test(rgl_texture_modes_are_converted),
        cmocka_unit_test(rgl_textures_modulate_highlights),
        cmocka_unit_test(vertex_colors_replace_rgls),
        cmocka_unit_test(broken_images_count_as_absent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
