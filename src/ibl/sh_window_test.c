/* sh_window_test.c - harmonics turned, their least values, and windows against ringing. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "ibl/sh.h"

static const double pi = 3.14159265358979323846;

static double random_number(uint32_t *state) /* [-1, 1) */
{
    lcg_next(state);
    return (double)(*state >> 8) / 8388608.0 - 1.0;
}

static double evaluate(const double c[SH_COUNT], const double d[3])
{
    double basis[SH_COUNT];
    double sum = 0.0;
    sh_basis(d, basis);
    for (int k = 0; k < SH_COUNT; k++)
        sum += c[k] * basis[k];
    return sum;
}

/* The least value on a grid of the sphere and, from its best place, by steps that halve. */
static double search_least(const double c[SH_COUNT])
{
    enum { ROWS = 60 };
    double best = (double)INFINITY;
    double theta = 0.0;
    double phi = 0.0;
    for (int y = 0; y <= ROWS; y++)
        for (int x = 0; x < 2 * ROWS; x++) {
            double t = pi * y / ROWS;
            double p = pi * x / ROWS;
            double value = evaluate(c, (double[3]){sin(t) * cos(p), cos(t), sin(t) * sin(p)});
            if (value < best) {
                best = value;
                theta = t;
                phi = p;
            }
        }
    for (double step = pi / ROWS; step > 1e-9; step *= 0.5)
        for (int turn = 0; turn < 4; turn++)
            for (int k = 0; k < 4; k++) {
                double t = theta + (k == 0 ? step : k == 1 ? -step : 0.0);
                double p = phi + (k == 2 ? step : k == 3 ? -step : 0.0);
                double value = evaluate(c, (double[3]){sin(t) * cos(p), cos(t), sin(t) * sin(p)});
                if (value < best) {
                    best = value;
                    theta = t;
                    phi = p;
                }
            }
    return best;
}

static void minima_are_those_of_a_dense_search(void **state)
{
    (void)state;
    uint32_t seed = 7;
    for (int i = 0; i < 100; i++) {
        double c[SH_COUNT];
        for (int k = 0; k < SH_COUNT; k++)
            c[k] = random_number(&seed);
        if (i % 4 == 1) /* one band alone */
            for (int k = 4; k < SH_COUNT; k++)
                c[k] = 0.0;
        if (i % 4 == 2) /* the hard case: nothing along the least axis */
            c[1] = c[2] = c[3] = 0.0;
        if (i % 8 == 3) /* axes of equal length */
            c[4] = c[5] = c[7] = c[8] = 0.0;
        assert_near(sh_minimum(c), search_least(c), 1e-8);
    }
    assert_near(sh_minimum((double[SH_COUNT]){1.0}), 0.28209479177387814, 1e-12);
    /* 1/4 + z/2 + 5/32 (3 z^2 - 1), the irradiance of a sun at +Z over pi, is least at z = -8/15: -19/480 */
    double sun[SH_COUNT] = {0.25 / 0.28209479177387814,      0, 0.5 / 0.48860251190291992, 0, 0, 0,
                            5.0 / 32.0 / 0.31539156525252005};
    assert_near(sh_minimum(sun), -19.0 / 480.0, 1e-12);
}

/* The rotated function at d is the function at d rotated back. */
static void rotated_harmonics_are_the_rotated_function(void **state)
{
    (void)state;
    uint32_t seed = 3;
    double c[SH_COUNT][3], turned[SH_COUNT][3];
    for (int k = 0; k < SH_COUNT; k++)
        for (int i = 0; i < 3; i++)
            c[k][i] = random_number(&seed);
    for (int n = 0; n < 20; n++) {
        double angle = 4.0 * random_number(&seed);
        double d[3] = {random_number(&seed), random_number(&seed), random_number(&seed)};
        double scale = 1.0 / sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        for (int i = 0; i < 3; i++)
            d[i] *= scale;
        /* from +Z towards +X */
        double to[3] = {d[0] * cos(angle) + d[2] * sin(angle), d[1], d[2] * cos(angle) - d[0] * sin(angle)};
        memcpy(turned, c, sizeof c);
        sh_rotate(turned, angle);
        for (int i = 0; i < 3; i++) {
            double before[SH_COUNT], after[SH_COUNT];
            for (int k = 0; k < SH_COUNT; k++) {
                before[k] = c[k][i];
                after[k] = turned[k][i];
            }
            assert_near(evaluate(after, to), evaluate(before, d), 1e-12);
        }
    }
}

