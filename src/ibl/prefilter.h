/* prefilter.h - radiance filtered for GGX reflections, one cube map per perceptual roughness.
 *
 * Level k of LEVEL_COUNT holds roughness k / (LEVEL_COUNT - 1), for N = V = R (Karis 2013):
 *   P(R) = integral of L(l) D(h) N.l dl / integral of D(h) N.l dl,  h half-way between l and R
 * which, as N.l = 2 (N.h)^2 - 1, is a convolution of the environment with a lobe that looks the same all around R. */
#ifndef IBL_PREFILTER_H
#define IBL_PREFILTER_H

#include "facet/facet.h"
#include "ibl/cube.h"
#include "ibl/harmonics.h"

enum {
    PREFILTER_LEVEL_COUNT = 9,
    PREFILTER_SAMPLED_COUNT =
        2,                   /* levels 0 (a copy) and 1 (sampled) come from a cube, the others of harmonics */
    PREFILTER_MAX_SIZE = 256 /* of level 0 */
};

/* Perceptual roughness of a level. */
float prefilter_roughness(uint32_t level);

/* Scale of degree l of the environment's harmonics, k_l = integral of D N.l P_l(N.l) / integral of D N.l, for l up to
 * degree; kernel[0] is 1. By Gauss-Legendre quadrature over the half vector, in double. */
void prefilter_kernel(float perceptual_roughness, uint32_t degree, float *kernel);

/* Levels from PREFILTER_SAMPLED_COUNT on. FACET_ERROR_MEMORY. */
facet_result prefilter_harmonics(const harmonics *h, uint32_t level, const facet_allocator *allocator,
                                 uint32_t thread_count, cube *out, facet_error *error);

/* Level 1, by filtered importance sampling of the sharp cube. FACET_ERROR_MEMORY. */
facet_result prefilter_sampled(const cube *sharp, uint32_t level, const facet_allocator *allocator,
                               uint32_t thread_count, cube *out, facet_error *error);

#endif
