/* bake_sampling.h - filtered importance sampling (Krivanek and Colbert 2008; Colbert and Krivanek, GPU Gems 3, chapter 20).
 *
 * Directions around R are distributed as the whole lobe D N.l is, so that all count the same, and each is looked up in the
 * level of a pyramid whose texels have the solid angle that the sample stands for, K times 1 / (N pdf): what is small and
 * bright is blurred rather than hit or missed. Samples are in rings around R, so many to a ring that each has a cell as wide
 * as it is high. The pattern is the same for all texels, about the meridian through R: a cube map is one function of
 * direction, over its edges as well. */
#ifndef BAKE_BAKE_SAMPLING_H
#define BAKE_BAKE_SAMPLING_H

#include "bake/bake_lobe.h"
#include "bake/bake_source.h"
#include "ibl/cube.h"

enum { BAKE_PYRAMID_LEVELS = 14 };

#define BAKE_OVERLAP 2.0 /* K; the paper has 4 for means over texels, which blur half as much */

/* Cube maps of texels that are equal angles apart (s = tan(pi / 4 a), a where cube.h has s), so that those of a level differ by
 * a quarter in solid angle, not five times; for lookups between texels, which weigh texels with tents. Light goes from level to level as tents want it: from
 * the middle of a texel to the four around it in proportion to how near they are, so that a sun stays where it is and loses
 * nothing, which means over texels do not achieve. Texels hold sums: solid angle in the fourth lane and, times radiance, R G
 * B, both over the solid angle of the texel's tent; the fourth is nearly 1. A mean of lookups is the sum of R G B over the sum
 * of the fourth. */
typedef struct bake_pyramid {
    uint32_t level_count;
    cube levels[BAKE_PYRAMID_LEVELS]; /* each half as large as the one before */
} bake_pyramid;

/* size: of the base. FACET_ERROR_MEMORY. */
facet_result bake_pyramid_create(const bake_source *source, uint32_t size, const facet_allocator *allocator,
                                 uint32_t thread_count, bake_pyramid *out, facet_error *error);
void bake_pyramid_destroy(bake_pyramid *p); /* {0} is allowed; leaves {0} */

/* Size of a base for a lobe: texels of half the samples' width and less, or a little finer than the image's; at most
 * max_texels along an edge. */
uint32_t bake_pyramid_size(const bake_lobe *lobe, uint32_t sample_count, uint32_t image_height,
                           uint32_t max_texels);

/* Texels of half the size: means of four, weighted with solid angles. */
void bake_halve(const cube *from, uint32_t thread_count, cube *out);

/* Fills out (its size is set) with what the lobe makes of the pyramid's light. watch is told of every texel and sample.
 * FACET_ERROR_MEMORY; where it was cancelled, out is of no use. */
facet_result bake_sample(const bake_pyramid *p, const bake_lobe *lobe, uint32_t sample_count,
                         const facet_allocator *allocator, uint32_t thread_count, bake_watch *watch,
                         cube *out, facet_error *error);

#endif
