/* compare_api_test.c - images from files and pixels, and their comparison, through facet.h alone. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "facet/facet.h"

enum { WIDTH = 24, HEIGHT = 16 };

/* Colors and opacities; premultiplied. */
static facet_image *draw(float brightness, bool is_opaque)
{
    static float pixels[WIDTH * HEIGHT * 4];
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        float opacity = is_opaque ? 1.0f : (float)(i % WIDTH) / (WIDTH - 1);
        for (int k = 0; k < 3; k++)
            pixels[4 * i + k] = brightness * (float)((i * (k + 3)) % 17) / 16.0f * opacity;
        pixels[4 * i + 3] = opacity;
    }
    facet_image *image = NULL;
    const facet_image_view view = {.width = WIDTH, .height = HEIGHT, .channel_count = 4, .pixels = pixels};
    assert_int_equal(facet_image_create(&view, NULL, &image, NULL), FACET_OK);
    return image;
}

/* What goes into a file comes back: rows from the top, premultiplied, linear, as exactly as the format is. */
static void files_come_back(void **state)
{
    (void)state;
    static const struct {
        facet_image_format format;
        bool has_alpha, is_display;
        /* of premultiplied light; for displays that of sRGB codes, in linear light at its steepest */
        double tolerance;
    } formats[] = {
        {FACET_IMAGE_FORMAT_PNG, true, true, 0.6 / 255 * 2.3},
        {FACET_IMAGE_FORMAT_PNG16, true, true, 0.6 / 65535 * 2.3},
        {FACET_IMAGE_FORMAT_EXR, true, false, 0x1p-11},
        {FACET_IMAGE_FORMAT_EXR_FLOAT, true, false, 0.0},
        {FACET_IMAGE_FORMAT_HDR, false, false, 1.0 / 256},
        {FACET_IMAGE_FORMAT_PFM, false, false, 0.0},
    };
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        facet_image *image = draw(1.0f, !formats[i].has_alpha), *back = NULL;
        unsigned char *bytes = NULL;
        size_t size = 0;
        facet_error error = {0};
        facet_result result = facet_image_encode(image, &(facet_image_save_desc){.format = formats[i].format},
                                                 &bytes, &size, &error);
        if (result == FACET_ERROR_UNSUPPORTED) { /* this build lacks the format */
            facet_image_destroy(image);
            continue;
        }
        assert_int_equal(result, FACET_OK);
        if (facet_image_load_memory(bytes, size, "there and back", NULL, &back, &error) != FACET_OK)
            fail_msg("%s", error.message);
        assert_int_equal(facet_image_is_for_display(back), formats[i].is_display);
        facet_comparison c;
        assert_int_equal(facet_compare(image, back,
                                       &(facet_compare_desc){.space = FACET_COMPARE_SPACE_LINEAR}, &c, NULL,
                                       NULL),
                         FACET_OK);
        if (!(c.max_error <= formats[i].tolerance))
            fail_msg("format %d: %g is more than %g", (int)formats[i].format, c.max_error,
                     formats[i].tolerance);
        assert_int_equal(c.channel_count, formats[i].has_alpha ? 4 : 3);
        facet_image_view view = facet_image_get_layer(back, 0);
        assert_true(facet_image_get_layer_count(back) == 1 && view.channel_count == 4 && view.name[0] == 0);
        facet_bytes_destroy(bytes);
        facet_image_destroy(image);
        facet_image_destroy(back);
    }
}

static void not_a_number_survives_files_of_light(void **state)
{
    (void)state;
    const facet_image_format formats[] = {FACET_IMAGE_FORMAT_PFM, FACET_IMAGE_FORMAT_EXR,
                                          FACET_IMAGE_FORMAT_EXR_FLOAT};
    for (int i = 0; i < 3; i++) {
        float pixels[] = {NAN, 1.0f, 2.0f, 0.5f, INFINITY, 0.25f};
        const facet_image_view view = {.width = 2, .height = 1, .channel_count = 3, .pixels = pixels};
        facet_image *image = NULL, *back = NULL;
        unsigned char *bytes = NULL;
        size_t size = 0;
        assert_int_equal(facet_image_create(&view, NULL, &image, NULL), FACET_OK);
        facet_result result =
            facet_image_encode(image, &(facet_image_save_desc){.format = formats[i]}, &bytes, &size, NULL);
        if (result == FACET_OK) {
            assert_int_equal(facet_image_load_memory(bytes, size, "light", NULL, &back, NULL), FACET_OK);
            facet_comparison c;
            assert_int_equal(facet_compare(image, back, NULL, &c, NULL, NULL), FACET_OK);
            assert_true(c.nonfinite_a == 2 && c.nonfinite_b == 2 && c.invalid_count == 0 &&
                        c.max_error == 0.0);
        }
        facet_bytes_destroy(bytes);
        facet_image_destroy(image);
        facet_image_destroy(back);
    }
}

