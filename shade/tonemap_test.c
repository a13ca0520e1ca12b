/* tonemap_test.c - operators against test vectors, and the properties of every operator. */
#include "testing/test_support.h"

static const float inputs[7][3] = {{0.18f, 0.18f, 0.18f}, {1.0f, 1.0f, 1.0f},  {2.0f, 1.0f, 0.25f},
                                   {0.9f, 0.2f, 0.05f},   {10.0f, 0.5f, 0.1f}, {0.0f, 1.0f, 0.0f},
                                   {16.0f, 16.0f, 16.0f}};

/* Display-linear values, computed independently in double, before the clamp to 1. */
static const struct {
    int op;
    const char *name;
    double out[7][3];
} vectors[] = {
    {TONEMAP_NEUTRAL,
     "PBR Neutral",
     {{0.14, 0.14, 0.14},
      {0.86909091, 0.86909091, 0.86909091},
      {0.96, 0.53409051, 0.21465839},
      {0.83334539, 0.16269600, 0.01898542},
      {0.99389831, 0.58962128, 0.57259909},
      {0.01555992, 0.88, 0.01555992},
      {0.99626943, 0.99626943, 0.99626943}}},
    {TONEMAP_ACES,
     "ACES (Hill)",
     {{0.10559125, 0.10559125, 0.10559019},
      {0.61911543, 0.61911543, 0.61910924},
      {0.83816927, 0.63008067, 0.27230403},
      {0.62353083, 0.14135431, 0.02778783},
      {1.0, 0.65455003, 0.29820690},
      {0.10161328, 0.62365898, 0.02884372},
      {0.98993531, 0.98993531, 0.98992541}}},
    {TONEMAP_ACES_NARKOWICZ,
     "ACES (Narkowicz)",
     {{0.26689892, 0.26689892, 0.26689892},
      {0.80379747, 0.80379747, 0.80379747},
      {0.91485507, 0.80379747, 0.37411095},
      {0.78054787, 0.29954955, 0.04428307},
      {1.0, 0.61630695, 0.12583968},
      {0.0, 0.80379747, 0.0},
      {1.0, 1.0, 1.0}}},
    {TONEMAP_AGX,
     "AgX",
     {{0.21451909, 0.21451909, 0.21451909},
      {0.59015925, 0.59015925, 0.59015925},
      {0.77229304, 0.58620256, 0.37297179},
      {0.62162259, 0.25843701, 0.13022256},
      {1.09370833, 0.67139727, 0.53094959},
      {0.23494166, 0.58456474, 0.13040261},
      {0.99510801, 0.99510801, 0.99510801}}},
    {TONEMAP_REINHARD,
     "Reinhard",
     {{0.15254237, 0.15254237, 0.15254237},
      {0.5, 0.5, 0.5},
      {0.66666667, 0.5, 0.2},
      {0.47368421, 0.16666667, 0.04761905},
      {0.90909091, 0.33333333, 0.09090909},
      {0.0, 0.5, 0.0},
      {0.94117647, 0.94117647, 0.94117647}}},
    {TONEMAP_REINHARD_EXTENDED,
     "Reinhard extended, white 4",
     {{0.15425847, 0.15425847, 0.15425847},
      {0.53125, 0.53125, 0.53125},
      {0.99367891, 0.49683946, 0.12420986},
      {0.68686009, 0.15263558, 0.03815889},
      {3.31061541, 0.16553077, 0.03310615},
      {0.0, 0.60908349, 0.0},
      {1.88235294, 1.88235294, 1.88235294}}},
    {TONEMAP_HABLE,
     "Hable",
     {{0.12833845, 0.12833845, 0.12833845},
      {0.49291855, 0.49291855, 0.49291855},
      {0.71323801, 0.49291855, 0.17196964},
      {0.46121402, 0.14114366, 0.03792942},
      {1.10886791, 0.30430056, 0.07421470},
      {0.0, 0.49291855, 0.0},
      {1.16962249, 1.16962249, 1.16962249}}},
};

static void test_vectors(void **state)
{
    (void)state;
    for (size_t v = 0; v < COUNT_OF(vectors); ++v)
        for (int i = 0; i < 7; ++i) {
            vec3 out = tonemap(vectors[v].op, vec3(inputs[i][0], inputs[i][1], inputs[i][2]));
            for (int k = 0; k < 3; ++k) {
                double expected = vectors[v].out[i][k] > 1.0 ? 1.0 : vectors[v].out[i][k];
                expect_near((double)out[k], expected, 4e-6, "%s, input %d, channel %d", vectors[v].name, i,
                            k);
            }
        }
}

static void test_promises(void **state)
{
    (void)state;
    test_rng rng = {13};
    for (int op = TONEMAP_NONE; op <= TONEMAP_HABLE; ++op) {
        vec3 black = tonemap(op, vec3(0.0f));
        for (int k = 0; k < 3; ++k)
            expect_near((double)black[k], 0.0, 1e-5, "black, operator %d", op);
        float previous = -1.0f;
        for (float x = 1e-5f; x < 1e6f; x *= 1.02f) { /* gray: monotonic, and it stays gray */
            vec3 out = tonemap(op, vec3(x));
            assert_true(out[0] >= previous - 1e-6f);
            previous = out[0];
            expect_near((double)out[2], (double)out[0], 2e-5, "grey stays grey, operator %d", op);
        }
        assert_true(previous > 0.98f); /* and reaches white */
        const float nasty[] = {INFINITY, 3e38f, 1e20f, -1.0f, -INFINITY, 1e-40f, 0.0f};
        for (int i = 0; i < 200000; ++i) {
            vec3 c = rng_color(&rng) * exp2(30.0f * rng_float(&rng) - 10.0f);
            if (i < 7 * 7 * 7)
                c = vec3(nasty[i % 7], nasty[i / 7 % 7], nasty[i / 49]);
            vec3 out = tonemap(op, c);
            for (int k = 0; k < 3; ++k)
                assert_true(out[k] >= 0.0f && out[k] <= 1.000001f);
        }
    }
}

/* PBR Neutral preserves base colors: below 0.8 only the toe changes them, hue included. */
static void test_neutral_keeps_base_colors(void **state)
{
    (void)state;
    test_rng rng = {19};
    for (int i = 0; i < 10000; ++i) {
        vec3 c = rng_color(&rng) * 0.72f + 0.08f;
        vec3 out = tonemap_pbr_neutral(c);
        if (max3(c) < 0.8f)
            for (int k = 0; k < 3; ++k)
                expect_near((double)out[k], (double)c[k] - 0.04, 1e-6, "channel %d", k);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_vectors), cmocka_unit_test(test_promises),
                                       cmocka_unit_test(test_neutral_keeps_base_colors)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
