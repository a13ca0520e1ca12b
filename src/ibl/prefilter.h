/* prefilter.h - radiance filtered for reflections, one cube map per lobe and perceptual roughness.
 *
 * For N = V = R (Karis 2013) the filter is
 *   P(R) = integral of L(l) D(h) N.l dl / integral of D(h) N.l dl,  h half-way between l and R
 * which, as N.l = 2 (N.h)^2 - 1, is a convolution of the environment with a lobe that looks the same all
 * around R: harmonics.h. Importance sampling would leave 10 % error around a sun with 64 samples a texel.
 *
 * GGX's lobe is a spot around R. Charlie's (sheen) would be a ring around the horizon of R, as D is 0 in the
 * middle: with x = N.l its weight is (1 - x)^(1 / (2 alpha)) x, the mean of x is 2 / (3 + 1 / (2 alpha)). That is far
 * from what sheen reflects to any view but the one along N: most of the ring is below the horizon of N. Renderers
 * therefore filter around N with the mean of the lobe over all views (of density N.v / pi). As the lobe is reciprocal,
 * that is E(x) x, with its directional albedo E. */
#ifndef IBL_PREFILTER_H
#define IBL_PREFILTER_H

#include "facet/facet.h"
#include "ibl/cube.h"
#include "ibl/harmonics.h"

/* Those before PREFILTER_LOBE_COUNT have levels, all have kernels. */
typedef enum prefilter_lobe {
    PREFILTER_GGX,
    PREFILTER_SHEEN, /* around N */
    PREFILTER_LOBE_COUNT,
    PREFILTER_CHARLIE = PREFILTER_LOBE_COUNT /* around R, for other renderers */
} prefilter_lobe;

/* Levels of a lobe, from smooth to rough. Level 0 is not a cube map: for GGX it is the panorama itself, and narrow.h makes what lies between it and level 1. */
enum {
    PREFILTER_LEVEL_COUNT = 16, /* of the lobe with the most levels */
    PREFILTER_DEGREE = 160      /* highest degree of a level */
};
uint32_t prefilter_level_count(prefilter_lobe lobe);

/* Perceptual roughness of a level. Each lobe is 1.3 to 1.9 times as wide as the one before, so that the
 * mean of two stays near the lobe between them; equal steps of roughness would make it 4 times at the
 * smooth end. */
float prefilter_roughness(prefilter_lobe lobe, uint32_t level);
/* Texels along an edge of its faces. */
uint32_t prefilter_size(prefilter_lobe lobe, uint32_t level);
/* Identifies how a level is made. */
uint64_t prefilter_recipe(prefilter_lobe lobe, uint32_t level);
/* The lod of a roughness in [0, 1], linear in roughness between levels. Sheen begins at 1: narrower rims
 * are clamped to level 1, where they reflect almost nothing except at grazing angles. */
float prefilter_lod_of(prefilter_lobe lobe, float perceptual_roughness);

/* Kernel of a lobe: the scale of degree l, k_l = integral of D N.l P_l(N.l) / integral of D N.l (of sheen: E in
 * place of D), for l up to degree (at most HARMONICS_MAX_DEGREE); kernel[0] is 1. Roughness above 0. By Gauss-Legendre quadrature over
 * the half vector, in double. */
void prefilter_kernel(prefilter_lobe lobe, float perceptual_roughness, uint32_t degree, float *kernel);
/* The smallest degree (a multiple of 32, at most HARMONICS_MAX_DEGREE) whose truncation error is tolerance of
 * the lobe's root mean square; fills the kernel, which has HARMONICS_MAX_DEGREE + 1 elements, up to it. *cut
 * receives the error, which may exceed tolerance at the maximum. */
uint32_t prefilter_choose_degree(prefilter_lobe lobe, float perceptual_roughness, double tolerance,
                                 float *kernel, double *cut);
/* Fades out the last quarter of the degrees, so that a truncated narrow lobe does not ring: around a sun, the
 * error of the sky falls from 3 % to 0.4 %. */
void prefilter_taper(uint32_t degree, float *kernel);

/* Cube map of a level from 1 on; h has at least degree PREFILTER_DEGREE. FACET_ERROR_MEMORY. */
facet_result prefilter_level(harmonics *h, prefilter_lobe lobe, uint32_t level,
                             const facet_allocator *allocator, uint32_t thread_count, cube *out,
                             facet_error *error);

#endif
