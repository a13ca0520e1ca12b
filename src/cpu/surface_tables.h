/* surface_tables.h - the tables that the shared text wants for a surface and a view, looked up. Holds shared shading text:
 * include it last. */
#ifndef CPU_SURFACE_TABLES_H
#define CPU_SURFACE_TABLES_H

#include "cpu/shading_hit.h"
#include "ibl/ibl.h"

/* ENERGY_* of shade/. */
static inline int surface_energy(const shading_scene *scene)
{
    return scene->energy == FACET_ENERGY_CONSERVING ? ENERGY_CONSERVING : ENERGY_GLTF;
}

/* (A, B) of the split sum; point: (N.V, perceptual roughness). */
static inline vec2 surface_dfg(vec2 point)
{
    float terms[2];
    ibl_dfg(point[0], point[1], terms);
    return vec2(terms[0], terms[1]);
}

/* Of a surface seen from V. */
static inline LayerTables surface_tables(const Layers *m, vec3 V, int energy)
{
    vec2 coat = vec2(0.0f);
    vec2 transmission = vec2(0.0f);
    float sheen_E = 0.0f;
    if (m->layers & LAYER_CLEARCOAT)
        coat = surface_dfg(vec2(layers_clearcoat_NdotV(*m, V), m->clearcoat_roughness));
    if (m->layers & LAYER_TRANSMISSION)
        transmission = surface_dfg(layers_transmission_point(*m, V, energy));
    if (m->layers & LAYER_SHEEN)
        sheen_E = ibl_sheen_albedo(surface_NdotV(m->base, V), m->sheen_roughness);
    vec3 glass = vec3(0.0f);
    if (layers_is_exact(*m, energy)) {
        vec3 point = layers_glass_point(*m, V, energy);
        float terms[3];
        ibl_glass(point[0], point[1], point[2], terms);
        glass = vec3(terms[0], terms[1], terms[2]);
    }
    return layer_tables(*m, V, energy, surface_dfg(layers_dfg_point(*m, V, energy)), coat[0] + coat[1],
                        transmission[0] + transmission[1], sheen_E, glass);
}

#endif
