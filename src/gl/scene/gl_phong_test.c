/* gl_phong_test.c - FACET_SHADING_OGL1 by OpenGL: quads against the pipelines in double
 * (cpu/ogl1_fixture.h), everything else against the preview, which src/cpu/ogl1_*_test.c test. Exits with
 * 77 where there is no OpenGL. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "cpu/ogl1_fixture.h"
#include "gl/scene/gl_fixture_test.h"

enum { VARIANT_COUNT = 4 };
static gl_fixture_contexts contexts;

static void set3(float out[3], float a, float b, float c)
{
    out[0] = a;
    out[1] = b;
    out[2] = c;
}

/* The images of the preview and of OpenGL differ nowhere by more than `most`, except in a share of the
 * pixels. */
static void assert_same(fixture *f, float most, double share, const char *what)
{
    film reference = fixture_render(f);
    for (int c = 0; c < contexts.count; c++) {
        film image = gl_fixture_render(f, &contexts.items[c]);
        /* OpenGL ES multisamples half floats: 2^-11 relative. */
        float near = contexts.items[c].is_es ? fmaxf(most, 1e-3f) : most;
        image_difference d = gl_fixture_compare(&reference, &image, near);
        if (d.share > share)
            fail_msg("%s, context %d: %g of the pixels differ by more than %g, mean %g", what, c, d.share,
                     (double)near, d.mean);
        film_destroy(&image);
    }
    film_destroy(&reference);
}

/* ---- quads in double ---- */

/* With normals that rotate across the view. */
static ogl1_quad make_quad(facet_ogl1_variant variant, bool is_linear, bool is_flat)
{
    ogl1_quad q = {.variant = variant,
                   .size = 32,
                   .ambient = {0.1, 0.05, 0.2},
                   .diffuse = {0.5, 0.3, 0.7},
                   .specular = {0.4, 0.6, 0.25},
                   .emission = {0.02, 0.08, 0.0},
                   .shininess = 20.0,
                   .is_flat = is_flat,
                   .is_linear = is_linear,
                   .global_ambient = variant == FACET_OGL1_VARIANT_FIXED ? 0.2 : 0.0};
    static const double tilts[4][2] = {{-0.9, -0.6}, {1.2, -0.4}, {-0.7, 1.0}, {0.8, 0.9}};
    for (int i = 0; i < 4; i++) {
        double length = sqrt(tilts[i][0] * tilts[i][0] + tilts[i][1] * tilts[i][1] + 1.0);
        for (int c = 0; c < 3; c++)
            q.normals[i][c] = (double)(float)((c < 2 ? tilts[i][c] : 1.0) / length);
    }
    for (int i = 0; i < 3; i++) { /* viewpoint, world, point in the world */
        legacy_light l = legacy_light_default();
        l.is_viewpoint_relative = i == 0;
        l.is_point = i == 2;
        legacy_light_direction(0.4f - 1.2f * (float)i, 0.3f, l.position);
        if (l.is_point)
            set3(l.position, -1.0f, 0.7f, 1.5f);
        set3(l.ambient, 0.15f, 0.1f, 0.05f);
        set3(l.diffuse, 0.45f, 0.35f, 0.5f);
        set3(l.specular, 0.5f, 0.4f, 0.3f);
        q.lights[q.light_count++] = l;
    }
    return q;
}

