/* narrow.h - radiance filtered for near-mirror reflections: GGX of perceptual roughness 0 to NARROW_END,
 * whose lobes are too narrow for the harmonics of prefilter.h.
 *
 * In the plane, which a few degrees of the sphere approximate, GGX of width alpha is a mixture of Gaussians
 * of variance v (rad^2) whose cumulative mass is exp(-2 alpha^2 / v). Without (alpha / alpha_end)^2 times the
 * lobe of NARROW_END, which supplies the tail, almost nothing of it is wider than that lobe. The rest is made
 * of the sharp image and three blurred ones, each about 2.5 times as wide as the one before and half as
 * large (Burt and Adelson 1983). One set of images serves every roughness; their weights change continuously
 * and are never negative. With texels of 0.35 degrees the standard deviations are 0.25, 0.6 and 1.6 degrees.
 *
 * The error in real environments is 0.1 to 6 % RMS, most of it on the flanks of small lights, and up to 14 %
 * for a sun; the sharp image blended with the lobe of NARROW_END is off by 10 to 60 %, and 200 %. */
#ifndef IBL_NARROW_H
#define IBL_NARROW_H

#include "facet/facet.h"
#include "image/image.h"

enum {
    NARROW_COUNT = 3,  /* blurred images */
    NARROW_STEPS = 16, /* steps of roughness between sets of weights */
    /* terms of a lookup: sharp image, blurred images, lobe of NARROW_END */
    NARROW_SHARP = 0,
    NARROW_LOBE = NARROW_COUNT + 1,
    NARROW_PARTS
};

/* Perceptual roughness of level 1 of GGX, which harmonics make. */
#define NARROW_END 0.16f

typedef struct narrow {
    image blurred[NARROW_COUNT];                   /* F32 RGB; {0} from count on */
    uint32_t count;                                /* coarse sources need fewer, one of 40 rows none */
    float weights[NARROW_STEPS + 1][NARROW_PARTS]; /* each set adds up to 1 */
} narrow;

/* Blurs the panorama. Mean radiance over the sphere and uniform radiance are preserved.
 * FACET_ERROR_MEMORY. */
facet_result narrow_create(const image *sharp, const facet_allocator *allocator, uint32_t thread_count,
                           narrow *out, facet_error *error);
void narrow_destroy(narrow *n); /* {0} is allowed; leaves {0} */

/* Weights of the terms at a roughness in [0, NARROW_END]. */
static inline void narrow_weights(const narrow *n, float perceptual_roughness, float weights[NARROW_PARTS])
{
    float step = perceptual_roughness * ((float)NARROW_STEPS / NARROW_END);
    uint32_t i = (uint32_t)step;
    i = i < NARROW_STEPS ? i : NARROW_STEPS - 1;
    float fraction = step - (float)i;
    for (int k = 0; k < NARROW_PARTS; k++)
        weights[k] = n->weights[i][k] + (n->weights[i + 1][k] - n->weights[i][k]) * fraction;
}

/* Variances, in squared texels, of the blurs of each image at its size; the last one is blurred twice,
 * otherwise its edges would show around a sun. */
enum { NARROW_PASSES = 2 };
extern const double narrow_variances[NARROW_COUNT][NARROW_PASSES];

/* The fit of narrow_create(): least-squares weights over the lobe's spectrum for count images, the first with
 * rows row_rad apart. */
void narrow_fit(uint32_t count, double row_rad, float weights[NARROW_STEPS + 1][NARROW_PARTS]);

#endif
