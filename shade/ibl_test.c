/* ibl_test.c - split sum, prefilter and their use, against golden numbers and against each other. */
#include "testing/test_support.h"

static const vec3 up = {0.0f, 0.0f, 1.0f};

/* Sums in double, to benefit from many samples. */
typedef vec2 dfg_sampler(uint i, uint n, float perceptual_roughness, float NdotV);
static void mean_dfg(dfg_sampler *sample_of, float r, float NdotV, uint n, double out[2])
{
    out[0] = out[1] = 0.0;
    for (uint i = 0; i < n; ++i) {
        vec2 s = sample_of(i, n, r, NdotV);
        out[0] += (double)s[0] / n;
        out[1] += (double)s[1] / n;
    }
}

static const golden_table karis_A = {{0.2083021751, 0.7410566129, 0.9588389269, 0.9955539406, 0.9998871135},
                                     {0.3348617238, 0.6573372938, 0.9023494544, 0.9717336779, 0.9943317615},
                                     {0.6207420839, 0.6094113879, 0.7285344857, 0.8275376699, 0.8950418829},
                                     {0.6689271644, 0.5934679022, 0.5730121860, 0.5820536078, 0.6035684302},
                                     {0.5680998863, 0.4834797374, 0.4066814618, 0.3501073583, 0.3068192051}};
static const golden_table karis_B = {
    {0.6241453121, 0.2293014798, 0.03109024092, 0.001000351390, 8.345276001e-08},
    {0.3100523048, 0.1733474915, 0.03047090025, 0.001444991704, 2.633721512e-06},
    {0.1150523998, 0.06088431170, 0.01854642935, 0.002382582941, 2.416901948e-05},
    {0.04170322589, 0.02062533820, 0.006969620756, 0.001451518140, 4.453806361e-05},
    {0.01638167451, 0.007484773656, 0.002455630747, 5.815782034e-04, 3.361429473e-05}};

static void test_split_sum(void **state)
{
    (void)state;
    for (int r = 0; r < GOLDEN_ROUGHNESS_COUNT; ++r)
        for (int c = 0; c < GOLDEN_NDOTV_COUNT; ++c) {
            double at[2] = {(double)golden_roughness[r], (double)golden_NdotV[c]}, dfg[2];
            mean_dfg(dfg_sample, golden_roughness[r], golden_NdotV[c], 1u << 20u, dfg);
            expect_near(dfg[0], golden_A[r][c], 2.5e-4, "A correlated at %g, %g", at[0], at[1]);
            expect_near(dfg[1], golden_B[r][c], 2.5e-4, "B correlated at %g, %g", at[0], at[1]);
            mean_dfg(dfg_sample_karis, golden_roughness[r], golden_NdotV[c], 1u << 20u, dfg);
            expect_near(dfg[0], karis_A[r][c], 2.5e-4, "A Karis at %g, %g", at[0], at[1]);
            expect_near(dfg[1], karis_B[r][c], 2.5e-4, "B Karis at %g, %g", at[0], at[1]);
            /* the loops of the shader library, with the 1024 samples of the notes: accurate to a few per
             * mille */
            vec2 loop = integrate_dfg(golden_roughness[r], golden_NdotV[c], 1024u);
            expect_near((double)loop[0], golden_A[r][c], 1.2e-2, "integrate_dfg at %g, %g", at[0], at[1]);
            loop = integrate_dfg_karis(golden_roughness[r], golden_NdotV[c], 1024u);
            expect_near((double)loop[1], karis_B[r][c], 1.2e-2, "integrate_dfg_karis at %g, %g", at[0],
                        at[1]);
        }
    /* a division by 0 in the notes */
    for (float r = 0.0f; r <= 1.0f; r += 0.25f) {
        vec2 edge = integrate_dfg(r, 0.0f, 64u);
        assert_true(isfinite(edge[0]) && isfinite(edge[1]) && edge[0] >= 0.0f && edge[0] + edge[1] <= 1.1f);
    }
}

/* A band-limited environment P_l(L.R), l = 0 to 4, is scaled by k_l(alpha); a
 * constant is preserved. */
