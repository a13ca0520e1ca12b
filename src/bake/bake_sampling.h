/* bake_sampling.h - filtered importance sampling (Krivanek and Colbert 2008; Colbert and Krivanek, GPU Gems
 * 3, chapter 20).
 *
 * Directions around R are distributed as the whole lobe D N.l, so that all have the same weight, and each is
 * looked up in the level of a pyramid whose texels have the solid angle of the sample, K times 1 / (N pdf):
 * small bright features are blurred rather than hit or missed. Samples lie on rings around R, with cells as
 * wide as high. The pattern is the same for all texels, relative to the meridian through R, so that the
 * result is continuous across the edges of the cube. */
#ifndef BAKE_BAKE_SAMPLING_H
#define BAKE_BAKE_SAMPLING_H

#include "bake/bake_lobe.h"
#include "bake/bake_source.h"
#include "ibl/cube.h"

enum { BAKE_PYRAMID_LEVELS = 14 };

#define BAKE_OVERLAP 2.0 /* K; the paper uses 4 with box-filtered mips, which blur half as much */

/* Cube maps with equiangular texels (s = tan(pi / 4 a), a where cube.h has s), whose solid angles differ by a
 * quarter within a level rather than five times. Bilinear lookups weight texels with tents, so levels are
 * reduced with tents as well: a texel spreads to the four nearest texels of the next level in proportion to
 * proximity, which keeps the position and energy of a sun, unlike box filtering. Texels hold radiance times
 * solid angle (R G B) and solid angle (fourth lane), both over the solid angle of the texel's tent; the
 * fourth is nearly 1. A mean of lookups is the sum of R G B over the sum of the fourth. */
typedef struct bake_pyramid {
    uint32_t level_count;
    cube levels[BAKE_PYRAMID_LEVELS]; /* each half as large as the one before */
} bake_pyramid;

/* size: of the base. FACET_ERROR_MEMORY. */
facet_result bake_pyramid_create(const bake_source *source, uint32_t size, const facet_allocator *allocator,
                                 uint32_t thread_count, bake_pyramid *out, facet_error *error);
void bake_pyramid_destroy(bake_pyramid *p); /* {0} is allowed; leaves {0} */

/* Size of the base level for a lobe: texels at most half as wide as the samples, or slightly finer than those
 * of the panorama; at most max_texels along an edge. */
uint32_t bake_pyramid_size(const bake_lobe *lobe, uint32_t sample_count, uint32_t image_height,
                           uint32_t max_texels);

/* Halves the size: means of four texels, weighted by solid angle. */
void bake_halve(const cube *from, uint32_t thread_count, cube *out);

/* Fills out, whose size is set, with the pyramid's radiance filtered with the lobe. watch counts texels times
 * samples. FACET_ERROR_MEMORY; after cancellation out is undefined. */
facet_result bake_sample(const bake_pyramid *p, const bake_lobe *lobe, uint32_t sample_count,
                         const facet_allocator *allocator, uint32_t thread_count, bake_watch *watch,
                         cube *out, facet_error *error);

#endif
