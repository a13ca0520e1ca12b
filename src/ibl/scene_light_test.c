/* scene_light_test.c - lights that a model brings: cubes of known radiance, written as the extension has
 * them. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "tests/support/support.h"
#include "ibl/light_fixture.h"
#include "ibl/environment_source.h"
#include "scene/scene.h"
#include "ibl/sh.h"

static const double pi = 3.14159265358979323846;

typedef void (*radiance_function)(const double d[3], double out[3]);

/* How a light is written. {0}: 8-bit RGBD, by the letter of the extension. */
typedef struct writing {
    uint32_t size;
    image_type type;
    bool is_rgb;      /* no alpha: at most 1 */
    bool is_mirrored; /* as Babylon.js reads it: cube of a world with X mirrored, images as they are */
    bool has_phase;   /* coefficients of odd m with the sign of Condon and Shortley */
} writing;

/* The model's direction that texel (x, y) of image number face holds. */
static void texel_direction(const writing *w, uint32_t face, uint32_t x, uint32_t y, double d[3])
{
    double s = (2.0 * x + 1.0) / w->size - 1.0;
    double t = (2.0 * y + 1.0) / w->size - 1.0;
    cube_direction(face, w->is_mirrored ? s : -s, t, d);
    if (w->is_mirrored)
        d[0] = -d[0];
    double scale = 1.0 / sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (int k = 0; k < 3; k++)
        d[k] *= scale;
}

static void write_texel(const writing *w, const double c[3], double out[4])
{
    double peak = fmax(fmax(c[0], c[1]), fmax(c[2], 1.0));
    double d = w->is_rgb ? 1.0 : floor(255.0 / peak) / 255.0;
    for (int k = 0; k < 3; k++)
        out[k] = srgb_encode(fmin(c[k] * d, 1.0));
    out[3] = d;
}

static void write_face(const writing *w, radiance_function radiance, uint32_t face, scene_image *out)
{
    image i;
    uint32_t channels = w->is_rgb ? 3 : 4;
    assert_int_equal(image_create(NULL, w->size, w->size, channels, w->type, &i, NULL), FACET_OK);
    for (uint32_t k = 0; k < w->size * w->size; k++) {
        double d[3], c[3], texel[4];
        texel_direction(w, face, k % w->size, k / w->size, d);
        radiance(d, c);
        write_texel(w, c, texel);
        for (uint32_t j = 0; j < channels; j++)
            if (w->type == IMAGE_U8)
                ((uint8_t *)i.pixels)[channels * k + j] = (uint8_t)lround(255.0 * texel[j]);
            else
                ((uint16_t *)i.pixels)[channels * k + j] = (uint16_t)lround(65535.0 * texel[j]);
    }
    unsigned char *bytes = NULL;
    assert_int_equal(image_encode(&i, IMAGE_CODEC_PNG, &(image_encode_desc){0}, &bytes, &out->size, NULL),
                     FACET_OK);
    image_destroy(&i);
    out->bytes = bytes;
}

/* Coefficients of irradiance by sums over a fine cube. */
static void write_irradiance(const writing *w, radiance_function radiance, float out[9][3])
{
    double sum[SH_COUNT][3] = {{0.0}};
    const uint32_t n = 64;
    for (uint32_t i = 0; i < 6 * n * n; i++) {
        double d[3], c[3], y[SH_COUNT];
        cube_direction(i / (n * n), (2.0 * (i % n) + 1.0) / n - 1.0, (2.0 * (i / n % n) + 1.0) / n - 1.0, d);
        double scale = 1.0 / sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        for (int k = 0; k < 3; k++)
            d[k] *= scale;
        radiance(d, c);
        if (w->is_mirrored)
            d[0] = -d[0];
        sh_basis(d, y);
        for (int l = 0; l < SH_COUNT; l++)
            for (int k = 0; k < 3; k++)
                sum[l][k] += cube_texel_solid_angle(n, i % n, i / n % n) * y[l] * c[k];
    }
    static const double A[SH_COUNT] = {3.14159265, 2.0943951,  2.0943951,  2.0943951, 0.78539816,
                                       0.78539816, 0.78539816, 0.78539816, 0.78539816};
    for (int l = 0; l < SH_COUNT; l++)
        for (int k = 0; k < 3; k++)
            out[l][k] = (float)((w->has_phase && (l == 1 || l == 3 || l == 5 || l == 7) ? -1.0 : 1.0) * A[l] *
                                sum[l][k]);
}

