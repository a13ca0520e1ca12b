/* dfg_integrate_test.c - albedos by quadrature against those of others: golden numbers, sums over samples,
 * exact limits. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "ibl/dfg_golden_test.h"
#include "ibl/dfg_integrate.h"

#include "shade/shade.h"

/* More values as in dfg_golden_test.h. */
static const double schlick_A[5][5] = {
    {0.2083021751, 0.7410566129, 0.9588389269, 0.9955539406, 0.9998871135},
    {0.3348617238, 0.6573372938, 0.9023494544, 0.9717336779, 0.9943317615},
    {0.6207420839, 0.6094113879, 0.7285344857, 0.8275376699, 0.8950418829},
    {0.6689271644, 0.5934679022, 0.5730121860, 0.5820536078, 0.6035684302},
    {0.5680998863, 0.4834797374, 0.4066814618, 0.3501073583, 0.3068192051}};
static const double schlick_B[5][5] = {
    {0.6241453121, 0.2293014798, 0.03109024092, 0.001000351390, 8.345276001e-08},
    {0.3100523048, 0.1733474915, 0.03047090025, 0.001444991704, 2.633721512e-06},
    {0.1150523998, 0.06088431170, 0.01854642935, 0.002382582941, 2.416901948e-05},
    {0.04170322589, 0.02062533820, 0.006969620756, 0.001451518140, 4.453806361e-05},
    {0.01638167451, 0.007484773656, 0.002455630747, 5.815782034e-04, 3.361429473e-05}};
static const double separable_E[5][5] = {
    {0.9760793455, 0.9990917988, 0.9997421166, 0.9998583453, 0.9998985564},
    {0.8793825564, 0.9612920564, 0.9883111645, 0.9938101223, 0.9956880607},
    {0.8745816452, 0.8285123531, 0.8550985344, 0.8911647446, 0.9158124302},
    {0.7670394509, 0.6964234585, 0.6474433943, 0.6283456252, 0.6268856567},
    {0.5844815608, 0.4909645111, 0.4091370926, 0.3506889365, 0.3068528194}};
static const double direct_E[5][5] = {{0.07398940641, 0.4731160964, 0.7540057677, 0.9058656279, 0.9996155138},
                                      {0.1353281296, 0.4103486788, 0.6910478225, 0.8693921373, 0.9877706972},
                                      {0.3411885911, 0.4338771713, 0.5852642069, 0.7327686427, 0.8598452698},
                                      {0.5143685070, 0.4973812414, 0.5080071844, 0.5369516006, 0.5755728342},
                                      {0.5844815608, 0.4909645111, 0.4091370926, 0.3506889365, 0.3068528194}};
static const double neubelt_E[5][5] = {
    {1.741163852, 0.1167289075, 0.001374564072, 9.203277922e-07, 8.540177113e-18},
    {1.133320792, 0.3945428076, 0.09888474431, 0.01531132288, 1.953125000e-04},
    {0.7470695544, 0.4313675424, 0.2295527838, 0.1077475321, 0.03125000000},
    {0.6083837140, 0.4102290090, 0.2715777416, 0.1726946334, 0.09346670817},
    {0.5451280275, 0.3938563253, 0.2872897598, 0.2084697555, 0.1414213562}};
static const double average_correlated[5] = {0.999490545680, 0.987250276739, 0.882323382618, 0.656201421324,
                                             0.409137092587};
static const double average_separable[5] = {0.999485471601, 0.987056560159, 0.879455669520, 0.642754354162,
                                            0.376634611193};
static const double average_neubelt[5] = {0.037041921533, 0.093838319491, 0.170338834695, 0.216227572227,
                                          0.241857965860};

/* The errors that the header states. */
static const double GGX_ERROR = 2e-6;
static const double SHEEN_ERROR = 1e-5;

static double worst_of_split_sum(dfg_masking masking, const double A[5][5], const double B[5][5])
{
    double worst = 0.0;
    for (int i = 0; i < 5; i++)
        for (int j = 0; j < 5; j++) {
            dfg_terms t = dfg_integrate(masking, (float)golden_roughness[i], golden_cosine[j]);
            worst = fmax(worst, fmax(fabs(t.scale - A[i][j]), fabs(t.bias - B[i][j])));
        }
    return worst;
}

static double worst_of_albedo(dfg_masking masking, const double E[5][5])
{
    double worst = 0.0;
    for (int i = 0; i < 5; i++)
        for (int j = 0; j < 5; j++) {
            dfg_terms t = dfg_integrate(masking, (float)golden_roughness[i], golden_cosine[j]);
            worst = fmax(worst, fabs(t.scale + t.bias - E[i][j]));
        }
    return worst;
}

