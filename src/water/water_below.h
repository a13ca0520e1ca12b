/* water_below.h - what an eye in the water sees. */
#ifndef WATER_WATER_BELOW_H
#define WATER_WATER_BELOW_H

#include "water/water_shade.h"

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

#endif
