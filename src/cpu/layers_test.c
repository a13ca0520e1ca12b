/* Tests of materials with extensions: texture channels, factors of 0, frames, limits. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "cpu/preview_fixture.h"

enum { SIZE = 32, FLOATS = SIZE * SIZE * 4 };

static scene_material base(void)
{
    scene_material m = scene_material_default();
    m.base_color[1] = 0.5f;
    m.base_color[2] = 0.25f;
    m.metallic = 0.3f;
    m.perceptual_roughness = 0.45f;
    return m;
}

/* A ball and a wall behind it, two lights, a constant environment; u1 is the ball's second set of
 * coordinates. */
static film render_ball(scene_material material, fixture *f, bool is_antialiased)
{
    f->desc.width = f->desc.height = SIZE;
    f->desc.has_specular_antialiasing = is_antialiased;
    scene_material wall = scene_material_default();
    wall.extensions = SCENE_UNLIT;
    wall.base_color[0] = 0.2f;
    fixture_place(f, fixture_add_quad(f, fixture_add_material(f, wall)), 0, 0, -2.0f, 3.0f);
    fixture_place(f, fixture_add_sphere(f, 48, fixture_add_material(f, material)), 0, 0, 0, 0.9f);
    scene_light light = {.name = "", .type = SCENE_LIGHT_POINT, .color = {1, 1, 1}, .intensity = 20.0f};
    fixture_add_light(f, light, 2.0f, 1.5f, 3.0f);
    fixture_add_light(f, light, -3.0f, 0.0f, -3.0f);
    return fixture_render(f);
}

static film film_of(scene_material material)
{
    fixture f = fixture_create();
    film rendered = render_ball(material, &f, false);
    fixture_destroy(&f);
    return rendered;
}

static double greatest_difference(const film *a, const film *b)
{
    double most = 0.0;
    for (uint32_t i = 0; i < FLOATS; i++)
        most = fmax(most, fabs((double)a->layers[0].pixels[i] - (double)b->layers[0].pixels[i]));
    return most;
}

/* ---- factors ---- */

static const uint32_t EXTENSIONS =
    SCENE_CLEARCOAT | SCENE_SHEEN | SCENE_TRANSMISSION | SCENE_VOLUME | SCENE_IRIDESCENCE | SCENE_ANISOTROPY |
    SCENE_DISPERSION | SCENE_DIFFUSE_TRANSMISSION | SCENE_VOLUME_SCATTER | SCENE_DIFFUSE_ROUGHNESS;

/* Every layer, with visible values. */
static scene_material with_all(float factor)
{
    scene_material m = base();
    m.extensions = EXTENSIONS;
    m.clearcoat = 0.7f * factor;
    m.clearcoat_roughness = 0.3f;
    m.sheen_color[0] = 0.4f * factor;
    m.sheen_color[2] = 0.8f * factor;
    m.sheen_roughness = 0.5f;
    m.transmission = 0.5f * factor;
    m.thickness = 0.2f;
    m.attenuation_distance = 0.5f;
    m.attenuation_color[1] = 0.5f;
    m.iridescence = 0.6f * factor;
    m.anisotropy = 0.6f * factor;
    m.dispersion = 2.0f;
    m.diffuse_transmission = 0.4f * factor;
    m.diffuse_transmission_color[0] = 0.3f;
    m.multiscatter_color[1] = 0.5f;
    m.diffuse_roughness = 0.8f * factor;
    return m;
}

static void a_factor_of_0_is_the_base(void **state)
{
    (void)state;
    film plain = film_of(base());
    film none = film_of(with_all(0.0f));
    film all = film_of(with_all(1.0f));
    assert_memory_equal(plain.layers[0].pixels, none.layers[0].pixels, FLOATS * sizeof(float));
    assert_true(greatest_difference(&plain, &all) > 0.05);
    film_destroy(&plain);
    film_destroy(&none);
    film_destroy(&all);
}

