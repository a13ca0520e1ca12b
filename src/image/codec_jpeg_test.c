/* codec_jpeg_test.c - JPEG and WebP: round trips by peak signal-to-noise ratio, reduced sizes, color
 * spaces. */
#include "image/image_test.h"

#include <math.h>

/* dB, of 8-bit images of one size. */
static double psnr(const image *a, const image *b)
{
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_int_equal(a->channel_count, b->channel_count);
    size_t size = image_row_size(a) * a->height;
    double sum = 0.0;
    for (size_t k = 0; k < size; k++) {
        double d = (double)((uint8_t *)a->pixels)[k] - (double)((uint8_t *)b->pixels)[k];
        sum += d * d;
    }
    return sum > 0.0 ? 10.0 * log10(255.0 * 255.0 * (double)size / sum) : 100.0;
}

/* Waves, as photographs have them. */
static image make_waves(uint32_t width, uint32_t height, uint32_t channel_count)
{
    image i = make_image(width, height, channel_count, IMAGE_U8);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            for (uint32_t c = 0; c < channel_count; c++)
                ((uint8_t *)i.pixels)[((size_t)y * width + x) * channel_count + c] =
                    (uint8_t)(128.0 + 60.0 * sin(x * 0.11 + c) + 50.0 * cos(y * 0.07 - c));
    return i;
}

static image through(const image *i, image_codec codec, uint32_t quality, const image_decode_desc *desc)
{
    unsigned char *bytes;
    size_t size;
    facet_error error;
    image back, header;
    image_codec found;
    if (image_encode(i, codec, &(image_encode_desc){.quality = quality}, &bytes, &size, &error) != FACET_OK)
        fail_msg("%s", error.message);
    assert_int_equal(image_probe(bytes, size, "p", &header, &found, &error), FACET_OK);
    assert_int_equal(found, codec);
    assert_int_equal(header.width, i->width);
    assert_int_equal(header.height, i->height);
    assert_int_equal(header.channel_count, i->channel_count);
    if (image_decode(bytes, size, "p", desc, &back, &error) != FACET_OK)
        fail_msg("%s", error.message);
    mem_free(bytes);
    return back;
}

static void jpeg_loses_little(void **state)
{
    (void)state;
    for (uint32_t channels = 1; channels <= 3; channels += 2) {
        image i = make_waves(203, 117, channels);
        image back = through(&i, IMAGE_CODEC_JPEG, 0, NULL);
        assert_true(psnr(&i, &back) > 44.0);
        image_destroy(&back);
        back = through(&i, IMAGE_CODEC_JPEG, 30, NULL);
        assert_true(psnr(&i, &back) > 33.0 && psnr(&i, &back) < 44.0);
        image_destroy(&back);
        image_destroy(&i);
    }
}

/* No chroma subsampling: a column of red beside blue stays. */
static void jpeg_keeps_chroma(void **state)
{
    (void)state;
    image i = make_waves(16, 16, 3);
    for (uint32_t k = 0; k < 256; k++)
        memcpy((uint8_t *)i.pixels + 3 * k, k % 2 ? "\xf0\x10\x10" : "\x10\x10\xf0", 3);
    image back = through(&i, IMAGE_CODEC_JPEG, 95, NULL);
    assert_true(psnr(&i, &back) > 30.0);
    image_destroy(&back);
    image_destroy(&i);
}

/* Sizes are rounded up, and a texel is about the mean of those it stands for. */
static void jpeg_is_reduced(void **state)
{
    (void)state;
    image i = make_waves(203, 117, 3);
    for (uint32_t k = 0; k <= 5; k++) {
        image back = through(&i, IMAGE_CODEC_JPEG, 0, &(image_decode_desc){.max_reduction = k});
        uint32_t r = k < 3 ? k : 3;
        assert_int_equal(back.width, (203 + (1u << r) - 1) >> r);
        assert_int_equal(back.height, (117 + (1u << r) - 1) >> r);
        for (uint32_t y = 0; y < 117u >> r; y += 5)
            for (uint32_t x = 0; x < 203u >> r; x += 5) {
                double mean = 0.0;
                for (uint32_t v = 0; v < 1u << r; v++)
                    for (uint32_t u = 0; u < 1u << r; u++)
                        mean += ((uint8_t *)i.pixels)[3 * (((y << r) + v) * 203 + (x << r) + u)];
                mean /= 1u << (2 * r);
                assert_true(fabs(mean - ((uint8_t *)back.pixels)[3 * (y * back.width + x)]) < 6.0);
            }
        image_destroy(&back);
    }
    image_destroy(&i);
}

static void expect_texel(const image *i, uint32_t y, int r, int g, int b, int tolerance)
{
    const uint8_t *p = (const uint8_t *)i->pixels + y * image_row_size(i);
    if (abs(p[0] - r) > tolerance || abs(p[1] - g) > tolerance || abs(p[2] - b) > tolerance)
        fail_msg("row %u: %d %d %d, %d %d %d was expected", y, p[0], p[1], p[2], r, g, b);
}

static void jpeg_color_spaces(void **state)
{
    (void)state;
    for (uint32_t channels = 3; channels <= 4; channels++) {
        image i = decode_file_as(TEST_DATA "cmyk.jpg", &(image_decode_desc){.channel_count = channels});
        assert_int_equal(i.channel_count, channels);
        expect_texel(&i, 3, 200, 100, 50, 3);
        if (channels == 4)
            assert_int_equal(((uint8_t *)i.pixels)[3], 255);
        image_destroy(&i);
    }
    image i = decode_file(TEST_DATA "progressive.jpg");
    assert_int_equal(i.width, 24);
    expect_texel(&i, 0, 250, 20, 10, 8);
    expect_texel(&i, 15, 10, 40, 240, 8);
    image_destroy(&i);
    i = decode_file(TEST_DATA "grey.jpg");
    assert_int_equal(i.channel_count, 1);
    assert_true(((uint8_t *)i.pixels)[0] < 8 && ((uint8_t *)i.pixels)[255] > 247);
    image_destroy(&i);
    i = decode_file_as(TEST_DATA "grey.jpg", &(image_decode_desc){.channel_count = 4});
    assert_int_equal(i.channel_count, 4);
    expect_texel(&i, 15, 255, 255, 255, 8);
    image_destroy(&i);
}

