/* ktx2_texels.h - texels without compression. See texel_unpack. */
#ifndef IMAGE_KTX2_TEXELS_H
#define IMAGE_KTX2_TEXELS_H

#include "image/ktx2_format.h"

/* 8 bits to U8, signed to F32; bgr: blue comes first */
texel_unpack unpack_u8, unpack_u8_bgr, unpack_s8;
/* 16 bits to U16, F32, F16; 32-bit floats to F32 */
texel_unpack unpack_u16, unpack_s16, unpack_f16, unpack_f32;
/* Packed in words: RGB9E5 and B10G11R11 to F16, which holds their values exactly; A2B10G10R10 and A2R10G10B10 to U16 */
texel_unpack unpack_e5b9g9r9, unpack_b10g11r11, unpack_a2b10g10r10, unpack_a2r10g10b10;

/* unpack as it is but for what is not finite, which stays. */
texel_unpack *unpack_nonfinite(texel_unpack *unpack);

#endif
