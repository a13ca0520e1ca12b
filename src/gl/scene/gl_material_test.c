/* gl_material_test.c - materials render as in the preview: textures with their transforms and sets, every
 * extension, alpha modes; single lobes, the white furnace. Exits with 77 where there is no OpenGL. */
#define _XOPEN_SOURCE 700 /* setenv() */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "gl/scene/gl_fixture_test.h"
#include "gl/core/gl_program.h"
#include "scene/material_table.h"

enum { SIZE = 32 };
static gl_fixture_contexts contexts;

static void set3(float out[3], float a, float b, float c)
{
    out[0] = a;
    out[1] = b;
    out[2] = c;
}

/* An image of smooth waves, in which mips and footprints show; its channels differ. */
static uint32_t add_waves(fixture *f, uint32_t seed)
{
    enum { EDGE = 32 };
    static unsigned char rgba[4 * EDGE * EDGE];
    for (uint32_t i = 0; i < EDGE * EDGE; i++)
        for (uint32_t c = 0; c < 4; c++) {
            double x = 6.2831853 * (i % EDGE + 3.0 * c) / EDGE, y = 6.2831853 * (i / (double)EDGE) / EDGE;
            rgba[4 * i + c] =
                (unsigned char)(150.0 + 90.0 * sin(x * (1 + seed % 3) + c) * cos(y * (1 + c % 2)));
        }
    return fixture_add_texture(f, EDGE, EDGE, rgba);
}

/* A tilted quad in front of a sphere, lit by punctual lights and a constant environment: one sample per
 * pixel, so that edges agree. */
static void place(fixture *f, scene_material material)
{
    f->desc.width = f->desc.height = SIZE;
    f->desc.samples = 1;
    uint32_t number = fixture_add_material(f, material);
    scene_node *quad = fixture_place(f, fixture_add_quad(f, number), -0.4f, 0.0f, 0.5f, 0.8f);
    gl_fixture_turn(quad, 0.0f, 0.38268343f, 0.0f, 0.92387953f);
    fixture_place(f, fixture_add_sphere(f, 32, number), 0.35f, 0.0f, -0.5f, 0.7f);
    scene_light light = {.name = "", .type = SCENE_LIGHT_POINT, .color = {1, 0.9f, 0.7f}, .intensity = 20.0f};
    fixture_add_light(f, light, 2.0f, 1.5f, 3.0f);
    fixture_add_light(f, light, -3.0f, 0.0f, -3.0f);
}

/* Share of the pixels in which a channel differs by more than 0.4 % of at least 1: half floats keep 2^-11
 * of a highlight. */
static double share_of_different(const film *a, const film *b)
{
    size_t different = 0, shown = 0;
    for (size_t i = 0; i < (size_t)a->width * a->height; i++) {
        const float *p = a->layers[0].pixels + 4 * i, *q = b->layers[0].pixels + 4 * i;
        bool differs = false;
        for (int c = 0; c < 4; c++)
            differs |= !(fabsf(p[c] - q[c]) <= 0.004f * fmaxf(1.0f, p[c]));
        shown += p[3] > 0.0f || q[3] > 0.0f;
        different += differs;
    }
    assert_true(shown > 100);
    return (double)different / (double)shown;
}

/* The images of both renderers agree, except for a share of the pixels, at edges. Contexts are tested one
 * after the other, because compiling programs takes most of the time. */
static void assert_near(fixture *f, double share, const char *what)
{
    static int turn;
    gl_context *context = &contexts.items[turn++ % contexts.count];
    film reference = fixture_render(f);
    film image = gl_fixture_render(f, context);
    double different = share_of_different(&reference, &image);
    if (different > share)
        fail_msg("%s%s: %g of the pixels differ by more than 0.4 %%", what, context->is_es ? ", ES" : "",
                 different);
    film_destroy(&image);
    film_destroy(&reference);
}

static void assert_same(fixture *f, const char *what)
{
    assert_near(f, 0.01, what);
}

static scene_material base(void)
{
    scene_material m = scene_material_default();
    set3(m.base_color, 0.9f, 0.5f, 0.25f);
    m.metallic = 0.3f;
    m.perceptual_roughness = 0.45f;
    return m;
}

