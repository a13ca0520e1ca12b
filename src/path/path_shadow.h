/* path_shadow.h - what of a light's radiance arrives where it was aimed at. Holds shared shading text: include it last. */
#ifndef PATH_SHADOW_H
#define PATH_SHADOW_H

#include "path/path_state.h"

/* The share that arrives at P (m), which is free of the surface that it lies on, of light. The ray is counted in p. */
vec3 path_shadow(path *p, vec3 P, const path_light_sample *light);

#endif
