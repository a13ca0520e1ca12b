/* water_shade.h - radiance of the sea: of the surface from above and from below, of the bed, and in the
 * legacy style. */
#ifndef WATER_WATER_SHADE_H
#define WATER_WATER_SHADE_H

#include "water/water_place.h"

/* Radiance (cd/m^2) towards the eye over the water. footprint: of a sample, relative to its pixel; random: selects the
 * sampled microfacets. */
vec3 water_shade(const water_setup *s, const water_place *p, float footprint, uint32_t random);

/* Radiance (cd/m^2) just below still, evenly lit water that is depth_m deep, along the refracted ray `down`. */
vec3 water_from_still(const water_setup *s, float depth_m, vec3 down);

/* Irradiance (lx, horizontal) just below the surface, depth_m above the bed, including interreflection
 * between both. */
vec3 water_light_over_bed(const water_setup *s, float depth_m);

/* Irradiance of the bed relative to its mean, per channel, where the ray from P along the unit direction d
 * hits it after `distance` m with a width of width_m. */
vec3 water_bed_lit_at(const water_setup *s, const double P[3], vec3 d, float distance, float width_m);

/* Radiance of ground above the water. */
vec3 water_shade_land(const water_setup *s);

/* Radiance (cd/m^2) of the model, hit in the water along the unit direction d from P. */
vec3 water_model_behind_water(const water_setup *s, const model_hit *hit, const double P[3], vec3 d);

/* Distance from P to the bed along the unit direction d, m; WATER_FAR_M: no hit. */
float water_distance_below(const water_setup *s, const double P[3], vec3 d);

/* Radiance (cd/m^2) at P from the unit direction d through water that ends only at the bed, if there is one.
 * The ray is width_m wide at P and widens by `spread` m per m. */
vec3 water_seen_through_water(const water_setup *s, const double P[3], vec3 d, float width_m, float spread);

/* Radiance of the surface at a distance of x m along the unit direction d from the eye E in the water. */
vec3 water_shade_from_below(const water_setup *s, const water_place *p, float footprint, uint32_t random,
                            const double E[3], vec3 d, float x);

/* Stages of facet_sea_shading: 1 Schlick's Fresnel with water's ior; 2 a microfacet highlight; 3 light of
 * sky and sun instead of constants; 4 refraction and absorption instead of a base color; 5 foam and
 * glints, that is everything. */

/* Linear values whose sRGB encoding is the legacy program's display output. d: unit, from the eye. */
vec3 water_shade_legacy_sky(vec3 d);
vec3 water_shade_legacy(const water_setup *s, const water_place *p, vec3 d);

/* Stage 3: radiance (cd/m^2) of an opaque reflecting surface with a base color under the sky. */
vec3 water_shade_painted(const water_setup *s, const water_place *p);

#endif
