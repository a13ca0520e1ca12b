/* surface_test.c - the glTF surface: parameters, reciprocity, white furnace in both energy modes, robustness. */
#include "testing/test_support.h"

static const vec3 up = {0.0f, 0.0f, 1.0f};

static Surface white(float metallic, float perceptual_roughness)
{
    return surface_from_metallic_roughness(up, vec3(1.0f), metallic, perceptual_roughness);
}

static void test_parameters(void **state)
{
    (void)state;
    Surface s = surface_from_metallic_roughness(up, vec3(0.5f, 2.0f, -1.0f), 0.25f, 0.5f);
    assert_true(s.alpha == 0.25f && s.F90 == 1.0f && s.occlusion == 1.0f && s.emissive[1] == 0.0f);
    assert_true(s.base_color[0] == 0.5f && s.base_color[1] == 1.0f && s.base_color[2] == 0.0f);
    expect_near((double)s.F0[0], 0.04, 1e-8, "F0 of ior 1.5");

    expect_relative(dielectric_F0(1.33f, 1.0f, vec3(1.0f))[0], 0.0200593122, 2e-6, "water");
    expect_relative(dielectric_F0(2.42f, 1.0f, vec3(1.0f))[0], 0.1723949249, 1e-6, "diamond");
    /* clamped to 1 before the factor: 0.04 * 50 = 2 -> 1 -> 0.5 */
    vec3 F0 = dielectric_F0(1.5f, 0.5f, vec3(50.0f, 1.0f, 0.0f));
    expect_relative(F0[0], 0.5, 1e-6, "clamp before factor");
    expect_relative(F0[1], 0.02, 1e-6, "specular factor");
    assert_true(F0[2] == 0.0f);
    /* ior 0: specular-glossiness compatibility, F0 is the specular color */
    F0 = dielectric_F0(0.0f, 1.0f, vec3(0.2f, 0.6f, 1.0f));
    assert_true(F0[0] == 0.2f && F0[1] == 0.6f && F0[2] == 1.0f);

    assert_true(occlusion_from_texel(0.25f, 1.0f) == 0.25f && occlusion_from_texel(0.25f, 0.0f) == 1.0f);
    assert_true(occlusion_from_texel(0.5f, 0.5f) == 0.75f);
    assert_true(face_forward(up, up, vec3(0.0f, 0.6f, 0.8f))[2] == 1.0f);
    assert_true(face_forward(up, up, vec3(0.0f, 0.6f, -0.8f))[2] == -1.0f);
    assert_true(max3(vec3(0.1f, 0.7f, 0.3f)) == 0.7f);
}

/* The definition of glTF 2.0, appendix B, term by term. */
static void test_specification_formula(void **state)
{
    (void)state;
    test_rng rng = {11};
    for (int i = 0; i < 20000; ++i) {
        vec3 c = rng_color(&rng);
        float metallic = rng_float(&rng), r = 0.1f + 0.9f * rng_float(&rng);
        vec3 V = rng_direction(&rng), L = rng_direction(&rng);
        V[2] = max(fabsf(V[2]), 0.01f);
        L[2] = max(fabsf(L[2]), 0.01f);
        V = normalize(V);
        L = normalize(L);
        vec3 H = normalize(V + L);
        float fw = schlick_weight(dot(V, H));
        float specular = D_GGX(H[2], r * r) * V_SmithGGX(L[2], V[2], r * r);
        vec3 f = surface_brdf_cos(surface_from_metallic_roughness(up, c, metallic, r), V, L);
        for (int k = 0; k < 3; ++k) {
            float dielectric = mix(c[k] * INV_PI, specular, 0.04f + 0.96f * fw);
            float metal = specular * (c[k] + (1.0f - c[k]) * fw);
            float expected = mix(dielectric, metal, metallic) * L[2];
            expect_near((double)f[k], (double)expected, 1e-3 * (double)expected + 1e-7, "channel %d", k);
        }
    }
}

