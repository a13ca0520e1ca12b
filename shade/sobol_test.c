/* sobol_test.c - whether the points are a (0, 2)-sequence, the scrambling is Owen's, and the effect on
 * integration. */
#include "testing/chi_square.h"

/* ---- the sequence ---- */

static void test_sequence(void **state)
{
    (void)state;
    /* Sobol 1967: the first points */
    const float first[8][2] = {{0.0f, 0.0f},     {0.5f, 0.5f},     {0.25f, 0.75f},   {0.75f, 0.25f},
                               {0.125f, 0.625f}, {0.625f, 0.125f}, {0.375f, 0.375f}, {0.875f, 0.875f}};
    for (uint i = 0; i < 8; ++i) {
        assert_true((float)reverse_bits(i) / 4294967296.0f == first[i][0]);
        assert_true((float)reverse_bits(sobol_second(i)) / 4294967296.0f == first[i][1]);
    }
    /* binomial(k, j) is odd where j's bits are among k's (Lucas 1878) */
    for (uint k = 0; k < 32; ++k) {
        uint column = 0;
        for (uint j = 0; j < 32; ++j)
            column |= (uint)((j & k) == j) << j;
        assert_int_equal(sobol_second(1u << k), column);
        assert_int_equal(reverse_bits(1u << k), 1u << (31 - k));
    }
    test_rng rng = {1};
    for (int i = 0; i < 1000; ++i) { /* linear over digits */
        uint a = rng_uint(&rng), b = rng_uint(&rng);
        assert_int_equal(sobol_second(a ^ b), sobol_second(a) ^ sobol_second(b));
        assert_int_equal(reverse_bits(reverse_bits(a)), a);
    }
}

/* Every elementary interval of area 2^-m contains one of the points first to first + 2^m - 1 in the order of
 * taps; 0: in that of sobol_point(). */
static void expect_net(uint seed, uint first, int m, uint taps)
{
    static unsigned char hits[1 << 14];
    uint count = 1u << m;
    for (int wide = 0; wide <= m; ++wide) { /* 2^wide columns, 2^(m - wide) rows */
        memset(hits, 0, count);
        for (uint i = first; i < first + count; ++i) {
            vec2 p = taps ? sobol_scrambled(sobol_order(i, taps), hash_uint(seed)) : sobol_point(i, seed);
            assert_true(p[0] >= 0.0f && p[0] < 1.0f && p[1] >= 0.0f && p[1] < 1.0f);
            uint x = (uint)(p[0] * (float)(1 << wide)), y = (uint)(p[1] * (float)(1 << (m - wide)));
            uint box = y << wide | x;
            if (hits[box]++)
                fail_msg("seed %u, points %u to %u: two in box (%u, %u) of %u x %u", seed, first,
                         first + count - 1, x, y, 1u << wide, 1u << (m - wide));
        }
    }
}

static void test_nets(void **state)
{
    (void)state;
    test_rng rng = {2};
    for (int m = 0; m <= 14; ++m)
        for (int k = 0; k < (m < 11 ? 40 : 3); ++k) {
            uint block = k % 2 ? rng_uint(&rng) >> (8 + m) : 0u; /* within 2^24 samples */
            expect_net(k < 4 ? (uint)k : rng_uint(&rng), block << m, m, 0u);
            uint taps = 0x01010101u + (rng_uint(&rng) & 0x1e0f0f07u); /* four from 1 to 31 */
            expect_net(rng_uint(&rng), block << m, m, taps);
        }
    /* the largest number */
    float largest = 0.0f;
    for (uint i = 0; i < 1u << 22; ++i) {
        vec2 p = sobol_point(i, 4u);
        largest = max(largest, max(p[0], p[1]));
    }
    assert_true(largest < 1.0f && largest > 1.0f - 1e-6f);
}

