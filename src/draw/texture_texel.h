/* texture_texel.h - coordinates and texels of one level. Inlined into each lookup. */
#ifndef DRAW_TEXTURE_TEXEL_H
#define DRAW_TEXTURE_TEXEL_H

#include <math.h>
#include <string.h>

#include "scene/scene.h"

#include "draw/texture_footprint.h"

typedef float float4 __attribute__((vector_size(16))); /* RGBA; or u and v of two levels */
typedef int32_t int4 __attribute__((vector_size(16)));

/* ---- coordinates ---- */

/* Texture coordinate u of any value, NaN and infinity too, to [0, 1] of the image as wrap has it. Beyond 2^23 floats
 * have no fraction. */
INLINE float wrap_coordinate(float u, scene_wrap wrap)
{
    if (wrap == SCENE_WRAP_CLAMP)
        return u > 0.0f ? (u < 1.0f ? u : 1.0f) : 0.0f;
    if (!(fabsf(u) < 8388608.0f))
        return 0.0f;
    if (wrap == SCENE_WRAP_REPEAT) {
        float fraction = u - (float)(int)u;
        return fraction < 0.0f ? fraction + 1.0f : fraction;
    }
    int tile = (int)fabsf(u);
    float fraction = fabsf(u) - (float)tile;
    return tile & 1 ? 1.0f - fraction : fraction;
}

/* ---- texels ---- */

INLINE float4 fetch_8(const texture_pyramid *p, const unsigned char *texel, uint32_t channel_count)
{
    const float *color = p->color_values;
    switch (channel_count) {
    case 1:
        return (float4){color[texel[0]], color[texel[0]], color[texel[0]], 1.0f};
    case 2:
        return (float4){color[texel[0]], color[texel[0]], color[texel[0]], p->alpha_values[texel[1]]};
    case 3:
        return (float4){color[texel[0]], color[texel[1]], color[texel[2]], 1.0f};
    default:
        return (float4){color[texel[0]], color[texel[1]], color[texel[2]], p->alpha_values[texel[3]]};
    }
}

INLINE float4 fetch_16(const unsigned char *texel, uint32_t channel_count)
{
    uint16_t v[4] = {0, 0, 0, 65535};
    memcpy(v, texel, channel_count * sizeof *v);
    if (channel_count < 3) {
        v[3] = channel_count == 2 ? v[1] : 65535;
        v[1] = v[2] = v[0];
    }
    return (float4){(float)v[0], (float)v[1], (float)v[2], (float)v[3]} * (1.0f / 65535.0f);
}

INLINE float4 fetch(const texture_pyramid *p, const unsigned char *texels, size_t index,
                    uint32_t channel_count, image_type type)
{
    return type == IMAGE_U8 ? fetch_8(p, texels + index * channel_count, channel_count)
                            : fetch_16(texels + index * channel_count * 2, channel_count);
}

#endif
