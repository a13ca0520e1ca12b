/* ogl1_point.h - a hit in eye space, with what the maps of its legacy material hold there. Holds shared shading text:
 * include it last. */
#ifndef CPU_OGL1_POINT_H
#define CPU_OGL1_POINT_H

#include "draw/ogl1_setup.h"
#include "cpu/shading_hit.h"

typedef struct ogl1_point {
    shading_hit hit;
    const ogl1_setup *setup;
    const ogl1_material *material;
    uint32_t maps; /* bits of legacy_map_slot */
    bool is_front; /* the side with counter-clockwise vertices; lines and points have no other */
    vec3 face;     /* unit normal of the triangle on its front, eye space */
    vec3 P, V;     /* eye space: m; unit, to where the ray came from */
} ogl1_point;

ogl1_point ogl1_point_make(const shading_scene *scene, const shading_point *point);

/* The unit normal as the mesh has it (on its front), eye space: of the vertices, or of the face where the material is not
 * smooth. weight: of the corners. */
vec3 ogl1_point_normal(const ogl1_point *p, const float weight[3]);
/* The same at the hit, bent by the normal map. */
vec3 ogl1_point_mapped_normal(const shading_scene *scene, const ogl1_point *p);
/* Diffuse color and opacity before any map: the material's with the vertices', in numbers that are computed with. */
PhongColor ogl1_point_color(const ogl1_point *p, const float weight[3]);
/* Texel of a map, base and gain not yet applied; white where it is not read. */
void ogl1_point_texel(const shading_scene *scene, const ogl1_point *p, legacy_map_slot slot, float texel[4]);
/* The texel of a map of colors with its base and gain. */
PhongColor ogl1_point_map(const shading_scene *scene, const ogl1_point *p, legacy_map_slot slot);

#endif
