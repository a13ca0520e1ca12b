/* block.h - block-compressed textures: the interface of the decoders and what they share. A decoder turns a
 * block into a tile of 4 x 4 texels of four channels each, RGBA, row-major, of the type that its comment
 * names. Channels that the format lacks are 0, alpha 1. Every bit pattern is valid, so decoding cannot fail.
 * Khronos Data Format Specification 1.4 (KDF), which has a chapter for each format. */
#ifndef IMAGE_BLOCK_H
#define IMAGE_BLOCK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

enum { TILE_EDGE = 4, TILE_TEXELS = 16, TILE_CHANNELS = 4 };

typedef void block_decode(const unsigned char *block, void *tile);

/* block_s3tc.c. S3TC: U8; bc1_rgb: the fourth color of the three-color mode is black, bc1_rgba: and
 * transparent */
block_decode bc1_rgb_decode, bc1_rgba_decode, bc2_decode, bc3_decode;
/* RGTC: U8, signed ones F32 */
block_decode bc4_decode, bc4_signed_decode, bc5_decode, bc5_signed_decode;
/* block_bptc.c. BC6H: F16; BC7: U8 */
block_decode bc6h_decode, bc6h_signed_decode, bc7_decode;
/* block_etc.c. ETC2: U8, ETC1 is part of it; EAC: U16, signed ones F32 */
block_decode etc2_rgb_decode, etc2_rgb_a1_decode, etc2_rgba_decode;
block_decode eac_r11_decode, eac_r11_signed_decode, eac_rg11_decode, eac_rg11_signed_decode;
/* basis_uastc.c: U8. srgb: for samplers that convert from sRGB afterwards */
block_decode uastc_decode, uastc_srgb_decode;

/* ---- what they share ---- */

static inline unsigned char clamp_u8(int x)
{
    return (unsigned char)(x < 0 ? 0 : x > 255 ? 255 : x);
}

static inline uint64_t load_u64_le(const unsigned char *p)
{
    uint64_t x = 0;
    for (int i = 7; i >= 0; i--)
        x = x << 8 | p[i];
    return x;
}

static inline uint64_t load_u64_be(const unsigned char *p)
{
    uint64_t x = 0;
    for (int i = 0; i < 8; i++)
        x = x << 8 | p[i];
    return x;
}

/* The 128 bits of a block, read from the lowest up. */
typedef struct block_bits {
    uint64_t low, high;
} block_bits;

static inline block_bits block_bits_load(const unsigned char block[16])
{
    return (block_bits){load_u64_le(block), load_u64_le(block + 8)};
}

/* The next count bits, 0 to 32. */
static inline uint32_t take_bits(block_bits *b, unsigned count)
{
    if (count == 0)
        return 0;
    uint32_t value = (uint32_t)(b->low & ((UINT64_C(1) << count) - 1));
    b->low = b->low >> count | b->high << (64 - count);
    b->high >>= count;
    return value;
}

/* Interpolation weights of BC6H and BC7, of 64, by an index of 2 and 3 bits (KDF 20.1); ASTC and UASTC
 * have the same. */
extern const unsigned char bptc_weights2[4], bptc_weights3[8];

#endif
