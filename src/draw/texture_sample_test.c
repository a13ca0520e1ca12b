/* Tests of texture_sample(): wrapping, filters, choice of levels, footprints. Textures are made in memory. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "draw/texture_set.h"
#include "tests/support/support.h"

static texture_tables tables;

/* A set of one texture with the default sampler, read as data or color. */
typedef struct fixture {
    texture_pyramid pyramid;
    texture_binding binding;
    texture_set set;
} fixture;

static image make_image(uint32_t width, uint32_t height, uint32_t channel_count, image_type type)
{
    image i;
    assert_int_equal(image_create(NULL, width, height, channel_count, type, &i, NULL), FACET_OK);
    i.is_srgb = true;
    return i;
}

static void set_up(fixture *f, image i, bool as_color)
{
    *f = (fixture){0};
    assert_int_equal(
        texture_pyramid_create(&i, 0, i.width, i.height, 0, as_color, &tables, NULL, &f->pyramid, NULL),
        FACET_OK);
    f->binding.color = as_color ? &f->pyramid : NULL;
    f->binding.data = as_color ? NULL : &f->pyramid;
    f->set = (texture_set){.binding_count = 1, .bindings = &f->binding};
}

static void tear_down(fixture *f)
{
    texture_pyramid_destroy(&f->pyramid);
}

static image make_noise(uint32_t width, uint32_t height, uint32_t channel_count)
{
    image i = make_image(width, height, channel_count, IMAGE_U8);
    uint32_t random = 5;
    for (size_t k = 0; k < (size_t)width * height * channel_count; k++) {
        lcg_next(&random);
        ((uint8_t *)i.pixels)[k] = (uint8_t)(random >> 24);
    }
    return i;
}

/* A lookup whose pixel is size texels wide and high. */
static void sample_at(const fixture *f, float u, float v, float size, float out[4])
{
    float dx[2] = {size / (float)f->pyramid.width, 0.0f};
    float dy[2] = {0.0f, size / (float)f->pyramid.height};
    texture_sample(&f->set, 0, f->binding.color != NULL, (float[2]){u, v}, dx, dy, out);
}

/* ---- robustness ---- */

static void constants_stay_under_every_lookup(void **state)
{
    (void)state;
    static const float odd[] = {0.0f,  0.37f,  -0.2f,   1.0f,     -1e-9f,    5.5f, -1e7f,
                                1e30f, -1e38f, FLT_MAX, INFINITY, -INFINITY, NAN};
    enum { COUNT = sizeof odd / sizeof *odd };
    image i = make_image(19, 12, 4, IMAGE_U8);
    memset(i.pixels, 77, 19 * 12 * 4);
    fixture f;
    set_up(&f, i, true);
    const float expected[4] = {tables.color[77], tables.color[77], tables.color[77], tables.data[77]};
    for (int sampler = 0; sampler < 3 * 2 * 2 * 3; sampler++) {
        f.binding.wrap_u = (scene_wrap)(sampler % 3);
        f.binding.wrap_v = (scene_wrap)((sampler + 1) % 3);
        f.binding.mag_filter = (scene_filter)(sampler / 3 % 2);
        f.binding.min_filter = (scene_filter)(sampler / 6 % 2);
        f.binding.mip_filter = (scene_mip_filter)(sampler / 12);
        for (int a = 0; a < COUNT * COUNT; a++)
            for (int b = 0; b < COUNT; b++) {
                float uv[2] = {odd[a % COUNT], odd[a / COUNT]};
                float dx[2] = {odd[b], odd[(a + b) % COUNT]};
                float dy[2] = {odd[(b + 3) % COUNT] * 1e-3f, odd[(2 * b + a) % COUNT]};
                float out[4];
                texture_sample(&f.set, 0, true, uv, dx, dy, out);
                for (int k = 0; k < 4; k++)
                    assert_float_equal(out[k], expected[k], 1e-6f);
            }
    }
    tear_down(&f);
}

