/* visibility_hit.h - where a ray meets the scene, as plain data that knows nothing of Embree. */
#ifndef CPU_VISIBILITY_HIT_H
#define CPU_VISIBILITY_HIT_H

#include <stdint.h>

#define VISIBILITY_NONE UINT32_MAX

/* The nearest hit of one ray. */
typedef struct visibility_hit {
    float t;           /* of the ray */
    float u, v;        /* weights of the triangle's second and third vertex; along a line: u */
    uint32_t geometry; /* VISIBILITY_NONE: no hit */
    uint32_t primitive;
    float normal[3]; /* geometric, of any length, outward for counter-clockwise triangles */
} visibility_hit;

#endif
