/* harmonics_transform.h - the transforms that harmonics.c (analysis) and harmonics_filter.c (synthesis) share:
 * Fourier transforms along rows, associated Legendre functions along columns, and where coefficients and
 * spectra lie in memory. */
#ifndef IBL_HARMONICS_TRANSFORM_H
#define IBL_HARMONICS_TRANSFORM_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/simd.h"
#include "ibl/rgbx.h"

/* ---- Fourier transforms of rows of texels, two rows at a time ---- */

enum { FOURIER_MAX = 4096 }; /* samples in a row */

/* Roots of unity for rows of size samples, a power of two from 16 to FOURIER_MAX. */
typedef struct fourier {
    uint32_t size;
    float cosine[FOURIER_MAX / 2], sine[FOURIER_MAX / 2]; /* of 2 pi k / size */
    uint16_t reversed[FOURIER_MAX / 2];                   /* bit-reversed index */
} fourier;

static inline void fourier_init(fourier *f, uint32_t size)
{
    uint32_t bits = 30u - (uint32_t)__builtin_clz(size); /* bits of an index below size / 2 */
    f->size = size;
    for (uint32_t k = 0; k < size / 2; k++) {
        double angle = 2.0 * 3.14159265358979323846 * k / size;
        f->cosine[k] = (float)cos(angle);
        f->sine[k] = (float)sin(angle);
        uint32_t reversed = 0;
        for (uint32_t b = 0; b < bits; b++)
            reversed |= (k >> b & 1u) << (bits - 1 - b);
        f->reversed[k] = (uint16_t)reversed;
    }
}

/* X[m] = sum of x[j] e^(-2 pi i j m / size) for m < size / 2, lane by lane. Always inlined, into loops that
 * are compiled for several instruction sets. */
static inline void fourier_forward(const fourier *f, const float8 *x, float8 *re, float8 *im);
/* x[j] = sum over -size / 2 < m < size / 2 of X[m] e^(2 pi i j m / size), X[-m] the conjugate of X[m]. */
static inline void fourier_backward(const fourier *f, const float8 *re, const float8 *im, float8 *x);

/* Rows are real: even and odd samples become the real and imaginary parts of a transform of half the size
 * (Cooley and Tukey 1965, radix 2); its inner loop runs over the lanes of two texels. */

/* Forward transform in place of size / 2 complex values in bit-reversed order. */
static inline __attribute__((always_inline)) void fourier_butterflies(const fourier *f, float8 *re,
                                                                      float8 *im)
{
    uint32_t n = f->size / 2;
    for (uint32_t a = 0; a < n; a += 4) { /* the first two steps, whose roots are 1 and -i */
        float8 s_re = re[a] + re[a + 1];
        float8 s_im = im[a] + im[a + 1];
        float8 d_re = re[a] - re[a + 1];
        float8 d_im = im[a] - im[a + 1];
        float8 t_re = re[a + 2] + re[a + 3];
        float8 t_im = im[a + 2] + im[a + 3];
        float8 e_re = re[a + 2] - re[a + 3];
        float8 e_im = im[a + 2] - im[a + 3];
        re[a] = s_re + t_re;
        im[a] = s_im + t_im;
        re[a + 2] = s_re - t_re;
        im[a + 2] = s_im - t_im;
        re[a + 1] = d_re + e_im;
        im[a + 1] = d_im - e_re;
        re[a + 3] = d_re - e_im;
        im[a + 3] = d_im + e_re;
    }
    for (uint32_t half = 4; half < n; half *= 2) {
        uint32_t stride = n / half; /* among the roots of size */
        for (uint32_t base = 0; base < n; base += 2 * half)
            for (uint32_t k = 0; k < half; k++) {
                float c = f->cosine[k * stride];
                float s = -f->sine[k * stride];
                uint32_t a = base + k;
                uint32_t b = a + half;
                float8 t_re = re[b] * c - im[b] * s;
                float8 t_im = re[b] * s + im[b] * c;
                re[b] = re[a] - t_re;
                im[b] = im[a] - t_im;
                re[a] += t_re;
                im[a] += t_im;
            }
    }
}