/* A scene of nothing but a light. */
typedef struct lit_scene {
    facet_scene scene;
    scene_root root;
    scene_image images[6];
    scene_image_light light;
} lit_scene;

static const uint32_t image_indices[6] = {0, 1, 2, 3, 4, 5};

static lit_scene *make_scene(const writing *w, radiance_function radiance)
{
    lit_scene *s = calloc(1, sizeof *s);
    assert_non_null(s);
    for (uint32_t face = 0; face < 6; face++)
        write_face(w, radiance, face, &s->images[face]);
    s->light = (scene_image_light){.name = "",
                                   .rotation = {0.0f, 0.0f, 0.0f, 1.0f},
                                   .intensity = 1.0f,
                                   .specular_size = w->size,
                                   .mip_count = 1,
                                   .images = image_indices};
    write_irradiance(w, radiance, s->light.irradiance);
    s->root.image_light = 0;
    s->scene = (facet_scene){.source = "room.gltf",
                             .scene_count = 1,
                             .scenes = &s->root,
                             .image_count = 6,
                             .images = s->images,
                             .image_light_count = 1,
                             .image_lights = &s->light};
    return s;
}

static void destroy_scene(lit_scene *s)
{
    for (int i = 0; i < 6; i++)
        mem_free((void *)(uintptr_t)s->images[i].bytes);
    free(s);
}

static facet_environment *make_light(const lit_scene *s)
{
    facet_environment *e = NULL;
    facet_error error = {0};
    assert_true(facet_scene_has_environment(&s->scene, NULL));
    facet_result result = facet_environment_create_from_scene(&s->scene, NULL, NULL, &e, &error);
    if (result != FACET_OK)
        print_error("%s\n", error.message);
    assert_int_equal(result, FACET_OK);
    return e;
}

/* ---- closed forms ---- */

static void uniform(const double d[3], double out[3])
{
    (void)d;
    out[0] = 0.2;
    out[1] = 5.0;
    out[2] = 1.0;
}

/* All lookups give the one radiance there is. */
static void check_uniform(const writing *w, const double expected[3], float intensity, double tolerance)
{
    lit_scene *s = make_scene(w, uniform);
    s->light.intensity = intensity;
    for (int k = 0; k < 3; k++)
        s->light.irradiance[0][k] = (float)(expected[k] * pi / 0.28209479177); /* E = pi L = c Y00 */
    facet_environment *e = make_light(s);
    const ibl_light *light = prepare(e, all_lookups);
    for (int i = 0; i < 100; i++) {
        float d[3], out[5][3];
        test_direction(i, 100, d);
        ibl_background(light, d, 0.0f, out[0]);
        ibl_specular(light, d, 0.0f, out[1]);
        ibl_specular(light, d, 0.6f, out[2]);
        ibl_sheen(light, d, 0.3f, out[3]);
        ibl_irradiance_over_pi(light, d, out[4]);
        for (int j = 0; j < 5; j++)
            for (int k = 0; k < 3; k++)
                assert_near((double)out[j][k] / (expected[k] * (double)intensity), 1.0,
                            j == 4 ? 1e-5 : tolerance);
    }
    ibl_light_release(light);
    facet_environment_destroy(e);
    destroy_scene(s);
}

