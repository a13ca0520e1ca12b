/* Tests of FACET_SHADING_OGL1: light. Pixels against double evaluations of each pipeline, for every
 * variant, kind of light, side and fog; punctual lights of glTF; linear light. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "cpu/ogl1_fixture.h"

enum { VARIANT_COUNT = 4 };

static const double DEGREE = 0.017453292519943295;

static void copy3(const double in[3], float out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = (float)in[i];
}

/* A quad with rotating normals, in colors that stay below 1 for the most part. */
static ogl1_quad make_quad(facet_ogl1_variant variant)
{
    ogl1_quad q = {.variant = variant,
                   .size = 64,
                   .ambient = {0.1, 0.05, 0.2},
                   .diffuse = {0.5, 0.3, 0.7},
                   .specular = {0.4, 0.6, 0.25},
                   .emission = {0.02, 0.08, 0.0},
                   .shininess = 20.0,
                   .global_ambient = variant == FACET_OGL1_VARIANT_FIXED ? 0.2 : 0.0};
    static const double tilts[4][2] = {{-0.9, -0.6}, {1.2, -0.4}, {-0.7, 1.0}, {0.8, 0.9}};
    for (int i = 0; i < 4; i++) {
        double n[3] = {tilts[i][0], tilts[i][1], 1.0};
        double length = sqrt(n[0] * n[0] + n[1] * n[1] + 1.0);
        for (int c = 0; c < 3; c++)
            q.normals[i][c] = (double)(float)(n[c] / length);
    }
    return q;
}

/* The fixture shows the quad. */
static fixture show(ogl1_quad *q)
{
    fixture f = fixture_create();
    ogl1_fixture_camera(&f);
    scene_legacy *legacy = ogl1_fixture_legacy(&f);
    legacy_material *m = &legacy->materials[0];
    copy3(q->ambient, m->ambient);
    copy3(q->diffuse, m->diffuse);
    copy3(q->specular, m->specular);
    copy3(q->emission, m->emission);
    m->shininess = (float)q->shininess;
    m->is_smooth = !q->is_flat;
    legacy->light_count = q->light_count;
    memcpy(legacy->lights, q->lights, q->light_count * sizeof *q->lights);
    legacy->fog = q->fog;
    uint32_t mesh = fixture_add_quad(&f, fixture_add_material(&f, scene_material_default()));
    float *normals = (float *)(uintptr_t)fixture_primitive(&f, mesh)->normals;
    for (int i = 0; i < 12; i++)
        normals[i] = (float)q->normals[i / 3][i % 3];
    fixture_place(&f, mesh, 0, 0, 0, 1.0f);
    f.desc.ogl1.variant = q->variant;
    f.desc.ogl1.is_linear = q->is_linear;
    q->camera = f.camera;
    return f;
}

static legacy_light directional(bool is_viewpoint_relative, float theta, float phi)
{
    legacy_light l = legacy_light_default();
    l.is_viewpoint_relative = is_viewpoint_relative;
    legacy_light_direction(theta, phi, l.position);
    const float colors[3][3] = {{0.3f, 0.2f, 0.1f}, {0.9f, 0.7f, 1.0f}, {1.0f, 0.8f, 0.6f}};
    memcpy(l.ambient, colors[0], sizeof l.ambient);
    memcpy(l.diffuse, colors[1], sizeof l.diffuse);
    memcpy(l.specular, colors[2], sizeof l.specular);
    return l;
}
static legacy_light point(bool is_viewpoint_relative, float x, float y, float z)
{
    legacy_light l = directional(is_viewpoint_relative, 0.0f, 0.0f);
    l.is_point = true;
    l.position[0] = x;
    l.position[1] = y;
    l.position[2] = z;
    return l;
}

/* ---- each variant under each kind of light, from both sides ---- */

static void add_lights(ogl1_quad *q, int kind)
{
    const legacy_light lights[4] = {directional(true, 0.4f, 0.3f), directional(false, -0.8f, 0.5f),
                                    point(true, 0.5f, 0.8f, -0.5f), point(false, -1.0f, 0.7f, 1.5f)};
    if (kind < 4)
        q->lights[q->light_count++] = lights[kind];
    else
        for (int i = 0; i < 3; i++)
            q->lights[q->light_count++] = lights[i + 1];
}