static void split_sum_terms_equal_golden_values(void **state)
{
    (void)state;
    double correlated = worst_of_split_sum(DFG_SMITH_CORRELATED, golden_A, golden_B);
    double schlick = worst_of_split_sum(DFG_SCHLICK_IBL, schlick_A, schlick_B);
    double separable = worst_of_albedo(DFG_SMITH_SEPARABLE, separable_E);
    double direct = worst_of_albedo(DFG_SCHLICK_DIRECT, direct_E);
    print_message(
        "farthest from 200 golden numbers: correlated %.1e, Schlick %.1e, separable %.1e, direct %.1e\n",
        correlated, schlick, separable, direct);
    assert_true(correlated < GGX_ERROR && schlick < GGX_ERROR && separable < GGX_ERROR && direct < GGX_ERROR);
}

static void averages_equal_golden_values(void **state)
{
    (void)state;
    for (int i = 0; i < 5; i++) {
        assert_near(dfg_integrate_average(DFG_SMITH_CORRELATED, (float)golden_roughness[i]),
                    average_correlated[i], GGX_ERROR);
        assert_near(dfg_integrate_average(DFG_SMITH_SEPARABLE, (float)golden_roughness[i]),
                    average_separable[i], GGX_ERROR);
        /* the fit that direct light uses says 1e-4 of itself */
        assert_near(dfg_integrate_average(DFG_SMITH_CORRELATED, (float)golden_roughness[i]),
                    (double)E_avg_GGX((float)golden_roughness[i]), 1.1e-4);
    }
}

static void sheen_albedos_equal_golden_values(void **state)
{
    (void)state;
    double worst = 0.0;
    for (int i = 0; i < 5; i++) {
        sheen_nodes nodes;
        sheen_prepare((float)golden_roughness[i], &nodes);
        for (int j = 0; j < 5; j++) {
            sheen_albedos E = sheen_integrate(&nodes, golden_cosine[j]);
            worst =
                fmax(worst, fmax(fabs(E.charlie - golden_sheen[i][j]), fabs(E.neubelt - neubelt_E[i][j])));
        }
        /* averages by 2000 midpoints of the root of N.V */
        double charlie = 0.0;
        double neubelt = 0.0;
        enum { STEPS = 2000 };
        for (int k = 0; k < STEPS; k++) {
            double root = (k + 0.5) / STEPS;
            sheen_albedos E = sheen_integrate(&nodes, root * root);
            charlie += 4.0 * root * root * root * E.charlie / STEPS;
            neubelt += 4.0 * root * root * root * E.neubelt / STEPS;
        }
        assert_near(charlie, golden_sheen_average[i], SHEEN_ERROR);
        assert_near(neubelt, average_neubelt[i], SHEEN_ERROR);
    }
    print_message("farthest from 50 golden numbers of sheen: %.1e\n", worst);
    assert_true(worst < SHEEN_ERROR);
}

/* The limit of no roughness, exactly and from above, far from grazing angles. */
static void roughness_zero_gives_fresnel(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        dfg_masking masking = (dfg_masking)i;
        for (double mu = 0.05; mu <= 1.0; mu += 0.05) {
            double Fc = pow(1.0 - mu, 5.0);
            dfg_terms t = dfg_integrate(masking, 0.0f, mu);
            assert_near(t.scale, 1.0 - Fc, 1e-6);
            assert_near(t.bias, Fc, 1e-6);
            if (masking == DFG_SCHLICK_DIRECT)
                continue; /* its k is 1/8 there */
            t = dfg_integrate(masking, 1e-3f, mu);
            assert_near(t.scale, 1.0 - Fc, 2e-5);
            assert_near(t.bias, Fc, 2e-5);
        }
    }
    sheen_nodes nodes;
    sheen_prepare(0.0f, &nodes);
    sheen_albedos E = sheen_integrate(&nodes, 0.1);
    assert_true(E.charlie == 0.0 && E.neubelt == 0.0);
}

/* E = 1 - ln 2 for alpha = 1 at normal incidence with any masking; separable masking and Schlick with k =
 * 1/2 are equal there; N.V is clamped to NDOTV_MIN. */
static void known_identities_hold(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        dfg_terms t = dfg_integrate((dfg_masking)i, 1.0f, 1.0);
        assert_near(t.scale + t.bias, 1.0 - log(2.0) * 1.0, 1e-6);
        dfg_terms least = dfg_integrate((dfg_masking)i, 0.5f, (double)NDOTV_MIN);
        dfg_terms zero = dfg_integrate((dfg_masking)i, 0.5f, 0.0);
        assert_true(least.scale == zero.scale && least.bias == zero.bias);
    }
    for (int j = 0; j < 5; j++) {
        dfg_terms separable = dfg_integrate(DFG_SMITH_SEPARABLE, 1.0f, golden_cosine[j]);
        dfg_terms schlick = dfg_integrate(DFG_SCHLICK_IBL, 1.0f, golden_cosine[j]);
        assert_near(separable.scale, schlick.scale, 1e-6);
        assert_near(separable.bias, schlick.bias, 1e-6);
    }
}