static void uniform_light_has_its_radiance(void **state)
{
    (void)state;
    /* 8 bits of a transfer function of slope 1 / 2.4 over d = 51 / 255: within 2 % of a channel */
    check_uniform(&(writing){.size = 16}, (const double[3]){0.2, 5.0, 1.0}, 1.0f, 0.02);
    check_uniform(&(writing){.size = 16, .type = IMAGE_U16}, (const double[3]){0.2, 5.0, 1.0}, 2.5f, 1e-4);
    check_uniform(&(writing){.size = 4, .is_rgb = true}, (const double[3]){0.2, 1.0, 1.0}, 1.0f, 0.01);
    check_uniform(&(writing){.size = 1, .type = IMAGE_U16}, (const double[3]){0.2, 5.0, 1.0}, 1.0f, 1e-4);
}

static uint32_t bright_face;

static void one_face(const double d[3], double out[3])
{
    cube_point p = cube_locate((float)d[0], (float)d[1], (float)d[2]);
    out[0] = out[1] = out[2] = p.face == bright_face ? 4.0 : 0.0;
}

/* One face of radiance 4, seen along each axis; a white surface that faces it sends out 4 times the form
 * factor of a square from one side length's half: (4 / 2 pi) 2 atan(1 / sqrt 2) / sqrt 2. */
static void each_face_lights_from_its_direction(void **state)
{
    (void)state;
    double form_factor = 4.0 / (2.0 * pi) * sqrt(2.0) * atan(1.0 / sqrt(2.0));
    for (bright_face = 0; bright_face < 6; bright_face++) {
        lit_scene *s = make_scene(&(writing){.size = 32, .type = IMAGE_U16}, one_face);
        facet_environment *e = make_light(s);
        const ibl_light *light = prepare(e, all_lookups);
        double mean = 0.0;
        for (uint32_t face = 0; face < 6; face++) {
            double d[3];
            float f[3], out[3];
            cube_direction(face, 0.0, 0.0, d);
            for (int k = 0; k < 3; k++)
                f[k] = (float)d[k];
            ibl_background(light, f, 0.0f, out);
            assert_near(out[0], face == bright_face ? 4.0 : 0.0, 1e-3);
            ibl_specular(light, f, 1.0f, out);
            mean += (double)out[0] / 6.0;
            if (face == bright_face)
                assert_near(out[0], 4.0 * form_factor, 0.02);
        }
        assert_near(mean, 4.0 * (form_factor + 4.0 * 0.25 * (1.0 - form_factor)) / 6.0, 0.02);
        ibl_light_release(light);
        facet_environment_destroy(e);
        destroy_scene(s);
    }
}

/* A light rotated by 90 degrees around +Y: radiance from +Z comes from +X, for reflections and diffuse
 * light. */
static void rotated_lights_turn(void **state)
{
    (void)state;
    bright_face = 4;
    lit_scene *s = make_scene(&(writing){.size = 16, .type = IMAGE_U16}, one_face);
    s->light.rotation[1] = s->light.rotation[3] = 0.70710678f;
    facet_environment *e = make_light(s);
    const ibl_light *light = prepare(e, all_lookups);
    static const float X[3] = {1.0f, 0.0f, 0.0f};
    static const float Z[3] = {0.0f, 0.0f, 1.0f};
    float at_x[3], at_z[3];
    ibl_background(light, X, 0.0f, at_x);
    ibl_background(light, Z, 0.0f, at_z);
    assert_near(at_x[0], 4.0, 1e-3);
    assert_near(at_z[0], 0.0, 1e-3);
    ibl_irradiance_over_pi(light, X, at_x);
    ibl_irradiance_over_pi(light, Z, at_z);
    assert_true(at_x[0] > 2.0f && at_z[0] < 1.0f);
    ibl_light_release(light);
    facet_environment_destroy(e);
    destroy_scene(s);
}

/* ---- the four conventions of files ---- */

static void gradient(const double d[3], double out[3])
{
    out[0] = 1.0 + 0.4 * d[0] + 0.3 * d[1] - 0.2 * d[2];
    out[1] = 1.0 - 0.3 * d[0] + 0.5 * d[2];
    out[2] = 2.0 + 1.5 * d[1] + 0.4 * d[0];
}

