/* surface_light.h - the radiance that leaves a surface: emission, image-based lighting, punctual lights. */
#ifndef CPU_SURFACE_LIGHT_H
#define CPU_SURFACE_LIGHT_H

#include "cpu/surface_point.h"

typedef struct surface_light {
    vec3 radiance; /* cd/m^2 towards the camera, without transmitted radiance */
    /* factor of the radiance behind the surface: tint of the boundary and transmittance of its layers; 0
     * for opaque surfaces */
    vec3 through;
    uint64_t rays; /* traced for it */
} surface_light;

/* Radiance and transmission of a surface, lit or not. */
surface_light surface_light_at(const shading_scene *scene, const surface_point *s);

#endif