static void test_specular_extension(void **state)
{
    (void)state;
    vec3 V = normalize(vec3(0.9f, 0.0f, 0.3f)), L = normalize(vec3(-0.7f, 0.4f, 0.3f));
    /* specular 0: Lambert only */
    Surface s = surface_from_gltf(up, vec3(0.8f), 0.0f, 0.3f, 1.5f, 0.0f, vec3(1.0f), 1.0f, vec3(0.0f));
    expect_relative(surface_brdf_cos(s, V, L)[0], 0.8 / 3.14159265358979 * (double)L[2], 2e-6, "Lambert");
    /* a colored F0 weights the base by its largest channel: no complementary color in the diffuse light */
    s = surface_from_gltf(up, vec3(0.8f), 0.0f, 0.3f, 1.5f, 1.0f, vec3(20.0f, 1.0f, 1.0f), 1.0f, vec3(0.0f));
    SurfaceLobes lobes = surface_lobes_cos(s, V, L, ENERGY_GLTF, vec2(0.0f));
    assert_true(lobes.diffuse[0] == lobes.diffuse[1] && lobes.specular[0] > lobes.specular[1]);
    vec3 H = normalize(V + L);
    double F = (double)F_Schlick1(0.8f, 1.0f, dot(V, H));
    expect_relative(lobes.diffuse[2], 0.8 / 3.14159265358979 * (double)L[2] * (1.0 - F), 1e-5, "base weight");
    /* independent of the metal */
    Surface metal = s, plain = white(1.0f, 0.3f);
    metal.metallic = 1.0f;
    metal.base_color = vec3(1.0f);
    assert_true(surface_brdf_cos(metal, V, L)[1] == surface_brdf_cos(plain, V, L)[1]);
}

/* f(V, L) = f(L, V) in glTF mode; the conserving mode weights with the albedo at V and is not. */
static void test_reciprocity(void **state)
{
    (void)state;
    test_rng rng = {5};
    for (int i = 0; i < 10000; ++i) {
        float roughness = 0.05f + 0.95f * rng_float(&rng);
        Surface s = surface_from_metallic_roughness(up, rng_color(&rng), rng_float(&rng), roughness);
        vec3 V = rng_direction(&rng), L = rng_direction(&rng);
        V[2] = max(fabsf(V[2]), 1e-3f);
        L[2] = max(fabsf(L[2]), 1e-3f);
        V = normalize(V);
        L = normalize(L);
        vec3 there = surface_brdf_cos(s, V, L) / L[2], back = surface_brdf_cos(s, L, V) / V[2];
        for (int k = 0; k < 3; ++k)
            expect_near((double)there[k], (double)back[k], 1e-6 * (1.0 + (double)there[k]), "reciprocity");
    }
}

/* Albedo in a uniform light of 1: specular part by visible normals, diffuse part by the cosine. */
typedef struct furnace {
    double specular[3], diffuse[3], total[3];
} furnace;
static furnace white_furnace(Surface s, float NdotV, int energy, vec2 dfg, uint n)
{
    furnace f = {{0}, {0}, {0}};
    vec3 V = view_at(NdotV);
    for (uint i = 0; i < n; ++i) {
        vec2 u = hammersley(i, n);
        u[0] += 0.5f / (float)n;
        vec3 H = sample_VNDF_GGX(u, V, s.alpha, s.alpha);
        vec3 L = reflect(-V, H);
        vec3 d = sample_cosine(u);
        vec3 specular = vec3(0.0f);
        if (L[2] > 0.0f)
            specular = surface_lobes_cos(s, V, L, energy, dfg).specular *
                       (4.0f * dot(V, H) / pdf_VNDF_GGX(V, H, s.alpha, s.alpha));
        vec3 diffuse = surface_lobes_cos(s, V, d, energy, dfg).diffuse / pdf_cosine(d[2]);
        for (int k = 0; k < 3; ++k) {
            f.specular[k] += (double)specular[k] / n;
            f.diffuse[k] += (double)diffuse[k] / n;
        }
    }
    for (int k = 0; k < 3; ++k)
        f.total[k] = f.specular[k] + f.diffuse[k];
    return f;
}

