/* fresnel_test.c - reflectance: golden numbers from the equations in 80-bit floats, and properties. */
#include "testing/test_support.h"

static const double iors[3] = {1.33, 1.5, 2.42};

/* cos, then exact and Schlick for each ior */
static const double table[][7] = {
    {1.00, 0.0200593122, 0.0200593122, 0.0400000000, 0.0400000000, 0.1723949249, 0.1723949249},
    {0.90, 0.0206017296, 0.0200691116, 0.0407918879, 0.0400096000, 0.1731840330, 0.1724032010},
    {0.75, 0.0249259431, 0.0210162855, 0.0467807474, 0.0409375000, 0.1785902753, 0.1732031330},
    {0.50, 0.0591255992, 0.0506824587, 0.0891867128, 0.0700000000, 0.2115975682, 0.1982575835},
    {0.25, 0.2223802678, 0.2526038309, 0.2641903734, 0.2678125000, 0.3388741057, 0.3687894886},
    {0.10, 0.5389897579, 0.5987044889, 0.5715925203, 0.6068704000, 0.5854810467, 0.6610874457},
    {0.05, 0.7318418773, 0.7783187363, 0.7521304778, 0.7828297000, 0.7495985191, 0.8127799558},
    {0.01, 0.9389409020, 0.9519731558, 0.9437525435, 0.9529504479, 0.9405729962, 0.9594391166}};

static void test_dielectric(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT_OF(table); ++i)
        for (int k = 0; k < 3; ++k) {
            float c = (float)table[i][0], eta = (float)iors[k], F0 = F0_from_ior(eta);
            expect_relative(F_dielectric(c, eta), table[i][1 + 2 * k], 5e-6, "exact, ior %g, cos %g", iors[k],
                            table[i][0]);
            expect_relative(F_Schlick(vec3(F0), vec3(1.0f), c)[1], table[i][2 + 2 * k], 3e-6,
                            "Schlick, ior %g, cos %g", iors[k], table[i][0]);
            assert_true(F_Schlick1(F0, 1.0f, c) == F_Schlick(vec3(F0), vec3(1.0f), c)[0]);
        }
}

/* From the denser side: golden values, reversibility, the critical angle, Brewster's angle. */
static void test_inside(void **state)
{
    (void)state;
    const double critical[3] = {0.6593003245, 0.7453559925, 0.9106298019};
    const double at_095[3] = {0.0204920717, 0.0411104624, 0.1862476670};
    const double at_080[3] = {0.0383115338, 0.1141411002, 1.0};
    for (int k = 0; k < 3; ++k) {
        float n = (float)iors[k];
        expect_relative(F_dielectric(0.95f, 1.0f / n), at_095[k], 5e-6, "inside .95, ior %g", iors[k]);
        expect_relative(F_dielectric(0.80f, 1.0f / n), at_080[k], 5e-6, "inside .80, ior %g", iors[k]);
        assert_true(F_dielectric((float)critical[k] - 1e-5f, 1.0f / n) == 1.0f);
        assert_true(F_dielectric((float)critical[k] + 1e-3f, 1.0f / n) < 1.0f);
        for (float c = 0.05f; c < 1.0f; c += 0.05f) { /* the same ray backwards */
            float cos_t = sqrt(1.0f - (1.0f - c * c) / (n * n));
            expect_near((double)F_dielectric(cos_t, 1.0f / n), (double)F_dielectric(c, n), 2e-5,
                        "reversibility");
        }
        /* at Brewster's angle atan(n) the p half vanishes: F = ((1 - n^2) / (1 + n^2))^2 / 2 */
        double s = (1.0 - iors[k] * iors[k]) / (1.0 + iors[k] * iors[k]);
        double c = 1.0 / sqrt(1.0 + iors[k] * iors[k]);
        expect_relative(F_dielectric((float)c, n), 0.5 * s * s, 1e-5, "Brewster, ior %g", iors[k]);
    }
    assert_true(F_dielectric(0.0f, 1.5f) == 1.0f && F_dielectric(0.0f, 1.0f) == 1.0f);
    assert_true(F_dielectric(0.5f, 1.0f) == 0.0f);
}

