/* sampler_test.c - a path's random numbers: stratified over a pixel's samples, also several pairs
 * together; independent between pixels; independent of what was drawn before. */
#include "shade/testing/chi_square.h"

#include "path/sampler.h"

enum { DIMENSIONS = 2 * PATH_SAMPLER_ORDERS };

/* Pair number `pair` of a path whose vertices draw four each. */
static vec2 pair_of(uint32_t x, uint32_t y, uint32_t index, uint32_t pair)
{
    path_sampler s = path_sampler_start(3, x, y, index);
    path_sampler_begin(&s, pair / PATH_SAMPLER_PAIRS);
    for (uint32_t k = 0; k < pair % PATH_SAMPLER_PAIRS; k++)
        path_sampler_pair(&s);
    return path_sampler_pair(&s);
}

/* ---- one pair ---- */

/* Each pair of a pixel's first 2^m samples is a net, further vertices' and further pairs' of a vertex as
 * well. */
static void every_pair_is_even(void **state)
{
    (void)state;
    enum { M = 6, COUNT = 1 << M };
    for (uint32_t vertex = 0; vertex < 10; vertex++)
        for (uint32_t dimension = 0; dimension < 11; dimension++)
            for (int wide = 0; wide <= M; wide++) {
                unsigned char hits[COUNT] = {0};
                for (uint32_t i = 0; i < COUNT; i++) {
                    path_sampler s = path_sampler_start(1, 17, 23, i);
                    path_sampler_begin(&s, vertex);
                    vec2 p = path_sampler_pair(&s);
                    for (uint32_t k = 0; k < dimension; k++)
                        p = path_sampler_pair(&s);
                    int column = (int)(p[0] * (float)(1 << wide)),
                        row = (int)(p[1] * (float)(1 << (M - wide)));
                    hits[row << wide | column]++;
                }
                for (int k = 0; k < COUNT; k++)
                    assert_int_equal(hits[k], 1);
            }
}

static void pairs_do_not_depend_on_earlier_ones(void **state)
{
    (void)state;
    for (uint32_t vertex = 1; vertex < 12; vertex++) {
        path_sampler a = path_sampler_start(9, 5, 6, 7), b = a;
        for (uint32_t v = 0; v < vertex; v++) {
            path_sampler_begin(&b, v);
            for (uint32_t k = 0; k < 3 * v % 13; k++)
                path_sampler_pair(&b);
        }
        path_sampler_begin(&a, vertex);
        path_sampler_begin(&b, vertex);
        for (int k = 0; k < 12; k++) {
            vec2 p = path_sampler_pair(&a), q = path_sampler_pair(&b);
            assert_true(p[0] == q[0] && p[1] == q[1]);
        }
    }
}

/* ---- pairs together ---- */

/* The digits in which two indices that differ by e differ first, in a dimension of a chosen order. */
static int first_digit(uint32_t e, int dimension)
{
    uint32_t i = sobol_order(e, path_sampler_orders[dimension / 2]);
    uint32_t d = dimension % 2 ? sobol_second(i) : i;
    return d ? __builtin_ctz(d) : 32;
}

/* n times the variance of a mean of n points of the product over `count` dimensions of 1 + 12^(1/2) g (x -
 * 1/2), scrambled as Owen does: points whose digits differ first in number k have a covariance of 1 -
 * (7/4) 4^-k of the variance in that dimension, and differences are those of all indices to 0. Random
 * points: (1 + g^2)^count - 1. */
static double variance_of(const int dimensions[], int count, double g, uint32_t n)
{
    double sum = 0.0;
    for (uint32_t e = 0; e < n; e++) {
        double product = 1.0;
        for (int d = 0; d < count; d++) {
            int k = first_digit(e, dimensions[d]);
            product *= 1.0 + g * g * (1.0 - 1.75 * (ldexp)(1.0, -2 * k));
        }
        sum += product;
    }
    return sum - n;
}

/* The same by drawing: the formula is no fiction. */
static double measured_variance(const int dimensions[], int count, double g, uint32_t n)
{
    enum { TRIES = 3000 };
    double square = 0.0;
    for (uint32_t t = 0; t < TRIES; t++) {
        double mean = 0.0;
        for (uint32_t i = 0; i < n; i++) {
            double product = 1.0;
            for (int d = 0; d < count; d++) {
                vec2 p = pair_of(t, 11, i, (uint32_t)dimensions[d] / 2);
                product *= 1.0 + 3.4641016151377544 * g * ((double)p[dimensions[d] % 2] - 0.5);
            }
            mean += product / n;
        }
        square += (mean - 1.0) * (mean - 1.0) / TRIES;
    }
    return square * n;
}

/* Means over all two of the 16 pairs, as the comment in sampler.h says; shuffled at random they have 2.0
 * whatever n is, and random points 4.06. No two are much worse than that. */
