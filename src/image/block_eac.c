/* block_eac.c - EAC: one channel of a block as a base and 16 scaled offsets, of 8 bits for the alpha of ETC2, of
 * 11 bits for one and two channels (KDF, "ETC2 compressed texture image formats"). */
#include "image/block.h"

static const signed char modifiers[16][8] = {
    {-3, -6, -9, -15, 2, 5, 8, 14}, {-3, -7, -10, -13, 2, 6, 9, 12}, {-2, -5, -8, -13, 1, 4, 7, 12},
    {-2, -4, -6, -13, 1, 3, 5, 12}, {-3, -6, -8, -12, 2, 5, 7, 11},  {-3, -7, -9, -11, 2, 6, 8, 10},
    {-4, -7, -8, -11, 3, 6, 7, 10}, {-3, -5, -8, -11, 2, 4, 7, 10},  {-2, -6, -8, -10, 1, 5, 7, 9},
    {-2, -5, -8, -10, 1, 4, 7, 9},  {-2, -4, -8, -10, 1, 3, 7, 9},   {-2, -5, -7, -10, 1, 4, 6, 9},
    {-3, -4, -7, -10, 2, 3, 6, 9},  {-1, -2, -3, -10, 0, 1, 2, 9},   {-4, -6, -8, -9, 3, 5, 7, 8},
    {-3, -5, -7, -9, 2, 4, 6, 8}};

/* The offset of a texel, numbered x * 4 + y; the first has the highest bits. */
static int get_modifier(uint64_t block, int texel)
{
    return modifiers[block >> 48 & 15][block >> (45 - 3 * texel) & 7];
}

/* Where a texel stands in a tile, in texels. */
static size_t get_place(int texel)
{
    return (size_t)(texel % 4 * 4 + texel / 4);
}

void eac_decode_alpha(const unsigned char bytes[8], unsigned char *channel)
{
    const uint64_t block = load_u64_be(bytes);
    const int base = bytes[0], multiplier = bytes[1] >> 4;
    for (int i = 0; i < TILE_TEXELS; i++)
        channel[4 * get_place(i)] = clamp_u8(base + get_modifier(block, i) * multiplier);
}

/* In [0, 2047]; here, and only here, a multiplier of 0 stands for 1/8. */
static int decode_unsigned(uint64_t block, int texel)
{
    const int base = (int)(block >> 56) * 8 + 4, multiplier = (int)(block >> 52 & 15);
    const int value = base + get_modifier(block, texel) * (multiplier ? multiplier * 8 : 1);
    return value < 0 ? 0 : value > 2047 ? 2047 : value;
}

/* In [-1023, 1023]. */
static int decode_signed(uint64_t block, int texel)
{
    int base = (int)((block >> 56) ^ 128) - 128;
    const int multiplier = (int)(block >> 52 & 15);
    if (base == -128)
        base = -127;
    const int value = base * 8 + get_modifier(block, texel) * (multiplier ? multiplier * 8 : 1);
    return value < -1023 ? -1023 : value > 1023 ? 1023 : value;
}

static void decode_u16(const unsigned char *bytes, unsigned channel_count, uint16_t *texels)
{
    for (size_t i = 0; i < TILE_TEXELS; i++) {
        texels[4 * i + 1] = texels[4 * i + 2] = 0;
        texels[4 * i + 3] = 65535;
    }
    for (unsigned c = 0; c < channel_count; c++) {
        const uint64_t block = load_u64_be(bytes + 8 * (size_t)c);
        for (int i = 0; i < TILE_TEXELS; i++) {
            int value = decode_unsigned(block, i);
            texels[4 * get_place(i) + c] = (uint16_t)(value << 5 | value >> 6);
        }
    }
}

static void decode_f32(const unsigned char *bytes, unsigned channel_count, float *texels)
{
    for (size_t i = 0; i < TILE_TEXELS; i++) {
        texels[4 * i + 1] = texels[4 * i + 2] = 0.0f;
        texels[4 * i + 3] = 1.0f;
    }
    for (unsigned c = 0; c < channel_count; c++) {
        const uint64_t block = load_u64_be(bytes + 8 * (size_t)c);
        for (int i = 0; i < TILE_TEXELS; i++)
            texels[4 * get_place(i) + c] = (float)decode_signed(block, i) / 1023.0f;
    }
}

void eac_r11_decode(const unsigned char *block, void *tile)
{
    decode_u16(block, 1, tile);
}

void eac_r11_signed_decode(const unsigned char *block, void *tile)
{
    decode_f32(block, 1, tile);
}

void eac_rg11_decode(const unsigned char *block, void *tile)
{
    decode_u16(block, 2, tile);
}

void eac_rg11_signed_decode(const unsigned char *block, void *tile)
{
    decode_f32(block, 2, tile);
}
