/* sheen_test.c - Charlie and the transformed cosine: normalisation, published numbers, samplers. */
#include "testing/chi_square.h"

static const double pi = 3.14159265358979323846;

/* Integral over the hemisphere of a function of z and phi by the midpoint rule. */
typedef double (*hemisphere_function)(const void *context, double z, double phi);
static double over_hemisphere(hemisphere_function f, const void *context, int z_count, int phi_count)
{
    double sum = 0.0;
    for (int j = 0; j < z_count; ++j)
        for (int i = 0; i < phi_count; ++i)
            sum += f(context, (j + 0.5) / z_count, 2.0 * pi * (i + 0.5) / phi_count);
    return sum * 2.0 * pi / ((double)z_count * phi_count);
}
static vec3 at(double z, double phi)
{
    double r = sqrt(1.0 - z * z);
    return vec3((float)(r * cos(phi)), (float)(r * sin(phi)), (float)z);
}

static double D_cos(const void *context, double z, double phi)
{
    (void)phi;
    return (double)D_Charlie((float)z, *(const float *)context) * z;
}
static void test_distribution_integrates_to_one(void **state)
{
    (void)state;
    const float roughness[] = {0.02f, 0.1f, 0.25f, 0.5f, 1.0f};
    for (size_t i = 0; i < COUNT_OF(roughness); ++i) {
        float alpha = sheen_alpha(roughness[i]);
        expect_near(over_hemisphere(D_cos, &alpha, 20000, 1), 1.0, 2e-3, "roughness %g",
                    (double)roughness[i]);
    }
    assert_true(D_Charlie(1.0f, 0.25f) < 1e-6f && D_Charlie(0.0f, 0.25f) > 0.9f);
}

/* Computed by an independent program in long double. */
static void test_point_values(void **state)
{
    (void)state;
    const struct {
        float r;
        double D, lambda_low, lambda_high, V;
    } golden[] = {{0.5f, 0.839293645211, 3.597104431854, 0.528525128321, 0.229303831949},
                  {1.0f, 0.462303333046, 2.006517743436, 0.251250936039, 0.339914290682},
                  {0.25f, 1.709475370196, 5.177281366055, 0.838199179132, 0.170008690830}};
    for (size_t i = 0; i < COUNT_OF(golden); ++i) {
        float alpha = sheen_alpha(golden[i].r);
        expect_relative(D_Charlie(0.25f, alpha), golden[i].D, 1e-5, "D");
        expect_relative(Lambda_Charlie(0.25f, alpha), golden[i].lambda_low, 1e-5, "Lambda below 1/2");
        expect_relative(Lambda_Charlie(0.75f, alpha), golden[i].lambda_high, 1e-5, "Lambda above 1/2");
        expect_relative(V_Charlie(0.5f, 0.75f, alpha), golden[i].V, 1e-5, "V");
    }
    expect_relative(D_Charlie(0.9f, 0.25f), 3.4472960674e-2, 1e-5, "D near N");
    expect_relative(V_Neubelt(0.5f, 0.75f), 0.285714285714, 1e-6, "Neubelt");
    expect_relative(Lambda_Charlie(0.5f, 0.3f), Lambda_Charlie(0.49999f, 0.3f), 1e-3, "no step at 1/2");
}

/* Directional albedo by quadrature in long double: rows roughness, columns N.V. */
static const golden_table golden_E = {
    {1.032847540, 0.06662283901, 7.902655155e-04, 5.420908046e-07, 5.159165020e-18},
    {0.7476768301, 0.2442339209, 0.05993452933, 0.009518274947, 1.279496138e-04},
    {0.6798274764, 0.3668602622, 0.1878539311, 0.08897543866, 0.02698202441},
    {0.7819239627, 0.4815967431, 0.2980103504, 0.1844342457, 0.1008732237},
    {0.8272474977, 0.5342260461, 0.3562892487, 0.2454791415, 0.1637639667}};

