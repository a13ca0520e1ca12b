/* ibl.h - image based light: from an environment image to what a renderer looks up.
 *
 * An environment (facet_environment) keeps the image. A light is what was prepared from it for one render:
 * cube maps filtered for GGX lobes, the roughest of which is the irradiance, as far as asked for. The environment
 * keeps prepared parts and hands them out again; they are shared and never change. */
#ifndef IBL_IBL_H
#define IBL_IBL_H

#include "facet/facet.h"

/* What a render will look up. */
typedef struct ibl_light_desc {
    uint32_t thread_count;
    bool needs_irradiance;
    bool needs_specular;
    float min_roughness,
        max_roughness; /* perceptual roughness of the surfaces; only these mips are filtered */
    bool needs_sheen;  /* ibl_sheen() */
    float min_sheen_roughness, max_sheen_roughness;
    bool needs_background;    /* sharp environment, ibl_background() */
    uint32_t background_size; /* height of the image in pixels divided by its field of view in rad: how fine
                                  the background has to be; 0: as fine as the source */
} ibl_light_desc;

/* Prepared light. Lookups take unit directions in the environment's own frame: rotate before. */
typedef struct ibl_light ibl_light;

/* Prepares, or hands out what was prepared before. Safe from several threads. Release with ibl_light_release(). */
facet_result ibl_light_prepare(facet_environment *environment, const ibl_light_desc *desc,
                               const ibl_light **light, facet_error *error);
void ibl_light_release(const ibl_light *light); /* NULL is allowed */

/* Irradiance / pi (cd/m^2 per channel): what a white Lambertian surface with normal N sends out. Never negative. */
void ibl_irradiance_over_pi(const ibl_light *light, const float N[3], float out[3]);
/* Radiance around R filtered with the GGX lobe of that perceptual roughness (cd/m^2 per channel). */
void ibl_specular(const ibl_light *light, const float R[3], float perceptual_roughness, float out[3]);
/* Radiance around R filtered with Charlie's lobe (KHR_materials_sheen) of that perceptual roughness in [0, 1] (cd/m^2 per
 * channel). The lobe is a ring on the horizon of R; below 0.1, where it would be a circle, it is that of 0.1. */
void ibl_sheen(const ibl_light *light, const float R[3], float sheen_roughness, float out[3]);
/* Radiance from direction d (cd/m^2 per channel), from the image reduced to background_size texels per rad, or up to
 * twice as many. footprint_rad is what the caller samples; with several samples a pixel it needs no more filtering
 * and is not read. */
void ibl_background(const ibl_light *light, const float d[3], float footprint_rad, float out[3]);

/* Split-sum terms of the height-correlated GGX (Karis 2013): reflectance = F0 out[0] + F90 out[1]. NdotV in
 * [0, 1], perceptual_roughness in [0, 1]; bilinear in a table that is computed when facet is built. */
void ibl_dfg(float NdotV, float perceptual_roughness, float out[2]);

/* Directional albedo of sheen of color 1: integral of D_Charlie V_Charlie N.L (Estevez and Kulla 2017), both arguments in
 * [0, 1], from a table that is computed when facet is built. Above 1 where the model is, at roughness below
 * 0.27 and N.V below 0.06; at roughness 0 the rim has no width, and it is 0. */
float ibl_sheen_albedo(float NdotV, float sheen_roughness);

/* integrate_glass() of shade/glass.h, from a table that is computed when facet is built: for ior between 1 / 9 and 9,
 * beyond as there. eta above 0. */
void ibl_glass(float NdotV, float perceptual_roughness, float eta, float out[3]);

#endif
