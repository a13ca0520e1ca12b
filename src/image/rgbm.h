/* rgbm.h - radiance in 8 bits: RGB with a multiplier as alpha. */
#ifndef IMAGE_RGBM_H
#define IMAGE_RGBM_H

#include "image/image.h"

/* U8 RGBA of F32 RGB or RGBA (alpha is not looked at), such that
 *   value = RGB / 255 * M / 255 * range
 * with the smallest M that holds the texel's largest channel, M = ceil(255 max / range), and at least 1 (Karis 2009, "RGBM
 * color encoding"; three.js' RGBMToLinear() reads it. PlayCanvas squares what it reads: it keeps roots). Values above range
 * become range, below 0 and NaN 0. The error is at most M range / (2 255^2): a part in 510 of the texel's largest channel,
 * or of a step of range / 255 where that is more. range: above 0. FACET_ERROR_MEMORY. */
facet_result rgbm_encode(const image *in, float range, const facet_allocator *allocator,
                         uint32_t thread_count, image *out, facet_error *error);

#endif