static void check(scene_material material, const char *what)
{
    fixture f = fixture_create();
    place(&f, material);
    assert_same(&f, what);
    fixture_destroy(&f);
}

/* ---- factors ---- */

static void every_extension_matches_the_preview(void **state)
{
    (void)state;
    scene_material m = base();
    m.extensions = SCENE_SPECULAR | SCENE_IOR | SCENE_EMISSIVE_STRENGTH;
    m.ior = 1.8f;
    m.specular = 0.7f;
    set3(m.specular_color, 1.0f, 0.6f, 0.3f);
    set3(m.emissive, 0.02f, 0.05f, 0.1f);
    m.emissive_strength = 3.0f;
    check(m, "specular, ior, emissive strength");
    m = base();
    m.extensions = SCENE_UNLIT;
    check(m, "unlit");
    m = base();
    m.metallic = 0.0f;
    m.extensions = SCENE_DIFFUSE_ROUGHNESS | SCENE_DIFFUSE_TRANSMISSION;
    m.diffuse_roughness = 0.8f;
    m.diffuse_transmission = 0.4f;
    check(m, "rough diffuse reflection and transmission");
}

static void energy_conservation_matches_the_preview(void **state)
{
    (void)state;
    fixture f = fixture_create();
    scene_material m = base();
    m.extensions = SCENE_CLEARCOAT | SCENE_SHEEN | SCENE_IRIDESCENCE | SCENE_ANISOTROPY;
    m.clearcoat = 0.7f;
    set3(m.sheen_color, 0.4f, 0.1f, 0.8f);
    m.sheen_roughness = 0.5f;
    m.iridescence = 0.5f;
    m.anisotropy = 0.6f;
    place(&f, m);
    f.desc.energy = FACET_ENERGY_CONSERVING;
    assert_same(&f, "all layers, conserving");
    fixture_destroy(&f);
}

/* ---- textures ---- */

static void set_texture(scene_material *m, scene_texture_slot slot, uint32_t texture)
{
    m->textures[slot].texture = texture;
}

/* Every slot, each with its own image, in materials where it matters. Transmission has its own test. */
static void every_texture_slot_matches_the_preview(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        scene_texture_slot first, last;
    } groups[] = {
        {"core, specular", SCENE_BASE_COLOR_TEXTURE, SCENE_SPECULAR_COLOR_TEXTURE},
        {"clearcoat, sheen", SCENE_CLEARCOAT_TEXTURE, SCENE_SHEEN_ROUGHNESS_TEXTURE},
        {"iridescence, anisotropy, diffuse transmission", SCENE_IRIDESCENCE_TEXTURE,
         SCENE_DIFFUSE_TRANSMISSION_COLOR_TEXTURE},
        {"specular-glossiness", SCENE_SPECULAR_GLOSSINESS_TEXTURE, SCENE_SPECULAR_GLOSSINESS_TEXTURE},
        {"diffuse roughness", SCENE_DIFFUSE_ROUGHNESS_TEXTURE, SCENE_DIFFUSE_ROUGHNESS_TEXTURE}};
    for (size_t g = 0; g < sizeof groups / sizeof *groups; g++) {
        fixture f = fixture_create();
        scene_material m = base();
        set3(m.emissive, 0.5f, 0.4f, 0.3f);
        m.clearcoat = 0.8f;
        m.clearcoat_roughness = 0.5f;
        set3(m.sheen_color, 0.6f, 0.5f, 0.8f);
        m.sheen_roughness = 0.7f;
        m.iridescence = 0.9f;
        m.anisotropy = 0.8f;
        m.anisotropy_rotation = 0.6f;
        m.diffuse_transmission = 0.6f;
        m.glossiness = 0.7f;
        m.diffuse_roughness = 1.0f;
        for (int slot = (int)groups[g].first; slot <= (int)groups[g].last; slot++) {
            m.extensions |= material_textures[slot].extension;
            set_texture(&m, (scene_texture_slot)slot, add_waves(&f, (uint32_t)slot));
        }
        place(&f, m);
        assert_same(&f, groups[g].name);
        fixture_destroy(&f);
    }
}

