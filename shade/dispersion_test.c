/* dispersion_test.c - refractive index by wavelength. */
#include "testing/test_support.h"

/* Ior 1.5, dispersion 1, at the lines F, d, C. */
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

/* Single wavelengths: no weight is negative, their mean is 1; each band has its center as mean, overlaps its
 * neighbors, and is 0 at its ends. */
static void test_wavelengths(void **state)
{
    (void)state;
    enum { N = 300000, BINS = 60 };
    const double middle[3] = {611.4, 549.1, 464.2};
    double mean[3] = {0.0, 0.0, 0.0}, weight[3] = {0.0, 0.0, 0.0};
    int count[3] = {0, 0, 0}, bins[BINS] = {0}, edge = 0;
    for (int i = 0; i < N; ++i) {
        WavelengthSample s = sample_wavelength(((float)i + 0.5f) / N);
        for (int c = 0; c < 3; ++c) {
            assert_true(s.weight[c] == (c == s.channel ? 3.0f : 0.0f));
            weight[c] += (double)s.weight[c] / N;
        }
        mean[s.channel] += (double)s.wavelength_nm;
        ++count[s.channel];
        double from_middle = fabs((double)s.wavelength_nm - middle[s.channel]);
        assert_true(from_middle <= 75.001);
        edge += from_middle > 74.0;
        ++bins[(int)(((double)s.wavelength_nm - 389.0) / (687.0 - 389.0) * BINS)];
    }
    for (int c = 0; c < 3; ++c) {
        expect_near(weight[c], 1.0, 1e-5, "mean weight");
        expect_near(mean[c] / count[c], middle[c], 0.02, "channel %d, mean wavelength", c);
    }
    for (int b = 2; b < BINS - 2; ++b)
        assert_true(bins[b] > N / BINS / 10); /* no gap in the rainbow */
    assert_true(edge < N / 3000);
    WavelengthSample last = sample_wavelength(1.0f);
    assert_true(last.channel == 2 && isfinite(last.wavelength_nm));
}

/* A surface at one wavelength: Cauchy's ior on the denser side, seen from either side; unchanged without
 * dispersion. */
static void test_surface_of_one_wavelength(void **state)
{
    (void)state;
    Layers m =
        layers_from_surface(surface_from_metallic_roughness(vec3(0.0f, 0.0f, 1.0f), vec3(1.0f), 0.0f, 0.0f));
    m.layers = LAYER_TRANSMISSION | LAYER_VOLUME | LAYER_DISPERSION;
    m.dispersion = 1.0f;
    m.eta = 1.5f;
    Layers blue = layers_with_wavelength(m, 486.13f);
    expect_near((double)blue.eta, 1.51748, 1e-5, "from outside");
    assert_true(blue.layers == (LAYER_TRANSMISSION | LAYER_VOLUME));
    m.eta = 1.0f / 1.5f;
    expect_near(1.0 / (double)layers_with_wavelength(m, 656.27f).eta, 1.49248, 1e-5, "from inside");
    for (int i = 0; i < 100; ++i) {
        m.dispersion = i % 2 ? 0.0f : 1.0f;
        m.eta = i % 4 < 2 ? 1.0f + 0.013f * (float)i : 1.0f / (1.0f + 0.013f * (float)i);
        Layers same = layers_with_wavelength(m, m.dispersion > 0.0f ? 587.57f : 450.0f);
        if (m.dispersion > 0.0f)
            expect_near((double)same.eta, (double)m.eta, 3e-6, "the line d");
        else
            assert_true(same.eta == m.eta);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_golden_numbers),
                                       cmocka_unit_test(test_abbe_number), cmocka_unit_test(test_limits),
                                       cmocka_unit_test(test_wavelengths),
                                       cmocka_unit_test(test_surface_of_one_wavelength)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
