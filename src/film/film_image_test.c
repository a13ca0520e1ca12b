/* Tests of film_image.h: codes against the transfer function in double, alpha, threads. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "film/film_image.h"
#include "tests/support/support.h"

/* A film of one row: pixel i is (value, value, 1 - value) * opacity with value = i / (count - 1). */
static film make_ramp(uint32_t count, float opacity)
{
    film f;
    assert_int_equal(film_create(NULL, count, 1, 0, &f, NULL), FACET_OK);
    for (uint32_t i = 0; i < count; i++) {
        float value = (float)i / (float)(count - 1);
        float *pixel = f.layers[0].pixels + 4 * (size_t)i;
        pixel[0] = pixel[1] = value * opacity;
        pixel[2] = (1.0f - value) * opacity;
        pixel[3] = opacity;
    }
    return f;
}

static void codes_are_rounded_exactly(void **state)
{
    (void)state;
    enum { COUNT = 4096 };
    film f = make_ramp(COUNT, 1.0f);
    image narrow;
    image wide;
    assert_int_equal(film_to_display_image(&f, IMAGE_U8, true, NULL, 1, &narrow, NULL), FACET_OK);
    assert_int_equal(film_to_display_image(&f, IMAGE_U16, true, NULL, 1, &wide, NULL), FACET_OK);
    assert_int_equal(narrow.channel_count, 3); /* every pixel is opaque */
    assert_true(narrow.is_srgb && wide.is_srgb);
    for (size_t i = 0; i < COUNT; i++)
        for (size_t k = 0; k < 3; k++) {
            double value = (double)f.layers[0].pixels[4 * i + k];
            assert_int_equal(((uint8_t *)narrow.pixels)[3 * i + k], lround(255.0 * srgb_encode(value)));
            assert_int_equal(((uint16_t *)wide.pixels)[3 * i + k], lround(65535.0 * srgb_encode(value)));
        }
    image_destroy(&narrow);
    image_destroy(&wide);
    film_destroy(&f);
}

static void alpha_is_straight_in_files(void **state)
{
    (void)state;
    enum { COUNT = 1024 };
    for (float opacity = 0.25f; opacity < 1.0f; opacity += 0.25f) { /* exact to divide by */
        film f = make_ramp(COUNT, opacity);
        image narrow;
        image wide;
        assert_int_equal(film_to_display_image(&f, IMAGE_U8, true, NULL, 1, &narrow, NULL), FACET_OK);
        assert_int_equal(film_to_display_image(&f, IMAGE_U16, true, NULL, 1, &wide, NULL), FACET_OK);
        assert_int_equal(narrow.channel_count, 4);
        for (size_t i = 0; i < COUNT; i++) {
            const float *pixel = f.layers[0].pixels + 4 * i;
            const uint8_t *texel = (uint8_t *)narrow.pixels + 4 * i;
            const uint16_t *texel_16 = (uint16_t *)wide.pixels + 4 * i;
            for (size_t k = 0; k < 3; k++) {
                double exact = srgb_encode((double)pixel[k] / (double)opacity);
                assert_true(fabs(texel[k] - 255.0 * exact) <= 0.5 + 1e-4);
                assert_true(fabs(texel_16[k] - 65535.0 * exact) <= 0.5 + 1e-2); /* the quotient is a float */
            }
            assert_int_equal(texel[3], lroundf(255.0f * opacity));
            assert_int_equal(texel_16[3], lroundf(65535.0f * opacity));
        }
        image_destroy(&narrow);
        image_destroy(&wide);
        film_destroy(&f);
    }
}

/* A single transparent pixel makes the image RGBA; fully transparent pixels have no color. */
static void alpha_is_kept_where_a_pixel_is_transparent(void **state)
{
    (void)state;
    film f = make_ramp(5000, 1.0f);
    memcpy(f.layers[0].pixels + 4 * 4321, (float[4]){0.5f, 0.5f, 0.5f, 0.0f}, 4 * sizeof(float));
    image i;
    assert_int_equal(film_to_display_image(&f, IMAGE_U8, true, NULL, 2, &i, NULL), FACET_OK);
    assert_int_equal(i.channel_count, 4);
    assert_memory_equal((uint8_t *)i.pixels + 4 * 4321, ((uint8_t[4]){0, 0, 0, 0}), 4);
    assert_int_equal(((uint8_t *)i.pixels)[4 * 4320 + 3], 255);
    image_destroy(&i);
    film_destroy(&f);
}

