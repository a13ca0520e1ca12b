/* dispersion_test.c - refractive index by wavelength. */
#include "testing/test_support.h"

/* Section 5.9 of the reference: ior 1.5, dispersion 1, at the lines F, d, C. */
static void test_golden_numbers(void **state)
{
    (void)state;
    expect_near((double)dispersed_ior_at(1.5f, 1.0f, 486.13f), 1.51748, 1e-5, "F");
    expect_near((double)dispersed_ior_at(1.5f, 1.0f, 587.56f), 1.50000, 1e-5, "d");
    expect_near((double)dispersed_ior_at(1.5f, 1.0f, 656.27f), 1.49248, 1e-5, "C");
    expect_near((double)dispersed_ior(1.5f, 1.0f, 0), 1.4875, 1e-6, "red");
    assert_true(dispersed_ior(1.5f, 1.0f, 1) == 1.5f);
    expect_near((double)dispersed_ior(1.5f, 1.0f, 2), 1.5125, 1e-6, "blue");
}

/* The definition of Abbe's number: V = (n_d - 1) / (n_F - n_C) = 20 / dispersion. */
static void test_abbe_number(void **state)
{
    (void)state;
    for (int i = 1; i <= 10; ++i) {
        float dispersion = 0.2f * (float)i, ior = 1.2f + 0.1f * (float)i;
        double spread = (double)dispersed_ior_at(ior, dispersion, 486.13f) -
                        (double)dispersed_ior_at(ior, dispersion, 656.27f);
        expect_relative((double)(ior - 1.0f) / spread, 20.0 / (double)dispersion, 2e-3, "Abbe number");
    }
}

static void test_limits(void **state)
{
    (void)state;
    for (int c = 0; c < 3; ++c) {
        assert_true(dispersed_ior(1.7f, 0.0f, c) == 1.7f); /* no dispersion */
        assert_true(dispersed_ior(0.0f, 1.0f, c) == 0.0f); /* infinite ior: no effect */
        assert_true(dispersed_ior(1.0f, 5.0f, c) == 1.0f);
        assert_true(dispersed_ior(1.01f, 200.0f, c) >= 1.0f); /* never below air */
    }
    assert_true(dispersed_ior_at(1.7f, 0.0f, 400.0f) == 1.7f && dispersed_ior_at(0.0f, 1.0f, 400.0f) == 0.0f);
    assert_true(dispersed_ior_at(1.05f, 100.0f, 780.0f) == 1.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_golden_numbers),
                                       cmocka_unit_test(test_abbe_number), cmocka_unit_test(test_limits)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