/* A property of glTF's mix, not of this code: the base is weighted with 1 - F(V.H), and at a grazing view
 * V.H can be large although most light was already reflected at the interface; so a white dielectric
 * returns up to
 * 1.68 of the incident light. Khronos' renderer does the same; pinned so that a change shows. */
static void test_furnace_gltf_dielectric(void **state)
{
    (void)state;
    static const double diffuse[GOLDEN_NDOTV_COUNT] = {0.936589192751, 0.947563419901, 0.955241459155,
                                                       0.958727673222, 0.959921387385};
    static const golden_table total = {{1.67995085, 1.21424302, 1.02537829, 0.99968580, 0.99991741},
                                       {1.39940655, 1.18142040, 1.02610626, 0.99992222, 0.99975174},
                                       {1.13165450, 1.05876114, 1.01098540, 0.99699897, 0.99658016},
                                       {1.03530015, 1.00417207, 0.98991218, 0.98561879, 0.98504255},
                                       {1.00130617, 0.98191025, 0.97613840, 0.97391649, 0.97222777}};
    double largest = 0.0;
    for (int r = 0; r < GOLDEN_ROUGHNESS_COUNT; ++r)
        for (int c = 0; c < GOLDEN_NDOTV_COUNT; ++c) {
            furnace f = white_furnace(white(0.0f, golden_roughness[r]), golden_NdotV[c], ENERGY_GLTF,
                                      vec2(0.0f), 1u << 15u);
            double at[2] = {(double)golden_roughness[r], (double)golden_NdotV[c]};
            expect_near(f.diffuse[1], diffuse[c], 2e-4, "diffuse part at %g, %g", at[0], at[1]);
            expect_near(f.specular[1], 0.04 * golden_A[r][c] + golden_B[r][c], 3e-4,
                        "specular part at %g, %g", at[0], at[1]);
            expect_near(f.total[1], total[r][c], 4e-4, "total at %g, %g", at[0], at[1]);
            largest = f.total[1] > largest ? f.total[1] : largest;
        }
    assert_true(largest > 1.67 && largest < 1.69);
}

/* A metal in glTF mode never gains energy; it loses multiple scattering: E of the golden table. */
static void test_furnace_gltf_metal(void **state)
{
    (void)state;
    for (int r = 0; r < GOLDEN_ROUGHNESS_COUNT; ++r)
        for (int c = 0; c < GOLDEN_NDOTV_COUNT; ++c) {
            furnace f = white_furnace(white(1.0f, golden_roughness[r]), golden_NdotV[c], ENERGY_GLTF,
                                      vec2(0.0f), 1u << 14u);
            expect_near(f.total[0], golden_A[r][c] + golden_B[r][c], 6e-4, "metal at %g, %g",
                        (double)golden_roughness[r], (double)golden_NdotV[c]);
            assert_true(f.total[0] < 1.0005);
        }
}

/* A white surface returns exactly the incident light, for any metallic, specular and ior. */
static void test_furnace_conserving_is_white(void **state)
{
    (void)state;
    const float metallic[] = {0.0f, 0.5f, 1.0f}, ior[] = {1.5f, 1.0f, 2.42f}, specular[] = {1.0f, 0.3f, 0.0f};
    for (int r = 0; r < GOLDEN_ROUGHNESS_COUNT; ++r)
        for (int c = 0; c < GOLDEN_NDOTV_COUNT; ++c)
            for (size_t k = 0; k < COUNT_OF(metallic); ++k) {
                Surface s = surface_from_gltf(up, vec3(1.0f), metallic[k], golden_roughness[r], ior[k],
                                              specular[k], vec3(1.0f), 1.0f, vec3(0.0f));
                furnace f = white_furnace(s, golden_NdotV[c], ENERGY_CONSERVING, golden_dfg(r, c), 1u << 14u);
                expect_near(f.total[2], 1.0, 1e-3, "roughness %g, N.V %g, metallic %g",
                            (double)golden_roughness[r], (double)golden_NdotV[c], (double)metallic[k]);
            }
}

