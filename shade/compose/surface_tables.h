/* surface_tables.h - LayerTables of a surface and a view, from the LUTs of a host (see surface_radiance.h):
 *
 *     vec2 host_split_sum(point)           integrate_dfg() at (N.V, perceptual roughness)
 *     float host_sheen_albedo(NdotV, sheen_roughness)
 *     vec3 host_glass(NdotV, perceptual_roughness, eta) */
#ifndef SHADE_COMPOSE_SURFACE_TABLES_H
#define SHADE_COMPOSE_SURFACE_TABLES_H
#include "shade/lang/lang_c_begin.h"

FN LayerTables surface_tables(Layers m, vec3 V, int energy)
{
    vec2 coat = vec2(0.0f);
    vec2 transmission = vec2(0.0f);
    float sheen_E = 0.0f;
    vec3 glass = vec3(0.0f);
    if (has_layer(m, LAYER_CLEARCOAT))
        coat = host_split_sum(vec2(layers_clearcoat_NdotV(m, V), m.clearcoat_roughness));
    if (has_layer(m, LAYER_TRANSMISSION))
        transmission = host_split_sum(layers_transmission_point(m, V, energy));
    if (has_layer(m, LAYER_SHEEN))
        sheen_E = host_sheen_albedo(surface_NdotV(m.base, V), m.sheen_roughness);
    if (layers_is_exact(m, energy)) {
        vec3 point = layers_glass_point(m, V, energy);
        glass = host_glass(point[0], point[1], point[2]);
    }
    vec2 dfg = host_split_sum(layers_dfg_point(m, V, energy));
    return layer_tables(m, V, energy, dfg, coat[0] + coat[1], transmission[0] + transmission[1], sheen_E,
                        glass);
}

#include "shade/lang/lang_c_end.h"
#endif