/* Transforms, a second set, wrap modes, filters. */
static void texture_coordinates_match_the_preview(void **state)
{
    (void)state;
    for (int variant = 0; variant < 6; variant++) {
        fixture f = fixture_create();
        scene_material m = base();
        uint32_t texture = add_waves(&f, 1);
        scene_texture_ref *ref = &m.textures[SCENE_BASE_COLOR_TEXTURE];
        scene_texture *t = &f.scene->textures[texture];
        ref->texture = texture;
        if (variant < 4) {
            ref->offset[0] = 0.3f;
            ref->rotation_rad = 0.7f;
            ref->scale[0] = 2.5f;
            ref->scale[1] = 1.5f;
            scene_texture_ref_update(ref);
        }
        t->wrap_u = variant == 1 ? SCENE_WRAP_CLAMP : SCENE_WRAP_REPEAT;
        t->wrap_v = variant == 2 ? SCENE_WRAP_MIRROR : SCENE_WRAP_REPEAT;
        t->mip_filter = variant == 3 ? SCENE_MIP_NEAREST : variant == 4 ? SCENE_MIP_NONE : SCENE_MIP_LINEAR;
        ref->texcoord = variant == 5; /* a missing set: everything is read at (0, 0) */
        place(&f, m);
        char what[32];
        snprintf(what, sizeof what, "coordinates, variant %d", variant);
        assert_same(&f, what);
        fixture_destroy(&f);
    }
}

/* Normals and stretched highlights turn with their textures, each on its own. */
static void transformed_vectors_match_the_preview(void **state)
{
    (void)state;
    static const struct {
        scene_texture_slot slot, beside; /* beside: a second texture, untransformed */
        uint32_t extension;
    } cases[] = {{SCENE_NORMAL_TEXTURE, SCENE_NORMAL_TEXTURE, 0},
                 {SCENE_CLEARCOAT_NORMAL_TEXTURE, SCENE_CLEARCOAT_NORMAL_TEXTURE, SCENE_CLEARCOAT},
                 {SCENE_CLEARCOAT_NORMAL_TEXTURE, SCENE_NORMAL_TEXTURE, SCENE_CLEARCOAT},
                 {SCENE_ANISOTROPY_TEXTURE, SCENE_ANISOTROPY_TEXTURE, SCENE_ANISOTROPY}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        fixture f = fixture_create();
        scene_material m = base();
        m.extensions = cases[i].extension;
        m.clearcoat = m.anisotropy = 0.8f;
        m.clearcoat_roughness = 0.3f;
        uint32_t texture = add_waves(&f, 1);
        set_texture(&m, cases[i].beside, texture);
        scene_texture_ref *ref = &m.textures[cases[i].slot];
        set_texture(&m, cases[i].slot, texture);
        ref->rotation_rad = 1.9f;
        ref->scale[0] = -0.8f;
        scene_texture_ref_update(ref);
        place(&f, m);
        char what[32];
        snprintf(what, sizeof what, "turned vectors, case %d", (int)i);
        assert_same(&f, what);
        fixture_destroy(&f);
    }
}

/* Texels that one image holds for two slots are sampled once, unless the coordinates differ. */
static void shared_texels_are_sampled_once(void **state)
{
    (void)state;
    for (int is_turned = 0; is_turned < 2; is_turned++) {
        fixture f = fixture_create();
        scene_material m = base();
        m.extensions = SCENE_SPECULAR;
        uint32_t texture = add_waves(&f, 2);
        for (int i = 0; i < GL_SLOT_PAIR_COUNT; i++) {
            if (material_textures[gl_slot_pairs[i].second].extension & ~m.extensions)
                continue;
            set_texture(&m, gl_slot_pairs[i].first, texture);
            set_texture(&m, gl_slot_pairs[i].second, texture);
            scene_texture_ref *ref = &m.textures[gl_slot_pairs[i].second];
            ref->offset[0] = is_turned ? 0.25f : 0.0f;
            scene_texture_ref_update(ref);
        }
        place(&f, m);
        assert_same(&f, is_turned ? "pairs at other places" : "pairs");
        fixture_destroy(&f);
    }
}