static void test_prefilter_bands(void **state)
{
    (void)state;
    const double rows[][6] = {
        {0.10, 0.998396210621, 0.998693503699, 0.996229938117, 0.992824773157, 0.988665743355},
        {0.25, 0.965686495978, 0.976092604298, 0.933738270618, 0.880606983182, 0.822958863625},
        {0.50, 0.762301701192, 0.867395662812, 0.662405687279, 0.460387585347, 0.305538297757},
        {0.75, 0.470932764969, 0.745131342455, 0.398824737791, 0.140121157544, 0.028984607620},
        {1.00, 0.250000000000, 0.666666666667, 0.250000000000, 0.0, -0.041666666667}};
    const uint n = 1u << 14u;
    vec3 R = normalize(vec3(0.3f, -0.8f, 0.4f));
    for (size_t row = 0; row < COUNT_OF(rows); ++row) {
        float r = (float)rows[row][0];
        double weight = 0.0, band[5] = {0};
        for (uint i = 0; i < n; ++i) {
            PrefilterSample s = prefilter_sample(i, n, r * r, R);
            double x = (double)dot(s.L, R), w = (double)s.weight;
            const double P[5] = {1.0, x, 1.5 * x * x - 0.5, (2.5 * x * x - 1.5) * x,
                                 ((35.0 * x * x - 30.0) * x * x + 3.0) / 8.0};
            weight += w;
            for (int l = 0; l < 5; ++l)
                band[l] += w * P[l];
        }
        expect_near(weight / n, rows[row][1], 2e-4, "mean of N.L, roughness %g", rows[row][0]);
        expect_near(band[0] / weight, 1.0, 1e-9, "a constant stays");
        for (int l = 1; l < 5; ++l)
            expect_near(band[l] / weight, rows[row][1 + l], 3e-4, "band %d, roughness %g", l, rows[row][0]);
    }
    PrefilterSample mirror = prefilter_sample(777u, 1024u, 0.0f, R);
    expect_near((double)dot(mirror.L, R), 1.0, 1e-6, "alpha 0 copies");
}

static void test_prefilter_lod(void **state)
{
    (void)state;
    const float texel = 4.0f * PI / (6.0f * 256.0f * 256.0f);
    /* a sample that covers one texel is read a level up; four times the texel, two levels up */
    expect_near((double)prefilter_lod(1.0f / (1024.0f * texel), 1024u, texel), 1.0, 1e-5, "one texel");
    expect_near((double)prefilter_lod(1.0f / (4096.0f * texel), 1024u, texel), 2.0, 1e-5, "four texels");
    assert_true(prefilter_lod(1e9f, 1024u, texel) == 0.0f);
    assert_true(isfinite(prefilter_lod(0.0f, 1024u, texel)));
    /* pdf is a density: the mean of 1 / pdf over the lobe of alpha 1 is the solid angle that the lobe covers */
    const uint n = 1u << 16u;
    double sum = 0.0;
    for (uint i = 0; i < n; ++i) {
        PrefilterSample s = prefilter_sample(i, n, 1.0f, up);
        sum += s.weight > 0.0f ? 1.0 / (double)s.pdf / n : 0.0;
    }
    expect_relative(sum, 2.0 * 3.14159265358979, 1e-3, "solid angle of the hemisphere");
}

