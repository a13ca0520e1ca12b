/* caustic_plan.h - chooses the layers of sunlight on the bed for an image: centered on the nearest visible
 * part of the bed, as fine as pixels are, and no finer than light is focused. */
#ifndef WATER_CAUSTIC_PLAN_H
#define WATER_CAUSTIC_PLAN_H

#include "water/water_setup.h"

/* Makes the caustics of an image, from the light, camera and waves in s. The map is empty without a bed or
 * a sun, on still water without a model's shadow in view, where too little focused light would reach the
 * eye, or where the shading omits caustics. FACET_ERROR_MEMORY; *map is to be destroyed, even then. */
facet_result caustic_map_of_picture(const water_setup *s, caustic_map *map, facet_error *error);

#endif
