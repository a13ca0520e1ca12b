/* fit_gram.h - products of the shapes that both models are made of, from a table: what linear least squares needs,
 * without a quadrature. For fit*.c only.
 *
 * Shapes: n = N.L, S = pi D V N.L of a roughness, P = (N.H)^s; w is Schlick's weight. Integrals over all views and lights of
 * fit_metric, with height-correlated masking. */
#ifndef LEGACY_FIT_GRAM_H
#define LEGACY_FIT_GRAM_H

/* The table's nodes: roughness by equal factors from that of ALPHA_MIRROR to 1, shininess by equal steps of log(1 + s). */
enum { GRAM_R = 49, GRAM_S = 76 };
#define GRAM_LOG_R (-4.605170186) /* of the first roughness, 0.01 */
#define GRAM_STEP_R (4.605170186 / (GRAM_R - 1))
#define GRAM_STEP_S 0.25

/* Index: power of w. */
typedef struct fit_gram {
    double nn[3];
    double nS[3], SS[3];
    double nP[2], PP;
    double SP[2];
} fit_gram;

/* Fills in what depends on one of the two, or on both: in any order, but for _both last. Roughness in [0, 1], s >= 0. */
typedef struct gram_place {
    int first;        /* of four nodes */
    double weight[4]; /* of their logarithms */
} gram_place;
gram_place fit_gram_roughness(fit_gram *gram, double perceptual_roughness);
gram_place fit_gram_shininess(fit_gram *gram, double shininess);
void fit_gram_both(fit_gram *gram, const gram_place *roughness, const gram_place *shininess);

/* Roughness and factors of n and S that come nearest to P: P = u n + g S. */
typedef struct fit_nearest {
    double perceptual_roughness, g;
} fit_nearest;
fit_nearest fit_gram_nearest(double shininess);
double fit_gram_nearest_shininess(double perceptual_roughness); /* the inverse; at most 1e5 */

#endif
