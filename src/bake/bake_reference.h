/* bake_reference.h - the reference for cube maps: for one direction, all texels of the panorama weighted with
 * the lobe.
 *
 * A texel contributes its radiance times the integral of the weight over its solid angle: the weight at its
 * center or, within 24 texels of R and on the ring of Charlie, a Gauss-Legendre rule of 2 x 2 points, within
 * 6 texels 8 x 8, per texel or per width of the lobe, whichever is smaller. The sum is divided by the sum of
 * weights. Up to 64 texels are summed in float, these sums in double. */
#ifndef BAKE_BAKE_REFERENCE_H
#define BAKE_BAKE_REFERENCE_H

#include "bake/bake_lobe.h"
#include "bake/bake_source.h"

typedef struct bake_reference {
    const bake_source *source;
    float *planes; /* the panorama as [row][R G B][column], rows padded with 0 */
    float *waves;  /* [cos sin][column] */
    size_t stride; /* columns in a row of planes and waves */
} bake_reference;

/* FACET_ERROR_MEMORY. source is referenced, not copied. */
facet_result bake_reference_create(const bake_source *source, const facet_allocator *allocator,
                                   bake_reference *out, facet_error *error);
void bake_reference_destroy(bake_reference *r); /* {0} is allowed; leaves {0} */

/* A lobe with the table of its weights. */
typedef struct bake_reference_lobe {
    bake_lobe lobe;
    float table[4097 + 7]; /* Charlie's, over 2 s^2 */
} bake_reference_lobe;
void bake_reference_set_lobe(const bake_lobe *lobe, bake_reference_lobe *out);

/* Radiance filtered with the lobe around a direction (any length) of the cube map, scaled. */
void bake_reference_gather(const bake_reference *r, const bake_reference_lobe *lobe, const double d[3],
                           double out[3]);
/* Mean over a texel of a cube map of size texels, by at least 64 x 64 points, 8 per texel of the panorama
 * along an edge: the texel of a sharp level, within 1 % for small bright features. is_interpolated:
 * bake_sharp_is_interpolated(). */
void bake_reference_average(const bake_reference *r, bool is_interpolated, uint32_t size, uint32_t face,
                            uint32_t x, uint32_t y, double out[3]);

/* Fills out with radiance filtered with the lobe. */
void bake_reference_fill(const bake_reference *r, const bake_lobe *lobe, uint32_t thread_count,
                         bake_watch *watch, cube *out);

#endif
