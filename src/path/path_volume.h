/* path_volume.h - what lies between surfaces: which of several bodies a path is in, what it absorbs, where it scatters. Holds
 * shared shading text: include it last. */
#ifndef PATH_VOLUME_H
#define PATH_VOLUME_H

#include "path/path_state.h"

/* ---- nested bodies ---- */

/* Where bodies overlap there is one of them: that of the largest whole number "priority" in the extras of its material (0
 * where there is none), of those the one with the largest ior, of those the first in the file. So a liquid that reaches
 * into its glass, or stands away from it, ends at the glass, and what a path finds does not depend on the way it came.
 * Schmidt and Budge 2002, "Simple Nested Dielectrics in Ray Traced Images". NULL: air. */
const medium *path_media_here(const media *m);

/* Index of refraction of what m says is here at a wavelength in nm, 0: the d line's. */
float path_media_ior(const media *m, float wavelength_nm);
bool path_media_disperses(const media *m);
bool path_media_has(const media *m, const scene_material *material);

/* ---- between surfaces ---- */

/* The share of light that passes distance_m of what m says is here; what is scattered on the way does not. INFINITY: a
 * body that ends nowhere, which counts as thick as its material says. */
vec3 path_media_transmittance(const media *m, float distance_m);

/* Takes p over distance_m from P (INFINITY: nothing is there) of what it is in, or to where it scatters before. u_*: uniform
 * in [0, 1). True: it scatters, p->P is there. */
bool path_fly(path *p, float distance_m, float u_channel, float u_distance);

#endif
