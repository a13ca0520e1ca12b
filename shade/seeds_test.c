/* seeds_test.c - formulas as circulating notes and summaries have them, failing a property that the right form
 * passes: so that nobody brings them back. docs/seeds.md lists them. */
#include "testing/test_support.h"

static const vec3 up = {0.0f, 0.0f, 1.0f};

/* Albedo with F = 1 by normals of D, for a masking term given as visibility. */
typedef float visibility(float NdotL, float NdotV, float perceptual_roughness);
static double albedo(visibility *V_term, float r, float NdotV)
{
    const uint n = 1u << 16u;
    vec3 V = view_at(NdotV);
    double sum = 0.0;
    for (uint i = 0; i < n; ++i) {
        vec3 H = sample_D_GGX(hammersley(i, n), r * r);
        vec3 L = reflect(-V, H);
        if (L[2] > 0.0f)
            sum += (double)(4.0f * V_term(L[2], NdotV, r) * L[2] * max(dot(V, H), 0.0f) / H[2]) / n;
    }
    return sum;
}
static float with_k_ibl(float NdotL, float NdotV, float r)
{
    return V_SchlickGGX(NdotL, NdotV, k_ibl(r * r));
}
static float with_k_direct(float NdotL, float NdotV, float r)
{
    return V_SchlickGGX(NdotL, NdotV, k_direct(r));
}
static float with_bias(float NdotL, float NdotV, float r)
{
    float G = 4.0f * NdotL * NdotV * V_SmithGGX(NdotL, NdotV, r * r);
    return G / (4.0f * NdotL * NdotV + 0.001f);
}
static float right(float NdotL, float NdotV, float r)
{
    return V_SmithGGX(NdotL, NdotV, r * r);
}

/* "k = (Roughness + 1)^2 / 8" under image based light: a smooth mirror of albedo 0.97 returns less than half. */
static void test_k_of_analytic_lights_in_image_based_light(void **state)
{
    (void)state;
    expect_near(albedo(with_k_ibl, 0.1f, 0.25f), 0.9703580927, 1e-3, "k = alpha / 2");
    expect_near(albedo(with_k_direct, 0.1f, 0.25f), 0.4731160964, 1e-3, "k = (r + 1)^2 / 8");
}

/* "/ (4 N.L N.V + 0.001)": an epsilon on a denominator that does not vanish alone takes energy at grazing views. */
static void test_epsilon_in_the_denominator(void **state)
{
    (void)state;
    double whole = albedo(right, 0.1f, 0.05f), biased = albedo(with_bias, 0.1f, 0.05f);
    expect_near(whole, 0.9762075901, 2e-3, "visibility");
    assert_true(biased < 0.95 * whole);
}

/* The spherical Gaussian without its power, as the exponent was lost in copying: not even in [0, 1]. */
static void test_gaussian_without_power(void **state)
{
    (void)state;
    float c = 0.5f, F0 = 0.04f;
    float printed = F0 + (1.0f - F0) * 2.0f * (-5.55473f * c - 6.98316f) * c;
    assert_true(printed < 0.0f);
    float F = F_Schlick_SG(vec3(F0), c)[0];
    assert_true(F >= F0 && F <= 1.0f);
}

/* alpha squared again inside D: the lobe is normalised, but it is that of another material. */
static void test_alpha_squared_twice(void **state)
{
    (void)state;
    float r = 0.5f;
    expect_relative(D_GGX(1.0f, alpha_from_roughness(r)), 5.0929581789, 1e-6, "roughness .5");
    assert_true(D_GGX(1.0f, alpha_from_roughness(r) * alpha_from_roughness(r)) > 15.0f * 5.09f);
}

/* chi as max(x, 0) in place of a step: D is multiplied by N.H and integrates to less than 1. */
static void test_heaviside_as_cosine(void **state)
{
    (void)state;
    const uint n = 1u << 14u;
    double step_sum = 0.0, cosine_sum = 0.0;
    for (uint i = 0; i < n; ++i) { /* D N.H / pdf is 1 for every sample */
        vec3 H = sample_D_GGX(hammersley(i, n), 1.0f);
        double ratio = (double)(D_GGX(H[2], 1.0f) * H[2] / pdf_D_GGX(H[2], 1.0f));
        step_sum += ratio / n;
        cosine_sum += ratio * (double)H[2] / n;
    }
    expect_near(step_sum, 1.0, 1e-6, "step");
    expect_near(cosine_sum, 2.0 / 3.0, 1e-3, "cosine");
}

/* PrefilterEnvMap divided by the number of samples in place of the sum of weights: a uniform light darkens. */
static void test_prefilter_by_count(void **state)
{
    (void)state;
    const uint n = 1024;
    double sum = 0.0, weight = 0.0;
    for (uint i = 0; i < n; ++i) {
        PrefilterSample s = prefilter_sample(i, n, 1.0f, up);
        sum += (double)s.weight;
        weight += (double)s.weight;
    }
    assert_true(sum / weight == 1.0);
    expect_near(sum / n, 0.25, 2e-3, "by count, roughness 1"); /* m0 of the golden table */
}

/* PrefilterEnvMap read from mip 0: with a sun of one texel in 256^2 x 6 a finite number of samples hits it or not.
 * Here: a spot of that solid angle 20 degrees off the axis, roughness .5. */
