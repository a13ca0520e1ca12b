/* surface_radiance.h - radiance (cd/m^2 per channel) from a surface towards the eye: emission, prefiltered
 * environment, punctual lights. It is no part of shade.h: a host, which is a renderer, defines the types and
 * look-ups below, and includes this text after them. src/cpu/surface_light.c is the host on the CPU,
 * src/gl/shaders/radiance.glsl on the GPU.
 *
 *     SurfaceHost     the point that is shaded: P (m), V (unit, to the eye), energy (ENERGY_*); and whatever
 *                     the look-ups need
 *     LightCursor     a place in the sequence of punctual lights; has_light: not at its end
 *     VolumeExit      distance_m; normal (unit, outward)
 *
 *     bool host_has_environment(host)
 *     vec3 host_specular(host, R, perceptual_roughness)    radiance prefiltered with GGX around R
 *     vec3 host_sheen(host, N, sheen_roughness)            LayerLight.sheen
 *     vec3 host_irradiance_over_pi(host, N)
 *     vec3 host_unoccluded_irradiance_over_pi(host, N)     the same for any direction, without occlusion ..
 *     vec3 host_ambient(host)                              .. and that occlusion, [0, 1], on the side of the eye
 *     VolumeExit host_exit(host, m)                        straight behind the surface, along -N
 *     vec3 host_transmitted(host, m)                       LayerLight.transmitted; 0: the host adds it itself
 *     LightCursor host_first_light(host), host_next_light(host, cursor)
 *     Light host_punctual(host, cursor)                    its intensity scaled by its visibility
 *     vec3 host_reflected(host, m, light, t, sheen_E_L)    layers_punctual(), or a variant of it
 *     host_split_sum(), host_sheen_albedo()                as for surface_tables.h */
#ifndef SHADE_COMPOSE_SURFACE_RADIANCE_H
#define SHADE_COMPOSE_SURFACE_RADIANCE_H
#include "shade/lang/lang_c_begin.h"

/* ---- a surface without layers ---- */

FN vec3 plain_radiance(SurfaceHost host, Surface s)
{
    float NdotV = surface_NdotV(s, host.V);
    vec2 dfg = host_split_sum(vec2(NdotV, s.perceptual_roughness));
    vec3 radiance = s.emissive;
    if (host_has_environment(host)) {
        vec3 specular =
            host_specular(host, surface_reflection(s, host.V, host.energy), s.perceptual_roughness);
        radiance += surface_ibl(s, NdotV, dfg, specular, host_irradiance_over_pi(host, s.N), host.energy);
    }
    for (LightCursor c = host_first_light(host); c.has_light; c = host_next_light(host, c))
        radiance += shade_punctual(s, host.P, host.V, host_punctual(host, c), host.energy, dfg);
    return radiance;
}

/* ---- layers ---- */

/* Where light that enters a closed volume diffusely has come from; for others the material's thickness. The
 * path in the volume is that of light from the environment and from punctual lights alike. */
FN VolumeExit diffuse_exit(SurfaceHost host, Layers m)
{
    VolumeExit e;
    e.distance_m = m.thickness;
    e.normal = -m.base.N;
    if (has_layer(m, LAYER_DIFFUSE_TRANSMISSION) && has_layer(m, LAYER_VOLUME))
        e = host_exit(host, m);
    return e;
}

/* LayerLight.specular. */
FN vec3 base_specular(SurfaceHost host, Layers m)
{
    if (!layers_reads_anisotropic(m, host.energy))
        return host_specular(host, layers_reflection(m, host.V, host.energy), m.base.perceptual_roughness);
    vec3 sum = vec3(0.0f);
    float weight = 0.0f;
    for (int k = 0; k < ANISOTROPY_LOOKUPS; k++) {
        AnisotropicLookup s = layers_anisotropic_lookup(m, host.V, k);
        sum += host_specular(host, s.L, s.perceptual_roughness) * s.weight;
        weight += s.weight;
    }
    return sum * (1.0f / weight);
}

