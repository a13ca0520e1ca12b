/* diffuse_test.c - the energy-preserving Oren-Nayar model: energy, reciprocity, image-based lighting, the sampler, and
 * numbers of an independent program in double precision. */
#include "testing/chi_square.h"

enum { COSINES = 7, ROUGHNESSES = 5 };
static const float cosines[COSINES] = {0.02f, 0.05f, 0.1f, 0.25f, 0.5f, 0.75f, 1.0f};
static const float roughnesses[ROUGHNESSES] = {0.0f, 0.25f, 0.5f, 0.75f, 1.0f};

/* ---- the BRDF ---- */

/* By the closed form; columns are N.V. */
static const double single_albedo[ROUGHNESSES][COSINES] = {
    {1, 1, 1, 1, 1, 1, 1},
    {0.998502195, 0.996209649, 0.992283304, 0.979993127, 0.95955015, 0.942291409, 0.932880766},
    {0.997192807, 0.992896106, 0.985537332, 0.962503022, 0.924188698, 0.891842281, 0.874204809},
    {0.996038387, 0.989974725, 0.979589753, 0.947082892, 0.893012314, 0.847363867, 0.822473221},
    {0.99501296, 0.987379775, 0.974306751, 0.933385792, 0.865319548, 0.807855425, 0.776522067},
};
/* Of rho = 0.5, by quadrature: within 2e-5. */
static const double grey_albedo[ROUGHNESSES][COSINES] = {
    {0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5},
    {0.499616158, 0.499026966, 0.498022673, 0.494867885, 0.489629073, 0.485201703, 0.482788055},
    {0.499264021, 0.498134376, 0.496208662, 0.490159896, 0.480114991, 0.471626144, 0.4669983},
    {0.498939818, 0.497312649, 0.49453854, 0.485825538, 0.471355782, 0.459127789, 0.452461459},
    {0.498640351, 0.496553666, 0.492995844, 0.48182203, 0.463265037, 0.44758332, 0.439034095},
};
static const struct {
    float roughness;
    double rho[3], V[3], L[3], f[3];
} values[] = {
    {1.0f,
     {0.5948, 0.0971, 0.2153},
     {0.979795897, 0, 0.2},
     {0.979795897, 0, 0.2},
     {0.854448837, 0.139246167, 0.308869338}},
    {1.0f,
     {0.7227, 0.873, 0.2566},
     {0.979795897, 0, 0.2},
     {-0.979795897, 0, 0.2},
     {0.00977027157, 0.0125743386, 0.00284097343}},
    {0.5f, {0.5556, 0.7256, 0.1485}, {0, 0, 1}, {0, 0, 1}, {0.170398687, 0.229309857, 0.0424071815}},
    {0.4238f,
     {0.1559, 0.7278, 0.2721},
     {-0.00491648105, -0.518109774, 0.8553},
     {-0.967707897, -0.0632884365, 0.244},
     {0.0453383848, 0.216854661, 0.0795112208}},
    {0.93f,
     {0.2449, 0.2109, 0.4745},
     {-0.453559383, -0.203422212, 0.8677},
     {0.809448662, 0.561891995, 0.1705},
     {0.0348556395, 0.029905987, 0.0692892026}},
    {0.6771f,
     {0.5793, 0.7663, 0.701},
     {0.799233258, -0.516222199, 0.3078},
     {0.525224075, 0.829618775, 0.1894},
     {0.155253267, 0.206224983, 0.188373891}},
    {0.5839f,
     {0.4712, 0.073, 0.2697},
     {-0.635732546, 0.670076033, 0.3832},
     {0.247126825, -0.893939104, 0.3739},
     {0.0743880718, 0.0111720357, 0.0419041354}},
    {0.8614f,
     {0.7029, 0.8183, 0.2333},
     {0.147162204, -0.98699402, 0.0647},
     {-0.976218844, -0.0184599076, 0.216},
     {0.1606655, 0.187205557, 0.0531550632}},
    {0.9428f,
     {0.8942, 0.9844, 0.2189},
     {0.019267523, -0.82995332, 0.5575},
     {-0.624433545, 0.654224624, 0.4267},
     {0.131261508, 0.147733685, 0.0274342886}},
    {0.9741f,
     {0.0722, 0.8421, 0.8371},
     {0.97359204, -0.168713071, 0.1538},
     {0.547826762, 0.443278229, 0.7095},
     {0.029311845, 0.350650565, 0.348503698}},
};