static void pixels_have_rows_and_channels(void **state)
{
    (void)state;
    const float grey[2][4] = {{0.25f, 0.5f, -9.0f, -9.0f}, {0.75f, 1.0f, -9.0f, -9.0f}}; /* padded */
    facet_image *image = NULL;
    facet_error error;
    facet_image_view view = {
        .width = 2, .height = 2, .channel_count = 1, .pixels = grey[0], .row_stride_bytes = sizeof grey[0]};
    assert_int_equal(facet_image_create(&view, NULL, &image, NULL), FACET_OK);
    const float *p = facet_image_get_layer(image, 0).pixels;
    const float wanted[] = {0.25f, 0.25f, 0.25f, 1.0f, 0.5f, 0.5f, 0.5f, 1.0f,
                            0.75f, 0.75f, 0.75f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f};
    assert_memory_equal(p, wanted, sizeof wanted);
    assert_false(facet_image_is_for_display(image));
    facet_image_destroy(image);
    view.channel_count = 2;
    assert_int_equal(facet_image_create(&view, NULL, &image, &error), FACET_ERROR_ARGUMENT);
    assert_null(image);
    view.channel_count = 1;
    view.width = 0;
    assert_int_equal(facet_image_create(&view, NULL, &image, &error), FACET_ERROR_ARGUMENT);
}

/* The difference, saved for a display, holds the numbers. */
static void the_difference_is_an_image(void **state)
{
    (void)state;
    facet_image *a = draw(1.0f, true), *b = draw(0.5f, true), *difference = NULL;
    facet_comparison c;
    facet_error error;
    assert_int_equal(facet_compare(a, b, &(facet_compare_desc){.space = FACET_COMPARE_SPACE_DISPLAY}, &c,
                                   &difference, &error),
                     FACET_OK);
    unsigned char *raw = NULL;
    size_t size = 0;
    assert_int_equal(facet_image_encode(difference,
                                        &(facet_image_save_desc){.format = FACET_IMAGE_FORMAT_RAW}, &raw,
                                        &size, &error),
                     FACET_OK);
    int largest = 0;
    for (size_t i = 0; i < size; i++)
        largest = i % 4 != 3 && raw[i] > largest ? raw[i] : largest;
    assert_int_equal(largest, (int)(c.max_error * 255.0 + 0.5));
    facet_bytes_destroy(raw);
    facet_image_destroy(difference);
    difference = NULL;
    facet_image_destroy(b);
    const float one[3] = {0};
    const facet_image_view view = {.width = 1, .height = 1, .channel_count = 3, .pixels = one};
    assert_int_equal(facet_image_create(&view, NULL, &b, NULL), FACET_OK);
    assert_int_equal(facet_compare(a, b, NULL, &c, &difference, &error), FACET_ERROR_ARGUMENT);
    assert_true(!difference && strstr(error.message, "24 x 16 and 1 x 1"));
    facet_image_destroy(a);
    facet_image_destroy(b);
}