/* Also a factor that a texel makes 0; with one sample, because transmissive materials are shaded for each. */
static void a_texel_of_0_is_the_base(void **state)
{
    (void)state;
    static const unsigned char black[4] = {0, 0, 0, 0};
    static const scene_texture_slot slots[] = {
        SCENE_CLEARCOAT_TEXTURE,        SCENE_SHEEN_COLOR_TEXTURE, SCENE_TRANSMISSION_TEXTURE,
        SCENE_IRIDESCENCE_TEXTURE,      SCENE_ANISOTROPY_TEXTURE,  SCENE_DIFFUSE_TRANSMISSION_TEXTURE,
        SCENE_DIFFUSE_ROUGHNESS_TEXTURE};
    fixture g = fixture_create();
    g.desc.samples = 1;
    film plain = render_ball(base(), &g, false);
    fixture_destroy(&g);
    fixture f = fixture_create();
    f.desc.samples = 1;
    scene_material m = with_all(1.0f);
    uint32_t texture = fixture_add_texture(&f, 1, 1, black);
    for (size_t i = 0; i < sizeof slots / sizeof *slots; i++)
        m.textures[slots[i]].texture = texture;
    film none = render_ball(m, &f, false);
    assert_memory_equal(plain.layers[0].pixels, none.layers[0].pixels, FLOATS * sizeof(float));
    film_destroy(&none);
    film_destroy(&plain);
    fixture_destroy(&f);
}

/* ---- channels ---- */

/* IEC 61966-2-1. */
static float decoded(unsigned char code)
{
    double encoded = code / 255.0;
    return (float)srgb_decode(encoded);
}

enum { R = 51, G = 102, B = 153, A = 204 };
static const unsigned char TEXEL[4] = {R, G, B, A};

static void multiply_color(float color[3])
{
    color[0] *= decoded(R);
    color[1] *= decoded(G);
    color[2] *= decoded(B);
}

/* The effect of a texture of that texel on the parameters of a material. */
static void apply_texel(scene_material *m, scene_texture_slot slot)
{
    const float r = R / 255.0f;
    const float g = G / 255.0f;
    const float b = B / 255.0f;
    const float a = A / 255.0f;
    switch (slot) {
    case SCENE_SPECULAR_TEXTURE:
        m->specular *= a;
        break;
    case SCENE_SPECULAR_COLOR_TEXTURE:
        multiply_color(m->specular_color);
        break;
    case SCENE_CLEARCOAT_TEXTURE:
        m->clearcoat *= r;
        break;
    case SCENE_CLEARCOAT_ROUGHNESS_TEXTURE:
        m->clearcoat_roughness *= g;
        break;
    case SCENE_SHEEN_COLOR_TEXTURE:
        multiply_color(m->sheen_color);
        break;
    case SCENE_SHEEN_ROUGHNESS_TEXTURE:
        m->sheen_roughness *= a;
        break;
    case SCENE_TRANSMISSION_TEXTURE:
        m->transmission *= r;
        break;
    case SCENE_IRIDESCENCE_TEXTURE:
        m->iridescence *= r;
        break;
    case SCENE_IRIDESCENCE_THICKNESS_TEXTURE:
        m->iridescence_thickness_maximum =
            m->iridescence_thickness_minimum +
            (m->iridescence_thickness_maximum - m->iridescence_thickness_minimum) * g;
        break;
    case SCENE_ANISOTROPY_TEXTURE: /* strength B, direction (R, G) */
        m->anisotropy *= b;
        m->anisotropy_rotation += atan2f(2.0f * g - 1.0f, 2.0f * r - 1.0f);
        break;
    case SCENE_DIFFUSE_TRANSMISSION_TEXTURE:
        m->diffuse_transmission *= a;
        break;
    case SCENE_DIFFUSE_TRANSMISSION_COLOR_TEXTURE:
        multiply_color(m->diffuse_transmission_color);
        break;
    case SCENE_SPECULAR_GLOSSINESS_TEXTURE:
        multiply_color(m->specular_color);
        m->glossiness *= a;
        break;
    case SCENE_DIFFUSE_ROUGHNESS_TEXTURE:
        m->diffuse_roughness *= r;
        break;
    default:
        fail_msg("slot %d", (int)slot);
    }
}