static void test_order(void **state)
{
    (void)state;
    test_rng rng = {8};
    for (int k = 0; k < 2000; ++k) {
        uint i = rng_uint(&rng) >> 1, taps = 0x01010101u + (rng_uint(&rng) & 0x1e0f0f07u), expected = i;
        for (int t = 0; t < 4; ++t) /* digit by digit */
            for (int j = 0; j + (int)(taps >> 8 * t & 255u) < 32; ++j)
                expected ^= (i >> (j + (int)(taps >> 8 * t & 255u)) & 1u) << j;
        assert_int_equal(sobol_order(i, taps), expected);
        assert_int_equal(sobol_order(i, 0x1f1f1f1fu), i);
        /* shuffling preserves blocks, and is not the identity */
        uint a = i & 0xffffff00u, seed = hash_uint(rng_uint(&rng));
        for (uint b = 0; b < 256; b += 15)
            assert_int_equal(sobol_shuffle(a | b, seed) >> 8, sobol_shuffle(a, seed) >> 8);
    }
}

/* ---- the scrambling ---- */

/* The flip of digit `depth` by the seed, given the digits p before it. */
static bool is_flipped(uint p, int depth, uint seed)
{
    return ((owen_scramble(p, seed) ^ p) >> depth & 1u) != 0;
}

static void test_digits_depend_on_earlier_ones(void **state)
{
    (void)state;
    test_rng rng = {3};
    for (int i = 0; i < 20000; ++i) {
        uint a = rng_uint(&rng), b = rng_uint(&rng), seed = rng_uint(&rng);
        int same = (int)(rng_uint(&rng) % 33u);
        uint mask = same == 32 ? 0xffffffffu : (1u << same) - 1u;
        uint other = (a & mask) | (b & ~mask);
        assert_int_equal((owen_scramble(a, seed) ^ owen_scramble(other, seed)) & mask, 0);
        if (same < 32) /* and no two digits coincide */
            assert_true(((owen_scramble(a, seed) ^ owen_scramble(a ^ (1u << same), seed)) >> same & 1u) ==
                        1u);
    }
}

enum { PREFIXES = 64, SEEDS = 16384 };

static int abs_int(int x)
{
    return x < 0 ? -x : x;
}

/* Over seeds, the flips of a digit behind each of PREFIXES rows of earlier digits: the largest deviation,
 * in standard errors, of a flip's mean from 1/2 and of two flips' agreement from 1/2. */
static double worst_flips(const uint prefixes[PREFIXES], int count, int depth)
{
    static int together[PREFIXES][PREFIXES], sums[PREFIXES];
    memset(together, 0, sizeof together);
    memset(sums, 0, sizeof sums);
    for (uint n = 0; n < SEEDS; ++n) {
        int flip[PREFIXES];
        uint seed = hash_uint(n + 1u);
        for (int i = 0; i < count; ++i) {
            flip[i] = is_flipped(prefixes[i], depth, seed) ? 1 : -1;
            sums[i] += flip[i];
        }
        for (int i = 0; i < count; ++i)
            for (int j = 0; j < i; ++j)
                together[i][j] += flip[i] * flip[j];
    }
    int worst = 0;
    for (int i = 0; i < count; ++i) {
        worst = abs_int(sums[i]) > worst ? abs_int(sums[i]) : worst;
        for (int j = 0; j < i; ++j)
            if (prefixes[i] != prefixes[j] && abs_int(together[i][j]) > worst)
                worst = abs_int(together[i][j]);
    }
    return worst / sqrt((double)SEEDS);
}

/* These conditions determine the variance of Owen's estimate. 2080 numbers for each of 57 sets: chance takes
 * one of all of them beyond 5.3 standard errors once in 70 changes of the hash. */
