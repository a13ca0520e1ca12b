/* fit.h - one material of OpenGL 1 to PBR and back, and how far apart two models are. Numbers only: no scene, no textures.
 *
 * Colors are linear here: whatever the file meant, the caller has decided. Both models see light of OpenGL 1 intensity 1,
 * PBR times pi: T = max(N.L, 0) Cd + max(N.H, 0)^s Cs, M = pi f (N.L). */
#ifndef LEGACY_FIT_H
#define LEGACY_FIT_H

#include "scene/legacy.h"

pbr_surface pbr_surface_default(void); /* glTF's defaults but for metallic 0 */

/* How PBR is evaluated. */
typedef enum pbr_masking {
    PBR_CORRELATED, /* height-correlated Smith: what facet and Khronos' renderer draw */
    PBR_SEPARABLE   /* the formula of the vignette, and of glTF's text before 2026 */
} pbr_masking;

/* Directions with weights, and what of them does not depend on the material. Immutable once made: any number of threads
 * may use it. */
typedef struct fit_metric fit_metric;
facet_result fit_metric_create(const facet_allocator *allocator, pbr_masking masking, fit_metric **out,
                               facet_error *error);
void fit_metric_destroy(fit_metric *metric); /* NULL is allowed */

typedef struct fit_error {
    double E;         /* relative to the source's RMS; to 1e-4 */
    double E_display; /* the same with both clamped to [0, 1]; to 1e-3 */
    /* the same with OpenGL 1 as its programs draw it: Cd and Cs encoded as sRGB, summed and clamped as display numbers,
     * and decoded to the light that the screen emits; to 1e-3 */
    double E_drawn;
    double views[3]; /* E of 0, 30, 60 degrees alone */
} fit_error;         /* finite: a source darker than a thousandth of white counts as that */

/* Which of the two is the source: errors are relative to it. */
typedef enum fit_source { FIT_FROM_OGL1, FIT_FROM_PBR } fit_source;
fit_error fit_compare(const fit_metric *metric, const ogl1_surface *ogl1, const pbr_surface *pbr,
                      fit_source source);

/* What a conversion found, and what it could not keep. */
typedef enum fit_remark {
    FIT_BASE_CLAMPED = 1 << 0,      /* base color above 1 would have been needed */
    FIT_SPECULAR_CLAMPED = 1 << 1,  /* Cs above 1 would have been needed */
    FIT_SHININESS_CLAMPED = 1 << 2, /* s above 128 would have been needed */
    FIT_LOW_EXPONENT = 1 << 3, /* s < 4 with a highlight: a second diffuse term rather than a highlight */
    FIT_ENERGY_GAIN = 1 << 4,  /* Cd + Cs > 1: the old material returns more light than it gets */
    FIT_METAL_WITH_DIFFUSE = 1 << 5 /* a metal that needs a diffuse term to look right */
} fit_remark;

/* OpenGL 1 to PBR. Return fit_remark or-ed. */
uint32_t ogl1_to_pbr_naive(const ogl1_surface *in, pbr_surface *out); /* roughness (2/(s+2))^(1/4), base Cd */
uint32_t ogl1_to_pbr_closed(const ogl1_surface *in, pbr_surface *out);      /* tables; reference 7.2 */
uint32_t ogl1_to_pbr_core_closed(const ogl1_surface *in, pbr_surface *out); /* the same without extensions */
uint32_t ogl1_to_pbr_fit(const fit_metric *metric, const ogl1_surface *in, facet_legacy_target target,
                         pbr_surface *out);
uint32_t ogl1_to_pbr_core_fit(const fit_metric *metric, const ogl1_surface *in, facet_legacy_target target,
                              pbr_surface *out);

/* The share of the hue of Cd that is left in the light that out reflects of white surroundings: 0 white, 1 all; 1 of grays. */
double fit_hue_share(const ogl1_surface *in, const pbr_surface *out);
#define FIT_HUE_KEPT 0.5
/* Where less than FIT_HUE_KEPT is left, replaces out by the material of least error that keeps so much; its base color is
 * proportional to Cd. Whether it did. */
bool fit_keep_hue(const fit_metric *metric, const ogl1_surface *in, facet_legacy_target target,
                  pbr_surface *out);

/* The closed form's roughness of an exponent and share of Cs that becomes F0, for textures: monotonic, any s >= 0. */
float perceptual_roughness_from_shininess(float shininess);
float shininess_from_perceptual_roughness(float perceptual_roughness); /* its inverse, [0, 1e5] */
float reflectance_share_from_shininess(float shininess);               /* F0 / Cs */

/* target is any of facet_legacy_target but _AUTO. With _DRAWN colors are still linear here: the light of the display
 * numbers. */

/* PBR to OpenGL 1 within the box s <= 128, Cd, Cs <= 1 (or without upper limits). */
typedef enum fit_range { FIT_DISPLAYABLE, FIT_UNLIMITED } fit_range;
uint32_t pbr_to_ogl1_naive(const pbr_surface *in, ogl1_surface *out);
uint32_t pbr_to_ogl1_fit(const fit_metric *metric, const pbr_surface *in, facet_legacy_target target,
                         fit_range range, ogl1_surface *out);
/* The best colors within the box for a given exponent. */
void pbr_to_ogl1_fit_at(const fit_metric *metric, const pbr_surface *in, facet_legacy_target target,
                        float shininess, ogl1_surface *out);
/* The same within the box by a table of integrals, and for textures, whose exponent is one for all texels: the best
 * colors for a given one. Linear target; within a few percent of the fit. */
uint32_t pbr_to_ogl1_closed(const pbr_surface *in, ogl1_surface *out);
uint32_t pbr_to_ogl1_closed_at(const pbr_surface *in, float shininess, ogl1_surface *out);

/* Radiance under light of intensity 1 (PBR: times pi), linear; N = +Z, V and L unit, for plots and pictures. */
void ogl1_radiance(const ogl1_surface *s, const float V[3], const float L[3], float out[3]);
void pbr_radiance(const pbr_surface *s, pbr_masking masking, const float V[3], const float L[3],
                  float out[3]);

#endif
