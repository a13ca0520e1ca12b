/* Tests of FACET_SHADING_OGL1: surfaces. Textures and maps, opacity and blending, sides, AOVs. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "cpu/ogl1_fixture.h"
#include "film/film_image.h"

static void assert_pixel(const film *rendered, uint32_t x, uint32_t y, const double rgb[3], double opacity)
{
    const float *pixel = fixture_pixel(rendered, "", x, y);
    if (!(fabs((double)pixel[3] - opacity) <= 1e-6))
        fail_msg("opacity %g instead of %g", (double)pixel[3], opacity);
    for (int c = 0; c < 3; c++) {
        double number = opacity > 0.0 ? ogl1_encode((double)pixel[c] / opacity) : 0.0;
        if (!(fabs(number - rgb[c]) <= 2e-5))
            fail_msg("channel %d: %.7g instead of %.7g", c, number, rgb[c]);
    }
}

/* Renders and compares the pixel (4, 2). */
static void check(fixture *f, const double rgb[3], double opacity)
{
    film rendered = fixture_render(f);
    assert_pixel(&rendered, 4, 2, rgb, opacity);
    film_destroy(&rendered);
}

static double rendered_opacity(fixture *f, uint32_t x, uint32_t y)
{
    film rendered = fixture_render(f);
    double opacity = (double)fixture_pixel(&rendered, "", x, y)[3];
    film_destroy(&rendered);
    return opacity;
}

static double cut(double x)
{
    return fmin(fmax(x, 0.0), 1.0);
}

static void set3(float out[3], float a, float b, float c)
{
    out[0] = a;
    out[1] = b;
    out[2] = c;
}

/* A material on a quad at depth z; returns its legacy counterpart. */
static legacy_material *add_quad(fixture *f, float z)
{
    uint32_t material = fixture_add_material(f, scene_material_default());
    fixture_place(f, fixture_add_quad(f, material), 0, 0, z, 1.0f);
    legacy_material *m = &f->scene->legacy->materials[material];
    m->fields = LEGACY_AMBIENT | LEGACY_DIFFUSE | LEGACY_SPECULAR | LEGACY_EMISSION | LEGACY_SHININESS;
    return m;
}

/* ogl1_fixture_head_on() with a quad at the origin. */
static fixture quad_fixture(legacy_material **m)
{
    scene_legacy *legacy;
    fixture f = ogl1_fixture_head_on(&legacy);
    *m = add_quad(&f, 0.0f);
    return f;
}

static const unsigned char TEXEL[4] = {51, 204, 102, 153}; /* 0.2, 0.8, 0.4, 0.6 */

/* A map of one texel's color. */
static void set_map(fixture *f, legacy_material *m, legacy_map_slot slot, const unsigned char rgba[4])
{
    unsigned char texels[16];
    for (int i = 0; i < 16; i++)
        texels[i] = rgba[i % 4];
    m->maps[slot].ref.texture = fixture_add_texture(f, 2, 2, texels);
}

/* ---- the texture environment ---- */

/* rgl's table in double, with E the lit color and m the mean of T. */
static void environment(int type, int mode, const double E[4], const double T[4], double out[4])
{
    double m = (T[0] + T[1] + T[2]) / 3.0;
    bool is_luminance = type == LEGACY_LUMINANCE || type == LEGACY_LUMINANCE_ALPHA;
    bool replaces = mode == LEGACY_REPLACE || (mode == LEGACY_DECAL && type != LEGACY_RGBA);
    double opacity = 1.0;
    if (type == LEGACY_RGBA || type == LEGACY_LUMINANCE_ALPHA)
        opacity = T[3];
    if (type == LEGACY_ALPHA)
        opacity = m;
    for (int c = 0; c < 3; c++) {
        double t = is_luminance ? m : T[c];
        out[c] = E[c] * t;
        if (mode == LEGACY_BLEND)
            out[c] = E[c] * (1.0 - t);
        if (mode == LEGACY_ADD)
            out[c] = E[c] + t;
        if (mode == LEGACY_DECAL && type == LEGACY_RGBA)
            out[c] = E[c] * (1.0 - T[3]) + t * T[3];
        if (replaces)
            out[c] = t;
        if (type == LEGACY_ALPHA)
            out[c] = E[c];
    }
    bool has_opacity = type != LEGACY_RGB && type != LEGACY_LUMINANCE;
    out[3] = E[3] * (has_opacity ? opacity : 1.0);
    if (replaces && has_opacity)
        out[3] = opacity;
    if (mode == LEGACY_DECAL && type == LEGACY_RGBA)
        out[3] = E[3];
}

