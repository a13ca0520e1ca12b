/* median.h - shared by benchmarks: medians, and the CPU clock, which base/clock.h does not have. */
#ifndef BENCH_MEDIAN_H
#define BENCH_MEDIAN_H

#include <stdlib.h>
#include <time.h>

/* CPU seconds of all threads of this process. */
static inline double cpu_seconds(void)
{
    return (double)clock() / (double)CLOCKS_PER_SEC;
}

static inline int median_order(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Sorts the values, at least one. */
static inline double median(double *values, int count)
{
    qsort(values, (size_t)count, sizeof *values, median_order);
    return count % 2 ? values[count / 2] : 0.5 * (values[count / 2 - 1] + values[count / 2]);
}

#endif