static void variants_lights_and_sides(void **state)
{
    (void)state;
    for (int variant = 0; variant < VARIANT_COUNT; variant++)
        for (int kind = 0; kind < 5; kind++)
            for (int side = 0; side < 2; side++) {
                ogl1_quad q = make_quad((facet_ogl1_variant)variant);
                add_lights(&q, kind);
                fixture f = show(&q);
                if (side)
                    f.camera.eye[2] = q.camera.eye[2] = -3.0f;
                char what[64];
                snprintf(what, sizeof what, "variant %d, light %d, side %d", variant, kind, side);
                ogl1_quad_check(&f, &q, 1000, what);
                fixture_destroy(&f);
            }
}

/* The rules differ where they should: the same scene in two variants is not the same image. */
static void variants_differ(void **state)
{
    (void)state;
    film films[VARIANT_COUNT];
    for (int variant = 0; variant < VARIANT_COUNT; variant++) {
        ogl1_quad q = make_quad((facet_ogl1_variant)variant);
        add_lights(&q, 4);
        fixture f = show(&q);
        f.camera.eye[0] = 4.0f; /* normals turn away within the image */
        f.camera.fov_y_rad = 1.0f;
        films[variant] = fixture_render(&f);
        fixture_destroy(&f);
    }
    for (int a = 0; a < VARIANT_COUNT; a++)
        for (int b = 0; b < a; b++) {
            uint32_t different = 0;
            for (uint32_t i = 0; i < 4 * 64 * 64; i++)
                different += fabsf(films[a].layers[0].pixels[i] - films[b].layers[0].pixels[i]) > 0.01f;
            assert_true(different > 10);
        }
    for (int variant = 0; variant < VARIANT_COUNT; variant++)
        film_destroy(&films[variant]);
}

static void flat_faces(void **state)
{
    (void)state;
    for (int variant = 0; variant < VARIANT_COUNT; variant++) {
        ogl1_quad q = make_quad((facet_ogl1_variant)variant);
        q.is_flat = true;
        add_lights(&q, 3);
        fixture f = show(&q);
        ogl1_quad_check(&f, &q, 1000, "flat");
        fixture_destroy(&f);
    }
}

/* A light at the viewpoint follows a camera that orbits the quad, one of the world does not. */
static void lights_that_move_with_the_camera(void **state)
{
    (void)state;
    for (int relative = 0; relative < 2; relative++) {
        float first = 0.0f;
        for (int i = 0; i < 5; i++) {
            ogl1_quad q = make_quad(FACET_OGL1_VARIANT_VIGNETTE);
            for (int k = 0; k < 12; k++)
                q.normals[k / 3][k % 3] = k % 3 == 2;
            q.shininess = 0.0;
            q.lights[q.light_count++] = directional(relative, 0.0f, 0.0f);
            fixture f = show(&q);
            double angle = (15.0 * i - 30.0) * DEGREE;
            f.camera.eye[0] = q.camera.eye[0] = (float)(4.0 * sin(angle));
            f.camera.eye[1] = q.camera.eye[1] = 0.0f;
            f.camera.eye[2] = q.camera.eye[2] = (float)(4.0 * cos(angle));
            ogl1_quad_check(&f, &q, 1000, "turned camera");
            film rendered = fixture_render(&f);
            float middle = fixture_pixel(&rendered, "", 32, 32)[0];
            if (i == 0)
                first = middle;
            /* N.L is cos(angle) for a light at the camera, 1 for one of the world; equal at -30 and 30
             * degrees */
            bool is_equal = fabsf(middle - first) < 1e-4f;
            assert_true(is_equal == (!relative || i == 0 || i == 4));
            film_destroy(&rendered);
            fixture_destroy(&f);
        }
    }
}

/* w = 1 as printed: the camera's position gets into the light's direction, which is not of unit length
 * then. */
static void directions_as_the_vignette_prints_them(void **state)
{
    (void)state;
    ogl1_quad q = make_quad(FACET_OGL1_VARIANT_VIGNETTE);
    q.direction_w = 1.0;
    q.lights[q.light_count++] = directional(false, 0.3f, 0.2f);
    q.lights[q.light_count++] = directional(true, 0.3f, 0.2f); /* stays */
    fixture f = show(&q);
    f.desc.ogl1.translates_directions = true;
    ogl1_quad_check(&f, &q, 1000, "w = 1");
    fixture_destroy(&f);
}

