/* anisotropy_test.c - stretched highlights: parameters, reflection, and the isotropic lobe of LUT lookups. */
#include "testing/test_support.h"

static const vec3 up = {0.0f, 0.0f, 1.0f};

static void test_parameters(void **state)
{
    (void)state;
    vec2 a = anisotropic_alpha(0.25f, 0.5f); /* strength^2 of the way from alpha to 1 along T */
    assert_true(a[0] == 0.4375f && a[1] == 0.25f);
    a = anisotropic_alpha(0.25f, 1.0f);
    assert_true(a[0] == 1.0f && a[1] == 0.25f);
    a = anisotropic_alpha(0.3f, 0.0f);
    assert_true(a[0] == 0.3f && a[1] == 0.3f);

    vec2 d = anisotropy_direction(vec2(1.0f, 0.0f), 0.0f);
    assert_true(d[0] == 1.0f && d[1] == 0.0f);
    d = anisotropy_direction(vec2(1.0f, 0.0f), 0.5f * PI); /* counter-clockwise: x to y */
    expect_near((double)d[1], 1.0, 1e-6, "a quarter turn");
    d = anisotropy_direction(vec2(0.3f, 0.4f), 0.0f);
    expect_near((double)d[0], 0.6, 1e-6, "unit");
    expect_near((double)length(anisotropy_direction(vec2(0.0f), 1.0f)), 0.0, 1e-6,
                "no direction, but no NaN");
}

/* Strength 0 bends only by the specification's last line, which applies to all; for a smooth surface of full
 * strength, R lies in the cone of reflections of a groove along T. */
static void test_reflection(void **state)
{
    (void)state;
    vec3 B = vec3(0.0f, 1.0f, 0.0f);
    test_rng rng = {3};
    for (int i = 0; i < 2000; ++i) {
        vec3 V = rng_direction(&rng);
        V[2] = fabsf(V[2]);
        vec3 mirror = reflect(-V, up);
        vec3 R = anisotropic_reflection(up, B, V, 0.0f, 0.0f);
        expect_near((double)length(R - mirror), 0.0, 1e-5, "strength 0, smooth: the mirror's");
        R = anisotropic_reflection(up, B, V, 0.0f, 0.5f);
        expect_near((double)length(R - normalize(mix(mirror, up, 0.25f))), 0.0, 1e-5,
                    "brought back to N by r^2");
        R = anisotropic_reflection(up, B, V, 1.0f, 1.0f);
        expect_near((double)length(R - up), 0.0, 1e-5, "rough: along the normal");
        R = anisotropic_reflection(up, B, V, 1.0f, 0.0f);
        vec3 grain = V - B * dot(V, B);
        if (length(grain) >
            1e-2f) /* the normal is V without its component along B: R has the mirrored angle to B */
            expect_near((double)dot(R, B), (double)-dot(V, B), 1e-4, "cone around B");
    }
    vec3 R = anisotropic_reflection(up, B, B, 1.0f, 0.0f);
    expect_near((double)length(R), 1.0, 1e-5, "V along B");
}

/* ---- the equivalent isotropic lobe ---- */

typedef struct split_sum {
    double A, B, E;
} split_sum;
static split_sum albedo(vec3 V, float ax, float ay, uint n)
{
    split_sum s = {0.0, 0.0, 0.0};
    for (uint i = 0; i < n; ++i) {
        vec3 H = sample_VNDF_GGX(hammersley(i, n) + 0.5f / (float)n, V, ax, ay), L = reflect(-V, H);
        if (L[2] <= 0.0f)
            continue;
        double w = (double)(V_SmithGGX_anisotropic(L, V, ax, ay) * 4.0f * L[2] * V[2] /
                            G1_SmithGGX_anisotropic(V, ax, ay));
        double grazing = (double)schlick_weight(dot(V, H));
        s.A += w * (1.0 - grazing) / n;
        s.B += w * grazing / n;
    }
    s.E = s.A + s.B;
    return s;
}
static split_sum substitute(vec3 V, vec2 alpha, uint n)
{
    vec2 p = anisotropic_table_point(V, alpha);
    float a = p[1] * p[1];
    return albedo(view_at(p[0]), a, a, n);
}

