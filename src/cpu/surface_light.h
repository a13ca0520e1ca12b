/* surface_light.h - the radiance that leaves a surface: emission, the prefiltered surroundings, every light. */
#ifndef CPU_SURFACE_LIGHT_H
#define CPU_SURFACE_LIGHT_H

#include "cpu/surface_point.h"

typedef struct surface_light {
    vec3 radiance; /* cd/m^2 towards the eye, without what rays bring from behind the surface */
    /* share of the radiance that rays bring which goes on towards the eye: the boundary's tint and what its layers
     * leave; 0 where the surface lets none through */
    vec3 through;
    uint64_t rays; /* traced for it */
} surface_light;

/* Radiance and share of a surface, lit or not. */
surface_light surface_light_at(const shading_scene *scene, const surface_point *s);

#endif
