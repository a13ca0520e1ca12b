/* block_rgtc.c - BC4 and BC5: one or two channels of eight interpolated values per block (KDF, "RGTC
 * compressed texture image formats"). BC3 has its alpha like this. */
#include "image/block.h"

/* The values of unsigned blocks, to the nearest code. */
static void make_values(unsigned first, unsigned second, unsigned char values[8])
{
    values[0] = (unsigned char)first;
    values[1] = (unsigned char)second;
    if (first > second) {
        for (unsigned i = 1; i < 7; i++)
            values[i + 1] = (unsigned char)(((7 - i) * first + i * second + 3) / 7);
    } else {
        for (unsigned i = 1; i < 5; i++)
            values[i + 1] = (unsigned char)(((5 - i) * first + i * second + 2) / 5);
        values[6] = 0;
        values[7] = 255;
    }
}

void rgtc_decode_channel(const unsigned char block[8], unsigned char *channel)
{
    unsigned char values[8];
    make_values(block[0], block[1], values);
    uint64_t indices = load_u64_le(block) >> 16;
    for (int i = 0; i < TILE_TEXELS; i++, indices >>= 3)
        channel[4 * i] = values[indices & 7];
}

/* The same with ends in [-1, 1]; -128 and -127 both are -1, but compare as the numbers that they are. */
static void decode_signed_channel(const unsigned char block[8], float *channel)
{
    int first = (signed char)block[0] < -127 ? -127 : (signed char)block[0];
    int second = (signed char)block[1] < -127 ? -127 : (signed char)block[1];
    float values[8] = {(float)first / 127.0f, (float)second / 127.0f};
    if ((signed char)block[0] > (signed char)block[1]) {
        for (int i = 1; i < 7; i++)
            values[i + 1] = (float)((7 - i) * first + i * second) / (7.0f * 127.0f);
    } else {
        for (int i = 1; i < 5; i++)
            values[i + 1] = (float)((5 - i) * first + i * second) / (5.0f * 127.0f);
        values[6] = -1.0f;
        values[7] = 1.0f;
    }
    uint64_t indices = load_u64_le(block) >> 16;
    for (int i = 0; i < TILE_TEXELS; i++, indices >>= 3)
        channel[4 * i] = values[indices & 7];
}

static void clear_u8(unsigned char *texels)
{
    static const unsigned char black[4] = {0, 0, 0, 255};
    for (size_t i = 0; i < TILE_TEXELS; i++)
        memcpy(texels + 4 * i, black, 4);
}

static void clear_f32(float *texels)
{
    static const float black[4] = {0.0f, 0.0f, 0.0f, 1.0f};
    for (size_t i = 0; i < TILE_TEXELS; i++)
        memcpy(texels + 4 * i, black, sizeof black);
}

void bc4_decode(const unsigned char *block, void *tile)
{
    clear_u8(tile);
    rgtc_decode_channel(block, tile);
}

void bc4_signed_decode(const unsigned char *block, void *tile)
{
    clear_f32(tile);
    decode_signed_channel(block, tile);
}

void bc5_decode(const unsigned char *block, void *tile)
{
    clear_u8(tile);
    rgtc_decode_channel(block, tile);
    rgtc_decode_channel(block + 8, (unsigned char *)tile + 1);
}

void bc5_signed_decode(const unsigned char *block, void *tile)
{
    clear_f32(tile);
    decode_signed_channel(block, tile);
    decode_signed_channel(block + 8, (float *)tile + 1);
}
