/* seeds_test.c - errors of formulas in circulating notes and summaries: each fails a property that the
 * correct form passes, so that none returns. docs/seeds.md lists them. */
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

/* "/ (4 N.L N.V + 0.001)": an epsilon on a denominator that does not vanish alone loses energy at grazing
 * views. */
static void test_epsilon_in_the_denominator(void **state)
{
    (void)state;
    double whole = albedo(right, 0.1f, 0.05f), biased = albedo(with_bias, 0.1f, 0.05f);
    expect_near(whole, 0.9762075901, 2e-3, "visibility");
    assert_true(biased < 0.95 * whole);
}

/* The spherical Gaussian without its power, its exponent lost in copying: not even in [0, 1]. */
static void test_gaussian_without_power(void **state)
{
    (void)state;
    float c = 0.5f, F0 = 0.04f;
    float printed = F0 + (1.0f - F0) * 2.0f * (-5.55473f * c - 6.98316f) * c;
    assert_true(printed < 0.0f);
    float F = F_Schlick_SG(vec3(F0), c)[0];
    assert_true(F >= F0 && F <= 1.0f);
}

/* alpha squared again inside D: the lobe is normalised, but belongs to another material. */
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

/* PrefilterEnvMap divided by the number of samples in place of the sum of weights darkens a uniform
 * environment. */
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

/* PrefilterEnvMap reading mip 0: a finite number of samples may hit or miss a sun of one texel in 256^2 x 6.
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
            double footprint = texel * pow(4.0, (double)lod);
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
    assert_true(worst_plain >= 1.0);    /* missed entirely, or many times too bright */
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

/* The falloff with d^2 + 1 is for centimeters: in meters it halves a light at 1 m. */
static void test_falloff_in_metres(void **state)
{
    (void)state;
    expect_relative(attenuation_ue4(1.0f, 1e6f), 0.5, 1e-6, "in metres");
    expect_relative(attenuation_ue4(100.0f, 1e6f) * 1e4f, 1.0, 2e-4, "in centimetres");
    assert_true(attenuation_range(1.0f, 0.0f) == 1.0f);
}

/* Widened alpha alone makes glossy surfaces look rough: the highlight of a light of 0.1 rad on roughness
 * .2 has nearly the light's full radiance; the widened lobe shows a fraction, the representative point
 * nearly all. */
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

/* "BRDF = (1 - F) diffuse + F Vis D" with F0 mixed by metallic differs from glTF, which mixes two BRDFs;
 * nor is it a radiance before N.L and the light. */
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
    assert_true(mixed < 0.95f * f); /* the diffuse part is weighted with the Fresnel of the metal as well */
    SurfaceLobes lobes = surface_lobes_cos(s, V, L, ENERGY_GLTF, vec2(0.0f));
    expect_relative(lobes.specular[0], F * DV * L[2], 1e-5, "the specular part is the same");
}

/* ---- "Shininess in OpenGL 1 versus glTF PBR" ---- */

/* The sum plotted in the vignette, phi in degrees, for roughness and metallic 1 and white, separable masking:
 * with the step chi of glTF, and with max(x, 0), as in its R code. */
static double vignette_pbr(double phi, bool is_ramp)
{
    const double to_rad = 3.14159265358979323846 / 180.0;
    vec3 V = vec3((float)sin(30.0 * to_rad), 0.0f, (float)cos(30.0 * to_rad));
    vec3 L = vec3((float)sin(phi * to_rad), 0.0f, (float)cos(phi * to_rad));
    vec3 H = normalize(V + L);
    float f = D_GGX(H[2], 1.0f) * V_SmithGGX_separable(L[2], V[2], 1.0f) * L[2];
    float ramp = H[2] * dot(H, L) * dot(H, V);
    return (double)(is_ramp ? f * ramp : f);
}
static void test_ramp_for_step(void **state)
{
    (void)state;
    static const struct {
        double phi, ramp, step;
    } values[] = {{-80, 0.007525289, 0.025238578}, {-60, 0.027461554, 0.056860585},
                  {-30, 0.059375451, 0.079167267}, {0, 0.076865935, 0.085290877},
                  {30, 0.068560865, 0.079167267},  {60, 0.037513180, 0.056860585},
                  {80, 0.011890705, 0.025238578}};
    for (size_t i = 0; i < COUNT_OF(values); ++i) {
        expect_relative(vignette_pbr(values[i].phi, true), values[i].ramp, 2e-6, "ramp, %g", values[i].phi);
        expect_relative(vignette_pbr(values[i].phi, false), values[i].step, 2e-6, "step, %g", values[i].phi);
    }
    assert_true(vignette_pbr(-80.0, false) > 3.3 * vignette_pbr(-80.0, true));
}

