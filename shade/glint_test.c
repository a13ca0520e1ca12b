/* glint_test.c - the variates have their stated moments, in cells and over time, and the mean is preserved. */
#include "testing/test_support.h"

static const double PI_DOUBLE = 3.14159265358979324;

typedef struct moments {
    double mean, variance;
} moments;

/* A cell of one footprint, seen at a position given by `key`. */
static GlintCell cell_of(uint key)
{
    GlintCell c;
    c.key = glint_hash(key);
    c.at = vec2(glint_uniform(glint_hash(c.key ^ 7u)), glint_uniform(glint_hash(c.key ^ 77u)));
    c.radius = vec2(0.5f, 0.5f);
    c.area = 1.0f;
    return c;
}

/* Moments of the variate of many cells at a time. */
static moments moments_of(float count, float time_s, int cells)
{
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < cells; ++i) {
        double X = (double)glint_variate(cell_of((uint)i), count, time_s, 0.02f);
        assert_true(X >= 0.0);
        sum += X;
        squares += X * X;
    }
    double mean = sum / cells;
    return (moments){mean, squares / cells - mean * mean};
}

/* For two slots with the weights s and 1 - s, 2 / 3 = E(s^2 + (1 - s)^2): many glints are uniform, few are
 * splats of the second moment M. */
static void test_moments(void **state)
{
    (void)state;
    const float counts[6] = {0.05f, 0.5f, 2.0f, 7.0f, 20.0f, 60.0f};
    const double M = 1.8 / PI_DOUBLE * 4.0; /* 9 / pi^2 pi / 5, over the product of radii */
    for (int i = 0; i < 6; ++i) {
        double n = (double)counts[i];
        int cells = (n < 0.3 ? 1000000 : 250000) / CASE_STEP;
        double variance = n > 1.0 ? 2.0 / n : M * (2.0 / 3.0 + 2.0 / n) - 2.0 / 3.0;
        double deviation = sqrt(variance / cells); /* of the mean */
        moments m = moments_of(counts[i], 1.37f, cells);
        expect_near(m.mean, 1.0, 3.0 * deviation, "mean of %g glints", n);
        expect_relative(m.variance, variance, n < 0.3 ? 0.05 : 0.1, "variance of %g glints", n);
    }
    /* none where glints are many, and no step in between */
    assert_true(glint_seen(vec2(1.0f, 2.0f), 0.1f, 0.5f, GLINT_COUNT_MAX * 1.01f, 0.0f, 0.02f) == 1.0f);
    moments fading = moments_of(0.999f * GLINT_COUNT_MAX, 0.0f, 10000);
    assert_true(fading.variance < 1e-6);
}

/* Compound Poisson variates, however few: the mean is preserved, which 1 - e^-n of small n would lose. Their
 * fourth cumulant is 24 / n^3, so that a measured variance of N has the relative deviation sqrt((6 / n + 2) /
 * N). */
static void test_sum(void **state)
{
    (void)state;
    for (float n = 0.001f; n < 100.0f; n *= 5.0f) {
        double sum = 0.0, squares = 0.0;
        int draws = 2000000 / CASE_STEP, none = 0;
        for (int i = 0; i < draws; ++i) {
            double x = (double)glint_sum(glint_hash((uint)i), n);
            none += x == 0.0;
            sum += x;
            squares += x * x;
        }
        double variance = 2.0 / (double)n, mean = sum / draws;
        expect_near(mean, 1.0, 3.5 * sqrt(variance / draws), "mean of a sum of %g", (double)n);
        expect_relative(squares / draws - mean * mean, variance,
                        0.02 + 3.0 * sqrt((6.0 / (double)n + 2.0) / draws), "variance of a sum of %g",
                        (double)n);
        expect_near((double)none / draws, exp(-(double)n), 2e-3, "chance of none of %g", (double)n);
    }
}

/* Pixels of an image from 2 m above the water, each with its own expected number: the mean is preserved in
 * every part, for few or many glints, and for one or sixteen samples a pixel. */
static double lit_by(int x, int y, int samples, float density)
{
    double X = 0.0;
    for (int i = 0; i < samples * samples; ++i) {
        float step = 1.0f / (float)samples;
        float azimuth = 0.001f * ((float)x + step * ((float)(i % samples) + 0.5f));
        float down = 0.02f + 0.001f * ((float)y + step * ((float)(i / samples) + 0.5f));
        float distance = 2.0f / down;
        float width = 0.001f * distance;
        vec2 rest = vec2(distance * cos(azimuth), distance * sin(azimuth));
        X += (double)glint_seen(rest, width, down, density * width * width / down, 0.5f, 0.02f);
    }
    return X / (samples * samples);
}
static void test_energy(void **state)
{
    (void)state;
    enum { ACROSS = 400, DOWN = 300 };
    for (int samples = 1; samples <= 2; ++samples)
        for (float density = 1.0f; density < 2e5f; density *= 8.0f) {
            double sum = 0.0, squares = 0.0;
            int count = 0;
            for (int y = 0; y < DOWN; y += CASE_STEP)
                for (int x = 0; x < ACROSS; ++x) {
                    double X = lit_by(x, y, samples, density);
                    sum += X;
                    squares += X * X;
                    count++;
                }
            double mean = sum / count, variance = squares / count - mean * mean;
            /* pixels that share a cell are not independent: up to 16 x 4 of them */
            expect_near(mean, 1.0, 3.0 * sqrt(variance * 8.0 / count), "light of %g per m^2",
                        (double)density);
        }
}

