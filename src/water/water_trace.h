/* water_trace.h - one sample of a picture: the nearest of sea, land, model and sky, and what is seen in them. Holds shared shading text:
 * include it last. */
#ifndef WATER_WATER_TRACE_H
#define WATER_WATER_TRACE_H

#include "water/water_setup.h"

/* What the ray through (x, y) of the picture brings, for the film: radiance (cd/m^2) times the exposure, or the look of before. random: for
 * surfaces of some opacity. */
vec3 water_trace(const water_setup *s, float x, float y, uint32_t random);

#endif
