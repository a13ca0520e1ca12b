/* dfg_test.c - the tables of albedo against quadrature. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "ibl/dfg_golden_test.h"

#include "ibl/dfg.h"
#include "ibl/ibl.h"

#include "shade/shade.h"

static void split_sum_terms_equal_golden_values(void **state)
{
    (void)state;
    double worst = 0.0;
    for (int i = 0; i < 5; i++)
        for (int j = 0; j < 5; j++) {
            float dfg[2];
            ibl_dfg((float)golden_cosine[j], (float)golden_roughness[i], dfg);
            worst = fmax(worst,
                         fmax(fabs((double)dfg[0] - golden_A[i][j]), fabs((double)dfg[1] - golden_B[i][j])));
        }
    print_message("largest deviation, interpolated: %.2e\n", worst);
    assert_true(worst < 2e-3);
}

/* r = 1 and N.V = 1 are a node: E = 1 - ln 2 exactly. */
static void the_last_node_is_exact(void **state)
{
    (void)state;
    float dfg[2];
    ibl_dfg(1.0f, 1.0f, dfg);
    assert_near((double)dfg[0] + (double)dfg[1], 0.3068528194, 1e-4);
    assert_near(dfg[0], golden_A[4][4], 1e-4);
    assert_near(dfg[1], golden_B[4][4], 1e-4);
}

/* At roughness 0 the terms are those of Fresnel reflection. */
static void roughness_zero_gives_fresnel(void **state)
{
    (void)state;
    for (int x = 0; x < DFG_SIZE; x++) {
        float dfg[2];
        double root = (double)x / (DFG_SIZE - 1);
        ibl_dfg((float)(root * root), 0.0f, dfg);
        double Fc = pow(1.0 - root * root, 5.0);
        assert_near(dfg[0], 1.0 - Fc, 1e-5);
        assert_near(dfg[1], Fc, 1e-5);
    }
}

static void terms_stay_in_range_and_conserve_energy(void **state)
{
    (void)state;
    for (int y = 0; y <= 500; y++)
        for (int x = 0; x <= 500; x++) {
            float dfg[2];
            ibl_dfg((float)x / 500.0f, (float)y / 500.0f, dfg);
            assert_true(dfg[0] >= 0.0f && dfg[1] >= 0.0f && dfg[0] + dfg[1] <= 1.0f + 1e-4f);
        }
    float inside[2], outside[2];
    ibl_dfg(1.0f, 1.0f, inside);
    ibl_dfg(1.5f, 3.0f, outside);
    assert_memory_equal(inside, outside, sizeof inside);
    ibl_dfg(0.0f, 0.0f, inside);
    ibl_dfg(-1.0f, NAN, outside);
    assert_memory_equal(inside, outside, sizeof inside);
}

static void sheen_albedos_equal_golden_values(void **state)
{
    (void)state;
    double worst = 0.0;
    for (int i = 0; i < 5; i++)
        for (int j = 0; j < 5; j++) {
            double E = (double)ibl_sheen_albedo((float)golden_cosine[j], (float)golden_roughness[i]);
            worst = fmax(worst, fabs(E - golden_sheen[i][j]));
        }
    print_message("largest deviation of sheen, interpolated: %.2e\n", worst);
    assert_true(worst < 2e-3);
}

/* The sampled integral of the shader library: another method, the same D and V. */
static void sheen_albedos_equal_those_of_the_shader_library(void **state)
{
    (void)state;
    double worst = 0.0;
    for (int i = 0; i < 60; i++) {
        float mu = 0.01f + 0.98f * (float)((i * 37) % 60) / 60.0f * (float)((i * 37) % 60) / 60.0f;
        float r = 0.05f + 0.95f * (float)i / 60.0f;
        float expected = integrate_sheen_albedo(r, mu, 16384u);
        worst = fmax(worst,
                     fabs((double)ibl_sheen_albedo(mu, r) - (double)expected) / fmax((double)expected, 1.0));
    }
    print_message("largest deviation from sampling: %.2e\n", worst);
    assert_true(worst < 5e-3);
}

/* Falling with N.V from its peak on, which is nearer to the horizon than 0.03; above 1 only at the rim of
 * smooth sheen, and 0 where the rim has no width. */
static void sheen_albedos_fall_towards_the_normal(void **state)
{
    (void)state;
    for (int y = 0; y <= 300; y++) {
        float before = INFINITY;
        for (int x = 0; x <= 300; x++) {
            float E = ibl_sheen_albedo((float)x / 300.0f, (float)y / 300.0f);
            assert_true(E >= 0.0f && (x < 9 || E <= before));
            assert_true(E <= 1.0f || (x < 18 && y < 80));
            assert_true(y > 0 || E == 0.0f);
            before = E;
        }
    }
    assert_true(ibl_sheen_albedo(-1.0f, 0.5f) == ibl_sheen_albedo(0.0f, 0.5f));
    assert_true(ibl_sheen_albedo(2.0f, 7.0f) == ibl_sheen_albedo(1.0f, 1.0f));
}

