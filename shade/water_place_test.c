/* water_place_test.c - local properties of the sea: sums of weights, limits of footprints, foam against its
 * integral, limits of the bed. */
#include "testing/test_support.h"

static void test_weights(void **state)
{
    (void)state;
    for (int i = 0; i < 400; i++) {
        float a = (float)(i % 20) / 20.0f, b = (float)(i / 20) / 20.0f;
        vec3 w = wave_patch_weights(vec2(a, b));
        expect_near((double)dot(w, w), 1.0, 1e-6, "squares at %g, %g", (double)a, (double)b);
        vec3 c = wave_cubic_weights(a);
        double last = (double)(a * a * (-0.5f + 0.5f * a));
        expect_near((double)(c[0] + c[1] + c[2]) + last, 1.0, 1e-6, "cubic at %g", (double)a);
    }
    vec3 corner = wave_patch_weights(vec2(0.0f, 0.0f));
    expect_near((double)corner[0], 1.0, 1e-6, "at a corner");
    expect_near((double)wave_patch_weights(vec2(0.5f, 0.5001f))[0], 0.0, 1e-6, "across an edge");
    expect_near((double)wave_patch_weights(vec2(0.9999f, 0.9999f))[0], 1.0, 1e-6, "at the upper corner");
}

/* The normal against the cross product of derivatives, in double. */
static void test_normal(void **state)
{
    (void)state;
    vec3 N = wave_normal(vec2(0.2f, -0.3f), vec3(-0.1f, 0.05f, 0.08f));
    double x = 0.08 * -0.3 - 1.05 * 0.2, y = 1.05 * 0.9 - 0.08 * 0.08, z = 0.08 * 0.2 - 0.9 * -0.3;
    double length = sqrt(x * x + y * y + z * z);
    expect_near((double)N[0], x / length, 1e-6, "x");
    expect_near((double)N[1], y / length, 1e-6, "y");
    expect_near((double)N[2], z / length, 1e-6, "z");
    vec3 V = normalize(vec3(-1.0f, 0.01f, 0.0f)), tilted = normalize(vec3(0.5f, 1.0f, 0.0f));
    vec3 faced = water_faced(tilted, V);
    assert_true(dot(faced, V) > 0.0f && faced[1] > 0.0f);
    vec3 same = water_faced(tilted, vec3(0.0f, 1.0f, 0.0f));
    expect_near((double)dot(same, tilted), 1.0, 1e-6, "seen as it is");
}

/* The mean slope of facets weighted by visible area, over a grid of slopes in double. */
static void test_seen_normal(void **state)
{
    (void)state;
    const double C[3] = {0.02, 0.008, 0.005}, mean[2] = {0.05, -0.04};
    const vec3 N = normal_from_slope(vec2((float)mean[0], (float)mean[1]));
    double L11 = sqrt(C[0]), L21 = C[2] / L11, L22 = sqrt(C[1] - L21 * L21); /* of Cholesky */
    for (int i = 0; i < 8; i++) {
        double elevation = i == 7 ? 1.5 : 0.06 + 0.08 * i, azimuth = 0.9 * i;
        double V[3] = {cos(elevation) * cos(azimuth), sin(elevation), cos(elevation) * sin(azimuth)};
        double first = V[1] - V[0] * mean[0] - V[2] * mean[1];
        double variance = C[0] * V[0] * V[0] + C[1] * V[2] * V[2] + 2.0 * C[2] * V[0] * V[2];
        double sum[3] = {0.0, 0.0, 0.0};
        for (int x = -200; x <= 200; x++)
            for (int y = -200; y <= 200; y++) {
                double a = x * 0.03, b = y * 0.03;
                double s = mean[0] + L11 * a, t = mean[1] + L21 * a + L22 * b;
                double tilt = fmax(V[1] - V[0] * s - V[2] * t, 0.0);
                double seen = tilt * -expm1(-2.0 * first * tilt / variance) * exp(-0.5 * (a * a + b * b));
                sum[0] += seen;
                sum[1] += seen * s;
                sum[2] += seen * t;
            }
        vec3 is = water_seen_normal(vec3((float)C[0], (float)C[1], (float)C[2]), N,
                                    vec3((float)V[0], (float)V[1], (float)V[2]));
        vec2 slope = slope_from_normal(is);
        expect_near((double)slope[0], sum[1] / sum[0], 2e-4, "x, eye %d", i);
        expect_near((double)slope[1], sum[2] / sum[0], 2e-4, "z, eye %d", i);
        assert_true(dot(is, vec3((float)V[0], (float)V[1], (float)V[2])) > 0.0f);
    }
    vec3 low = normalize(vec3(1.0f, 0.01f, 0.0f)); /* behind a wave */
    assert_true(dot(water_seen_normal(vec3(0.001f, 0.001f, 0.0f), normalize(vec3(-0.3f, 1.0f, 0.0f)), low),
                    low) > 0.0f);
}

