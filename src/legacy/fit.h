/* fit.h - conversion of one surface between OpenGL 1 and PBR, and the error between the models. No scene,
 * no textures.
 *
 * Colors are linear here. Both models are lit by OpenGL 1 intensity 1, PBR times pi:
 * T = max(N.L, 0) Cd + max(N.H, 0)^s Cs, M = pi f (N.L). */
#ifndef LEGACY_FIT_H
#define LEGACY_FIT_H

#include "scene/legacy.h"

pbr_surface pbr_surface_default(void); /* defaults of glTF, with metallic 0 */

/* Masking and shadowing of PBR. */
typedef enum pbr_masking {
    PBR_CORRELATED, /* height-correlated Smith, as in facet and Khronos' renderer */
    PBR_SEPARABLE   /* the formula of the vignette, and of the glTF text before 2026 */
} pbr_masking;

/* Quadrature directions with weights, and everything that does not depend on the material. Immutable after
 * creation: any number of threads may use it. */
typedef struct fit_metric fit_metric;
facet_result fit_metric_create(const facet_allocator *allocator, pbr_masking masking, fit_metric **out,
                               facet_error *error);
void fit_metric_destroy(fit_metric *metric); /* NULL is allowed */

typedef struct fit_error {
    double E;         /* relative to the source's RMS; to 1e-4 */
    double E_display; /* the same with both clamped to [0, 1]; to 1e-3 */
    /* the same with OpenGL 1 as its programs display it: Cd and Cs encoded as sRGB, summed and clamped as
     * display values, and decoded; to 1e-3 */
    double E_drawn;
    double views[3]; /* E of 0, 30, 60 degrees alone */
} fit_error;         /* finite: the RMS of the source is at least a thousandth of white */

/* The source, which errors are relative to. */
typedef enum fit_source { FIT_FROM_OGL1, FIT_FROM_PBR } fit_source;
fit_error fit_compare(const fit_metric *metric, const ogl1_surface *ogl1, const pbr_surface *pbr,
                      fit_source source);

/* Remarks of a conversion. */
typedef enum fit_remark {
    FIT_BASE_CLAMPED = 1 << 0,      /* base color above 1 would have been needed */
    FIT_SPECULAR_CLAMPED = 1 << 1,  /* Cs above 1 would have been needed */
    FIT_SHININESS_CLAMPED = 1 << 2, /* s above 128 would have been needed */
    FIT_LOW_EXPONENT = 1 << 3,      /* s < 4 with a highlight: a second diffuse term */
    FIT_ENERGY_GAIN = 1 << 4,       /* Cd + Cs > 1: the source reflects more light than it receives */
    FIT_METAL_WITH_DIFFUSE = 1 << 5 /* a metal that needs a diffuse term */
} fit_remark;

/* OpenGL 1 to PBR. Return fit_remark, combined by or. */
uint32_t ogl1_to_pbr_naive(const ogl1_surface *in, pbr_surface *out); /* roughness (2/(s+2))^(1/4), base Cd */
uint32_t ogl1_to_pbr_closed(const ogl1_surface *in, pbr_surface *out);      /* by LUTs of the optimum */
uint32_t ogl1_to_pbr_core_closed(const ogl1_surface *in, pbr_surface *out); /* the same without extensions */
uint32_t ogl1_to_pbr_fit(const fit_metric *metric, const ogl1_surface *in, facet_legacy_target target,
                         pbr_surface *out);
uint32_t ogl1_to_pbr_core_fit(const fit_metric *metric, const ogl1_surface *in, facet_legacy_target target,
                              pbr_surface *out);

/* The share of the hue of Cd that remains in the reflection of a white environment: 0 white, 1 all; 1 for
 * grays. */
double fit_hue_share(const ogl1_surface *in, const pbr_surface *out);
#define FIT_HUE_KEPT 0.5
/* If less than FIT_HUE_KEPT remains, replaces out by the material of least error that keeps it, with a
 * base color proportional to Cd, and returns true. */
bool fit_keep_hue(const fit_metric *metric, const ogl1_surface *in, facet_legacy_target target,
                  pbr_surface *out);

/* Closed-form roughness of an exponent, and the share of Cs that becomes F0, for textures: monotonic, any
 * s >= 0. */
float perceptual_roughness_from_shininess(float shininess);
float shininess_from_perceptual_roughness(float perceptual_roughness); /* its inverse, [0, 1e5] */
float reflectance_share_from_shininess(float shininess);               /* F0 / Cs */

/* target is not _AUTO. Colors are linear for _DRAWN as well: the light of the display values. */

/* PBR to OpenGL 1 within the box s <= 128, Cd, Cs <= 1 (or without upper limits). */
typedef enum fit_range { FIT_DISPLAYABLE, FIT_UNLIMITED } fit_range;
uint32_t pbr_to_ogl1_naive(const pbr_surface *in, ogl1_surface *out);
uint32_t pbr_to_ogl1_fit(const fit_metric *metric, const pbr_surface *in, facet_legacy_target target,
                         fit_range range, ogl1_surface *out);
/* The optimal colors within the box for a given exponent. */
void pbr_to_ogl1_fit_at(const fit_metric *metric, const pbr_surface *in, facet_legacy_target target,
                        float shininess, ogl1_surface *out);
/* The same within the box by a LUT of integrals; and for textures, whose texels share one exponent: the
 * optimal colors for it. Linear target; within a few percent of the fit. */
uint32_t pbr_to_ogl1_closed(const pbr_surface *in, ogl1_surface *out);
uint32_t pbr_to_ogl1_closed_at(const pbr_surface *in, float shininess, ogl1_surface *out);

/* Radiance under light of intensity 1 (PBR: times pi), linear; N = +Z, V and L unit, for plots and images. */
void ogl1_radiance(const ogl1_surface *s, const float V[3], const float L[3], float out[3]);
void pbr_radiance(const pbr_surface *s, pbr_masking masking, const float V[3], const float L[3],
                  float out[3]);

#endif
