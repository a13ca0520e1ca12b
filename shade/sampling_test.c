/* sampling_test.c - samplers against their densities. */
#include "testing/chi_square.h"

static const double pi = 3.14159265358979323846;

static void test_points(void **state)
{
    (void)state;
    const float first[8] = {0.0f, 0.5f, 0.25f, 0.75f, 0.125f, 0.625f, 0.375f, 0.875f};
    for (uint i = 0; i < 8; ++i) {
        vec2 p = hammersley(i, 16u);
        assert_true(p[0] == (float)i / 16.0f && p[1] == first[i]);
    }
    assert_true(radical_inverse(UINT32_MAX) < 1.0f);
    /* a (0, m, 2) net: every elementary interval of 256 points holds one */
    for (uint width = 1; width <= 256; width *= 2) {
        int hits[256] = {0};
        for (uint i = 0; i < 256; ++i) {
            vec2 p = hammersley(i, 256u);
            uint x = (uint)(p[0] * (float)width), y = (uint)(p[1] * (float)(256 / width));
            ++hits[x * (256 / width) + y];
        }
        for (int i = 0; i < 256; ++i)
            assert_int_equal(hits[i], 1);
    }
}

static void test_basis(void **state)
{
    (void)state;
    test_rng rng = {3};
    for (int i = 0; i < 20000; ++i) {
        vec3 N = i < 2 ? vec3(0.0f, 0.0f, i == 0 ? 1.0f : -1.0f) : rng_direction(&rng);
        if (i == 2)
            N = normalize(vec3(1e-6f, -1e-6f, -1.0f));
        mat3 b = basis_from_normal(N);
        vec3 x = COL(b, 0), y = COL(b, 1);
        expect_near((double)dot(x, y), 0.0, 1e-6, "orthogonal");
        expect_near((double)dot(x, x), 1.0, 2e-6, "unit");
        expect_near((double)dot(y, y), 1.0, 2e-6, "unit");
        expect_near((double)dot(cross(x, y), N), 1.0, 2e-6, "right-handed, third column N");
        vec3 v = mul(transpose(b), mul(b, vec3(0.3f, -0.5f, 0.7f)));
        expect_near((double)v[0], 0.3, 2e-6, "transpose is inverse");
    }
}

/* Computed by an independent program in long double. */
static void test_vectors(void **state)
{
    (void)state;
    vec3 V = vec3(0.7442084075f, 0.2480694692f, 0.6201736729f);
    const struct {
        float u[2], alpha[2];
        double H[3];
        bool visible;
    } cases[] = {{{0.25f, 0.5f}, {0.25f, 0.25f}, {0.0, 0.2425356250, 0.9701425001}, false},
                 {{0.1f, 0.9f}, {0.25f, 0.25f}, {0.4854101966, 0.3526711514, 0.8}, false},
                 {{0.25f, 0.5f}, {0.25f, 0.25f}, {0.0703218957, 0.2692214894, 0.9605074808}, true},
                 {{0.1f, 0.9f}, {0.25f, 0.25f}, {0.6639507212, 0.3906046859, 0.6376499190}, true},
                 {{0.25f, 0.5f}, {0.5f, 0.1f}, {0.2653380274, 0.1064791958, 0.9582577483}, true},
                 {{0.7f, 0.3f}, {0.5f, 0.1f}, {0.0906594277, -0.0625765518, 0.9939140020}, true}};
    for (size_t i = 0; i < COUNT_OF(cases); ++i) {
        vec2 u = vec2(cases[i].u[0], cases[i].u[1]);
        vec3 H = cases[i].visible ? sample_VNDF_GGX(u, V, cases[i].alpha[0], cases[i].alpha[1])
                                  : sample_D_GGX(u, cases[i].alpha[0]);
        for (int c = 0; c < 3; ++c)
            expect_near((double)H[c], cases[i].H[c], 5e-7, "case %zu, component %d", i, c);
    }
    /* density of a given normal: Heitz's sample for u = (.25, .5) */
    vec3 H = vec3(0.1149156869f, -0.1179792561f, 0.9863444023f);
    expect_relative(D_GGX(H[2], 0.25f), 2.5731297064, 3e-6, "D");
    expect_relative(G1_SmithGGX(V[2], 0.25f), 0.9761769634, 1e-6, "G1");
    expect_relative(pdf_VNDF_GGX(V, H, 0.25f, 0.25f) / (4.0f * dot(V, H)), 1.0125510211, 5e-6, "pdf of L");
    vec3 L = reflect(-V, H);
    const double L_expected[3] = {-0.5906904730, -0.4056800809, 0.6975015677};
    for (int c = 0; c < 3; ++c)
        expect_near((double)L[c], L_expected[c], 5e-7, "L");
}

