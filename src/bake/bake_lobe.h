/* bake_lobe.h - the lobes of cube maps as densities over x = N.l in [0, 1] (N = V = R).
 *
 * With s^2 = (1 - x) / 2, the squared sine of half the angle, the weight of a direction is, up to a constant,
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
    double width; /* rad: distance over which the weight changes by half or more */
} bake_lobe;

/* Roughness above 0; that of Charlie is at least BAKE_CHARLIE_MIN. */
bake_lobe bake_lobe_create(facet_lobe kind, float perceptual_roughness);

/* Weight of a direction from s^2 in [0, 1/2], which avoids cancellation near the axis. */
double bake_lobe_weight(const bake_lobe *lobe, double s2);

/* The kernel of the lobe over the degrees of harmonics (prefilter.h), as far as it differs from 0; it has
 * HARMONICS_MAX_DEGREE + 1 places. False: the lobe is too narrow for HARMONICS_MAX_DEGREE, and the kernel
 * is not usable. */
bool bake_lobe_kernel(const bake_lobe *lobe, float *kernel, uint32_t *degree);

/* Cumulative weight of the lobe from R outwards, for inversion. */
enum { BAKE_LOBE_PANELS = 1024 };
typedef struct bake_lobe_shares {
    bake_lobe lobe;
    double edges[BAKE_LOBE_PANELS + 1];  /* s^2 */
    double before[BAKE_LOBE_PANELS + 1]; /* cumulative weight up to each edge; the last one is the total */
} bake_lobe_shares;
void bake_lobe_share_init(const bake_lobe *lobe, bake_lobe_shares *out);
/* Inverse CDF: s^2 within which a share in [0, 1] of the weight lies. */
double bake_lobe_find(const bake_lobe_shares *shares, double share);
/* pdf of the lobe, 1 / sr. */
double bake_lobe_pdf(const bake_lobe_shares *shares, double s2);

#endif
