/* convert_read_test.c - every row of the mapping in docs/legacy.md, and every warning of one material. */
#include "legacy/convert_test_support.h"

static const facet_legacy_desc PLAIN = {0};

#define ALL_BLINN_PHONG (LEGACY_DIFFUSE | LEGACY_SPECULAR | LEGACY_SHININESS)

static legacy_material gold(void)
{
    legacy_material m = legacy_material_default();
    m.name = "gold";
    m.fields = ALL_BLINN_PHONG;
    set_color(m.diffuse, .75164f, .60648f, .22648f);
    set_color(m.specular, .628281f, .555802f, .366065f);
    m.shininess = 51.2f;
    return m;
}

/* ---- Kd, Ks, Ns ---- */

static void blinn_phong_becomes_specular_and_ior(void **state)
{
    (void)state;
    facet_scene *scene = convert_one(gold(), &PLAIN);
    const scene_material *m = &scene->materials[0];
    ogl1_surface in = {{.75164f, .60648f, .22648f}, {.628281f, .555802f, .366065f}, 51.2f};
    pbr_surface wanted;
    ogl1_to_pbr_closed(&in, &wanted);
    assert_int_equal(m->extensions, SCENE_SPECULAR | SCENE_IOR);
    assert_color(m->base_color, wanted.base_color[0], wanted.base_color[1], wanted.base_color[2], 0);
    assert_near(m->base_color[3], 1, 0);
    assert_near(m->metallic, 0, 0);
    assert_near(m->perceptual_roughness, wanted.perceptual_roughness, 0);
    assert_near(m->ior, 0, 0);
    assert_near(m->specular, wanted.specular, 0);
    assert_true(m->is_double_sided); /* OpenGL 1 is two-sided */
    assert_int_equal(m->alpha_mode, SCENE_ALPHA_OPAQUE);
    const facet_conversion *c = &scene->conversion->materials[0].summary;
    assert_string_equal(c->method, "closed");
    assert_string_equal(c->profile, "specular+ior");
    assert_string_equal(c->source, "mtl");
    assert_near(c->error, .070, .0075); /* of an independent fit */
    assert_near(c->error_naive, .160, .005);
    assert_true(c->error_core > c->error && c->error_core < 1);
    assert_int_equal(c->grade,
                     c->error_display < .05 ? FACET_CONVERSION_GRADE_GOOD : FACET_CONVERSION_GRADE_FAIR);
    assert_near(scene->conversion->light_scale, 3.14159265, 1e-8);
    scene_destroy(scene);
}

/* Vertex colors replace a Kd that is not stated, and multiply one that is. */
static void vertex_colors_replace_a_default(void **state)
{
    (void)state;
    static const float colors[4] = {1, 1, 1, 1};
    for (int is_stated = 0; is_stated < 2; is_stated++) {
        scene_primitive primitive = {.vertex_count = 1, .colors = colors};
        scene_mesh mesh = {.primitives = &primitive, .primitive_count = 1};
        facet_scene *scene = legacy_scene(1);
        scene->meshes = &mesh;
        scene->mesh_count = 1;
        legacy_material m = legacy_material_default();
        m.fields = is_stated ? LEGACY_DIFFUSE : 0;
        scene->legacy->materials[0] = m;
        convert(scene, &PLAIN);
        float wanted = is_stated ? .8f : 1.0f; /* its colors are linear */
        assert_color(scene->materials[0].base_color, wanted, wanted, wanted, 1e-4);
        scene_destroy(scene);
    }
}

static void fit_and_core_are_options(void **state)
{
    (void)state;
    facet_scene *fit = convert_one(gold(), &(facet_legacy_desc){.method = FACET_LEGACY_METHOD_FIT});
    assert_string_equal(fit->conversion->materials[0].summary.method, "fit");
    assert_near(fit->conversion->materials[0].summary.error, .068, .0064);
    facet_scene *core = convert_one(gold(), &(facet_legacy_desc){.method = FACET_LEGACY_METHOD_FIT,
                                                                 .profile = FACET_LEGACY_PROFILE_CORE});
    const facet_conversion *c = &core->conversion->materials[0].summary;
    assert_int_equal(core->materials[0].extensions, 0);
    assert_string_equal(c->profile, "core");
    assert_near(c->error, .093, .0077);
    assert_near(c->error_core, c->error, 0);
    scene_destroy(fit);
    scene_destroy(core);
}

