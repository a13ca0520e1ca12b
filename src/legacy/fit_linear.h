/* fit_linear.h - the linear part of a fit: for given roughness or shininess both models are sums of shapes
 * whose factors are the colors. For fit*.c only.
 *
 * Channel k is M = factor[0] shape[0] + factor[1] shape[1] + rest, with factors within bounds. The search
 * for the nonlinear parameters sees only the minimum over the linear ones (Golub and Pereyra 1973,
 * "variable projection"). */
#ifndef LEGACY_FIT_LINEAR_H
#define LEGACY_FIT_LINEAR_H

#include "legacy/fit_metric.h"

/* Weighted sums over all nodes. */
typedef struct fit_moments {
    double shapes[3]; /* of shape 0 0, 0 1, 1 1 */
    double wanted[2]; /* of shape i times (source - rest) */
    double square;    /* of source - rest */
} fit_moments;

typedef struct fit_bounds {
    double low[2], high[2];
} fit_bounds;

/* The factors that minimize the square, and the minimum; rounding may make it negative. */
double fit_box(const fit_moments *moments, const fit_bounds *bounds, double factor[2]);

/* A source and the shapes that approximate it. */
typedef struct fit_problem {
    const fit_metric *metric;
    facet_legacy_target target;
    double source_square;           /* of all channels */
    float source[3][FIT_MAX_NODES]; /* clamped unless the target is linear radiance */
    bool is_same[3];                /* equal to the previous channel */
    float lobe[FIT_MAX_NODES];
    float shape[2][FIT_MAX_NODES];
    float rest[FIT_MAX_NODES];
} fit_problem;

/* For _DRAWN the source is the displayed light, and target becomes _DISPLAY: that of the model. */
void fit_problem_from_ogl1(fit_problem *p, const fit_metric *metric, facet_legacy_target target,
                           const ogl1_surface *source);
void fit_problem_from_pbr(fit_problem *p, const fit_metric *metric, facet_legacy_target target,
                          const pbr_surface *source);

/* Finds the optimal factors of all channels for the present shapes; returns E^2. Equal channels with equal
 * bounds get equal factors. */
double fit_factors(const fit_problem *p, const fit_bounds bounds[3], double factor[3][2]);

#endif