static void test_directional_albedo(void **state)
{
    (void)state;
    for (int r = 0; r < GOLDEN_ROUGHNESS_COUNT; ++r)
        for (int c = 0; c < GOLDEN_NDOTV_COUNT; ++c)
            expect_near((double)integrate_sheen_albedo(golden_roughness[r], golden_NdotV[c], 1u << 14u),
                        golden_E[r][c], 1.5e-4, "E at %g, %g", (double)golden_roughness[r],
                        (double)golden_NdotV[c]);
}

/* And the same number from the lobe itself over directions to the light, for either visibility. */
typedef struct lobe_at {
    vec3 V;
    float alpha;
    bool is_neubelt;
} lobe_at;
static double lobe_cos(const void *context, double z, double phi)
{
    const lobe_at *l = (const lobe_at *)context;
    vec3 L = at(z, phi), H = normalize(l->V + L);
    if (l->is_neubelt)
        return (double)(D_Charlie(H[2], l->alpha) * V_Neubelt(L[2], l->V[2]) * L[2]);
    return (double)(brdf_sheen(L[2], l->V[2], H[2], l->alpha) * L[2]);
}
static void test_lobe_has_that_albedo(void **state)
{
    (void)state;
    static const double neubelt[3] = {0.4313675424, 0.4102290090, 0.3938563253}; /* N.V .25, r .5 .75 1 */
    for (int r = 2; r < GOLDEN_ROUGHNESS_COUNT; ++r) {
        lobe_at l = {view_at(0.25f), sheen_alpha(golden_roughness[r]), false};
        expect_near(over_hemisphere(lobe_cos, &l, 1500, 300), golden_E[r][1], 1e-3, "Charlie");
        l.is_neubelt = true;
        expect_near(over_hemisphere(lobe_cos, &l, 1500, 300), neubelt[r - 2], 1e-3, "Neubelt");
    }
}

static void test_reciprocity(void **state)
{
    (void)state;
    test_rng rng = {4};
    for (int i = 0; i < 10000; ++i) {
        float a = 0.01f + 0.99f * rng_float(&rng), b = 0.01f + 0.99f * rng_float(&rng);
        float H = rng_float(&rng), alpha = sheen_alpha(rng_float(&rng));
        expect_relative(brdf_sheen(a, b, H, alpha), brdf_sheen(b, a, H, alpha), 1e-6, "reciprocity");
    }
}

/* E may exceed 1; the transmittance must not be negative. */
static void test_scaling_stays_in_range(void **state)
{
    (void)state;
    assert_true(sheen_scaling(vec3(1.0f), 1.033f) == 0.0f);
    assert_true(sheen_scaling(vec3(0.0f), 1.033f) == 1.0f);
    expect_near((double)sheen_scaling(vec3(0.1f, 0.5f, 0.2f), 0.4f), 0.8, 1e-6, "by the largest channel");
    test_rng rng = {9};
    for (int i = 0; i < 100000; ++i) {
        float alpha = sheen_alpha(rng_float(&rng)), NdotL = rng_float(&rng), NdotV = rng_float(&rng);
        float f = brdf_sheen(max(NdotL, 1e-6f), max(NdotV, NDOTV_MIN), rng_float(&rng), alpha);
        assert_true(f >= 0.0f && isfinite(f));
    }
}

/* Band 1 of prefiltering: an environment (1 + z) / 2 becomes (1 + k1 R.z) / 2. */
static void test_prefilter_band(void **state)
{
    (void)state;
    static const double k1[3] = {0.400000000000, 0.514285714286, 0.571428571429};
    for (int r = 0; r < 3; ++r) {
        double sum = 0.0, weight = 0.0;
        const uint n = 1u << 15u;
        for (uint i = 0; i < n; ++i) {
            PrefilterSample p =
                prefilter_sheen_sample(i, n, sheen_alpha(golden_roughness[r + 2]), vec3(0.0f, 0.0f, 1.0f));
            sum += (double)(p.weight * p.L[2]);
            weight += (double)p.weight;
        }
        expect_near(sum / weight, k1[r], 2e-3, "k1 at roughness %g", (double)golden_roughness[r + 2]);
    }
}