static void test_footprint(void **state)
{
    (void)state;
    expect_near((double)water_footprint(0.01f, 0.001f, 1.0f), 0.01, 1e-4, "where waves are high");
    expect_near((double)water_footprint(0.01f, 0.25f, 0.0f), 0.04, 1e-6,
                "still water: the length of the ray's foot");
    expect_near((double)water_footprint(0.01f, -1.0f, 0.0f), 0.01, 1e-8, "from below, straight");
    vec3 C = vec3(0.0f);
    expect_near((double)water_seen_cosine(vec3(0.6f, 0.8f, 0.0f), C), 0.8, 1e-6, "flat water");
}

/* Fraction of the area seen from above whose q exceeds the threshold, by a sum over q. */
static double foam_integral(double mean, double sigma, double threshold)
{
    double sum = 0.0, all = fmax(1.0 - mean, 0.02);
    for (int i = 0; i < 20000; i++) {
        double z = -8.0 + 16.0 * (i + 0.5) / 20000, q = z * sigma; /* about the mean */
        double J = (1.0 - mean) - q + 0.25 * (q * q - sigma * sigma);
        if (mean + q > threshold)
            sum += J * exp(-0.5 * z * z) * 0.3989422804 * 16.0 / 20000;
    }
    return fmin(fmax(sum / all, 0.0), 1.0);
}

static void test_foam(void **state)
{
    (void)state;
    const double cases[][3] = {{0.0, 0.2, 0.5}, {0.3, 0.1, 0.5}, {0.6, 0.1, 0.5}, {-0.2, 0.3, 0.4}};
    for (int i = 0; i < 4; i++) {
        const double *c = cases[i];
        double share = (double)foam_share((float)c[0], (float)(c[1] * c[1]), (float)c[2]);
        expect_near(share, foam_integral(c[0], c[1], c[2]), 2e-3, "case %d", i);
    }
    assert_true(foam_share(0.6f, 0.0f, 0.5f) == 1.0f && foam_share(0.4f, 0.0f, 0.5f) == 0.0f);
    assert_true(water_foam_cover(0.0f, 0.3f) == 0.0f && water_foam_cover(1.0f, 1.0f) == 1.0f);
    expect_relative(water_foam_cover(0.01f, 0.0f) * 0.55f, 0.0022, 1e-3,
                    "thin foam"); /* reflects 0.22 of its area */
}

/* Lace covers its fraction if the field is unresolved; otherwise its mean over the field is that fraction. */
static void test_lace(void **state)
{
    (void)state;
    for (int i = 1; i < 10; i++) {
        float share = 0.1f * (float)i;
        expect_near((double)foam_lace(share, 0.0f, 1.0f), (double)share, 1e-4, "unseen, %d", i);
        for (int j = 0; j < 4; j++) {
            float hidden = 0.3f * (float)j;
            double sum = 0.0, deviation = sqrt(1.0 - (double)hidden);
            for (int k = 0; k < 4000; k++) {
                double z = -6.0 + 12.0 * (k + 0.5) / 4000,
                       density = exp(-0.5 * z * z) * 0.3989422804 * 12.0 / 4000;
                sum += (double)foam_lace(share, (float)(z * deviation), hidden) * density;
            }
            expect_near(sum, (double)share, 1e-4, "mean, %d, hidden %d", i, j);
        }
        assert_true(foam_lace(share, 3.0f, 0.0f) > 0.95f); /* high is covered, low is open */
        assert_true(foam_lace(share, -3.0f, 0.0f) < 0.05f);
    }
}

