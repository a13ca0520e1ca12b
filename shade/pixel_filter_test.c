/* pixel_filter_test.c - filters against the formulas of their papers, samples against filters. */
#include "testing/chi_square.h"

static const double pi = 3.14159265358979323846;
static const char *const names[] = {"Blackman-Harris", "box", "Mitchell"};
static const double radius[] = {1.5, 0.5, 2.0};

/* ---- the curves, from their papers, in double ---- */

static double exact_blackman_harris(double x)
{
    double t = 2.0 * pi * (x + 1.5) / 3.0;
    if ((fabs)(x) > 1.5)
        return 0.0;
    return (0.35875 - 0.48829 * cos(t) + 0.14128 * cos(2.0 * t) - 0.01168 * cos(3.0 * t)) / (3.0 * 0.35875);
}

static double exact_mitchell(double x)
{
    const double B = 1.0 / 3.0, C = 1.0 / 3.0;
    double a = (fabs)(x);
    if (a < 1.0)
        return ((12.0 - 9.0 * B - 6.0 * C) * a * a * a + (-18.0 + 12.0 * B + 6.0 * C) * a * a + 6.0 -
                2.0 * B) /
               6.0;
    if (a < 2.0)
        return ((-B - 6.0 * C) * a * a * a + (6.0 * B + 30.0 * C) * a * a + (-12.0 * B - 48.0 * C) * a +
                8.0 * B + 24.0 * C) /
               6.0;
    return 0.0;
}

static double exact(int kind, double x)
{
    if (kind == PIXEL_FILTER_BLACKMAN_HARRIS)
        return exact_blackman_harris(x);
    return kind == PIXEL_FILTER_MITCHELL ? exact_mitchell(x) : (fabs)(x) <= 0.5 ? 1.0 : 0.0;
}

/* The integral of k(x) x^power, or of |k|, over [from, to]: Simpson over pieces that hold no kink. */
static double integral(int kind, double from, double to, int power, bool is_absolute)
{
    const double kinks[] = {-2.0, -1.5, -8.0 / 7.0, -1.0, -0.5, 0.0, 0.5, 1.0, 8.0 / 7.0, 1.5, 2.0};
    double sum = 0.0;
    for (size_t i = 0; i + 1 < COUNT_OF(kinks); ++i) {
        double a = (fmax)(from, kinks[i]), b = (fmin)(to, kinks[i + 1]);
        enum { STEPS = 64 };
        for (int s = 0; a < b && s <= STEPS; ++s) {
            double x = a + (b - a) * s / STEPS;
            /* from inside the piece, where the curve jumps */
            double k = exact(kind, x + ((a + b) / 2.0 - x) * 1e-12) * pow(x, power);
            sum += (is_absolute ? (fabs)(k) : k) * (b - a) / (3.0 * STEPS) *
                   (s == 0 || s == STEPS ? 1.0
                    : s % 2              ? 4.0
                                         : 2.0);
        }
    }
    return sum;
}

static void test_curves(void **state)
{
    (void)state;
    for (int i = -2500; i <= 2500; ++i) {
        float x = (float)i / 1000.0f;
        expect_near((double)blackman_harris(x), exact_blackman_harris((double)x), 3e-7, "BH at %d", i);
        expect_near((double)mitchell(x), exact_mitchell((double)x), 3e-7, "Mitchell at %d", i);
        for (int kind = 0; kind < 3; ++kind)
            expect_near((double)pixel_filter(kind, vec2(x, 0.25f)),
                        exact(kind, (double)x) * exact(kind, 0.25), 5e-7, "%s at %d", names[kind], i);
    }
    for (int kind = 0; kind < 3; ++kind)
        expect_near(integral(kind, -2.0, 2.0, 0, false), 1.0, 1e-9, "integral of %s", names[kind]);
    expect_near(integral(PIXEL_FILTER_MITCHELL, -2.0, 2.0, 0, true), 367.0 / 343.0, 1e-9, "of |Mitchell|");
    /* Mitchell's filters at integer distances add up to 1 everywhere */
    for (int i = 0; i <= 100; ++i) {
        float x = (float)i / 100.0f;
        expect_near((double)(mitchell(x - 2.0f) + mitchell(x - 1.0f) + mitchell(x) + mitchell(x + 1.0f)), 1.0,
                    1e-6, "partition of unity at %d", i);
    }
}

/* ---- samples ---- */

