/* light_setup.c - see light_setup.h. */
#include "draw/light_setup.h"

#include <math.h>

#include "base/result.h"
#include "draw/material_plan.h"

#include "shade/lang/lang_c_load.h"
#include "shade/shade.h"

/* ---- what must be prepared ---- */

enum { GROUND_SKY_SIZE = 64 }; /* texels per rad of the environment that lights the ground */

facet_energy light_energy(const facet_render_desc *desc)
{
    return desc->gl.brdf == FACET_BRDF_MULTISCATTER ? FACET_ENERGY_CONSERVING : desc->energy;
}

static bool is_entirely_metallic(const scene_material *material)
{
    return material->metallic >= 1.0f &&
           material->textures[SCENE_METALLIC_ROUGHNESS_TEXTURE].texture == SCENE_NONE;
}

static void add_range(ibl_light_desc *needs, float lowest, float highest)
{
    needs->min_roughness = min(needs->min_roughness, clamp(lowest, 0.0f, 1.0f));
    needs->max_roughness = max(needs->max_roughness, clamp(highest, 0.0f, 1.0f));
    needs->needs_specular = true;
}

/* Texels scale the factor down: a textured roughness may be anything up to it. Anti-aliasing increases it. */
static void add_lobe(ibl_light_desc *needs, float roughness, bool is_textured, bool is_widened)
{
    float most = roughness;
    if (is_widened) {
        float alpha = alpha_from_roughness(clamp(roughness, 0.0f, 1.0f));
        most = sqrt(alpha_specular_aa(alpha, vec3(1.0f), vec3(1.0f)));
    }
    add_range(needs, is_textured ? 0.0f : roughness, most);
}

/* Layers look up with their own roughness; refracted rays with anything up to the combination of several
 * lobes, and they see what a camera sees. */
static void add_layers(ibl_light_desc *needs, const scene_material *m, const facet_render_desc *desc)
{
    uint32_t layers = material_plan_layers(m);
    if (layers & LAYER_CLEARCOAT)
        add_lobe(needs, m->clearcoat_roughness, scene_material_has(m, SCENE_CLEARCOAT_ROUGHNESS_TEXTURE),
                 desc->has_specular_antialiasing);
    if (layers & LAYER_ANISOTROPY && light_energy(desc) == FACET_ENERGY_CONSERVING)
        add_range(needs, 1.0f, 1.0f); /* layers_anisotropic_lookup() */
    if (layers & LAYER_SHEEN) {
        bool is_textured = scene_material_has(m, SCENE_SHEEN_ROUGHNESS_TEXTURE);
        float lowest = is_textured ? 0.0f : m->sheen_roughness;
        needs->min_sheen_roughness = needs->needs_sheen ? min(needs->min_sheen_roughness, lowest) : lowest;
        needs->max_sheen_roughness = max(needs->max_sheen_roughness, m->sheen_roughness);
        needs->needs_sheen = true;
    }
    if (layers & LAYER_DIFFUSE_TRANSMISSION)
        needs->needs_irradiance = true;
    if (layers & LAYER_TRANSMISSION) {
        float alpha = alpha_from_roughness(clamp(m->perceptual_roughness, 0.0f, 1.0f));
        add_range(needs, 0.0f, sqrt(2.0f * alpha));
        needs->needs_irradiance = true;
        needs->needs_background = true;
    }
}

static void add_material(ibl_light_desc *needs, const scene_material *material, const facet_render_desc *desc)
{
    bool is_glossy = (material->extensions & SCENE_SPECULAR_GLOSSINESS) != 0;
    bool is_textured = scene_material_has(material, is_glossy ? SCENE_SPECULAR_GLOSSINESS_TEXTURE
                                                              : SCENE_METALLIC_ROUGHNESS_TEXTURE);
    if (is_glossy) /* texels scale glossiness down */
        add_range(needs, 1.0f - material->glossiness, is_textured ? 1.0f : 1.0f - material->glossiness);
    else
        add_lobe(needs, material->perceptual_roughness, is_textured, false);
    if (desc->has_specular_antialiasing)
        add_lobe(needs, needs->max_roughness, false, true);
    /* A metal does not scatter light below its surface; the conserving mode reads it for multiple scattering. */
    if (is_glossy || !is_entirely_metallic(material) || light_energy(desc) == FACET_ENERGY_CONSERVING)
        needs->needs_irradiance = true;
    add_layers(needs, material, desc);
}

