/* sky_image.h - skies as equirectangular images. */
#ifndef IBL_SKY_IMAGE_H
#define IBL_SKY_IMAGE_H

#include "image/image.h"

#include "ibl/sky_view.h"

/* ---- the sun ---- */

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

/* Adds the disc to an image in cd/m^2 (F32 RGB), limb darkening included: every part of it goes to the texel that it is in, so
 * that no image loses light. */
void sky_sun_draw(const sky_sun_light *sun, image *panorama);

/* ---- skies ---- */

/* Draws the sky and the ground that view sees, without the sun's disc, into an image (F32 RGB). The sun's azimuth is from +Z
 * towards +X. FACET_ERROR_MEMORY. */
facet_result sky_image_atmosphere(const sky_view *view, float sun_azimuth_rad,
                                  const facet_allocator *allocator, uint32_t thread_count, image *panorama,
                                  facet_error *error);

/* The same by Preetham's formula; below the horizon a matt ground, lit by that sky and by sun. */
facet_result sky_image_preetham(float turbidity, const sky_sun_light *sun, const float ground_albedo[3],
                                const facet_allocator *allocator, uint32_t thread_count, image *panorama,
                                facet_error *error);

/* Illuminance in lx of the surface that gets most of the light of an image that is symmetric about the vertical plane of an
 * azimuth. To 0.1 %. FACET_ERROR_MEMORY. */
facet_result sky_image_illuminance(const image *panorama, float azimuth_rad, const facet_allocator *allocator,
                                   uint32_t thread_count, double *out, facet_error *error);

#endif
