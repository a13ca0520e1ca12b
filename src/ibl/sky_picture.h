/* sky_picture.h - skies as equirectangular pictures. */
#ifndef IBL_SKY_PICTURE_H
#define IBL_SKY_PICTURE_H

#include "image/image.h"

#include "ibl/sky_sun.h"
#include "ibl/sky_view.h"

/* Draws the sky and the ground that view sees, without the sun's disc, into a picture (F32 RGB). The sun's azimuth is from +Z
 * towards +X. FACET_ERROR_MEMORY. */
facet_result sky_picture_atmosphere(const sky_view *view, float sun_azimuth_rad,
                                    const facet_allocator *allocator, uint32_t thread_count, image *picture,
                                    facet_error *error);

/* The same by Preetham's formula; below the horizon a matt ground, lit by that sky and by sun. */
facet_result sky_picture_preetham(float turbidity, const sky_sun_light *sun, const float ground_albedo[3],
                                  const facet_allocator *allocator, uint32_t thread_count, image *picture,
                                  facet_error *error);

/* Illuminance in lx of the surface that gets most of the light of a picture that is symmetric about the vertical plane of an
 * azimuth. To 0.1 %. FACET_ERROR_MEMORY. */
facet_result sky_picture_illuminance(const image *picture, float azimuth_rad,
                                     const facet_allocator *allocator, uint32_t thread_count, double *out,
                                     facet_error *error);

#endif
