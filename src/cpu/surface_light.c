/* surface_light.c - see surface_light.h. The look-ups of each layer; the formulas are in shade/. */
#include "cpu/media.h"

#include "cpu/surface_light.h"
#include "cpu/surface_point.h"

static light_cursor lights_at(const shading_scene *scene, vec3 P)
{
    float point[3];
    store3(P, point);
    return light_grid_at(&scene->light->grid, point);
}

/* ---- lookups of the environment ---- */

static vec3 specular_light(const shading_scene *scene, vec3 direction, float perceptual_roughness)
{
    float d[3];
    float radiance[3];
    store3(direction, d);
    light_specular(scene->light, d, perceptual_roughness, radiance);
    return load3(radiance);
}

static vec3 sheen_light(const shading_scene *scene, vec3 direction, float sheen_roughness)
{
    float d[3];
    float radiance[3];
    store3(direction, d);
    light_sheen(scene->light, d, sheen_roughness, radiance);
    return load3(radiance);
}

static vec3 irradiance(const shading_scene *scene, vec3 normal)
{
    float N[3];
    float out[3];
    store3(normal, N);
    light_irradiance_over_pi(scene->light, N, out);
    return load3(out);
}

/* ---- a surface without layers ---- */

static vec3 plain_radiance(const shading_scene *scene, const surface_point *point)
{
    Surface s = point->m.base;
    vec3 V = point->V;
    int energy = surface_energy(scene);
    float NdotV = surface_NdotV(s, V);
    vec2 dfg = surface_dfg(vec2(NdotV, s.perceptual_roughness));

    vec3 radiance = s.emissive;
    if (scene->light->ibl) {
        vec3 specular = specular_light(scene, normalize(reflect(-V, s.N)), s.perceptual_roughness);
        radiance += surface_ibl(s, NdotV, dfg, specular, irradiance(scene, s.N), energy);
    }
    if (scene->light->punctual_count == 0)
        return radiance;
    light_cursor lights = lights_at(scene, point->P);
    for (uint32_t i; light_cursor_next(&lights, &i);)
        radiance += shade_punctual(s, point->P, V, scene->light->punctual[i], energy, dfg);
    return radiance;
}

/* ---- layers ---- */

/* Irradiance on the back of a diffusely transmitting surface. Into a closed volume light enters at the far
 * side, straight behind the surface, through the actual distance; without a far side, through the
 * material's thickness. */
static vec3 light_from_behind(const shading_scene *scene, const surface_point *s, Layers *m, uint64_t *rays)
{
    vec3 N = m->base.N;
    if (!(m->layers & LAYER_VOLUME))
        return irradiance(scene, -N);
    media_exit exit = {.distance_m = m->thickness, .normal = -N};
    if (media_find_exit(scene, s, -N, &exit))
        m->thickness = exit.distance_m;
    (*rays)++;
    return irradiance(scene, exit.normal) *
           volume_transmittance(m->attenuation_color, m->attenuation_distance, exit.distance_m);
}

static LayerLight environment_light(const shading_scene *scene, const surface_point *s, Layers *m,
                                    uint64_t *rays)
{
    vec3 V = s->V;
    LayerLight light;
    light.specular = specular_light(scene, layers_reflection(*m, V), m->base.perceptual_roughness);
    light.irradiance_over_pi = irradiance(scene, m->base.N);
    light.irradiance_back_over_pi = light.clearcoat = light.sheen = light.transmitted = vec3(0.0f);
    if (m->layers & LAYER_DIFFUSE_TRANSMISSION)
        light.irradiance_back_over_pi = light_from_behind(scene, s, m, rays);
    if (m->layers & LAYER_CLEARCOAT)
        light.clearcoat = specular_light(scene, layers_clearcoat_reflection(*m, V), m->clearcoat_roughness);
    if (m->layers & LAYER_SHEEN)
        light.sheen = sheen_light(scene, normalize(reflect(-V, m->base.N)), m->sheen_roughness);
    return light;
}

static vec3 punctual_radiance(const shading_scene *scene, const Layers *m, vec3 P, vec3 V, LayerTables tables)
{
    int energy = surface_energy(scene);
    vec3 radiance = vec3(0.0f);
    light_cursor lights = lights_at(scene, P);
    for (uint32_t i; light_cursor_next(&lights, &i);) {
        Light light = scene->light->punctual[i];
        float sheen_E_L = 0.0f;
        if (m->layers & LAYER_SHEEN)
            sheen_E_L = ibl_sheen_albedo(clamp(dot(m->base.N, light_illuminate(light, P).L), 0.0f, 1.0f),
                                         m->sheen_roughness);
        radiance += layers_punctual(*m, P, V, light, energy, tables, sheen_E_L);
    }
    return radiance;
}

/* Transmitted radiance enters linearly: its factor is the result for radiance 1 without other light. */
static surface_light layered_light(const shading_scene *scene, const surface_point *s)
{
    surface_light out = {.through = vec3(0.0f)};
    int energy = surface_energy(scene);
    Layers m = s->m;
    LayerTables tables = surface_tables(&m, s->V, energy);
    LayerLight light = {.specular = vec3(0.0f)};
    if (scene->light->ibl)
        light = environment_light(scene, s, &m, &out.rays);
    out.radiance = layers_emission(m, s->V) + layers_ibl(m, s->V, tables, light, energy) +
                   punctual_radiance(scene, &m, s->P, s->V, tables);
    if (m.layers & LAYER_TRANSMISSION) {
        LayerLight one = {.transmitted = vec3(1.0f)};
        m.base.occlusion = 1.0f;
        out.through = layers_ibl(m, s->V, tables, one, energy);
    }
    return out;
}

surface_light surface_light_at(const shading_scene *scene, const surface_point *s)
{
    if (s->is_lit && s->m.layers)
        return layered_light(scene, s);
    surface_light out = {.through = vec3(0.0f)};
    if (s->is_lit) {
        out.radiance = plain_radiance(scene, s);
    } else {
        /* Points and lines without normals emit as well: glTF 2.0, 3.7.2.1. */
        out.radiance = load3(s->base_color);
        if (!(s->hit.geometry->material->extensions & SCENE_UNLIT))
            out.radiance += s->m.base.emissive;
    }
    return out;
}
