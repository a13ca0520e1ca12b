/* path_lights.h - all lights of a scene, for light sampling and for BSDF-sampled rays that hit them:
 * environment, sun, punctual lights, emissive triangles. */
#ifndef PATH_LIGHTS_H
#define PATH_LIGHTS_H

#include "cpu/render_setup.h"
#include "cpu/surface_point.h"
#include "path/light_environment.h"
#include "path/light_tree.h"

typedef struct path_lights path_lights;

/* All lights of the image of setup, which outlives them: the environment of desc with rotation and scale,
 * desc->sun, setup's punctual lights, every visible emissive triangle (with textures, strength,
 * double-sidedness). Invalid values (not finite, negative) are 0. Fails with FACET_ERROR_MEMORY. */
facet_result path_lights_create(const render_setup *setup, path_lights **out, facet_error *error);
void path_lights_destroy(path_lights *lights); /* NULL is allowed */
bool path_lights_has_any(const path_lights *lights);
/* Lights and emissive triangles that are ignored: not finite, without area. */
uint64_t path_lights_ignored(const path_lights *lights);

/* A light sample, as seen from a point. */
typedef struct path_light_sample {
    vec3 L;           /* unit, towards it */
    float distance_m; /* INFINITY: environment or sun */
    vec3 radiance;    /* cd/m^2; of a delta light: illuminance of a surface that faces it, lux */
    /* per sr, of path_lights_sample(); of a delta light: the probability of this light */
    float pdf;
    bool is_delta;    /* a delta light: rays never hit it */
    bool is_infinite; /* environment or sun */
    /* of an emissive triangle; VISIBILITY_NONE: none. A shadow ray towards it ends before it */
    uint32_t geometry, primitive;
} path_light_sample;

enum { PATH_LIGHTS_KINDS = 4 }; /* environment, sun, directional, with a position */

/* The lights as seen from a point: the irradiance from each part of them, which samples and densities share. */
typedef struct path_lights_view {
    vec3 P, N; /* N: as given */
    light_environment_view environment;
    light_tree_view tree;
    float directional; /* lx */
    float probabilities[PATH_LIGHTS_KINDS];
} path_lights_view;

/* For point P. N: the unit normal of a surface that scatters on its side only; {0}: all directions count
 * (volumes, transmissive surfaces). */
void path_lights_see(const path_lights *lights, vec3 P, vec3 N, path_lights_view *view);
/* Samples a light and a direction to it by uniform u_light, u. False: no light, or none that reaches the
 * point; the estimate is then 0. */
bool path_lights_sample(const path_lights *lights, const path_lights_view *view, float u_light, vec2 u,
                        path_light_sample *out);

/* Radiance of environment and sun from the unit direction d, cd/m^2. */
vec3 path_lights_infinite(const path_lights *lights, vec3 d);
/* The same without the sun. */
vec3 path_lights_environment(const path_lights *lights, vec3 d);
/* How many samples of path_lights_sample() to choose among: 1 where all of them contribute about alike. */
uint32_t path_lights_candidates(const path_lights *lights, const path_lights_view *view);
/* The pdf per sr of path_lights_sample() for environment or sun in direction d. */
float path_lights_infinite_pdf(const path_lights *lights, const path_lights_view *view, vec3 d);
/* The same for the point of an emissive triangle that the ray from view->P in the unit direction d hit at
 * distance_m. */
float path_lights_emitter_pdf(const path_lights *lights, const path_lights_view *view,
                              const visibility_hit *hit, vec3 d, float distance_m);

#endif