static void test_passing(void **state)
{
    (void)state;
    vec3 C = vec3(0.02f, 0.02f, 0.0f), up = vec3(0.0f, 1.0f, 0.0f);
    expect_near((double)water_visibility(C, up, up), 1.0, 1e-6, "straight up");
    assert_true(water_visibility(C, up, vec3(1.0f, -0.01f, 0.0f)) == 0.0f);
    assert_true(water_visibility(C, up, normalize(vec3(1.0f, 0.02f, 0.0f))) < 0.1f);
    assert_true(water_visibility(C, normal_from_slope(vec2(0.3f, 0.0f)), normalize(vec3(1.0f, 0.2f, 0.0f))) ==
                0.0f); /* behind the wave itself */
}

/* A lobe past waves: high elevations are unoccluded; of a lobe on the horizon half remains, with the mean
 * elevation of half a normal distribution; nothing comes from below. In between, against a thousand
 * directions of the lobe. */
static void test_mirror_passing(void **state)
{
    (void)state;
    vec3 C = vec3(0.005f, 0.005f, 0.0f), up = vec3(0.0f, 1.0f, 0.0f), calm = vec3(1e-6f, 1e-6f, 0.0f);
    WaterSpecular m;
    m.fresnel = 0.5f;
    m.escape = 0.8f;
    m.perceptual_roughness = 0.2f;
    m.deviation = 0.15f;
    m.R = normalize(vec3(0.3f, 1.0f, 0.2f));
    WaterSpecular high = water_specular_masked(m, C, up);
    expect_near((double)high.escape, 0.8, 1e-4, "high above");
    expect_near((double)dot(high.R, m.R), 1.0, 1e-6, "high above, direction");
    m.R = vec3(1.0f, 0.0f, 0.0f);
    WaterSpecular half = water_specular_masked(m, calm, up);
    expect_near((double)half.escape, 0.4, 1e-5, "on the horizon");
    expect_near((double)half.R[1], 0.15 * 0.7979, 0.15 * 0.07, "half of a normal distribution");
    for (double e = -0.1; e < 0.5; e += 0.1) {
        double passed = 0.0, all = 0.0;
        for (int i = 0; i < 1000; ++i) {
            double z = 0.01 * (i - 499.5), w = exp(-0.5 * z * z), at = e + 0.15 * z;
            all += w;
            passed += w * (double)water_visibility(C, up, vec3((float)cos(at), (float)sin(at), 0.0f));
        }
        m.R = vec3((float)cos(e), (float)sin(e), 0.0f);
        expect_near((double)water_specular_masked(m, C, up).escape, 0.8 * passed / all, 0.1, "at %g", e);
    }
    m.R = vec3(0.8660254f, -0.5f, 0.0f);
    WaterSpecular below = water_specular_masked(m, C, up);
    assert_true(below.escape < 0.01f && below.R[1] >= 0.0f);
    expect_near((double)length(below.R), 1.0, 1e-6, "unit");
}

/* A three-dimensional walk with N as one component: the root mean square of tilts is exact if N faces the eye
 * at a grazing angle; tilts far above the slope deviation stay. */
static void test_tilted(void **state)
{
    (void)state;
    vec3 C = vec3(0.01f, 0.02f, 0.003f), V = normalize(vec3(0.8f, 1e-4f, 0.6f));
    double variance = (double)slope_variance(C, vec2(V[0], V[2]));
    vec3 seen = water_tilted(vec3(0.0f, 1.0f, 0.0f), C, V);
    expect_near((double)(dot(seen, V) / seen[1]), sqrt(2.0 * variance), 1e-3, "of a level place");
    vec3 away = water_tilted(normalize(vec3(-0.1f, 1.0f, 0.0f)), C, V);
    assert_true(dot(away, V) > 0.08f);
    vec3 N = normalize(vec3(0.8f, 1.0f, 0.6f));
    expect_near((double)dot(water_tilted(N, C, V), N), 1.0, 1e-6, "towards the eye");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_weights),     cmocka_unit_test(test_normal),
        cmocka_unit_test(test_seen_normal), cmocka_unit_test(test_footprint),
        cmocka_unit_test(test_foam),        cmocka_unit_test(test_lace),
        cmocka_unit_test(test_passing),     cmocka_unit_test(test_mirror_passing),
        cmocka_unit_test(test_tilted)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