static void textures_are_read_by_their_channels(void **state)
{
    (void)state;
    for (int slot = SCENE_SPECULAR_TEXTURE; slot < SCENE_TEXTURE_SLOT_COUNT; slot += IS_SLOW ? 3 : 1) {
        if (slot == SCENE_CLEARCOAT_NORMAL_TEXTURE || slot == SCENE_THICKNESS_TEXTURE)
            continue; /* the tests below */
        scene_material m = with_all(1.0f);
        m.extensions |= SCENE_SPECULAR;
        if (slot == SCENE_SPECULAR_GLOSSINESS_TEXTURE) {
            m = base();
            m.extensions = SCENE_SPECULAR_GLOSSINESS;
            m.glossiness = 0.8f;
        }
        film plain = film_of(m);
        scene_material applied = m;
        apply_texel(&applied, (scene_texture_slot)slot);
        film expected = film_of(applied);
        fixture f = fixture_create();
        m.textures[slot].texture = fixture_add_texture(&f, 1, 1, TEXEL);
        film textured = render_ball(m, &f, false);
        if (!(greatest_difference(&textured, &expected) < 2e-4))
            fail_msg("slot %d: %g", slot, greatest_difference(&textured, &expected));
        if (!(greatest_difference(&textured, &plain) > 1e-3))
            fail_msg("slot %d makes no difference", slot);
        film_destroy(&plain);
        film_destroy(&expected);
        film_destroy(&textured);
        fixture_destroy(&f);
    }
}

static void more_textures_than_a_group_holds(void **state)
{
    (void)state;
    scene_material m = with_all(1.0f);
    m.extensions |= SCENE_SPECULAR;
    scene_material applied = m;
    fixture f = fixture_create();
    uint32_t texture = fixture_add_texture(&f, 1, 1, TEXEL);
    for (int slot = SCENE_SPECULAR_TEXTURE; slot < SCENE_SPECULAR_GLOSSINESS_TEXTURE; slot++) {
        if (slot == SCENE_CLEARCOAT_NORMAL_TEXTURE || slot == SCENE_THICKNESS_TEXTURE)
            continue;
        m.textures[slot].texture = texture;
        apply_texel(&applied, (scene_texture_slot)slot);
    }
    film expected = film_of(applied);
    film textured = render_ball(m, &f, false);
    assert_true(greatest_difference(&textured, &expected) < 2e-4);
    film_destroy(&expected);
    film_destroy(&textured);
    fixture_destroy(&f);
}

/* Specular-glossiness is the metallic-roughness surface of infinite ior with that specular color. */
static void glossiness_is_lossless(void **state)
{
    (void)state;
    scene_material gloss = base();
    gloss.extensions = SCENE_SPECULAR_GLOSSINESS;
    gloss.glossiness = 0.625f;
    gloss.specular_color[0] = 0.5f;
    gloss.specular_color[1] = 0.25f;
    gloss.specular_color[2] = 0.125f;
    scene_material metal = gloss;
    metal.extensions = SCENE_IOR | SCENE_SPECULAR;
    metal.metallic = 0.0f;
    metal.perceptual_roughness = 0.375f;
    metal.ior = 0.0f;
    film a = film_of(gloss);
    film b = film_of(metal);
    assert_memory_equal(a.layers[0].pixels, b.layers[0].pixels, FLOATS * sizeof(float));
    film_destroy(&a);
    film_destroy(&b);
}

/* ---- frames ---- */

static const float TANGENTS[16] = {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1};