static inline __attribute__((always_inline)) void fourier_forward(const fourier *f, const float8 *x,
                                                                  float8 *re, float8 *im)
{
    uint32_t n = f->size / 2;
    float8 z_re[FOURIER_MAX / 2], z_im[FOURIER_MAX / 2];
    for (uint32_t i = 0; i < n; i++) {
        z_re[i] = x[2 * f->reversed[i]];
        z_im[i] = x[2 * f->reversed[i] + 1];
    }
    fourier_butterflies(f, z_re, z_im);
    for (uint32_t m = 0; m < n; m++) {
        /* even = (Z[m] + conj Z[n - m]) / 2, odd = (Z[m] - conj Z[n - m]) / 2i, X = even + e^(-2 pi i m /
         * size) odd */
        uint32_t o = m ? n - m : 0;
        float8 even_re = (z_re[m] + z_re[o]) * 0.5f;
        float8 even_im = (z_im[m] - z_im[o]) * 0.5f;
        float8 odd_re = (z_im[m] + z_im[o]) * 0.5f;
        float8 odd_im = (z_re[o] - z_re[m]) * 0.5f;
        float c = f->cosine[m];
        float s = -f->sine[m];
        re[m] = even_re + (odd_re * c - odd_im * s);
        im[m] = even_im + (odd_re * s + odd_im * c);
    }
}

static inline __attribute__((always_inline)) void fourier_backward(const fourier *f, const float8 *re,
                                                                   const float8 *im, float8 *x)
{
    uint32_t n = f->size / 2;
    float8 z_re[FOURIER_MAX / 2], z_im[FOURIER_MAX / 2];
    for (uint32_t m = 0; m < n; m++) {
        /* X[m + n] = conj X[n - m], 0 for m = 0; Z = X[m] + X[m + n] + i e^(2 pi i m / size) (X[m] - X[m +
         * n]) */
        float far = m ? 1.0f : 0.0f;
        float8 far_re = re[m ? n - m : 0] * far;
        float8 far_im = im[m ? n - m : 0] * -far;
        float8 d_re = re[m] - far_re;
        float8 d_im = im[m] - far_im;
        float c = f->cosine[m];
        float s = f->sine[m];
        float8 odd_re = d_re * c - d_im * s;
        float8 odd_im = d_re * s + d_im * c;
        /* the backward transform is the forward one with real and imaginary parts swapped before and after */
        uint32_t to = f->reversed[m];
        z_im[to] = re[m] + far_re - odd_im;
        z_re[to] = im[m] + far_im + odd_re;
    }
    fourier_butterflies(f, z_re, z_im);
    for (uint32_t i = 0; i < n; i++) {
        x[2 * i] = z_im[i];
        x[2 * i + 1] = z_re[i];
    }
}

/* ---- associated Legendre functions ----
 *
 * Orthonormal: the integral of (P_lm(x))^2 dx over [-1, 1] is 1 / 2 pi. By degree, P_lm = a_l (x P_(l-1)m -
 * b_l P_(l-2)m) from P_mm on, for rows of a grid between the north pole and the equator, LANES of them at a
 * time. In double: near the poles each step forward takes a small difference, and in float one degree of
 * latitude from a pole would be 3 % off at degree 1000. */

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

/* ---- layout of coefficients and spectra ---- */

enum { HARMONICS_PARTS = 6 }; /* R G B, real and imaginary */

/* Index of the first coefficient of an order. */
static inline size_t harmonics_order_index(uint32_t degree, uint32_t order)
{
    return HARMONICS_PARTS * ((size_t)order * (degree + 1) - (size_t)order * (order - 1) / 2);
}

/* Spectra are Fourier coefficients of rows by order, [order][even odd][HARMONICS_PARTS][row], for pairs of
 * rows that mirror each other at the equator. As P_lm(-x) = (-1)^(l - m) P_lm(x), their sum (even) belongs to
 * even l - m, their difference (odd) to odd l - m, and both rows share their Legendre functions. */
static inline size_t harmonics_spectrum_index(uint32_t order, uint32_t is_odd, uint32_t part,
                                              uint32_t row_count)
{
    return (((size_t)order * 2 + is_odd) * HARMONICS_PARTS + part) * row_count;
}

#endif
