/* water_scales_test.c - masking of superposed waves (slopes_seen()): the projected area is that of the
 * surface, a three-dimensional walk has the same slopes, and a surface split into long and short waves
 * shows the same; and ray-marched surfaces of eleven octaves and of one. */
#include "testing/test_support.h"

#include <complex.h> /* its I is an identifier in the shader library */

static const double PI_DOUBLE = 3.14159265358979324;

static const vec3 UP = {0.0f, 1.0f, 0.0f, 0.0f};

static vec3 direction(double elevation_deg, double azimuth_deg)
{
    float e = (float)(elevation_deg * PI_DOUBLE / 180.0), a = (float)(azimuth_deg * PI_DOUBLE / 180.0);
    return vec3(cos(e) * cos(a), sin(e), cos(e) * sin(a));
}

/* Visible density of slopes along X, by tilt: D m.X G1 over N.X, integrated across. c0, c: tilts; variance:
 * X_h^T C X_h. */
static double seen_density(double c0, double c, double variance)
{
    double density = exp(-0.5 * (c - c0) * (c - c0) / variance) / sqrt(2.0 * PI_DOUBLE * variance);
    vec3 X = vec3(1.0f, 0.0f, 0.0f); /* level: tilts are -slopes */
    vec3 N = normal_from_slope(vec2((float)-c0, 0.0f)), m = normal_from_slope(vec2((float)-c, 0.0f));
    return density * c / c0 * (double)slopes_seen(vec3((float)variance, 0.02f, 0.0f), N, m, X);
}

/* On slopes and at an azimuth: the projected area of all visible facets is that of the surface. */
static void test_area(void **state)
{
    (void)state;
    enum { STEPS = 300 };
    vec3 C = vec3(0.03f, 0.012f, 0.008f);
    for (int k = 0; k < 12; ++k) {
        vec3 X = direction(1.0 + 7.0 * k, 35.0 + 30.0 * k),
             N = normal_from_slope(vec2(0.05f, -0.03f) * (float)k);
        if (dot(N, X) < 0.005f)
            continue;
        double area = 0.0;
        for (int i = 0; i < STEPS; ++i) /* of slopes, within seven standard deviations */
            for (int j = 0; j < STEPS; ++j) {
                vec2 d = vec2((float)(14.0 * (i + 0.5) / STEPS - 7.0) * 0.1732f,
                              (float)(14.0 * (j + 0.5) / STEPS - 7.0) * 0.1095f);
                vec3 m = normal_from_slope(slope_from_normal(N) + d);
                if (dot(X, m) > 0.0f)
                    area += (double)(slope_density(WATER_BECKMANN, C, d) * dot(X, m) / m[1] *
                                     slopes_seen(C, N, m, X));
            }
        area *= 14.0 * 0.1732 * 14.0 * 0.1095 / (STEPS * STEPS);
        expect_relative(area, (double)(dot(N, X) / N[1]), 2e-3, "area seen, case %d", k);
    }
}

/* Visible tilts are lengths of (c0, 0, 0) + sigma times a vector of three normal numbers: moments, for
 * eyes near the surface and far above it. Near the surface they are 1.6 standard deviations, where Smith's
 * are 1.25. */
static void test_walk(void **state)
{
    (void)state;
    const double sigma = 0.16;
    for (double c0 = 1e-3; c0 < 1.0; c0 *= 2.3) {
        double sum = 0.0, mean = 0.0, square = 0.0;
        enum { STEPS = 20000 };
        for (int i = 0; i < STEPS; ++i) {
            double c = (c0 + 7.0 * sigma) * (i + 0.5) / STEPS;
            double w = seen_density(c0, c, sigma * sigma) * (c0 + 7.0 * sigma) / STEPS;
            sum += w;
            mean += w * c;
            square += w * c * c;
        }
        expect_relative(sum, 1.0, 2e-3, "all, from %g", c0);
        expect_relative(square, c0 * c0 + 3.0 * sigma * sigma, 2e-3, "square, from %g", c0);
        if (c0 < 2e-3)
            expect_relative(mean, sigma * 2.0 * sqrt(2.0 / PI_DOUBLE), 2e-3, "mean at the surface");
    }
}

/* Masking by long waves, then by short waves on them, is masking by all, for any split: the same distribution
 * of tilts. */
static void test_division(void **state)
{
    (void)state;
    const double variance = 0.03;
    enum { STEPS = 4000 };
    for (double share = 0.1; share < 1.0; share += 0.2)
        for (double c0 = 0.003; c0 < 0.7; c0 *= 3.7)
            for (double c = 0.02; c < 0.7; c *= 2.1) {
                double divided = 0.0, width = c0 + 7.0 * sqrt(share * variance);
                for (int i = 0; i < STEPS; ++i) {
                    double middle = width * (i + 0.5) / STEPS;
                    divided += seen_density(c0, middle, share * variance) *
                               seen_density(middle, c, (1.0 - share) * variance) * width / STEPS;
                }
                double whole = seen_density(c0, c, variance);
                expect_near(divided, whole, 3e-3 * whole + 1e-5, "divided at %g, from %g to %g", share, c0,
                            c);
            }
}

