/* lobe_sum.h - what a lobe around any direction gathers of a picture, by summation over blocks of texels, one direction at a
 * time. It shows the errors of harmonics.h and of sampling, with which it has nothing in common. */
#ifndef IBL_LOBE_SUM_H
#define IBL_LOBE_SUM_H

#include "facet/facet.h"
#include "image/image.h"

enum { LOBE_SUM_LEVELS = 6, LOBE_SUM_MAX_WIDTH = 2048, LOBE_SUM_MIN_WIDTH = 1024 };

/* Blocks of texels in rows, each number an array of its own. Level 0 are texels, the smallest blocks of which a row has no more
 * than LOBE_SUM_MAX_WIDTH, or the largest parts of texels of which it has LOBE_SUM_MIN_WIDTH; blocks of the next level are
 * twice as wide and high. */
typedef struct lobe_blocks {
    uint32_t width, height;
    float texel_rad;     /* height of a block */
    float *direction[3]; /* of its energy, unit: for a sun that is the sun */
    float *energy[3];    /* integral of radiance over it */
} lobe_blocks;

typedef struct lobe_sum {
    float texel_rad; /* of the picture */
    uint32_t level_count;
    lobe_blocks levels[LOBE_SUM_LEVELS];
} lobe_sum;

/* From an equirectangular picture (F32 RGB) whose channels are cut off at limit. FACET_ERROR_MEMORY. */
facet_result lobe_sum_create(const image *picture, float limit, const facet_allocator *allocator,
                             uint32_t thread_count, lobe_sum *out, facet_error *error);
void lobe_sum_destroy(lobe_sum *s); /* {0} is allowed; leaves {0} */

enum { LOBE_TABLE_SIZE = 1024 };

/* A lobe to gather with. */
typedef struct lobe_plan {
    const lobe_sum *sum;
    facet_lobe lobe;
    float alpha;
    float scale;         /* 1 / integral of its weight */
    uint32_t near, far;  /* levels close to the axis and away from it */
    float x_near, x_far; /* cosines between which the one fades into the other; both -2: near alone */
    float table[LOBE_TABLE_SIZE + 2]; /* of Charlie over the cosine */
} lobe_plan;

/* The lobe D N.l for N = V = R (GGX from perceptual roughness 0.1 on; Charlie from 0.25 on) or the cosine (Lambert). */
void lobe_plan_make(const lobe_sum *sum, facet_lobe lobe, float perceptual_roughness, lobe_plan *out);
/* The mean of radiance under it around the unit vector axis; of Lambert that is irradiance / pi. Texels are of one radiance
 * each. Within 0.2 % of the sum over all of them in pictures of up to LOBE_SUM_MAX_WIDTH. */
void lobe_plan_gather(const lobe_plan *p, const float axis[3], float out[3]);

#endif
