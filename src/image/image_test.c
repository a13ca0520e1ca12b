/* image_test.c - making and converting images, half numbers, the sRGB transfer function. */
#include "image/image_test.h"

#include <math.h>

#include "image/half.h"
#include "image/srgb.h"

/* The value of a half by its definition, in double. */
static double half_value(uint16_t half)
{
    int exponent = half >> 10 & 31;
    double fraction = (half & 1023) / 1024.0;
    double magnitude = exponent ? ldexp(1.0 + fraction, exponent - 15) : ldexp(fraction, -14);
    return half & 0x8000 ? -magnitude : magnitude;
}

static void half_codes_are_exact(void **state)
{
    (void)state;
    for (uint32_t code = 0; code < 65536; code++) {
        float x = half_to_float((uint16_t)code);
        if ((code & 0x7c00) != 0x7c00) {
            assert_true((double)x == half_value((uint16_t)code));
            assert_int_equal(signbit(x) != 0, code >> 15);
            assert_int_equal(half_from_float(x), code);
        } else if (code & 0x3ff) {
            assert_true(isnan(x));
            assert_int_equal(half_from_float(x) & 0x7fff, 0x7e00);
        } else {
            assert_true(isinf(x));
            assert_int_equal(half_from_float(x), code);
        }
    }
}

static void half_rounds_to_nearest_even(void **state)
{
    (void)state;
    for (uint32_t code = 0; code < 0x7bff; code++) {
        double lower = half_value((uint16_t)code);
        double upper = half_value((uint16_t)(code + 1));
        float middle = (float)((lower + upper) / 2.0); /* exact: 12 bits */
        assert_int_equal(half_from_float(middle), code % 2 ? code + 1 : code);
        assert_int_equal(half_from_float(nextafterf(middle, 0.0f)), code);
        assert_int_equal(half_from_float(nextafterf(middle, INFINITY)), code + 1);
        assert_int_equal(half_from_float(-middle), 0x8000 | (code % 2 ? code + 1 : code));
    }
    assert_int_equal(half_from_float(65519.996f), 0x7bff);
    assert_int_equal(half_from_float(65520.0f), 0x7c00);
    assert_int_equal(half_from_float(3e38f), 0x7c00);
    assert_int_equal(half_from_float(-3e38f), 0xfc00);
}

static void srgb_codes_round_trip(void **state)
{
    (void)state;
    srgb_tables tables;
    srgb_tables_prepare(&tables);
    for (int code = 0; code < 256; code++)
        assert_int_equal(srgb_encode_u8(&tables, tables.decoded[code]), code);
    assert_int_equal(srgb_encode_u8(&tables, -1.0f), 0);
    assert_int_equal(srgb_encode_u8(&tables, NAN), 0);
    assert_int_equal(srgb_encode_u8(&tables, INFINITY), 255);
}

/* Against the formula in double, over all magnitudes; where the formula is within 1e-5 of a rounding,
 * either. */
static void srgb_encoding_is_nearest(void **state)
{
    (void)state;
    srgb_tables tables;
    srgb_tables_prepare(&tables);
    for (uint32_t bits = 0x30000000; bits <= 0x3f800000; bits += 1237) {
        float x = float_from_bits(bits);
        double exact = 255.0 * srgb_encode((double)x);
        int code = srgb_encode_u8(&tables, x);
        if (fabs(exact - floor(exact) - 0.5) > 1e-5)
            assert_int_equal(code, (int)floor(exact + 0.5));
        else
            assert_true(fabs(code - exact) < 0.50002);
    }
}

static void create_checks_its_arguments(void **state)
{
    (void)state;
    image i;
    facet_error error;
    assert_int_equal(image_create(NULL, 0, 1, 3, IMAGE_U8, &i, &error), FACET_ERROR_ARGUMENT);
    assert_int_equal(image_create(NULL, 1, 1, 5, IMAGE_U8, &i, &error), FACET_ERROR_ARGUMENT);
    assert_int_equal(image_create(NULL, UINT32_MAX, UINT32_MAX, 4, IMAGE_F32, &i, &error),
                     FACET_ERROR_MEMORY);
    assert_null(i.pixels);
    image_destroy(&i);
    assert_int_equal(image_create(NULL, 3, 2, 4, IMAGE_F32, &i, &error), FACET_OK);
    assert_int_equal(image_texel_size(&i), 16);
    assert_int_equal(image_row_size(&i), 48);
    assert_int_equal(mem_size(i.pixels), 96);
    image_destroy(&i);
    assert_null(i.pixels);
}

static void converted(const image *in, uint32_t channels, image_type type, bool to_srgb, image *out)
{
    assert_int_equal(image_convert(in, NULL, 2, channels, type, to_srgb, out, NULL), FACET_OK);
    assert_int_equal(out->is_srgb, to_srgb);
}

static void eight_bits_survive_float_and_half(void **state)
{
    (void)state;
    image codes;
    assert_int_equal(image_create(NULL, 256, 3, 4, IMAGE_U8, &codes, NULL), FACET_OK);
    codes.is_srgb = true;
    for (uint32_t k = 0; k < 256 * 3 * 4; k++)
        ((uint8_t *)codes.pixels)[k] = (uint8_t)(k / 4);
    for (int linear = 0; linear < 2; linear++) {
        image_type types[] = {IMAGE_F32, IMAGE_F16, IMAGE_U16};
        for (int t = 0; t < 3; t++) {
            image there, back;
            converted(&codes, 4, types[t], !linear, &there);
            converted(&there, 4, IMAGE_U8, true, &back);
            assert_same_texels(&codes, &back);
            image_destroy(&there);
            image_destroy(&back);
        }
    }
    image_destroy(&codes);
}

