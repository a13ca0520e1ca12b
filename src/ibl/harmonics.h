/* harmonics.h - spherical harmonics of an environment up to a high degree, and pictures made of them.
 *
 * A lobe that looks the same all around its axis, as that of a surface seen head on does (N = V = R), filters an
 * environment by scaling each degree l of its harmonics with one number k_l (Ramamoorthi and Hanrahan 2001, for any
 * such kernel). That is exact: no samples, no noise, a sun of one texel comes out as the lobe itself. A lobe of GGX
 * width alpha needs degrees up to about 8 / alpha. */
#ifndef IBL_HARMONICS_H
#define IBL_HARMONICS_H

#include "facet/facet.h"
#include "ibl/cube.h"
#include "ibl/equirect.h"

enum { HARMONICS_DEGREE = 128 }; /* highest degree that is kept */

/* Coefficients c_lm = integral of L P_lm(cos theta) e^(-i m phi), orthonormal P_lm, theta from +Y, for 0 <= m <= l;
 * of the difference from the mean, so that a uniform environment is 0 to the last bit. */
typedef struct harmonics {
    float mean[3];
    float *
        coefficients; /* of order m: [l - m][R G B][re im]; orders follow each other; a block of mem_alloc() */
} harmonics;

/* FACET_ERROR_MEMORY. */
facet_result harmonics_create(const image *picture, const facet_allocator *allocator, uint32_t thread_count,
                              harmonics *out, facet_error *error);
void harmonics_destroy(harmonics *h); /* {0} is allowed; leaves {0} */

/* A cube map of the environment with degree l scaled by kernel[l], l up to degree (a power of two, at most
 * HARMONICS_DEGREE); never negative. FACET_ERROR_MEMORY. */
facet_result harmonics_filter(const harmonics *h, const float *kernel, uint32_t degree, uint32_t size,
                              const facet_allocator *allocator, uint32_t thread_count, cube *out,
                              facet_error *error);

#endif
