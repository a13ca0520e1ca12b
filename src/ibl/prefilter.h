/* prefilter.h - radiance filtered for GGX reflections, one cube map per perceptual roughness.
 *
 * For N = V = R (Karis 2013) the filter is
 *   P(R) = integral of L(l) D(h) N.l dl / integral of D(h) N.l dl,  h half-way between l and R
 * which, as N.l = 2 (N.h)^2 - 1, is a convolution of the environment with a lobe that looks the same all around R:
 * harmonics.h. Importance sampling would leave 10 % error around a sun with 64 samples a texel. */
#ifndef IBL_PREFILTER_H
#define IBL_PREFILTER_H

#include "facet/facet.h"
#include "ibl/cube.h"
#include "ibl/harmonics.h"

/* Levels, from smooth to rough. Level 0 is a mirror and no cube map: the picture itself. */
enum { PREFILTER_LEVEL_COUNT = 9 };

/* Perceptual roughness of a level. Each lobe is 1.4 to 1.9 times as wide as the one before, so that the mean of two
 * stays near the lobe between them; equal steps of roughness would make it 4 times at the smooth end. */
float prefilter_roughness(uint32_t level);
/* Texels along an edge of its faces. */
uint32_t prefilter_size(uint32_t level);
/* Differs between levels that are made differently. */
uint64_t prefilter_recipe(uint32_t level);
/* The level, with fraction, of a roughness in [0, 1]: linear in roughness between levels. */
float prefilter_lod_of(float perceptual_roughness);

/* Scale of degree l of the environment's harmonics, k_l = integral of D N.l P_l(N.l) / integral of D N.l, for l up to
 * degree; kernel[0] is 1. By Gauss-Legendre quadrature over the half vector, in double. */
void prefilter_kernel(float perceptual_roughness, uint32_t degree, float *kernel);

/* Cube map of a level from 1 on. FACET_ERROR_MEMORY. */
facet_result prefilter_level(harmonics *h, uint32_t level, const facet_allocator *allocator,
                             uint32_t thread_count, cube *out, facet_error *error);

#endif
