/* rgbm_test.c - radiance as RGBM is accurate to the precision of 8 bits. */
#include "image/image_test.h"

#include <math.h>

#include "image/image.h"
#include "tests/support/support.h"

enum { WIDTH = 256, HEIGHT = 64 };

static image make_texels(uint32_t channel_count)
{
    image i;
    assert_int_equal(image_create(NULL, WIDTH, HEIGHT, channel_count, IMAGE_F32, &i, NULL), FACET_OK);
    uint32_t noise = 1;
    for (size_t k = 0; k < (size_t)WIDTH * HEIGHT * channel_count; k++) {
        lcg_next(&noise);
        ((float *)i.pixels)[k] = exp2f((float)(noise >> 8) / 16777216.0f * 20.0f - 15.0f); /* 2^-15 to 32 */
    }
    return i;
}

static void values_are_near_the_original(void **state)
{
    (void)state;
    for (uint32_t channels = 3; channels <= 4; channels++) {
        static const float ranges[] = {1.0f, 16.0f, 50.3f};
        image in = make_texels(channels);
        for (int r = 0; r < 3; r++) {
            image out;
            const double range = (double)ranges[r];
            assert_int_equal(rgbm_encode(&in, ranges[r], NULL, 2, &out, NULL), FACET_OK);
            for (size_t t = 0; t < (size_t)WIDTH * HEIGHT; t++) {
                const float *from = (const float *)in.pixels + t * channels;
                const uint8_t *code = (const uint8_t *)out.pixels + 4 * t;
                double largest = 0.0;
                for (int c = 0; c < 3; c++) {
                    const double wanted = fmin((double)from[c], range);
                    const double got = code[c] / 255.0 * code[3] / 255.0 * range;
                    largest = fmax(largest, wanted);
                    assert_true(fabs(got - wanted) <= code[3] * range / (2.0 * 255.0 * 255.0) * 1.0001);
                }
                /* the smallest M that holds it */
                assert_true(code[3] * range / 255.0 >= largest * 0.999999);
                assert_true(code[3] == 1 || (code[3] - 1) * range / 255.0 < largest * 1.000001);
            }
            image_destroy(&out);
        }
        image_destroy(&in);
    }
}

static void values_beyond_the_range_are_clamped(void **state)
{
    (void)state;
    static const float texels[5][3] = {{0.0f, 0.0f, 0.0f},
                                       {8.0f, 4.0f, 0.0f},
                                       {INFINITY, NAN, -INFINITY},
                                       {1e-9f, 0.0f, -1.0f},
                                       {9.0f, 8.0f, 2.0f}};
    static const uint8_t wanted[5][4] = {
        {0, 0, 0, 1}, {255, 128, 0, 255}, {255, 0, 0, 255}, {0, 0, 0, 1}, {255, 255, 64, 255}};
    image in, out;
    assert_int_equal(image_create(NULL, 5, 1, 3, IMAGE_F32, &in, NULL), FACET_OK);
    memcpy(in.pixels, texels, sizeof texels);
    assert_int_equal(rgbm_encode(&in, 8.0f, NULL, 1, &out, NULL), FACET_OK);
    assert_memory_equal(out.pixels, wanted, sizeof wanted);
    image_destroy(&in);
    image_destroy(&out);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(values_are_near_the_original),
                                       cmocka_unit_test(values_beyond_the_range_are_clamped)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