/* The reference integrator in a uniform light is the split sum, for any frame. */
static void test_reference_integrator(void **state)
{
    (void)state;
    test_rng rng = {3};
    const uint n = 1u << 15u;
    vec3 F0 = vec3(0.04f, 0.5f, 1.0f), F90 = vec3(1.0f);
    for (int r = 0; r < GOLDEN_ROUGHNESS_COUNT; ++r)
        for (int c = 0; c < GOLDEN_NDOTV_COUNT; ++c) {
            vec3 N = rng_direction(&rng);
            vec3 V = mul(basis_from_normal(N), view_at(golden_NdotV[c]));
            double sum[3] = {0};
            for (uint i = 0; i < n; ++i) {
                SpecularSample s = specular_ibl_sample(i, n, F0, F90, golden_roughness[r], N, V);
                for (int k = 0; k < 3; ++k)
                    sum[k] += (double)s.weight[k] / n;
                assert_true(s.weight[0] >= 0.0f && isfinite(s.pdf));
            }
            vec3 split = approximate_specular_ibl(F0, F90, vec3(1.0f), golden_dfg(r, c));
            for (int k = 0; k < 3; ++k)
                expect_near(sum[k], (double)split[k], 1.5e-3, "SpecularIBL at %g, %g",
                            (double)golden_roughness[r], (double)golden_NdotV[c]);
            /* its weight is BRDF times cosine over its density */
            Surface s = surface_from_metallic_roughness(N, F0, 1.0f, golden_roughness[r]);
            SpecularSample one = specular_ibl_sample(5u, 16u, F0, F90, golden_roughness[r], N, V);
            vec3 f_cos = surface_brdf_cos(s, V, one.L);
            expect_near((double)one.weight[1], (double)(f_cos[1] / one.pdf),
                        2e-3 * (double)one.weight[1] + 1e-6, "weight");
        }
}

/* Error of the split sum in non-uniform light: N = V = R replaces the stretched highlight of a grazing
 * view by a round one. A gradient, L = 1 + L.z, both ways. */
static void test_split_sum_error(void **state)
{
    (void)state;
    const uint n = 1u << 14u;
    double worst = 0.0;
    for (int r = 0; r < GOLDEN_ROUGHNESS_COUNT; ++r)
        for (int c = 1; c < GOLDEN_NDOTV_COUNT; ++c) {
            vec3 V = view_at(golden_NdotV[c]), R = reflect(-V, up);
            double exact = 0.0, weight = 0.0, filtered = 0.0;
            for (uint i = 0; i < n; ++i) {
                SpecularSample s =
                    specular_ibl_sample(i, n, vec3(1.0f), vec3(1.0f), golden_roughness[r], up, V);
                exact += (double)(s.weight[0] * (1.0f + s.L[2])) / n;
                PrefilterSample p = prefilter_sample(i, n, golden_roughness[r] * golden_roughness[r], R);
                weight += (double)p.weight;
                filtered += (double)(p.weight * (1.0f + p.L[2]));
            }
            vec3 split = approximate_specular_ibl(vec3(1.0f), vec3(1.0f), vec3((float)(filtered / weight)),
                                                  golden_dfg(r, c));
            double error = fabs((double)split[0] / exact - 1.0);
            worst = error > worst ? error : worst;
        }
    assert_true(worst > 0.2 && worst < 0.3); /* 27 %, at grazing views of rough surfaces */
}

/* ---- direction of the lookup ---- */

/* Two lamps on a gradient. */
static double lamps(vec3 d)
{
    double a = (double)dot(d, vec3(0.48f, 0.8f, 0.36f)), b = (double)dot(d, vec3(-0.6f, 0.64f, -0.48f));
    return 0.4 + 0.3 * (double)d[1] + 9.0 * exp(40.0 * (a - 1.0)) + 12.0 * exp(80.0 * (b - 1.0));
}

/* What a lobe reflects of the lamps over what it reflects of uniform light. */
static double reflected_lamps(vec3 N, vec3 V, float roughness, float F0)
{
    const uint n = 1u << 12u;
    double sum = 0.0, weight = 0.0;
    for (uint i = 0; i < n; ++i) {
        SpecularSample s = specular_ibl_sample(i, n, vec3(F0), vec3(1.0f), roughness, N, V);
        if (s.weight[0] > 0.0f)
            sum += (double)s.weight[0] * lamps(s.L);
        weight += (double)s.weight[0];
    }
    return sum / weight;
}
static double prefiltered_lamps(vec3 R, float roughness)
{
    const uint n = 1u << 12u;
    double sum = 0.0, weight = 0.0;
    for (uint i = 0; i < n; ++i) {
        PrefilterSample p = prefilter_sample(i, n, alpha_from_roughness(roughness), R);
        if (p.weight > 0.0f)
            sum += (double)p.weight * lamps(p.L);
        weight += (double)p.weight;
    }
    return sum / weight;
}

