/* water_light.h - what lights a sea and does not move: the sky with its filtered light, means over facets, pictures of it for the
 * GPU. The sea keeps it from picture to picture, so that frames from one place pay for waves only. Holds shared shading text: include
 * it last. */
#ifndef WATER_WATER_LIGHT_H
#define WATER_WATER_LIGHT_H

#include "ocean/sea.h"
#include "ocean/water_table.h"
#include "water/water_sky.h"

typedef struct water_light {
    sea_kept kept;              /* first */
    facet_sea_render_desc desc; /* what it was made for; its environment stays as long */
    float eye_height_m, rows_per_rad;
    water_sky sky;
    water_table table;
    facet_environment *around; /* the sky and the sea, as a model sees them; NULL: no model asked for it */
    bool around_has_foam;
    float *pictures, *lobes; /* of sea_picture.h; NULL: nobody asked for them, or there are none */
} water_light;

/* The one that the sea keeps, if it was made for the same, or another: the same to the last bit. The caller's until
 * water_light_give_back(). What is in it is allocated as the sea is. Fails as water_sky_create(). */
facet_result water_light_take(const facet_sea *sea, const facet_sea_render_desc *desc, float eye_height_m,
                              float rows_per_rad, water_light **out, facet_error *error);
void water_light_give_back(const facet_sea *sea, water_light *light); /* NULL is allowed */

#endif
