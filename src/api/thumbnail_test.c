/* thumbnail_test.c - thumbnails of images: sizes, means, exposure. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "facet/facet.h"

static facet_image *make(uint32_t width, uint32_t height, float even, float odd)
{
    float *pixels = malloc((size_t)width * height * 3 * sizeof *pixels);
    for (uint32_t i = 0; i < width * height * 3; i++)
        pixels[i] = (i / 3 % width) % 2 ? odd : even;
    const facet_image_view view = {.width = width, .height = height, .channel_count = 3, .pixels = pixels};
    facet_image *image = NULL;
    facet_error error;
    assert_int_equal(facet_image_create(&view, NULL, &image, &error), FACET_OK);
    free(pixels);
    return image;
}

static facet_image_view reduce(const facet_image *image, const facet_thumbnail_desc *desc, facet_image **made)
{
    facet_error error;
    assert_int_equal(facet_image_create_thumbnail(image, desc, made, &error), FACET_OK);
    return facet_image_get_layer(*made, 0);
}

static void the_longer_edge_is_the_size(void **state)
{
    (void)state;
    static const uint32_t sizes[][4] = {
        {200, 100, 50, 25}, {100, 300, 17, 50}, {1000, 3, 50, 1}, {20, 10, 20, 10}, {1, 1, 1, 1}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        facet_image *image = make(sizes[i][0], sizes[i][1], 1.0f, 1.0f), *made;
        facet_image_view view = reduce(image, &(facet_thumbnail_desc){.size = 50}, &made);
        assert_int_equal(view.width, sizes[i][2]);
        assert_int_equal(view.height, sizes[i][3]);
        facet_image_destroy(made);
        facet_image_destroy(image);
    }
}

/* Exposure is the middle grey of the meter, whatever the unit of the light; pixels are means, not samples. */
static void light_is_averaged_and_exposed(void **state)
{
    (void)state;
    for (float unit = 1e-3f; unit < 1e5f; unit *= 1e2f) {
        facet_image *image = make(64, 64, 0.0f, 2.0f * unit), *made;
        facet_image_view view = reduce(image, &(facet_thumbnail_desc){.size = 32}, &made);
        for (uint32_t i = 0; i < 32 * 32; i++)
            assert_float_equal(view.pixels[4 * i], 0.22f, 1e-4f);
        facet_image_destroy(made);
        made = NULL;
        view = reduce(image, &(facet_thumbnail_desc){.size = 32, .exposure_ev = 1.0f}, &made);
        assert_float_equal(view.pixels[0], 0.44f, 1e-4f);
        facet_image_destroy(made);
        facet_image_destroy(image);
    }
}

/* An object on black is exposed for the object. */
static void blacks_do_not_count(void **state)
{
    (void)state;
    float pixels[100 * 3] = {0};
    for (int i = 0; i < 5 * 3; i++)
        pixels[i] = 3.0f;
    const facet_image_view view = {.width = 10, .height = 10, .channel_count = 3, .pixels = pixels};
    facet_image *image = NULL, *made;
    facet_error error;
    assert_int_equal(facet_image_create(&view, NULL, &image, &error), FACET_OK);
    facet_image_view small = reduce(image, &(facet_thumbnail_desc){.size = 10}, &made);
    assert_float_equal(small.pixels[0], 0.22f, 1e-4f);
    assert_float_equal(small.pixels[4 * 99], 0.0f, 0.0f);
    facet_image_destroy(made);
    facet_image_destroy(image);
}

/* Values of broken renderings do not spread. */
static void nonfinite_values_are_bounded(void **state)
{
    (void)state;
    float pixels[4 * 3];
    for (int i = 0; i < 4 * 3; i++)
        pixels[i] = i < 3 ? NAN : i < 6 ? INFINITY : 1.0f;
    const facet_image_view view = {.width = 2, .height = 2, .channel_count = 3, .pixels = pixels};
    facet_image *image = NULL, *made;
    facet_error error;
    assert_int_equal(facet_image_create(&view, NULL, &image, &error), FACET_OK);
    facet_image_view small = reduce(image, NULL, &made);
    for (int i = 0; i < 4 * 4; i++)
        assert_true(small.pixels[i] >= 0.0f && small.pixels[i] <= 1.0f);
    facet_image_destroy(made);
    facet_image_destroy(image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_longer_edge_is_the_size), cmocka_unit_test(light_is_averaged_and_exposed),
        cmocka_unit_test(blacks_do_not_count), cmocka_unit_test(nonfinite_values_are_bounded)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
