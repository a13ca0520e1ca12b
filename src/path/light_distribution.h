/* light_distribution.h - sampling of discrete distributions: of a few float weights, and of tables of
 * whole counts. */
#ifndef PATH_LIGHT_DISTRIBUTION_H
#define PATH_LIGHT_DISTRIBUTION_H

#include <stddef.h>
#include <stdint.h>

/* ---- a few weights ---- */

enum { MAX_LIGHT_WEIGHTS = 16 };

/* The item that *u in [0, 1) selects, of count <= MAX_LIGHT_WEIGHTS with weights >= 0, some positive;
 * never one of weight 0. *u becomes the position within its share, in [0, 1). No branches on weights: they
 * are as random as u. */
static inline int light_choose(const float *weights, int count, double *u)
{
    double ends[MAX_LIGHT_WEIGHTS];
    double sum = 0.0;
    for (int i = 0; i < count; i++) {
        sum += (double)weights[i];
        ends[i] = sum;
    }
    double target = *u * sum;
    int found = 0;
    for (int i = 0; i < count; i++)
        found += ends[i] <= target;
    if (found == count) /* u * sum was rounded up to sum */
        found--;
    while (!(weights[found] > 0.0f))
        found--;
    double rest = (target - (ends[found] - (double)weights[found])) / (double)weights[found];
    *u = rest < 0.0 ? 0.0 : rest < 1.0 ? rest : 1.0 - 0x1p-53;
    return found;
}

/* ---- tables ---- */

/* Probabilities as whole numbers: exact differences of the stored ends, the same for sampling and pdf, and
 * no positive weight is rounded to 0. */

/* The sum of all counts of a distribution. */
#define LIGHT_COUNTS_TOTAL 4294967295u
#define LIGHT_COUNTS_SHARE (1.0 / 4294967295.0)

/* The end of an item's counts, for `end`, the sum of the weights up to and including it, and `all`, the
 * sum of all weights. Every item of positive weight gets a count: positive_end of them up to here,
 * positive_all in all. */
static inline uint32_t light_counts_end(double end, double all, size_t positive_end, size_t positive_all)
{
    double share = end < all ? end / all : 1.0;
    return (uint32_t)(share * (double)(LIGHT_COUNTS_TOTAL - positive_all)) + (uint32_t)positive_end;
}

/* The item that u in [0, 1) selects: the first of ends[0 .. count - 1] above u. *probability: of that
 * item; *rest: the position of u within it, in [0, 1). */
static inline size_t light_counts_find(const uint32_t *ends, size_t count, double u, double *probability,
                                       double *rest)
{
    double x = u * (double)LIGHT_COUNTS_TOTAL;
    uint32_t wanted = (uint32_t)x;
    size_t low = 0;
    for (size_t remaining = count; remaining > 1;) { /* without branches: u is random */
        size_t half = remaining / 2;
        low += ends[low + half - 1] <= wanted ? half : 0;
        remaining -= half;
    }
    uint32_t start = low ? ends[low - 1] : 0;
    double width = (double)(ends[low] - start);
    *probability = width * LIGHT_COUNTS_SHARE;
    *rest = (x - (double)start) / width;
    return low;
}

/* The probability of an item. */
static inline double light_counts_probability(const uint32_t *ends, size_t item)
{
    return (double)(ends[item] - (item ? ends[item - 1] : 0)) * LIGHT_COUNTS_SHARE;
}

#endif