/* A light of 1 in both models: a white surface is 1 in OpenGL 1 and 1 / pi in glTF. */
static void test_light_without_pi(void **state)
{
    (void)state;
    float old = phong_reflection(up, up, up, vec3(1.0f), vec3(0.0f), 1.0f)[0];
    float lambert = brdf_lambert(vec3(1.0f))[0];
    expect_relative(old, 1.0, 1e-7, "old");
    expect_relative(lambert, 0.318309886, 1e-6, "the same light");
    expect_relative(lambert * PI, old, 1e-6, "pi times the light");
}

/* "mvMatrix * vec4(lightdir, 1.)" for a direction: a light from +Y on a floor facing it vanishes as the eye
 * moves away, though neither floor nor light moved. */
static void test_direction_with_w_1(void **state)
{
    (void)state;
    mat3 view = mat3(vec3(1.0f, 0.0f, 0.0f), vec3(0.0f, 0.6f, 0.8f), vec3(0.0f, -0.8f, 0.6f));
    vec3 N = mul(view, vec3(0.0f, 1.0f, 0.0f));
    PhongMaterial m = {vec3(0.0f), vec3(1.0f), vec3(0.0f), vec3(0.0f), 1.0f};
    PhongRules printed = phong_rules(PHONG_VIGNETTE);
    for (int i = 0; i < 3; ++i) {
        vec3 translation = vec3(0.0f, 0.0f, -1.0f - 2.0f * (float)i);
        vec3 L = phong_to_eye(view, translation, vec3(0.0f, 1.0f, 0.0f), 0.0f);
        vec3 leaking = phong_to_eye(view, translation, vec3(0.0f, 1.0f, 0.0f), printed.direction_w);
        PhongLight right = phong_light_directional(L, vec3(0.0f), vec3(1.0f), vec3(1.0f));
        PhongLight wrong = phong_light_directional(leaking, vec3(0.0f), vec3(1.0f), vec3(1.0f));
        vec3 P = translation;
        expect_near((double)phong_light_part(printed, m, right, P, N, normalize(-P)).color[0], 1.0, 1e-6,
                    "w 0");
        expect_near((double)phong_light_part(printed, m, wrong, P, N, normalize(-P)).color[0],
                    i == 0 ? 0.2 : 0.0, 1e-6, "w 1, %d", i);
    }
}

/* "lighteffect + vec4(col, colDiff.a)" in the loop over lights, as in rgl's WebGL shader: 0.4 is opaque under
 * three lights. phong_texture() counts the opacity once. */
static void test_alpha_per_light(void **state)
{
    (void)state;
    float alpha = 0.4f, summed = 0.0f;
    for (int light = 0; light < 3; ++light)
        summed += alpha;
    PhongColor e = {vec3(1.0f), alpha}, white = {vec3(1.0f), 1.0f};
    assert_true(summed > 1.0f);
    assert_true(phong_texture(PHONG_RGB, PHONG_MODULATE, e, white).opacity == alpha);
}

/* alpha = sqrt(2 / (s + 2)) is glTF's alpha, the square of its roughness: taken as roughness, the
 * highlight of s = 50 is that of s = 1350. */
static void test_one_square_root(void **state)
{
    (void)state;
    float alpha = alpha_from_shininess(50.0f);
    expect_relative(alpha_from_roughness(sqrt(alpha)), alpha, 1e-6, "two roots");
    expect_relative(shininess_from_alpha(alpha_from_roughness(alpha)), 1350.0, 1e-4, "one root");
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
                                       cmocka_unit_test(test_parameters_mixed),
                                       cmocka_unit_test(test_ramp_for_step),
                                       cmocka_unit_test(test_light_without_pi),
                                       cmocka_unit_test(test_direction_with_w_1),
                                       cmocka_unit_test(test_alpha_per_light),
                                       cmocka_unit_test(test_one_square_root)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