static void what_is_missing_is_white(void **state)
{
    (void)state;
    fixture f;
    set_up(&f, make_noise(4, 4, 3), true);
    const float zero[2] = {0.0f, 0.0f};
    const float white[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    float out[4];
    texture_sample(&f.set, 0, false, zero, zero, zero, out); /* not available as data */
    assert_memory_equal(out, white, sizeof white);
    texture_sample(&f.set, 7, true, zero, zero, zero, out);
    assert_memory_equal(out, white, sizeof white);
    texture_sample(&f.set, UINT32_MAX, true, zero, zero, zero, out);
    assert_memory_equal(out, white, sizeof white);
    tear_down(&f);
}

/* ---- one level ---- */

/* The texel that OpenGL reads for index i of an axis of n texels (OpenGL 4.6, table 8.20). */
static int wrap_index(int i, int n, scene_wrap wrap)
{
    if (wrap == SCENE_WRAP_CLAMP)
        return i < 0 ? 0 : i >= n ? n - 1 : i;
    if (wrap == SCENE_WRAP_REPEAT)
        return ((i % n) + n) % n;
    int m = ((i % (2 * n)) + 2 * n) % (2 * n);
    return m < n ? m : 2 * n - 1 - m;
}

static double look_up_directly(const uint8_t *texels, int width, int height, double u, double v,
                               scene_wrap wrap_u, scene_wrap wrap_v)
{
    double x = u * width - 0.5;
    double y = v * height - 0.5;
    double sum = 0.0;
    for (int k = 0; k < 4; k++) {
        double fx = x - floor(x);
        double fy = y - floor(y);
        double weight = (k & 1 ? fx : 1.0 - fx) * (k & 2 ? fy : 1.0 - fy);
        int i = wrap_index((int)floor(x) + (k & 1), width, wrap_u);
        int j = wrap_index((int)floor(y) + (k >> 1), height, wrap_v);
        sum += weight * texels[j * width + i] / 255.0;
    }
    return sum;
}

static void borders_wrap_as_in_opengl(void **state)
{
    (void)state;
    enum { WIDTH = 7, HEIGHT = 4 };
    image i = make_noise(WIDTH, HEIGHT, 1);
    uint8_t texels[WIDTH * HEIGHT];
    memcpy(texels, i.pixels, sizeof texels);
    fixture f;
    set_up(&f, i, false);
    for (int wraps = 0; wraps < 9; wraps++) {
        f.binding.wrap_u = (scene_wrap)(wraps % 3);
        f.binding.wrap_v = (scene_wrap)(wraps / 3);
        for (int a = -97; a <= 97; a++)
            for (int b = -41; b <= 41; b += 3) {
                float u = (float)a / 32.0f;
                float v = (float)b / 16.0f;
                float out[4];
                sample_at(&f, u, v, 0.0f, out);
                assert_float_equal((double)out[0],
                                   look_up_directly(texels, WIDTH, HEIGHT, (double)u, (double)v,
                                                    f.binding.wrap_u, f.binding.wrap_v),
                                   1e-5);
            }
    }
    tear_down(&f);
}

static void nearest_is_the_texel_itself(void **state)
{
    (void)state;
    enum { WIDTH = 5, HEIGHT = 3 };
    image i = make_image(WIDTH, HEIGHT, 2, IMAGE_U8);
    for (int t = 0; t < WIDTH * HEIGHT; t++) {
        ((uint8_t *)i.pixels)[2 * t] = (uint8_t)(10 * t);
        ((uint8_t *)i.pixels)[2 * t + 1] = (uint8_t)(255 - t);
    }
    fixture f;
    set_up(&f, i, false);
    f.binding.mag_filter = SCENE_FILTER_NEAREST;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            for (int part = 1; part < 8; part++)
                for (int tile = -2; tile <= 2; tile++) {
                    float out[4];
                    sample_at(&f, ((float)x + (float)part / 8.0f) / WIDTH + (float)tile,
                              ((float)y + 1.0f - (float)part / 8.0f) / HEIGHT, 0.5f, out);
                    assert_true(out[0] == (float)(10 * (y * WIDTH + x)) / 255.0f);
                    assert_true(out[1] == out[0] && out[2] == out[0]);
                    assert_true(out[3] == (float)(255 - y * WIDTH - x) / 255.0f);
                }
    float corner[4]; /* (0, 0) is the top left, (1, 1) the bottom right */
    f.binding.wrap_u = f.binding.wrap_v = SCENE_WRAP_CLAMP;
    sample_at(&f, 0.0f, 0.0f, 0.0f, corner);
    assert_true(corner[0] == 0.0f);
    sample_at(&f, 1.0f, 1.0f, 0.0f, corner);
    assert_true(corner[0] == 140.0f / 255.0f);
    sample_at(&f, 1.0f, 0.0f, 0.0f, corner);
    assert_true(corner[0] == 40.0f / 255.0f);
    tear_down(&f);
}

static void colors_are_decoded_before_they_are_filtered(void **state)
{
    (void)state;
    for (uint32_t channel_count = 1; channel_count <= 4; channel_count++) {
        image i = make_image(2, 1, channel_count, IMAGE_U8);
        memset(i.pixels, 0, channel_count);
        memset((uint8_t *)i.pixels + channel_count, 255, channel_count);
        fixture f;
        set_up(&f, i, true);
        float out[4];
        sample_at(&f, 0.5f, 0.5f, 0.5f, out);
        for (int k = 0; k < 4; k++)
            assert_float_equal(out[k], k == 3 && channel_count % 2 == 1 ? 1.0f : 0.5f, 1e-6f);
        tear_down(&f);
    }
}

static void every_format_gives_its_channels(void **state)
{
    (void)state;
    for (image_type type = IMAGE_U8; type <= IMAGE_U16; type++)
        for (uint32_t channel_count = 1; channel_count <= 4; channel_count++) {
            image i = make_image(1, 1, channel_count, type);
            for (uint32_t k = 0; k < channel_count; k++)
                if (type == IMAGE_U8)
                    ((uint8_t *)i.pixels)[k] = (uint8_t)(51 * (k + 1));
                else
                    ((uint16_t *)i.pixels)[k] = (uint16_t)(13107 * (k + 1));
            fixture f;
            set_up(&f, i, false);
            static const float expected[4][4] = {{0.2f, 0.2f, 0.2f, 1.0f},
                                                 {0.2f, 0.2f, 0.2f, 0.4f},
                                                 {0.2f, 0.4f, 0.6f, 1.0f},
                                                 {0.2f, 0.4f, 0.6f, 0.8f}};
            for (int nearest = 0; nearest < 2; nearest++) {
                f.binding.mag_filter = nearest ? SCENE_FILTER_NEAREST : SCENE_FILTER_LINEAR;
                float out[4];
                sample_at(&f, 0.3f, 0.6f, 0.0f, out);
                for (int k = 0; k < 4; k++)
                    assert_float_equal(out[k], expected[channel_count - 1][k], 1e-6f);
            }
            tear_down(&f);
        }
}

/* ---- levels ---- */

/* A texture whose level n is everywhere n / 16. */
static void set_up_staircase(fixture *f, uint32_t width, uint32_t height)
{
    set_up(f, make_image(width, height, 1, IMAGE_U16), false);
    for (uint32_t level = 0; level < f->pyramid.level_count; level++) {
        texture_level *l = &f->pyramid.levels[level];
        for (size_t k = 0; k < (size_t)l->width * l->height; k++) {
            uint16_t value = (uint16_t)(level * 4096);
            memcpy((unsigned char *)(uintptr_t)l->texels + 2 * k, &value, 2);
        }
    }
}

/* The level that a lookup read, fractional where it read two. */
static float get_lod(const fixture *f, const float dx[2], const float dy[2])
{
    float out[4];
    texture_sample(&f->set, 0, false, (float[2]){0.3f, 0.7f}, dx, dy, out);
    return out[0] * 65535.0f / 4096.0f;
}

static float clamp_lod(float lod, float last)
{
    return fminf(fmaxf(lod, 0.0f), last);
}

static void levels_follow_opengl(void **state)
{
    (void)state;
    fixture f;
    set_up_staircase(&f, 256, 64);
    for (int step = -20; step < 110; step++) {
        float rho =
            exp2f((float)step / 10.0f + 0.003f); /* texels; away from halves, where rounding decides */
        float lod = log2f(rho);
        float dx[2] = {rho / 256.0f, 0.0f};
        float dy[2] = {0.0f, rho / 64.0f};

        f.binding.mip_filter = SCENE_MIP_LINEAR;
        f.binding.min_filter = SCENE_FILTER_LINEAR;
        assert_float_equal(get_lod(&f, dx, dy), clamp_lod(lod, 8.0f), 1e-3f);
        f.binding.min_filter = SCENE_FILTER_NEAREST;
        f.binding.mag_filter = SCENE_FILTER_NEAREST;
        assert_float_equal(get_lod(&f, dx, dy), clamp_lod(lod, 8.0f), 1e-3f);
        f.binding.mag_filter = SCENE_FILTER_LINEAR; /* magnified up to 0.5 */
        assert_float_equal(get_lod(&f, dx, dy), lod <= 0.5f ? 0.0f : clamp_lod(lod, 8.0f), 1e-3f);

        f.binding.mip_filter = SCENE_MIP_NEAREST;
        assert_float_equal(get_lod(&f, dx, dy),
                           lod <= 0.5f ? 0.0f : clamp_lod(ceilf(lod + 0.5f) - 1.0f, 8.0f), 1e-3f);
        f.binding.min_filter = SCENE_FILTER_LINEAR;
        assert_float_equal(get_lod(&f, dx, dy),
                           lod <= 0.5f ? 0.0f : clamp_lod(ceilf(lod + 0.5f) - 1.0f, 8.0f), 1e-3f);

        f.binding.mip_filter = SCENE_MIP_NONE;
        assert_float_equal(get_lod(&f, dx, dy), 0.0f, 1e-3f);
        f.binding.mip_filter = SCENE_MIP_NEAREST; /* the longer derivative decides */
        float half_dy[2] = {0.0f, 0.5f * rho / 64.0f};
        float half_dx[2] = {0.5f * rho / 256.0f, 0.0f};
        float expected = get_lod(&f, dx, dy);
        assert_float_equal(get_lod(&f, dx, half_dy), expected, 1e-3f);
        assert_float_equal(get_lod(&f, half_dx, dy), expected, 1e-3f);
        f.binding.min_filter = SCENE_FILTER_LINEAR;
        f.binding.mag_filter = SCENE_FILTER_LINEAR;
    }
    tear_down(&f);
}

static void trilinear_lods_do_not_turn_with_the_pixel(void **state)
{
    (void)state;
    fixture f;
    set_up_staircase(&f, 512, 512);
    for (int step = 0; step < 32; step++) {
        float angle = (float)step * 0.2f;
        float c = 6.0f / 512.0f * cosf(angle);
        float s = 6.0f / 512.0f * sinf(angle);
        assert_float_equal(get_lod(&f, (float[2]){c, s}, (float[2]){-s, c}), log2f(6.0f), 1e-3f);
        /* Stretched fourfold along that axis: the minor axis decides. */
        assert_float_equal(get_lod(&f, (float[2]){4.0f * c, 4.0f * s}, (float[2]){-s, c}), log2f(6.0f),
                           1e-3f);
        /* Beyond 16 it grows with the major one. */
        assert_float_equal(get_lod(&f, (float[2]){c, s}, (float[2]){-0.01f * s, 0.01f * c}), 0.0f, 1e-3f);
        assert_float_equal(get_lod(&f, (float[2]){32.0f * c, 32.0f * s}, (float[2]){-s, c}), log2f(12.0f),
                           1e-3f);
    }
    tear_down(&f);
}

/* ---- footprints ---- */

/* Stripes of period 8 texels across u, fine noise along v; a pixel of 1 x 12 texels keeps the stripes. */
static void stretched_footprints_keep_what_is_across(void **state)
{
    (void)state;
    enum { SIZE = 128 };
    image i = make_image(SIZE, SIZE, 1, IMAGE_U8);
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++)
            ((uint8_t *)i.pixels)[y * SIZE + x] = x / 4 % 2 ? 255 : 0;
    fixture f;
    set_up(&f, i, false);
    float along[4];
    float across[4];
    const float narrow[2] = {1.0f / SIZE, 0.0f};
    const float high[2] = {0.0f, 12.0f / SIZE};
    for (int stripe = 0; stripe < 8; stripe++) {
        float u = (4.0f * (float)stripe + 2.0f) / SIZE;
        texture_sample(&f.set, 0, false, (float[2]){u, 0.4f}, narrow, high, along);
        assert_float_equal(along[0], (stripe % 2 ? 1.0f : 0.0f), 0.01f);
        /* x and y are interchangeable */
        texture_sample(&f.set, 0, false, (float[2]){u, 0.4f}, high, narrow, along);
        assert_float_equal(along[0], (stripe % 2 ? 1.0f : 0.0f), 0.01f);
        /* Rotated by 90 degrees the stripes average out. */
        texture_sample(&f.set, 0, false, (float[2]){u, 0.4f}, (float[2]){16.0f / SIZE, 0.0f},
                       (float[2]){0.0f, 1.0f / SIZE}, across);
        assert_float_equal(across[0], 0.5f, 0.1f);
    }
    tear_down(&f);
}