static vec3 vec3_of(const double v[3])
{
    return vec3((float)v[0], (float)v[1], (float)v[2]);
}

static vec3 eon_between(vec3 rho, float roughness, vec3 V, vec3 L)
{
    return brdf_eon(rho, roughness, L[2], V[2], dot(L, V));
}

static void test_values(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT_OF(values); ++i) {
        vec3 f = eon_between(vec3_of(values[i].rho), values[i].roughness, vec3_of(values[i].V),
                             vec3_of(values[i].L));
        for (int c = 0; c < 3;
             ++c) /* the polynomial's error is largest, 4e-4, where f is small at the horizon */
            expect_near((double)f[c], values[i].f[c], 2e-4 * values[i].f[c] + 1.6e-5, "value %zu", i);
    }
    for (int r = 0; r < ROUGHNESSES; ++r)
        for (int c = 0; c < COSINES; ++c) {
            float E = eon_albedo(cosines[c], roughnesses[r]);
            expect_near((double)E, single_albedo[r][c], 2.1e-4, "E at roughness %g", (double)roughnesses[r]);
            vec3 all = eon_reflected(vec3(0.5f), cosines[c], roughnesses[r], vec3(1.0f), vec3(1.0f));
            expect_near((double)all[0], grey_albedo[r][c], 1.5e-4, "albedo at roughness %g",
                        (double)roughnesses[r]);
        }
}

static void test_smooth_is_lambert(void **state)
{
    (void)state;
    test_rng rng = {3};
    for (int i = 0; i < 1000; ++i) {
        vec3 rho = rng_color(&rng), V = rng_direction(&rng), L = rng_direction(&rng);
        V[2] = fabsf(V[2]) + 1e-3f;
        L[2] = fabsf(L[2]) + 1e-3f;
        vec3 f = eon_between(rho, 0.0f, V, L), lambert = brdf_lambert(rho);
        for (int c = 0; c < 3; ++c)
            expect_relative(f[c], lambert[c], 1e-6, "roughness 0");
    }
}

static void test_reciprocity(void **state)
{
    (void)state;
    test_rng rng = {4};
    for (int i = 0; i < 1000; ++i) {
        vec3 rho = rng_color(&rng), V = rng_direction(&rng), L = rng_direction(&rng);
        float r = rng_float(&rng);
        V[2] = fabsf(V[2]) + 1e-3f;
        L[2] = fabsf(L[2]) + 1e-3f;
        vec3 f = eon_between(rho, r, V, L), g = eon_between(rho, r, L, V);
        for (int c = 0; c < 3; ++c)
            expect_relative(f[c], g[c], 1e-6, "exchanged");
    }
}

/* The moments int f N.L (1, x, y, z, x^2, .., xz) dL, by the midpoint rule in N.L^(1/2) and the azimuth. */
typedef struct moments {
    double one, x, z, zz, xx_minus_yy, xz;
} moments;
static moments moments_of(vec3 rho, float roughness, vec3 V)
{
    enum { Z = 400, PHI = 256 };
    moments m = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    for (int i = 0; i < Z; ++i)
        for (int j = 0; j < PHI; ++j) {
            double root = (i + 0.5) / Z, z = root * root, across = sqrt(1.0 - z * z);
            double phi = 6.283185307179586 * (j + 0.5) / PHI;
            vec3 L = vec3((float)(across * cos(phi)), (float)(across * sin(phi)), (float)z);
            double x = across * cos(phi), y = across * sin(phi);
            double w =
                (double)eon_between(rho, roughness, V, L)[0] * z * 2.0 * root * 6.283185307179586 / (Z * PHI);
            m.one += w;
            m.x += w * x;
            m.z += w * z;
            m.zz += w * z * z;
            m.xx_minus_yy += w * (x * x - y * y);
            m.xz += w * x * z;
        }
    return m;
}