/* A compact image takes part in comparisons as any other, and in nothing else. */
static void compact_images_are_compared_alike(void **state)
{
    (void)state;
    const facet_image_format formats[] = {FACET_IMAGE_FORMAT_PNG, FACET_IMAGE_FORMAT_PNG16,
                                          FACET_IMAGE_FORMAT_PFM};
    for (int i = 0; i < 3; i++) {
        facet_image *drawn = draw(1.0f, i == 2), *other = draw(0.7f, i == 2), *back[2] = {NULL};
        unsigned char *bytes = NULL;
        size_t size = 0;
        facet_error error;
        assert_int_equal(
            facet_image_encode(drawn, &(facet_image_save_desc){.format = formats[i]}, &bytes, &size, NULL),
            FACET_OK);
        for (int k = 0; k < 2; k++)
            assert_int_equal(facet_image_load_memory(bytes, size, "file",
                                                     &(facet_image_load_desc){.is_compact = k == 1}, &back[k],
                                                     NULL),
                             FACET_OK);
        facet_comparison c[2];
        for (int k = 0; k < 2; k++)
            assert_int_equal(facet_compare(other, back[k], NULL, &c[k], NULL, NULL), FACET_OK);
        assert_memory_equal(&c[0].mse, &c[1].mse, sizeof c[0].mse);
        assert_memory_equal(&c[0].ssim, &c[1].ssim, sizeof c[0].ssim);
        assert_memory_equal(&c[0].flip, &c[1].flip, sizeof c[0].flip);
        assert_int_equal(facet_compare(back[0], back[1], NULL, &c[0], NULL, NULL), FACET_OK);
        assert_true(c[0].is_equal);
        const facet_image_view view = facet_image_get_layer(back[1], 0);
        assert_true(!view.pixels && view.width == WIDTH && view.height == HEIGHT);
        facet_bytes_destroy(bytes);
        bytes = NULL;
        assert_int_equal(facet_image_encode(back[1],
                                            &(facet_image_save_desc){.format = FACET_IMAGE_FORMAT_PNG},
                                            &bytes, &size, &error),
                         FACET_ERROR_ARGUMENT);
        assert_null(bytes);
        facet_image_destroy(other);
        assert_int_equal(facet_image_create_sheet((const facet_image *const *)back, 2, NULL, &other, &error),
                         FACET_ERROR_ARGUMENT);
        assert_null(other);
        facet_image_destroy(drawn);
        for (int k = 0; k < 2; k++)
            facet_image_destroy(back[k]);
    }
}

static void bad_files_are_refused(void **state)
{
    (void)state;
    facet_image *image = (facet_image *)1;
    facet_error error;
    assert_int_equal(facet_image_load("no such file.png", NULL, &image, &error), FACET_ERROR_READ);
    assert_true(!image && strstr(error.message, "no such file.png"));
    assert_int_equal(facet_image_load_memory("8BPS\0\1", 6, "a.psd", NULL, &image, &error),
                     FACET_ERROR_INVALID);
    assert_non_null(strstr(error.message, "a.psd: first bytes"));
    static const char large[] = "PF\n20000 3\n-1\n";
    assert_int_equal(facet_image_load_memory(large, sizeof large, "a.pfm", NULL, &image, &error),
                     FACET_ERROR_LIMIT);
    static const char small[] = "PF\n200 3\n-1\n";
    assert_int_equal(facet_image_load_memory(small, sizeof small, "a.pfm",
                                             &(facet_image_load_desc){.max_size = 199}, &image, &error),
                     FACET_ERROR_LIMIT);
    assert_int_equal(facet_image_load_memory(small, sizeof small, "a.pfm", NULL, &image, &error),
                     FACET_ERROR_INVALID);
    assert_null(image);
}

static void memory_that_runs_out_is_a_result(void **state)
{
    (void)state;
    facet_image *a = draw(1.0f, false), *image = NULL, *difference = NULL;
    unsigned char *bytes = NULL;
    size_t size = 0;
    assert_int_equal(facet_image_encode(a, &(facet_image_save_desc){.format = FACET_IMAGE_FORMAT_PNG}, &bytes,
                                        &size, NULL),
                     FACET_OK);
    long calls = 1;
    double complete = 0.0;
    for (long at = -1; at < calls; at++) {
        failing_allocator memory = {.fail_at = at};
        facet_error error = {0};
        facet_comparison c;
        const facet_image_load_desc load = {.allocator = failing_allocator_get(&memory), .thread_count = 1};
        facet_compare_desc compare = {.allocator = load.allocator, .thread_count = 1};
        facet_result result = facet_image_load_memory(bytes, size, "a.png", &load, &image, &error);
        if (result == FACET_OK)
            result = facet_compare(a, image, &compare, &c, &difference, &error);
        if (at < 0) {
            assert_int_equal(result, FACET_OK);
            calls = atomic_load(&memory.calls);
            complete = c.nrmse;
        } else if (result == FACET_OK) { /* PNG is read in rows where its whole does not fit */
            assert_true(c.nrmse == complete);
        } else {
            assert_int_equal(result, FACET_ERROR_MEMORY);
            assert_null(difference);
        }
        facet_image_destroy(image);
        facet_image_destroy(difference);
        image = difference = NULL;
        assert_int_equal(atomic_load(&memory.blocks), 0);
    }
    facet_bytes_destroy(bytes);
    facet_image_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_come_back),
        cmocka_unit_test(not_a_number_survives_files_of_light),
        cmocka_unit_test(pixels_have_rows_and_channels),
        cmocka_unit_test(the_difference_is_an_image),
        cmocka_unit_test(compact_images_are_compared_alike),
        cmocka_unit_test(bad_files_are_refused),
        cmocka_unit_test(memory_that_runs_out_is_a_result),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
