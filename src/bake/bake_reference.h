/* bake_reference.h - what cube maps are measured against: for one direction, every texel of the image weighed with the lobe.
 *
 * A texel counts with its radiance times the integral of the weight over its solid angle: the weight in its middle or, within
 * 24 texels of R and on the ring of Charlie, Gauss and Legendre's rule of 2 x 2 points, within 6 texels 8 x 8, in each
 * texel or width of the lobe, whichever is smaller. Weights are summed as light is, and divided by. Sums of up to 64 texels
 * are in float, of these in double. */
#ifndef BAKE_BAKE_REFERENCE_H
#define BAKE_BAKE_REFERENCE_H

#include "bake/bake_lobe.h"
#include "bake/bake_source.h"

typedef struct bake_reference {
    const bake_source *source;
    float *planes; /* the image as [row][R G B][column], rows filled up with 0 */
    float *waves;  /* [cos sin][column] */
    size_t stride; /* columns in a row of planes and waves */
} bake_reference;

/* FACET_ERROR_MEMORY. source is used, not copied. */
facet_result bake_reference_create(const bake_source *source, const facet_allocator *allocator,
                                   bake_reference *out, facet_error *error);
void bake_reference_destroy(bake_reference *r); /* {0} is allowed; leaves {0} */

/* A lobe's weight where it is looked up per texel of the image. */
typedef struct bake_reference_lobe {
    bake_lobe lobe;
    float table[4097 + 7]; /* Charlie's, over 2 s^2 */
} bake_reference_lobe;
void bake_reference_set_lobe(const bake_lobe *lobe, bake_reference_lobe *out);

/* Light of the lobe around a direction (any length) of the cube map, scaled. */
void bake_reference_gather(const bake_reference *r, const bake_reference_lobe *lobe, const double d[3],
                           double out[3]);
/* The mean over a texel of a cube map of size texels, from 64 x 64 points of it and more, 8 for each texel of the image along an
 * edge: what a mirror's texel is, within 1 % of what is small in it and bright. is_interpolated: bake_area.h. */
void bake_reference_average(const bake_reference *r, bool is_interpolated, uint32_t size, uint32_t face,
                            uint32_t x, uint32_t y, double out[3]);

/* Fills out with the lobe's light. */
void bake_reference_fill(const bake_reference *r, const bake_lobe *lobe, uint32_t thread_count,
                         bake_watch *watch, cube *out);

#endif