static void test_means(void **state)
{
    (void)state;
    const double exact[3] = {0.0659308493, 0.0917779593, 0.2125407947};
    const double inside[3] = {0.4719491488, 0.5963457597, 0.8655386918};
    const double schlick[3] = {0.0667231545, 0.0857142857, 0.2118046904};
    for (int k = 0; k < 3; ++k) {
        float n = (float)iors[k];
        const int steps = 20000;
        double sum = 0.0, sum_inside = 0.0;
        for (int i = 0; i < steps; ++i) {
            float c = ((float)i + 0.5f) / (float)steps;
            sum += 2.0 * (double)(F_dielectric(c, n) * c) / steps;
            sum_inside += 2.0 * (double)(F_dielectric(c, 1.0f / n) * c) / steps;
        }
        expect_near(sum, exact[k], 1e-6, "mean, ior %g", iors[k]);
        expect_near(sum_inside, inside[k], 2e-5, "mean from inside, ior %g", iors[k]);
        expect_near(1.0 - (1.0 - exact[k]) / (iors[k] * iors[k]), inside[k], 1e-9, "link of the two means");
        expect_near((double)F_dielectric_avg(n), exact[k], 6e-3, "fit of the mean, ior %g", iors[k]);
        expect_relative(F_avg(vec3(F0_from_ior(n)), vec3(1.0f))[2], schlick[k], 1e-6, "mean of Schlick");
    }
}

static void test_spherical_gaussian(void **state)
{
    (void)state;
    const double at[][2] = {{0.5, 0.0725961144}, {0.25, 0.2650232046}, {0.05, 0.7864210025}};
    for (size_t i = 0; i < COUNT_OF(at); ++i)
        expect_relative(F_Schlick_SG(vec3(0.04f), (float)at[i][0])[0], at[i][1], 3e-6, "Gaussian at %g",
                        at[i][0]);
    for (float c = 0.0f; c <= 1.0f; c += 0.01f)
        expect_near((double)F_Schlick_SG(vec3(0.0f), c)[0], (double)schlick_weight(c), 4.1e-3,
                    "against the power");
}

static void test_conductor(void **state)
{
    (void)state;
    const float cosines[4] = {1.0f, 0.5f, 0.25f, 0.1f};
    const double silver[4] = {0.951951951952, 0.945882381801, 0.942741265792, 0.962896539909};
    const double aluminium[4] = {0.906264646149, 0.889096186751, 0.849352170010, 0.835438695221};
    for (int i = 0; i < 4; ++i) {
        vec3 F = F_conductor(cosines[i], vec3(0.2f, 1.5f, 1.5f), vec3(3.9f, 7.6f, 0.0f));
        expect_relative(F[0], silver[i], 3e-6, "eta .2, k 3.9, cos %g", (double)cosines[i]);
        expect_relative(F[1], aluminium[i], 3e-6, "eta 1.5, k 7.6, cos %g", (double)cosines[i]);
        /* without absorption a conductor is a dielectric */
        expect_relative(F[2], F_dielectric(cosines[i], 1.5f), 2e-5, "k 0, cos %g", (double)cosines[i]);
    }
    expect_near((double)F_conductor1(0.0f, 0.2f, 3.9f), 1.0, 1e-6, "grazing");
}

static void test_ior(void **state)
{
    (void)state;
    expect_relative(F0_from_ior(1.5f), 0.04, 1e-6, "ior 1.5");
    assert_true(F0_from_ior(0.0f) == 1.0f); /* stands for infinite */
    assert_true(F0_from_ior(1.0f) == 0.0f);
    for (float ior = 1.0f; ior < 3.0f; ior += 0.05f)
        expect_relative(ior_from_F0(F0_from_ior(ior)), ior, 1e-5, "round trip");
}

static void test_ranges(void **state)
{
    (void)state;
    test_rng rng = {7};
    for (int i = 0; i < 200000; ++i) {
        float c = i < 3 ? 0.5f * (float)i : rng_float(&rng), u = rng_float(&rng);
        float F[4] = {F_dielectric(c, 0.3f + 3.0f * u),
                      F_conductor1(c, 0.05f + 5.0f * u, 9.0f * rng_float(&rng)), F_Schlick1(u, 1.0f, c),
                      F_Schlick_SG(vec3(u), c)[0]};
        for (int k = 0; k < 4; ++k)
            assert_true(F[k] >= 0.0f && F[k] <= 1.00001f);
        float rough = F_Schlick_roughness(vec3(u), vec3(1.0f), 0.7f, c)[0];
        assert_true(rough >= u - 1e-6f && rough <= F_Schlick1(u, 1.0f, c) + 1e-6f);
    }
    assert_true(schlick_weight(1.0f) == 0.0f && schlick_weight(0.0f) == 1.0f);
    assert_true(schlick_weight(1.1f) == 0.0f && schlick_weight(-0.1f) == 1.0f);
    expect_relative(F_Schlick_roughness(vec3(0.04f), vec3(1.0f), 0.25f, 0.0f)[0], 0.75, 1e-6,
                    "grazing, rough");
    expect_relative(F_Schlick_roughness(vec3(0.9f), vec3(1.0f), 0.25f, 0.0f)[0], 0.9, 1e-6, "never below F0");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_dielectric), cmocka_unit_test(test_inside),
        cmocka_unit_test(test_means),      cmocka_unit_test(test_spherical_gaussian),
        cmocka_unit_test(test_conductor),  cmocka_unit_test(test_ior),
        cmocka_unit_test(test_ranges)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