/* Colors of the file are linear here, so that both computations use the same values. */
static fixture show(ogl1_quad *q, bool is_behind)
{
    fixture f = fixture_create();
    ogl1_fixture_camera(&f);
    scene_legacy *legacy = ogl1_fixture_legacy(&f);
    legacy->colors = FACET_LEGACY_COLORS_LINEAR;
    legacy_material *m = &legacy->materials[0];
    for (int c = 0; c < 3; c++) {
        m->ambient[c] = (float)q->ambient[c];
        m->diffuse[c] = (float)q->diffuse[c];
        m->specular[c] = (float)q->specular[c];
        m->emission[c] = (float)q->emission[c];
    }
    m->shininess = (float)q->shininess;
    m->is_smooth = !q->is_flat;
    legacy->light_count = q->light_count;
    memcpy(legacy->lights, q->lights, q->light_count * sizeof *q->lights);
    uint32_t mesh = fixture_add_quad(&f, fixture_add_material(&f, scene_material_default()));
    float *normals = (float *)(uintptr_t)fixture_primitive(&f, mesh)->normals;
    for (int i = 0; i < 12; i++)
        normals[i] = (float)q->normals[i / 3][i % 3];
    fixture_place(&f, mesh, 0, 0, 0, 1.0f);
    f.desc.width = f.desc.height = q->size;
    f.desc.ogl1.variant = q->variant;
    f.desc.ogl1.is_linear = q->is_linear;
    if (is_behind)
        f.camera.eye[2] = -3.0f;
    q->camera = f.camera;
    return f;
}

static void check_quad(const fixture *f, const ogl1_quad *q, gl_context *context, const char *what)
{
    film image = gl_fixture_render(f, context);
    uint32_t count = 0;
    for (uint32_t y = 0; y < q->size; y++)
        for (uint32_t x = 0; x < q->size; x++) {
            double rgb[3];
            const float *pixel = fixture_pixel(&image, "", x, y);
            if (pixel[3] < 1.0f || !ogl1_quad_color(q, x, y, rgb))
                continue;
            count++;
            for (int c = 0; c < 3; c++) {
                double value = q->is_linear ? (double)pixel[c] : ogl1_encode((double)pixel[c]);
                if (!(fabs(value - rgb[c]) <= GL_FIXTURE_SLACK * 2e-4 * fmax(1.0, rgb[c])))
                    fail_msg("%s: pixel (%u, %u), channel %d: %.8g instead of %.8g", what, x, y, c, value,
                             rgb[c]);
            }
        }
    assert_true(count >= 200);
    film_destroy(&image);
}

static void quads_match_the_computation_in_double_in_every_variant(void **state)
{
    (void)state;
    for (int k = 0; k < VARIANT_COUNT * 8; k++) {
        bool is_linear = k & 1, is_flat = k & 2, is_behind = k & 4;
        ogl1_quad q = make_quad((facet_ogl1_variant)(k >> 3), is_linear, is_flat);
        fixture f = show(&q, is_behind);
        char what[80];
        snprintf(what, sizeof what, "variant %d, linear %d, flat %d, behind %d", k >> 3, is_linear, is_flat,
                 is_behind);
        for (int c = 0; c < contexts.count; c++)
            check_quad(&f, &q, &contexts.items[c], what);
        fixture_destroy(&f);
    }
}

/* ---- against the preview ---- */

static legacy_material *add_quad(fixture *f, float z)
{
    uint32_t material = fixture_add_material(f, scene_material_default());
    fixture_place(f, fixture_add_quad(f, material), 0, 0, z, 1.0f);
    legacy_material *m = &f->scene->legacy->materials[material];
    m->fields = LEGACY_AMBIENT | LEGACY_DIFFUSE | LEGACY_SPECULAR | LEGACY_EMISSION | LEGACY_SHININESS;
    return m;
}

static uint32_t add_texel(fixture *f, const unsigned char rgba[4])
{
    unsigned char texels[16];
    for (int i = 0; i < 16; i++)
        texels[i] = rgba[i % 4];
    return fixture_add_texture(f, 2, 2, texels);
}

static void every_texture_type_and_mode_matches_the_preview(void **state)
{
    (void)state;
    static const unsigned char texel[4] = {51, 204, 102, 153};
    for (int k = 0; k < 25; k++) {
        scene_legacy *legacy;
        fixture f = ogl1_fixture_head_on(&legacy);
        legacy->is_rgl = true;
        legacy_material *m = add_quad(&f, 0.0f);
        set3(m->diffuse, 0.3f, 0.2f, 0.1f);
        set3(m->specular, 0.1f, 0.25f, 0.4f);
        set3(m->emission, 0.05f, 0.0f, 0.15f);
        m->shininess = 10.0f;
        m->opacity = 0.75f;
        m->texture_type = (legacy_texture_type)(k % 5);
        m->texture_mode = (legacy_texture_mode)(k / 5);
        m->maps[LEGACY_DIFFUSE_MAP].ref.texture = add_texel(&f, texel);
        f.desc.ogl1.variant = (facet_ogl1_variant)(k % VARIANT_COUNT);
        char what[40];
        snprintf(what, sizeof what, "type %d, mode %d", k % 5, k / 5);
        assert_same(&f, 1e-4f, 0.0, what);
        fixture_destroy(&f);
    }
}