/* And no surface of any color exceeds it; the specular part is specular_albedo(). */
static void test_furnace_conserving_never_gains(void **state)
{
    (void)state;
    test_rng rng = {21};
    for (int i = 0; i < 200; ++i) {
        int r = i % GOLDEN_ROUGHNESS_COUNT, c = (i / GOLDEN_ROUGHNESS_COUNT) % GOLDEN_NDOTV_COUNT;
        float metallic = rng_float(&rng), ior = 1.0f + 2.0f * rng_float(&rng), specular = rng_float(&rng);
        vec3 base = rng_color(&rng);
        vec3 specular_color = rng_color(&rng) * 2.0f;
        Surface s = surface_from_gltf(up, base, metallic, golden_roughness[r], ior, specular, specular_color,
                                      1.0f, vec3(0.0f));
        vec2 dfg = golden_dfg(r, c);
        furnace f = white_furnace(s, golden_NdotV[c], ENERGY_CONSERVING, dfg, 1u << 12u);
        vec3 albedo = mix(specular_albedo(s.F0, vec3(s.F90), dfg),
                          specular_albedo(s.base_color, vec3(1.0f), dfg), metallic);
        for (int k = 0; k < 3; ++k) {
            assert_true(f.total[k] <= 1.002);
            expect_near(f.specular[k], (double)albedo[k], 3e-3, "specular albedo");
        }
    }
}

static vec3 nasty_direction(test_rng *rng)
{
    switch (rng_uint(rng) % 8u) {
    case 0:
        return vec3(0.0f, 0.0f, 1.0f);
    case 1:
        return vec3(0.0f, 0.0f, -1.0f);
    case 2:
        return vec3(1.0f, 0.0f, 0.0f);
    case 3:
        return vec3(-1.0f, 0.0f, -0.0f);
    case 4:
        return normalize(vec3(1.0f, 0.0f, 1e-30f));
    case 5:
        return normalize(vec3(-1.0f, 1e-20f, 1e-6f));
    default:
        return rng_direction(rng);
    }
}
static float nasty_unit(test_rng *rng)
{
    const float values[] = {0.0f, 1.0f, -0.0f, 1e-40f, 1e-20f, 0.5f};
    uint32_t k = rng_uint(rng) % 12u;
    return k < COUNT_OF(values) ? values[k] : rng_float(rng);
}

static void test_positive_and_finite(void **state)
{
    (void)state;
    test_rng rng = {31};
    for (int i = 0; i < 1000000; ++i) {
        vec3 N = nasty_direction(&rng), V = nasty_direction(&rng), L = nasty_direction(&rng);
        float metallic = nasty_unit(&rng), roughness = nasty_unit(&rng), ior = 3.0f * nasty_unit(&rng);
        float specular = nasty_unit(&rng);
        vec3 base = rng_color(&rng);
        vec3 specular_color = rng_color(&rng) * 30.0f;
        Surface s =
            surface_from_gltf(N, base, metallic, roughness, ior, specular, specular_color, 1.0f, vec3(0.0f));
        float A = rng_float(&rng), B = (1.0f - A) * rng_float(&rng);
        vec3 f = surface_brdf_cos(s, V, L),
             g = surface_brdf_cos_energy(s, V, L, ENERGY_CONSERVING, vec2(A, B));
        assert_true(is_finite3(f) && is_finite3(g));
        for (int k = 0; k < 3; ++k)
            assert_true(f[k] >= 0.0f && g[k] >= -1e-6f);
        if (dot(N, L) <= 0.0f)
            assert_true(f[0] == 0.0f && g[1] == 0.0f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_parameters),
        cmocka_unit_test(test_specification_formula),
        cmocka_unit_test(test_specular_extension),
        cmocka_unit_test(test_reciprocity),
        cmocka_unit_test(test_furnace_gltf_dielectric),
        cmocka_unit_test(test_furnace_gltf_metal),
        cmocka_unit_test(test_furnace_conserving_is_white),
        cmocka_unit_test(test_furnace_conserving_never_gains),
        cmocka_unit_test(test_positive_and_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