static ibl_light_desc light_needs(const render_geometry_set *set, const camera_rays *camera,
                                  const facet_render_desc *desc, bool is_sampled)
{
    ibl_light_desc needs = {.thread_count = desc->thread_count, .min_roughness = 1.0f};
    for (uint32_t i = 0; i < set->count && !is_sampled; i++)
        if (set->items[i].is_lit)
            add_material(&needs, set->items[i].material, desc);
    bool has_ground = desc->ground == FACET_GROUND_SHADOW && !is_sampled;
    if (has_ground) /* shadows are shares of it */
        needs.needs_irradiance = true;
    if (desc->background == FACET_BACKGROUND_ENVIRONMENT) {
        if (desc->background_blur > 0.0f)
            add_range(&needs, desc->background_blur, desc->background_blur);
        else if (!is_sampled)
            needs.needs_background = true;
    }
    if (needs.needs_background)
        needs.background_size = camera->is_orthographic ? 0 : (uint32_t)min(1.0f / camera->pixel_size, 1e6f);
    else if (has_ground && desc->renderer == FACET_RENDERER_KIND_PREVIEW) {
        needs.needs_background = true; /* from where the light comes that is blocked */
        needs.background_size = GROUND_SKY_SIZE;
    }
    return needs;
}

/* ---- punctual lights ---- */

static Light posed_light(const scene_posed_light *posed)
{
    const scene_light *l = &posed->light;
    vec3 intensity = load3(l->color) * l->intensity;
    vec3 position = load3(posed->position);
    vec3 direction = load3(posed->direction);
    switch (l->type) {
    case SCENE_LIGHT_DIRECTIONAL:
        return light_directional(direction, intensity);
    case SCENE_LIGHT_SPOT:
        return light_spot(position, direction, intensity, l->range, l->inner_cone_rad, l->outer_cone_rad);
    case SCENE_LIGHT_POINT:
        break;
    }
    return light_point(position, intensity, l->range);
}

/* A sun without size; false: there is none. */
static bool delta_sun(const facet_render_desc *desc, Light *out)
{
    const facet_sun *sun = &desc->sun;
    vec3 E = load3(sun->illuminance_lux);
    if (!(max3(E) > 0.0f))
        return false;
    float level = cos(sun->elevation_rad);
    *out = light_directional(
        -vec3(level * sin(sun->azimuth_rad), sin(sun->elevation_rad), level * cos(sun->azimuth_rad)), E);
    return true;
}

static facet_result create_punctual(const scene_pose *pose, const facet_render_desc *desc, bool is_sampled,
                                    light_setup *out, facet_error *error)
{
    Light sun;
    bool has_sun = !is_sampled && delta_sun(desc, &sun);
    uint32_t of_scene = desc->ignores_scene_lights ? 0 : pose->light_count;
    uint32_t count = of_scene + (has_sun ? 1 : 0);
    if (count == 0)
        return FACET_OK;
    out->punctual = mem_alloc(&desc->allocator, count, sizeof *out->punctual);
    if (!out->punctual)
        return fail_memory(error, "lights", count * sizeof *out->punctual);
    out->punctual_count = count;
    for (uint32_t i = 0; i < of_scene; i++)
        out->punctual[i] = posed_light(&pose->lights[i]);
    if (has_sun)
        out->punctual[of_scene] = sun;
    return light_grid_create(out->punctual, out->punctual_count, &desc->allocator, &out->grid, error);
}