/* The cumulative distribution of tilts, from their density; and its inverse, used to sample facets. */
static void test_tilts(void **state)
{
    (void)state;
    for (double a = 1e-3; a < 20.0; a *= 3.1) {
        enum { STEPS = 4000 };
        double sum = 0.0, low = fmax(a - 7.0, 0.0), width = a + 7.0 - low;
        for (int i = 0; i < STEPS; ++i) {
            double x = low + width * (i + 0.5) / STEPS, e = exp(-0.5 * (x - a) * (x - a));
            sum += x / a * e * -expm1(-2.0 * a * x) / sqrt(2.0 * PI_DOUBLE) * width / STEPS;
            if (i % 200 == 0)
                expect_near((double)tilts_seen((float)a, (float)(x + 0.5 * width / STEPS)), sum,
                            3e-6 + 2e-6 * a, "tilts below %g, from %g", x, a);
        }
    }
}

/* Reflectance of a sea of 5, 10 and 15 m/s for a horizontal view, by facets sampled as lengths of three
 * normal numbers and a slope across: independent of quadrature and of densities. */
static void test_mean_reflectance(void **state)
{
    (void)state;
    const double mss[3] = {0.0286, 0.0542, 0.0798};
    for (int k = 0; k < 3; ++k)
        for (double degrees = 0.5; degrees < 40.0; degrees *= 3.0) {
            double sigma = sqrt(0.5 * mss[k]), e = degrees * PI_DOUBLE / 180.0, sum = 0.0;
            enum { DRAWS = 100000 };
            test_rng rng = {(uint64_t)(7 + k)};
            for (int i = 0; i < DRAWS; ++i) {
                double g[4];
                for (int j = 0; j < 4; ++j)
                    g[j] = sigma * (double)inverse_normal(clamp(rng_float(&rng), 1e-6f, 0.999999f));
                double c0 = sin(e), level = cos(e);
                double c = sqrt((c0 + level * g[0]) * (c0 + level * g[0]) +
                                level * level * (g[1] * g[1] + g[2] * g[2]));
                double along = (c0 - c) / level;
                sum += (double)F_dielectric((float)(c / sqrt(1.0 + along * along + g[3] * g[3])), 1.34f);
            }
            float mu = (float)sin(e);
            WaterMeans m = integrate_water_means(WATER_BECKMANN, WATER_SCALES, mu, (float)sigma, 1.34f, 96);
            expect_relative((double)(m.fresnel * F_dielectric(mu, 1.34f)), sum / DRAWS, 0.01,
                            "mss %g, %g degrees", mss[k], degrees);
            WaterMeans smith =
                integrate_water_means(WATER_BECKMANN, WATER_SMITH, mu, (float)sigma, 1.34f, 96);
            if (degrees < 1.0) /* a quarter more, and a third */
                assert_true(smith.fresnel > 1.2f * m.fresnel && smith.fresnel < 1.4f * m.fresnel);
        }
}

/* Small slopes hide nothing; callers exclude facets that face away. */
static void test_calm(void **state)
{
    (void)state;
    vec3 C = vec3(SLOPE_VARIANCE_MIN, SLOPE_VARIANCE_MIN, 0.0f);
    assert_true(slopes_seen(C, UP, UP, direction(1.0, 20.0)) == 1.0f);
    assert_true(slopes_seen(vec3(0.05f, 0.05f, 0.0f), UP, UP, UP) == 1.0f);
}

/* ---- rays ---- */

enum { HEIGHTS = 1 << 18, SHORTEST = 16 };

/* Two normal numbers. */
static double complex normal_pair(test_rng *rng)
{
    double r = sqrt(-2.0 * log(1.0 - (double)rng_float(rng))), phi = 2.0 * PI_DOUBLE * (double)rng_float(rng);
    return r * cos(phi) + r * sin(phi) * (double complex)I;
}

/* Sum of a[i] e^(2 pi i j i / n), in place; n is a power of two. Cooley and Tukey 1965. */
static void transform(double complex *a, size_t n)
{
    for (size_t i = 1, j = 0; i < n; i++) {
        size_t bit = n >> 1;
        for (; j & bit; bit >>= 1)
            j ^= bit;
        j ^= bit;
        double complex t = a[i];
        if (i < j)
            a[i] = a[j], a[j] = t;
    }
    for (size_t half = 1; half < n; half *= 2)
        for (size_t k = 0; k < half; k++) {
            double complex turn = cexp(PI_DOUBLE * (double complex)I * (double)k / (double)half);
            for (size_t i = k; i < n; i += 2 * half) {
                double complex u = a[i], v = a[i + half] * turn;
                a[i] = u + v;
                a[i + half] = u - v;
            }
        }
}