/* The environment for a rough diffuse lobe around N, on whose side V is seen. */
FN RoughLight rough_light(SurfaceHost host, vec3 N, vec3 V, float NdotV, float roughness)
{
    mat3 frame = basis_from_view(N, V);
    vec3 X = COL(frame, 0);
    vec3 Y = COL(frame, 1);
    vec3 XN = (X + N) * 0.70710678f;
    DiffuseLight d = diffuse_light(
        host_unoccluded_irradiance_over_pi(host, N), host_unoccluded_irradiance_over_pi(host, -N),
        host_unoccluded_irradiance_over_pi(host, X), host_unoccluded_irradiance_over_pi(host, -X),
        host_unoccluded_irradiance_over_pi(host, Y), host_unoccluded_irradiance_over_pi(host, -Y),
        host_unoccluded_irradiance_over_pi(host, XN), host_unoccluded_irradiance_over_pi(host, -XN));
    RoughLight light;
    light.single = eon_single_light(d, NdotV, roughness);
    light.multiple = eon_multiple_light(d);
    return light;
}

/* Light from everywhere but from punctual lights. e: of diffuse_exit(). */
FN LayerLight layer_light(SurfaceHost host, Layers m, VolumeExit e)
{
    LayerLight light;
    light.specular = vec3(0.0f);
    light.irradiance_over_pi = vec3(0.0f);
    light.irradiance_back_over_pi = vec3(0.0f);
    light.clearcoat = vec3(0.0f);
    light.sheen = vec3(0.0f);
    light.transmitted = vec3(0.0f);
    light.rough.single = vec3(0.0f);
    light.rough.multiple = vec3(0.0f);
    light.rough_back = light.rough;
    if (host_has_environment(host)) {
        light.specular = base_specular(host, m);
        light.irradiance_over_pi = host_irradiance_over_pi(host, m.base.N);
        if (has_layer(m, LAYER_DIFFUSE_TRANSMISSION)) {
            light.irradiance_back_over_pi = host_irradiance_over_pi(host, e.normal);
            if (has_layer(m, LAYER_DIFFUSE_ROUGHNESS))
                light.rough_back =
                    rough_light(host, e.normal, host.V, surface_NdotV(m.base, host.V), m.diffuse_roughness);
            if (has_layer(m, LAYER_VOLUME)) {
                vec3 inside = volume_transmittance(m.attenuation_color, m.attenuation_distance, e.distance_m);
                light.irradiance_back_over_pi *= inside;
                light.rough_back.single *= inside;
                light.rough_back.multiple *= inside;
            }
        }
        if (has_layer(m, LAYER_DIFFUSE_ROUGHNESS)) {
            vec3 ambient = host_ambient(host);
            light.rough =
                rough_light(host, m.base.N, host.V, surface_NdotV(m.base, host.V), m.diffuse_roughness);
            light.rough.single *= ambient;
            light.rough.multiple *= ambient;
        }
        if (has_layer(m, LAYER_CLEARCOAT))
            light.clearcoat = host_specular(host, layers_clearcoat_reflection(m, host.V, host.energy),
                                            m.clearcoat_roughness);
        if (has_layer(m, LAYER_SHEEN))
            light.sheen = host_sheen(host, m.base.N, m.sheen_roughness);
    }
    if (has_layer(m, LAYER_TRANSMISSION))
        light.transmitted = host_transmitted(host, m);
    return light;
}

/* Directional albedo of the sheen at the cosine of a light. */
FN float sheen_albedo_of_light(SurfaceHost host, Layers m, Light l)
{
    if (!has_layer(m, LAYER_SHEEN))
        return 0.0f;
    return host_sheen_albedo(clamp(dot(m.base.N, light_illuminate(l, host.P).L), 0.0f, 1.0f),
                             m.sheen_roughness);
}

FN vec3 layered_radiance(SurfaceHost host, Layers m, LayerTables t)
{
    VolumeExit e = diffuse_exit(host, m);
    m.thickness = e.distance_m;
    vec3 punctual = vec3(0.0f);
    for (LightCursor c = host_first_light(host); c.has_light; c = host_next_light(host, c)) {
        Light l = host_punctual(host, c);
        punctual += host_reflected(host, m, l, t, sheen_albedo_of_light(host, m, l));
    }
    return layers_emission(m, host.V) + layers_ibl(m, host.V, t, layer_light(host, m, e), host.energy) +
           punctual;
}

#include "shade/lang/lang_c_end.h"
#endif
