/* water_trace.h - one sample of a picture: the nearest of sea, land, model and sky, and what is seen in them. Holds shared shading text:
 * include it last. */
#ifndef WATER_WATER_TRACE_H
#define WATER_WATER_TRACE_H

#include "water/water_setup.h"

/* What the rays through pixel (x, y) of the picture bring on average, for the film: radiance (cd/m^2) times the exposure, or the look of before.
 * pattern: count places in the pixel, x and y in [0, 1). Unless all of them are to be shaded (FACET_QUALITY_FINAL), those that meet one
 * piece of water, or all miss it, are shaded once. */
vec3 water_trace_pixel(const water_setup *s, uint32_t x, uint32_t y, const float *pattern, uint32_t count);

#endif
