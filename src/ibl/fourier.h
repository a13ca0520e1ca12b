/* fourier.h - Fourier transforms of rows of texels, two rows at a time. */
#ifndef IBL_FOURIER_H
#define IBL_FOURIER_H

#include <math.h>
#include <stdint.h>

#include "ibl/rgbx.h"

enum { FOURIER_MAX = 4096 }; /* samples in a row */

/* Roots of unity for rows of size samples, a power of two from 16 to FOURIER_MAX. */
typedef struct fourier {
    uint32_t size;
    float cosine[FOURIER_MAX / 2], sine[FOURIER_MAX / 2]; /* of 2 pi k / size */
    uint16_t mirrored[FOURIER_MAX / 2];                   /* bit-reversed index */
} fourier;

static inline void fourier_init(fourier *f, uint32_t size)
{
    uint32_t bits = 30u - (uint32_t)__builtin_clz(size); /* bits of an index below size / 2 */
    f->size = size;
    for (uint32_t k = 0; k < size / 2; k++) {
        double angle = 2.0 * 3.14159265358979323846 * k / size;
        f->cosine[k] = (float)cos(angle);
        f->sine[k] = (float)sin(angle);
        uint32_t mirrored = 0;
        for (uint32_t b = 0; b < bits; b++)
            mirrored |= (k >> b & 1u) << (bits - 1 - b);
        f->mirrored[k] = (uint16_t)mirrored;
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
        z_re[i] = x[2 * f->mirrored[i]];
        z_im[i] = x[2 * f->mirrored[i] + 1];
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
        uint32_t to = f->mirrored[m];
        z_im[to] = re[m] + far_re - odd_im;
        z_re[to] = im[m] + far_im + odd_re;
    }
    fourier_butterflies(f, z_re, z_im);
    for (uint32_t i = 0; i < n; i++) {
        x[2 * i] = z_im[i];
        x[2 * i + 1] = z_re[i];
    }
}

#endif
