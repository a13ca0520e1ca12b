/* sky_image.h - skies and the sun's disc as panoramas. */
#ifndef IBL_SKY_IMAGE_H
#define IBL_SKY_IMAGE_H

#include "image/image.h"

#include "ibl/sky_luts.h"

/* ---- the sun ---- */

/* Sunlight over the height of the disc: linear Rec.709 illuminance in lx as if the whole disc stood at that
 * height; 0 below the horizon. */
enum { SKY_SUN_NODES = 17 };
typedef struct sky_sun_light {
    float elevation_rad, azimuth_rad; /* of the center; azimuth from +Z towards +X */
    vec3 nodes[SKY_SUN_NODES];        /* from the lower to the upper edge */
    float horizon_rad;                /* elevation of the horizon */
} sky_sun_light;

/* Through the atmosphere, seen from a height. */
sky_sun_light sky_sun_through_air(const Atmosphere air[SKY_HALVES], float height_km, float elevation_rad,
                                  float azimuth_rad);
/* Under Preetham's sky. */
sky_sun_light sky_sun_preetham(float turbidity, float elevation_rad, float azimuth_rad);

/* Illuminance in lx of a surface that faces the center of the disc: the sum of what sky_sun_draw() adds. */
vec3 sky_sun_illuminance(const sky_sun_light *sun);

/* Adds the disc with limb darkening to a panorama in cd/m^2 (F32 RGB). Each sample goes to the texel that
 * contains it, so that energy is preserved at any resolution. */
void sky_sun_draw(const sky_sun_light *sun, image *panorama);

/* ---- skies ---- */

/* Draws sky and ground of view, without the sun's disc, into a panorama (F32 RGB). The sun's azimuth is from
 * +Z towards +X. FACET_ERROR_MEMORY. */
facet_result sky_image_atmosphere(const sky_view *view, float sun_azimuth_rad,
                                  const facet_allocator *allocator, uint32_t thread_count, image *panorama,
                                  facet_error *error);

#endif