/* ---- units ---- */

static void units_are_assigned_to_sampled_slots(void **state)
{
    (void)state;
    int8_t units[SCENE_TEXTURE_SLOT_COUNT];
    assert_int_equal(gl_material_slot_units(0, units), 0);
    uint64_t slots = 1ull << SCENE_BASE_COLOR_TEXTURE | 1ull << SCENE_METALLIC_ROUGHNESS_TEXTURE |
                     1ull << SCENE_OCCLUSION_TEXTURE;
    assert_int_equal(gl_material_slot_units(slots << GL_SURFACE_TEXTURES, units), 3);
    assert_int_equal(units[SCENE_OCCLUSION_TEXTURE], 2);
    uint64_t paired = slots << GL_SURFACE_TEXTURES | 1ull << GL_SURFACE_PAIRS;
    assert_int_equal(gl_material_slot_units(paired, units), 2);
    assert_int_equal(units[SCENE_OCCLUSION_TEXTURE], -1);
    assert_int_equal(units[SCENE_METALLIC_ROUGHNESS_TEXTURE], 1);
    uint32_t seen = 0;
    for (int i = 0; i < SCENE_TEXTURE_SLOT_COUNT; i++)
        seen |= 1u << gl_slots_by_loss[i];
    assert_int_equal(seen, (1u << SCENE_TEXTURE_SLOT_COUNT) - 1);
    assert_string_equal(gl_program_feature_name(GL_MAIN_SURFACE, GL_SURFACE_TEXTURES),
                        "HAS_BASE_COLOR_TEXTURE");
    assert_string_equal(gl_program_feature_name(GL_MAIN_SURFACE, GL_SURFACE_PAIRS), "IS_OCCLUSION_PAIRED");
    assert_string_equal(gl_program_feature_name(GL_MAIN_SURFACE, GL_SURFACE_LAYERS), "HAS_CLEARCOAT");
    assert_string_equal(gl_program_feature_name(GL_MAIN_SURFACE, GL_SURFACE_IS_VOLUME), "IS_VOLUME");
}

static int warning_count;

static void note_warning(void *user, facet_log_level level, const char *message)
{
    (void)user;
    if (level != FACET_LOG_LEVEL_WARNING)
        return;
    assert_non_null(strstr(message, "more textures than OpenGL's 9 units"));
    warning_count++;
}

/* Ten textures: the least important one is dropped, with one warning. */
static void the_least_important_texture_is_dropped(void **state)
{
    (void)state;
    fixture f = fixture_create();
    scene_material m = base();
    m.name = "many";
    m.extensions = SCENE_CLEARCOAT | SCENE_SPECULAR;
    m.clearcoat = 0.8f;
    for (int slot = 0; slot <= SCENE_CLEARCOAT_NORMAL_TEXTURE; slot++)
        set_texture(&m, (scene_texture_slot)slot, add_waves(&f, (uint32_t)slot));
    place(&f, m);
    f.desc.log.message = note_warning;
    warning_count = 0;
    gl_renderer *renderer = gl_fixture_renderer(&f, &contexts.items[0]);
    for (int i = 0; i < 2; i++) {
        film image = gl_fixture_draw(&f, renderer);
        film_destroy(&image);
    }
    gl_renderer_destroy(renderer);
    assert_int_equal(warning_count, 1);
    fixture_destroy(&f);
}

/* ---- alpha ---- */

static void alpha_modes_match_the_preview(void **state)
{
    (void)state;
    static const scene_alpha_mode modes[] = {SCENE_ALPHA_OPAQUE, SCENE_ALPHA_MASK, SCENE_ALPHA_BLEND};
    for (int i = 0; i < 3; i++) {
        fixture f = fixture_create();
        scene_material m = base();
        m.alpha_mode = modes[i];
        m.alpha_cutoff = 0.45f;
        m.base_color[3] = 0.8f;
        m.is_double_sided = true;
        set_texture(&m, SCENE_BASE_COLOR_TEXTURE, add_waves(&f, 0));
        f.scene->textures[0].mag_filter = SCENE_FILTER_NEAREST; /* no interpolation of alpha */
        fixture_place(&f, fixture_add_quad(&f, fixture_add_material(&f, m)), 0, 0, 0, 0.9f);
        f.desc.width = f.desc.height = SIZE;
        f.desc.samples = 1;
        assert_near(&f, 0.05, modes[i] == SCENE_ALPHA_MASK ? "mask" : "alpha"); /* texels have edges */
        fixture_destroy(&f);
    }
}