/* Decoded for the first image, not for the next. */
static void decoded_texels_are_counted_per_image(void **state)
{
    (void)state;
    static const unsigned char texel[4] = {51, 204, 102, 153};
    scene_legacy *legacy;
    fixture f = ogl1_fixture_head_on(&legacy);
    add_quad(&f, 0.0f)->maps[LEGACY_DIFFUSE_MAP].ref.texture = add_texel(&f, texel);
    gl_renderer *renderer = gl_fixture_renderer(&f, &contexts.items[0]);
    facet_render_desc desc = f.desc;
    desc.camera = &f.camera;
    desc.crop[2] = desc.width;
    desc.crop[3] = desc.height;
    for (int i = 0; i < 2; i++) {
        film out;
        facet_render_stats stats;
        assert_int_equal(film_create(&desc.allocator, desc.width, desc.height, 0, &out, NULL), FACET_OK);
        assert_int_equal(gl_renderer_render(renderer, &desc, &out, &stats, NULL), FACET_OK);
        assert_int_equal(stats.decoded_texels, i == 0 ? 4 : 0);
        film_destroy(&out);
    }
    gl_renderer_destroy(renderer);
    fixture_destroy(&f);
}

/* All maps at once, with base, gain and channel; bumps too. */
static void maps_of_every_term_match_the_preview(void **state)
{
    (void)state;
    static const unsigned char texels[5][4] = {{51, 204, 102, 153},
                                               {200, 90, 160, 220},
                                               {218, 128, 218, 255},
                                               {130, 140, 150, 90},
                                               {250, 240, 60, 128}};
    static const char channels[6] = {'r', 'g', 'b', 'm', 'l', 0};
    for (int channel = 0; channel < 6; channel++) {
        scene_legacy *legacy;
        fixture f = ogl1_fixture_head_on(&legacy);
        legacy_light_direction(0.0f, 0.7f, legacy->lights[0].position);
        legacy_material *m = add_quad(&f, 0.0f);
        set3(m->ambient, 0.5f, 0.25f, 0.0f);
        set3(m->diffuse, 0.3f, 0.4f, 0.2f);
        set3(m->specular, 0.5f, 0.5f, 0.25f);
        set3(m->emission, 0.25f, 0.125f, 0.5f);
        m->shininess = 60.0f;
        static const legacy_map_slot slots[7] = {
            LEGACY_AMBIENT_MAP, LEGACY_SPECULAR_MAP, LEGACY_NORMAL_MAP, LEGACY_SHININESS_MAP,
            LEGACY_OPACITY_MAP, LEGACY_EMISSION_MAP, LEGACY_DIFFUSE_MAP};
        for (int i = 0; i < 7; i++)
            m->maps[slots[i]].ref.texture = add_texel(&f, texels[i % 5]);
        m->maps[LEGACY_AMBIENT_MAP].base = 0.1f;
        m->maps[LEGACY_AMBIENT_MAP].gain = 0.5f;
        m->maps[LEGACY_NORMAL_MAP].bump_multiplier = 0.5f;
        m->maps[LEGACY_SHININESS_MAP].channel = channels[channel];
        m->maps[LEGACY_OPACITY_MAP].channel = channels[channel];
        m->maps[LEGACY_OPACITY_MAP].base = 0.05f;
        f.desc.ogl1.is_linear = channel & 1;
        f.desc.ogl1.variant = channel & 2 ? FACET_OGL1_VARIANT_WEBGL : FACET_OGL1_VARIANT_VIGNETTE;
        assert_same(&f, 2e-4f, 0.0, "maps");
        fixture_destroy(&f);
    }
}