static void test_inversion(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; ++kind) {
        double whole = integral(kind, -2.0, 2.0, 0, true), last = -3.0;
        for (uint32_t i = 0; i <= 8192u; ++i) {
            /* both ends as close as a uniform number can get */
            uint32_t n = i < 512u ? i : i > 7680u ? 16777215u - (8192u - i) : 2048u * i;
            float u = (float)n / 16777216.0f;
            FilterSample s = sample_pixel_filter(kind, vec2(u, 0.5f));
            double x = (double)s.offset[0];
            assert_true((fabs)(x) <= radius[kind]);
            /* Newton's method for neighboring u differs by rounding, visible where the filter is nearly 0 */
            if (x < last - 2e-4)
                fail_msg("%s: falls at u = %.9g", names[kind], (double)u);
            last = x;
            expect_near(integral(kind, -2.0, x, 0, true) / whole, (double)u, 4e-7, "%s: share below %.9g",
                        names[kind], x);
            expect_near((double)s.offset[1], 0.0, 1e-6, "%s: middle", names[kind]);
            double k = exact(kind, x);
            if ((fabs)(k) > 1e-4)
                expect_near((double)s.weight, (k > 0.0 ? whole : -whole) * whole, 1e-6, "%s: weight at %.9g",
                            names[kind], x);
        }
    }
}

enum { CELLS = 48, DRAWS = 1000000 };
static double seen[CELLS * CELLS];

/* Chi-square of samples over a grid as wide as the filter against |k(x) k(y)|, which also tests that x and y
 * are independent; one fit in 1e4 would be worse by chance. */
static void test_histogram(void **state)
{
    (void)state;
    test_rng rng = {11};
    for (int kind = 0; kind < 3; ++kind) {
        double r = radius[kind], mass[CELLS], whole = integral(kind, -2.0, 2.0, 0, true);
        for (int i = 0; i < CELLS; ++i)
            mass[i] =
                integral(kind, r * (2.0 * i / CELLS - 1.0), r * (2.0 * (i + 1) / CELLS - 1.0), 0, true) /
                whole;
        memset(seen, 0, sizeof seen);
        for (int i = 0; i < DRAWS; ++i) {
            vec2 at = sample_pixel_filter(kind, rng_vec2(&rng)).offset;
            int x = (int)(((double)at[0] + r) / (2.0 * r) * CELLS),
                y = (int)(((double)at[1] + r) / (2.0 * r) * CELLS);
            x = x < CELLS ? x : CELLS - 1;
            y = y < CELLS ? y : CELLS - 1;
            ++seen[y * CELLS + x];
        }
        double chi2 = 0.0, pooled_expected = 0.0, pooled_seen = 0.0;
        int freedom = -1;
        for (int i = 0; i < CELLS * CELLS; ++i) {
            double expected = DRAWS * mass[i % CELLS] * mass[i / CELLS];
            if (expected < 10.0) {
                pooled_expected += expected;
                pooled_seen += seen[i];
                continue;
            }
            chi2 += (seen[i] - expected) * (seen[i] - expected) / expected;
            ++freedom;
        }
        if (pooled_expected > 10.0) {
            chi2 += (pooled_seen - pooled_expected) * (pooled_seen - pooled_expected) / pooled_expected;
            ++freedom;
        }
        double p = chi2_p_value(chi2, freedom);
        if (!(p > 1e-4))
            fail_msg("%s: chi-square %.1f with %d degrees of freedom", names[kind], chi2, freedom);
    }
}

/* A mean over samples is the filtered image: constants, ramps, and squares, whose means are the moments of
 * the filter. */
static void test_expectation(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; ++kind) {
        enum { COUNT = 367 * 4096 /* no stratum lies on both sides of Mitchell's change of sign */ };
        double sum[4] = {0.0}, whole = integral(kind, -2.0, 2.0, 0, true);
        for (int i = 0; i < COUNT; ++i) {
            float u = ((float)i + 0.5f) / (float)COUNT;
            /* the center of the other axis: its weight is positive */
            FilterSample s = sample_pixel_filter(kind, vec2(u, 0.5f)),
                         t = sample_pixel_filter(kind, vec2(0.5f, u));
            double w = (double)s.weight / whole;
            assert_true(s.weight == t.weight && s.offset[0] == t.offset[1]);
            for (int power = 0; power < 4; ++power)
                sum[power] += w * pow((double)s.offset[0], power) / COUNT;
        }
        double second = integral(kind, -2.0, 2.0, 2, false);
        const double expected[4] = {1.0, 0.0, second, 0.0};
        for (int i = 0; i < 4; ++i)
            expect_near(sum[i], expected[i], i == 0 ? 2e-7 : 1e-5, "%s: moment %d", names[kind], i);
    }
    /* and with random numbers: the weight's variance is W^4 - 1 */
    test_rng rng = {5};
    double sum = 0.0, deviation = sqrt((pow(367.0 / 343.0, 4.0) - 1.0) / DRAWS);
    for (int i = 0; i < DRAWS; ++i)
        sum += (double)sample_pixel_filter(PIXEL_FILTER_MITCHELL, rng_vec2(&rng)).weight;
    expect_near(sum / DRAWS, 1.0, 4.0 * deviation, "mean of Mitchell's weights");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_curves),
        cmocka_unit_test(test_inversion),
        cmocka_unit_test(test_histogram),
        cmocka_unit_test(test_expectation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