static void windows_are_powers_of_sinc(void **state)
{
    (void)state;
    double factors[2];
    sh_window(0.0, factors);
    assert_true(factors[0] == 1.0 && factors[1] == 1.0);
    sh_window(1.0 / 3.0, factors); /* sinc(pi / 3) = 3 sqrt 3 / 2 pi, sinc(2 pi / 3) half of it */
    double sinc = 1.5 * sqrt(3.0) / pi;
    assert_near(factors[0], sinc * sinc * sinc * sinc, 1e-12);
    assert_near(factors[1], sinc * sinc * sinc * sinc / 16.0, 1e-12);
}

static double least_irradiance(double radiance[SH_COUNT][3], int channel)
{
    double irradiance[SH_COUNT][3], one[SH_COUNT];
    sh_irradiance((const double(*)[3])radiance, irradiance);
    for (int k = 0; k < SH_COUNT; k++)
        one[k] = irradiance[k][channel];
    return sh_minimum(one);
}

/* For a sun in any direction the window just removes negative irradiance, equally in all channels. */
static void deringing_removes_exactly_the_negative_lobes(void **state)
{
    (void)state;
    uint32_t seed = 11;
    double narrowness = 0.0;
    for (int n = 0; n < 20; n++) {
        double d[3] = {random_number(&seed), random_number(&seed), random_number(&seed)};
        double scale = 1.0 / sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        for (int i = 0; i < 3; i++)
            d[i] *= scale;
        double basis[SH_COUNT], radiance[SH_COUNT][3], before[SH_COUNT][3];
        sh_basis(d, basis);
        for (int k = 0; k < SH_COUNT; k++) {
            radiance[k][0] = 5.0 * basis[k];
            radiance[k][1] = k == 0 ? 1.0 : 0.01 * basis[k]; /* nothing to repair */
            radiance[k][2] = 0.0;
        }
        memcpy(before, radiance, sizeof before);
        assert_true(least_irradiance(radiance, 0) < -0.1);
        double w = sh_dering(radiance);
        assert_true(least_irradiance(radiance, 0) >= 0.0);
        assert_true(least_irradiance(radiance, 0) < 1e-4);
        assert_true(n == 0 || fabs(w - narrowness) < 1e-9); /* whatever the direction */
        narrowness = w;
        double factors[2];
        sh_window(w, factors);
        for (int k = 0; k < SH_COUNT; k++)
            for (int i = 0; i < 2; i++)
                assert_near(radiance[k][i], before[k][i] * (k == 0 ? 1.0 : factors[k < 4 ? 0 : 1]), 1e-12);
    }
    print_message("a sun is windowed to %.4f bands\n", 1.0 / narrowness);
    double calm[SH_COUNT][3] = {{1.0, 1.0, 1.0}, {0.2, 0.0, -0.1}};
    double same[SH_COUNT][3];
    memcpy(same, calm, sizeof same);
    assert_true(sh_dering(calm) == 0.0);
    assert_memory_equal(calm, same, sizeof same);
    double black[SH_COUNT][3] = {{0}};
    assert_true(sh_dering(black) == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(minima_are_those_of_a_dense_search),
        cmocka_unit_test(rotated_harmonics_are_the_rotated_function),
        cmocka_unit_test(windows_are_powers_of_sinc),
        cmocka_unit_test(deringing_removes_exactly_the_negative_lobes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