/* The texture multiplies all of the light, the highlight too; fixed functions add the highlight later. */
static void every_texture_type_and_mode(void **state)
{
    (void)state;
    const double T[4] = {0.2, 0.8, 0.4, 0.6};
    for (int variant = 0; variant < 4; variant++)
        for (int type = 0; type < 5; type++)
            for (int mode = 0; mode < 5; mode++) {
                legacy_material *m;
                fixture f = quad_fixture(&m);
                f.scene->legacy->is_rgl = true;
                set3(m->diffuse, 0.3f, 0.2f, 0.1f);
                set3(m->specular, 0.1f, 0.25f, 0.4f);
                set3(m->emission, 0.05f, 0.0f, 0.15f);
                m->shininess = 10.0f;
                m->opacity = 0.75f;
                m->texture_type = (legacy_texture_type)type;
                m->texture_mode = (legacy_texture_mode)mode;
                set_map(&f, m, LEGACY_DIFFUSE_MAP, TEXEL);
                f.desc.ogl1.variant = (facet_ogl1_variant)variant;
                bool is_separate = variant >= FACET_OGL1_VARIANT_FIXED;
                const double light[3] = {0.35, 0.2, 0.25}, highlight[3] = {0.1, 0.25, 0.4};
                double E[4] = {0, 0, 0, 0.75};
                double out[4];
                for (int c = 0; c < 3; c++)
                    E[c] = light[c] + (is_separate ? 0.0 : highlight[c]);
                environment(type, mode, E, T, out);
                for (int c = 0; c < 3; c++)
                    out[c] = cut(out[c] + (is_separate ? highlight[c] : 0.0));
                check(&f, out, out[3]);
                fixture_destroy(&f);
            }
}

/* MTL's rule: the diffuse map multiplies the diffuse color only; a black one, or none stated, counts as
 * white. */
static void the_diffuse_map_of_mtl(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        legacy_material *m;
        fixture f = quad_fixture(&m);
        set3(m->diffuse, 0.5f, 0.25f, 0.5f);
        if (kind == 1)
            set3(m->diffuse, 0.0f, 0.0f, 0.0f);
        if (kind == 2)
            m->fields = 0;
        set3(m->specular, 0.1f, 0.2f, 0.3f);
        set_map(&f, m, LEGACY_DIFFUSE_MAP, TEXEL);
        const double factored[3] = {0.1 + 0.1, 0.2 + 0.2, 0.2 + 0.3}, whole[3] = {0.3, 1.0, 0.7};
        check(&f, kind ? whole : factored, 1.0);
        fixture_destroy(&f);
    }
}

