/* volume_test.c - absorption and scattering between surfaces. */
#include "testing/chi_square.h"

static void test_beer(void **state)
{
    (void)state;
    /* color^(3 / 2) */
    vec3 T = volume_transmittance(vec3(0.5f, 0.8f, 0.9f), 2.0f, 3.0f);
    const double expected[3] = {0.353553390593, 0.715541752800, 0.853814968245};
    for (int c = 0; c < 3; ++c)
        expect_relative(T[c], expected[c], 1e-6, "channel %d", c);
    test_rng rng = {3};
    for (int i = 0; i < 10000; ++i) {
        vec3 color = rng_color(&rng);
        float distance = 0.01f + 10.0f * rng_float(&rng), a = rng_float(&rng), b = rng_float(&rng);
        vec3 both = volume_transmittance(color, distance, a + b);
        vec3 product = volume_transmittance(color, distance, a) * volume_transmittance(color, distance, b);
        vec3 sigma = volume_extinction(color, distance);
        for (int c = 0; c < 3; ++c) {
            expect_near((double)both[c], (double)product[c], 3e-6, "two parts");
            expect_near((double)both[c], exp(-(double)sigma[c] * (double)(a + b)), 1e-5, "extinction");
        }
    }
}

static void test_beer_limits(void **state)
{
    (void)state;
    vec3 color = vec3(0.0f, 0.5f, 1.0f);
    vec3 T = volume_transmittance(color, 1.0f, 0.0f); /* no path */
    assert_true(T[0] == 1.0f && T[1] == 1.0f && T[2] == 1.0f);
    T = volume_transmittance(color, 1.0f, 1e-6f); /* 0 is opaque, 1 is clear */
    assert_true(T[0] == 0.0f && T[1] < 1.0f && T[1] > 0.99f && T[2] == 1.0f);
    T = volume_transmittance(color, 1.0f, 1e38f);
    assert_true(T[0] == 0.0f && T[1] == 0.0f && T[2] == 1.0f);
    const float unlimited[] = {INFINITY, 0.0f};
    for (size_t i = 0; i < COUNT_OF(unlimited); ++i) {
        T = volume_transmittance(color, unlimited[i], 5.0f);
        vec3 sigma = volume_extinction(color, unlimited[i]);
        for (int c = 0; c < 3; ++c)
            assert_true(T[c] == 1.0f && sigma[c] == 0.0f);
    }
    T = volume_transmittance(vec3(0.5f), 1e-30f, 1e30f); /* the quotient overflows */
    assert_true(T[0] == 0.0f);
}

static void test_single_scatter_albedo(void **state)
{
    (void)state;
    const double golden[4][2] = {
        {0.1, 0.384240453846}, {0.5, 0.911708854747}, {0.8, 0.990588779730}, {0.95, 0.999505258515}};
    for (int i = 0; i < 4; ++i)
        expect_near((double)single_scatter_albedo1((float)golden[i][0]), golden[i][1], 1e-5, "of %g",
                    golden[i][0]);
    float before = -1.0f;
    for (int i = 0; i <= 1000; ++i) {
        float a = single_scatter_albedo1((float)i * 1e-3f);
        assert_true(a >= 0.0f && a <= 1.0f && a >= before - 1e-6f);
        before = a;
    }
    vec3 each = single_scatter_albedo(vec3(0.1f, 0.5f, 0.8f));
    expect_near((double)each[2], golden[2][1], 1e-5, "per channel");
}

typedef struct medium {
    vec3 before;
    float g;
} medium;
static bool draw_phase(const void *context, vec2 u, vec3 *d)
{
    const medium *m = (const medium *)context;
    *d = sample_phase_HG(u, m->before, m->g);
    return true;
}
static float pdf_phase(const void *context, vec3 d)
{
    const medium *m = (const medium *)context;
    return phase_HG(dot(m->before, d), m->g);
}
static void test_phase(void **state)
{
    (void)state;
    expect_relative(phase_HG(1.0f, 0.5f), 0.4774648293, 1e-6, "forward");
    expect_relative(phase_HG(0.0f, 0.5f), 0.0427057526, 1e-6, "sideways");
    expect_relative(phase_HG(-1.0f, 0.5f), 0.0176838826, 1e-6, "backward");
    expect_relative(phase_HG(0.3f, 0.0f), 0.0795774715, 1e-6, "isotropic");
    const float g[] = {0.0f, 0.0005f, 0.002f, 0.5f, -0.7f};
    for (size_t i = 0; i < COUNT_OF(g); ++i) {
        medium m = {normalize(vec3(0.3f, -0.5f, 0.6f)), g[i]};
        double p = chi2_over_sphere(&(sphere_sampler){draw_phase, pdf_phase, &m}, 60u + i);
        if (p < 1e-3)
            fail_msg("g %g: p = %g", (double)g[i], p);
        double mean = 0.0;
        const uint n = 1u << 14u;
        for (uint k = 0; k < n; ++k)
            mean += (double)dot(sample_phase_HG(hammersley(k, n), m.before, g[i]), m.before) / n;
        expect_near(mean, (double)g[i], 1e-3, "mean cosine");
    }
    for (int i = 0; i < 3; ++i) { /* forward lobes stay unit and finite */
        vec3 d = sample_phase_HG(vec2(0.5f, (float)i * 0.49999997f), vec3(0.0f, 0.0f, 1.0f), 0.999f);
        expect_near((double)length(d), 1.0, 1e-5, "unit");
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_beer), cmocka_unit_test(test_beer_limits),
                                       cmocka_unit_test(test_single_scatter_albedo),
                                       cmocka_unit_test(test_phase)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
