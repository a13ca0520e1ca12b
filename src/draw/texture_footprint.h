/* texture_footprint.h - which levels of a texture a pixel reads; where it lands there is in shade/footprint.h. Inlined into
 * each lookup. Holds shared shading text: include it last. */
#ifndef DRAW_TEXTURE_FOOTPRINT_H
#define DRAW_TEXTURE_FOOTPRINT_H

#include <math.h>
#include <string.h>

#include "draw/texture_pyramid.h"

#include "shade/shade.h"

#define INLINE static inline __attribute__((always_inline))

/* Two levels and the weight of the second one. */
typedef struct level_pair {
    uint32_t first, second;
    float fraction;
} level_pair;

/* The lod log2(sqrt(width_2)) as levels that are there; width_2 > 0 and normal.
 *
 * Which levels they are comes from the exponent of width_2 alone, so that fetching need not wait for the logarithm.
 * That is right to 6e-5: far below what a lod shows. With the mantissa 1 + t it is t and a correction that vanishes
 * at both ends, so that octaves join. */
INLINE level_pair get_levels(const texture_pyramid *p, float width_2)
{
    uint32_t bits;
    memcpy(&bits, &width_2, sizeof bits);
    int32_t exponent = (int32_t)(bits >> 23) - 127;
    int32_t first = exponent >> 1; /* rounded down */
    bits = (bits & 0x007fffff) | 0x3f800000;
    float t;
    memcpy(&t, &bits, sizeof t);
    t -= 1.0f;
    float mantissa_log2 = t + t * (1.0f - t) * (0.438726f + t * (-0.239058f + t * 0.082131f));
    float fraction = 0.5f * ((float)(exponent & 1) + mantissa_log2);
    if (first < (int32_t)p->first_level)
        return (level_pair){.first = p->first_level, .second = p->first_level};
    if (first + 1 >= (int32_t)p->level_count)
        return (level_pair){.first = p->level_count - 1, .second = p->level_count - 1};
    return (level_pair){.first = (uint32_t)first, .second = (uint32_t)first + 1, .fraction = fraction};
}

/* Where the pixel lands in the image. False: it has no finite size. */
INLINE bool get_footprint(const texture_pyramid *p, const float duv_dx[2], const float duv_dy[2],
                          Footprint *f)
{
    *f = footprint_from_derivatives(vec2((float)p->width, (float)p->height), vec2(duv_dx[0], duv_dx[1]),
                                    vec2(duv_dy[0], duv_dy[1]));
    return footprint_is_finite(*f);
}

INLINE ProbeRow place_probes(const texture_pyramid *p, const Footprint *f)
{
    return footprint_probes(*f, (float)(1u << p->first_level), vec2(p->texel_size[0], p->texel_size[1]));
}

#endif
