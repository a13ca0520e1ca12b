/* light_emitters.h - emissive triangles, and the sampling of points on them.
 *
 * A light is a triangle of a lit geometry whose material emits. Emission without a light
 * (KHR_materials_unlit, points, lines, triangles without normals) is found by BSDF sampling only, with
 * weight 1: light_emitters_find() finds none of it. */
#ifndef PATH_LIGHT_EMITTERS_H
#define PATH_LIGHT_EMITTERS_H

#include "cpu/surface_point.h"

/* ---- a triangle ---- */

/* In world space, m: a corner, and the edges from it to the other two. */
typedef struct light_triangle {
    vec3 corner, edge1, edge2;
} light_triangle;

static inline float light_triangle_area(const light_triangle *t)
{
    return 0.5f * length(cross(t->edge1, t->edge2));
}

/* A point of a triangle as seen from P. */
typedef struct light_triangle_point {
    float u, v; /* weights of the second and the third corner */
    vec3 L;     /* unit, from P */
    float distance_m;
    float pdf; /* of L, per sr */
} light_triangle_point;

/* Samples a point for P; u: uniform in [0, 1)^2. Triangles of large solid angle are sampled uniformly in
 * direction (Arvo 1995, "Stratified Sampling of Spherical Triangles"), small ones uniformly in area.
 * False: seen edge on, or from one of its points. */
bool light_triangle_sample(const light_triangle *t, vec3 P, vec2 u, light_triangle_point *out);
/* The pdf (per sr) of light_triangle_sample() in the unit direction d, in which the triangle is distance_m
 * away. */
float light_triangle_pdf(const light_triangle *t, vec3 P, vec3 d, float distance_m);

/* ---- all that emit ---- */

#define LIGHT_EMITTERS_NONE 0xffffffffu

typedef struct light_emitter {
    uint32_t geometry, primitive; /* as in hits */
    /* cd along the normal, mean of the channels, of one side: radiance times area, above 0 */
    float intensity;
} light_emitter;

typedef struct light_emitters {
    const shading_scene *scene;
    light_emitter *items;
    uint32_t count;
    uint64_t ignored;  /* emissive triangles that are ignored: not finite, without area */
    uint32_t *first;   /* per geometry: its first entry in item_of; LIGHT_EMITTERS_NONE: it has no emission */
    uint32_t *item_of; /* per triangle of the geometries that emit: its item; LIGHT_EMITTERS_NONE: none */
} light_emitters;

/* All of a scene that outlives them. Fails with FACET_ERROR_MEMORY. */
facet_result light_emitters_create(const shading_scene *scene, const facet_allocator *allocator,
                                   uint32_t thread_count, light_emitters *out, facet_error *error);
void light_emitters_destroy(light_emitters *e); /* {0} is allowed */

/* The item that is the triangle of a hit, or LIGHT_EMITTERS_NONE. */
static inline uint32_t light_emitters_find(const light_emitters *e, uint32_t geometry, uint32_t primitive)
{
    return e->count && e->first[geometry] != LIGHT_EMITTERS_NONE ? e->item_of[e->first[geometry] + primitive]
                                                                 : LIGHT_EMITTERS_NONE;
}

/* In world space; the cross product of its edges is outward for counter-clockwise triangles of geometries
 * that are not mirrored. */
light_triangle light_emitters_triangle(const light_emitters *e, uint32_t item);
/* Whether it emits on both sides; else on that of normal_sign times the cross product of its edges. */
bool light_emitters_is_two_sided(const light_emitters *e, uint32_t item);
float light_emitters_normal_sign(const light_emitters *e, uint32_t item);

/* Radiance (cd/m^2), times coverage (alpha mask and blend), seen by a ray from P in the unit direction d
 * at the point with the weights u, v of the second and third corner: that of surface_point_make() and
 * layers_emission() with textures at full resolution. 0 from the side that does not emit, and where it is
 * not finite. */
vec3 light_emitters_radiance(const light_emitters *e, uint32_t item, float u, float v, vec3 P, vec3 d,
                             float distance_m);

#endif