static void test_prefilter_from_mip_0(void **state)
{
    (void)state;
    const uint n = 1024;
    const double texel = 4.0 * 3.14159265358979 / (6.0 * 256.0 * 256.0), sun = 1e5;
    double worst_plain = 0.0, worst_filtered = 0.0;
    for (int turn = 0; turn < 64; ++turn) {
        float phi = 0.1f * (float)turn, theta = 0.35f;
        vec3 d = vec3(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
        double plain = 0.0, filtered = 0.0, weight = 0.0;
        for (uint i = 0; i < n; ++i) {
            PrefilterSample s = prefilter_sample(i, n, 0.25f, up);
            float lod = prefilter_lod(s.pdf, n, (float)texel);
            double away =
                2.0 * (1.0 - (double)dot(s.L, d)) * 3.14159265358979; /* solid angle of the cap to d */
            double footprint = texel * (pow)(4.0, (double)lod);
            weight += (double)s.weight;
            plain += away < texel ? sun * (double)s.weight : 0.0;
            filtered += away < footprint ? sun * texel / footprint * (double)s.weight : 0.0;
        }
        vec3 H = normalize(d + up); /* the expectation: L pdf N.L over the mean weight */
        double expected = sun * texel * (double)(0.25f * D_GGX(H[2], 0.25f) * d[2]) / (weight / n);
        double error_plain = fabs(plain / weight / expected - 1.0);
        double error_filtered = fabs(filtered / weight / expected - 1.0);
        worst_plain = error_plain > worst_plain ? error_plain : worst_plain;
        worst_filtered = error_filtered > worst_filtered ? error_filtered : worst_filtered;
    }
    assert_true(worst_plain >= 1.0);    /* missed altogether, or many times too bright */
    assert_true(worst_filtered < 0.75); /* a box of one mip level */
}

/* IntegrateBRDF at N.V = 0 as written: 0 / 0. */
static void test_division_at_the_horizon(void **state)
{
    (void)state;
    float NdotV = 0.0f, NdotH = 0.5f, VdotH = 0.0f, G = 0.0f;
    assert_true(isnan(G * VdotH / (NdotH * NdotV)));
    assert_true(isfinite(dfg_sample(3u, 16u, 0.5f, 0.0f)[0]));
}

/* The falloff with d^2 + 1 is for centimetres: in metres a lamp 1 m away has half its light. */
static void test_falloff_in_metres(void **state)
{
    (void)state;
    expect_relative(attenuation_ue4(1.0f, 1e6f), 0.5, 1e-6, "in metres");
    expect_relative(attenuation_ue4(100.0f, 1e6f) * 1e4f, 1.0, 2e-4, "in centimetres");
    assert_true(attenuation_range(1.0f, 0.0f) == 1.0f);
}

/* Widened alpha used alone makes glossy surfaces look rough: the highlight of a lamp of 0.1 rad on roughness .2 is
 * the lamp at nearly full brightness; the widened lobe shows a fraction, the representative point all but. */
static void test_widened_lobe_alone(void **state)
{
    (void)state;
    vec3 V = normalize(vec3(-1.0f, 0.0f, 1.0f)), center = normalize(vec3(1.0f, 0.0f, 1.0f));
    Surface s = surface_from_metallic_roughness(up, vec3(1.0f), 1.0f, 0.2f);
    vec3 I = vec3(PI * 0.01f); /* radiance 1 */
    double exact = 0.680395207727;
    double point = (double)shade_sphere(s, vec3(0.0f), V, center, 0.1f, I, ENERGY_GLTF, vec2(0.0f))[0];
    double wide = (double)shade_sphere_widened(s, vec3(0.0f), V, center, 0.1f, I, ENERGY_GLTF, vec2(0.0f))[0];
    assert_true(fabs(point / exact - 1.0) < 0.05);
    assert_true(wide < 0.7 * exact);
}

/* "BRDF = (1 - F) diffuse + F Vis D" with F0 mixed by metallic: not glTF's, which mixes two BRDFs; and no radiance
 * either before N.L and the light. */
static void test_parameters_mixed(void **state)
{
    (void)state;
    vec3 V = normalize(vec3(0.5f, 0.0f, 0.8f)), L = normalize(vec3(-0.2f, 0.4f, 0.8f)), H = normalize(V + L);
    float metallic = 0.5f, base = 1.0f;
    float F0 = mix(0.04f, base, metallic), F = F_Schlick1(F0, 1.0f, dot(V, H));
    float DV = D_GGX(H[2], 0.25f) * V_SmithGGX(L[2], V[2], 0.25f);
    float mixed = (F * DV + (1.0f - F) * base * (1.0f - metallic) * INV_PI) * L[2];
    Surface s = surface_from_metallic_roughness(up, vec3(base), metallic, 0.5f);
    float f = surface_brdf_cos(s, V, L)[0];
    assert_true(mixed < 0.95f * f); /* the diffuse part is weighted with the metal's Fresnel as well */
    SurfaceLobes lobes = surface_lobes_cos(s, V, L, ENERGY_GLTF, vec2(0.0f));
    expect_relative(lobes.specular[0], F * DV * L[2], 1e-5, "the specular part is the same");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_k_of_analytic_lights_in_image_based_light),
                                       cmocka_unit_test(test_epsilon_in_the_denominator),
                                       cmocka_unit_test(test_gaussian_without_power),
                                       cmocka_unit_test(test_alpha_squared_twice),
                                       cmocka_unit_test(test_heaviside_as_cosine),
                                       cmocka_unit_test(test_prefilter_by_count),
                                       cmocka_unit_test(test_prefilter_from_mip_0),
                                       cmocka_unit_test(test_division_at_the_horizon),
                                       cmocka_unit_test(test_falloff_in_metres),
                                       cmocka_unit_test(test_widened_lobe_alone),
                                       cmocka_unit_test(test_parameters_mixed)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
