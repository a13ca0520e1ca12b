/* rgbx.h - a texel's radiance as one vector. */
#ifndef IBL_RGBX_H
#define IBL_RGBX_H

#include "base/simd.h"

/* Radiance of a texel: R, G, B (cd/m^2) and an unused lane. Aligned to 16 bytes. */
typedef float rgbx __attribute__((vector_size(16)));

static inline rgbx rgbx_splat(float x)
{
    return (rgbx){x, x, x, x};
}

/* The larger of each lane. */
static inline rgbx rgbx_max(rgbx a, rgbx b)
{
    return (rgbx){a[0] > b[0] ? a[0] : b[0], a[1] > b[1] ? a[1] : b[1], a[2] > b[2] ? a[2] : b[2], 0.0f};
}

/* No lane below 0. */
static inline rgbx rgbx_not_negative(rgbx c)
{
    return (rgbx){c[0] > 0.0f ? c[0] : 0.0f, c[1] > 0.0f ? c[1] : 0.0f, c[2] > 0.0f ? c[2] : 0.0f, 0.0f};
}

#endif