/* ---- the transformed cosine ---- */

static void test_ltc_values(void **state)
{
    (void)state;
    static const double R[4][5] = {{.53090710, .10912436, .00654910, .00097166, .00086996},
                                   {.62352044, .37012067, .14971759, .05319917, .02486865},
                                   {.66268750, .51913255, .34436259, .21816883, .14795151},
                                   {.72049326, .61715466, .49569684, .40317104, .34461903}};
    for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 5; ++c)
            expect_near((double)sheen_ltc_albedo(golden_NdotV[c], golden_roughness[r + 1]), R[r][c], 2e-5,
                        "R at %g, %g", (double)golden_roughness[r + 1], (double)golden_NdotV[c]);
    vec2 t = sheen_ltc_transform(0.5f, 0.5f);
    expect_near((double)t[0], .49058266, 1e-6, "A");
    expect_near((double)t[1], -.05793409, 1e-6, "B");
    vec3 V = view_at(0.5f);
    expect_near((double)pdf_sheen_ltc(V, V, 0.5f), 0.2315444995, 1e-6, "towards V");
    expect_near((double)pdf_sheen_ltc(V, vec3(-V[0], 0.0f, V[2]), 0.5f), 0.1842460000, 1e-6, "mirrored");
    expect_near((double)pdf_sheen_ltc(V, vec3(0.0f, 0.0f, 1.0f), 0.5f), 0.0760963983, 1e-6, "along N");
}

typedef struct sheen_view {
    vec3 V;
    float roughness;
} sheen_view;
static bool draw_ltc(const void *context, vec2 u, vec3 *d)
{
    const sheen_view *s = (const sheen_view *)context;
    *d = sample_sheen_ltc(u, s->V, s->roughness);
    return true;
}
static float pdf_ltc(const void *context, vec3 d)
{
    const sheen_view *s = (const sheen_view *)context;
    return pdf_sheen_ltc(s->V, d, s->roughness);
}
static bool draw_charlie(const void *context, vec2 u, vec3 *d)
{
    *d = sample_D_Charlie(u, sheen_alpha(((const sheen_view *)context)->roughness));
    return true;
}
static float pdf_charlie(const void *context, vec3 d)
{
    float alpha = sheen_alpha(((const sheen_view *)context)->roughness);
    return d[2] > 0.0f ? pdf_D_Charlie(d[2], alpha) : 0.0f;
}

static void test_samplers(void **state)
{
    (void)state;
    const float roughness[] = {0.3f, 0.5f, 1.0f}, NdotV[] = {0.1f, 0.5f, 0.9f};
    uint64_t seed = 70;
    for (size_t r = 0; r < COUNT_OF(roughness); ++r) {
        sheen_view view = {view_at(0.5f), roughness[r]};
        double p = chi2_over_sphere(&(sphere_sampler){draw_charlie, pdf_charlie, &view}, seed++);
        if (p < 1e-3)
            fail_msg("normals of Charlie, roughness %g: p = %g", (double)roughness[r], p);
        for (size_t v = 0; v < COUNT_OF(NdotV); ++v) {
            view.V = view_at(NdotV[v]);
            p = chi2_over_sphere(&(sphere_sampler){draw_ltc, pdf_ltc, &view}, seed++);
            if (p < 1e-3)
                fail_msg("transformed cosine, roughness %g, N.V %g: p = %g", (double)roughness[r],
                         (double)NdotV[v], p);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_distribution_integrates_to_one),
        cmocka_unit_test(test_point_values),
        cmocka_unit_test(test_directional_albedo),
        cmocka_unit_test(test_lobe_has_that_albedo),
        cmocka_unit_test(test_reciprocity),
        cmocka_unit_test(test_scaling_stays_in_range),
        cmocka_unit_test(test_prefilter_band),
        cmocka_unit_test(test_ltc_values),
        cmocka_unit_test(test_samplers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
