/* path_shadow.h - what of a light's radiance arrives where it was aimed at. Holds shared shading text: include it last. */
#ifndef PATH_SHADOW_H
#define PATH_SHADOW_H

#include "path/path_state.h"

/* The share that arrives of light that was chosen for the point `at`. P (m) is where the ray starts: beside `at`, free of the
 * surface that it lies on, and in what `in` says. Alpha lets its share pass, and so does what light goes straight through;
 * all else that transmits blocks it, but with facet_path_desc.has_straight_shadows. The ray is counted in p. */
vec3 path_shadow(path *p, vec3 at, vec3 P, const media *in, const path_light_sample *light);

#endif
