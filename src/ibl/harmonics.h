/* harmonics.h - spherical harmonics of an environment up to a high degree, and cube maps made of them.
 *
 * A lobe that looks the same all around its axis, as that of a surface seen head on does (N = V = R), filters an
 * environment by scaling each degree l of its harmonics with one number k_l (Ramamoorthi and Hanrahan 2001, for any
 * such kernel). That is exact: no samples, no noise, a sun of one texel comes out as the lobe itself. A lobe of GGX
 * width alpha needs degrees up to about 4 / alpha. Analysis takes in the order of degree^2 times rows of the image, a
 * filter degree^3; at degree 512 that is 0.1 s. */
#ifndef IBL_HARMONICS_H
#define IBL_HARMONICS_H

#include "facet/facet.h"
#include "ibl/cube.h"
#include "image/image.h"

enum { HARMONICS_MAX_DEGREE = 1344 }; /* three columns of a grid for each, at most FOURIER_MAX */

/* Coefficients c_lm = integral of L P_lm(cos theta) e^(-i m phi), orthonormal P_lm, theta from +Y, for 0 <= m <= l;
 * of the difference from the mean, so that a uniform environment leaves nothing. Texels of the image are taken as of one
 * radiance all over their solid angle. */
typedef struct harmonics {
    facet_allocator allocator;
    uint32_t degree; /* the highest that is kept, a multiple of 32 */
    /* of the grid of the analysis, whose middle of column 0 is phi = 0 of the coefficients */
    uint32_t column_count;
    float mean[3];
    float least[3];      /* of the image, below which no mean of it can be */
    float *coefficients; /* of order m: [l - m][R G B][re im]; orders follow each other */
    float *spectra; /* scratch memory of filters, the larger arrays of which would cost more to map than */
    rgbx *grid;     /* to compute */
    size_t spectrum_count, grid_count; /* what there is of them */
} harmonics;

/* degree: a multiple of 32 up to HARMONICS_MAX_DEGREE. FACET_ERROR_MEMORY. */
facet_result harmonics_create(const image *panorama, uint32_t degree, const facet_allocator *allocator,
                              uint32_t thread_count, harmonics *out, facet_error *error);
void harmonics_destroy(harmonics *h); /* {0} is allowed; leaves {0} */
/* Releases the scratch memory until the next filter. */
void harmonics_trim(harmonics *h);

/* A cube map of the environment with degree l scaled by kernel[l], l up to degree (a multiple of 32, at most h->degree), times
 * scale, turned by rotation_rad around +Y from +Z towards +X; nowhere below the least radiance of the image, as rings around a sun would be. One filter at a time per h. FACET_ERROR_MEMORY. */
typedef struct harmonics_filter_desc {
    const float *kernel;
    uint32_t degree;
    double rotation_rad;
    float scale;
    uint32_t size; /* texels along an edge of the cube map */
    const facet_allocator *allocator;
    uint32_t thread_count;
} harmonics_filter_desc;
facet_result harmonics_filter(harmonics *h, const harmonics_filter_desc *desc, cube *out, facet_error *error);

/* ---- between harmonics.c, which analyses, and harmonics_filter.c ---- */

enum { HARMONICS_PARTS = 6 }; /* R G B, real and imaginary */

/* Where the coefficients of an order begin. */
static inline size_t harmonics_order_index(uint32_t degree, uint32_t order)
{
    return HARMONICS_PARTS * ((size_t)order * (degree + 1) - (size_t)order * (order - 1) / 2);
}

/* Waves, rows of Fourier coefficients by order: [order][even odd][HARMONICS_PARTS][row], of pairs of rows that mirror each
 * other at the equator. As P_lm(-x) = (-1)^(l - m) P_lm(x), even (their sum) goes with even l - m, odd (their difference) with
 * odd, and the two rows share their Legendre functions. */
static inline size_t harmonics_spectrum_index(uint32_t order, uint32_t is_odd, uint32_t part,
                                              uint32_t row_count)
{
    return (((size_t)order * 2 + is_odd) * HARMONICS_PARTS + part) * row_count;
}

#endif