static void test_isotropic_is_its_own_substitute(void **state)
{
    (void)state;
    for (int i = 1; i <= 10; ++i) {
        vec3 V = normalize(vec3(0.3f, 0.5f, 0.1f * (float)i));
        vec2 p = anisotropic_table_point(V, vec2(0.09f, 0.09f));
        expect_near((double)p[0], (double)V[2], 1e-6, "N.V");
        expect_near((double)p[1], 0.3, 1e-6, "perceptual roughness");
        vec2 q = anisotropic_table_bound(vec2(0.5f, 0.2f), V, vec2(0.09f, 0.09f));
        expect_near((double)q[0], 0.5, 1e-6, "A");
        expect_near((double)q[1], 0.2, 1e-6, "B");
    }
}

/* Albedos by quadrature in long double, and a grid of them: the equivalent lobe within 0.04, the bounds never below. */
static void test_substitute_albedo(void **state)
{
    (void)state;
    const uint n = 1u << 12u;
    const vec2 golden = vec2(0.4375f, 0.25f);
    expect_near(substitute(vec3(0.8660254f, 0.0f, 0.5f), golden, n).E, 0.798663456599, 0.015, "along T");
    expect_near(substitute(vec3(0.0f, 0.8660254f, 0.5f), golden, n).E, 0.779309017473, 0.015, "along B");
    const float roughness[] = {0.05f, 0.1f, 0.25f, 0.5f, 0.75f},
                strength[] = {0.1f, 0.25f, 0.5f, 0.75f, 1.0f};
    const float NdotV[] = {0.05f, 0.1f, 0.2f, 0.4f, 0.6f, 0.8f, 1.0f};
    double worst = 0.0, squares = 0.0, lowest_E = 1.0, lowest_B = 1.0, highest_B = 0.0;
    int count = 0;
    for (size_t r = 0; r < COUNT_OF(roughness); ++r)
        for (size_t s = 0; s < COUNT_OF(strength); ++s)
            for (size_t v = 0; v < COUNT_OF(NdotV); ++v)
                for (int azimuth = 0; azimuth <= 6; ++azimuth) {
                    vec2 alpha = anisotropic_alpha(roughness[r] * roughness[r], strength[s]);
                    float across = sqrt(1.0f - NdotV[v] * NdotV[v]), phi = (float)azimuth * PI / 12.0f;
                    vec3 V = vec3(across * cosf(phi), across * sinf(phi), NdotV[v]);
                    split_sum is = albedo(V, alpha[0], alpha[1], n), stand_in = substitute(V, alpha, n);
                    vec2 bound =
                        anisotropic_table_bound(vec2((float)stand_in.A, (float)stand_in.B), V, alpha);
                    worst = fmax(worst, fabs(stand_in.E - is.E));
                    squares += (stand_in.E - is.E) * (stand_in.E - is.E);
                    lowest_E = fmin(lowest_E, (double)(bound[0] + bound[1]) - is.E);
                    lowest_B = fmin(lowest_B, (double)bound[1] - is.B);
                    highest_B = fmax(highest_B, (double)bound[1] - is.B);
                    ++count;
                }
    print_message("substitute for E: worst %.3f, root mean square %.4f; bound at least %.4f above\n"
                  "bound of B: %.4f to %.4f above\n",
                  worst, sqrt(squares / count), lowest_E, lowest_B, highest_B);
    assert_true(worst < 0.045 && sqrt(squares / count) < 0.014);
    assert_true(lowest_E > -1e-3 && lowest_B > -4e-3 && highest_B < 0.35);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_parameters), cmocka_unit_test(test_reflection),
                                       cmocka_unit_test(test_isotropic_is_its_own_substitute),
                                       cmocka_unit_test(test_substitute_albedo)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
