/* water_light.h - what lights a sea and does not move: the sky with its filtered light, means over
 * microfacets, and images of the sky for the GPU. A water_cache keeps it from image to image, so that
 * frames from one place pay only for the waves. */
#ifndef WATER_WATER_LIGHT_H
#define WATER_WATER_LIGHT_H

#include "ocean/water_table.h"
#include "water/water_render.h"
#include "water/water_sky.h"

typedef struct water_light {
    facet_render_desc desc; /* what it was made for; its environment is retained */
    float eye_height_m, rows_per_rad;
    water_sky sky;
    water_table table;
    facet_environment *around; /* the sky and the sea, as a model sees them; NULL: not needed yet */
    bool around_has_foam;
    float *images, *lobes; /* of water_frame.h; NULL: not needed yet, or there are none */
} water_light;

/* Drops from the cache what was made for a sea other than desc's. */
void water_cache_begin(water_cache *cache, const facet_render_desc *desc);

/* Makes cache->light, unless the one there was made for the same sky: the same to the last bit. Fails as
 * water_sky_create(). */
facet_result water_light_update(water_cache *cache, const facet_render_desc *desc, float eye_height_m,
                                float rows_per_rad, facet_error *error);

#endif