/* ---- chi-square ---- */

/* A lobe on the hemisphere: sampler and density. Normals are histogrammed after stretching by 1 / alpha,
 * where GGX of any width is smooth: h' = normalize(h.x / ax, h.y / ay, h.z), dh = ax ay / |(ax h'.x, ay
 * h'.y, h'.z)|^3 dh'. */
typedef enum lobe_kind { COSINE, NORMALS, VISIBLE_NORMALS, REFLECTED } lobe_kind;
typedef struct lobe {
    lobe_kind kind;
    float alpha_x, alpha_y;
    vec3 V;
} lobe;

static vec3 lobe_sample(const lobe *l, vec2 u)
{
    if (l->kind == COSINE)
        return sample_cosine(u);
    if (l->kind == NORMALS)
        return sample_D_GGX(u, l->alpha_x);
    vec3 H = sample_VNDF_GGX(u, l->V, l->alpha_x, l->alpha_y);
    return l->kind == REFLECTED ? reflect(-l->V, H) : H;
}
static float lobe_pdf(const lobe *l, vec3 d)
{
    if (l->kind == COSINE)
        return pdf_cosine(d[2]);
    if (l->kind == NORMALS)
        return pdf_D_GGX(d[2], l->alpha_x);
    if (l->kind == VISIBLE_NORMALS)
        return pdf_VNDF_GGX(l->V, d, l->alpha_x, l->alpha_y);
    vec3 sum = d + l->V;
    if (length(sum) < 1e-6f)
        return 0.0f;
    vec3 H = normalize(sum);
    return H[2] <= 0.0f ? 0.0f : pdf_VNDF_GGX(l->V, H, l->alpha_x, l->alpha_y) / (4.0f * dot(l->V, H));
}

/* p-value of samples of one lobe against the density of another, which should be the same: histogram over
 * phi x z against the integral of the density in each cell (Gauss-Legendre, 5 x 5); cells that expect
 * fewer than 5 samples are pooled. */
enum { CELLS_PHI = 50, CELLS_Z = 50, DRAWS = 1000000, CHI2_TESTS = 48 };
static double expected[CELLS_PHI * CELLS_Z], observed[CELLS_PHI * CELLS_Z];

static double chi2_compare(const lobe *drawn, const lobe *l, bool stretched, uint64_t seed)
{
    static const double node[5] = {-0.906179845938664, -0.538469310105683, 0.0, 0.538469310105683,
                                   0.906179845938664};
    static const double weight[5] = {0.236926885056189, 0.478628670499366, 0.568888888888889,
                                     0.478628670499366, 0.236926885056189};
    const double cell = 2.0 * pi / ((double)CELLS_PHI * CELLS_Z);
    float ax = stretched ? l->alpha_x : 1.0f, ay = stretched ? l->alpha_y : 1.0f;
    double total = 0.0;
    for (int j = 0; j < CELLS_Z; ++j)
        for (int i = 0; i < CELLS_PHI; ++i) {
            double sum = 0.0;
            for (int b = 0; b < 5; ++b)
                for (int a = 0; a < 5; ++a) {
                    double z = (j + 0.5 + 0.5 * node[b]) / CELLS_Z;
                    double phi = 2.0 * pi * (i + 0.5 + 0.5 * node[a]) / CELLS_PHI;
                    double s = sqrt(1.0 - z * z);
                    vec3 d = vec3(ax * (float)(s * cos(phi)), ay * (float)(s * sin(phi)), (float)z);
                    float len = length(d);
                    sum += 0.25 * weight[a] * weight[b] *
                           (double)(lobe_pdf(l, d * (1.0f / len)) * ax * ay / (len * len * len));
                }
            expected[j * CELLS_PHI + i] = sum * cell * DRAWS;
            total += sum * cell;
            observed[j * CELLS_PHI + i] = 0.0;
        }
    if (l->kind == REFLECTED)
        assert_true(total < 1.0); /* the rest goes into the surface */
    else
        expect_near(total, 1.0, 4e-3, "integral of the density, alpha %g %g, V.z %g", (double)l->alpha_x,
                    (double)l->alpha_y, (double)l->V[2]);

    double below = 0.0;
    test_rng rng = {seed};
    for (int i = 0; i < DRAWS; ++i) {
        vec3 d = lobe_sample(drawn, rng_vec2(&rng));
        if (d[2] < 0.0f) {
            below += 1.0;
            continue;
        }
        vec3 h = normalize(vec3(d[0] / ax, d[1] / ay, d[2]));
        double phi = (atan2)((double)h[1], (double)h[0]);
        int x = (int)((phi < 0.0 ? phi + 2.0 * pi : phi) / (2.0 * pi) * CELLS_PHI);
        int y = (int)((double)h[2] * CELLS_Z);
        x = x < 0 ? 0 : x >= CELLS_PHI ? CELLS_PHI - 1 : x;
        y = y < 0 ? 0 : y >= CELLS_Z ? CELLS_Z - 1 : y;
        observed[y * CELLS_PHI + x] += 1.0;
    }
    double chi2 = 0.0, pooled_expected = l->kind == REFLECTED ? (1.0 - total) * DRAWS : 0.0;
    double pooled_observed = below;
    int freedom = -1;
    for (int i = 0; i < CELLS_PHI * CELLS_Z; ++i) {
        if (expected[i] < 5.0) {
            pooled_expected += expected[i];
            pooled_observed += observed[i];
            continue;
        }
        double difference = observed[i] - expected[i];
        chi2 += difference * difference / expected[i];
        ++freedom;
    }
    if (pooled_expected > 5.0) {
        chi2 += (pooled_observed - pooled_expected) * (pooled_observed - pooled_expected) / pooled_expected;
        ++freedom;
    } else {
        assert_true(pooled_observed < 40.0);
    }
    return chi2_p_value(chi2, (double)freedom);
}