/* Alpha-to-coverage: at an edge through the center of pixels, as many samples as the driver takes for 0.5,
 * with alpha 1. */
static void alpha_to_coverage_follows_the_mask(void **state)
{
    (void)state;
    static const unsigned char rgba[8] = {255, 255, 255, 255, 255, 255, 255, 0};
    fixture f = fixture_create();
    scene_material m = gl_fixture_unlit(1.0f, 0.5f, 0.25f, 1.0f);
    m.alpha_mode = SCENE_ALPHA_MASK;
    m.alpha_cutoff = 0.5f;
    set_texture(&m, SCENE_BASE_COLOR_TEXTURE, fixture_add_texture(&f, 2, 1, rgba));
    f.scene->textures[0].wrap_u = SCENE_WRAP_CLAMP;
    fixture_place(&f, fixture_add_quad(&f, fixture_add_material(&f, m)), 0, 0, 0, 1);
    f.desc.width = f.desc.height = 33; /* the edge is in the middle of column 16 */
    for (int k = 0; k < contexts.count; k++) {
        if (contexts.items[k].is_es)
            continue;
        film image = gl_fixture_render(&f, &contexts.items[k]);
        gl_fixture_assert_pixel(&image, 15, 16, (float[4]){1.0f, 0.5f, 0.25f, 1.0f}, 1e-3f);
        gl_fixture_assert_pixel(&image, 17, 16, (float[4]){0.0f}, 0.0f);
        float share = fixture_pixel(&image, "", 16, 16)[3];
        assert_true(share >= 0.25f && share <= 0.75f);
        gl_fixture_assert_pixel(&image, 16, 16, (float[4]){share, 0.5f * share, 0.25f * share, share}, 1e-3f);
        film_destroy(&image);
    }
    fixture_destroy(&f);
}

/* ---- channels ---- */

/* Lobes and emission add up to the whole image. */
static void lobes_and_emission_sum_to_the_image(void **state)
{
    (void)state;
    static const facet_channel parts[] = {FACET_CHANNEL_DIFFUSE,      FACET_CHANNEL_SPECULAR,
                                          FACET_CHANNEL_CLEARCOAT,    FACET_CHANNEL_SHEEN,
                                          FACET_CHANNEL_TRANSMISSION, FACET_CHANNEL_EMISSION};
    for (int energy = 0; energy < 2; energy++) {
        fixture f = fixture_create();
        scene_material m = base();
        m.extensions = SCENE_CLEARCOAT | SCENE_SHEEN | SCENE_DIFFUSE_TRANSMISSION | SCENE_IRIDESCENCE;
        m.clearcoat = 0.7f;
        set3(m.sheen_color, 0.4f, 0.1f, 0.8f);
        m.sheen_roughness = 0.5f;
        m.iridescence = 0.5f;
        m.diffuse_transmission = 0.4f;
        set3(m.emissive, 0.1f, 0.2f, 0.3f);
        place(&f, m);
        f.desc.energy = energy ? FACET_ENERGY_CONSERVING : FACET_ENERGY_GLTF;
        gl_renderer *renderer = gl_fixture_renderer(&f, &contexts.items[0]);
        film whole = gl_fixture_draw(&f, renderer);
        film sum = gl_fixture_draw(&f, renderer);
        size_t count = 4 * (size_t)sum.width * sum.height;
        memset(sum.layers[0].pixels, 0, count * sizeof(float));
        for (size_t p = 0; p < sizeof parts / sizeof *parts; p++) {
            f.desc.gl.channel = parts[p];
            film part = gl_fixture_draw(&f, renderer);
            double light = 0.0;
            for (size_t i = 0; i < count; i++) {
                if (i % 4 < 3)
                    light += (double)part.layers[0].pixels[i];
                sum.layers[0].pixels[i] += part.layers[0].pixels[i] / (i % 4 == 3 ? 6.0f : 1.0f);
            }
            assert_true(light > 0.1); /* each lobe contributes */
            film_destroy(&part);
        }
        for (size_t i = 0; i < count; i++)
            if (fabsf(sum.layers[0].pixels[i] - whole.layers[0].pixels[i]) >
                0.003f * fmaxf(whole.layers[0].pixels[i], 0.1f)) /* half floats, six of them */
                fail_msg("energy %d, pixel %zu: %g in place of %g", energy, i / 4,
                         (double)sum.layers[0].pixels[i], (double)whole.layers[0].pixels[i]);
        film_destroy(&whole);
        film_destroy(&sum);
        gl_renderer_destroy(renderer);
        fixture_destroy(&f);
    }
}