static void alpha_is_always_linear(void **state)
{
    (void)state;
    uint8_t texel[] = {128, 128, 128, 128};
    image in = {texel, 1, 1, 4, IMAGE_U8, true};
    image out;
    converted(&in, 4, IMAGE_F32, false, &out);
    const float *p = out.pixels;
    assert_float_equal(p[0], 0.21586050f, 1e-7f); /* ((128/255 + 0.055) / 1.055)^2.4 */
    assert_float_equal(p[3], 128.0f / 255.0f, 1e-7f);
    image_destroy(&out);
}

static void channels_are_replicated_and_dropped(void **state)
{
    (void)state;
    uint8_t grey_alpha[] = {10, 20, 30, 40};
    image in = {grey_alpha, 2, 1, 2, IMAGE_U8, true};
    image out;
    converted(&in, 4, IMAGE_U8, true, &out);
    assert_memory_equal(out.pixels, ((uint8_t[]){10, 10, 10, 20, 30, 30, 30, 40}), 8);
    image_destroy(&out);
    converted(&in, 3, IMAGE_U8, true, &out);
    assert_memory_equal(out.pixels, ((uint8_t[]){10, 10, 10, 30, 30, 30}), 6);
    image_destroy(&out);
    converted(&in, 1, IMAGE_U16, true, &out);
    assert_memory_equal(out.pixels, ((uint16_t[]){10 * 257, 30 * 257}), 4);
    image_destroy(&out);
    uint8_t rgb[] = {1, 2, 3, 4, 5, 6};
    in = (image){rgb, 2, 1, 3, IMAGE_U8, true};
    converted(&in, 4, IMAGE_U8, true, &out);
    assert_memory_equal(out.pixels, ((uint8_t[]){1, 2, 3, 255, 4, 5, 6, 255}), 8);
    image_destroy(&out);
    assert_int_equal(image_convert(&in, NULL, 1, 1, IMAGE_U8, true, &out, NULL), FACET_ERROR_ARGUMENT);
    assert_null(out.pixels);
}

/* All types, counts and directions on several threads as on one. */
static void conversion_does_not_depend_on_threads(void **state)
{
    (void)state;
    image in = make_image(701, 203, 3, IMAGE_F32);
    for (int type = IMAGE_U8; type <= IMAGE_F32; type++) {
        image one, four;
        assert_int_equal(image_convert(&in, NULL, 1, 4, (image_type)type, true, &one, NULL), FACET_OK);
        assert_int_equal(image_convert(&in, NULL, 4, 4, (image_type)type, true, &four, NULL), FACET_OK);
        assert_same_texels(&one, &four);
        image_destroy(&one);
        image_destroy(&four);
    }
    image_destroy(&in);
}

static void formats_are_detected_by_content(void **state)
{
    (void)state;
    assert_int_equal(image_codec_detect("\x89PNG\r\n\x1a\n", 8), IMAGE_CODEC_PNG);
    assert_int_equal(image_codec_detect("\x89PNG\r\n\x1a\n", 7), IMAGE_CODEC_UNKNOWN);
    assert_int_equal(image_codec_detect("\xff\xd8\xff\xe0", 4), IMAGE_CODEC_JPEG);
    assert_int_equal(image_codec_detect("RIFFxxxxWEBP", 12), IMAGE_CODEC_WEBP);
    assert_int_equal(image_codec_detect("RIFXxxxxWEBP", 12), IMAGE_CODEC_UNKNOWN);
    assert_int_equal(image_codec_detect("#?RGBE\n", 7), IMAGE_CODEC_HDR);
    assert_int_equal(image_codec_detect("#?RADIANCX\n", 11), IMAGE_CODEC_UNKNOWN);
    assert_int_equal(image_codec_detect("\x76\x2f\x31\x01", 4), IMAGE_CODEC_EXR);
    assert_int_equal(image_codec_detect("PF\n", 3), IMAGE_CODEC_PFM);
    assert_int_equal(image_codec_detect("\xabKTX 20\xbb\r\n\x1a\n", 12), IMAGE_CODEC_KTX2);
    assert_int_equal(image_codec_detect("\0\0\0\x20"
                                        "ftypavif",
                                        12),
                     IMAGE_CODEC_AVIF);
    assert_int_equal(image_codec_detect("\0\0\0\x20"
                                        "ftypmp42",
                                        12),
                     IMAGE_CODEC_UNKNOWN);
    assert_int_equal(image_codec_detect(NULL, 0), IMAGE_CODEC_UNKNOWN);
    image i;
    facet_error error;
    assert_int_equal(image_decode("", 0, "empty", NULL, &i, &error), FACET_ERROR_INVALID);
    assert_int_equal(image_probe("hello", 5, "text", &i, NULL, &error), FACET_ERROR_INVALID);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(half_codes_are_exact),
        cmocka_unit_test(half_rounds_to_nearest_even),
        cmocka_unit_test(srgb_codes_round_trip),
        cmocka_unit_test(srgb_encoding_is_nearest),
        cmocka_unit_test(create_checks_its_arguments),
        cmocka_unit_test(eight_bits_survive_float_and_half),
        cmocka_unit_test(alpha_is_always_linear),
        cmocka_unit_test(channels_are_replicated_and_dropped),
        cmocka_unit_test(conversion_does_not_depend_on_threads),
        cmocka_unit_test(formats_are_detected_by_content),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