static void test_flips_are_independent(void **state)
{
    (void)state;
    for (int depth = 0; depth < 32; ++depth) {
        uint prefixes[PREFIXES];
        int count = depth < 6 ? 1 << depth : PREFIXES;
        /* those of small numbers, of one digit, and any, spread by a large odd factor */
        for (int i = 0; i < count; ++i) {
            prefixes[i] = i < 24 || depth < 6 ? (uint)i : (uint)i * 0x9e3779b1u & ((1u << depth) - 1u);
            if (depth > 6 && i >= 24 && i < 24 + depth - 5)
                prefixes[i] = 1u << (i - 24 + 5);
        }
        double worst = worst_flips(prefixes, count, depth);
        if (!(worst < 5.3))
            fail_msg("digit %d: %.1f standard errors", depth, worst);
        /* those of few samples' indices: the last digits before this one */
        for (int i = 0; depth >= 6 && i < PREFIXES; ++i)
            prefixes[i] = (uint)i << (depth - 6);
        worst = depth < 6 ? 0.0 : worst_flips(prefixes, count, depth);
        if (!(worst < 5.3))
            fail_msg("digit %d, few samples: %.1f standard errors", depth, worst);
    }
}

/* ---- points over seeds ---- */

/* p-value of counts that should all be mean. */
static double uniform_p(const int *counts, int cells, double mean)
{
    double chi2 = 0.0;
    for (int i = 0; i < cells; ++i)
        chi2 += (counts[i] - mean) * (counts[i] - mean) / mean;
    return chi2_p_value(chi2, cells - 1.0);
}

enum { SIDE = 32, DRAWS = SIDE * SIDE * 100 };

/* Each point alone is uniform in the square over seeds, at any position of the sequence, and so are a
 * number of one sequence and one of the sequence of the next seed. */
static void test_points_are_uniform(void **state)
{
    (void)state;
    static int alone[SIDE * SIDE], beside[SIDE * SIDE];
    const uint indices[] = {0u, 1u, 2u, 5u, 63u, 100000u};
    for (size_t k = 0; k < COUNT_OF(indices); ++k) {
        memset(alone, 0, sizeof alone);
        memset(beside, 0, sizeof beside);
        for (uint seed = 0; seed < DRAWS; ++seed) {
            vec2 p = sobol_point(indices[k], seed), q = sobol_point(indices[k], seed + 1u);
            int x = (int)(p[0] * SIDE);
            ++alone[(int)(p[1] * SIDE) * SIDE + x];
            ++beside[(int)(q[0] * SIDE) * SIDE + x];
        }
        double p_alone = uniform_p(alone, SIDE * SIDE, 100.0),
               p_beside = uniform_p(beside, SIDE * SIDE, 100.0);
        if (!(p_alone > 1e-4 && p_beside > 1e-4))
            fail_msg("point %u: p-values %.2g alone, %.2g beside the next seed's", indices[k], p_alone,
                     p_beside);
    }
}

/* Sums of (a - 1/2)(b - 1/2) over n = 2^m points of two sequences, whose orders must not go together: over
 * seeds their mean is 0. Their variance: a - 1/2 is the sum over digits k of D_k 2^-(k + 2), D_k = +-1.
 * Owen's flips leave E[D_k(i) D_k(j)] = 1 for i = j, -2^-k where k is the largest digit in which indices i
 * and j differ, else 0. So with Q the sum of 16^-(k + 2) 2^-k over k < m it is n ((1/12)^2 + Q): more than
 * n (1/12)^2 of random numbers, the price for an order that is even at each power of two. */