/* A splat has the same sum wherever it lies between pixels. */
static void test_image(void **state)
{
    (void)state;
    GlintCell c;
    c.radius = vec2(0.125f, 0.25f);
    for (uint key = 1; key < 100; ++key) {
        double sum = 0.0;
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 32; ++x) { /* pixels of a quarter of a radius */
                c.at = vec2(((float)x + 0.5f) / 32.0f, ((float)y + 0.5f) / 16.0f);
                sum += (double)glint_image(c, key) / 512.0;
            }
        expect_near(sum, 1.0, 0.01, "image %g", (double)key);
        sum = 0.0;
        for (int i = 0; i < 32; ++i) { /* pixels as wide as a radius */
            c.at = vec2(((float)(i % 8) + 0.5f) / 8.0f, ((float)(i / 8) + 0.5f) / 4.0f);
            sum += (double)glint_image(c, key) / 32.0;
        }
        expect_near(sum, 1.0, 0.08, "coarse image %g", (double)key);
    }
}

/* From frame to frame a cell is constant during the lifetime of its glints, and changes afterwards. */
static void test_time(void **state)
{
    (void)state;
    double product[3] = {0, 0, 0}, sum = 0.0, squares = 0.0;
    const float steps[3] = {0.002f, 0.02f, 0.2f}, lifetime = 0.02f, count = 4.0f;
    int samples = 60000 / CASE_STEP;
    for (int i = 0; i < samples; ++i) {
        GlintCell cell = cell_of((uint)i);
        float t = 0.011f * (float)(i & 255);
        double X = (double)glint_variate(cell, count, t, lifetime) - 1.0;
        sum += X;
        squares += X * X;
        for (int k = 0; k < 3; ++k)
            product[k] += X * ((double)glint_variate(cell, count, t + steps[k], lifetime) - 1.0);
    }
    assert_true(fabs(sum / samples) < 0.02);
    assert_true(product[0] / squares > 0.8);
    assert_true(product[1] / squares > 0.2 && product[1] < product[0]);
    assert_true(fabs(product[2] / squares) < 0.05);
}

/* Cells: a footprint has one, a footprint twice as wide has half of the cells, cells are wider where
 * glints are few, and they stay with the water. */
static void test_cells(void **state)
{
    (void)state;
    const float counts[3] = {4.0f, 0.25f, 1e-4f}, wider[3] = {1.0f, 2.0f, GLINT_CELL_MAX};
    for (float width = 0.01f; width < 1.0f; width *= 1.7f)
        for (int k = 0; k < 3; ++k) {
            int changes = 0;
            enum { STEPS = 40000 };
            uint last = 0;
            for (int i = 0; i < STEPS; ++i) {
                GlintCell cell =
                    glint_cell(vec2(0.0005f * (float)i - 3.0f, 0.77f), vec2(width, 0.5f), counts[k]);
                changes += i > 0 && cell.key != last;
                last = cell.key;
                assert_true(cell.at[0] >= 0.0f && cell.at[0] <= 1.0f && cell.radius[0] <= 0.5f);
                assert_true(cell.area >= GLINT_IMAGE && cell.area <= 64.01f);
            }
            double mean = 0.0005 * STEPS / changes, wanted = (double)(width * wider[k]);
            assert_true(mean > 0.6 * wanted && mean < 1.7 * wanted);
        }
    vec2 width = vec2(0.3f, 0.3f);
    assert_true(glint_cell(vec2(0.1f, 0.1f), width, 1.0f).key ==
                glint_cell(vec2(0.1001f, 0.1f), width, 1.0f).key);
    assert_true(glint_cell(vec2(5.0f, 0.1f), width, 1.0f).key !=
                glint_cell(vec2(0.1f, 0.1f), width, 1.0f).key);
}

/* A pixel straight ahead, and one below the eye, where the azimuth is undefined. */
static void test_places(void **state)
{
    (void)state;
    vec2 ahead = glint_place(vec2(0.0f, 100.0f));
    expect_near((double)ahead[0], 100.0, 1e-5, "distance");
    expect_near((double)ahead[1], 0.5 * PI_DOUBLE, 1e-6, "azimuth");
    vec2 extent = glint_extent(ahead, 0.1f, 0.05f);
    expect_near((double)extent[0], 2.0, 1e-6, "length");
    expect_near((double)extent[1], 0.001, 1e-9, "angle");
    vec2 below = glint_place(vec2(0.0f, 0.0f));
    assert_true(isfinite(below[1]) && glint_extent(below, 0.1f, 1.0f)[1] <= 1.0f);
}