/* A white surface returns all light, within the error of the polynomial. */
static void test_furnace(void **state)
{
    (void)state;
    for (int r = 0; r < ROUGHNESSES; ++r)
        for (int c = 0; c < COSINES; ++c) {
            moments m = moments_of(vec3(1.0f), roughnesses[r], view_at(cosines[c]));
            expect_near(m.one, 1.0, 3e-4, "roughness %g, N.V %g", (double)roughnesses[r], (double)cosines[c]);
        }
}

/* ---- image-based lighting ---- */

/* Integrals of f N.L Y_lm for rho = 1 and rho_ms = 1, in the order (0,0) (1,0) (1,1) (2,0) (2,1) (2,2). */
static const struct {
    double roughness, NdotV, single[6], multiple[6];
} kernels[] = {
    {0.5,
     0.1,
     {0.278016565, 0.303065631, 0.0920935912, 0.119230008, 0.0906783107, 0.0171004348},
     {0.00407984338, 0.00522957161, 0, 0.00345303664, 0, 0}},
    {0.5,
     0.3,
     {0.269311491, 0.300606213, 0.0783244525, 0.12774795, 0.0839896225, 0.0117152238},
     {0.0127818442, 0.0163838567, 0, 0.0108181055, 0, 0}},
    {0.5,
     0.5,
     {0.260710896, 0.29617411, 0.0626178127, 0.13420996, 0.0713012714, 0.00677062665},
     {0.0213859736, 0.0274126896, 0, 0.0181003395, 0, 0}},
    {0.5,
     0.7,
     {0.253176924, 0.290752936, 0.0453932232, 0.13755679, 0.0534873628, 0.00288452121},
     {0.0289176586, 0.0370668558, 0, 0.0244748941, 0, 0}},
    {0.5,
     0.9,
     {0.247831157, 0.285977863, 0.0245493839, 0.138054151, 0.0292612273, 0.000488412431},
     {0.0342637419, 0.0439195026, 0, 0.0289996319, 0, 0}},
    {1,
     0.1,
     {0.274849733, 0.28546236, 0.163606297, 0.0893604857, 0.16109202, 0.0303792998},
     {0.00724793179, 0.00929044937, 0, 0.00613439579, 0, 0}},
    {1,
     0.3,
     {0.259384976, 0.28109315, 0.139145118, 0.104492796, 0.149209418, 0.0208123536},
     {0.0227072282, 0.029106283, 0, 0.0192186032, 0, 0}},
    {1,
     0.5,
     {0.244105829, 0.27321942, 0.111241926, 0.115972701, 0.126668282, 0.0120281676},
     {0.037992654, 0.0486992481, 0, 0.0321556526, 0, 0}},
    {1,
     0.7,
     {0.230721561, 0.263588586, 0.0806420628, 0.121918417, 0.0950214803, 0.00512441557},
     {0.0513728586, 0.0658500873, 0, 0.0434801894, 0, 0}},
    {1,
     0.9,
     {0.221224689, 0.255105563, 0.0436125222, 0.12280199, 0.051983216, 0.000867675462},
     {0.0608702936, 0.0780239656, 0, 0.051518486, 0, 0}},
};

/* An environment of degree 2: mean + a.w + w.Q w in the frame of V, in one channel. */
typedef struct environment {
    double mean, a[3], xx, yy, xy, xz, yz;
} environment;

static vec3 irradiance_over_pi(const environment *e, vec3 d)
{
    double x = (double)d[0], y = (double)d[1], z = (double)d[2];
    double q = e->xx * x * x + e->yy * y * y - (e->xx + e->yy) * z * z +
               2.0 * (e->xy * x * y + e->xz * x * z + e->yz * y * z);
    return vec3((float)(e->mean + (e->a[0] * x + e->a[1] * y + e->a[2] * z) * 2.0 / 3.0 + 0.25 * q));
}

