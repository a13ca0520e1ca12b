/* fourier.c - see fourier.h. Rows are real: even and odd samples become real and imaginary parts of a transform of
 * half the size (Cooley and Tukey 1965, radix 2), of which the lanes of a texel are the inner loop. */
#include "ibl/fourier.h"

#include <math.h>

void fourier_init(fourier *f, uint32_t size)
{
    f->size = size;
    for (uint32_t k = 0; k < size / 2; k++) {
        double angle = 2.0 * 3.14159265358979323846 * k / size;
        f->cosine[k] = (float)cos(angle);
        f->sine[k] = (float)sin(angle);
    }
}

static uint32_t log2_of(uint32_t n)
{
    return 31u - (uint32_t)__builtin_clz(n);
}

static uint32_t mirrored(uint32_t i, uint32_t bits)
{
    uint32_t r = 0;
    for (uint32_t b = 0; b < bits; b++)
        r |= (i >> b & 1u) << (bits - 1 - b);
    return r;
}

/* Forward transform in place of size / 2 complex values that are in mirrored order. */
static inline __attribute__((always_inline)) void butterflies(const fourier *f, rgbx *re, rgbx *im)
{
    uint32_t n = f->size / 2;
    for (uint32_t half = 1; half < n; half *= 2) {
        uint32_t stride = n / half; /* in the roots of size */
        for (uint32_t base = 0; base < n; base += 2 * half)
            for (uint32_t k = 0; k < half; k++) {
                float c = f->cosine[k * stride];
                float s = -f->sine[k * stride];
                uint32_t a = base + k;
                uint32_t b = a + half;
                rgbx t_re = re[b] * c - im[b] * s;
                rgbx t_im = re[b] * s + im[b] * c;
                re[b] = re[a] - t_re;
                im[b] = im[a] - t_im;
                re[a] += t_re;
                im[a] += t_im;
            }
    }
}

IBL_DISPATCH void fourier_forward(const fourier *f, const rgbx *x, rgbx *re, rgbx *im)
{
    uint32_t n = f->size / 2;
    uint32_t bits = log2_of(n);
    rgbx z_re[FOURIER_MAX / 2], z_im[FOURIER_MAX / 2];
    for (uint32_t i = 0; i < n; i++) {
        uint32_t from = mirrored(i, bits);
        z_re[i] = x[2 * from];
        z_im[i] = x[2 * from + 1];
    }
    butterflies(f, z_re, z_im);
    for (uint32_t m = 0; m < n; m++) {
        /* even = (Z[m] + conj Z[n - m]) / 2, odd = (Z[m] - conj Z[n - m]) / 2i, X = even + e^(-2 pi i m / size) odd */
        uint32_t o = m ? n - m : 0;
        rgbx even_re = (z_re[m] + z_re[o]) * 0.5f;
        rgbx even_im = (z_im[m] - z_im[o]) * 0.5f;
        rgbx odd_re = (z_im[m] + z_im[o]) * 0.5f;
        rgbx odd_im = (z_re[o] - z_re[m]) * 0.5f;
        float c = f->cosine[m];
        float s = -f->sine[m];
        re[m] = even_re + odd_re * c - odd_im * s;
        im[m] = even_im + odd_re * s + odd_im * c;
    }
}

IBL_DISPATCH void fourier_backward(const fourier *f, rgbx *re, rgbx *im, rgbx *x)
{
    uint32_t n = f->size / 2;
    uint32_t bits = log2_of(n);
    rgbx z_re[FOURIER_MAX / 2], z_im[FOURIER_MAX / 2];
    rgbx zero = {0};
    for (uint32_t m = 0; m < n; m++) {
        /* X[m + n] = conj X[n - m], 0 for m = 0; Z = X[m] + X[m + n] + i e^(2 pi i m / size) (X[m] - X[m + n]) */
        rgbx far_re = m ? re[n - m] : zero;
        rgbx far_im = m ? -im[n - m] : zero;
        rgbx d_re = re[m] - far_re;
        rgbx d_im = im[m] - far_im;
        float c = f->cosine[m];
        float s = f->sine[m];
        rgbx odd_re = d_re * c - d_im * s;
        rgbx odd_im = d_re * s + d_im * c;
        uint32_t to = mirrored(m, bits);
        /* backward is forward with real and imaginary part swapped, before and after */
        z_im[to] = re[m] + far_re - odd_im;
        z_re[to] = im[m] + far_im + odd_re;
    }
    butterflies(f, z_re, z_im);
    for (uint32_t i = 0; i < n; i++) {
        x[2 * i] = z_im[i];
        x[2 * i + 1] = z_re[i];
    }
}
