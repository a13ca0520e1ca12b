/* legendre.h - associated Legendre functions, orthonormal: integral of (P_lm(x))^2 dx over [-1, 1] = 1 / 2
 * pi.
 *
 * By degree, P_lm = a_l (x P_(l-1)m - b_l P_(l-2)m) from P_mm on, for rows of a grid between the north
 * pole and the equator, LANES of them at a time. In double: near the poles each step forward takes a small
 * difference, and in float one degree of latitude from a pole would be 3 % off at degree 1000. */
#ifndef IBL_LEGENDRE_H
#define IBL_LEGENDRE_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/simd.h"

enum {
    LEGENDRE_LANES = 8,
    LEGENDRE_MAX_DEGREE = 1344,
    LEGENDRE_MAX_BLOCKS = LEGENDRE_MAX_DEGREE / LEGENDRE_LANES
};

typedef double double4 __attribute__((vector_size(32), may_alias));
typedef float float4 __attribute__((vector_size(16)));

/* A block of two vectors: compilers keep those in registers, but not one of twice the size. */
typedef struct double8 {
    double4 low, high;
} double8;

/* By pointer: the calling convention of vectors returned by value depends on the instruction set. */
static inline __attribute__((always_inline)) void legendre_floats(const double8 *d, float8 *out)
{
    float4 low = __builtin_convertvector(d->low, float4);
    float4 high = __builtin_convertvector(d->high, float4);
    *out = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}

/* before = (x now - before b) a, the next degree. */
static inline __attribute__((always_inline)) void legendre_step(const double8 *x, const double8 *now,
                                                                double8 *before, double b, double a)
{
    before->low = (x->low * now->low - before->low * b) * a;
    before->high = (x->high * now->high - before->high * b) * a;
}

/* Rows of a grid, in blocks of LEGENDRE_LANES. */
typedef struct legendre_rows {
    uint32_t block_count;
    double8 x[LEGENDRE_MAX_BLOCKS], sine[LEGENDRE_MAX_BLOCKS]; /* cos and sin of theta */
} legendre_rows;

/* Functions of one order m for blocks of LEGENDRE_LANES rows. Towards a pole P_lm vanishes like an Airy
 * function where l sin(theta) < m, so a block contributes only from some degree on; its functions are stored
 * at that degree. */
typedef struct legendre {
    double a[LEGENDRE_MAX_DEGREE + 3], b[LEGENDRE_MAX_DEGREE + 3];
    double8 now[LEGENDRE_MAX_BLOCKS];    /* P at degree from[] */
    double8 before[LEGENDRE_MAX_BLOCKS]; /* and at the one before */
    uint32_t from[LEGENDRE_MAX_BLOCKS];  /* m + an even number; above degree: never */
} legendre;

/* Scale of P_mm, which may underflow a double, until the block contributes. */
#define LEGENDRE_LARGER 1e300

/* Rows first_row .. first_row + row_count - 1 of a grid of grid_rows from pole to pole, with centers at (j +
 * 0.5) pi / grid_rows; rows that pad the last block are ignored. */
static inline void legendre_place(legendre_rows *rows, uint32_t first_row, uint32_t row_count,
                                  uint32_t grid_rows)
{
    double step = 3.14159265358979323846 / grid_rows;
    rows->block_count = (row_count + LEGENDRE_LANES - 1) / LEGENDRE_LANES;
    for (uint32_t j = 0; j < rows->block_count * LEGENDRE_LANES; j++) {
        ((double *)rows->x)[j] = cos(step * (first_row + j + 0.5));
        ((double *)rows->sine)[j] = sin(step * (first_row + j + 0.5));
    }
}

/* P_mm = norm sin(theta)^m, LEGENDRE_LARGER times. */
static inline __attribute__((always_inline)) void legendre_start(double norm, uint32_t order,
                                                                 const double8 *sine, double8 *out)
{
    double8 half = {sine->low * 0.0 + 1e150,
                    sine->high * 0.0 + 1e150}; /* the square root of the power underflows later */
    double8 power = *sine;
    for (uint32_t n = order / 2; n; n >>= 1) {
        if (n & 1) {
            half.low *= power.low;
            half.high *= power.high;
        }
        power.low *= power.low;
        power.high *= power.high;
    }
    out->low = half.low * norm * half.low;
    out->high = half.high * norm * half.high;
    if (order & 1) {
        out->low *= sine->low;
        out->high *= sine->high;
    }
}

/* Always inlined, into loops that are compiled for several instruction sets. */
static inline __attribute__((always_inline)) void legendre_init(legendre *p, uint32_t order, uint32_t degree,
                                                                const legendre_rows *rows)
{
    double m = order;
    for (uint32_t l = order + 1; l < degree + 3; l++) {
        double l2 = (double)l * l;
        double k2 = (double)(l - 1) * (l - 1);
        p->a[l] = sqrt((4.0 * l2 - 1.0) / (l2 - m * m));
        p->b[l] = sqrt((k2 - m * m) / (4.0 * k2 - 1.0));
    }
    double norm = 1.0 / (4.0 * 3.14159265358979323846);
    for (uint32_t k = 1; k <= order; k++)
        norm *= (2.0 * k + 1.0) / (2.0 * k);
    norm = sqrt(norm);
    /* 6 m^(1/3) before the turning point l sin(theta) = m, P_lm is below 1e-6 of its maximum */
    double turning = m - 6.0 * cbrt(m);
    for (uint32_t block = 0; block < rows->block_count; block++) {
        double last = rows->sine[block].high[3];
        bool is_past_equator = rows->x[block].high[3] <= 0.0;
        double from = is_past_equator ? turning : turning / last;
        p->from[block] = degree + 1;
        if (from > degree)
            continue;
        uint32_t skipped = from > m ? (uint32_t)(from - m) & ~1u : 0;
        p->from[block] = order + skipped;
        double8 x = rows->x[block];
        double8 now;
        double8 before = {{0.0}, {0.0}};
        legendre_start(norm, order, &rows->sine[block], &now);
        for (uint32_t l = order + 1; l <= order + skipped; l += 2) {
            legendre_step(&x, &now, &before, p->b[l], p->a[l]);
            legendre_step(&x, &before, &now, p->b[l + 1], p->a[l + 1]);
        }
        double scale = 1.0 / LEGENDRE_LARGER;
        p->now[block] = (double8){now.low * scale, now.high * scale};
        p->before[block] = (double8){before.low * scale, before.high * scale};
    }
}

#endif