/* Brightness under light from tan(30 degrees) to the right (or above) on a quad with a tilted coat. */
static float coat_towards(bool from_above, uint32_t set, bool has_tangents)
{
    static const unsigned char right[4] = {192, 128, 238, 255}; /* tilted by 30 degrees towards +u */
    static const float turned[8] = {0, 1, 0, 0, 1, 1, 1, 0};    /* u up, v to the right */
    fixture f = fixture_create();
    fixture_remove_environment(&f);
    f.desc.width = f.desc.height = 9;
    scene_material m = scene_material_default();
    m.base_color[0] = 0.0f;
    m.metallic = 1.0f;
    m.extensions = SCENE_CLEARCOAT;
    m.clearcoat = 1.0f;
    m.clearcoat_roughness = 0.2f;
    m.textures[SCENE_CLEARCOAT_NORMAL_TEXTURE].texture = fixture_add_texture(&f, 1, 1, right);
    m.textures[SCENE_CLEARCOAT_NORMAL_TEXTURE].texcoord = set;
    uint32_t mesh = fixture_add_quad(&f, fixture_add_material(&f, m));
    scene_primitive *p = fixture_primitive(&f, mesh);
    const float *sets[2] = {p->texcoords[0], turned};
    p->texcoords = sets;
    p->texcoord_count = 2;
    p->tangents = has_tangents ? TANGENTS : NULL;
    fixture_place(&f, mesh, 0, 0, 0, 1.0f);
    scene_light sun = {.name = "", .type = SCENE_LIGHT_DIRECTIONAL, .color = {1, 1, 1}, .intensity = 1.0f};
    fixture_add_light(&f, sun, 0, 0, 0);
    float angle = 60.0f * 3.14159265f / 180.0f; /* mirrored at a normal that leans by 30 degrees */
    scene_node *node = &f.scene->nodes[f.scene->node_count - 1];
    node->rotation[from_above ? 0 : 1] = (from_above ? -1.0f : 1.0f) * sinf(0.5f * angle);
    node->rotation[3] = cosf(0.5f * angle);
    film rendered = fixture_render(&f);
    float brightness = fixture_pixel(&rendered, "", 4, 4)[0];
    film_destroy(&rendered);
    fixture_destroy(&f);
    return brightness;
}

static void coats_have_normals_of_their_own(void **state)
{
    (void)state;
    float most = coat_towards(false, 0, true);
    assert_true(most > 10.0f * coat_towards(true, 0, true));
    assert_true(fabsf(coat_towards(false, 0, false) - most) < 0.02f * most);
    /* The second set has u upwards. */
    assert_true(fabsf(coat_towards(true, 1, false) - most) < 0.02f * most);
    assert_true(most > 10.0f * coat_towards(false, 1, false));
}

static film anisotropic_quad(const float *tangents, float rotation)
{
    fixture f = fixture_create();
    fixture_remove_environment(&f);
    f.desc.width = f.desc.height = SIZE;
    scene_material m = scene_material_default();
    m.perceptual_roughness = 0.3f;
    m.extensions = SCENE_ANISOTROPY;
    m.anisotropy = 0.8f;
    m.anisotropy_rotation = rotation;
    uint32_t mesh = fixture_add_quad(&f, fixture_add_material(&f, m));
    fixture_primitive(&f, mesh)->tangents = tangents;
    fixture_place(&f, mesh, 0, 0, 0, 1.0f);
    scene_light light = {.name = "", .type = SCENE_LIGHT_POINT, .color = {1, 1, 1}, .intensity = 3.0f};
    fixture_add_light(&f, light, 0.3f, 0.1f, 1.0f);
    film rendered = fixture_render(&f);
    fixture_destroy(&f);
    return rendered;
}

static void highlights_are_stretched_along_the_tangent(void **state)
{
    (void)state;
    static const float upright[16] = {0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1};
    const float quarter = 1.57079633f;
    film along = anisotropic_quad(TANGENTS, 0.0f);
    film generated = anisotropic_quad(NULL, 0.0f); /* from the texture coordinates */
    film turned = anisotropic_quad(TANGENTS, quarter);
    film upward = anisotropic_quad(upright, 0.0f);
    assert_true(greatest_difference(&along, &generated) < 1e-4);
    assert_true(greatest_difference(&turned, &upward) < 1e-4);
    assert_true(greatest_difference(&along, &upward) > 0.1);
    /* At the same distance from the highlight it is brighter along the tangent. */
    assert_true(*fixture_pixel(&along, "", 20 + 8, 14) > 1.5f * *fixture_pixel(&along, "", 20, 14 + 8));
    film_destroy(&along);
    film_destroy(&generated);
    film_destroy(&turned);
    film_destroy(&upward);
}