/* White furnace: a white energy-conserving surface returns radiance 1 as 1 at any roughness. */
static void white_surfaces_pass_the_furnace_test(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        fixture f = fixture_create();
        scene_material m = scene_material_default();
        m.metallic = i < 2 ? 0.0f : 1.0f;
        m.perceptual_roughness = i % 2 ? 1.0f : 0.2f;
        fixture_place(&f, fixture_add_sphere(&f, 32, fixture_add_material(&f, m)), 0, 0, 0, 0.9f);
        f.desc.energy = FACET_ENERGY_CONSERVING;
        f.desc.gl.channel = FACET_CHANNEL_FURNACE;
        f.desc.width = f.desc.height = SIZE;
        f.desc.samples = 1;
        film image = gl_fixture_render(&f, &contexts.items[0]);
        for (uint32_t k = 0; k < SIZE * SIZE; k++) {
            const float *p = image.layers[0].pixels + 4 * (size_t)k;
            for (int c = 0; c < 3 && p[3] > 0.0f; c++)
                if (fabsf(p[c] - 1.0f) > 0.004f)
                    fail_msg("metallic %g, roughness %g: %g", (double)m.metallic,
                             (double)m.perceptual_roughness, (double)p[c]);
        }
        film_destroy(&image);
        fixture_destroy(&f);
    }
}

/* Parameters are shown unchanged. */
static void channels_show_parameters_unchanged(void **state)
{
    (void)state;
    static const struct {
        facet_channel channel;
        float value[3];
    } cases[] = {
        {FACET_CHANNEL_NORMAL, {0.5f, 0.5f, 1.0f}},       {FACET_CHANNEL_BASE_COLOR, {0.9f, 0.5f, 0.25f}},
        {FACET_CHANNEL_ROUGHNESS, {0.45f, 0.45f, 0.45f}}, {FACET_CHANNEL_METALLIC, {0.3f, 0.3f, 0.3f}},
        {FACET_CHANNEL_OCCLUSION, {1.0f, 1.0f, 1.0f}},    {FACET_CHANNEL_OPACITY, {0.6f, 0.6f, 0.6f}},
        {FACET_CHANNEL_NDOTV, {1.0f, 1.0f, 1.0f}},        {FACET_CHANNEL_CLEARCOAT, {0.0f, 0.0f, 0.0f}}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        fixture f = fixture_create();
        scene_material m = base();
        if (cases[i].channel == FACET_CHANNEL_OPACITY) {
            m.alpha_mode = SCENE_ALPHA_BLEND;
            m.base_color[3] = 0.6f;
        }
        fixture_place(&f, fixture_add_quad(&f, fixture_add_material(&f, m)), 0, 0, 0, 1);
        f.desc.gl.channel = cases[i].channel;
        film image = gl_fixture_render(&f, &contexts.items[contexts.count - 1]);
        const float *v = cases[i].value;
        gl_fixture_assert_pixel(&image, 30, 30, (float[4]){v[0], v[1], v[2], 1.0f}, 1e-3f);
        film_destroy(&image);
        fixture_destroy(&f);
    }
}

