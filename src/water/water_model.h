/* water_model.h - a model that stands or floats in the sea: what rays of the sea's picture meet of it, lit by the sky, by what the sea
 * reflects, and by the sun where the model itself is not in between. */
#ifndef WATER_WATER_MODEL_H
#define WATER_WATER_MODEL_H

#include "cpu/render_setup.h"
#include "water/water_sky.h"

/* Stays where it is between create and destroy. */
typedef struct water_model {
    bool is_there;
    prepared_scene prepared;
    render_setup setup;
    facet_render_desc desc;   /* of setup */
    light_setup shaded_light; /* setup's, where the sun does not reach: its own are the lamps only */
    shading_scene shaded;
} water_model;

/* around: the sky, whose lower half shows the sea; it stays as long. Fails as preview_render(). */
facet_result water_model_create(const facet_scene *scene, const facet_render_desc *desc, const water_sky *sky,
                                facet_environment *around, facet_render_stats *stats, water_model *out,
                                facet_error *error);
void water_model_destroy(water_model *m); /* {0} is allowed */

/* The nearest surface of the model, of either side. */
typedef struct model_hit {
    shading_ray ray;
    visibility_hit hit;
    double distance_m;
    vec3 P;
} model_hit;

/* Along the unit direction d from P, nearer than far_m. random: decides whether surfaces of some opacity are there. */
bool water_model_find(const water_model *m, const double P[3], vec3 d, double far_m, uint32_t random,
                      model_hit *hit);
/* Of the ray of the camera through (x, y) of the picture; footprint in pixels. */
bool water_model_find_seen(const water_model *m, float x, float y, float footprint, double far_m,
                           uint32_t random, model_hit *hit);

/* Radiance (cd/m^2) towards where the ray came from. */
vec3 water_model_radiance(const water_model *m, const model_hit *hit, vec3 sun);

/* Share of light that passes the model from P along d for far_m (HUGE_VAL: for ever), [0, 1]. */
float water_model_opening(const water_model *m, const double P[3], vec3 d, double far_m);

/* Whether P is inside of a hull, which keeps the sea out: the model is met below and to all sides. */
bool water_model_is_dry(const water_model *m, const double P[3]);

#endif
