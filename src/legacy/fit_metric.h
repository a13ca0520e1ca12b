/* fit_metric.h - quadrature directions of the error, and the shapes of both models there. For fit*.c only. */
#ifndef LEGACY_FIT_METRIC_H
#define LEGACY_FIT_METRIC_H

#include "legacy/fit.h"

enum {
    FIT_VIEWS = 3,
    FIT_LANES = 16,      /* nodes of a view are a multiple of this, which fixes the order of sums */
    FIT_MAX_RINGS = 448, /* angles between N and H */
    FIT_MAX_NODES = 4096,
    DISPLAY_STEPS = 1024
};

/* Nodes of a quadrature over half vectors, view by view. A ring is one angle between N and H; D and the
 * highlight of OpenGL 1 depend on nothing else. */
struct fit_metric {
    pbr_masking masking;
    size_t ring_begin[FIT_VIEWS + 1];
    size_t node_begin[FIT_VIEWS + 1];
    float NdotV[FIT_VIEWS];
    float cos_h[FIT_MAX_RINGS], sin_h[FIT_MAX_RINGS], log_cos_h[FIT_MAX_RINGS];
    uint16_t ring[FIT_MAX_NODES];
    float NdotL[FIT_MAX_NODES];
    float VdotH[FIT_MAX_NODES];
    float fresnel[FIT_MAX_NODES]; /* Schlick's weight */
    float weight[FIT_MAX_NODES];  /* N.L dL; 0 for padding */
    /* light of even display values in [0, 1], the last one twice; linear interpolation is within 5e-7 */
    float display[DISPLAY_STEPS + 2];
};

/* pi D V N.L at every node, and N.H^s. */
void fit_specular_lobe(const fit_metric *metric, float perceptual_roughness, float *out);
void fit_highlight(const fit_metric *metric, float shininess, float *out);

/* The two lobes of a surface: pi f N.L = N.L diffuse[k] (1 - mix(shade[0], shade[1], w)) + lobe mix(F0[k],
 * F90[k], w) with Schlick's weight w. */
typedef struct fit_lobes {
    float diffuse[3], shade[2];
    float F0[3], F90[3];
} fit_lobes;
fit_lobes fit_lobes_of(const pbr_surface *surface);

/* Radiance of channel k at every node. */
void fit_radiance_ogl1(const fit_metric *metric, const ogl1_surface *surface, const float *highlight, int k,
                       float *out);
void fit_radiance_pbr(const fit_metric *metric, const fit_lobes *lobes, const float *lobe, int k, float *out);

/* ---- OpenGL 1 as its programs display it ---- */

/* The linear value of a display value (sRGB), any value >= 0. */
float fit_display_light(float number);

/* Displayed light at every node, at most 1: the clamped sum of display values, decoded. */
void fit_radiance_drawn(const fit_metric *metric, const ogl1_surface *surface, const float *highlight, int k,
                        float *out);

/* Remarks on a conversion from its input and its output. */
uint32_t fit_remarks_to_pbr(const ogl1_surface *in, const pbr_surface *out);
uint32_t fit_remarks_to_ogl1(const pbr_surface *in, const ogl1_surface *out);

#define OGL1_MAX_SHININESS 128.0f

/* The smallest mean square of a source, relative to white; darker sources count as that. */
#define FIT_DARKEST 1e-3

/* ---- the LUT that fit_table_generate.c computes when facet is built and fit_closed.c reads ---- */

/* Nodes: roughness by equal factors from that of ALPHA_DELTA to 1, shininess by equal steps of log(1 +
 * s). */
enum { GRAM_R = 49, GRAM_S = 76 };
#define GRAM_LOG_R (-4.605170186) /* of the first roughness, 0.01 */
#define GRAM_STEP_R (4.605170186 / (GRAM_R - 1))
#define GRAM_STEP_S 0.25

#endif