/* A sphere with a sphere map, and layers with fog, halo and opacity. */
static void spheres_match_the_preview_in_every_variant(void **state)
{
    (void)state;
    enum { SIZE = 64 };
    static unsigned char texels[SIZE * SIZE * 4];
    for (int i = 0; i < SIZE * SIZE; i++) {
        const unsigned char t[4] = {(unsigned char)(4 * (i % SIZE)), (unsigned char)(252 - 4 * (i / SIZE)),
                                    90, 255};
        memcpy(texels + 4 * i, t, 4);
    }
    for (int k = 0; k < VARIANT_COUNT * 3; k++) {
        fixture f = fixture_create();
        scene_legacy *legacy = ogl1_fixture_legacy(&f);
        ogl1_fixture_camera(&f);
        f.desc.width = f.desc.height = 64;
        f.desc.ogl1.variant = (facet_ogl1_variant)(k % VARIANT_COUNT);
        uint32_t material = fixture_add_material(&f, scene_material_default());
        fixture_place(&f, fixture_add_sphere(&f, 64, material), 0, 0, 0, 1.0f);
        legacy_material *m = &legacy->materials[material];
        set3(m->diffuse, 0.7f, 0.6f, 0.5f);
        set3(m->specular, 0.3f, 0.3f, 0.3f);
        m->shininess = 12.0f;
        if (k / VARIANT_COUNT == 0) {
            m->has_environment_map = true;
            m->maps[LEGACY_DIFFUSE_MAP].ref.texture = fixture_add_texture(&f, SIZE, SIZE, texels);
        } else if (k / VARIANT_COUNT == 1) {
            m->is_halo = true;
            m->opacity = 0.4f;
            m->is_culled = true;
        } else {
            legacy->fog = (legacy_fog){.mode = LEGACY_FOG_EXP2, .color = {0.2f, 0.5f, 0.9f}, .scale = 1.0f};
        }
        char what[32];
        snprintf(what, sizeof what, "sphere %d", k);
        assert_same(&f, 4e-3f, 0.04, what); /* a pixel at the rim may see another triangle */
        fixture_destroy(&f);
    }
}

/* Layers are blended in display colors. */
static void layers_blend_in_display_values(void **state)
{
    (void)state;
    for (int mode = FACET_TRANSPARENCY_SORTED; mode <= FACET_TRANSPARENCY_PEELED; mode++) {
        scene_legacy *legacy;
        fixture f = ogl1_fixture_head_on(&legacy);
        legacy_material *front = add_quad(&f, 1.0f), *back = add_quad(&f, -1.0f);
        set3(front->diffuse, 0.875f, 0.25f, 0.5f);
        set3(back->diffuse, 0.125f, 0.625f, 1.0f);
        front->opacity = 0.5f;
        back->opacity = 0.25f;
        f.desc.exposure_ev = -0.5f;
        f.desc.gl.transparency = (facet_transparency)mode;
        assert_same(&f, 1e-4f, 0.0, "layers");
        fixture_destroy(&f);
    }
}

/* Punctual lights of glTF where there are no legacy lights; vertex colors; points and lines. */
static void punctual_lights_colors_and_sprites_match_the_preview(void **state)
{
    (void)state;
    static const float positions[12] = {-0.8f, -0.5f, 0.2f, 0.7f, 0.6f,  0.2f,
                                        -0.6f, 0.7f,  0.1f, 0.8f, -0.7f, 0.3f};
    for (int variant = 0; variant < VARIANT_COUNT; variant++) {
        fixture f = fixture_create();
        ogl1_fixture_legacy(&f)->light_count = 0;
        ogl1_fixture_camera(&f);
        f.desc.samples = 1;
        f.desc.ogl1.variant = (facet_ogl1_variant)variant;
        legacy_material *m = add_quad(&f, 0.0f);
        set3(m->specular, 0.3f, 0.2f, 0.4f);
        m->shininess = 8.0f;
        fixture_place(&f, fixture_add_sprites(&f, SCENE_LINES, positions, 4, 0), 0, 0, 0, 1.0f);
        fixture_add_light(&f,
                          (scene_light){.type = SCENE_LIGHT_POINT,
                                        .color = {1.0f, 0.8f, 0.6f},
                                        .intensity = 12.0f,
                                        .range = INFINITY},
                          0.5f, 1.0f, 2.0f);
        assert_same(&f, 2e-3f, 0.01, "punctual lights");
        fixture_destroy(&f);
    }
}

