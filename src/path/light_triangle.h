/* light_triangle.h - points on a triangle as seen from another point, and the density of their directions. Holds shared
 * shading text: include it last. */
#ifndef PATH_LIGHT_TRIANGLE_H
#define PATH_LIGHT_TRIANGLE_H

#include "shade/shade.h"

/* Corners in world space, m: one and the edges from it to the next ones. */
typedef struct light_triangle {
    vec3 corner, edge1, edge2;
} light_triangle;

static inline float light_triangle_area(const light_triangle *t)
{
    return 0.5f * length(cross(t->edge1, t->edge2));
}

/* A point of a triangle and the way to it. */
typedef struct light_triangle_point {
    float u, v; /* weights of the second and the third corner */
    vec3 L;     /* unit, from P */
    float distance_m;
    float pdf; /* of L, per sr */
} light_triangle_point;

/* A point for P; u: uniform in [0, 1)^2. Directions to triangles that are large for P are uniform (Arvo 1995, "Stratified
 * Sampling of Spherical Triangles"), points on small ones are. False: seen edge on, or from one of its points. */
bool light_triangle_sample(const light_triangle *t, vec3 P, vec2 u, light_triangle_point *out);
/* The pdf that light_triangle_sample() has for the unit direction d, along which the triangle is distance_m away. */
float light_triangle_pdf(const light_triangle *t, vec3 P, vec3 d, float distance_m);

#endif