/* A lobe with k_1 filters L = a + b.d to a + k_1 b.d, with k_1 = 2 / 3 for diffuse light. */
static void gradients_are_read_in_all_conventions(void **state)
{
    (void)state;
    for (int reading = 0; reading < 8; reading++) {
        writing w = {.size = 32,
                     .type = reading & 4 ? IMAGE_U16 : IMAGE_U8,
                     .is_mirrored = reading & 1,
                     .has_phase = reading & 2};
        double tolerance = reading & 4 ? 3e-3 : 0.02;
        lit_scene *s = make_scene(&w, gradient);
        facet_environment *e = make_light(s);
        const ibl_light *light = prepare(e, all_lookups);
        for (int i = 0; i < 300; i++) {
            float d[3], sharp[3], rough[3], diffuse[3];
            double c[3], lower[3];
            test_direction(i, 300, d);
            gradient((const double[3]){(double)d[0], (double)d[1], (double)d[2]}, c);
            gradient((const double[3]){2.0 / 3.0 * (double)d[0], 2.0 / 3.0 * (double)d[1],
                                       2.0 / 3.0 * (double)d[2]},
                     lower);
            ibl_background(light, d, 0.0f, sharp);
            ibl_specular(light, d, 1.0f, rough);
            ibl_irradiance_over_pi(light, d, diffuse);
            for (int k = 0; k < 3; k++) {
                assert_near(sharp[k], c[k], tolerance);
                assert_near(rough[k], lower[k], tolerance);
                assert_near(diffuse[k], lower[k], 3e-3);
            }
            float back[3]; /* diffuse transmission is lit from the opposite side */
            ibl_irradiance_over_pi(light, (const float[3]){-d[0], -d[1], -d[2]}, back);
            assert_near(back[1] + diffuse[1], 2.0, 4e-3);
        }
        ibl_light_release(light);
        facet_environment_destroy(e);
        destroy_scene(s);
    }
}

/* Where images cannot hold the radiance, irradiance is still that of the file. */
static void irradiance_is_that_of_the_file(void **state)
{
    (void)state;
    lit_scene *s = make_scene(&(writing){.size = 16, .is_rgb = true}, gradient);
    for (int l = 0; l < SH_COUNT; l++)
        for (int k = 0; k < 3; k++)
            s->light.irradiance[l][k] *= 40.0f;
    facet_environment *e = make_light(s);
    const ibl_light *light = prepare(e, all_lookups);
    static const float Y[3] = {0.0f, 1.0f, 0.0f};
    float out[3];
    ibl_background(light, Y, 0.0f, out);
    assert_near(out[2], 1.0, 1e-3);
    ibl_irradiance_over_pi(light, Y, out);
    assert_near(out[2], 40.0 * (2.0 + 2.0 / 3.0 * 1.5), 0.1);
    assert_null(e->parts.levels[PREFILTER_GGX][0].texels);
    ibl_light_release(light);
    facet_environment_destroy(e);
    destroy_scene(s);
}

/* A gradient has no seams when read as it was written, and distinct ones in the other convention. */
static void seams_reveal_mirrored_faces(void **state)
{
    (void)state;
    cube c;
    assert_int_equal(cube_create(16, NULL, &c, NULL), FACET_OK);
    for (int is_wrong = 0; is_wrong < 2; is_wrong++) {
        writing w = {.size = 16, .is_mirrored = true};
        for (uint32_t i = 0; i < 6 * 256; i++) {
            double d[3], out[3];
            texel_direction(&w, i / 256, i % 16, i / 16 % 16, d);
            gradient(d, out);
            *cube_texel(&c, i / 256, is_wrong ? 15 - (int)(i % 16) : (int)(i % 16), (int)(i / 16 % 16)) =
                (rgbx){(float)out[0], (float)out[1], (float)out[2], 0.0f};
        }
        cube_fill_borders(&c);
        double seams = scene_cube_seams(&c);
        assert_true(is_wrong ? seams > 0.1 : seams < 0.04);
    }
    cube_destroy(&c);
}

/* ---- invalid files ---- */

