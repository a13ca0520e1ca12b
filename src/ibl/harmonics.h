/* harmonics.h - spherical harmonics of an environment up to a high degree, and cube maps made of them.
 *
 * A lobe that looks the same all around its axis, as that of a surface seen head on does (N = V = R), filters an
 * environment by scaling each degree l of its harmonics with one number k_l (Ramamoorthi and Hanrahan 2001, for any
 * such kernel). That is exact: no samples, no noise, a sun of one texel comes out as the lobe itself. A lobe of GGX
 * width alpha needs degrees up to about 4 / alpha. */
#ifndef IBL_HARMONICS_H
#define IBL_HARMONICS_H

#include "facet/facet.h"
#include "ibl/cube.h"
#include "image/image.h"

enum { HARMONICS_DEGREE = 160 }; /* highest degree that is kept */

/* Coefficients c_lm = integral of L P_lm(cos theta) e^(-i m phi), orthonormal P_lm, theta from +Y, for 0 <= m <= l;
 * of the difference from the mean, so that a uniform environment leaves nothing. */
typedef struct harmonics {
    facet_allocator allocator;
    float mean[3];
    float *coefficients; /* of order m: [l - m][R G B][re im]; orders follow each other */
    float *waves; /* scratch memory of filters, the larger arrays of which would cost more to map than */
    rgbx *grid;   /* to compute */
} harmonics;

/* FACET_ERROR_MEMORY. */
facet_result harmonics_create(const image *picture, const facet_allocator *allocator, uint32_t thread_count,
                              harmonics *out, facet_error *error);
void harmonics_destroy(harmonics *h); /* {0} is allowed; leaves {0} */
/* Releases the scratch memory until the next filter. */
void harmonics_trim(harmonics *h);

/* A cube map of the environment with degree l scaled by kernel[l], l up to degree (a multiple of 32, at most
 * HARMONICS_DEGREE), turned by rotation_rad around +Y from +Z towards +X; never negative. One filter at a time per h.
 * FACET_ERROR_MEMORY. */
facet_result harmonics_filter(harmonics *h, const float *kernel, uint32_t degree, double rotation_rad,
                              uint32_t size, const facet_allocator *allocator, uint32_t thread_count,
                              cube *out, facet_error *error);

#endif
