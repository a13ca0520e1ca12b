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
    vec3 ambient;        /* factor of the environment's diffuse light, beside the occlusion of m.base */
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

/* ---- LUTs ---- */

/* ENERGY_* of shade/. */
static inline int surface_energy(const shading_scene *scene)
{
    return scene->energy == FACET_ENERGY_CONSERVING ? ENERGY_CONSERVING : ENERGY_GLTF;
}

/* The look-ups of shade/compose/surface_tables.h. */

static inline vec2 host_split_sum(vec2 point)
{
    float terms[2];
    ibl_dfg(point[0], point[1], terms);
    return vec2(terms[0], terms[1]);
}

static inline float host_sheen_albedo(float NdotV, float sheen_roughness)
{
    return ibl_sheen_albedo(NdotV, sheen_roughness);
}

static inline vec3 host_glass(float NdotV, float perceptual_roughness, float eta)
{
    float terms[3];
    ibl_glass(NdotV, perceptual_roughness, eta, terms);
    return vec3(terms[0], terms[1], terms[2]);
}

#include "shade/compose/surface_tables.h"

#endif
