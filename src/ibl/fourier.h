/* fourier.h - Fourier transforms of rows of texels. */
#ifndef IBL_FOURIER_H
#define IBL_FOURIER_H

#include "ibl/simd.h"

#include <stdint.h>

enum { FOURIER_MAX = 512 }; /* samples in a row */

/* Roots of unity for rows of size samples, a power of two from 4 to FOURIER_MAX. */
typedef struct fourier {
    uint32_t size;
    float cosine[FOURIER_MAX / 2], sine[FOURIER_MAX / 2]; /* of 2 pi k / size */
} fourier;
void fourier_init(fourier *f, uint32_t size);

/* X[m] = sum of x[j] e^(-2 pi i j m / size) for m < size / 2, lane by lane. */
void fourier_forward(const fourier *f, const rgbx *x, rgbx *re, rgbx *im);
/* x[j] = sum over -size / 2 < m < size / 2 of X[m] e^(2 pi i j m / size), X[-m] the conjugate of X[m]. Overwrites re
 * and im, size / 2 each. */
void fourier_backward(const fourier *f, rgbx *re, rgbx *im, rgbx *x);

#endif
