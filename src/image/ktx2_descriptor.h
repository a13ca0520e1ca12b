/* ktx2_descriptor.h - what the texels of a KTX2 file are, as Khronos' Data Format Specification 1.3 (KDF) describes them:
 * one basic descriptor block (section 5). */
#ifndef IMAGE_KTX2_DESCRIPTOR_H
#define IMAGE_KTX2_DESCRIPTOR_H

#include "facet/facet.h"

size_t ktx2_descriptor_size(facet_texel_format format);
/* Linear, BT.709, alpha straight. */
void ktx2_put_descriptor(facet_texel_format format, unsigned char *out);

#endif
