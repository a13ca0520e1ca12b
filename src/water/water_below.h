/* water_below.h - what an eye in the water sees. Holds shared shading text: include it last. */
#ifndef WATER_WATER_BELOW_H
#define WATER_WATER_BELOW_H

#include "water/water_shade.h"

/* Radiance (cd/m^2) of something behind x m of water, seen from P along the unit direction d. */
vec3 water_behind_water(const water_setup *s, vec3 radiance, const double P[3], vec3 d, float x);

/* Radiance (cd/m^2) that comes to a point at the height y (m) from the unit direction d through water that ends at the bed, if there is
 * one, and nowhere else. The ray is width_m wide there, and by `spread` m more per m. */
vec3 water_seen_through_water(const water_setup *s, const double P[3], vec3 d, float width_m, float spread);

/* Radiance along a ray of an eye in the water; hit NULL: it does not meet the surface. */
vec3 water_shade_from_below(const water_setup *s, const march_ray *ray, const march_hit *hit);

#endif
