/* brdf_test.c - distribution and visibility: properties, then golden numbers. */
#include "testing/test_support.h"

/* Integral of D N.H g(H) over the hemisphere: midpoints in phi and in x = ln(tan theta / alpha), where D
 * N.H is the density 2 u (1 - u) / 2pi with u = 1 / (1 + e^-2x). n by n points; even in phi. */
typedef double (*over_normals)(vec3 H, const void *data);
static double integrate_normals(float alpha, int n, over_normals g, const void *data)
{
    const double low = -7.0, high = 12.0 - log((double)alpha), pi = 3.14159265358979323846;
    double sum = 0.0;
    for (int j = 0; j < n; ++j) {
        double x = low + (high - low) * (j + 0.5) / n;
        double t = (double)alpha * exp(x);
        double c = 1.0 / sqrt(1.0 + t * t), s = t * c;
        double u = 1.0 / (1.0 + exp(-2.0 * x)), weight = 2.0 * u / (1.0 + exp(2.0 * x));
        for (int i = 0; i < n; ++i) {
            double phi = pi * (i + 0.5) / n;
            vec3 H = vec3((float)(s * cos(phi)), (float)(s * sin(phi)), (float)c);
            sum += weight * g(H, data);
        }
    }
    return sum * (high - low) / ((double)n * n);
}

/* Integral of D (N.H) over the hemisphere with tan(theta) = scale e^x, midpoint rule in x; smooth for any
 * alpha. */
static double projected_area(double (*D)(double theta, float alpha), float alpha)
{
    const int steps = 4000;
    const double range = 14.0, pi = 3.14159265358979323846;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        double x = -range + 2.0 * range * (i + 0.5) / steps;
        double t = (double)alpha * exp(x);
        double theta = atan(t);
        double c = cos(theta), s = sin(theta);
        sum += D(theta, alpha) * c * s * c * c * t; /* d theta = cos^2 t dx */
    }
    return sum * 2.0 * range / steps * 2.0 * pi;
}
static double D_plain(double theta, float alpha)
{
    return (double)D_GGX((float)cos(theta), alpha);
}
static double D_cross(double theta, float alpha)
{
    return (double)D_GGX_stable((float)cos(theta), vec3((float)sin(theta), 0.0f, 0.0f), alpha);
}

static void test_D_is_normalised(void **state)
{
    (void)state;
    for (float r = 0.25f; r <= 1.0f; r += 0.05f)
        expect_near(projected_area(D_plain, r * r), 1.0, 2e-5, "integral of D_GGX N.H, roughness %g",
                    (double)r);
    for (float r = 0.01f; r <= 1.0f; r += 0.03f)
        expect_near(projected_area(D_cross, r * r), 1.0, 2e-6, "integral of D_GGX_stable N.H, roughness %g",
                    (double)r);
}

static void test_D_anisotropic_is_normalised(void **state)
{
    (void)state;
    const float alphas[][2] = {{0.5f, 0.1f}, {0.05f, 0.9f}, {1.0f, 0.01f}, {0.3f, 0.3f}};
    for (size_t a = 0; a < COUNT_OF(alphas); ++a) {
        /* midpoints in the stretched sphere h' = (h.x / ax, h.y / ay, h.z), where D is smooth */
        float ax = alphas[a][0], ay = alphas[a][1];
        const int n = 400;
        double sum = 0.0;
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                double z = (j + 0.5) / n, phi = 2.0 * 3.14159265358979 * (i + 0.5) / n, s = sqrt(1.0 - z * z);
                vec3 stretched = vec3(ax * (float)(s * cos(phi)), ay * (float)(s * sin(phi)), (float)z);
                vec3 H = normalize(stretched);
                float len = length(stretched);
                sum += (double)(D_GGX_anisotropic(H, ax, ay) * H[2] * ax * ay / (len * len * len));
            }
        sum *= 2.0 * 3.14159265358979 / ((double)n * n);
        expect_near(sum, 1.0, 1e-5, "integral of D_GGX_anisotropic, alpha %g, %g", (double)ax, (double)ay);
    }
}

