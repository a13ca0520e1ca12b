/* light_setup.h - the light of a render: prepared environment, rotated and scaled, and punctual lights. */
#ifndef DRAW_LIGHT_SETUP_H
#define DRAW_LIGHT_SETUP_H

#include "draw/light_grid.h"
#include "draw/render_geometry.h"
#include "ibl/ibl.h"

struct Light; /* shade/light.h */

typedef struct light_setup {
    const ibl_light *ibl; /* NULL: black */
    bool has_irradiance, has_specular, has_sheen, has_background;
    float scale; /* 2^environment_ev */
    float rotation_cos, rotation_sin;
    uint32_t punctual_count;
    struct Light *punctual;
    light_grid grid; /* which of them reach a point */
} light_setup;

/* The energy mode of a render's surfaces: FACET_BRDF_MULTISCATTER conserves energy whatever desc->energy
 * says. */
facet_energy light_energy(const facet_render_desc *desc);

/* Prepares what the materials of the drawn geometries and the background read; with FACET_SHADING_OGL1 the
 * punctual lights only. is_sampled: the renderer samples the environment and the sun's disc itself, as path
 * tracing does; prepares other punctual lights and a blurred background only. Fails as ibl_light_prepare(). */
facet_result light_setup_create(const render_geometry_set *set, const scene_pose *pose,
                                const camera_rays *camera, const facet_render_desc *desc, bool is_sampled,
                                light_setup *out, facet_error *error);
void light_setup_destroy(light_setup *light); /* {0} is allowed */
/* Warns of an image that is black because nothing emits light, which is rarely intended. */
void light_setup_warn_dark(const light_setup *light, const render_geometry_set *set,
                           const facet_render_desc *desc);

/* As the ibl_* lookups (radiance in cd/m^2), for unit directions in world space. 0 where there is no
 * light, or none was prepared because no material reads it. */
void light_irradiance_over_pi(const light_setup *light, const float N[3], float out[3]);
void light_specular(const light_setup *light, const float R[3], float perceptual_roughness, float out[3]);
void light_sheen(const light_setup *light, const float N[3], float sheen_roughness, float out[3]);
void light_background(const light_setup *light, const float d[3], float footprint_rad, float out[3]);

#endif