/* Smooth noise: level 3 of white noise, magnified. */
static image make_smooth(uint32_t size)
{
    image i = make_image(size, size, 1, IMAGE_U16);
    for (uint32_t y = 0; y < size; y++)
        for (uint32_t x = 0; x < size; x++) {
            float a = (float)x * 6.2831853f / (float)size;
            float b = (float)y * 6.2831853f / (float)size;
            float value = 0.5f + 0.12f * sinf(9.0f * a + 3.0f * b) + 0.12f * cosf(23.0f * b - 5.0f * a) +
                          0.12f * sinf(31.0f * a - 17.0f * b) + 0.12f * sinf(7.0f * a + 29.0f * b + 1.0f);
            ((uint16_t *)i.pixels)[y * size + x] = (uint16_t)(65535.0f * value);
        }
    return i;
}

/* Nothing jumps while a pixel tilts: from 1 to 40 in steps of 1 %. */
static void lookups_are_continuous_in_the_footprint(void **state)
{
    (void)state;
    fixture f;
    set_up(&f, make_smooth(256), false);
    for (int place = 0; place < 50; place++) {
        float uv[2] = {0.137f * (float)place, 0.291f * (float)place};
        float angle = (float)place;
        float before = -1.0f;
        for (float stretch = 1.0f; stretch < 40.0f; stretch *= 1.01f) {
            float length = 2.0f * stretch / 256.0f;
            float out[4];
            texture_sample(&f.set, 0, false, uv, (float[2]){length * cosf(angle), length * sinf(angle)},
                           (float[2]){-2.0f / 256.0f * sinf(angle), 2.0f / 256.0f * cosf(angle)}, out);
            if (before >= 0.0f)
                assert_true(fabsf(out[0] - before) < 0.02f); /* the image ranges over 0.96 */
            before = out[0];
        }
    }
    tear_down(&f);
}

