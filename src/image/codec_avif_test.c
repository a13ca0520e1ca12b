/* codec_avif_test.c - AVIF pictures whose texels are known. */
#include "image/image_test.h"

static void eight_bits_with_alpha(void **state)
{
    (void)state;
    image i = decode_file(TEST_DATA "rgba_lossless.avif");
    assert_int_equal(i.width, 24);
    assert_int_equal(i.height, 17);
    assert_int_equal(i.channel_count, 4);
    assert_int_equal(i.type, IMAGE_U8);
    assert_true(i.is_srgb);
    const uint8_t *texel = i.pixels;
    for (uint32_t y = 0; y < 17; y++)
        for (uint32_t x = 0; x < 24; x++, texel += 4) {
            assert_int_equal(texel[0], 10 * x);
            assert_int_equal(texel[1], 15 * y);
            assert_int_equal(texel[2], 255 - 5 * x - 7 * y);
            assert_int_equal(texel[3], 128 + 5 * x);
        }
    image_destroy(&i);
    i = decode_file_as(TEST_DATA "rgba_lossless.avif",
                       &(image_decode_desc){.channel_count = 3, .thread_count = 2});
    assert_int_equal(i.channel_count, 3);
    assert_int_equal(((const uint8_t *)i.pixels)[3 * 25 + 1], 15);
    image_destroy(&i);
}

static void ten_bits_become_sixteen(void **state)
{
    (void)state;
    image i = decode_file(TEST_DATA "rgb10_lossless.avif");
    assert_int_equal(i.channel_count, 3);
    assert_int_equal(i.type, IMAGE_U16);
    const uint16_t *texel = i.pixels;
    for (uint32_t y = 0; y < 17; y++)
        for (uint32_t x = 0; x < 24; x++, texel += 3) {
            const double codes[3] = {40.0 * x, 60.0 * y, 1023.0 - 20 * x - 30 * y};
            for (int c = 0; c < 3; c++)
                assert_true(abs((int)texel[c] - (int)(codes[c] * 65535 / 1023 + 0.5)) <= 1);
        }
    image_destroy(&i);
}

static void sizes_are_limited(void **state)
{
    (void)state;
    file_bytes file = read_file(TEST_DATA "rgba_lossless.avif");
    image i;
    facet_error error;
    assert_int_equal(
        image_decode(file.data, file.size, "a", &(image_decode_desc){.max_size = 23}, &i, &error),
        FACET_ERROR_LIMIT);
    assert_null(i.pixels);
    assert_int_equal(image_decode(file.data, 40, "a", NULL, &i, &error), FACET_ERROR_INVALID);
    assert_non_null(strstr(error.message, "a: AVIF: "));
    file_close(&file);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(eight_bits_with_alpha),
        cmocka_unit_test(ten_bits_become_sixteen),
        cmocka_unit_test(sizes_are_limited),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