/* ---- which lights ---- */

/* Its ambient part is 1 for rgl's materials; for others it is OpenGL's global ambient light, which FIXED
 * has anyway. */
static void without_lights_there_is_rgls_default(void **state)
{
    (void)state;
    for (int i = 0; i < 8; i++) {
        bool ignores = i & 1, is_rgl = i & 2, is_fixed = i & 4;
        ogl1_quad q = make_quad(is_fixed ? FACET_OGL1_VARIANT_FIXED : FACET_OGL1_VARIANT_VIGNETTE);
        float ambient = is_rgl ? 1.0f : is_fixed ? 0.0f : 0.2f;
        if (ignores)
            q.lights[q.light_count++] = directional(false, 0.3f, 0.2f);
        fixture f = show(&q);
        f.scene->legacy->is_rgl = is_rgl;
        f.desc.ignores_scene_lights = ignores;
        q.light_count = 1;
        q.lights[0] = (legacy_light){.is_viewpoint_relative = true,
                                     .position = {0.0f, (float)sin(15.0 * DEGREE), (float)cos(15.0 * DEGREE)},
                                     .ambient = {ambient, ambient, ambient},
                                     .diffuse = {1, 1, 1},
                                     .specular = {1, 1, 1}};
        ogl1_quad_check(&f, &q, 1000, "default light");
        fixture_destroy(&f);
    }
}

/* A punctual light of pi lx is a legacy light of 1; others are encoded like colors. */
static void directional_lights_of_gltf_are_lit_by_their_irradiance(void **state)
{
    (void)state;
    for (int is_linear = 0; is_linear < 2; is_linear++) {
        const float factor = 0.3f;
        ogl1_quad q = make_quad(FACET_OGL1_VARIANT_WEBGL);
        q.is_linear = is_linear;
        if (is_linear)
            for (int c = 0; c < 3; c++) {
                q.ambient[c] = ogl1_decode(q.ambient[c]);
                q.diffuse[c] = ogl1_decode(q.diffuse[c]);
                q.specular[c] = ogl1_decode(q.specular[c]);
                q.emission[c] = ogl1_decode(q.emission[c]);
            }
        fixture f = show(&q);
        if (is_linear) { /* the values of make_quad() */
            ogl1_quad file = make_quad(FACET_OGL1_VARIANT_WEBGL);
            copy3(file.ambient, f.scene->legacy->materials[0].ambient);
            copy3(file.diffuse, f.scene->legacy->materials[0].diffuse);
            copy3(file.specular, f.scene->legacy->materials[0].specular);
            copy3(file.emission, f.scene->legacy->materials[0].emission);
        }
        scene_light light = {.name = "",
                             .type = SCENE_LIGHT_DIRECTIONAL,
                             .color = {1.0f, 0.5f, 0.25f},
                             .intensity = 3.14159265f * factor};
        fixture_add_light(&f, light, 0, 0, 0); /* emits along -Z */
        q.light_count = 1;
        q.lights[0] = (legacy_light){.position = {0, 0, 1}};
        for (int c = 0; c < 3; c++) {
            double linear = (double)factor * pow(0.5, c);
            q.lights[0].diffuse[c] = q.lights[0].specular[c] =
                (float)(is_linear ? linear : ogl1_encode(linear));
        }
        ogl1_quad_check(&f, &q, 1000, is_linear ? "light, linear" : "light, encoded");
        fixture_destroy(&f);
    }
}

