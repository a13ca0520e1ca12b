/* compare_select.c - see compare_select.h. The bits of a float that is not negative are ordered as its value: the upper 16
 * are counted, then the lower 16 of those values that share the upper ones of a wanted rank. */
#include "compare/compare_select.h"

#include <math.h>

#include "base/memory.h"
#include "base/result.h"
#include "image/half.h"

enum { BINS = 1 << 16 };

/* The bin in which the rank falls, from 1; *rank becomes the rank within it. */
static uint32_t find_bin(const uint64_t *bins, uint64_t *rank)
{
    uint32_t bin = 0;
    while (bin < BINS - 1 && *rank > bins[bin])
        *rank -= bins[bin++];
    return bin;
}

static bool is_value(float x)
{
    return x >= 0.0f;
}

facet_result compare_select(const float *values, size_t value_count, const double *shares, uint32_t count,
                            const facet_allocator *allocator, double *out, facet_error *error)
{
    uint64_t *bins = mem_zalloc(allocator, (size_t)(1 + COMPARE_SELECT_MAX) * BINS, sizeof *bins);
    if (!bins)
        return fail_memory(error, "histogram", sizeof *bins * BINS);
    uint64_t total = 0;
    for (size_t i = 0; i < value_count; i++)
        if (is_value(values[i])) {
            bins[float_bits(values[i] + 0.0f) >> 16]++; /* + 0: of -0 there is none */
            total++;
        }
    uint64_t ranks[COMPARE_SELECT_MAX];
    uint32_t upper[COMPARE_SELECT_MAX];
    for (uint32_t k = 0; k < count; k++) {
        const double rank =
            ceil(shares[k] / 100.0 * (double)total - 1e-9); /* 95 % of 100 is 95, whatever 0.95 is */
        ranks[k] = rank < 1.0 ? 1 : rank > (double)total ? total : (uint64_t)rank;
        upper[k] = find_bin(bins, &ranks[k]);
    }
    for (size_t i = 0; i < value_count; i++) {
        if (!is_value(values[i]))
            continue;
        const uint32_t bits = float_bits(values[i] + 0.0f);
        for (uint32_t k = 0; k < count; k++)
            if (bits >> 16 == upper[k])
                bins[(size_t)(1 + k) * BINS + (bits & 0xffff)]++;
    }
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t lower = find_bin(bins + (size_t)(1 + k) * BINS, &ranks[k]);
        out[k] = total ? (double)float_from_bits(upper[k] << 16 | lower) : 0.0;
    }
    mem_free(bins);
    return FACET_OK;
}
