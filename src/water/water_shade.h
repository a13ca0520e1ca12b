/* water_shade.h - light that comes from a place of the surface to an eye over the water. */
#ifndef WATER_WATER_SHADE_H
#define WATER_WATER_SHADE_H

#include "water/water_place.h"

/* What others find along rays that leave the place; {0}: nothing but sky and water. */
typedef struct water_findings {
    bool has_below, has_shadow;
    float sun; /* share of the sun's light that arrives */
    /* share of all light that is reflected, whatever it brings, by facets that show something else than sky and sea
     * */
    float covered;
    vec3 mirrored; /* radiance of that */
    vec3 below;    /* radiance just below the surface, along the refracted ray */
} water_findings;

/* Radiance (cd/m^2) towards the eye over the water. */
vec3 water_shade(const water_setup *s, const water_place *p, const water_findings *found);

/* Radiance (cd/m^2) that goes up just below the place, towards the eye: of deep water, or of the bed through it. */
vec3 water_from_below(const water_setup *s, const water_place *p);

/* The same of still water that is depth_m deep and evenly lit, along the refracted ray `down`. */
vec3 water_from_still(const water_setup *s, float depth_m, vec3 down);

/* Light just below the surface where the bed lies depth_m below, lx on a horizontal plane, with what goes to and fro between both. */
vec3 water_light_over_bed(const water_setup *s, float depth_m);

/* Light on the bed over its mean, per channel, where the ray from P along the unit direction d meets it after `way` m, as wide as
 * width_m. */
vec3 water_bed_lit_at(const water_setup *s, const double P[3], vec3 d, float way, float width_m);

/* Of ground that the water does not cover, where it is seen from the air. */
vec3 water_shade_land(const water_setup *s);

#endif