/* Schlick-GGX masks more than Smith's function; multiscatter conserves energy. */
static void specular_variants_differ_as_expected(void **state)
{
    (void)state;
    fixture f = fixture_create();
    scene_material m = base();
    m.metallic = 1.0f;
    m.perceptual_roughness = 0.8f;
    place(&f, m);
    facet_environment_destroy(f.environment); /* multiple scattering is on in both energy modes */
    f.environment = NULL;
    f.desc.energy = FACET_ENERGY_GLTF;
    gl_renderer *renderer = gl_fixture_renderer(&f, &contexts.items[0]);
    film plain = gl_fixture_draw(&f, renderer);
    f.desc.gl.brdf = FACET_BRDF_SCHLICK_GGX;
    film schlick = gl_fixture_draw(&f, renderer);
    f.desc.gl.brdf = FACET_BRDF_MULTISCATTER;
    film multiple = gl_fixture_draw(&f, renderer);
    f.desc.gl.brdf = FACET_BRDF_ENERGY;
    f.desc.energy = FACET_ENERGY_CONSERVING;
    film conserving = gl_fixture_draw(&f, renderer);
    double sums[3] = {0};
    for (size_t i = 0; i < 4 * SIZE * SIZE; i++) {
        sums[0] += (double)plain.layers[0].pixels[i];
        sums[1] += (double)schlick.layers[0].pixels[i];
        sums[2] += (double)multiple.layers[0].pixels[i];
    }
    assert_true(fabs(sums[1] / sums[0] - 1.0) > 0.01);
    assert_true(sums[2] > sums[0] * 1.01);
    assert_memory_equal(multiple.layers[0].pixels, conserving.layers[0].pixels, 16 * SIZE * SIZE);
    film_destroy(&plain);
    film_destroy(&schlick);
    film_destroy(&multiple);
    film_destroy(&conserving);
    gl_renderer_destroy(renderer);
    fixture_destroy(&f);
}

/* A scene of metals only needs irradiance for multiple scattering alone: white metal in a white room is
 * white. */
static void multiple_scattering_preserves_energy_of_metals(void **state)
{
    (void)state;
    for (int i = 1; i < 5; i++) {
        fixture f = fixture_create();
        scene_material m = scene_material_default();
        m.metallic = 1.0f;
        m.perceptual_roughness = 0.25f * (float)i;
        fixture_place(&f, fixture_add_sphere(&f, 64, fixture_add_material(&f, m)), 0, 0, 0, 0.9f);
        f.desc.gl.brdf = FACET_BRDF_MULTISCATTER;
        film image = gl_fixture_render(&f, &contexts.items[0]);
        gl_fixture_assert_pixel(&image, 32, 32, (float[4]){1.0f, 1.0f, 1.0f, 1.0f}, 4e-3f);
        film_destroy(&image);
        fixture_destroy(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_extension_matches_the_preview),
                                       cmocka_unit_test(energy_conservation_matches_the_preview),
                                       cmocka_unit_test(every_texture_slot_matches_the_preview),
                                       cmocka_unit_test(texture_coordinates_match_the_preview),
                                       cmocka_unit_test(transformed_vectors_match_the_preview),
                                       cmocka_unit_test(shared_texels_are_sampled_once),
                                       cmocka_unit_test(units_are_assigned_to_sampled_slots),
                                       cmocka_unit_test(the_least_important_texture_is_dropped),
                                       cmocka_unit_test(alpha_modes_match_the_preview),
                                       cmocka_unit_test(alpha_to_coverage_follows_the_mask),
                                       cmocka_unit_test(lobes_and_emission_sum_to_the_image),
                                       cmocka_unit_test(white_surfaces_pass_the_furnace_test),
                                       cmocka_unit_test(multiple_scattering_preserves_energy_of_metals),
                                       cmocka_unit_test(channels_show_parameters_unchanged),
                                       cmocka_unit_test(specular_variants_differ_as_expected)};
    /* Mesa's llvmpipe filters 8-bit data with 8-bit weights by default, which shows in sharp reflections. */
    setenv("GALLIVM_PERF", "no_aos_sampling", 1);
    if (!gl_fixture_open(&contexts))
        return 77;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    gl_fixture_close(&contexts);
    return failed;
}
