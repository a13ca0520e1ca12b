/* water_trace.h - one sample of a picture: the nearest of sea, land, model and sky, and what is seen in them. */
#ifndef WATER_WATER_TRACE_H
#define WATER_WATER_TRACE_H

#include "water/water_setup.h"
#include "water/water_place.h"

/* A sample on its way. */
typedef struct water_sample {
    const water_setup *s;
    float x, y;      /* pixels */
    float footprint; /* over that of a pixel */
    uint32_t random;
    march_ray ray;
    vec3 d;                   /* its direction */
    const water_place *place; /* that it shows of the sea; NULL: yet to be known */
} water_sample;

water_sample water_sample_begin(const water_setup *s, float x, float y, float footprint, uint32_t random);

/* What it brings for the film: radiance (cd/m^2) times the exposure, or the look of before; sea: where the ray meets the water, if it does. */
vec3 water_sample_shade(const water_sample *p, bool is_met, const march_hit *sea);

/* Radiance (cd/m^2) times the exposure of the pixel (x, y); pattern: x, y of each sample in it, [0, 1). */
vec3 water_pixel_trace(const water_setup *s, uint32_t x, uint32_t y, const float *pattern, uint32_t count);

#endif
