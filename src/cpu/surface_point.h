/* surface_point.h - a hit as input of shade/: the surface and its layers, with textures applied. */
#ifndef CPU_SURFACE_POINT_H
#define CPU_SURFACE_POINT_H

#include "cpu/shading_hit.h"
#include "ibl/ibl.h"

typedef struct surface_point {
    shading_hit hit;
    const material_plan *plan;
    bool is_front; /* the side with counter-clockwise vertices; lines and points have no other */
    vec3 P;        /* m */
    vec3 V;        /* unit, against the ray */
    /* change of the shading normal over the ray's footprint; undefined where it is not needed: without
     * anti-aliasing, on opaque surfaces */
    vec3 dN_dx, dN_dy;
    float base_color[4]; /* linear, with the alpha before alphaMode */
    bool is_lit;         /* false: only base_color, m.base.emissive and .N are set */
    Layers m;            /* m.layers 0: only base is set */
} surface_point;

/* Whether the ray hits the front of a triangle: counter-clockwise vertices, unless the instance is
 * mirrored. */
static inline bool surface_sees_front(const render_geometry *g, const visibility_hit *hit, vec3 direction)
{
    float facing = dot(load3(hit->normal), direction);
    return g->is_mirrored ? facing > 0.0f : facing < 0.0f;
}

void surface_point_make(const shading_scene *scene, const shading_point *point, surface_point *out);
/* Coverage of an alpha by alphaMode, [0, 1]. */
float surface_opacity(const scene_material *material, float alpha);
/* base_color only: factor, texture and vertex color. */
void surface_base_color(const shading_scene *scene, const shading_hit *h, const material_plan *plan,
                        float out[4]);

/* ---- tables that shade/ takes for a surface and a view ---- */

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