static void test_forms_agree(void **state)
{
    (void)state;
    test_rng rng = {1};
    vec3 N = vec3(0.0f, 0.0f, 1.0f);
    for (int i = 0; i < 20000; ++i) {
        float alpha = 0.05f + 0.95f * rng_float(&rng);
        vec3 L = rng_direction(&rng), V = rng_direction(&rng);
        L[2] = fabsf(L[2]) + 1e-4f;
        V[2] = fabsf(V[2]) + 1e-4f;
        L = normalize(L);
        V = normalize(V);
        vec3 H = normalize(L + V);
        float D = D_GGX(H[2], alpha);
        expect_relative(D_GGX_stable(H[2], cross(N, H), alpha), D, 2e-4, "D_GGX_stable");
        expect_relative(D_GGX_anisotropic(H, alpha, alpha), D, 2e-4, "D_GGX_anisotropic");
        float Vis = V_SmithGGX(L[2], V[2], alpha);
        expect_relative(V_SmithGGX_anisotropic(L, V, alpha, alpha), Vis, 1e-5, "V_SmithGGX_anisotropic");
        expect_relative(G1_SmithGGX_anisotropic(V, alpha, alpha), G1_SmithGGX(V[2], alpha), 1e-5,
                        "G1 anisotropic");
        /* the definition of visibility: G2 / (4 N.L N.V) with G2 = 1 / (1 + Lambda + Lambda) */
        float lambda_L = Lambda_SmithGGX(L[2], alpha), lambda_V = Lambda_SmithGGX(V[2], alpha);
        float cosines = 4.0f * L[2] * V[2];
        expect_relative(Vis * cosines, 1.0f / (1.0f + lambda_L + lambda_V), 2e-4, "height-correlated G2");
        expect_relative(V_SmithGGX_separable(L[2], V[2], alpha) * cosines,
                        G1_SmithGGX(L[2], alpha) * G1_SmithGGX(V[2], alpha), 1e-4, "separable G2");
        expect_relative(G1_SmithGGX(V[2], alpha), 1.0f / (1.0f + lambda_V), 2e-4, "G1 from Lambda");
        assert_true(V_SmithGGX_separable(L[2], V[2], alpha) <= Vis * 1.00001f);
        assert_true(Vis >= 0.24999f);
        /* reciprocity */
        assert_true(Vis == V_SmithGGX(V[2], L[2], alpha));
    }
}

static void test_values(void **state)
{
    (void)state;
    /* roughness, D(1), D(.95), then visibility at N.L .5, N.V .75: correlated, separable, Karis ibl, direct */
    const double rows[][7] = {
        {0.10, 3183.0988618, 3.3422371807e-3, 0.666603713650, 0.666603712678, 0.662246173459, 0.551286672946},
        {0.25, 81.487330863, 0.12182855280, 0.664222244498, 0.664220777269, 0.639800062480, 0.523642871982},
        {0.50, 5.0929581789, 0.83988075821, 0.630792882542, 0.630471503861, 0.568888888889, 0.475725900116},
        {0.75, 1.0060164304, 0.68638722150, 0.530694732349, 0.525873732027, 0.475725900116, 0.427551832570},
        {1.00, 0.31830988618, 0.31830988618, 0.4, 0.380952380952, 0.380952380952, 0.380952380952}};
    for (size_t i = 0; i < COUNT_OF(rows); ++i) {
        float r = (float)rows[i][0], alpha = alpha_from_roughness(r);
        expect_relative(D_GGX(1.0f, alpha), rows[i][1], 1e-6, "D(1), roughness %g", rows[i][0]);
        expect_relative(D_GGX_stable(1.0f, vec3(0.0f), alpha), rows[i][1], 1e-6, "D(1) stable");
        expect_relative(D_GGX(0.95f, alpha), rows[i][2], 2e-6, "D(.95), roughness %g", rows[i][0]);
        expect_relative(V_SmithGGX(0.5f, 0.75f, alpha), rows[i][3], 1e-6, "V correlated");
        expect_relative(V_SmithGGX_separable(0.5f, 0.75f, alpha), rows[i][4], 1e-6, "V separable");
        expect_relative(V_SchlickGGX(0.5f, 0.75f, k_ibl(alpha)), rows[i][5], 1e-6, "V Karis, k = alpha / 2");
        expect_relative(V_SchlickGGX(0.5f, 0.75f, k_direct(r)), rows[i][6], 1e-6, "V Karis, k direct");
    }
    expect_near((double)V_SmithGGX(0.0f, 0.0f, 0.5f) * 0.0, 0.0, 0.0, "V is finite at the horizon");
    assert_true(isfinite(D_GGX(0.0f, ALPHA_DELTA)) && isfinite(D_GGX(1.0f, ALPHA_DELTA)));
    assert_true(k_direct(1.0f) == 0.5f && k_ibl(1.0f) == 0.5f); /* equal at roughness 1 */
}