static void check_failure(const lit_scene *s, facet_result expected, const char *words)
{
    facet_environment *e = (facet_environment *)(uintptr_t)1;
    facet_error error = {0};
    assert_int_equal(facet_environment_create_from_scene(&s->scene, NULL, NULL, &e, &error), expected);
    assert_null(e);
    if (!strstr(error.message, words) || strncmp(error.message, "room.gltf: ", 11) != 0)
        fail_msg("\"%s\" does not say \"%s\"", error.message, words);
}

static void invalid_images_are_refused(void **state)
{
    (void)state;
    lit_scene *s = make_scene(&(writing){.size = 8}, gradient);
    lit_scene *other = make_scene(&(writing){.size = 16}, gradient);
    scene_image good = s->images[3];

    s->images[3] = other->images[3];
    check_failure(s, FACET_ERROR_INVALID, "light 0: face -Y has 16 texels along an edge, face +X has 8");
    s->images[3] = (scene_image){0};
    check_failure(s, FACET_ERROR_READ, "light 0: face -Y: image 3 cannot be read");
    s->images[3] = good;
    s->images[3].size = 60;
    check_failure(s, FACET_ERROR_INVALID, "light 0: face -Y");
    s->images[3] = (scene_image){.bytes = (const unsigned char *)"no image", .size = 10};
    check_failure(s, FACET_ERROR_INVALID, "light 0: face -Y");

    image oblong;
    assert_int_equal(image_create(NULL, 8, 4, 3, IMAGE_U8, &oblong, NULL), FACET_OK);
    memset(oblong.pixels, 77, 96);
    unsigned char *bytes = NULL;
    size_t size = 0;
    assert_int_equal(image_encode(&oblong, IMAGE_CODEC_PNG, &(image_encode_desc){0}, &bytes, &size, NULL),
                     FACET_OK);
    image_destroy(&oblong);
    s->images[3] = (scene_image){.bytes = bytes, .size = size};
    check_failure(s, FACET_ERROR_INVALID, "face -Y: 8 x 4 texels: faces of a cube are square");
    mem_free(bytes);
    s->images[3] = good;

    s->scene.image_count = 5;
    check_failure(s, FACET_ERROR_READ, "face -Z: image 5 cannot be read");
    s->scene.image_count = 6;
    s->light.mip_count = 0;
    check_failure(s, FACET_ERROR_INVALID, "there are no images");
    s->light.mip_count = 1;

    captured_messages m = {0};
    s->light.specular_size = 256;
    facet_environment *e = NULL;
    facet_environment_desc desc = {.log = capture_log(&m)};
    assert_int_equal(facet_environment_create_from_scene(&s->scene, NULL, &desc, &e, NULL), FACET_OK);
    assert_int_equal(m.count, 1);
    assert_non_null(strstr(m.text, "specularImageSize is 256, but the faces have 8"));
    facet_environment_destroy(e);
    destroy_scene(s);
    destroy_scene(other);
}

/* Alpha 0 divides nothing by 0. */
static void texels_of_alpha_zero_are_finite(void **state)
{
    (void)state;
    lit_scene *s = make_scene(&(writing){.size = 4}, gradient);
    image i;
    assert_int_equal(image_create(NULL, 4, 4, 4, IMAGE_U8, &i, NULL), FACET_OK);
    memset(i.pixels, 0, 64);
    ((unsigned char *)i.pixels)[0] = 255;
    unsigned char *bytes = NULL;
    size_t size = 0;
    assert_int_equal(image_encode(&i, IMAGE_CODEC_PNG, &(image_encode_desc){0}, &bytes, &size, NULL),
                     FACET_OK);
    image_destroy(&i);
    scene_image good = s->images[0];
    s->images[0] = (scene_image){.bytes = bytes, .size = size};
    facet_environment *e = make_light(s);
    const float *p = e->panorama.pixels;
    for (uint32_t k = 0; k < 3 * e->panorama.width * e->panorama.height; k++)
        assert_true(p[k] >= 0.0f && p[k] <= 255.0f);
    facet_environment_destroy(e);
    mem_free(bytes);
    s->images[0] = good;
    destroy_scene(s);
}