static void test_orders_are_independent(void **state)
{
    (void)state;
    for (int n = 4; n <= 256; n *= 4) {
        enum { TRIES = 8000 };
        double sum[4] = {0.0}, square[4] = {0.0};
        for (uint t = 0; t < TRIES; ++t) {
            double s[4] = {0.0};
            for (uint i = 0; i < (uint)n; ++i) {
                vec2 p = sobol_point(i, 2u * t) - 0.5f, q = sobol_point(i, 2u * t + 1u) - 0.5f;
                for (int c = 0; c < 4; ++c)
                    s[c] += (double)p[c & 1] * (double)q[c >> 1];
            }
            for (int c = 0; c < 4; ++c) {
                sum[c] += s[c] / TRIES;
                square[c] += s[c] * s[c] / TRIES;
            }
        }
        double variance = n / 144.0, term = n / 256.0;
        for (int left = n; left > 1; left /= 2, term /= 32.0)
            variance += term;
        for (int c = 0; c < 4; ++c) {
            expect_near(sum[c], 0.0, 4.0 * sqrt(variance / TRIES), "n %d, pair %d: mean", n, c);
            expect_relative(square[c], variance, 0.1, "n %d, pair %d: variance", n, c);
        }
    }
}

/* ---- integration ---- */

typedef enum integrand { SMOOTH, DISC } integrand;

static double value_of(integrand kind, vec2 p)
{
    double x = (double)p[0], y = (double)p[1];
    if (kind == DISC)
        return x * x + y * y < 0.64 ? 1.0 : 0.0;
    return exp(-x * y) * sin(3.0 * x + 2.0 * y);
}

/* Root mean square error of means of n points. */
static double error_of(integrand kind, uint n, double exact, bool is_sobol)
{
    enum { TRIES = 400 };
    test_rng rng = {n + 17u};
    double square = 0.0;
    for (uint t = 0; t < TRIES; ++t) {
        double mean = 0.0;
        for (uint i = 0; i < n; ++i)
            mean += value_of(kind, is_sobol ? sobol_point(i, t * 77u + n) : rng_vec2(&rng)) / n;
        square += (mean - exact) * (mean - exact) / TRIES;
    }
    return sqrt(square);
}

/* Owen 1997: n^-1.5, times a logarithm, where derivatives exist; n^-0.75 for an edge, where random points
 * have n^-0.5. */
static void test_errors(void **state)
{
    (void)state;
    double smooth = 0.0, disc = 3.14159265358979323846 / 4.0 * 0.64;
    for (int y = 0; y < 1000; ++y)
        for (int x = 0; x < 1000; ++x) {
            double u = (x + 0.5) / 1000.0, v = (y + 0.5) / 1000.0;
            smooth += exp(-u * v) * sin(3.0 * u + 2.0 * v) * 1e-6;
        }
    double s16 = error_of(SMOOTH, 16, smooth, true), s1024 = error_of(SMOOTH, 1024, smooth, true);
    double d16 = error_of(DISC, 16, disc, true), d1024 = error_of(DISC, 1024, disc, true);
    double slope_smooth = log(s1024 / s16) / log(64.0), slope_disc = log(d1024 / d16) / log(64.0);
    double random_smooth = error_of(SMOOTH, 1024, smooth, false),
           random_disc = error_of(DISC, 1024, disc, false);
    print_message("smooth: error %.2e at 1024 (random %.2e), n^%.2f; edge: %.2e (random %.2e), n^%.2f\n",
                  s1024, random_smooth, slope_smooth, d1024, random_disc, slope_disc);
    assert_true(slope_smooth < -1.35 && slope_disc < -0.7);
    assert_true(s1024 < random_smooth / 100.0 && d1024 < random_disc / 4.0);
    /* counts between powers of two are better than random as well */
    assert_true(error_of(DISC, 900, disc, true) < 0.5 * error_of(DISC, 900, disc, false));
    assert_true(error_of(SMOOTH, 900, smooth, true) < 0.2 * error_of(SMOOTH, 900, smooth, false));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sequence),
        cmocka_unit_test(test_nets),
        cmocka_unit_test(test_order),
        cmocka_unit_test(test_digits_depend_on_earlier_ones),
        cmocka_unit_test(test_flips_are_independent),
        cmocka_unit_test(test_points_are_uniform),
        cmocka_unit_test(test_orders_are_independent),
        cmocka_unit_test(test_errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