typedef struct albedo_case {
    float NdotV, alpha, k; /* k < 0: correlated, k < -1: separable */
    bool weak;             /* masking only, over the whole sphere */
} albedo_case;
static double albedo_integrand(vec3 H, const void *data)
{
    const albedo_case *c = data;
    vec3 V = view_at(c->NdotV);
    float VdotH = dot(V, H);
    if (c->weak) /* D_V(H) / (D N.H) */
        return (double)(G1_SmithGGX(c->NdotV, c->alpha) * max(VdotH, 0.0f) / (c->NdotV * H[2]));
    float NdotL = 2.0f * VdotH * H[2] - c->NdotV;
    if (NdotL <= 0.0f)
        return 0.0;
    float Vis;
    if (c->k >= 0.0f)
        Vis = V_SchlickGGX(NdotL, c->NdotV, c->k);
    else
        Vis = c->k < -1.0f ? V_SmithGGX_separable(NdotL, c->NdotV, c->alpha)
                           : V_SmithGGX(NdotL, c->NdotV, c->alpha);
    return (double)(4.0f * Vis * NdotL * VdotH / H[2]);
}

/* Heitz 2014: with masking only, the light leaving in all directions, also into the surface, sums to 1. */
static void test_weak_white_furnace(void **state)
{
    (void)state;
    for (int r = 0; r < GOLDEN_ROUGHNESS_COUNT; ++r)
        for (int c = 0; c < GOLDEN_NDOTV_COUNT; ++c) {
            float alpha = golden_roughness[r] * golden_roughness[r];
            albedo_case furnace = {golden_NdotV[c], alpha, -1.0f, true};
            expect_near(integrate_normals(alpha, 800, albedo_integrand, &furnace), 1.0, 1e-4,
                        "weak white furnace, roughness %g, N.V %g", (double)golden_roughness[r],
                        (double)golden_NdotV[c]);
        }
}

/* Directional albedo with F = 1 for each visibility term. */
static void test_albedo(void **state)
{
    (void)state;
    static const golden_table separable = {
        {0.9760793455, 0.9990917988, 0.9997421166, 0.9998583453, 0.9998985564},
        {0.8793825564, 0.9612920564, 0.9883111645, 0.9938101223, 0.9956880607},
        {0.8745816452, 0.8285123531, 0.8550985344, 0.8911647446, 0.9158124302},
        {0.7670394509, 0.6964234585, 0.6474433943, 0.6283456252, 0.6268856567},
        {0.5844815608, 0.4909645111, 0.4091370926, 0.3506889365, 0.3068528194}};
    static const golden_table direct = {
        {0.07398940641, 0.4731160964, 0.7540057677, 0.9058656279, 0.9996155138},
        {0.1353281296, 0.4103486788, 0.6910478225, 0.8693921373, 0.9877706972},
        {0.3411885911, 0.4338771713, 0.5852642069, 0.7327686427, 0.8598452698},
        {0.5143685070, 0.4973812414, 0.5080071844, 0.5369516006, 0.5755728342},
        {0.5844815608, 0.4909645111, 0.4091370926, 0.3506889365, 0.3068528194}};
    for (int r = 0; r < GOLDEN_ROUGHNESS_COUNT; ++r)
        for (int c = 0; c < GOLDEN_NDOTV_COUNT; ++c) {
            float alpha = golden_roughness[r] * golden_roughness[r];
            albedo_case f = {golden_NdotV[c], alpha, -1.0f, false};
            double at[2] = {(double)golden_roughness[r], (double)golden_NdotV[c]};
            expect_near(integrate_normals(alpha, 800, albedo_integrand, &f), golden_A[r][c] + golden_B[r][c],
                        1e-4, "E correlated at %g, %g", at[0], at[1]);
            f.k = -2.0f;
            expect_near(integrate_normals(alpha, 800, albedo_integrand, &f), separable[r][c], 1e-4,
                        "E separable at %g, %g", at[0], at[1]);
            f.k = k_direct(golden_roughness[r]);
            expect_near(integrate_normals(alpha, 800, albedo_integrand, &f), direct[r][c], 1e-4,
                        "E with the k of analytic lights at %g, %g", at[0], at[1]);
        }
    /* exactly 1 - ln 2 for alpha 1 at normal incidence */
    albedo_case head_on = {1.0f, 1.0f, -1.0f, false};
    expect_near(integrate_normals(1.0f, 1000, albedo_integrand, &head_on), 1.0 - log(2.0), 3e-5, "1 - ln 2");
}

