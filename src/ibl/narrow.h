/* narrow.h - radiance filtered for reflections that are nearly mirrors: GGX of perceptual roughness 0 to NARROW_END,
 * where a lobe is narrower than the harmonics of prefilter.h can hold.
 *
 * In the plane, which a few degrees of the sphere are, GGX of width alpha is a mixture of Gaussians of variance v (rad^2)
 * whose share of mass up to v is exp(-2 alpha^2 / v). Without (alpha / alpha_end)^2 times the lobe of NARROW_END, whose
 * tail is then the whole tail, next to nothing of it is wider than that lobe. The rest is made of the image that
 * mirrors show and of three blurred ones, each about 2.5 times as wide as the one before and half as large (Burt and
 * Adelson 1983). One set of images does for every roughness; weights in between change continuously and are never
 * negative. With texels of 0.35 degrees the images' standard deviations are 0.25, 0.6 and 1.6 degrees.
 *
 * What is left of error in real environments is 0.1 to 6 % of the root mean square, most of it on the flanks of small
 * lamps, and up to 14 % for a sun; a mirror mixed with the lobe of NARROW_END is off by 10 to 60 %, and 200 %. */
#ifndef IBL_NARROW_H
#define IBL_NARROW_H

#include "facet/facet.h"
#include "image/image.h"

enum {
    NARROW_COUNT = 3,  /* blurred images */
    NARROW_STEPS = 16, /* steps of roughness between sets of weights */
    /* of what a lookup adds up: mirror, blurred images, lobe of NARROW_END */
    NARROW_MIRROR = 0,
    NARROW_LOBE = NARROW_COUNT + 1,
    NARROW_PARTS
};

/* Perceptual roughness of the lobe that the harmonics make: that of level 1 of GGX. */
#define NARROW_END 0.16f

typedef struct narrow {
    image blurred[NARROW_COUNT];                   /* F32 RGB; {0} from count on */
    uint32_t count;                                /* a coarse source needs fewer, one of 40 rows none */
    float weights[NARROW_STEPS + 1][NARROW_PARTS]; /* each set adds up to 1 */
} narrow;

/* From the image that mirrors show. Mean radiance over the sphere is kept, and what is uniform. FACET_ERROR_MEMORY. */
facet_result narrow_create(const image *mirror, const facet_allocator *allocator, uint32_t thread_count,
                           narrow *out, facet_error *error);
void narrow_destroy(narrow *n); /* {0} is allowed; leaves {0} */

/* Weights of the parts at a roughness in [0, NARROW_END]. */
static inline void narrow_weights(const narrow *n, float perceptual_roughness, float weights[NARROW_PARTS])
{
    float step = perceptual_roughness * ((float)NARROW_STEPS / NARROW_END);
    uint32_t i = (uint32_t)step;
    i = i < NARROW_STEPS ? i : NARROW_STEPS - 1;
    float fraction = step - (float)i;
    for (int k = 0; k < NARROW_PARTS; k++)
        weights[k] = n->weights[i][k] + (n->weights[i + 1][k] - n->weights[i][k]) * fraction;
}

/* Variances in squared texels by which each image is blurred once it has its size; the last twice, or its edges would
 * show around a sun. */
enum { NARROW_PASSES = 2 };
extern const double narrow_variances[NARROW_COUNT][NARROW_PASSES];

/* The fit behind narrow_create(): weights for count images made of one whose rows are row_rad apart, each set the one
 * that is best in the least-squares sense over the lobe's spectrum. */
void narrow_fit(uint32_t count, double row_rad, float weights[NARROW_STEPS + 1][NARROW_PARTS]);

#endif
