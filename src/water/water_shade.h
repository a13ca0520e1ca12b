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

/* The same of still water that is depth_m deep and evenly lit, along the refracted ray `down`. */
vec3 water_from_still(const water_setup *s, float depth_m, vec3 down);

/* Light just below the surface where the bed lies depth_m below, lx on a horizontal plane, with what goes to and fro between both. */
vec3 water_light_over_bed(const water_setup *s, float depth_m);

/* Light on the bed over its mean, per channel, where the ray from P along the unit direction d meets it after `way` m, as wide as
 * width_m. */
vec3 water_bed_lit_at(const water_setup *s, const double P[3], vec3 d, float way, float width_m);

/* Of ground that the water does not cover, where it is seen from the air. */
vec3 water_shade_land(const water_setup *s);

/* What others find along rays that facets send on, as a share of all light that these show. */
typedef struct water_findings_below {
    float covered; /* by facets that mirror something else than water */
    vec3 mirrored; /* radiance of that */
    vec3 through;  /* radiance of what is seen through facets in the place of the sky */
    vec3 hidden;   /* of the sky there */
    float sun;     /* share of the sun's light that arrives */
} water_findings_below;

/* Radiance (cd/m^2) of the model, met in the water along the unit direction d from P. */
vec3 water_model_behind_water(const water_setup *s, const model_hit *hit, const double P[3], vec3 d);

/* m from P to the bed along the unit direction d; 1e4: it is not met. */
float water_way_to_bed_below(const water_setup *s, const double P[3], vec3 d);

/* Radiance (cd/m^2) that comes to a point at the height y (m) from the unit direction d through water that ends at the bed, if there is
 * one, and nowhere else. The ray is width_m wide there, and by `spread` m more per m. */
vec3 water_seen_through_water(const water_setup *s, const double P[3], vec3 d, float width_m, float spread);

/* Radiance of the surface from the eye E in the water, x m away along the unit direction d. */
vec3 water_shade_from_below(const water_setup *s, const water_place *p, const water_findings_below *found,
                            const double E[3], vec3 d, float x);

/* Stages of facet_sea_shading: 1 Schlick's formula with water's ior, 2 a microfacet highlight, 3 light of the sky and the sun in place of
 * constants, 4 refraction and absorption in place of a base color, 5 foam and glints: all of it. */

/* As linear numbers that a display's sRGB encoding takes to what the look had shown. */
vec3 water_look_sky(vec3 d);
vec3 water_look_shade(const water_setup *s, const water_place *p, vec3 d);

/* Stage 3: radiance (cd/m^2) of a surface that reflects and has a base color, in the light of the sky. */
vec3 water_look_painted(const water_setup *s, const water_place *p);

#endif
