/* gl_bloom_test.c - bloom conserves energy, has the right shape, and is off by default. Exits with 77
 * where there is no OpenGL. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>
#include <epoxy/gl.h>

#include "gl/scene/gl_fixture_test.h"

static gl_fixture_contexts contexts;

/* An unlit square in the center, of edge 2 `scale`, in an image that is 2 m high. */
static fixture light_fixture(uint32_t width, uint32_t height, float scale)
{
    fixture f = fixture_create();
    f.desc.width = width;
    f.desc.height = height;
    scene_material emitter = gl_fixture_unlit(1.0f, 0.5f, 0.25f, 1.0f);
    fixture_place(&f, fixture_add_quad(&f, fixture_add_material(&f, emitter)), 0.0f, 0.0f, 0.0f, scale);
    return f;
}

static double sum_of(const film *image, int channel)
{
    double sum = 0.0;
    for (size_t i = 0; i < (size_t)image->width * image->height; i++)
        sum += (double)image->layers[0].pixels[4 * i + (size_t)channel];
    return sum;
}

static size_t bytes_of(const film *image)
{
    return (size_t)image->width * image->height * 4 * sizeof(float);
}

/* Odd sizes too, which cannot be halved exactly. */
static void bloom_preserves_energy(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{128, 96}, {129, 97}, {200, 61}};
    for (int c = 0; c < contexts.count; c++)
        for (int size = 0; size < 3; size++) {
            fixture f = light_fixture(sizes[size][0], sizes[size][1], 0.05f);
            film without = gl_fixture_render(&f, &contexts.items[c]);
            f.desc.gl.bloom = 0.25f;
            film with = gl_fixture_render(&f, &contexts.items[c]);
            for (int channel = 0; channel < 4; channel++) {
                double all = sum_of(&without, channel);
                assert_true(all > 0.5);
                double share = sum_of(&with, channel) / all;
                if (!(fabs(share - 1.0) < 0.01 * GL_FIXTURE_SLACK))
                    fail_msg("%u x %u, channel %d: %g of the energy", sizes[size][0], sizes[size][1], channel,
                             share);
            }
            /* It is missing in the center. */
            float middle = fixture_pixel(&without, "", sizes[size][0] / 2, sizes[size][1] / 2)[0];
            float left = fixture_pixel(&with, "", sizes[size][0] / 2, sizes[size][1] / 2)[0];
            assert_true(left < 0.95f * middle && left > 0.75f * middle);
            film_destroy(&without);
            film_destroy(&with);
            fixture_destroy(&f);
        }
}

static void zero_bloom_changes_nothing(void **state)
{
    (void)state;
    for (int c = 0; c < contexts.count; c++) {
        fixture f = light_fixture(64, 64, 0.3f);
        gl_renderer *renderer = gl_fixture_renderer(&f, &contexts.items[c]);
        film before = gl_fixture_draw(&f, renderer);
        f.desc.gl.bloom = 0.5f;
        film with = gl_fixture_draw(&f, renderer);
        f.desc.gl.bloom = 0.0f;
        film after = gl_fixture_draw(&f, renderer);
        assert_memory_equal(before.layers[0].pixels, after.layers[0].pixels, bytes_of(&before));
        assert_true(memcmp(before.layers[0].pixels, with.layers[0].pixels, bytes_of(&before)) != 0);
        film_destroy(&before);
        film_destroy(&with);
        film_destroy(&after);
        gl_renderer_destroy(renderer);
        fixture_destroy(&f);
    }
}

static void uniform_images_stay_uniform(void **state)
{
    (void)state;
    static const float wanted[4] = {1.0f, 0.5f, 0.25f, 1.0f};
    for (int c = 0; c < contexts.count; c++) {
        fixture f = light_fixture(100, 70, 4.0f);
        f.desc.gl.bloom = 1.0f;
        film image = gl_fixture_render(&f, &contexts.items[c]);
        for (uint32_t i = 0; i < 70; i += 3)
            gl_fixture_assert_pixel(&image, i, i, wanted, 1e-3f);
        film_destroy(&image);
        fixture_destroy(&f);
    }
}

/* Mean of a ring of pixels around the center. */
static double ring(const film *image, double radius)
{
    double sum = 0.0;
    for (int i = 0; i < 64; i++) {
        double angle = 6.283185307179586 * i / 64.0;
        double x = 0.5 * image->width + radius * cos(angle), y = 0.5 * image->height + radius * sin(angle);
        sum += (double)fixture_pixel(image, "", (uint32_t)x, (uint32_t)y)[0] / 64.0;
    }
    return sum;
}