static DiffuseLight light_of(const environment *e)
{
    vec3 N = vec3(0.0f, 0.0f, 1.0f), X = vec3(1.0f, 0.0f, 0.0f), Y = vec3(0.0f, 1.0f, 0.0f);
    vec3 XN = (X + N) * 0.70710678f;
    return diffuse_light(irradiance_over_pi(e, N), irradiance_over_pi(e, -N), irradiance_over_pi(e, X),
                         irradiance_over_pi(e, -X), irradiance_over_pi(e, Y), irradiance_over_pi(e, -Y),
                         irradiance_over_pi(e, XN), irradiance_over_pi(e, -XN));
}

/* Radiance of the lobe whose coefficients are h. */
static double reflected(const environment *e, const double h[6])
{
    const double c0 = 0.28209479177387814, c1 = 0.4886025119029199, c2 = 1.0925484305920792,
                 c20 = 0.31539156525252, c22 = 0.5462742152960396;
    double one = h[0] / c0, zz = (h[3] / c20 + one) / 3.0, d = h[5] / c22;
    double xx = 0.5 * (one - zz + d), yy = 0.5 * (one - zz - d);
    return e->mean * one + e->a[0] * h[2] / c1 + e->a[2] * h[1] / c1 + e->xx * xx + e->yy * yy -
           (e->xx + e->yy) * zz + 2.0 * e->xz * h[4] / c2;
}

/* Half a thousandth of the mean radiance, of which the error of eon_shape() is the most. */
static void test_image_based(void **state)
{
    (void)state;
    test_rng rng = {7};
    for (size_t i = 0; i < COUNT_OF(kernels); ++i)
        for (int k = 0; k < 20; ++k) {
            environment e = {.mean = 3.0};
            double *rest = e.a;
            for (int n = 0; n < 3; ++n)
                rest[n] = (double)rng_float(&rng) * 2.0 - 1.0;
            e.xx = (double)rng_float(&rng) - 0.5;
            e.yy = (double)rng_float(&rng) - 0.5;
            e.xy = (double)rng_float(&rng) - 0.5;
            e.xz = (double)rng_float(&rng) - 0.5;
            e.yz = (double)rng_float(&rng) - 0.5;
            DiffuseLight d = light_of(&e);
            float NdotV = (float)kernels[i].NdotV, r = (float)kernels[i].roughness;
            double E = (double)eon_albedo(NdotV, r);
            expect_near((double)eon_single_light(d, NdotV, r)[0] * E, reflected(&e, kernels[i].single),
                        1.5e-3, "single, kernel %zu", i);
            expect_near((double)eon_multiple_light(d)[0] * (1.0 - E), reflected(&e, kernels[i].multiple),
                        1.5e-3, "multiple, kernel %zu", i);
        }
}

/* Roughness 0 reflects the irradiance around N, whatever the environment. */
static void test_image_based_smooth(void **state)
{
    (void)state;
    test_rng rng = {8};
    for (int i = 0; i < 200; ++i) {
        vec3 c[8];
        for (int k = 0; k < 8; ++k)
            c[k] = rng_color(&rng) + 0.2f;
        DiffuseLight d = diffuse_light(c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7]);
        float NdotV = 0.01f + 0.99f * rng_float(&rng);
        for (int k = 0; k < 3; ++k)
            expect_near((double)eon_single_light(d, NdotV, 0.0f)[k], (double)c[0][k], 1e-5, "N.V %g",
                        (double)NdotV);
    }
}

/* ---- sampling ---- */

