/* ktx2_pack.h - packing of float texels for KTX2 files: the formats of facet_texel_format, their sizes,
 * rounding. ktx2_format.h unpacks. */
#ifndef IMAGE_KTX2_PACK_H
#define IMAGE_KTX2_PACK_H

#include "facet/facet.h"

/* Properties of a format, from the Vulkan specification ("Formats"). */
typedef struct ktx2_texel {
    uint32_t vk_format;
    uint32_t size; /* bytes of a texel */
    /* unit of byte swapping: a number or a packed word */
    uint32_t type_size;
    uint32_t component_count; /* stored components: R, RG, RGB or RGBA */
} ktx2_texel;

const ktx2_texel *ktx2_find_texel(facet_texel_format format);

/* Packs count texels of channel_count (1 to 4) floats each. Missing channels are 0, alpha 1; is_opaque: alpha
 * is 1 in any case. Numbers are rounded to nearest, ties to even; those beyond the largest of the format
 * become that (infinity too in signed formats), NaN 0. */
void ktx2_pack(facet_texel_format format, const float *texels, uint32_t channel_count, size_t count,
               bool is_opaque, unsigned char *out);

#endif