/* A power law of -2.5 within the distances that the filters cover. */
static void bloom_falls_off_with_distance(void **state)
{
    (void)state;
    for (int c = 0; c < contexts.count; c++) {
        fixture f = light_fixture(512, 512, 0.01f);
        f.desc.gl.bloom = 1.0f;
        film image = gl_fixture_render(&f, &contexts.items[c]);
        double last = ring(&image, 4.0);
        for (double radius = 6.0; radius < 220.0; radius *= 1.5) {
            double here = ring(&image, radius);
            assert_true(here > 0.0 && here < last);
            last = here;
        }
        double power = log2(ring(&image, 64.0) / ring(&image, 16.0)) / 2.0;
        assert_true(power > -2.8 && power < -2.2);
        film_destroy(&image);
        fixture_destroy(&f);
    }
}

/* Bloom over a background equals bloom with the background in the image. */
static void coverage_blooms_like_radiance(void **state)
{
    (void)state;
    for (int c = 0; c < contexts.count; c++) {
        fixture f = light_fixture(96, 96, 0.4f);
        f.desc.gl.bloom = 0.3f;
        film over = gl_fixture_render(&f, &contexts.items[c]);
        scene_material wall = gl_fixture_unlit(0.75f, 0.75f, 0.75f, 1.0f);
        fixture_place(&f, fixture_add_quad(&f, fixture_add_material(&f, wall)), 0.0f, 0.0f, -1.0f, 4.0f);
        film in = gl_fixture_render(&f, &contexts.items[c]);
        for (uint32_t i = 0; i < 96; i += 2) {
            const float *p = fixture_pixel(&over, "", i, 95 - i);
            float wanted[4] = {0, 0, 0, 1.0f};
            for (int k = 0; k < 3; k++)
                wanted[k] = p[k] + (1.0f - p[3]) * 0.75f;
            gl_fixture_assert_pixel(&in, i, 95 - i, wanted, 2e-3f);
        }
        film_destroy(&over);
        film_destroy(&in);
        fixture_destroy(&f);
    }
}

/* In an image of twice the size bloom spreads over twice as many pixels. */
static void bloom_scales_with_the_image(void **state)
{
    (void)state;
    for (int c = 0; c < contexts.count; c++) {
        film images[2];
        for (int i = 0; i < 2; i++) {
            fixture f = light_fixture(512u << i, 512u << i, 0.05f);
            f.desc.samples = 1;
            f.desc.gl.bloom = 1.0f;
            images[i] = gl_fixture_render(&f, &contexts.items[c]);
            fixture_destroy(&f);
        }
        for (double radius = 32.0; radius < 220.0; radius += 20.0) {
            double small = ring(&images[0], radius), large = ring(&images[1], 2.0 * radius);
            assert_true(fabs(large / small - 1.0) < 0.1);
        }
        film_destroy(&images[0]);
        film_destroy(&images[1]);
    }
}

/* The levels of the texture that is bound, as far as its MAX_LEVEL says; 1: that has its default. */
static GLint level_count(void)
{
    GLint last;
    glGetTexParameteriv(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, &last);
    return last == 1000 ? 1 : last + 1;
}

enum { MAX_NAMES = 20000 };

/* Strict drivers of ES 3.0, browsers among them, draw into levels of immutable storage only. */
static void textures_with_levels_have_immutable_storage(void **state)
{
    (void)state;
    for (int c = 0; c < contexts.count; c++) {
        if (!contexts.items[c].has_texture_storage)
            continue;
        fixture f = light_fixture(64, 64, 0.3f);
        f.desc.gl.bloom = 0.5f;
        gl_renderer *renderer = gl_fixture_renderer(&f, &contexts.items[c]);
        film image = gl_fixture_draw(&f, renderer);
        assert_int_equal(gl_context_make_current(&contexts.items[c], NULL), FACET_OK);
        int found = 0;
        for (GLuint name = 1; name < MAX_NAMES; name++) {
            GLint is_immutable = 0;
            if (!glIsTexture(name))
                continue;
            glBindTexture(GL_TEXTURE_2D, name);
            if (glGetError() != GL_NO_ERROR || level_count() == 1) /* an array, or without levels */
                continue;
            glGetTexParameteriv(GL_TEXTURE_2D, GL_TEXTURE_IMMUTABLE_FORMAT, &is_immutable);
            assert_true(is_immutable);
            found++;
        }
        assert_true(found > 0);
        film_destroy(&image);
        gl_renderer_destroy(renderer);
        fixture_destroy(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bloom_preserves_energy),
        cmocka_unit_test(zero_bloom_changes_nothing),
        cmocka_unit_test(uniform_images_stay_uniform),
        cmocka_unit_test(bloom_falls_off_with_distance),
        cmocka_unit_test(coverage_blooms_like_radiance),
        cmocka_unit_test(bloom_scales_with_the_image),
        cmocka_unit_test(textures_with_levels_have_immutable_storage),
    };
    if (gl_fixture_open(&contexts) == 0)
        return 77;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    gl_fixture_close(&contexts);
    return failed;
}
