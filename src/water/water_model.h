/* water_model.h - a model that stands or floats in the sea: ray queries against it, and its shading by the
 * sky, by light from the sea, and by the sun with its own shadow; or by OpenGL 1 (FACET_SHADING_OGL1), under
 * the lights of that shading alone. Its rays need Embree: a build without it has water_model_none.c instead of
 * water_model.c. */
#ifndef WATER_WATER_MODEL_H
#define WATER_WATER_MODEL_H

#include "cpu/shading_scene.h"
#include "water/water_sky.h"

/* Not to be moved between create and destroy. */
typedef struct water_model {
    bool is_there;
    facet_render_desc desc;             /* lit by the sky and the sea around it, and by the sun */
    float bounds_min[3], bounds_max[3]; /* m */
    struct water_model_rays *rays;      /* what traces and shades it: water_model.c */
} water_model;

/* around: the environment of the model, sky above and sea below; it outlives the model. NULL: the model is
 * not shaded, and its warnings are left to the renderer that draws it. Fails as
 * preview_render(), and with FACET_ERROR_ARGUMENT as ogl1_check(). */
facet_result water_model_create(const facet_scene *scene, const facet_render_desc *desc, const water_sky *sky,
                                facet_environment *around, facet_render_stats *stats, water_model *out,
                                facet_error *error);
void water_model_destroy(water_model *m); /* {0} is allowed */

/* The nearest surface, front or back. */
typedef struct model_hit {
    shading_ray ray;
    visibility_hit hit;
    double distance_m;
    vec3 P;
} model_hit;

/* Along the unit direction d from P, nearer than far_m. random: for stochastic opacity. */
bool water_model_find(const water_model *m, const double P[3], vec3 d, double far_m, uint32_t random,
                      model_hit *hit);
/* Along the camera ray through (x, y) of the image, on the sides that are drawn; footprint in pixels. */
bool water_model_find_seen(const water_model *m, float x, float y, float footprint, double far_m,
                           uint32_t random, model_hit *hit);

/* The nearest surface along the same ray at any opacity but 0, on the sides that are drawn; false: none.
 * depth_m along the camera's axis; geometry: its index in m->setup. */
bool water_model_describe(const water_model *m, float x, float y, double far_m, shading_description *out,
                          float *depth_m, uint32_t *geometry);

/* Radiance (cd/m^2) towards the ray's origin. */
vec3 water_model_radiance(const water_model *m, const model_hit *hit, vec3 sun);

/* Identity of a geometry, where a layer of the image needs identities. */
const struct scene_identity *water_model_identity(const water_model *m, uint32_t geometry);

/* Visibility through the model from P along d over far_m (HUGE_VAL: infinity), [0, 1]. */
float water_model_visibility(const water_model *m, const double P[3], vec3 d, double far_m);

/* Whether P is inside of a hull that keeps the sea out: the model is below it and on all sides. */
bool water_model_is_dry(const water_model *m, const double P[3]);

#endif
