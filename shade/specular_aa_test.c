/* specular_aa_test.c - highlights smaller than a pixel. */
#include "testing/test_support.h"

/* sqrt(alpha^2 + kernel) by hand, the kernel below and at its bound. */
static void test_golden_numbers(void **state)
{
    (void)state;
    vec3 dx = vec3(0.1f, 0.0f, 0.0f), dy = vec3(0.0f, 0.1f, 0.0f); /* squares add to 0.02 */
    expect_near((double)alpha_specular_aa(0.1f, dx, dy), 0.1414213562, 1e-7, "added to alpha squared");
    dx = vec3(0.6f, 0.0f, 0.0f); /* 0.4 with dy */
    dy = vec3(0.0f, 0.0f, 0.2f);
    expect_near((double)alpha_specular_aa(0.1f, dx, dy), 0.4358898944, 1e-6, "bounded kernel");
}

static void test_limits(void **state)
{
    (void)state;
    vec3 none = vec3(0.0f);
    for (int i = 0; i <= 10; ++i)
        expect_near((double)alpha_specular_aa(0.1f * (float)i, none, none), 0.1 * i, 1e-6, "flat: unchanged");
    assert_true(alpha_specular_aa(1.0f, vec3(9.0f), none) == 1.0f);
    float before = 0.0f;
    for (int i = 0; i < 100; ++i) { /* more curvature never sharpens */
        float a = alpha_specular_aa(0.05f, vec3(0.01f * (float)i, 0.0f, 0.0f), none);
        assert_true(a >= before);
        before = a;
    }
}

/* Its purpose: a row of mirrors whose normals vary over a pixel reflects, on average, like one surface of the
 * wider alpha: slopes of variance s^2 added to a GGX of alpha^2 / 2 per axis. */
static void test_variance_is_that_of_the_normals(void **state)
{
    (void)state;
    /* normals over a pixel of Gaussian footprint 1/2: N(x) = z + x dN/dx, slope variance |dN/dx|^2 / 4 per
     * axis */
    double sum = 0.0, weight = 0.0;
    float slope = 0.2f;
    for (int i = -400; i <= 400; ++i) {
        double x = i / 100.0, w = exp(-0.5 * x * x / 0.25);
        sum += w * (x * (double)slope) * (x * (double)slope);
        weight += w;
    }
    double alpha2 =
        2.0 * sum / weight; /* GGX's alpha^2 stands for twice the variance of one axis (Beckmann's) */
    float a = alpha_specular_aa(0.0f, vec3(slope, 0.0f, 0.0f), vec3(0.0f));
    expect_relative(a * a, alpha2, 1e-4, "alpha squared");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_golden_numbers), cmocka_unit_test(test_limits),
                                       cmocka_unit_test(test_variance_is_that_of_the_normals)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