/* Total specular albedo at N.V .5, roughness .75 for metals of four F0: single scattering and five
 * compensations. */
static void test_multiscatter(void **state)
{
    (void)state;
    const float A = 0.6546928351f, B = 0.0084830101f, E = 0.6631758453f, E_mean = 0.6562014213f;
    /* F0, single, Turquin, Cycles, Kulla-Conty, Fdez-Aguera */
    const double rows[][6] = {{1.000, 0.6631758453, 1.0, 1.0, 1.0, 1.0},
                              {0.766, 0.5099777219, 0.7083835855, 0.6902242083, 0.6921344271, 0.6908025270},
                              {0.336, 0.2284598027, 0.2674471426, 0.2605003824, 0.2626512333, 0.2607461691},
                              {0.040, 0.0346707235, 0.0353750880, 0.0356912356, 0.0363438823, 0.0357014472}};
    for (size_t i = 0; i < COUNT_OF(rows); ++i) {
        vec3 F0 = vec3((float)rows[i][0]);
        vec3 mean = F_avg(F0, vec3(1.0f));
        float single = F0[0] * A + B;
        expect_relative(single, rows[i][1], 1e-6, "single");
        expect_relative(single * multiscatter_scale_turquin(F0, E)[0], rows[i][2], 2e-6, "Turquin");
        expect_relative(single * multiscatter_scale_cycles(mean, E, E_mean)[0], rows[i][3], 2e-6, "Cycles");
        expect_relative(single * multiscatter_scale(mean, E)[0], rows[i][5], 2e-6, "Fdez-Aguera");
        /* the additive lobe at E_L = E_mean is its own mean over L: times pi it is its albedo */
        float additive = brdf_kulla_conty(mean, E_mean, E, E_mean)[0] * PI;
        expect_relative(single + additive, rows[i][4], 2e-6, "Kulla-Conty");
    }
}

/* Against 2 int E mu dmu by midpoints over the albedo that test_albedo checks, and golden values. */
static void test_mean_albedo(void **state)
{
    (void)state;
    const double golden[GOLDEN_ROUGHNESS_COUNT] = {0.999490545680, 0.987250276739, 0.882323382618,
                                                   0.656201421324, 0.409137092587};
    for (int r = 0; r < GOLDEN_ROUGHNESS_COUNT; ++r) {
        expect_near((double)E_avg_GGX(golden_roughness[r]), golden[r], 1e-4, "fit, roughness %g",
                    (double)golden_roughness[r]);
        float alpha = golden_roughness[r] * golden_roughness[r];
        double mean = 0.0;
        for (int i = 0; i < 40; ++i) {
            float mu = ((float)i + 0.5f) / 40.0f;
            albedo_case f = {mu, alpha, -1.0f, false};
            mean += 2.0 * (double)mu * integrate_normals(alpha, 250, albedo_integrand, &f) / 40.0;
        }
        expect_near(mean, golden[r], 5e-4, "quadrature, roughness %g", (double)golden_roughness[r]);
    }
    assert_true(E_avg_GGX(0.0f) == 1.0f);
    for (float r = 0.0f; r < 1.0f; r += 0.01f)
        assert_true(E_avg_GGX(r + 0.01f) < E_avg_GGX(r) + 1e-6f);
}

static void test_lambert(void **state)
{
    (void)state;
    vec3 f = brdf_lambert(vec3(1.0f, 0.5f, 0.0f));
    expect_relative(f[0], 1.0 / 3.14159265358979, 1e-7, "Lambert");
    assert_true(f[1] == 0.5f * f[0] && f[2] == 0.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_D_is_normalised),
                                       cmocka_unit_test(test_D_anisotropic_is_normalised),
                                       cmocka_unit_test(test_forms_agree),
                                       cmocka_unit_test(test_values),
                                       cmocka_unit_test(test_weak_white_furnace),
                                       cmocka_unit_test(test_albedo),
                                       cmocka_unit_test(test_multiscatter),
                                       cmocka_unit_test(test_mean_albedo),
                                       cmocka_unit_test(test_lambert)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