/* ---- energy ---- */

static void layers_return_no_more_than_they_got(void **state)
{
    (void)state;
    for (int i = 0; i < 8; i++) {
        fixture f = fixture_create();
        f.desc.width = f.desc.height = SIZE;
        f.desc.energy = FACET_ENERGY_CONSERVING;
        scene_material m = with_all(1.0f);
        for (int c = 0; c < 3; c++)
            m.base_color[c] = m.diffuse_transmission_color[c] = m.sheen_color[c] = 1.0f;
        m.metallic = i & 1 ? 1.0f : 0.0f;
        m.perceptual_roughness = i & 2 ? 0.8f : 0.1f;
        m.sheen_roughness = i & 4 ? 0.9f : 0.2f;
        fixture_place(&f, fixture_add_sphere(&f, 48, fixture_add_material(&f, m)), 0, 0, 0, 0.9f);
        film rendered = fixture_render(&f);
        for (uint32_t p = 0; p < FLOATS; p++)
            assert_true(rendered.layers[0].pixels[p] < 1.01f);
        film_destroy(&rendered);
        fixture_destroy(&f);
    }
}

/* ---- limits ---- */

/* Twelve balls within one another, in one tile. */
static fixture slow_tile(void)
{
    fixture f = fixture_create();
    f.desc.width = f.desc.height = SIZE;
    f.desc.quality = FACET_QUALITY_FINAL;
    f.desc.thread_count = 1;
    scene_material m = with_all(1.0f);
    m.metallic = 0.0f;
    m.transmission = 1.0f;
    for (int i = 0; i < 12; i++)
        fixture_place(&f, fixture_add_sphere(&f, 64, fixture_add_material(&f, m)), 0, 0, 0,
                      0.95f - 0.07f * (float)i);
    return f;
}

/* The deadline is checked within a tile: this image is one, and takes much longer. */
static void the_time_limit_holds_within_a_tile(void **state)
{
    (void)state;
    fixture f = slow_tile();
    f.desc.samples = 16;
    f.desc.time_limit_s = 0.03;
    film rendered;
    facet_render_stats stats;
    facet_error error;
    assert_int_equal(fixture_try_render(&f, &rendered, &stats, &error), FACET_ERROR_LIMIT);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

/* Cancels at the second call of the progress callback. */
static bool stop_soon(void *user, const char *stage, double fraction)
{
    double *last = user;
    if (strcmp(stage, "shade") == 0)
        *last = fraction;
    return strcmp(stage, "shade") != 0 || ++last[1] < 2.0;
}

static void a_tile_can_be_cancelled(void **state)
{
    (void)state;
    fixture f = slow_tile();
    double reported[2] = {-1.0, 0.0}; /* fraction, times */
    f.desc.samples = 64;
    f.desc.progress = (facet_progress){.report = stop_soon, .user = reported};
    film rendered;
    facet_render_stats stats;
    facet_error error;
    assert_int_equal(fixture_try_render(&f, &rendered, &stats, &error), FACET_ERROR_CANCELLED);
    assert_true(reported[0] < 1.0); /* the only tile was not done */
    film_destroy(&rendered);
    fixture_destroy(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_factor_of_0_is_the_base),
        cmocka_unit_test(a_texel_of_0_is_the_base),
        cmocka_unit_test(textures_are_read_by_their_channels),
        cmocka_unit_test(more_textures_than_a_group_holds),
        cmocka_unit_test(glossiness_is_lossless),
        cmocka_unit_test(coats_have_normals_of_their_own),
        cmocka_unit_test(highlights_are_stretched_along_the_tangent),
        cmocka_unit_test(layers_return_no_more_than_they_got),
        cmocka_unit_test(the_time_limit_holds_within_a_tile),
        cmocka_unit_test(a_tile_can_be_cancelled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
