/* bake_lobe.h - the lobes of cube maps as functions of x = N.l, N = V = R: of the cosine alone, so that all there is to them is
 * a density over [0, 1].
 *
 * With s^2 = sin^2 of half the angle = (1 - x) / 2 the weight of a direction, up to a constant, is
 *   GGX      x / (alpha^2 + (1 - alpha^2) s^2)^2
 *   Charlie  x (2 s^2)^(1 / (2 alpha))
 *   Lambert  x */
#ifndef BAKE_BAKE_LOBE_H
#define BAKE_BAKE_LOBE_H

#include "facet/facet.h"

#define BAKE_CHARLIE_MIN 0.1f

typedef struct bake_lobe {
    facet_lobe kind; /* not FACET_LOBE_NONE */
    double alpha;
    double width; /* rad: over which the weight changes by half or more */
} bake_lobe;

/* Roughness above 0; that of Charlie is at least BAKE_CHARLIE_MIN. */
bake_lobe bake_lobe_create(facet_lobe kind, float perceptual_roughness);

/* Weight of a direction, from s^2 in [0, 1/2]: without cancellation near the middle. */
double bake_lobe_weight(const bake_lobe *lobe, double s2);

/* The kernel of the lobe over the degrees of harmonics (prefilter.h), as far as it differs from 0; it has
 * HARMONICS_MAX_DEGREE + 1 places. False: the lobe is too narrow for HARMONICS_MAX_DEGREE, and the kernel is not usable. */
bool bake_lobe_kernel(const bake_lobe *lobe, float *kernel, uint32_t *degree);

/* The lobe's weight from R outwards, to be looked up by its share. */
enum { BAKE_LOBE_PANELS = 1024 };
typedef struct bake_lobe_shares {
    bake_lobe lobe;
    double edges[BAKE_LOBE_PANELS + 1];  /* s^2 */
    double before[BAKE_LOBE_PANELS + 1]; /* weight from 0 to there, over s^2; the last one is the whole */
} bake_lobe_shares;
void bake_lobe_share_init(const bake_lobe *lobe, bake_lobe_shares *out);
/* s^2 within which the share in [0, 1] of the weight is. */
double bake_lobe_find(const bake_lobe_shares *shares, double share);
/* Density of the lobe, 1 / sr. */
double bake_lobe_pdf(const bake_lobe_shares *shares, double s2);

#endif
