/* boundary_normal.h - the normal by which a boundary refracts. Holds shared shading text: include it last. */
#ifndef CPU_BOUNDARY_NORMAL_H
#define CPU_BOUNDARY_NORMAL_H

#include "cpu/surface_point.h"

/* Smooth normals often lie: a modeller's rim has them averaged over its sharp edge, which turns the wall below it into a
 * prism that reflects totally. Here the vertices' normals are limited to those of a curved surface through them. */
typedef struct boundary_normal {
    vec3 N;            /* unit, on the side of V; with what the normal texture adds */
    vec3 dN_dx, dN_dy; /* its change over the ray's footprint */
    vec3 Ng;           /* unit, geometric, on the side of V */
    float tolerance;   /* of volume_rays.h, m */
} boundary_normal;

boundary_normal boundary_normal_at(const surface_point *s, const visibility_hit *hit);

#endif