/* The mean over the pixel's parallelogram, from 64 x 64 bilinear lookups. */
static float integrate(const fixture *f, const float uv[2], const float dx[2], const float dy[2])
{
    const float zero[2] = {0.0f, 0.0f};
    double sum = 0.0;
    for (int j = 0; j < 64; j++)
        for (int i = 0; i < 64; i++) {
            float s = ((float)i - 31.5f) / 64.0f;
            float t = ((float)j - 31.5f) / 64.0f;
            float out[4];
            texture_sample(&f->set, 0, false,
                           (float[2]){uv[0] + s * dx[0] + t * dy[0], uv[1] + s * dx[1] + t * dy[1]}, zero,
                           zero, out);
            sum += (double)out[0];
        }
    return (float)(sum / 4096.0);
}

/* Against the true mean over the pixel, stretched and skewed lookups are better than isotropic ones, and
 * accurate. */
static void footprints_are_covered(void **state)
{
    (void)state;
    fixture f;
    set_up(&f, make_smooth(256), false);
    double error_2 = 0.0;
    double isotropic_error_2 = 0.0;
    for (int place = 0; place < 60; place++) {
        float angle = 0.7f * (float)place;
        float stretch = 2.0f + (float)(place % 12);
        float skew = 0.5f * (float)(place % 3);
        float uv[2] = {0.137f * (float)place, 0.291f * (float)place};
        float dx[2] = {stretch / 256.0f * cosf(angle), stretch / 256.0f * sinf(angle)};
        float dy[2] = {-1.0f / 256.0f * sinf(angle) + skew * dx[0],
                       1.0f / 256.0f * cosf(angle) + skew * dx[1]};
        float truth = integrate(&f, uv, dx, dy);
        float out[4];
        texture_sample(&f.set, 0, false, uv, dx, dy, out);
        error_2 += (double)((out[0] - truth) * (out[0] - truth));
        float longest = fmaxf(hypotf(dx[0], dx[1]), hypotf(dy[0], dy[1]));
        texture_sample(&f.set, 0, false, uv, (float[2]){longest, 0.0f}, (float[2]){0.0f, longest}, out);
        isotropic_error_2 += (double)((out[0] - truth) * (out[0] - truth));
    }
    double error = sqrt(error_2 / 60.0);
    double isotropic_error = sqrt(isotropic_error_2 / 60.0);
    print_message("footprint error %.4f, isotropic %.4f\n", error, isotropic_error);
    assert_true(error < 0.02);
    assert_true(error < 0.4 * isotropic_error);
    tear_down(&f);
}