/* Fails below the significance 0.01 of all tests together (Sidak). */
static void chi2_test(const lobe *l, bool stretched, uint64_t seed)
{
    double p = chi2_compare(l, l, stretched, seed);
    double level = 1.0 - pow(1.0 - 0.01, 1.0 / CHI2_TESTS);
    if (p < level)
        fail_msg("chi-square: kind %d, alpha %g %g, V.z %g: p = %g", (int)l->kind, (double)l->alpha_x,
                 (double)l->alpha_y, (double)l->V[2], p);
}

static void test_chi_square(void **state)
{
    (void)state;
    uint64_t seed = 100;
    chi2_test(&(lobe){COSINE, 1.0f, 1.0f, vec3(0.0f, 0.0f, 1.0f)}, false, seed++);
    const float roughness[] = {0.05f, 0.1f, 0.3f, 0.5f, 0.8f, 1.0f};
    const float NdotV[] = {0.05f, 0.3f, 0.7f, 1.0f};
    for (size_t r = 0; r < COUNT_OF(roughness); ++r) {
        float alpha = roughness[r] * roughness[r];
        chi2_test(&(lobe){NORMALS, alpha, alpha, vec3(0.0f, 0.0f, 1.0f)}, true, seed++);
        for (size_t v = 0; v < COUNT_OF(NdotV); ++v)
            chi2_test(&(lobe){VISIBLE_NORMALS, alpha, alpha, view_at(NdotV[v])}, true, seed++);
    }
    const float anisotropic[][2] = {{0.4375f, 0.25f}, {1.0f, 0.25f}, {0.02f, 0.6f}};
    for (size_t a = 0; a < COUNT_OF(anisotropic); ++a)
        for (size_t v = 0; v < COUNT_OF(NdotV); ++v) {
            float s = sqrt(1.0f - NdotV[v] * NdotV[v]);
            vec3 V = vec3(0.8f * s, -0.6f * s, NdotV[v]);
            chi2_test(&(lobe){VISIBLE_NORMALS, anisotropic[a][0], anisotropic[a][1], V}, true, seed++);
        }
    /* the reflected direction, one cell for all below the horizon, where the lobe is wide against a cell */
    chi2_test(&(lobe){REFLECTED, 0.5f, 0.5f, view_at(0.3f)}, false, seed++);
    chi2_test(&(lobe){REFLECTED, 1.0f, 1.0f, view_at(0.7f)}, false, seed++);
    chi2_test(&(lobe){REFLECTED, 0.8f, 0.4f, view_at(0.7f)}, false, seed++);
    assert_true(seed - 100 <= CHI2_TESTS);
}

/* The test detects errors: 2 % of alpha, exchanged axes, or all normals in place of visible ones. */
static void test_chi_square_sees_slips(void **state)
{
    (void)state;
    lobe right = {VISIBLE_NORMALS, 0.4f, 0.3f, view_at(0.5f)};
    lobe wider = {VISIBLE_NORMALS, 0.408f, 0.306f, view_at(0.5f)};
    lobe turned = {VISIBLE_NORMALS, 0.3f, 0.4f, view_at(0.5f)};
    lobe all = {NORMALS, 0.4f, 0.4f, view_at(0.5f)};
    assert_true(chi2_compare(&wider, &right, true, 1) < 1e-6);
    assert_true(chi2_compare(&turned, &right, true, 2) < 1e-6);
    assert_true(chi2_compare(&all, &right, true, 3) < 1e-6);
}

/* ---- weights ---- */

