/* water_find.h - reflections and refractions of a model at a point of the surface, seen from above the water
 * and from below. */
#ifndef WATER_WATER_FIND_H
#define WATER_WATER_FIND_H

#include "water/water_shade.h"

/* footprint: of a sample, relative to its pixel; random: selects the sampled microfacets. */
water_findings water_find(const water_setup *s, const water_place *place, float footprint, uint32_t random);

/* d: unit, from the eye. */
water_findings_below water_find_below(const water_setup *s, const water_place *place, vec3 d, float footprint,
                                      uint32_t random);

#endif
