/* glint_test.c - chance has the moments that it is said to have, in cells and over time, and nothing is lost or won. */
#include "testing/test_support.h"

static const double PI_DOUBLE = 3.14159265358979324;

typedef struct moments {
    double mean, variance;
} moments;

/* Of the variate of many cells at a time. */
static moments moments_of(float count, float time_s, int cells)
{
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < cells; ++i) {
        double X = (double)glint_variate(glint_hash((uint)i), count, time_s, 0.02f);
        assert_true(X >= 0.0);
        sum += X;
        squares += X * X;
    }
    double mean = sum / cells;
    return (moments){mean, squares / cells - mean * mean};
}

static void test_moments(void **state)
{
    (void)state;
    const float counts[6] = {0.05f, 0.5f, 2.0f, 7.0f, 20.0f, 60.0f};
    for (int i = 0; i < 6; ++i) {
        double n = (double)counts[i];
        int cells = (n < 0.3 ? 1000000 : 250000) / CASE_STEP;
        double deviation = (sqrt)(2.0 / n / cells); /* of the mean */
        moments m = moments_of(counts[i], 1.37f, cells);
        expect_near(m.mean, 1.0, fmax(0.004, 3.0 * deviation), "mean of %g glints", n);
        expect_relative(m.variance, 2.0 / n, 0.1, "variance of %g glints", n);
    }
    /* none where they are many, and no step in between */
    assert_true(glint_variate(1u, GLINT_COUNT_MAX * 1.01f, 0.0f, 0.02f) == 1.0f);
    moments fading = moments_of(0.999f * GLINT_COUNT_MAX, 0.0f, 10000);
    assert_true(fading.variance < 1e-6);
}

/* A million pixels of which each has its own expected number: the picture's mean stays, as does each part's. */
static void test_energy(void **state)
{
    (void)state;
    enum { SIZE = 1000 };
    double with = 0.0, without = 0.0;
    for (int y = 0; y < SIZE; y += CASE_STEP)
        for (int x = 0; x < SIZE; x += CASE_STEP) {
            vec2 rest = vec2(0.013f * (float)x, 0.031f * (float)y);
            double light = (exp)(-1e-5 * ((x - 500) * (x - 500) + (y - 300) * (y - 300)));
            uint cell = glint_cell(rest, vec2(0.013f, 0.031f));
            with += light * (double)glint_variate(cell, (float)(20.0 * light), 0.5f, 0.02f);
            without += light;
        }
    expect_relative(with, without, CASE_STEP == 1 ? 0.01 : 0.03, "light of a picture");
}

/* The mean over time of one cell is 1; from frame to frame it is alike while glints live and another after. */
static void test_time(void **state)
{
    (void)state;
    double product[3] = {0, 0, 0}, sum = 0.0, squares = 0.0;
    const float steps[3] = {0.002f, 0.02f, 0.2f}, lifetime = 0.02f, count = 4.0f;
    int samples = 60000 / CASE_STEP;
    for (int i = 0; i < samples; ++i) {
        uint cell = glint_hash((uint)i);
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

/* Cells: a footprint sees one, twice as wide one has half of the cells, and they stay where the water is. */
static void test_cells(void **state)
{
    (void)state;
    for (float width = 0.01f; width < 1.0f; width *= 1.7f) {
        int changes = 0;
        enum { STEPS = 40000 };
        uint last = 0;
        for (int i = 0; i < STEPS; ++i) {
            uint cell = glint_cell(vec2(0.0005f * (float)i - 3.0f, 0.77f), vec2(width, 0.5f));
            changes += i > 0 && cell != last;
            last = cell;
        }
        double mean = 0.0005 * STEPS / changes;
        assert_true(mean > 0.6 * (double)width && mean < 1.7 * (double)width);
    }
    assert_true(glint_cell(vec2(0.1f, 0.1f), vec2(0.3f, 0.3f)) ==
                glint_cell(vec2(0.1001f, 0.1f), vec2(0.3f, 0.3f)));
    assert_true(glint_cell(vec2(5.0f, 0.1f), vec2(0.3f, 0.3f)) !=
                glint_cell(vec2(0.1f, 0.1f), vec2(0.3f, 0.3f)));
}

/* Density at the peak, n0 = m4 / (2 sqrt 3 pi mss), of whole seas: golden numbers, 10 to 20 m/s. */
static void test_density(void **state)
{
    (void)state;
    const double rows[][3] = {{5, 1810, 5.8e3},     {7.5, 3990, 8.9e3},  {10, 6540, 1.11e4},
                              {12.5, 8530, 1.17e4}, {15, 10160, 1.17e4}, {20, 12770, 1.11e4}};
    vec3 up = vec3(0.0f, 1.0f, 0.0f);
    for (size_t i = 0; i < COUNT_OF(rows); ++i) {
        float variance = (float)(0.5 * (0.003 + 0.00512 * rows[i][0]));
        float n = glint_count(WATER_BECKMANN, vec3(variance, variance, 0.0f), up, up, (float)rows[i][1], 1.0f,
                              0.0f);
        expect_relative(n, rows[i][2], 0.012, "glints per m^2 at %g m/s", rows[i][0]);
    }
    /* 10 m away, pixels of 1 mrad at 80 degrees: some 6; in twice the time that one lives three times as many */
    float area = (float)(100.0 * 1e-6 / (cos)(1.3962634));
    float n = glint_count(WATER_BECKMANN, vec3(0.0271f, 0.0271f, 0.0f), up, up, 6540.0f, area, 0.0f);
    expect_near((double)n, 6.4, 0.2, "glints in a pixel");
    expect_relative(glint_count(WATER_BECKMANN, vec3(0.0271f, 0.0271f, 0.0f), up, up, 6540.0f, area, 2.0f),
                    3.0 * (double)n, 1e-5, "exposure");
}

static void test_gamma(void **state)
{
    (void)state;
    for (float k = 1.0f; k < 40.0f; k *= 2.3f) { /* against the normal distribution's own quadrature */
        double mean = 0.0, squares = 0.0;
        for (int i = -600; i <= 600; ++i) {
            double z = 0.01 * i, weight = 0.01 * (exp)(-0.5 * z * z) / (sqrt)(2.0 * PI_DOUBLE),
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
        cmocka_unit_test(test_moments), cmocka_unit_test(test_energy),  cmocka_unit_test(test_time),
        cmocka_unit_test(test_cells),   cmocka_unit_test(test_density), cmocka_unit_test(test_gamma),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