/* The mean of G2 / G1, the weight of a visible normal with F = 1, is the directional albedo. */
static void test_albedo_by_visible_normals(void **state)
{
    (void)state;
    const uint n = 1u << 16u;
    for (int r = 0; r < GOLDEN_ROUGHNESS_COUNT; ++r)
        for (int c = 0; c < GOLDEN_NDOTV_COUNT; ++c) {
            float alpha = golden_roughness[r] * golden_roughness[r];
            vec3 V = view_at(golden_NdotV[c]);
            double sum = 0.0;
            for (uint i = 0; i < n; ++i) {
                vec3 H = sample_VNDF_GGX(hammersley(i, n), V, alpha, alpha);
                vec3 L = reflect(-V, H);
                if (L[2] <= 0.0f)
                    continue;
                float f_cos = D_GGX_anisotropic(H, alpha, alpha) * V_SmithGGX(L[2], V[2], alpha) * L[2];
                sum += (double)(f_cos * 4.0f * dot(V, H) / pdf_VNDF_GGX(V, H, alpha, alpha));
            }
            expect_near(sum / n, golden_A[r][c] + golden_B[r][c], 2e-4, "E at %g, %g",
                        (double)golden_roughness[r], (double)golden_NdotV[c]);
        }
}

/* Anisotropic albedo, roughness .5: strength .5 and 1; at normal incidence and 60 degrees in either plane,
 * by quadrature in long double. */
static void test_anisotropic_albedo(void **state)
{
    (void)state;
    const struct {
        float alpha_x;
        vec3 V;
        double E;
    } cases[] = {{0.4375f, vec3(0.8660254f, 0.0f, 0.5f), 0.798663456599},
                 {0.4375f, vec3(0.0f, 0.8660254f, 0.5f), 0.779309017473},
                 {0.4375f, vec3(0.0f, 0.0f, 1.0f), 0.826372660955},
                 {1.0f, vec3(0.8660254f, 0.0f, 0.5f), 0.639173887886},
                 {1.0f, vec3(0.0f, 0.8660254f, 0.5f), 0.502967098140},
                 {1.0f, vec3(0.0f, 0.0f, 1.0f), 0.511589847374}};
    const uint n = 1u << 16u;
    for (size_t k = 0; k < COUNT_OF(cases); ++k) {
        vec3 V = cases[k].V;
        double sum = 0.0;
        for (uint i = 0; i < n; ++i) {
            vec3 H = sample_VNDF_GGX(hammersley(i, n), V, cases[k].alpha_x, 0.25f);
            vec3 L = reflect(-V, H);
            if (L[2] > 0.0f)
                sum += (double)(V_SmithGGX_anisotropic(L, V, cases[k].alpha_x, 0.25f) * 4.0f * L[2] * V[2] /
                                G1_SmithGGX_anisotropic(V, cases[k].alpha_x, 0.25f));
        }
        expect_near(sum / n, cases[k].E, 2e-4, "anisotropic E, case %zu", k);
    }
}

static void test_extremes_stay_unit(void **state)
{
    (void)state;
    const float corners[] = {0.0f, 1e-7f, 0.5f, 0.99999994f};
    const float alphas[] = {1e-4f, 0.01f, 1.0f};
    const float cosines[] = {1e-4f, 0.5f, 1.0f};
    for (size_t i = 0; i < COUNT_OF(corners); ++i)
        for (size_t j = 0; j < COUNT_OF(corners); ++j)
            for (size_t a = 0; a < COUNT_OF(alphas); ++a)
                for (size_t v = 0; v < COUNT_OF(cosines); ++v) {
                    vec2 u = vec2(corners[i], corners[j]);
                    vec3 V = view_at(cosines[v]);
                    vec3 H = sample_VNDF_GGX(u, V, alphas[a], alphas[2 - a]);
                    expect_near((double)length(H), 1.0, 1e-5, "length of a visible normal");
                    assert_true(H[2] >= 0.0f && isfinite(pdf_VNDF_GGX(V, H, alphas[a], alphas[2 - a])));
                    expect_near((double)length(sample_D_GGX(u, alphas[a])), 1.0, 1e-5, "length of a normal");
                    expect_near((double)length(sample_cosine(u)), 1.0, 1e-5, "length of a direction");
                }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_points),
                                       cmocka_unit_test(test_basis),
                                       cmocka_unit_test(test_vectors),
                                       cmocka_unit_test(test_chi_square),
                                       cmocka_unit_test(test_chi_square_sees_slips),
                                       cmocka_unit_test(test_albedo_by_visible_normals),
                                       cmocka_unit_test(test_anisotropic_albedo),
                                       cmocka_unit_test(test_extremes_stay_unit)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
