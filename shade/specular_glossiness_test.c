/* specular_glossiness_test.c - the archived extension against its own formulas. */
#include "testing/test_support.h"

static const vec3 up = {0.0f, 0.0f, 1.0f};

/* KHR_materials_pbrSpecularGlossiness, appendix: F0 = specular, alpha = (1 - glossiness)^2, diffuse weighted
 * with 1 - max3 of the reflectance; at normal incidence that is its c_diff = diffuse (1 - max3(specular)). */
static void test_formulas(void **state)
{
    (void)state;
    test_rng rng = {31};
    for (int i = 0; i < 10000; ++i) {
        vec3 diffuse = rng_color(&rng), specular = rng_color(&rng);
        float glossiness = 0.9f * rng_float(&rng), alpha = (1.0f - glossiness) * (1.0f - glossiness);
        vec3 V = rng_direction(&rng), L = rng_direction(&rng);
        V[2] = max(fabsf(V[2]), 0.02f);
        L[2] = max(fabsf(L[2]), 0.02f);
        V = normalize(V);
        L = normalize(L);
        vec3 H = normalize(V + L);
        Surface s = surface_from_specular_glossiness(up, diffuse, specular, glossiness, 1.0f, vec3(0.0f));
        expect_near((double)s.alpha, (double)alpha, 1e-6, "alpha");
        vec3 f = surface_brdf_cos(s, V, L);
        vec3 F = F_Schlick(specular, vec3(1.0f), dot(V, H));
        for (int c = 0; c < 3; ++c) {
            double expected = (double)(F[c] * D_GGX(H[2], alpha) * V_SmithGGX(L[2], V[2], alpha) +
                                       (1.0f - max3(F)) * diffuse[c] * INV_PI) *
                              (double)L[2];
            expect_near((double)f[c], expected, 2e-3 * expected + 1e-6, "channel %d", c);
        }
    }
    Surface s =
        surface_from_specular_glossiness(up, vec3(0.5f), vec3(0.2f, 0.1f, 0.6f), 1.0f, 1.0f, vec3(0.0f));
    expect_near((double)(s.base_color[0] * (1.0f - max3(s.F0))), 0.5 * 0.4, 1e-6, "c_diff head on");
    assert_true(s.alpha == 0.0f && s.metallic == 0.0f && s.F90 == 1.0f);
}

/* A metal in either extension is the same metal; so is a dielectric of ior 1.5. */
static void test_equals_metallic_roughness(void **state)
{
    (void)state;
    vec3 V = normalize(vec3(0.5f, 0.2f, 0.7f)), L = normalize(vec3(-0.3f, 0.4f, 0.5f)),
         gold = vec3(1.0f, 0.7f, 0.3f);
    vec3 a = surface_brdf_cos(surface_from_specular_glossiness(up, vec3(0.0f), gold, 0.6f, 1.0f, vec3(0.0f)),
                              V, L);
    vec3 b = surface_brdf_cos(surface_from_metallic_roughness(up, gold, 1.0f, 0.4f), V, L);
    vec3 c = surface_brdf_cos(surface_from_specular_glossiness(up, gold, vec3(0.04f), 0.6f, 1.0f, vec3(0.0f)),
                              V, L);
    vec3 d = surface_brdf_cos(surface_from_metallic_roughness(up, gold, 0.0f, 0.4f), V, L);
    for (int k = 0; k < 3; ++k) {
        expect_relative(a[k], b[k], 1e-5, "metal");
        expect_relative(c[k], d[k], 1e-5, "dielectric");
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_formulas),
                                       cmocka_unit_test(test_equals_metallic_roughness)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
