/* water_trace.h - the samples of a pixel: the nearest of sea, land, model and sky, and its radiance. Samples
 * that hit one patch of water are shaded as one, with the slopes that each of them sees, unless the
 * quality is the best. */
#ifndef WATER_WATER_TRACE_H
#define WATER_WATER_TRACE_H

#include "film/matte.h"
#include "water/water_setup.h"

typedef struct water_pixel {
    uint32_t x, y;              /* in the whole image */
    uint32_t count;             /* of samples */
    const float *pattern;       /* x, y of each sample in the pixel, [0, 1) */
    const matte_layers *mattes; /* to which the coverage of each object is added; NULL: none */
    size_t number;              /* of the pixel in the mattes */
} water_pixel;

/* Radiance (cd/m^2) times the exposure. */
vec3 water_pixel_trace(const water_setup *s, const water_pixel *p);

/* The nearest surface at the center of a pixel. */
typedef struct water_description {
    float depth_m; /* along the camera's axis */
    shading_description surface;
    const struct scene_identity *identity; /* NULL: no layer needs it */
} water_description;
/* False: the sky, or water without end. */
bool water_pixel_describe(const water_setup *s, uint32_t x, uint32_t y, water_description *out);

#endif
