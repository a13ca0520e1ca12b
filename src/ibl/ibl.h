/* ibl.h - image-based light: what a renderer looks up.
 *
 * An environment (facet_environment) keeps the panorama. A light holds what a render needs of it: cube maps
 * filtered with GGX lobes, of which the roughest is the irradiance. The environment keeps prepared parts and
 * shares them between lights; they never change. */
#ifndef IBL_IBL_H
#define IBL_IBL_H

#include "facet/facet.h"

/* The lookups that a render needs. */
typedef struct ibl_light_desc {
    uint32_t thread_count;
    bool needs_irradiance;
    bool needs_specular;
    float min_roughness,
        max_roughness; /* perceptual roughness of the surfaces; only these levels are filtered */
    bool needs_sheen;  /* ibl_sheen() */
    float min_sheen_roughness, max_sheen_roughness;
    bool needs_background; /* sharp environment, ibl_background() */
    /* Resolution of the background: image height in pixels over field of view in rad; 0: that of the source */
    uint32_t background_size;
} ibl_light_desc;

/* Prepared light. Lookups take unit directions in the environment's frame; rotate them first. */
typedef struct ibl_light ibl_light;

/* Prepares a light or reuses prepared parts. Thread-safe. Release with ibl_light_release(). */
facet_result ibl_light_prepare(facet_environment *environment, const ibl_light_desc *desc,
                               const ibl_light **light, facet_error *error);
void ibl_light_release(const ibl_light *light); /* NULL is allowed */

/* Irradiance / pi (cd/m^2 per channel), the radiance of a white Lambertian surface with normal N. Never
 * negative. */
void ibl_irradiance_over_pi(const ibl_light *light, const float N[3], float out[3]);
/* Radiance around R filtered with the GGX lobe of a perceptual roughness (cd/m^2 per channel). */
void ibl_specular(const ibl_light *light, const float R[3], float perceptual_roughness, float out[3]);
/* Radiance around N filtered with Charlie's lobe (KHR_materials_sheen) of a perceptual roughness in [0, 1], as its mean
 * over views (prefilter.h; cd/m^2 per channel). Times ibl_sheen_albedo() it is what sheen of color 1 reflects; exact in
 * uniform light. Roughness is clamped to 0.1, below which the lobe approaches the horizon. */
void ibl_sheen(const ibl_light *light, const float N[3], float sheen_roughness, float out[3]);
/* Radiance from direction d (cd/m^2 per channel), from the panorama at background_size to twice that many
 * texels per rad. footprint_rad is the sampled footprint; with several samples per pixel it is not needed and
 * not used. */
void ibl_background(const ibl_light *light, const float d[3], float footprint_rad, float out[3]);

/* Split-sum terms of height-correlated GGX (Karis 2013): reflectance = F0 out[0] + F90 out[1]. NdotV and
 * perceptual_roughness in [0, 1]; bilinear in a LUT that is computed when facet is built. */
void ibl_dfg(float NdotV, float perceptual_roughness, float out[2]);

/* Directional albedo of sheen of color 1: integral of D_Charlie V_Charlie N.L (Estevez and Kulla 2017),
 * arguments in [0, 1], from a LUT that is computed when facet is built. Exceeds 1 where the model does, at
 * roughness below 0.27 and N.V below 0.06; 0 at roughness 0, where the rim has no width. */
float ibl_sheen_albedo(float NdotV, float sheen_roughness);

/* integrate_glass() of shade/glass.h from a LUT that is computed when facet is built, for ior from 1 / 9 to
 * 9, beyond that as there. eta above 0. */
void ibl_glass(float NdotV, float perceptual_roughness, float eta, float out[3]);

#endif