/* RMS over RMS light of lookups along R (out[0]) and in the bent direction (out[1]), over views of many normals. */
static void lookup_errors(float roughness, float F0, double out[2])
{
    const float NdotV[] = {0.05f, 0.1f, 0.2f, 0.35f, 0.5f, 0.7f, 0.85f, 0.97f};
    test_rng rng = {71};
    double square[3] = {0};
    for (int i = 0; i < 16; ++i)
        for (size_t v = 0; v < COUNT_OF(NdotV); ++v) {
            vec3 N = rng_direction(&rng);
            vec3 V = mul(basis_from_normal(N), view_at(NdotV[v]));
            Surface s = surface_from_metallic_roughness(N, vec3(F0), 1.0f, roughness);
            double exact = reflected_lamps(N, V, roughness, F0);
            square[2] += exact * exact;
            for (int k = 0; k < 2; ++k) {
                vec3 L = surface_reflection(s, V, k == 0 ? ENERGY_GLTF : ENERGY_CONSERVING);
                double off = prefiltered_lamps(L, roughness) - exact;
                square[k] += off * off;
            }
        }
    out[0] = sqrt(square[0] / square[2]);
    out[1] = sqrt(square[1] / square[2]);
}

/* Against quadrature, bent lookups have two thirds of the error of those along R at most where a metal is rough, and
 * are nowhere worse. */
static void test_lookup_direction(void **state)
{
    (void)state;
    const float rough[] = {0.5f, 0.6f, 0.75f, 1.0f}, F0[] = {1.0f, 0.5f, 0.04f};
    for (size_t f = 0; f < COUNT_OF(F0); ++f)
        for (size_t r = 0; r < COUNT_OF(rough); ++r) {
            double error[2];
            lookup_errors(rough[r], F0[f], error);
            print_message("F0 %.2f, roughness %.2f: RMS error %.3f along R, %.3f bent\n", (double)F0[f],
                          (double)rough[r], error[0], error[1]);
            assert_true(error[1] < (F0[f] > 0.1f ? 2.0 / 3.0 : 1.0) * error[0]);
        }
}

/* R for mirrors and in ENERGY_GLTF, bit for bit; N for the roughest metal; between them otherwise, of length 1. */
static void test_lookup_limits(void **state)
{
    (void)state;
    test_rng rng = {5};
    for (int i = 0; i < 20000; ++i) {
        vec3 N = rng_direction(&rng), V = rng_direction(&rng), R = normalize(reflect(-V, N));
        float alpha = rng_float(&rng), F0 = rng_float(&rng), NdotV = clamp(dot(N, V), 0.0f, 1.0f);
        vec3 mirror = specular_reflection(N, V, 0.0f, F0, ENERGY_CONSERVING);
        vec3 gltf = specular_reflection(N, V, alpha, F0, ENERGY_GLTF);
        vec3 white = specular_reflection(N, V, 1.0f, 1.0f, ENERGY_CONSERVING);
        vec3 bent = specular_reflection(N, V, alpha, F0, ENERGY_CONSERVING);
        for (int c = 0; c < 3; ++c) {
            assert_true(gltf[c] == R[c]);
            expect_near((double)mirror[c], (double)R[c], 1e-6, "a mirror");
            expect_near((double)white[c], (double)N[c], 1e-6, "alpha 1");
        }
        float bend = reflection_bend(alpha, NdotV, F0);
        assert_true(bend >= 0.0f && bend <= 1.0f);
        expect_near((double)length(bent), 1.0, 1e-5, "length");
        assert_true(dot(bent, N) > dot(R, N) - 1e-5f);
    }
    vec3 behind = specular_reflection(up, -up, 0.5f, 1.0f, ENERGY_CONSERVING);
    expect_near((double)length(behind), 1.0, 1e-5, "an eye behind the surface");
    Surface dark = surface_from_gltf(up, vec3(1.0f), 0.0f, 0.5f, 1.5f, 0.0f, vec3(1.0f), 1.0f, vec3(0.0f));
    assert_true(surface_facing_reflectance(dark) == 0.0f);
    dark.metallic = 1.0f;
    expect_near((double)surface_facing_reflectance(dark), 1.0, 1e-6, "a white metal");
}