/* In linear light a texture is decoded, and combined with decoded colors. */
static void textures_in_linear_light(void **state)
{
    (void)state;
    legacy_material *m;
    fixture f = quad_fixture(&m);
    f.desc.ogl1.is_linear = true;
    set3(m->diffuse, 0.5f, 0.25f, 0.5f);
    set_map(&f, m, LEGACY_DIFFUSE_MAP, TEXEL);
    film rendered = fixture_render(&f);
    const double kd[3] = {0.5, 0.25, 0.5}, t[3] = {0.2, 0.8, 0.4};
    double expected[3];
    for (int c = 0; c < 3; c++)
        expected[c] = ogl1_encode(ogl1_decode(kd[c]) * ogl1_decode(t[c]));
    assert_pixel(&rendered, 4, 2, expected, 1.0);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

/* Each map times its constant; base and gain; channels of scalar maps. The half vector is 20 degrees off. */
static void maps_of_the_terms(void **state)
{
    (void)state;
    const double t[3] = {0.2, 0.8, 0.4};
    static const char channels[6] = {'r', 'g', 'b', 'm', 'l', 0};
    const double luminance = 0.2126 * 0.2 + 0.7152 * 0.8 + 0.0722 * 0.4;
    const double values[6] = {0.2, 0.8, 0.4, 0.6, luminance, luminance};
    for (int channel = 0; channel < 6; channel++) {
        legacy_material *m;
        fixture f = quad_fixture(&m);
        legacy_light_direction(0.0f, 40.0f * 0.017453292f, f.scene->legacy->lights[0].position);
        set3(m->ambient, 0.5f, 0.25f, 0.0f);
        set3(m->diffuse, 0.0f, 0.0f, 0.0f);
        set3(m->specular, 0.5f, 0.5f, 0.25f);
        set3(m->emission, 0.25f, 0.125f, 0.5f);
        m->shininess = 60.0f;
        for (int slot = 0; slot < LEGACY_MAP_COUNT; slot++)
            if (slot == LEGACY_AMBIENT_MAP || slot == LEGACY_SPECULAR_MAP || slot == LEGACY_EMISSION_MAP ||
                slot == LEGACY_SHININESS_MAP || slot == LEGACY_OPACITY_MAP)
                set_map(&f, m, (legacy_map_slot)slot, TEXEL);
        m->maps[LEGACY_AMBIENT_MAP].base = 0.1f;
        m->maps[LEGACY_AMBIENT_MAP].gain = 0.5f;
        m->maps[LEGACY_SHININESS_MAP].channel = channels[channel];
        m->maps[LEGACY_OPACITY_MAP].channel = channels[channel];
        m->maps[LEGACY_OPACITY_MAP].base = 0.05f;
        double lobe = pow(cos(20.0 * 0.017453292519943), 60.0 * values[channel]);
        double expected[3];
        for (int c = 0; c < 3; c++)
            expected[c] = cut((double)m->ambient[c] * (0.1 + 0.5 * t[c]) + (double)m->emission[c] * t[c] +
                              (double)m->specular[c] * t[c] * lobe);
        check(&f, expected, 0.05 + values[channel]);
        fixture_destroy(&f);
    }
}

/* A texel of (1, 0, 1) / sqrt 2 leans towards +u, which is +X; half as far with a multiplier. */
static void normal_maps(void **state)
{
    (void)state;
    static const unsigned char texel[4] = {218, 128, 218, 255};
    for (int side = 0; side < 2; side++) {
        scene_legacy *legacy;
        fixture f = ogl1_fixture_head_on(&legacy);
        if (side)
            f.camera.eye[2] = -10.0f;
        set3(legacy->lights[0].position, 0.6f, 0.0f, 0.8f);
        legacy_material *m = add_quad(&f, 0.0f);
        set3(m->diffuse, 0.75f, 0.75f, 0.75f);
        set_map(&f, m, LEGACY_NORMAL_MAP, texel);
        m->maps[LEGACY_NORMAL_MAP].bump_multiplier = 0.5f;
        f.desc.aovs = FACET_AOV_NORMAL;
        film rendered = fixture_render(&f);
        double n[3] = {0.5 * (2.0 * 218.0 / 255.0 - 1.0), 0.5 * (2.0 * 128.0 / 255.0 - 1.0),
                       2.0 * 218.0 / 255.0 - 1.0};
        double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        /* From behind, the camera's right is -X: the normal turned to the camera is (-x, -y, -z), which is
         * (x, -y, z) there. */
        double NL = (0.6 * n[0] + 0.8 * n[2]) / length;
        const double expected[3] = {0.75 * NL, 0.75 * NL, 0.75 * NL};
        assert_pixel(&rendered, 4, 2, expected, 1.0);
        const float *aov = fixture_pixel(&rendered, "normal", 4, 2);
        for (int c = 0; c < 3; c++)
            assert_true(fabs((double)aov[c] - n[c] / length * (side ? -1.0 : 1.0)) < 1e-5);
        film_destroy(&rendered);
        fixture_destroy(&f);
    }
}

/* A sphere under a sphere map whose red grows to the right and green to the top shows the image itself: uv
 * = n.xy / 2 + 1/2 where V is +Z. */
static void sphere_maps(void **state)
{
    (void)state;
    enum { SIZE = 128 };
    scene_legacy *legacy;
    fixture f = ogl1_fixture_head_on(&legacy);
    f.desc.width = f.desc.height = 64;
    static unsigned char texels[SIZE * SIZE * 4];
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            unsigned char *t = texels + 4 * (y * SIZE + x);
            t[0] = (unsigned char)(2 * x);
            t[1] = (unsigned char)(254 - 2 * y);
            t[2] = 0;
            t[3] = 255;
        }
    uint32_t material = fixture_add_material(&f, scene_material_default());
    fixture_place(&f, fixture_add_sphere(&f, 256, material), 0, 0, 0, 1.0f);
    legacy_material *m = &legacy->materials[material];
    m->is_lit = false;
    set3(m->diffuse, 1.0f, 1.0f, 1.0f);
    m->has_environment_map = true;
    m->maps[LEGACY_DIFFUSE_MAP].ref.texture = fixture_add_texture(&f, SIZE, SIZE, texels);
    film rendered = fixture_render(&f);
    uint32_t count = 0;
    for (uint32_t y = 0; y < 64; y++)
        for (uint32_t x = 0; x < 64; x++) {
            double nx = ((double)x + 0.5) / 32.0 - 1.0;
            double ny = 1.0 - ((double)y + 0.5) / 32.0;
            if (nx * nx + ny * ny > 0.8)
                continue;
            const float *pixel = fixture_pixel(&rendered, "", x, y);
            double u = 0.5 * nx + 0.5, v = 0.5 * ny + 0.5; /* texel i is code 2 i at (i + 1/2) / 128 */
            assert_true(fabs(ogl1_encode((double)pixel[0]) - (u * 256.0 - 1.0) / 255.0) < 0.004);
            assert_true(fabs(ogl1_encode((double)pixel[1]) - (v * 256.0 - 1.0) / 255.0) < 0.004);
            count++;
        }
    assert_true(count > 2000);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

/* ---- opacity ---- */

/* 8-bit codes of a film laid over a color. */
static void codes_over(film *rendered, const float *color, unsigned char rgb[3])
{
    image codes;
    film_tone_map(rendered, FACET_TONEMAP_NONE, NULL, 1);
    if (color)
        film_blend_encoded(rendered, color, 1);
    assert_int_equal(film_to_display_image(rendered, IMAGE_U8, false, NULL, 1, &codes, NULL), FACET_OK);
    memcpy(rgb, (const unsigned char *)codes.pixels + codes.channel_count * (4 + 2 * rendered->width), 3);
    image_destroy(&codes);
}

/* Front over back over background in the display's numbers, as glBlendFunc(GL_SRC_ALPHA,
 * GL_ONE_MINUS_SRC_ALPHA) did. */
static void alpha_over_alpha(void **state)
{
    (void)state;
    scene_legacy *legacy;
    fixture f = ogl1_fixture_head_on(&legacy);
    legacy_material *front = add_quad(&f, 1.0f), *back = add_quad(&f, -1.0f);
    set3(front->diffuse, 0.875f, 0.25f, 0.5f);
    set3(back->diffuse, 0.125f, 0.625f, 1.0f);
    front->opacity = 0.5f;
    back->opacity = 0.25f;
    film rendered = fixture_render(&f);
    double over[3], straight[3];
    const double background = 0.75, coverage = 0.5 + 0.5 * 0.25;
    for (int c = 0; c < 3; c++) {
        double behind = 0.25 * (double)back->diffuse[c] + 0.75 * background;
        over[c] = 0.5 * (double)front->diffuse[c] + 0.5 * behind;
        straight[c] = (0.5 * (double)front->diffuse[c] + 0.125 * (double)back->diffuse[c]) / coverage;
    }
    assert_pixel(&rendered, 4, 2, straight, coverage); /* content of a transparent image */
    const float linear = (float)ogl1_decode(background);
    const float color[3] = {linear, linear, linear};
    unsigned char codes[3];
    codes_over(&rendered, color, codes);
    for (int c = 0; c < 3; c++)
        assert_int_equal(codes[c], (int)floor(over[c] * 255.0 + 0.5));
    film_destroy(&rendered);

    f.desc.ogl1.is_linear = true; /* and as light */
    rendered = fixture_render(&f);
    const float *pixel = fixture_pixel(&rendered, "", 4, 2);
    for (int c = 0; c < 3; c++) {
        double sum =
            0.5 * ogl1_decode((double)front->diffuse[c]) + 0.125 * ogl1_decode((double)back->diffuse[c]);
        assert_true(fabs((double)pixel[c] - sum) < 1e-6);
    }
    film_destroy(&rendered);
    fixture_destroy(&f);
}

/* Opacity 0 is absent; vertex alpha and a map multiply; a halo is thinnest where it faces the camera. */
static void opacities(void **state)
{
    (void)state;
    static const unsigned char half[4] = {128, 128, 128, 255};
    legacy_material *m;
    fixture f = quad_fixture(&m);
    m->opacity = 0.0f;
    assert_true(rendered_opacity(&f, 4, 2) == 0.0);

    m->opacity = 0.5f;
    set_map(&f, m, LEGACY_OPACITY_MAP, half);
    float colors[16];
    for (int i = 0; i < 16; i++)
        colors[i] = i % 4 == 3 ? 0.75f : 1.0f;
    fixture_primitive(&f, 0)->colors = colors;
    assert_true(fabs(rendered_opacity(&f, 4, 2) - 0.5 * 0.75 * 128.0 / 255.0) < 1e-6);

    fixture_primitive(&f, 0)->colors = NULL;
    m->maps[LEGACY_OPACITY_MAP].ref.texture = SCENE_NONE;
    m->is_halo = true;
    f.camera.eye[0] = 10.0f; /* 45 degrees */
    assert_true(fabs(rendered_opacity(&f, 4, 4) - (1.0 - sqrt(0.5) * 0.5)) < 1e-5);
    fixture_destroy(&f);
}

/* Two lights do not make half transparent opaque, as rgl's WebGL shader does. */
static void opacity_does_not_count_lights(void **state)
{
    (void)state;
    for (int variant = 0; variant < 4; variant++) {
        scene_legacy *legacy;
        fixture f = ogl1_fixture_head_on(&legacy);
        f.desc.ogl1.variant = (facet_ogl1_variant)variant;
        legacy->lights[1] = legacy->lights[0];
        legacy->light_count = 2;
        add_quad(&f, 0.0f)->opacity = 0.375f;
        assert_true(fabs(rendered_opacity(&f, 4, 2) - 0.375) < 1e-6);
        fixture_destroy(&f);
    }
}

/* ---- images ---- */

/* lit = FALSE: the color as it is, and with a texture; no emission, no light. */
static void unlit_surfaces(void **state)
{
    (void)state;
    for (int variant = 0; variant < 4; variant++) {
        legacy_material *m;
        fixture f = quad_fixture(&m);
        f.desc.ogl1.variant = (facet_ogl1_variant)variant;
        m->is_lit = false;
        set3(m->diffuse, 0.7f, 0.4f, 0.1f);
        set3(m->emission, 0.3f, 0.3f, 0.3f);
        set3(m->specular, 1.0f, 1.0f, 1.0f);
        const double plain[3] = {(double)0.7f, (double)0.4f, (double)0.1f};
        const double textured[3] = {(double)0.7f * 0.2, (double)0.4f * 0.8, (double)0.1f * 0.4};
        check(&f, plain, 1.0);
        set_map(&f, m, LEGACY_DIFFUSE_MAP, TEXEL);
        check(&f, textured, 1.0);
        fixture_destroy(&f);
    }
}

/* Lines have no normals: they show their color. */
static void lines_show_their_color(void **state)
{
    (void)state;
    static const float line[6] = {-1.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f};
    scene_legacy *legacy;
    fixture f = ogl1_fixture_head_on(&legacy);
    f.desc.width = f.desc.height = 9;
    uint32_t material = fixture_add_material(&f, scene_material_default());
    fixture_place(&f, fixture_add_sprites(&f, SCENE_LINES, line, 2, material), 0, 0, 0, 1.0f);
    set3(legacy->materials[material].diffuse, 0.7f, 0.4f, 0.1f);
    film rendered = fixture_render(&f);
    const double expected[3] = {(double)0.7f, (double)0.4f, (double)0.1f};
    assert_pixel(&rendered, 4, 4, expected, 1.0);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

/* Backs are shown unless culled, whatever glTF's doubleSided says; a primitive without material has the
 * defaults. */
static void sides_and_defaults(void **state)
{
    (void)state;
    for (int is_culled = 0; is_culled < 2; is_culled++)
        for (int side = 0; side < 2; side++) {
            scene_legacy *legacy;
            fixture f = ogl1_fixture_head_on(&legacy);
            f.camera.eye[2] = side ? -10.0f : 10.0f;
            add_quad(&f, 0.0f)->is_culled = is_culled;
            assert_true(rendered_opacity(&f, 4, 2) == (is_culled && side ? 0.0 : 1.0));
            fixture_destroy(&f);
        }
    scene_legacy *legacy;
    fixture f = ogl1_fixture_head_on(&legacy);
    fixture_place(&f, fixture_add_quad(&f, SCENE_NONE), 0, 0, 0, 1.0f);
    const double expected[3] = {(double)0.8f, (double)0.8f, (double)0.8f};
    check(&f, expected, 1.0);
    fixture_destroy(&f);
}

static void aovs(void **state)
{
    (void)state;
    static const unsigned char texel[4] = {51, 204, 102, 255};
    legacy_material *m;
    fixture f = quad_fixture(&m);
    set3(m->diffuse, 0.5f, 0.5f, 0.5f);
    set_map(&f, m, LEGACY_DIFFUSE_MAP, texel);
    f.desc.aovs = FACET_AOV_DEPTH | FACET_AOV_NORMAL | FACET_AOV_ALBEDO | FACET_AOV_MATERIAL_ID |
                  FACET_AOV_UV | FACET_AOV_OCCLUSION;
    film rendered = fixture_render(&f);
    assert_true(fabsf(fixture_pixel(&rendered, "depth", 2, 6)[0] - 10.0f) < 1e-5f);
    assert_true(fabsf(fixture_pixel(&rendered, "normal", 2, 6)[2] - 1.0f) < 1e-6f);
    const double t[3] = {0.1, 0.4, 0.2};
    for (int c = 0; c < 3; c++)
        assert_true(fabs((double)fixture_pixel(&rendered, "albedo", 2, 6)[c] - ogl1_decode(t[c])) < 1e-5);
    assert_true(fixture_pixel(&rendered, "material", 2, 6)[0] == 1.0f);
    assert_true(fabsf(fixture_pixel(&rendered, "uv", 2, 6)[0] - 2.5f / 8.0f) < 1e-5f);
    assert_true(fabsf(fixture_pixel(&rendered, "uv", 2, 6)[1] - 6.5f / 8.0f) < 1e-5f);
    assert_true(fixture_pixel(&rendered, "occlusion", 2, 6)[0] == 1.0f);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_texture_type_and_mode),
        cmocka_unit_test(the_diffuse_map_of_mtl),
        cmocka_unit_test(textures_in_linear_light),
        cmocka_unit_test(maps_of_the_terms),
        cmocka_unit_test(normal_maps),
        cmocka_unit_test(sphere_maps),
        cmocka_unit_test(alpha_over_alpha),
        cmocka_unit_test(opacities),
        cmocka_unit_test(opacity_does_not_count_lights),
        cmocka_unit_test(unlit_surfaces),
        cmocka_unit_test(lines_show_their_color),
        cmocka_unit_test(sides_and_defaults),
        cmocka_unit_test(aovs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
