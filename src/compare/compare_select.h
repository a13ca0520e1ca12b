/* compare_select.h - percentiles of many values, exactly, without sorting them. */
#ifndef COMPARE_COMPARE_SELECT_H
#define COMPARE_COMPARE_SELECT_H

#include "facet/facet.h"

enum { COMPARE_SELECT_MAX = 8 };

/* For each share (0 to 100, count of them) the least of values that at least that share of them does not exceed: the
 * nearest-rank percentile. Negative values and NaN are no values; infinity is one. 0 where there are none. Fails with
 * FACET_ERROR_MEMORY. */
facet_result compare_select(const float *values, size_t value_count, const double *shares, uint32_t count,
                            const facet_allocator *allocator, double *out, facet_error *error);

#endif