static void pairs_are_even_together(void **state)
{
    (void)state;
    const double g = sqrt(0.5);
    const struct {
        uint32_t n;
        double mean, worst;
    } cases[] = {{16, 1.90, 5.2}, {64, 0.90, 3.0}, {256, 0.26, 2.7}, {1024, 0.08, 1.0}};
    for (size_t k = 0; k < COUNT_OF(cases); k++) {
        double sum = 0.0, worst = 0.0;
        for (int a = 0; a < PATH_SAMPLER_ORDERS; a++)
            for (int b = 0; b < a; b++) {
                const int dimensions[4] = {2 * a, 2 * a + 1, 2 * b, 2 * b + 1};
                double v = variance_of(dimensions, 4, g, cases[k].n);
                sum += v;
                worst = v > worst ? v : worst;
            }
        double mean = sum / (PATH_SAMPLER_ORDERS * (PATH_SAMPLER_ORDERS - 1) / 2);
        print_message("%u samples: %.2f / n, at worst %.2f / n\n", cases[k].n, mean, worst);
        assert_true(mean < cases[k].mean && worst < cases[k].worst);
    }
    /* a pixel's place with the first surface's light: measured as well */
    const int place_and_light[4] = {0, 1, 8, 9};
    double expected = variance_of(place_and_light, 4, g, 64);
    assert_true(expected < 1.2);
    expect_relative(measured_variance(place_and_light, 4, g, 64), expected, 0.15, "64 samples");
}

/* All 32 dimensions at once; random points: 1.1^32 - 1 = 20.1. */
static void all_dimensions_are_even_together(void **state)
{
    (void)state;
    int dimensions[DIMENSIONS];
    for (int d = 0; d < DIMENSIONS; d++)
        dimensions[d] = d;
    double v16 = variance_of(dimensions, DIMENSIONS, sqrt(0.1), 16);
    double v64 = variance_of(dimensions, DIMENSIONS, sqrt(0.1), 64);
    double v1024 = variance_of(dimensions, DIMENSIONS, sqrt(0.1), 1024);
    assert_true(v16 < 17.6 && v64 < 13.3 && v1024 < 11.7);
}

/* ---- pixels ---- */

static double uniform_p(const int *counts, int cells, double mean)
{
    double chi2 = 0.0;
    for (int i = 0; i < cells; i++)
        chi2 += (counts[i] - mean) * (counts[i] - mean) / mean;
    return chi2_p_value(chi2, cells - 1.0);
}

/* A number of one pixel and the same of its neighbor fill the square evenly and at random, for neighbors
 * on all sides, and so do a pixel's number in two vertices that share no shuffle. */
static void neighbors_are_independent(void **state)
{
    (void)state;
    enum { SIDE = 16, WIDTH = 400, HEIGHT = 320 };
    static int counts[4][SIDE * SIDE];
    const uint32_t pairs[] = {0, 3, 4, 13, 40};
    for (size_t k = 0; k < COUNT_OF(pairs); k++)
        for (uint32_t index = 0; index < 5; index += 2) {
            memset(counts, 0, sizeof counts);
            for (uint32_t y = 0; y < HEIGHT; y++)
                for (uint32_t x = 0; x < WIDTH; x++) {
                    int here = (int)(pair_of(x, y, index, pairs[k])[0] * SIDE) * SIDE;
                    counts[0][here + (int)(pair_of(x + 1, y, index, pairs[k])[0] * SIDE)]++;
                    counts[1][here + (int)(pair_of(x, y + 1, index, pairs[k])[0] * SIDE)]++;
                    counts[2][here + (int)(pair_of(x + 1, y + 1, index, pairs[k])[0] * SIDE)]++;
                    counts[3][here + (int)(pair_of(x, y, index, pairs[k] + 16)[0] * SIDE)]++;
                }
            for (int n = 0; n < 4; n++) {
                double p = uniform_p(counts[n], SIDE * SIDE, WIDTH * HEIGHT / (double)(SIDE * SIDE));
                if (!(p > 1e-5))
                    fail_msg("pair %u, sample %u, neighbor %d: p-value %.2g", pairs[k], index, n, p);
            }
        }
}

/* No two of many pixels begin alike, nor do seeds. */
static int compare_words(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

static void patterns_do_not_repeat(void **state)
{
    (void)state;
    enum { WIDTH = 512, COUNT = WIDTH * WIDTH };
    static uint64_t words[COUNT];
    for (uint32_t i = 0; i < COUNT; i++) {
        uint64_t word = 0;
        for (uint32_t k = 0; k < 3; k++) { /* 54 bits of the first three samples */
            path_sampler s = path_sampler_start(i % 2, i % WIDTH, i / WIDTH, k);
            vec2 p = path_sampler_pair(&s);
            word = word << 18 | (uint64_t)(p[0] * 512.0f) << 9 | (uint64_t)(p[1] * 512.0f);
        }
        words[i] = word;
    }
    qsort(words, COUNT, sizeof *words, compare_words);
    int same = 0;
    for (uint32_t i = 1; i < COUNT; i++)
        same += words[i] == words[i - 1];
    /* keys of 32 bits: 8 of 2^18 pixels' are expected to coincide with another's */
    assert_true(same < 24);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_pair_is_even),        cmocka_unit_test(pairs_do_not_depend_on_earlier_ones),
        cmocka_unit_test(pairs_are_even_together),   cmocka_unit_test(all_dimensions_are_even_together),
        cmocka_unit_test(neighbors_are_independent), cmocka_unit_test(patterns_do_not_repeat),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
