/* path_lights.h - all that shines, for paths that aim at it and for paths that meet it: the environment, the sun,
 * punctual lights, emissive triangles. */
#ifndef PATH_LIGHTS_H
#define PATH_LIGHTS_H

#include "cpu/render_setup.h"
#include "cpu/surface_point.h"

typedef struct path_lights path_lights;

/* Everything that shines in the picture of setup, which outlives it: the environment of desc with rotation and scale,
 * desc->sun, setup's punctual lights, every visible emissive triangle (textures, strengths, double-sidedness in it).
 * Values that are no light (not finite, negative) are 0. Fails with FACET_ERROR_MEMORY. */
facet_result path_lights_create(const render_setup *setup, path_lights **out, facet_error *error);
void path_lights_destroy(path_lights *lights); /* NULL is allowed */
bool path_lights_has_any(const path_lights *lights);
/* Lights and triangles that should shine but are ignored: not finite, without area. */
uint64_t path_lights_ignored(const path_lights *lights);

/* A light as seen from a point. */
typedef struct path_light_sample {
    vec3 L;           /* unit, towards it */
    float distance_m; /* INFINITY: the surroundings */
    vec3 radiance;    /* cd/m^2; of a light without size: illuminance of a surface that faces it, lux */
    /* per sr that path_lights_sample() gives this direction; without size: the probability of this light */
    float pdf;
    bool is_delta;    /* has no size: paths never meet it */
    bool is_infinite; /* environment or sun */
    uint32_t geometry,
        primitive; /* of an emissive triangle; VISIBILITY_NONE: none. A shadow ray towards it ends before it */
} path_light_sample;

/* Chooses a light for point P and a direction to it. N: the unit normal of a surface that scatters on its side only;
 * {0}: all directions count (volumes, surfaces that let light through). u_light, u: uniform. False: there is none, or
 * none that reaches P; its probability belongs to the estimate, which is then 0. */
bool path_lights_sample(const path_lights *lights, vec3 P, vec3 N, float u_light, vec2 u,
                        path_light_sample *out);

/* Radiance of environment and sun from the unit direction d, cd/m^2. */
vec3 path_lights_infinite(const path_lights *lights, vec3 d);
/* The same without the sun. */
vec3 path_lights_environment(const path_lights *lights, vec3 d);
/* The pdf per sr with which path_lights_sample(P, N) finds d in the surroundings. */
float path_lights_infinite_pdf(const path_lights *lights, vec3 P, vec3 N, vec3 d);
/* The same for the point of an emissive triangle that the ray from P met as hit, at distance_m, direction d unit. */
float path_lights_emitter_pdf(const path_lights *lights, vec3 P, vec3 N, const visibility_hit *hit, vec3 d,
                              float distance_m);

#endif