/* Points and spots have their inverse square and cones: irradiance / pi, at the middle of the image. */
static void lights_with_falloff_have_it_in_ogl1_too(void **state)
{
    (void)state;
    for (int is_spot = 0; is_spot < 2; is_spot++) {
        ogl1_quad q = make_quad(FACET_OGL1_VARIANT_VIGNETTE);
        q.is_linear = true;
        fixture f = show(&q);
        f.scene->legacy->colors = FACET_LEGACY_COLORS_LINEAR;
        f.camera.eye[0] = f.camera.eye[1] = 0.0f;
        legacy_material *m = &f.scene->legacy->materials[0];
        memset(m->ambient, 0, sizeof m->ambient);
        memset(m->emission, 0, sizeof m->emission);
        memset(m->specular, 0, sizeof m->specular);
        m->is_smooth = false;
        scene_light light = {.name = "",
                             .type = is_spot ? SCENE_LIGHT_SPOT : SCENE_LIGHT_POINT,
                             .color = {1.0f, 1.0f, 1.0f},
                             .intensity = 20.0f,
                             .inner_cone_rad = 0.1f,
                             .outer_cone_rad = 0.4f};
        fixture_add_light(&f, light, 0.0f, 0.0f, 2.0f);
        film rendered = fixture_render(&f);
        double pixel = 2.0 * tan(0.35) * 3.0 / 64.0;
        for (uint32_t x = 32; x < 60; x += 3) {
            double px = ((double)x + 0.5 - 32.0) * pixel;
            double py = -0.5 * pixel;
            double d2 = px * px + py * py + 4.0;
            if (px > 0.98)
                break;
            double cosine = 2.0 / sqrt(d2);
            double cone = (cosine - cos((double)0.4f)) / (cos((double)0.1f) - cos((double)0.4f));
            cone = is_spot ? pow(fmin(fmax(cone, 0.0), 1.0), 2.0) : 1.0;
            double expected = 20.0 / d2 * cone / 3.14159265358979 * cosine * 0.5;
            assert_true(fabs((double)fixture_pixel(&rendered, "", x, 32)[0] - expected) < 3e-5);
        }
        film_destroy(&rendered);
        fixture_destroy(&f);
    }
}

/* ---- linear light ---- */

/* Colors of the file are decoded, sums are not cut at 1. */
static void linear_light(void **state)
{
    (void)state;
    for (int variant = 0; variant < VARIANT_COUNT; variant++)
        for (int is_srgb = 0; is_srgb < 2; is_srgb++) {
            ogl1_quad q = make_quad((facet_ogl1_variant)variant);
            q.is_linear = true;
            q.diffuse[0] = 0.95;
            add_lights(&q, 4);
            fixture f = show(&q);
            f.scene->legacy->colors = is_srgb ? FACET_LEGACY_COLORS_SRGB : FACET_LEGACY_COLORS_LINEAR;
            for (int c = 0; is_srgb && c < 3; c++) {
                q.ambient[c] = ogl1_decode(q.ambient[c]);
                q.diffuse[c] = ogl1_decode(q.diffuse[c]);
                q.specular[c] = ogl1_decode(q.specular[c]);
                q.emission[c] = ogl1_decode(q.emission[c]);
                for (uint32_t i = 0; i < q.light_count; i++) {
                    legacy_light *l = &q.lights[i];
                    l->ambient[c] = (float)ogl1_decode((double)l->ambient[c]);
                    l->diffuse[c] = (float)ogl1_decode((double)l->diffuse[c]);
                    l->specular[c] = (float)ogl1_decode((double)l->specular[c]);
                }
            }
            if (is_srgb)
                q.global_ambient = q.global_ambient > 0.0 ? ogl1_decode(q.global_ambient) : 0.0;
            ogl1_quad_check(&f, &q, 1000, "linear");
            film rendered = fixture_render(&f);
            float brightest = 0.0f;
            for (uint32_t i = 0; i < 64 * 64; i++)
                brightest = fmaxf(brightest, rendered.layers[0].pixels[4 * i]);
            assert_true(brightest > 1.05f || is_srgb);
            film_destroy(&rendered);
            fixture_destroy(&f);
        }
}

/* Display values do not depend on their meaning as light. */
static void encoded_numbers_have_no_color_space(void **state)
{
    (void)state;
    ogl1_quad q = make_quad(FACET_OGL1_VARIANT_VIGNETTE);
    add_lights(&q, 4);
    fixture f = show(&q);
    f.scene->legacy->colors = FACET_LEGACY_COLORS_LINEAR;
    ogl1_quad_check(&f, &q, 1000, "encoded, colors linear");
    fixture_destroy(&f);
}

/* ---- fog ---- */

