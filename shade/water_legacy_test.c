/* water_legacy_test.c - the legacy shading style: values of its formulas, computed independently in double. */
#include "testing/test_support.h"

/* A power of 256 amplifies the rounding of a cosine near 1 to 2e-5. */
static void expect_color(vec3 c, double r, double g, double b, const char *what)
{
    expect_near((double)c[0], r, 1e-5 * (1.0 + r), "%s, red", what);
    expect_near((double)c[1], g, 1e-5 * (1.0 + g), "%s, green", what);
    expect_near((double)c[2], b, 1e-5 * (1.0 + b), "%s, blue", what);
}

static vec3 plain(int variant, vec3 d, vec3 N, float y)
{
    return water_legacy_shade(variant, WATER_LEGACY_STAGE_NONE, d, N, WATER_LEGACY_SUN_DIRECTION, y, 0.0f,
                              0.0f, 1.33f, 0.1f);
}

static void test_vectors(void **state)
{
    (void)state;
    vec3 up = vec3(0.0f, 1.0f, 0.0f), N = normalize(vec3(-0.2f, 1.0f, 0.1f)), L = WATER_LEGACY_SUN_DIRECTION;
    vec3 down = vec3(0.0f, -1.0f, 0.0f), steep = normalize(vec3(0.0f, -0.6f, -1.0f)),
         low = normalize(vec3(0.0f, -0.1f, -1.0f));
    vec3 mirror = vec3(L[0], -L[1], L[2]); /* the eye sees the sun */
    expect_color(plain(WATER_LEGACY_WRITTEN, down, up, 0.0f), 0.41119, 0.46016, 0.57413, "A, down");
    expect_color(plain(WATER_LEGACY_INTENDED, down, up, 0.0f), 0.11119, 0.36016, 0.47413, "B, down");
    expect_color(plain(WATER_LEGACY_WRITTEN, steep, up, 0.0f), 0.33916, 0.40216, 0.53016, "A, steep");
    expect_color(plain(WATER_LEGACY_INTENDED, steep, up, 0.0f), 0.10284, 0.34932, 0.46620, "B, steep");
    expect_color(plain(WATER_LEGACY_WRITTEN, low, up, 0.0f), 0.28729, 0.36066, 0.49903, "A, low");
    expect_color(plain(WATER_LEGACY_INTENDED, low, up, 0.0f), 0.19611, 0.34482, 0.47695, "B, low");
    expect_color(plain(WATER_LEGACY_WRITTEN, mirror, up, 0.0f), 2.16324, 1.92142, 1.74460, "A, the sun");
    expect_color(plain(WATER_LEGACY_INTENDED, mirror, up, 0.0f), 1.90004, 1.85056, 1.66651, "B, the sun");
    expect_color(plain(WATER_LEGACY_WRITTEN, steep, N, 1.0f), 0.34313, 0.40499, 0.53185, "A, steep, a wave");
    expect_color(plain(WATER_LEGACY_INTENDED, steep, N, 1.0f), 0.09070, 0.29195, 0.41002, "B, steep, a wave");
    expect_color(plain(WATER_LEGACY_WRITTEN, low, N, 1.0f), 0.29947, 0.37006, 0.50565, "A, low, a wave");
    expect_color(plain(WATER_LEGACY_INTENDED, low, N, 1.0f), 0.13710, 0.29959, 0.42804, "B, low, a wave");
    expect_color(water_legacy_shade(WATER_LEGACY_INTENDED, 0, mirror, up, L, 0.0f, 1.0f, 0.0f, 1.33f, 0.1f),
                 3.40004, 3.25056, 2.96651, "B, the sun, a sparkle");
    expect_color(water_legacy_shade(WATER_LEGACY_INTENDED, 0, down, up, L, 0.0f, 0.0f, 1.0f, 1.33f, 0.1f),
                 0.73336, 0.80805, 0.84224, "B, foam");
}

/* Intermediate stages: the Fresnel term is 0.02 facing and 1 at the horizon; the Cook-Torrance highlight
 * conserves energy and is brighter and narrower. As originally written, only the sky was visible. */
static void test_stages(void **state)
{
    (void)state;
    vec3 up = vec3(0.0f, 1.0f, 0.0f), down = vec3(0.0f, -1.0f, 0.0f), L = WATER_LEGACY_SUN_DIRECTION;
    vec3 before = plain(WATER_LEGACY_INTENDED, down, up, 0.0f);
    vec3 after = water_legacy_shade(WATER_LEGACY_WRITTEN, WATER_LEGACY_STAGE_FRESNEL, down, up, L, 0.0f, 0.0f,
                                    0.0f, 1.33f, 0.1f);
    vec3 difference = (water_legacy_sky(up) - vec3(0.0f, 0.5f, 0.7f)) * (0.5f * F0_from_ior(1.33f));
    for (int k = 0; k < 3; ++k)
        expect_near((double)(after[k] - before[k]), (double)difference[k], 1e-6, "stage 1, facing");
    vec3 V = vec3(-L[0], L[1], -L[2]);
    vec3 wide = water_legacy_highlight(WATER_LEGACY_STAGE_COOK_TORRANCE, up, V, L, 1.33f, 0.4f);
    float alpha = 0.16f, NdotL = L[1];
    float expected = F_Schlick1(F0_from_ior(1.33f), 1.0f, NdotL) * V_SmithGGX(NdotL, NdotL, alpha) * NdotL /
                     (PI * alpha * alpha);
    expect_relative(wide[1], expected, 1e-4, "stage 2, the sun's mirror");
    vec3 narrow = water_legacy_highlight(WATER_LEGACY_STAGE_COOK_TORRANCE, up, V, L, 1.33f, 0.1f);
    assert_true(narrow[1] > 100.0f * wide[1]);
    expect_near((double)water_legacy_foam(0.5f), 0.0, 0.0, "foam begins");
    expect_near((double)water_legacy_foam(0.75f), 0.5, 1e-6, "foam");
    expect_near((double)water_legacy_display(vec3(0.5f))[1], pow(0.5, 0.95), 1e-6, "the display's power");
    assert_true(water_legacy_display(vec3(-1.0f))[0] == 0.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_vectors), cmocka_unit_test(test_stages)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
