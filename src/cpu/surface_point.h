/* surface_point.h - from a hit to the values that shade/ works with: the surface and its layers, textures looked up.
 * Holds shared shading text: include it last. */
#ifndef CPU_SURFACE_POINT_H
#define CPU_SURFACE_POINT_H

#include "cpu/shading_hit.h"

typedef struct surface_point {
    shading_hit hit;
    const material_plan *plan;
    bool is_front; /* the side with counter-clockwise vertices; lines and points have no other */
    vec3 P;        /* m */
    vec3 V;        /* unit, to where the ray came from */
    vec3 dN_dx,
        dN_dy; /* change of the shading normal over the ray's footprint; undefined where nothing reads it:
                            without anti-aliasing, where no rays are let through */
    float base_color[4]; /* linear, with the alpha before its mode */
    bool is_lit;         /* false: it has base_color and m.base.emissive, .N only */
    Layers m;            /* where m.layers is 0, only base is set */
} surface_point;

/* Whether the ray sees the front of a triangle: its vertices counter-clockwise, unless the instance is mirrored. */
static inline bool surface_sees_front(const render_geometry *g, const visibility_hit *hit, vec3 direction)
{
    float facing = dot(load3(hit->normal), direction);
    return g->is_mirrored ? facing > 0.0f : facing < 0.0f;
}

void surface_point_make(const shading_scene *scene, const shading_point *point, surface_point *out);
/* alphaMode's coverage for an alpha: 0 not there, 1 opaque. */
float surface_opacity(const scene_material *material, float alpha);
/* base_color only: factor, texture and vertex color. */
void surface_base_color(const shading_scene *scene, const shading_hit *h, const material_plan *plan,
                        float out[4]);

#endif
