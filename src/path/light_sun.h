/* light_sun.h - facet_sun: a disc of uniform radiance at infinite distance. Holds shared shading text: include it last. */
#ifndef PATH_LIGHT_SUN_H
#define PATH_LIGHT_SUN_H

#include "facet/facet.h"
#include "shade/shade.h"

typedef struct light_sun {
    vec3 direction;   /* unit, to its middle */
    vec3 radiance;    /* cd/m^2 */
    vec3 illuminance; /* lx, of a surface that faces it */
    float sin_radius;
    float height; /* of the cap of the unit sphere that it is: 1 - cos(radius) */
    float chord2; /* squared distance on the unit sphere from the middle to the border */
    float pdf;    /* per sr, in the disc; 0: there is no sun */
} light_sun;

/* Without an illuminance above 0 in any channel, or with one, or a place, that is not finite: no sun. Its radius is kept
 * within 5e-5 rad (what floats can tell apart) and a right angle. */
light_sun light_sun_create(const facet_sun *desc);

static inline bool light_sun_contains(const light_sun *sun, vec3 d)
{
    vec3 difference = d - sun->direction; /* the cosine of so small an angle would have no digits */
    return dot(difference, difference) < sun->chord2;
}

/* About the illuminance (lx, mean of the channels) of a surface with unit normal N, {0}: one that faces it. 0 only where
 * all of it is below the horizon. */
float light_sun_irradiance(const light_sun *sun, vec3 N);

/* A uniform direction in the disc; density sun->pdf. Shirley and Wang 1994, "Direct Lighting Calculation by Monte Carlo
 * Integration": uniform height in the cap. */
vec3 light_sun_sample(const light_sun *sun, vec2 u);

#endif