/* Without extensions black becomes the darkest that core glTF has, a rough black metal. */
static void black_becomes_the_darkest_of_the_core(void **state)
{
    (void)state;
    legacy_material m = gold();
    set_color(m.diffuse, 0, 0, 0);
    set_color(m.specular, 0, 0, 0);
    facet_scene *scene = convert_one(m, &(facet_legacy_desc){.profile = FACET_LEGACY_PROFILE_CORE});
    const scene_material *out = &scene->materials[0];
    double E = scene->conversion->materials[0].summary.error;
    fit_metric *metric;
    ogl1_surface black = {{0, 0, 0}, {0, 0, 0}, 51.2f};
    assert_near(out->metallic, 1, .01);
    assert_near(out->perceptual_roughness, 1, .01);
    assert_color(out->base_color, 0, 0, 0, 1e-4);
    assert_int_equal(fit_metric_create(NULL, PBR_CORRELATED, &metric, NULL), FACET_OK);
    for (int i = 0; i <= 10; i++)
        for (int j = 0; j <= 10; j++) {
            pbr_surface other = pbr_surface_default();
            set_color(other.base_color, 0, 0, 0);
            other.metallic = .1f * (float)i;
            other.perceptual_roughness = .1f * (float)j;
            assert_true(fit_compare(metric, &black, &other, FIT_FROM_OGL1).E >= E * .999);
        }
    fit_metric_destroy(metric);
    scene_destroy(scene);
}

static void colors_are_srgb_or_linear(void **state)
{
    (void)state;
    legacy_material m = gold();
    set_color(m.specular, 0, 0, 0);
    set_color(m.diffuse, .5f, .5f, .5f);
    facet_scene *linear = convert_one(m, &(facet_legacy_desc){.colors = FACET_LEGACY_COLORS_LINEAR});
    facet_scene *srgb = convert_one(m, &(facet_legacy_desc){.colors = FACET_LEGACY_COLORS_SRGB});
    assert_near(linear->materials[0].base_color[0], .5, 1e-6);
    assert_near(srgb->materials[0].base_color[0], .21404, 1e-4);
    assert_int_equal(srgb->legacy->colors, FACET_LEGACY_COLORS_SRGB);
    assert_false(has_warning(srgb, SCENE_NONE, "color-space-assumed"));
    facet_scene *unsaid = convert_one(m, &PLAIN);
    assert_true(has_warning(unsaid, SCENE_NONE, "color-space-assumed"));
    scene_destroy(linear);
    scene_destroy(srgb);
    scene_destroy(unsaid);
}

/* The lamp of the Cornell box is 17, 12, 4; an emission up to 1 is a color. */
static void emission_above_1_suggests_linear_colors(void **state)
{
    (void)state;
    static const char code[] = "colors-may-be-linear";
    static const facet_legacy_desc srgb = {.colors = FACET_LEGACY_COLORS_SRGB};
    static const facet_legacy_desc linear = {.colors = FACET_LEGACY_COLORS_LINEAR};
    legacy_material lamp = gold();
    set_color(lamp.emission, 17, 12, 4);
    legacy_material screen = gold();
    set_color(screen.emission, 1, .5f, 0);
    const struct {
        legacy_material material;
        const facet_legacy_desc *desc;
        bool is_noted;
    } cases[] = {{lamp, &PLAIN, true}, {screen, &PLAIN, false}, {lamp, &srgb, false}, {lamp, &linear, false}};
    for (size_t i = 0; i < 4; i++) {
        facet_scene *scene = legacy_scene(1);
        scene->legacy->colors = FACET_LEGACY_COLORS_SRGB;
        scene->legacy->materials[0] = cases[i].material;
        convert(scene, cases[i].desc);
        assert_int_equal(has_warning(scene, 0, code), cases[i].is_noted);
        assert_int_equal(scene->warning_count > 0, cases[i].is_noted);
        scene_destroy(scene);
    }
}