facet_result light_setup_create(const render_geometry_set *set, const scene_pose *pose,
                                const camera_rays *camera, const facet_render_desc *desc, bool is_sampled,
                                light_setup *out, facet_error *error)
{
    *out = (light_setup){.scale = exp2f(desc->environment_ev),
                         .rotation_cos = cosf(desc->environment_rotation_rad),
                         .rotation_sin = sinf(desc->environment_rotation_rad)};
    facet_result result = create_punctual(pose, desc, is_sampled, out, error);
    if (result != FACET_OK) {
        light_setup_destroy(out);
        return result;
    }
    if (!desc->environment || desc->shading == FACET_SHADING_OGL1)
        return FACET_OK;
    ibl_light_desc needs = light_needs(set, camera, desc, is_sampled);
    if (!(needs.needs_irradiance || needs.needs_specular || needs.needs_sheen || needs.needs_background))
        return FACET_OK;
    result = ibl_light_prepare(desc->environment, &needs, &out->ibl, error);
    if (result != FACET_OK) {
        light_setup_destroy(out);
        return result;
    }
    out->has_irradiance = needs.needs_irradiance;
    out->has_specular = needs.needs_specular;
    out->has_sheen = needs.needs_sheen;
    out->has_background = needs.needs_background;
    return FACET_OK;
}

void light_setup_destroy(light_setup *light)
{
    ibl_light_release(light->ibl);
    mem_free(light->punctual);
    light_grid_destroy(&light->grid);
    *light = (light_setup){0};
}

/* ---- a model in the dark ---- */

static bool shines(const render_geometry *g)
{
    const float *e = g->material->emissive;
    return !g->is_lit || (e[0] + e[1] + e[2]) * g->material->emissive_strength > 0.0f;
}

/* A black image because nothing emits light is rarely intended. */
void light_setup_warn_dark(const light_setup *light, const render_geometry_set *set,
                           const facet_render_desc *desc)
{
    const float *sun = desc->sun.illuminance_lux;
    if (desc->shading == FACET_SHADING_OGL1 || desc->environment || light->punctual_count ||
        sun[0] + sun[1] + sun[2] > 0.0f || !desc->log.message)
        return;
    for (uint32_t i = 0; i < set->count; i++)
        if (shines(&set->items[i]))
            return;
    if (set->count)
        desc->log.message(
            desc->log.user, FACET_LOG_LEVEL_WARNING,
            "the image is black: there is no environment, and the model has no light of its own");
}

/* ---- lookups ---- */

/* From world to environment: the environment is rotated from +Z towards +X, so the direction is rotated back. */
static void to_environment(const light_setup *light, const float d[3], float out[3])
{
    out[0] = d[0] * light->rotation_cos - d[2] * light->rotation_sin;
    out[1] = d[1];
    out[2] = d[0] * light->rotation_sin + d[2] * light->rotation_cos;
}

static void scale3(float v[3], float factor)
{
    for (int i = 0; i < 3; i++)
        v[i] *= factor;
}

void light_irradiance_over_pi(const light_setup *light, const float N[3], float out[3])
{
    float d[3];
    out[0] = out[1] = out[2] = 0.0f;
    if (!light->has_irradiance)
        return;
    to_environment(light, N, d);
    ibl_irradiance_over_pi(light->ibl, d, out);
    scale3(out, light->scale);
}

void light_specular(const light_setup *light, const float R[3], float perceptual_roughness, float out[3])
{
    float d[3];
    out[0] = out[1] = out[2] = 0.0f;
    if (!light->has_specular)
        return;
    to_environment(light, R, d);
    ibl_specular(light->ibl, d, perceptual_roughness, out);
    scale3(out, light->scale);
}

void light_sheen(const light_setup *light, const float N[3], float sheen_roughness, float out[3])
{
    float d[3];
    out[0] = out[1] = out[2] = 0.0f;
    if (!light->has_sheen)
        return;
    to_environment(light, N, d);
    ibl_sheen(light->ibl, d, sheen_roughness, out);
    scale3(out, light->scale);
}

void light_background(const light_setup *light, const float d[3], float footprint_rad, float out[3])
{
    float turned[3];
    out[0] = out[1] = out[2] = 0.0f;
    if (!light->has_background)
        return;
    to_environment(light, d, turned);
    ibl_background(light->ibl, turned, footprint_rad, out);
    scale3(out, light->scale);
}