/* No surface reflects more than it receives, not even at grazing angles and near roughness 0. */
static void no_surface_reflects_more_than_it_receives(void **state)
{
    (void)state;
    for (int y = 0; y < 60; y++)
        for (int x = 0; x < 60; x++) {
            double a = (x + 0.5) / 60.0;
            double r = (y + 0.5) / 60.0;
            dfg_terms t = dfg_integrate(DFG_SMITH_CORRELATED, (float)(r * r * r), a * a * a);
            assert_true(t.scale >= 0.0 && t.bias >= 0.0 && t.scale + t.bias <= 1.0 + 1e-6);
            dfg_terms separable = dfg_integrate(DFG_SMITH_SEPARABLE, (float)(r * r * r), a * a * a);
            assert_true(separable.scale + separable.bias <= t.scale + t.bias + 1e-6);
        }
}

static uint32_t reverse(uint32_t bits)
{
    bits = bits << 16 | bits >> 16;
    bits = (bits & 0x00ff00ffu) << 8 | (bits >> 8 & 0x00ff00ffu);
    bits = (bits & 0x0f0f0f0fu) << 4 | (bits >> 4 & 0x0f0f0f0fu);
    bits = (bits & 0x33333333u) << 2 | (bits >> 2 & 0x33333333u);
    return (bits & 0x55555555u) << 1 | (bits >> 1 & 0x55555555u);
}

/* "IntegrateBRDF" as the notes on Karis 2013 have it, in double and with what they leave out (N, and
 * Hammersley's points, here shifted by half a step): H of density D N.H, G by Schlick's terms with k =
 * alpha / 2. Farther from the quadrature where fewer samples see the lobe: at grazing angles. */
static void integrate_brdf(double r, double NoV, uint32_t samples, double *A, double *B)
{
    double a = r * r;
    double k = 0.5 * a;
    double V[3] = {sqrt(1.0 - NoV * NoV), 0.0, NoV};
    *A = *B = 0.0;
    for (uint32_t i = 0; i < samples; i++) {
        double u = (i + 0.5) / samples;
        double v = (double)(reverse(i) + 0.5) / 4294967296.0;
        double phi = 2.0 * 3.14159265358979323846 * u;
        double cos_theta = sqrt((1.0 - v) / (1.0 + (a * a - 1.0) * v));
        double sin_theta = sqrt(1.0 - cos_theta * cos_theta);
        double H[3] = {sin_theta * cos(phi), sin_theta * sin(phi), cos_theta};
        double VoH = V[0] * H[0] + V[2] * H[2];
        double NoL = 2.0 * VoH * H[2] - V[2];
        if (NoL <= 0.0)
            continue;
        double G = NoV / (NoV * (1.0 - k) + k) * (NoL / (NoL * (1.0 - k) + k));
        double G_Vis = G * VoH / (H[2] * NoV);
        double Fc = pow(1.0 - VoH, 5.0);
        *A += (1.0 - Fc) * G_Vis / samples;
        *B += Fc * G_Vis / samples;
    }
}

static void terms_equal_those_of_importance_sampling(void **state)
{
    (void)state;
    enum { SAMPLES = 18 };
    double worst = 0.0;
    for (int i = 0; i < 5; i++)
        for (int j = 0; j < 5; j++) {
            double A, B;
            integrate_brdf(golden_roughness[i], golden_cosine[j], 1u << SAMPLES, &A, &B);
            dfg_terms t = dfg_integrate(DFG_SCHLICK_IBL, (float)golden_roughness[i], golden_cosine[j]);
            worst = fmax(worst, fmax(fabs(t.scale - A), fabs(t.bias - B)));
        }
    print_message("farthest from sums of 2^%d samples: %.1e\n", SAMPLES, worst);
    assert_true(worst < 1e-4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(split_sum_terms_equal_golden_values),
        cmocka_unit_test(averages_equal_golden_values),
        cmocka_unit_test(sheen_albedos_equal_golden_values),
        cmocka_unit_test(roughness_zero_gives_fresnel),
        cmocka_unit_test(known_identities_hold),
        cmocka_unit_test(no_surface_reflects_more_than_it_receives),
        cmocka_unit_test(terms_equal_those_of_importance_sampling),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