/* Fdez-Aguera's total for four F0 at roughness .75, N.V .5, with k_S = F0 and
 * roughness-dependent. */
static void test_multiscatter(void **state)
{
    (void)state;
    const double rows[][3] = {{1.0, 1.0, 1.0},
                              {0.766, 0.6908025270, 0.6908025270},
                              {0.336, 0.2607461691, 0.2607461691},
                              {0.04, 0.0357014472, 0.0401255970}};
    vec2 dfg = golden_dfg(3, 2);
    for (size_t i = 0; i < COUNT_OF(rows); ++i) {
        vec3 F0 = vec3((float)rows[i][0]), one = vec3(1.0f);
        MultiScatter m = multiscatter_ibl(F0, F0, one, dfg);
        expect_relative(m.single[0] + m.multiple[0], rows[i][1], 2e-6, "k_S = F0");
        expect_relative(specular_albedo(F0, one, dfg)[0], rows[i][1], 2e-6, "specular_albedo is the same");
        m = multiscatter_ibl(F_Schlick_roughness(F0, one, 0.75f, 0.5f), F0, one, dfg);
        expect_relative(m.single[1] + m.multiple[1], rows[i][2], 2e-6, "roughness-dependent");
    }
}

/* A white surface in a uniform light is white, in both modes; none returns more. */
static void test_surface_furnace(void **state)
{
    (void)state;
    test_rng rng = {41};
    for (int i = 0; i < 100000; ++i) {
        int r = (int)(rng_uint(&rng) % GOLDEN_ROUGHNESS_COUNT),
            c = (int)(rng_uint(&rng) % GOLDEN_NDOTV_COUNT);
        float metallic = rng_float(&rng), ior = 1.0f + 2.0f * rng_float(&rng), specular = rng_float(&rng);
        vec3 base = i % 2 == 0 ? vec3(1.0f) : rng_color(&rng);
        Surface s = surface_from_gltf(up, base, metallic, golden_roughness[r], ior, specular, vec3(1.0f),
                                      1.0f, vec3(0.0f));
        for (int energy = ENERGY_CONSERVING; energy <= ENERGY_GLTF; ++energy) {
            vec3 out = surface_ibl(s, golden_NdotV[c], golden_dfg(r, c), vec3(1.0f), vec3(1.0f), energy);
            for (int k = 0; k < 3; ++k) {
                assert_true(out[k] >= 0.0f && out[k] <= 1.00001f);
                if (i % 2 == 0)
                    expect_near((double)out[k], 1.0, 1e-5, "white stays white");
            }
        }
    }
}

/* Khronos' renderer (with its own order of terms) for a gray specular color, where both agree. */
static vec3 khronos_fresnel(vec3 F0, float specular_weight, float roughness, float NdotV, vec2 dfg)
{
    vec3 k_S = F0 + (max(vec3(1.0f - roughness), F0) - F0) * schlick_weight(NdotV);
    vec3 single = (k_S * dfg[0] + dfg[1]) * specular_weight;
    float Ems = 1.0f - (dfg[0] + dfg[1]);
    vec3 F_mean = (F0 + (1.0f - F0) / 21.0f) * specular_weight;
    return single + single * F_mean * Ems / (1.0f - F_mean * Ems);
}
static void test_khronos(void **state)
{
    (void)state;
    test_rng rng = {43};
    for (int i = 0; i < 20000; ++i) {
        int r = (int)(rng_uint(&rng) % GOLDEN_ROUGHNESS_COUNT),
            c = (int)(rng_uint(&rng) % GOLDEN_NDOTV_COUNT);
        float metallic = rng_float(&rng), ior = 1.0f + rng_float(&rng), specular = rng_float(&rng);
        float roughness = golden_roughness[r], NdotV = golden_NdotV[c];
        vec3 base = rng_color(&rng), radiance = rng_color(&rng) * 9.0f, irradiance = rng_color(&rng);
        Surface s =
            surface_from_gltf(up, base, metallic, roughness, ior, specular, vec3(1.0f), 0.7f, vec3(0.0f));
        vec2 dfg = golden_dfg(r, c);
        vec3 out = surface_ibl(s, NdotV, dfg, radiance, irradiance, ENERGY_GLTF);
        vec3 metal = khronos_fresnel(base, 1.0f, roughness, NdotV, dfg) * radiance;
        vec3 dielectric = mix(base * irradiance, radiance,
                              khronos_fresnel(vec3(F0_from_ior(ior)), specular, roughness, NdotV, dfg));
        vec3 expected = mix(dielectric, metal, metallic) * 0.7f; /* occlusion dims all of it */
        for (int k = 0; k < 3; ++k)
            expect_near((double)out[k], (double)expected[k], 1e-5 * (1.0 + (double)expected[k]), "channel %d",
                        k);
    }
}