static void unsuitable_images_and_qualities_are_refused(void **state)
{
    (void)state;
    unsigned char *bytes;
    size_t size;
    image i = make_waves(8, 8, 4);
    assert_int_equal(image_encode(&i, IMAGE_CODEC_JPEG, NULL, &bytes, &size, NULL), FACET_ERROR_ARGUMENT);
    assert_int_equal(
        image_encode(&i, IMAGE_CODEC_WEBP, &(image_encode_desc){.quality = 101}, &bytes, &size, NULL),
        FACET_ERROR_ARGUMENT);
    image_destroy(&i);
}

static bool has_webp(void)
{
    image i = make_waves(8, 8, 3);
    unsigned char *bytes;
    size_t size;
    facet_result result = image_encode(&i, IMAGE_CODEC_WEBP, NULL, &bytes, &size, NULL);
    mem_free(bytes);
    image_destroy(&i);
    if (result == FACET_ERROR_UNSUPPORTED)
        print_message("SKIP: built without libwebp\n");
    return result == FACET_OK;
}

/* Tables alone, which libjpeg takes without a word on the image. */
static void jpeg_without_an_image_is_refused(void **state)
{
    (void)state;
    static const unsigned char files[2][20] = {{0xff, 0xd8, 0xff, 0xd9},
                                               {0xff, 0xd8, 0xff, 0xe0, 0, 4, 'g', 'a', 0xff, 0xd9}};
    for (int i = 0; i < 2; i++) {
        image header = {0};
        facet_error error = {0};
        assert_int_equal(image_probe(files[i], sizeof files[i], "x", &header, NULL, &error),
                         FACET_ERROR_INVALID);
        assert_non_null(strstr(error.message, "x: JPEG: "));
    }
}

/* Stray bytes before a marker, wherever it stands, leave the image as it is: zeros, and FF 00, which
 * libjpeg skips too. */
static void jpeg_skips_stray_bytes(void **state)
{
    (void)state;
    static const unsigned char stray[2][4] = {{0, 0, 0, 0}, {0xff, 0, 0x12, 0}};
    file_bytes file = read_file(TEST_DATA "cmyk.jpg"); /* its colors depend on a marker of the header, too */
    image whole = decode_file(TEST_DATA "cmyk.jpg");
    unsigned char *longer = malloc(file.size + 4);
    size_t marker_count = 0;
    for (size_t at = 2; at + 4 < file.size && file.data[at] == 0xff;
         at += 2 + ((size_t)file.data[at + 2] << 8 | file.data[at + 3])) {
        for (int kind = 0; kind < 2; kind++) {
            memcpy(longer, file.data, at);
            memcpy(longer + at, stray[kind], 4);
            memcpy(longer + at + 4, file.data + at, file.size - at);
            image i, header;
            facet_error error;
            if (image_probe(longer, file.size + 4, "stray", &header, NULL, &error) != FACET_OK ||
                image_decode(longer, file.size + 4, "stray", NULL, &i, &error) != FACET_OK)
                fail_msg("before byte %zu: %s", at, error.message);
            assert_int_equal(header.width, whole.width);
            assert_same_texels(&whole, &i);
            image_destroy(&i);
        }
        marker_count++;
        if (file.data[at + 1] == 0xda)
            break;
    }
    assert_true(marker_count >= 4);
    free(longer);
    image_destroy(&whole);
    file_close(&file);
}

static void webp_is_lossless_at_100(void **state)
{
    (void)state;
    if (!has_webp())
        skip();
    for (uint32_t channels = 3; channels <= 4; channels++) {
        image i = make_image(203, 117, channels, IMAGE_U8);
        if (channels == 4)
            for (uint32_t k = 0; k < 1000; k++)
                ((uint8_t *)i.pixels)[4 * k + 3] = 0; /* color under no opacity is kept */
        image back = through(&i, IMAGE_CODEC_WEBP, 100, NULL);
        assert_same_texels(&i, &back);
        assert_true(back.is_srgb);
        image_destroy(&back);
        image_destroy(&i);
    }
}

static void webp_loses_little(void **state)
{
    (void)state;
    if (!has_webp())
        skip();
    image i = make_waves(203, 117, 3);
    image back = through(&i, IMAGE_CODEC_WEBP, 0, NULL);
    assert_true(psnr(&i, &back) > 30.0); /* chroma is subsampled */
    image_destroy(&back);
    back = through(&i, IMAGE_CODEC_WEBP, 0, &(image_decode_desc){.channel_count = 4, .thread_count = 2});
    assert_int_equal(((uint8_t *)back.pixels)[3], 255);
    image_destroy(&back);
    image_destroy(&i);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(jpeg_loses_little),
        cmocka_unit_test(jpeg_keeps_chroma),
        cmocka_unit_test(jpeg_is_reduced),
        cmocka_unit_test(jpeg_color_spaces),
        cmocka_unit_test(unsuitable_images_and_qualities_are_refused),
        cmocka_unit_test(jpeg_without_an_image_is_refused),
        cmocka_unit_test(jpeg_skips_stray_bytes),
        cmocka_unit_test(webp_is_lossless_at_100),
        cmocka_unit_test(webp_loses_little),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
