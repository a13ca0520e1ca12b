/* color_test.c - transfer functions and color spaces. */
#include "testing/test_support.h"

static void test_srgb_round_trip(void **state)
{
    (void)state;
    for (int code = 0; code < 256; ++code) { /* all 8-bit and 16-bit codes round trip */
        float linear = linear_from_srgb1((float)code / 255.0f);
        assert_int_equal((int)(srgb_from_linear1(linear) * 255.0f + 0.5f), code);
    }
    for (int code = 0; code < 65536; ++code) {
        float linear = linear_from_srgb1((float)code / 65535.0f);
        assert_int_equal((int)(srgb_from_linear1(linear) * 65535.0f + 0.5f), code);
    }
}

static void test_srgb_values(void **state)
{
    (void)state;
    const double encode[][2] = {
        {0.001, 0.01292}, {0.01, 0.0998528227}, {0.18, 0.4613561295}, {0.5, 0.7353569831}};
    for (size_t i = 0; i < COUNT_OF(encode); ++i)
        expect_relative(srgb_from_linear1((float)encode[i][0]), encode[i][1], 1e-6, "encode %g",
                        encode[i][0]);
    const double decode[][2] = {{1, 0.0003035270},   {10, 0.0030352698},  {64, 0.0512694584},
                                {124, 0.2015562538}, {128, 0.2158605001}, {188, 0.5028864580},
                                {231, 0.7991027380}};
    for (size_t i = 0; i < COUNT_OF(decode); ++i)
        expect_relative(linear_from_srgb1((float)(decode[i][0] / 255.0)), decode[i][1], 2e-6, "decode %g",
                        decode[i][0]);
    assert_true(srgb_from_linear1(0.0f) == 0.0f && linear_from_srgb1(0.0f) == 0.0f);
    expect_near((double)srgb_from_linear1(1.0f), 1.0, 1e-7, "white");
    expect_near((double)linear_from_srgb1(1.0f), 1.0, 1e-7, "white");
    float previous = -1.0f;
    for (int i = 0; i <= 100000; ++i) { /* monotonic through the joint, and no NaN below 0 */
        float v = srgb_from_linear1((float)i * 1e-5f - 0.001f);
        assert_true(v > previous);
        previous = v;
    }
    vec3 c = linear_from_srgb(srgb_from_linear(vec3(0.1f, 0.002f, 0.9f)));
    expect_relative(c[1], 0.002, 1e-6, "three channels");
}

static void test_matrices(void **state)
{
    (void)state;
    test_rng rng = {2};
    for (int i = 0; i < 1000; ++i) {
        vec3 c = rng_color(&rng);
        vec3 xyz = rec709_from_xyz(xyz_from_rec709(c)), wide = rec709_from_rec2020(rec2020_from_rec709(c));
        for (int k = 0; k < 3; ++k) {
            expect_near((double)xyz[k], (double)c[k], 1e-6, "XYZ and back");
            expect_near((double)wide[k], (double)c[k], 1e-6, "Rec.2020 and back");
        }
        expect_near((double)luminance(c), (double)xyz_from_rec709(c)[1], 1e-4, "luminance is Y");
    }
    /* white is D65, and stays white */
    vec3 white = xyz_from_rec709(vec3(1.0f)), white2020 = rec2020_from_rec709(vec3(1.0f));
    expect_relative(white[0], 0.3127 / 0.3290, 1e-6, "X of D65");
    expect_relative(white[1], 1.0, 1e-6, "Y of D65");
    expect_relative(white[2], (1.0 - 0.3127 - 0.3290) / 0.3290, 1e-6, "Z of D65");
    for (int k = 0; k < 3; ++k)
        expect_near((double)white2020[k], 1.0, 1e-6, "white in Rec.2020");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_srgb_round_trip),
                                       cmocka_unit_test(test_srgb_values), cmocka_unit_test(test_matrices)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