/* A uniform environment and a great many punctual lights give the same in conserving mode: one surface, not
 * two. */
static void test_direct_equals_image_based(void **state)
{
    (void)state;
    const uint n = 1u << 15u;
    for (int r = 1; r < GOLDEN_ROUGHNESS_COUNT; ++r)
        for (int c = 0; c < GOLDEN_NDOTV_COUNT; ++c) {
            Surface s =
                surface_from_metallic_roughness(up, vec3(0.9f, 0.5f, 0.1f), 0.4f, golden_roughness[r]);
            vec3 V = view_at(golden_NdotV[c]);
            vec2 dfg = golden_dfg(r, c);
            double direct[3] = {0};
            for (uint i = 0; i < n; ++i) { /* half by visible normals, half by the cosine, balanced */
                vec2 u = hammersley(i / 2u, n / 2u);
                vec3 L = i % 2u ? sample_cosine(u) : reflect(-V, sample_VNDF_GGX(u, V, s.alpha, s.alpha));
                if (L[2] <= 0.0f)
                    continue;
                vec3 H = normalize(V + L);
                float pdf = 0.5f * pdf_cosine(L[2]) +
                            0.5f * pdf_VNDF_GGX(V, H, s.alpha, s.alpha) / (4.0f * dot(V, H));
                vec3 f = surface_brdf_cos_energy(s, V, L, ENERGY_CONSERVING, dfg);
                for (int k = 0; k < 3; ++k)
                    direct[k] += (double)(f[k] / pdf) / n;
            }
            vec3 image = surface_ibl(s, golden_NdotV[c], dfg, vec3(1.0f), vec3(1.0f), ENERGY_CONSERVING);
            for (int k = 0; k < 3; ++k)
                expect_near(direct[k], (double)image[k], 2e-3, "roughness %g, N.V %g",
                            (double)golden_roughness[r], (double)golden_NdotV[c]);
        }
}

/* Rays that leave the wall of an integrating sphere with an opening of share A end there with probability A, as the
 * cosine from a sphere's wall is uniform over the sphere; each bounce keeps the albedo. */
static void test_interreflection(void **state)
{
    (void)state;
    for (int i = 1; i <= 10; i++)
        for (int k = 0; k <= 10; k++) {
            double open = 0.1 * i;
            double albedo = 0.1 * k;
            double reaches = 0.0;
            double walks = 1.0;
            for (int bounce = 0; bounce < 1000; bounce++, walks *= (1.0 - open) * albedo)
                reaches += walks * open;
            vec3 got = ambient_interreflection((float)open, vec3((float)albedo));
            expect_near((double)got[0], reaches, 1e-5, "openness %g, albedo %g", open, albedo);
        }
    assert_true(ambient_interreflection(0.0f, vec3(1.0f))[0] == 0.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_split_sum),       cmocka_unit_test(test_prefilter_bands),
        cmocka_unit_test(test_prefilter_lod),   cmocka_unit_test(test_reference_integrator),
        cmocka_unit_test(test_split_sum_error), cmocka_unit_test(test_lookup_direction),
        cmocka_unit_test(test_lookup_limits),   cmocka_unit_test(test_multiscatter),
        cmocka_unit_test(test_surface_furnace), cmocka_unit_test(test_interreflection),
        cmocka_unit_test(test_khronos),         cmocka_unit_test(test_direct_equals_image_based)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