/* With the camera's clipping distances, and with those of the sphere around the quad: radius sqrt 2, 3.5 m
 * away. */
static void fog(void **state)
{
    (void)state;
    for (int variant = 0; variant < VARIANT_COUNT; variant++)
        for (int mode = 0; mode < 4; mode++)
            for (int has_clipping = 0; has_clipping < 2; has_clipping++) {
                ogl1_quad q = make_quad((facet_ogl1_variant)variant);
                add_lights(&q, 4);
                q.fog =
                    (legacy_fog){.mode = (legacy_fog_mode)mode, .color = {0.75f, 0.5f, 0.25f}, .scale = 1.5f};
                fixture f = show(&q);
                double distance = sqrt(1.5 * 1.5 + 1.0 + 9.0);
                q.near_m = has_clipping ? 1.0 : distance - sqrt(2.0);
                q.far_m = has_clipping ? 9.0 : distance + sqrt(2.0);
                q.fog_w = (1.0 - sin(0.5 * (double)0.7f)) / (1.0 + sin(0.5 * (double)0.7f));
                if (has_clipping) {
                    f.camera.near_m = 1.0f;
                    f.camera.far_m = 9.0f;
                }
                char what[64];
                snprintf(what, sizeof what, "variant %d, fog %d, clipping %d", variant, mode, has_clipping);
                ogl1_quad_check(&f, &q, 1000, what);
                q.fog.mode = LEGACY_FOG_NONE;
                f.desc.ogl1.ignores_fog = true;
                ogl1_quad_check(&f, &q, 1000, "ignored fog");
                f.desc.ogl1.ignores_fog = false;
                f.scene->legacy->materials[0].has_fog = false;
                ogl1_quad_check(&f, &q, 1000, "material without fog");
                fixture_destroy(&f);
            }
}

/* ---- vertex colors ---- */

/* Encoded per vertex and interpolated then; in place of the diffuse color by rgl's rules, times it by
 * MTL's. */
static void vertex_colors(void **state)
{
    (void)state;
    static const double colors[4][3] = {{0.9, 0.1, 0.2}, {0.2, 0.8, 0.1}, {0.3, 0.2, 0.7}, {1.0, 0.9, 0.6}};
    for (int variant = 0; variant < VARIANT_COUNT; variant++)
        for (int is_rgl = 0; is_rgl < 2; is_rgl++)
            for (int is_srgb = 0; is_srgb < 2; is_srgb++) {
                ogl1_quad q = make_quad((facet_ogl1_variant)variant);
                add_lights(&q, 1);
                fixture f = show(&q);
                f.scene->legacy->is_rgl = is_rgl;
                f.scene->legacy->colors = is_srgb ? FACET_LEGACY_COLORS_SRGB : FACET_LEGACY_COLORS_LINEAR;
                scene_primitive *p = fixture_primitive(&f, 0);
                float *stored = arena_alloc(f.scene->arena, 16, sizeof *stored);
                assert_non_null(stored);
                q.has_colors = true;
                for (int i = 0; i < 4; i++) {
                    for (int c = 0; c < 3; c++) {
                        stored[4 * i + c] = (float)(is_srgb ? ogl1_decode(colors[i][c]) : colors[i][c]);
                        q.colors[i][c] = colors[i][c] * (is_rgl ? 1.0 : q.diffuse[c]);
                    }
                    stored[4 * i + 3] = 1.0f;
                }
                p->colors = stored;
                ogl1_quad_check(&f, &q, 1000, "vertex colors");
                fixture_destroy(&f);
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(variants_lights_and_sides),
        cmocka_unit_test(variants_differ),
        cmocka_unit_test(flat_faces),
        cmocka_unit_test(lights_that_move_with_the_camera),
        cmocka_unit_test(directions_as_the_vignette_prints_them),
        cmocka_unit_test(without_lights_there_is_rgls_default),
        cmocka_unit_test(directional_lights_of_gltf_are_lit_by_their_irradiance),
        cmocka_unit_test(lights_with_falloff_have_it_in_ogl1_too),
        cmocka_unit_test(linear_light),
        cmocka_unit_test(encoded_numbers_have_no_color_space),
        cmocka_unit_test(fog),
        cmocka_unit_test(vertex_colors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