static const struct {
    double roughness, NdotV, L[3], pdf_lobe, pdf, u[2], sample[3];
} samples[] = {
    {0.887,
     0.3678,
     {0.594801416, -0.23288391, 0.7694},
     0.371077488,
     0.353399659,
     {0.6664, 0.6077},
     {0.775436308, -0.479125868, 0.411262611}},
    {0.4369,
     0.1527,
     {-0.312018108, -0.707055543, 0.6346},
     0.166804001,
     0.165975771,
     {0.7002, 0.7684},
     {0.0480414186, -0.84057399, 0.53956222}},
    {0.5483,
     0.8188,
     {-0.533564353, 0.698958255, 0.4762},
     0.128505684,
     0.130222559,
     {0.1495, 0.4403},
     {0.451352817, 0.134857294, 0.882096449}},
    {0.1099,
     0.5753,
     {0.522026791, -0.599401192, 0.6068},
     0.202336473,
     0.199855737,
     {0.2468, 0.1387},
     {-0.285153021, 0.382335093, 0.878924133}},
};

static void test_sampler_values(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT_OF(samples); ++i) {
        float r = (float)samples[i].roughness, NdotV = (float)samples[i].NdotV;
        expect_relative(pdf_eon(vec3_of(samples[i].L), NdotV, r), samples[i].pdf, 2e-6, "density %zu", i);
        float share = eon_uniform_probability(NdotV, r);
        double lobe = ((double)pdf_eon(vec3_of(samples[i].L), NdotV, r) - (double)share / 6.283185307179586) /
                      (1.0 - (double)share);
        expect_relative(lobe, samples[i].pdf_lobe, 5e-6, "density of the lobe %zu", i);
        vec2 u = vec2(mix(share, 1.0f, (float)samples[i].u[0]), (float)samples[i].u[1]);
        vec3 L = sample_eon(u, NdotV, r);
        for (int c = 0; c < 3; ++c)
            expect_near((double)L[c], samples[i].sample[c], 3e-6, "sample %zu", i);
    }
}

typedef struct lobe {
    float roughness, NdotV;
} lobe;
static bool draw(const void *context, vec2 u, vec3 *L)
{
    const lobe *l = context;
    *L = sample_eon(u, l->NdotV, l->roughness);
    return (*L)[2] > 0.0f;
}
static float density(const void *context, vec3 L)
{
    const lobe *l = context;
    return pdf_eon(L, l->NdotV, l->roughness);
}

static void test_samples_follow_density(void **state)
{
    (void)state;
    uint64_t seed = 11;
    for (int r = 1; r < ROUGHNESSES; ++r)
        for (int c = 0; c < COSINES; c += 2) {
            lobe l = {roughnesses[r], cosines[c]};
            double p = chi2_over_sphere(&(sphere_sampler){draw, density, &l}, ++seed);
            if (p < sidak_level(16))
                fail_msg("roughness %g, N.V %g: p = %g", (double)l.roughness, (double)l.NdotV, p);
        }
}

/* The weight f N.L / pdf of a white surface is bounded: 1.46 at most, where cosine sampling reaches 1 / N.V. */
static void test_weights_are_bounded(void **state)
{
    (void)state;
    test_rng rng = {12};
    double largest = 0.0;
    for (int i = 0; i < 200000; ++i) {
        float r = rng_float(&rng), NdotV = 0.005f + 0.995f * rng_float(&rng);
        vec3 L = sample_eon(rng_vec2(&rng), NdotV, r);
        if (L[2] <= 0.0f)
            continue;
        float w = eon_between(vec3(1.0f), r, view_at(NdotV), L)[0] * L[2] / pdf_eon(L, NdotV, r);
        largest = fmax(largest, (double)w);
    }
    print_message("largest weight %.3f\n", largest);
    assert_true(largest < 1.5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values),
        cmocka_unit_test(test_smooth_is_lambert),
        cmocka_unit_test(test_reciprocity),
        cmocka_unit_test(test_furnace),
        cmocka_unit_test(test_image_based),
        cmocka_unit_test(test_image_based_smooth),
        cmocka_unit_test(test_sampler_values),
        cmocka_unit_test(test_samples_follow_density),
        cmocka_unit_test(test_weights_are_bounded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