/* Heights, a unit apart, of a section of a periodic Gaussian sea whose slopes have the variance 1, equally in
 * each octave: k^-3. */
static void make_cut(double octaves, test_rng *rng, double complex *a, double *heights)
{
    size_t last = HEIGHTS / SHORTEST, first = (size_t)((double)last * exp2(-octaves));
    for (size_t i = 0; i < HEIGHTS; i++)
        a[i] = 0.0;
    for (size_t i = first; i <= last; i++) {
        double k = 2.0 * PI_DOUBLE * (double)i / HEIGHTS;
        a[i] = normal_pair(rng) * 0.5 * sqrt(1.0 / (log(2.0) * octaves * (double)i)) / k;
        a[HEIGHTS - i] = conj(a[i]);
    }
    transform(a, HEIGHTS);
    for (size_t i = 0; i < HEIGHTS; i++)
        heights[i] = creal(a[i]);
}

/* Whether a ray of the slope `rise` escapes to the right (step 1) or the left (-1) from each height. */
static void find_seen(const double *heights, double rise, int step, bool *is_seen)
{
    double highest = -1e300;
    for (int i = 2 * HEIGHTS - 1; i >= 0; i--) { /* all around twice */
        size_t at = (size_t)(step > 0 ? i : -i - 1) & (HEIGHTS - 1);
        double above = heights[at] - rise * i;
        is_seen[at] = above > highest;
        highest = fmax(highest, above);
    }
}

typedef struct marched {
    double mean_tilt; /* of the visible area, in deviations */
    double both;      /* fraction of the facets reflecting equally low light to the eye that both see */
} marched;

static marched march(double octaves, double rise, int cuts)
{
    double complex *a = malloc(HEIGHTS * sizeof *a);
    double *heights = malloc(HEIGHTS * sizeof *heights);
    bool *right = malloc(HEIGHTS), *left = malloc(HEIGHTS);
    test_rng rng = {11u};
    double area = 0.0, tilts = 0.0, mirrors = 0.0, both = 0.0;
    for (int cut = 0; cut < cuts; cut++) {
        make_cut(octaves, &rng, a, heights);
        find_seen(heights, rise, 1, right);
        find_seen(heights, rise, -1, left);
        for (size_t i = 0; i < HEIGHTS; i++) {
            double tilt = rise - 0.5 * (heights[(i + 1) & (HEIGHTS - 1)] - heights[(i - 1) & (HEIGHTS - 1)]);
            bool is_mirror = fabs(tilt - rise) < 0.05;
            area += right[i] && tilt > 0.0 ? tilt : 0.0;
            tilts += right[i] && tilt > 0.0 ? tilt * tilt : 0.0;
            mirrors += is_mirror;
            both += is_mirror && right[i] && left[i];
        }
    }
    expect_relative(area, rise * HEIGHTS * cuts, 0.01, "area seen, %g octaves", octaves);
    free(a);
    free(heights);
    free(right);
    free(left);
    return (marched){tilts / area, both / mirrors};
}

/* Mean visible tilt, of a sea; of one octave, Smith's. */
static void test_marched(void **state)
{
    (void)state;
    static const double rises[3] = {0.06, 0.5, 1.0};
    for (int k = 0; k < 3; ++k) {
        double r = rises[k], walk = 0.0;
        for (int i = 0; i < 4000; ++i) {
            double c = (r + 7.0) * (i + 0.5) / 4000.0;
            walk += c * seen_density(r, c, 1.0) * (r + 7.0) / 4000.0;
        }
        double smith_area = r * 0.5 * (1.0 + erf(r * sqrt(0.5))) + exp(-0.5 * r * r) / sqrt(2.0 * PI_DOUBLE);
        double smith = (0.5 * (1.0 + erf(r * sqrt(0.5))) * (1.0 + r * r) +
                        r * exp(-0.5 * r * r) / sqrt(2.0 * PI_DOUBLE)) /
                       smith_area;
        marched sea = march(11.0, r, 4);
        double seen =
            (double)slopes_seen(vec3(1.0f, 1.0f, 0.0f), UP, UP, normalize(vec3(1.0f, (float)r, 0.0f)));
        expect_relative(sea.mean_tilt, walk, k ? 0.03 : 0.1, "tilts seen from %g", r);
        assert_true(k == 2 || fabs(sea.mean_tilt - smith) > 1.5 * fabs(sea.mean_tilt - walk));
        expect_near(sea.both, seen * seen, 0.06, "seen from both sides, %g", r);
        double one = k ? smith : march(1.0, r, 1).mean_tilt;
        assert_true(fabs(one - smith) < 0.5 * fabs(one - walk));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_area),
                                       cmocka_unit_test(test_walk),
                                       cmocka_unit_test(test_division),
                                       cmocka_unit_test(test_tilts),
                                       cmocka_unit_test(test_mean_reflectance),
                                       cmocka_unit_test(test_calm),
                                       cmocka_unit_test(test_marched)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
