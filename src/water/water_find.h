/* water_find.h - what a place of the surface shows of a model in the sea, to an eye over the water and to one in it. */
#ifndef WATER_WATER_FIND_H
#define WATER_WATER_FIND_H

#include "water/water_shade.h"

/* footprint: of a sample, over that of its pixel; random: which facets are looked into. */
water_findings water_find(const water_setup *s, const water_place *place, float footprint, uint32_t random);

/* d: unit, from the eye. */
water_findings_below water_find_below(const water_setup *s, const water_place *place, vec3 d, float footprint,
                                      uint32_t random);

#endif