/* A light belongs to a scene of the file, and the pose says which. */
static void the_pose_selects_the_light(void **state)
{
    (void)state;
    lit_scene *s = make_scene(&(writing){.size = 2}, uniform);
    scene_root roots[2] = {{.image_light = SCENE_NONE}, {.image_light = 0}};
    s->scene.scenes = roots;
    s->scene.scene_count = 2;
    const facet_pose_desc first = {.has_scene_index = true, .scene_index = 0};
    const facet_pose_desc second = {.has_scene_index = true, .scene_index = 1};
    const facet_pose_desc third = {.has_scene_index = true, .scene_index = 2};
    assert_false(facet_scene_has_environment(&s->scene, NULL));
    assert_false(facet_scene_has_environment(&s->scene, &first));
    assert_true(facet_scene_has_environment(&s->scene, &second));
    assert_false(facet_scene_has_environment(&s->scene, &third));
    s->scene.default_scene = 1;
    assert_true(facet_scene_has_environment(&s->scene, NULL));
    facet_environment *e = NULL;
    facet_error error = {0};
    assert_int_equal(facet_environment_create_from_scene(&s->scene, &first, NULL, &e, &error),
                     FACET_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "has no image-based light"));
    s->scene.default_scene = SCENE_NONE;
    s->scene.scene_count = 0;
    assert_false(facet_scene_has_environment(&s->scene, NULL));
    destroy_scene(s);
}

/* ---- threads and memory ---- */

static void lights_do_not_depend_on_threads(void **state)
{
    (void)state;
    lit_scene *s = make_scene(&(writing){.size = 20}, gradient);
    facet_environment *e[2];
    for (uint32_t i = 0; i < 2; i++)
        assert_int_equal(
            facet_environment_create_from_scene(
                &s->scene, NULL, &(facet_environment_desc){.thread_count = 1 + 4 * i}, &e[i], NULL),
            FACET_OK);
    assert_memory_equal(e[0]->panorama.pixels, e[1]->panorama.pixels, 80 * 40 * 12);
    assert_memory_equal(e[0]->irradiance_over_pi.texels, e[1]->irradiance_over_pi.texels,
                        mem_size(e[0]->irradiance_over_pi.texels));
    facet_environment_destroy(e[0]);
    facet_environment_destroy(e[1]);
    destroy_scene(s);
}

static void running_out_of_memory_leaks_nothing(void **state)
{
    (void)state;
    lit_scene *s = make_scene(&(writing){.size = 4}, gradient);
    for (long limit = 0;; limit = next_failure(limit)) {
        failing_allocator c = {.fail_at = limit};
        facet_environment_desc desc = {.allocator = failing_allocator_get(&c), .thread_count = 1};
        facet_environment *e = NULL;
        facet_error error;
        facet_result result = facet_environment_create_from_scene(&s->scene, NULL, &desc, &e, &error);
        facet_environment_destroy(e);
        assert_int_equal(c.blocks, 0);
        if (result == FACET_OK) {
            print_message("%ld allocations\n", limit);
            break;
        }
        assert_null(e);
        assert_int_equal(result, FACET_ERROR_MEMORY);
    }
    destroy_scene(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(uniform_light_has_its_radiance),
        cmocka_unit_test(each_face_lights_from_its_direction),
        cmocka_unit_test(rotated_lights_turn),
        cmocka_unit_test(gradients_are_read_in_all_conventions),
        cmocka_unit_test(irradiance_is_that_of_the_file),
        cmocka_unit_test(seams_reveal_mirrored_faces),
        cmocka_unit_test(invalid_images_are_refused),
        cmocka_unit_test(texels_of_alpha_zero_are_finite),
        cmocka_unit_test(the_pose_selects_the_light),
        cmocka_unit_test(lights_do_not_depend_on_threads),
        cmocka_unit_test(running_out_of_memory_leaks_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