static void remarks_of_the_fit_are_reported(void **state)
{
    (void)state;
    legacy_material m = gold();
    set_color(m.diffuse, 1, 1, 1);
    set_color(m.specular, 1, 1, 1);
    m.shininess = 2;
    facet_scene *scene = convert_one(m, &PLAIN);
    assert_true(has_warning(scene, 0, "energy-gain"));
    assert_true(has_warning(scene, 0, "base-clamped"));
    assert_true(has_warning(scene, 0, "low-exponent"));
    scene_destroy(scene);
    m = gold();
    set_color(m.specular, .1f, .1f, .1f);
    scene = convert_one(m, &PLAIN);
    assert_false(has_warning(scene, 0, "energy-gain"));
    assert_false(has_warning(scene, 0, "low-exponent"));
    scene_destroy(scene);
}

/* ---- Ke, Ka ---- */

static void emission_above_one_becomes_strength(void **state)
{
    (void)state;
    legacy_material m = gold();
    m.fields |= LEGACY_EMISSION;
    set_color(m.emission, 17, 12, 4);
    facet_scene *scene = convert_one(m, &PLAIN);
    const scene_material *out = &scene->materials[0];
    assert_true(out->extensions & SCENE_EMISSIVE_STRENGTH);
    assert_near(out->emissive_strength, 17, 1e-5);
    for (int k = 0; k < 3; k++)
        assert_near(out->emissive[k] * out->emissive_strength, m.emission[k], 1e-5);
    scene_destroy(scene);
    set_color(m.emission, .5f, 0, 0);
    scene = convert_one(m, &PLAIN);
    assert_false(scene->materials[0].extensions & SCENE_EMISSIVE_STRENGTH);
    assert_near(scene->materials[0].emissive[0], .5, 1e-6);
    scene_destroy(scene);
}

static void ambient_is_dropped_or_emitted(void **state)
{
    (void)state;
    legacy_material m = gold();
    m.fields |= LEGACY_AMBIENT;
    set_color(m.ambient, .2f, .1f, 0);
    facet_scene *dropped = convert_one(m, &PLAIN);
    assert_true(has_warning(dropped, 0, "ambient-dropped"));
    assert_near(dropped->materials[0].emissive[0], 0, 0);
    facet_scene *emitted = convert_one(m, &(facet_legacy_desc){.ambient = FACET_LEGACY_AMBIENT_EMISSIVE});
    assert_false(has_warning(emitted, 0, "ambient-dropped"));
    assert_color(emitted->materials[0].emissive, .2f, .1f, 0, 1e-6);
    /* Exporters write Ka of 0 or equal to Kd without meaning. */
    memcpy(m.ambient, m.diffuse, sizeof m.ambient);
    facet_scene *equal = convert_one(m, &PLAIN);
    assert_false(has_warning(equal, 0, "ambient-dropped"));
    scene_destroy(dropped);
    scene_destroy(emitted);
    scene_destroy(equal);
}

/* ---- opacity ---- */

static void opacity_becomes_alpha(void **state)
{
    (void)state;
    legacy_material m = gold();
    m.fields |= LEGACY_OPACITY;
    m.opacity = .25f;
    facet_scene *scene = convert_one(m, &PLAIN);
    assert_int_equal(scene->materials[0].alpha_mode, SCENE_ALPHA_BLEND);
    assert_near(scene->materials[0].base_color[3], .25, 1e-6);
    scene_destroy(scene);
    m.opacity = 0; /* invisible, and not known to be a mistake */
    scene = convert_one(m, &PLAIN);
    assert_near(scene->materials[0].base_color[3], 0, 0);
    assert_false(has_warning(scene, 0, "zero-alpha"));
    scene_destroy(scene);
    m.is_transparency_ambiguous = true;
    m.is_halo = true;
    m.opacity = .5f;
    scene = convert_one(m, &PLAIN);
    assert_true(has_warning(scene, 0, "tr-ambiguous"));
    assert_true(has_warning(scene, 0, "halo-dropped"));
    scene_destroy(scene);
}

