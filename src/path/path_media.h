/* path_media.h - the participating media between surfaces: which of several nested dielectrics a path is
 * in, what it absorbs, where it scatters. */
#ifndef PATH_PATH_MEDIA_H
#define PATH_PATH_MEDIA_H

#include "cpu/media.h"
#include "shade/shade.h"

/* ---- nested dielectrics ---- */

/* Where closed volumes overlap, one of them displaces the others: that of the largest whole number
 * "priority" in the extras of its material (0 where there is none), of those the one with the largest ior,
 * of those the first in the file. So a liquid that reaches into its glass, or stands away from it, ends at
 * the glass, and the result does not depend on the order in which volumes were entered. Schmidt and Budge
 * 2002, "Simple Nested Dielectrics in Ray Traced Images". NULL: air. */
const medium *path_media_here(const media *m);

/* Index of refraction of that medium at a wavelength in nm, 0: the d line's. */
float path_media_ior(const media *m, float wavelength_nm);
bool path_media_disperses(const media *m);
bool path_media_has(const media *m, const scene_material *material);

/* ---- between surfaces ---- */

/* Transmittance of distance_m of that medium, without in-scattering. INFINITY: a volume without a far
 * side, which counts as thick as its material says. */
vec3 path_media_transmittance(const media *m, float distance_m);

typedef struct path_flight {
    bool is_scattered;
    float distance_m; /* to the scattering event */
    vec3 weight;      /* of beta */
} path_flight;

/* Samples a free flight over distance_m (INFINITY: to no surface): whether, and where, light scatters in
 * that medium. u_*: uniform in [0, 1). */
path_flight path_media_sample_flight(const media *m, vec3 beta, float distance_m, float u_channel,
                                     float u_distance);

#endif