/* The mean over a hemisphere of uniform light, 2 E N.V dN.V: quadrature in long double. */
static void averages_of_sheen_equal_golden_values(void **state)
{
    (void)state;
    for (int i = 0; i < 5; i++) {
        double sum = 0.0;
        for (int k = 0; k < 20000; k++) {
            double mu = (k + 0.5) / 20000.0;
            sum += 2.0 * mu * (double)ibl_sheen_albedo((float)mu, (float)golden_roughness[i]) / 20000.0;
        }
        assert_near(sum, golden_sheen_average[i], 2e-3); /* without the part above 1 */
    }
}

/* Rough glass: R and T by quadrature, R + T the node-free number of the table. */
static void terms_of_glass_equal_golden_values(void **state)
{
    (void)state;
    static const struct {
        float eta, r, mu;
        double R, T;
    } rows[] = {{1.33f, 0.25f, 0.25f, 0.194968220724, 0.789269741410},
                {1.33f, 1.00f, 0.25f, 0.023993545366, 0.669276530096},
                {1.33f, 0.50f, 1.00f, 0.018661476913, 0.975771709073},
                {1.50f, 0.25f, 0.25f, 0.233456163475, 0.749758477838},
                {1.50f, 0.50f, 0.50f, 0.066898507093, 0.893867651534},
                {1.50f, 1.00f, 1.00f, 0.012702412787, 0.880637578333},
                {2.42f, 0.25f, 0.25f, 0.311229491070, 0.670719044788},
                {2.42f, 0.50f, 0.50f, 0.173636205390, 0.778107502070},
                {2.42f, 1.00f, 0.50f, 0.082092470379, 0.613895461367}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        float glass[3];
        float dfg[2];
        ibl_glass(rows[i].mu, rows[i].r, rows[i].eta, glass);
        ibl_dfg(rows[i].mu, rows[i].r, dfg);
        double f0 = (double)F0_from_ior(rows[i].eta);
        assert_near((double)(dfg[0] + dfg[1]) * (f0 + (1.0 - f0) * (double)glass[0]), rows[i].R, 2e-3);
        assert_near(glass[1], rows[i].R + rows[i].T, 3e-3);
        assert_true(glass[2] >= glass[1] - (float)rows[i].R - 1e-3f);
    }
}

/* Interpolated single scattering is accurate to 1 % from either side for the iors of real glasses; at
 * nodes the LUT holds integrate_glass() to the last of its 16 bits. */
static void interpolated_terms_of_glass_are_accurate(void **state)
{
    (void)state;
    double worst = 0.0;
    for (int i = 0; i < 600; i++) {
        vec2 u = hammersley((uint)i, 600u);
        float r = radical_inverse((uint)i * 7919u + 13u);
        float mu = 0.04f + 0.96f * u[0];
        float ior = 1.2f + 1.3f * u[1];
        float eta = i % 2 ? ior : 1.0f / ior;
        float glass[3];
        ibl_glass(mu, r, eta, glass);
        vec3 expected = integrate_glass(r, mu, eta, 2048u);
        worst = fmax(worst, fabs((double)(glass[1] / expected[1]) - 1.0));
    }
    print_message("largest relative deviation of R + T: %.2e\n", worst);
    assert_true(worst < 0.01);
    float glass[3];
    ibl_glass(1.0f, 1.0f, 1.0f / 9.0f, glass);
    vec3 node = integrate_glass(1.0f, 1.0f, 1.0f / 9.0f, 4096u);
    for (int i = 0; i < 3; i++)
        assert_near(glass[i], node[i], 2e-5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(split_sum_terms_equal_golden_values),
        cmocka_unit_test(the_last_node_is_exact),
        cmocka_unit_test(roughness_zero_gives_fresnel),
        cmocka_unit_test(terms_stay_in_range_and_conserve_energy),
        cmocka_unit_test(sheen_albedos_equal_golden_values),
        cmocka_unit_test(sheen_albedos_equal_those_of_the_shader_library),
        cmocka_unit_test(sheen_albedos_fall_towards_the_normal),
        cmocka_unit_test(averages_of_sheen_equal_golden_values),
        cmocka_unit_test(terms_of_glass_equal_golden_values),
        cmocka_unit_test(interpolated_terms_of_glass_are_accurate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