/* Two primitives; the second one has no material, the same, or one of another opacity. */
static void opacity_0_of_all_drawn_materials_counts_as_1(void **state)
{
    (void)state;
    static const struct {
        uint32_t second;
        float opacity;
        bool is_rgl;
        double wanted;
    } cases[] = {
        {0, 0, false, 1}, {1, 0, false, 1}, {1, .5f, false, 0}, {SCENE_NONE, 0, false, 0}, {1, 0, true, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        scene_primitive primitives[2] = {{.material = 0}, {.material = cases[i].second}};
        scene_mesh mesh = {.primitives = primitives, .primitive_count = 2};
        facet_scene *scene = legacy_scene(2);
        scene->meshes = &mesh;
        scene->mesh_count = 1;
        scene->legacy->is_rgl = cases[i].is_rgl;
        for (int k = 0; k < 2; k++) {
            scene->legacy->materials[k] = gold();
            scene->legacy->materials[k].fields |= LEGACY_OPACITY;
            scene->legacy->materials[k].opacity = k ? cases[i].opacity : 0;
        }
        convert(scene, &PLAIN);
        assert_near(scene->materials[0].base_color[3], cases[i].wanted, 0);
        assert_true(has_warning(scene, 0, "zero-alpha") == (cases[i].wanted > 0));
        scene_destroy(scene);
    }
}

static void glass_becomes_transmission_on_request(void **state)
{
    (void)state;
    const facet_legacy_desc glass = {.has_glass = true};
    legacy_material m = gold();
    m.fields |= LEGACY_OPACITY | LEGACY_ILLUM | LEGACY_IOR | LEGACY_TRANSMISSION_FILTER;
    m.opacity = .2f;
    m.illum = 4;
    m.ior = 1.33f;
    facet_scene *scene = convert_one(m, &glass);
    const scene_material *out = &scene->materials[0];
    assert_true(out->extensions & SCENE_TRANSMISSION && out->extensions & SCENE_IOR);
    assert_false(out->extensions & (SCENE_SPECULAR | SCENE_VOLUME));
    assert_near(out->transmission, .8, 1e-6);
    assert_near(out->ior, 1.33, 1e-6);
    assert_near(out->base_color[3], 1, 0);
    assert_int_equal(out->alpha_mode, SCENE_ALPHA_OPAQUE);
    scene_destroy(scene);
    scene = convert_one(m, &PLAIN); /* not enabled */
    assert_false(scene->materials[0].extensions & SCENE_TRANSMISSION);
    assert_near(scene->materials[0].base_color[3], .2, 1e-6);
    scene_destroy(scene);
    /* illum 7: refraction, strength and tint from Tf; a volume needs geometry with an extent. */
    m.opacity = 1;
    m.illum = 7;
    set_color(m.transmission_filter, .5f, 1, .5f);
    set_color(m.diffuse, 0, 0, 0);
    scene = legacy_scene(1);
    scene->legacy->materials[0] = m;
    scene_primitive primitive = {.bounds_min = {-1, -2, -3}, .bounds_max = {1, 2, 3}, .material = 0};
    scene_mesh mesh = {.name = "", .primitive_count = 1, .primitives = &primitive};
    scene->meshes = &mesh;
    scene->mesh_count = 1;
    convert(scene, &glass);
    out = &scene->materials[0];
    assert_near(out->transmission, 1, 1e-6);
    assert_color(out->base_color, .5f, 1, .5f, 1e-6);
    assert_true(out->extensions & SCENE_VOLUME);
    assert_near(out->thickness, 2, 1e-6);
    assert_true(isnan(scene->conversion->materials[0].summary.error));
    scene_destroy(scene);
}

/* ---- illum, lit, sides ---- */

static void illum_is_honored_unless_contradicted(void **state)
{
    (void)state;
    legacy_material m = gold();
    m.fields |= LEGACY_ILLUM;
    m.illum = 0;
    facet_scene *scene = convert_one(m, &PLAIN); /* Ks is not black */
    assert_true(has_warning(scene, 0, "illum-ignored"));
    assert_false(scene->materials[0].extensions & SCENE_UNLIT);
    scene_destroy(scene);
    scene = convert_one(m, &(facet_legacy_desc){.illum = FACET_MTL_ILLUM_HONOR});
    assert_true(has_warning(scene, 0, "illum-honoured"));
    assert_int_equal(scene->materials[0].extensions, SCENE_UNLIT);
    assert_near(scene->materials[0].base_color[0], .75164, 1e-6);
    assert_string_equal(scene->conversion->materials[0].summary.method, "exact");
    scene_destroy(scene);
    m.illum = 1;
    scene = convert_one(m, &(facet_legacy_desc){.illum = FACET_MTL_ILLUM_HONOR});
    assert_true(has_warning(scene, 0, "illum-honoured"));
    assert_near(scene->materials[0].specular, 0, 0);
    scene_destroy(scene);
    /* known to write it on purpose */
    scene = convert_one(m, &(facet_legacy_desc){.dialect = FACET_MTL_DIALECT_BLENDER27});
    assert_true(has_warning(scene, 0, "illum-honoured"));
    scene_destroy(scene);
    set_color(m.specular, 0, 0, 0);
    m.illum = 0;
    scene = convert_one(m, &PLAIN);
    assert_true(scene->materials[0].extensions & SCENE_UNLIT);
    scene_destroy(scene);
    scene = convert_one(m, &(facet_legacy_desc){.illum = FACET_MTL_ILLUM_IGNORE});
    assert_false(scene->materials[0].extensions & SCENE_UNLIT);
    assert_true(has_warning(scene, 0, "illum-ignored"));
    scene_destroy(scene);
    m.illum = 10;
    scene = convert_one(m, &PLAIN);
    assert_true(has_warning(scene, 0, "illum-ignored"));
    scene_destroy(scene);
}

static void materials_without_lighting_are_unlit(void **state)
{
    (void)state;
    legacy_material m = gold();
    m.is_lit = false;
    m.is_culled = true;
    facet_scene *scene = convert_one(m, &PLAIN);
    assert_int_equal(scene->materials[0].extensions, SCENE_UNLIT);
    assert_false(scene->materials[0].is_double_sided);
    assert_color(scene->materials[0].base_color, .75164f, .60648f, .22648f, 1e-6);
    scene_destroy(scene);
}

/* ---- MTL's extension for physically based materials ---- */

static void pbr_statements_win(void **state)
{
    (void)state;
    legacy_material m = gold();
    m.fields |= LEGACY_ROUGHNESS | LEGACY_METALLIC | LEGACY_SHEEN | LEGACY_CLEARCOAT |
                LEGACY_CLEARCOAT_ROUGHNESS | LEGACY_ANISOTROPY | LEGACY_ANISOTROPY_ROTATION;
    m.roughness = .3f;
    m.metallic = .9f;
    m.sheen = .2f;
    m.clearcoat = .8f;
    m.clearcoat_roughness = .1f;
    m.anisotropy = .6f;
    m.anisotropy_rotation = .25f;
    facet_scene *scene = convert_one(m, &PLAIN);
    const scene_material *out = &scene->materials[0];
    assert_int_equal(out->extensions, SCENE_SHEEN | SCENE_CLEARCOAT | SCENE_ANISOTROPY);
    assert_color(out->base_color, .75164f, .60648f, .22648f, 1e-6);
    assert_near(out->perceptual_roughness, .3, 1e-6);
    assert_near(out->metallic, .9, 1e-6);
    assert_near(out->sheen_color[1], .2, 1e-6);
    assert_near(out->clearcoat, .8, 1e-6);
    assert_near(out->clearcoat_roughness, .1, 1e-6);
    assert_near(out->anisotropy, .6, 1e-6);
    assert_near(out->anisotropy_rotation, 1.5707963, 1e-6);
    assert_string_equal(scene->conversion->materials[0].summary.method, "exact");
    scene_destroy(scene);
    m.fields = ALL_BLINN_PHONG | LEGACY_METALLIC; /* the other is still Ns's */
    scene = convert_one(m, &PLAIN);
    assert_near(scene->materials[0].perceptual_roughness, perceptual_roughness_from_shininess(51.2f), 1e-6);
    scene_destroy(scene);
}

/* ---- dialects ---- */

static facet_scene *in_dialect(legacy_material m, facet_mtl_dialect dialect)
{
    return convert_one(m, &(facet_legacy_desc){.dialect = dialect});
}

static void dialects_put_roughness_elsewhere(void **state)
{
    (void)state;
    legacy_material m = gold();
    m.fields |= LEGACY_AMBIENT | LEGACY_ILLUM;
    set_color(m.specular, .5f, .5f, .5f);
    set_color(m.ambient, .7f, .7f, .7f);
    m.illum = 3;
    m.shininess = 225; /* roughness .5 of Blender 2.8 */
    facet_scene *scene = in_dialect(m, FACET_MTL_DIALECT_BLENDER28);
    assert_near(scene->materials[0].perceptual_roughness, .5, 1e-5);
    assert_near(scene->materials[0].metallic, .7, 1e-6);
    assert_false(scene->materials[0].extensions & SCENE_SPECULAR); /* a level of .5 is glTF's 0.04 */
    assert_false(has_warning(scene, 0, "ambient-dropped"));
    scene_destroy(scene);
    m.shininess = 250; /* the same of Blender 3 */
    m.illum = 2;       /* no mirror: Ka has no meaning */
    set_color(m.specular, .25f, .25f, .25f);
    m.fields |= LEGACY_CLEARCOAT;
    m.clearcoat = 1;
    scene = in_dialect(m, FACET_MTL_DIALECT_BLENDER3);
    assert_near(scene->materials[0].perceptual_roughness, .5, 1e-5);
    assert_near(scene->materials[0].metallic, 0, 0);
    assert_true(scene->materials[0].extensions & SCENE_SPECULAR);
    assert_near(scene->materials[0].specular, .5, 1e-6);
    assert_near(scene->materials[0].clearcoat, .25, 1e-6);
    scene_destroy(scene);
    m = gold();
    m.shininess = 96.078431f; /* hardness 50 */
    scene = in_dialect(m, FACET_MTL_DIALECT_BLENDER27);
    assert_near(scene->materials[0].perceptual_roughness, perceptual_roughness_from_shininess(50), 1e-4);
    scene_destroy(scene);
    m.shininess = .3f;
    set_color(m.specular, .9f, .9f, .9f);
    scene = in_dialect(m, FACET_MTL_DIALECT_OBJ2GLTF_MR);
    assert_near(scene->materials[0].perceptual_roughness, .3, 1e-6);
    assert_near(scene->materials[0].metallic, .9, 1e-6);
    scene_destroy(scene);
    scene = in_dialect(m, FACET_MTL_DIALECT_OBJ2GLTF_SG);
    assert_int_equal(scene->materials[0].extensions, SCENE_SPECULAR | SCENE_IOR);
    assert_near(scene->materials[0].perceptual_roughness, .7, 1e-6);
    assert_near(scene->materials[0].ior, 0, 0);
    assert_color(scene->materials[0].specular_color, .9f, .9f, .9f, 1e-6);
    scene_destroy(scene);
}

/* A highlight over the whole surface is ignored in every dialect, except with the literal format;
 * Blender's newer exporters and obj2gltf have a roughness there. */
static void widest_highlights_are_dropped(void **state)
{
    (void)state;
    static const facet_mtl_dialect dialects[] = {FACET_MTL_DIALECT_AUTO,       FACET_MTL_DIALECT_SPEC,
                                                 FACET_MTL_DIALECT_BLENDER27,  FACET_MTL_DIALECT_BLENDER28,
                                                 FACET_MTL_DIALECT_BLENDER3,   FACET_MTL_DIALECT_OBJ2GLTF_MR,
                                                 FACET_MTL_DIALECT_OBJ2GLTF_SG};
    static const float exponents[] = {0, .25f, 1};
    for (size_t d = 0; d < sizeof dialects / sizeof *dialects; d++)
        for (int i = -1; i < 3; i++) { /* -1: not stated */
            legacy_material m = legacy_material_default();
            m.fields = LEGACY_DIFFUSE | LEGACY_SPECULAR | (i >= 0 ? LEGACY_SHININESS : 0);
            set_color(m.diffuse, .8f, .2f, .2f);
            set_color(m.specular, .9f, .9f, .9f);
            m.shininess = i >= 0 ? exponents[i] : 0;
            facet_scene *scene = in_dialect(m, dialects[d]);
            const scene_material *out = &scene->materials[0];
            bool is_exponent = dialects[d] <= FACET_MTL_DIALECT_BLENDER27;
            bool is_literal = dialects[d] == FACET_MTL_DIALECT_SPEC;
            assert_true(has_warning(scene, 0, "highlight-ignored") == (is_exponent && !is_literal));
            if (is_literal)
                assert_true(out->base_color[1] > .4f); /* washed out */
            else if (is_exponent)
                assert_near(out->specular, 0, 0);
            if (!is_literal)
                assert_color(out->base_color, .8f, .2f, .2f, 1e-6);
            if (dialects[d] == FACET_MTL_DIALECT_OBJ2GLTF_MR)
                assert_near(out->perceptual_roughness, i >= 0 ? m.shininess : 1, 1e-6);
            else if (!is_literal && dialects[d] != FACET_MTL_DIALECT_OBJ2GLTF_SG)
                assert_true(out->perceptual_roughness > .94f);
            scene_destroy(scene);
        }
}

static void guessed_dialects_are_reported(void **state)
{
    (void)state;
    facet_scene *scene = legacy_scene(1);
    scene->legacy->dialect = FACET_MTL_DIALECT_BLENDER3;
    scene->legacy->is_dialect_guessed = true;
    convert(scene, &PLAIN);
    assert_true(has_warning(scene, SCENE_NONE, "dialect-guessed"));
    scene_destroy(scene);
    scene = legacy_scene(1); /* as in the format: no warning */
    scene->legacy->is_dialect_guessed = true;
    convert(scene, &PLAIN);
    assert_false(has_warning(scene, SCENE_NONE, "dialect-guessed"));
    scene_destroy(scene);
}

/* ---- what has no counterpart ---- */

static void losses_are_reported_and_kept_in_extras(void **state)
{
    (void)state;
    legacy_material m = gold();
    m.fields |= LEGACY_SHARPNESS;
    m.sharpness = 100;
    m.unknown = "alpha_test 1\nfoo 2";
    set_map(&m, LEGACY_REFLECTION_MAP, SCENE_NONE);
    facet_scene *scene = convert_one(m, &PLAIN);
    assert_true(has_warning(scene, 0, "map-dropped"));
    assert_true(has_warning(scene, 0, "sharpness-dropped"));
    assert_true(has_warning(scene, 0, "unknown-key"));
    assert_non_null(strstr(scene->materials[0].meta.extras, "facet_legacy"));
    assert_non_null(strstr(scene->materials[0].meta.extras, "alpha_test"));
    scene_destroy(scene);
    m = gold(); /* known to rgl: kept */
    m.unknown = m.kept = "size 3\nlwd 2";
    scene = convert_one(m, &PLAIN);
    assert_false(has_warning(scene, 0, "unknown-key"));
    assert_non_null(strstr(scene->materials[0].meta.extras, "lwd 2"));
    scene_destroy(scene);
    m.unknown = "foo 1\nsize 3";
    m.kept = m.unknown + 6;
    scene = convert_one(m, &PLAIN);
    assert_true(has_warning(scene, 0, "unknown-key"));
    const conversion_warning *warnings = scene->conversion->materials[0].warnings;
    bool is_alone = false;
    for (uint32_t i = 0; i < scene->conversion->materials[0].warning_count; i++)
        is_alone |= strstr(warnings[i].text, "unknown statements: foo 1") && !strstr(warnings[i].text, "..");
    assert_true(is_alone);
    scene_destroy(scene);
    m = gold();
    m.maps[LEGACY_DIFFUSE_MAP].path = "gone.png";
    m.maps[LEGACY_DIFFUSE_MAP].dropped = "-t 1 1 1";
    scene = convert_one(m, &PLAIN);
    assert_true(has_warning(scene, 0, "texture-missing"));
    assert_true(has_warning(scene, 0, "texture-option-dropped"));
    assert_near(scene->materials[0].base_color[0], scene->materials[0].base_color[0], 0);
    assert_false(scene_material_has(&scene->materials[0], SCENE_BASE_COLOR_TEXTURE));
    scene_destroy(scene);
    scene = legacy_scene(1);
    scene->legacy->fog.mode = LEGACY_FOG_LINEAR;
    convert(scene, &PLAIN);
    assert_true(has_warning(scene, SCENE_NONE, "fog-dropped"));
    assert_non_null(strstr(scene->meta.extras, "fog"));
    scene_destroy(scene);
}

static void restored_materials_are_unchanged(void **state)
{
    (void)state;
    facet_scene *scene = legacy_scene(1);
    scene->legacy->materials[0] = gold();
    scene->legacy->materials[0].is_gltf_restored = true;
    scene->materials[0].metallic = .77f;
    scene->materials[0].base_color[0] = .123f;
    convert(scene, &PLAIN);
    assert_near(scene->materials[0].metallic, .77, 1e-6);
    assert_near(scene->materials[0].base_color[0], .123, 1e-6);
    assert_null(scene->materials[0].meta.extras);
    assert_string_equal(scene->conversion->materials[0].summary.method, "source");
    scene_destroy(scene);
}

/* Notes of every conversion are in the report only; a loss is reported once for all materials. */
static void the_log_has_one_line_per_code(void **state)
{
    (void)state;
    captured_messages log = {0};
    const facet_log capture = capture_log(&log);
    facet_scene *scene = legacy_scene(50);
    for (int i = 0; i < 50; i++) {
        scene->legacy->materials[i] = gold();
        scene->legacy->materials[i].fields |= LEGACY_AMBIENT;
        set_color(scene->legacy->materials[i].ambient, .1f, .1f, .1f);
    }
    assert_int_equal(legacy_convert(scene, FACET_MATERIAL_MODEL_METALLIC_ROUGHNESS, &PLAIN, &capture, NULL),
                     FACET_OK);
    assert_true(has_warning(scene, SCENE_NONE, "legacy-light-pi"));
    assert_null(strstr(log.text, "pi"));
    assert_null(strstr(log.text, "sRGB"));
    assert_non_null(strstr(log.text, "material \"stuff\" and 49 more: the ambient color"));
    assert_int_equal(log.count, 1);
    for (uint32_t i = 0; i < 50; i++)
        assert_true(has_warning(scene, i, "ambient-dropped"));
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blinn_phong_becomes_specular_and_ior),
        cmocka_unit_test(vertex_colors_replace_a_default),
        cmocka_unit_test(fit_and_core_are_options),
        cmocka_unit_test(black_becomes_the_darkest_of_the_core),
        cmocka_unit_test(colors_are_srgb_or_linear),
        cmocka_unit_test(emission_above_1_suggests_linear_colors),
        cmocka_unit_test(remarks_of_the_fit_are_reported),
        cmocka_unit_test(emission_above_one_becomes_strength),
        cmocka_unit_test(ambient_is_dropped_or_emitted),
        cmocka_unit_test(opacity_becomes_alpha),
        cmocka_unit_test(opacity_0_of_all_drawn_materials_counts_as_1),
        cmocka_unit_test(glass_becomes_transmission_on_request),
        cmocka_unit_test(illum_is_honored_unless_contradicted),
        cmocka_unit_test(materials_without_lighting_are_unlit),
        cmocka_unit_test(pbr_statements_win),
        cmocka_unit_test(dialects_put_roughness_elsewhere),
        cmocka_unit_test(widest_highlights_are_dropped),
        cmocka_unit_test(guessed_dialects_are_reported),
        cmocka_unit_test(losses_are_reported_and_kept_in_extras),
        cmocka_unit_test(restored_materials_are_unchanged),
        cmocka_unit_test(the_log_has_one_line_per_code),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
