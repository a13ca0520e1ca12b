/* caustic_plan.h - where a picture needs sunlight on the bed: layers around what of it is seen from nearest, as fine as pixels are, and no
 * finer than light is focused. */
#ifndef WATER_CAUSTIC_PLAN_H
#define WATER_CAUSTIC_PLAN_H

#include "water/water_setup.h"

/* The map of a picture, whose light, camera and waves are in s already; empty where there is no bed or no sun, where water is still and no model's shadow is seen, where
 * too little of the focused light would come to the eye, or the look has none. FACET_ERROR_MEMORY; *map is to be destroyed, even then. */
facet_result caustic_map_of_picture(const water_setup *s, caustic_map *map, facet_error *error);

#endif
