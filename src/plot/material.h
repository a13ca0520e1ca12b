/* material.h - the reflectance of a material for plots: one interface for PBR, OpenGL 1 and measured
 * BRDFs. Values are those of shade/, legacy/fit.h, or the file. */
#ifndef PLOT_MATERIAL_H
#define PLOT_MATERIAL_H

#include "base/memory.h"
#include "facet/facet.h"
#include "legacy/fit.h"

struct merl; /* plot/merl.h */

typedef struct material {
    facet_plot_material parameters; /* of FACET_PLOT_MODEL_MERL: path only */
    const char *label;              /* never NULL */
    facet_energy energy;            /* PBR only, as has_separable_smith */
    bool has_separable_smith;
    const struct merl *measured; /* FACET_PLOT_MODEL_MERL, else NULL */
} material;

facet_plot_material material_default(void); /* facet_plot_material_default() */

/* BRDF times N.L per channel, 1/sr, N = +Z, V unit above the horizon; 0 for L at or below it. OpenGL 1:
 * its radiance under light of intensity 1 over pi, comparable with PBR under irradiance pi (legacy/fit.h).
 * NAN where a measured BRDF has no value. */
void material_brdf_cos(const material *m, const float V[3], size_t count, const float (*L)[3],
                       double (*out)[3]);

/* Directional albedo: the integral of material_brdf_cos() over all L; by reciprocity also over all V.
 * Samples all lobes with MIS, doubling the count until the sum changes by less than 5e-4; unmeasured
 * directions count as black. */
void material_albedo(const material *m, const float V[3], double out[3]);

/* The albedo for V as image-based lighting computes it, with prefiltered light of a uniform environment of
 * radiance 1 (shade/layers_ibl.h); FACET_PLOT_MODEL_PBR only. */
void material_albedo_image_based(const material *m, const float V[3], double out[3]);

/* Relative luminance of linear Rec.709. */
double material_luminance(const double rgb[3]);

/* GGX alpha of the narrowest lobe, (0, 1]: the resolution that plots need near the mirror direction. */
double material_width(const material *m);

/* "metal 1, roughness 0.3"; NULL: no memory. */
const char *material_describe(const facet_plot_material *p, const facet_allocator *allocator, arena *memory);

/* The base layer of a PBR material, and an OpenGL 1 material, as input of the fits; and results of the
 * fits as materials. */
pbr_surface material_pbr_surface(const facet_plot_material *p);
ogl1_surface material_ogl1_surface(const facet_plot_material *p);
facet_plot_material material_from_pbr(const pbr_surface *s);
facet_plot_material material_from_ogl1(const ogl1_surface *s);

/* The PBR (metallic 0, ior 0: F0 is specular_color) or OpenGL 1 parameters that approximate a measured
 * BRDF by least squares of log(1 + f cos), which keeps the peak from outweighing all else (Loew et al.
 * 2012, "BRDF Models for Accurate and Efficient Rendering of Glossy Surfaces"). The cosine, and excluding
 * directions more than 80 degrees off the normal, where measurements are unreliable, follow Ngan, Durand
 * and Matusik 2005, "Experimental Analysis of BRDF Models". *rms: RMS of the residual over that of the
 * measured values, both as logarithms. Fails with FACET_ERROR_MEMORY. */
facet_result material_fit(const material *measured, facet_plot_model model, const facet_allocator *allocator,
                          facet_plot_material *out, double *rms, facet_error *error);

/* Whether a PBR material has layers that the fits ignore: clearcoat, sheen, iridescence, anisotropy, diffuse
 * roughness. */
bool material_has_layers(const facet_plot_material *p);

#endif