static void without_alpha_white_is_behind(void **state)
{
    (void)state;
    film f = make_ramp(256, 0.5f);
    image i;
    assert_int_equal(film_to_display_image(&f, IMAGE_U8, false, NULL, 1, &i, NULL), FACET_OK);
    assert_int_equal(i.channel_count, 3);
    for (size_t p = 0; p < 256; p++)
        for (size_t k = 0; k < 3; k++)
            assert_int_equal(((uint8_t *)i.pixels)[3 * p + k],
                             lround(255.0 * srgb_encode((double)(f.layers[0].pixels[4 * p + k] + 0.5f))));
    image_destroy(&i);
    assert_int_equal(film_to_linear_image(&f, NULL, 1, &i, NULL), FACET_OK);
    assert_true(i.type == IMAGE_F32 && i.channel_count == 3 && !i.is_srgb);
    for (size_t p = 0; p < 256; p++)
        assert_memory_equal((float *)i.pixels + 3 * p, f.layers[0].pixels + 4 * p, 3 * sizeof(float));
    image_destroy(&i);
    film_destroy(&f);
}

static void values_out_of_range_are_clamped(void **state)
{
    (void)state;
    const float odd[] = {NAN, -INFINITY, -1.0f, INFINITY, 2.0f};
    const uint8_t codes[] = {0, 0, 0, 255, 255};
    film f;
    assert_int_equal(film_create(NULL, 5, 2, 0, &f, NULL), FACET_OK);
    for (size_t p = 0; p < 10; p++)
        for (size_t k = 0; k < 4; k++)
            f.layers[0].pixels[4 * p + k] = k == 3 ? (p < 5 ? 1.0f : odd[p - 5]) : odd[p % 5];
    for (int has_alpha = 0; has_alpha < 2; has_alpha++) {
        image i;
        assert_int_equal(film_to_display_image(&f, IMAGE_U16, has_alpha, NULL, 1, &i, NULL), FACET_OK);
        for (size_t p = 0; p < 5; p++)
            for (size_t k = 0; k < 3; k++)
                assert_int_equal(((uint16_t *)i.pixels)[i.channel_count * p + k], 257 * codes[p]);
        image_destroy(&i);
        assert_int_equal(film_to_display_image(&f, IMAGE_U8, has_alpha, NULL, 1, &i, NULL), FACET_OK);
        for (size_t p = 0; p < 5; p++)
            for (size_t k = 0; k < 3; k++)
                assert_int_equal(((uint8_t *)i.pixels)[i.channel_count * p + k], codes[p]);
        image_destroy(&i);
    }
    film_destroy(&f);
}

static void results_do_not_depend_on_threads(void **state)
{
    (void)state;
    film f;
    assert_int_equal(film_create(NULL, 301, 257, 0, &f, NULL), FACET_OK);
    uint32_t random = 7;
    for (size_t i = 0; i < 4 * 301 * 257; i++) {
        lcg_next(&random);
        f.layers[0].pixels[i] = (float)(random >> 8) * 0x1p-24f;
    }
    for (image_type type = IMAGE_U8; type <= IMAGE_U16; type++) {
        image one;
        image many;
        assert_int_equal(film_to_display_image(&f, type, true, NULL, 1, &one, NULL), FACET_OK);
        assert_int_equal(film_to_display_image(&f, type, true, NULL, 6, &many, NULL), FACET_OK);
        assert_memory_equal(one.pixels, many.pixels, image_row_size(&one) * one.height);
        image_destroy(&one);
        image_destroy(&many);
    }
    film_destroy(&f);
}

static void *refuse(void *user, size_t size)
{
    (void)user;
    (void)size;
    return NULL;
}
static void release(void *user, void *memory, size_t size)
{
    (void)user;
    (void)size;
    free(memory);
}

static void running_out_of_memory_is_an_error(void **state)
{
    (void)state;
    film f = make_ramp(64, 0.5f);
    facet_allocator none = {.allocate = refuse, .release = release};
    facet_error error;
    image i;
    assert_int_equal(film_to_display_image(&f, IMAGE_U8, true, &none, 1, &i, &error), FACET_ERROR_MEMORY);
    assert_null(i.pixels);
    assert_int_equal(film_to_linear_image(&f, &none, 1, &i, &error), FACET_ERROR_MEMORY);
    assert_null(i.pixels);
    film_destroy(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(codes_are_rounded_exactly),
        cmocka_unit_test(alpha_is_straight_in_files),
        cmocka_unit_test(alpha_is_kept_where_a_pixel_is_transparent),
        cmocka_unit_test(without_alpha_white_is_behind),
        cmocka_unit_test(values_out_of_range_are_clamped),
        cmocka_unit_test(results_do_not_depend_on_threads),
        cmocka_unit_test(running_out_of_memory_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