/* Density at the peak, n0 = m4 / (2 sqrt 3 pi mss), of whole seas: golden numbers, 10 to 20 m/s. */
static void test_density(void **state)
{
    (void)state;
    const double rows[][3] = {{5, 1810, 5.8e3},     {7.5, 3990, 8.9e3},  {10, 6540, 1.11e4},
                              {12.5, 8530, 1.17e4}, {15, 10160, 1.17e4}, {20, 12770, 1.11e4}};
    const vec3 up = vec3(0.0f, 1.0f, 0.0f), point = vec3(1e-13f, 1e-13f, 0.0f);
    for (size_t i = 0; i < COUNT_OF(rows); ++i) {
        float variance = (float)(0.5 * (0.003 + 0.00512 * rows[i][0]));
        float n = glint_count(WATER_BECKMANN, vec3(variance, variance, 0.0f), point, up, up,
                              (float)rows[i][1], 1.0f, 0.0f);
        expect_relative(n, rows[i][2], 0.012, "glints per m^2 at %g m/s", rows[i][0]);
    }
    /* at 10 m, pixels of 1 mrad at 80 degrees: about 6; an exposure of two lifetimes has three times as many */
    float area = (float)(100.0 * 1e-6 / cos(1.3962634));
    float n = glint_count(WATER_BECKMANN, vec3(0.0271f, 0.0271f, 0.0f), point, up, up, 6540.0f, area, 0.0f);
    expect_near((double)n, 6.4, 0.2, "glints in a pixel");
    expect_relative(
        glint_count(WATER_BECKMANN, vec3(0.0271f, 0.0271f, 0.0f), point, up, up, 6540.0f, area, 2.0f),
        3.0 * (double)n, 1e-5, "exposure");
}

/* Still water, and any of small curvature, resolves the disc, without randomness; glints as large as a pixel
 * have a quarter of the variance of one that shows all of the disc or nothing; with more of them it falls as
 * one over their number. */
static void test_disc(void **state)
{
    (void)state;
    const vec3 up = vec3(0.0f, 1.0f, 0.0f), S = vec3(4e-6f, 1e-6f, 0.0f);
    const vec3 H = normal_from_slope(vec2(0.0005f, 0.0003f));
    const float m4 = 50.0f;
    for (float variance = 1e-8f; variance < 0.1f; variance *= 4.0f) {
        vec3 C = vec3(variance, 0.5f * variance, 0.0f);
        double c = 2.0 * PI_DOUBLE * 2e-6 * (double)sun_density(WATER_BECKMANN, C, S, slope_from_normal(H));
        assert_true(c > 0.0 && c < 1.001);
        assert_true(glint_count(WATER_BECKMANN, C, S, up, H, 0.0f, 1.0f, 0.0f) > GLINT_COUNT_MAX);
        if (c > 0.999) {
            assert_true(glint_count(WATER_BECKMANN, C, S, up, H, m4, 1e-4f, 0.0f) > GLINT_COUNT_MAX);
            continue;
        }
        double a = 8.0 * PI_DOUBLE * sqrt(3.0) / (double)m4 / (5e5 + 4.0 / 3.0 / (double)variance);
        float one = glint_count(WATER_BECKMANN, C, S, up, H, m4, (float)a, 0.0f);
        expect_relative(2.0 / (double)one, 0.25 * (1.0 - c) / c, 2e-3, "variance of one, slopes %g",
                        (double)variance);
        float many = glint_count(WATER_BECKMANN, C, S, up, H, m4, (float)(500.0 * a), 1.0f);
        expect_relative(2.0 / (double)many, 1e-3 * (1.0 - c) / c, 4e-3, "variance of many, slopes %g",
                        (double)variance);
    }
}

static void test_gamma(void **state)
{
    (void)state;
    for (float k = 1.0f; k < 40.0f; k *= 2.3f) { /* against the normal distribution's own quadrature */
        double mean = 0.0, squares = 0.0;
        for (int i = -600; i <= 600; ++i) {
            double z = 0.01 * i, weight = 0.01 * exp(-0.5 * z * z) / sqrt(2.0 * PI_DOUBLE),
                   x = (double)gamma_variate(k, (float)z);
            mean += weight * x;
            squares += weight * x * x;
        }
        expect_relative(mean, (double)k, 1e-3, "mean of Gamma(%g)", (double)k);
        expect_relative(squares - mean * mean, (double)k, 0.006, "variance of Gamma(%g)", (double)k);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_moments), cmocka_unit_test(test_sum),     cmocka_unit_test(test_energy),
        cmocka_unit_test(test_image),   cmocka_unit_test(test_time),    cmocka_unit_test(test_cells),
        cmocka_unit_test(test_places),  cmocka_unit_test(test_density), cmocka_unit_test(test_disc),
        cmocka_unit_test(test_gamma),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
