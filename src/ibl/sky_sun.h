/* sky_sun.h - the sun's disc in an equirectangular picture. */
#ifndef IBL_SKY_SUN_H
#define IBL_SKY_SUN_H

#include "image/image.h"

#include "ibl/sky_tables.h"

/* What light of the sun an eye gets, over the height of the disc; linear Rec.709 illuminance in lx that the whole disc would have
 * if all of it stood there. Below the horizon 0. */
enum { SKY_SUN_NODES = 17 };
typedef struct sky_sun_light {
    float elevation_rad, azimuth_rad; /* of the middle; from +Z towards +X */
    vec3 nodes[SKY_SUN_NODES];        /* from the lower to the upper edge */
    float horizon_rad;                /* below which nothing is seen */
} sky_sun_light;

/* Through the atmosphere, by columns of its own, seen from a height. */
sky_sun_light sky_sun_through_air(const Atmosphere air[SKY_HALVES], float height_km, float elevation_rad,
                                  float azimuth_rad);
/* Under Preetham's sky. */
sky_sun_light sky_sun_preetham(float turbidity, float elevation_rad, float azimuth_rad);

/* Illuminance of a surface that faces the middle of the disc, lx: sum of what sky_sun_draw() adds. */
vec3 sky_sun_illuminance(const sky_sun_light *sun);

/* Adds the disc to a picture in cd/m^2 (F32 RGB), limb darkening included: every part of it goes to the texel that it is in, so
 * that no picture loses light. */
void sky_sun_draw(const sky_sun_light *sun, image *picture);

#endif
