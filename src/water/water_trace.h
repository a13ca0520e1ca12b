/* water_trace.h - the samples of a pixel: the nearest of sea, land, model and sky, and what is seen in
 * them. Samples that meet one piece of water are shaded as one, with the slopes that each of them sees,
 * unless the quality is the best. */
#ifndef WATER_WATER_TRACE_H
#define WATER_WATER_TRACE_H

#include "water/water_setup.h"

/* Radiance (cd/m^2) times the exposure of the pixel (x, y); pattern: x, y of each sample in it, [0, 1). */
vec3 water_pixel_trace(const water_setup *s, uint32_t x, uint32_t y, const float *pattern, uint32_t count);

#endif