/* ---- limits ---- */

static facet_result try_render(const fixture *f, gl_context *context, facet_error *error)
{
    film out;
    facet_render_stats stats;
    facet_render_desc desc = f->desc;
    desc.camera = &f->camera;
    desc.crop[2] = desc.width;
    desc.crop[3] = desc.height;
    gl_renderer *renderer = gl_fixture_renderer(f, context);
    assert_int_equal(film_create(&desc.allocator, desc.width, desc.height, 0, &out, NULL), FACET_OK);
    facet_result result = gl_renderer_render(renderer, &desc, &out, &stats, error);
    film_destroy(&out);
    gl_renderer_destroy(renderer);
    return result;
}

static void unsupported_materials_are_reported(void **state)
{
    (void)state;
    facet_error error;
    scene_legacy *legacy;
    fixture f = ogl1_fixture_head_on(&legacy);
    add_quad(&f, 0.0f);
    legacy_light lights[65];
    for (int i = 0; i < 65; i++)
        lights[i] = legacy_light_default();
    legacy->lights = lights;
    legacy->light_count = 64;
    assert_int_equal(try_render(&f, &contexts.items[0], &error), FACET_OK);
    legacy->light_count = 65;
    assert_int_equal(try_render(&f, &contexts.items[0], &error), FACET_ERROR_LIMIT);
    assert_non_null(strstr(error.message, "65 lights"));
    f.scene->legacy = NULL;
    assert_int_equal(try_render(&f, &contexts.items[0], &error), FACET_ERROR_ARGUMENT);
    fixture_destroy(&f);
}

/* One renderer for both models: neither leaves state behind. */
static void alternating_models_do_not_interfere(void **state)
{
    (void)state;
    scene_legacy *legacy;
    fixture f = ogl1_fixture_head_on(&legacy);
    legacy_material *m = add_quad(&f, 0.0f);
    set3(m->diffuse, 0.2f, 0.4f, 0.6f);
    gl_renderer *renderer = gl_fixture_renderer(&f, &contexts.items[0]);
    film first[2];
    for (int i = 0; i < 4; i++) {
        f.desc.shading = i % 2 ? FACET_SHADING_GLTF : FACET_SHADING_OGL1;
        film image = gl_fixture_draw(&f, renderer);
        if (i < 2) {
            first[i] = image;
            continue;
        }
        assert_memory_equal(first[i - 2].layers[0].pixels, image.layers[0].pixels,
                            (size_t)image.width * image.height * 4 * sizeof(float));
        film_destroy(&image);
    }
    assert_true(fixture_pixel(&first[0], "", 4, 2)[2] > 0.1f);
    film_destroy(&first[0]);
    film_destroy(&first[1]);
    gl_renderer_destroy(renderer);
    fixture_destroy(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quads_match_the_computation_in_double_in_every_variant),
        cmocka_unit_test(every_texture_type_and_mode_matches_the_preview),
        cmocka_unit_test(decoded_texels_are_counted_per_image),
        cmocka_unit_test(maps_of_every_term_match_the_preview),
        cmocka_unit_test(spheres_match_the_preview_in_every_variant),
        cmocka_unit_test(layers_blend_in_display_values),
        cmocka_unit_test(punctual_lights_colors_and_sprites_match_the_preview),
        cmocka_unit_test(unsupported_materials_are_reported),
        cmocka_unit_test(alternating_models_do_not_interfere),
    };
    if (gl_fixture_open(&contexts) == 0)
        return 77;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    gl_fixture_close(&contexts);
    return failed;
}