/* ---- groups ---- */

/* A group gives the same bits as its textures one by one, whatever they have in common. */
static void groups_are_lookups_one_by_one(void **state)
{
    (void)state;
    enum { COUNT = TEXTURE_GROUP };
    fixture f[COUNT];
    texture_binding bindings[COUNT];
    for (uint32_t i = 0; i < COUNT; i++) {
        set_up(&f[i], make_noise(i == 5 ? 64 : 128, 32, 1 + (i + 2) % 4), i % 2);
        bindings[i] = f[i].binding;
    }
    bindings[2].wrap_v = SCENE_WRAP_CLAMP;
    bindings[6].mip_filter = SCENE_MIP_NEAREST;
    texture_set set = {.binding_count = COUNT, .bindings = bindings};
    for (int n = 0; n < 2000; n++) {
        float uv[2] = {0.013f * (float)n - 9.0f, 0.7f - 0.029f * (float)n};
        float size = exp2f((float)(n % 50) * 0.2f - 8.0f); /* magnified to minified */
        float dx[2] = {size * cosf((float)n), size * sinf((float)n)};
        float dy[2] = {-0.3f * size * sinf((float)n), 0.1f * size * (float)(n % 7)};
        texture_request requests[COUNT];
        for (uint32_t i = 0; i < COUNT; i++)
            requests[i] = (texture_request){.texture = i == 7 ? 99 : i, .as_color = i % 2};
        texture_sample_group(&set, requests, COUNT, uv, dx, dy);
        for (uint32_t i = 0; i < COUNT; i++) {
            float single[4];
            texture_sample(&set, requests[i].texture, requests[i].as_color, uv, dx, dy, single);
            assert_memory_equal(requests[i].texel, single, sizeof single);
        }
    }
    for (uint32_t i = 0; i < COUNT; i++)
        tear_down(&f[i]);
}

static int prepare(void **state)
{
    (void)state;
    texture_tables_fill(&tables);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(constants_stay_under_every_lookup),
        cmocka_unit_test(what_is_missing_is_white),
        cmocka_unit_test(borders_wrap_as_in_opengl),
        cmocka_unit_test(nearest_is_the_texel_itself),
        cmocka_unit_test(colors_are_decoded_before_they_are_filtered),
        cmocka_unit_test(every_format_gives_its_channels),
        cmocka_unit_test(levels_follow_opengl),
        cmocka_unit_test(trilinear_lods_do_not_turn_with_the_pixel),
        cmocka_unit_test(stretched_footprints_keep_what_is_across),
        cmocka_unit_test(lookups_are_continuous_in_the_footprint),
        cmocka_unit_test(footprints_are_covered),
        cmocka_unit_test(groups_are_lookups_one_by_one),
    };
    return cmocka_run_group_tests(tests, prepare, NULL);
}
