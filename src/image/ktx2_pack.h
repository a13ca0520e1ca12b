/* ktx2_pack.h - texels of floats as KTX2 files hold them: the formats of facet_texel_format, their sizes, their rounding.
 * The way back: ktx2_format.h. */
#ifndef IMAGE_KTX2_PACK_H
#define IMAGE_KTX2_PACK_H

#include "facet/facet.h"

/* What a format is, by Vulkan's specification ("Formats"). */
typedef struct ktx2_texel {
    uint32_t vk_format;
    uint32_t size; /* bytes of a texel */
    /* bytes of what is swapped on a machine of the other byte order: a number or a packed word */
    uint32_t type_size;
    uint32_t component_count; /* that are kept: R, RG, RGB or RGBA */
} ktx2_texel;

const ktx2_texel *ktx2_find_texel(facet_texel_format format);

/* Packs count texels of channel_count (1 to 4) floats each, behind one another. Channels that are missing are 0, alpha 1;
 * is_opaque: alpha is 1, whatever the texels say. Numbers are rounded to the nearest that the format has, ties to even;
 * what is beyond its largest becomes that (infinity too, where there are signs on both sides), NaN 0. */
void ktx2_pack(facet_texel_format format, const float *texels, uint32_t channel_count, size_t count,
               bool is_opaque, unsigned char *out);

#endif
