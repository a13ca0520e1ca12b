/* material.h - what a plot knows of a material: how much light it sends from where to where. One interface for PBR, for
 * OpenGL 1 and for measured BRDFs. All numbers are shade's, legacy/fit.h's, or the file's. */
#ifndef PLOT_MATERIAL_H
#define PLOT_MATERIAL_H

#include "base/memory.h"
#include "facet/facet.h"
#include "legacy/fit.h"

struct merl; /* plot/merl.h */

typedef struct material {
    facet_plot_material parameters; /* of FACET_PLOT_MODEL_MERL: path only */
    const char *label;              /* never NULL */
    facet_energy energy;            /* of PBR, as the next */
    bool has_separable_smith;
    const struct merl *measured; /* FACET_PLOT_MODEL_MERL, else NULL */
} material;

facet_plot_material material_default(void); /* facet_plot_material_default() */

/* BRDF times N.L in 1/sr per channel, N = +Z, V unit above the horizon; 0 for L at or below it. OpenGL 1's is its radiance
 * under light of intensity 1 over pi, so that it compares with PBR under light of irradiance pi (legacy/fit.h). NAN
 * where a measured BRDF has no value. */
void material_brdf_cos(const material *m, const float V[3], size_t count, const float (*L)[3],
                       double (*out)[3]);

/* Directional albedo: the integral of material_brdf_cos() over all L, the same for light and eye exchanged where the
 * BRDF is reciprocal. Sampled by all lobes that the material has, with twice as many directions until the sum moves by
 * less than 5e-4; unmeasured directions count as black. */
void material_albedo(const material *m, const float V[3], double out[3]);

/* What leaves towards V where light of radiance 1 comes from everywhere and is looked up as prefiltered light
 * (shade/layers_ibl.h); FACET_PLOT_MODEL_PBR only. */
void material_albedo_image_based(const material *m, const float V[3], double out[3]);

/* Relative luminance of linear Rec.709. */
double material_luminance(const double rgb[3]);

/* GGX width of the narrowest lobe, (0, 1]: how fine plots have to be near the mirror direction. */
double material_width(const material *m);

/* "metal 1, roughness 0.3"; NULL: no memory. */
const char *material_describe(const facet_plot_material *p, const facet_allocator *allocator, arena *memory);

/* The base of a PBR material, and an OpenGL 1 material, as the fits take them; and back into a material with the
 * format's defaults. */
pbr_surface material_pbr_surface(const facet_plot_material *p);
ogl1_surface material_ogl1_surface(const facet_plot_material *p);
facet_plot_material material_from_pbr(const pbr_surface *s);
facet_plot_material material_from_ogl1(const ogl1_surface *s);

/* The PBR (metallic 0, ior 0: F0 is specular_color) or OpenGL 1 parameters nearest to a measured BRDF, by least squares of
 * log(1 + f cos) (Loew et al. 2012, "BRDF Models for Accurate and Efficient Rendering of Glossy Surfaces"), which keeps the
 * peak from outweighing all else; the cosine, and leaving out what is more than 80 degrees off the normal, where
 * measurements are unreliable, are Ngan, Durand and Matusik 2005, "Experimental Analysis of BRDF Models". *rms is the
 * root mean square of the residual over that of the measured values, both as logarithms. Fails with
 * FACET_ERROR_MEMORY. */
facet_result material_fit(const material *measured, facet_plot_model model, const facet_allocator *allocator,
                          facet_plot_material *out, double *rms, facet_error *error);

/* Whether a PBR material has more than the fits know: coat, sheen, film, grain. */
bool material_has_layers(const facet_plot_material *p);

#endif
