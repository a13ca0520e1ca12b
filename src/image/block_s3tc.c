/* block_s3tc.c - BC1 to BC3, once DXT1 to DXT5 (KDF, "S3TC compressed texture image formats"), BC4 and BC5
 * ("RGTC"). The specification interpolates real numbers; results are rounded to the nearest code. */
#include "image/block.h"
#include "image/codec.h"

/* ---- RGTC ---- */

/* Values of unsigned blocks, rounded to the nearest code. */
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

static void rgtc_decode_channel(const unsigned char block[8], unsigned char *channel)
{
    unsigned char values[8];
    make_values(block[0], block[1], values);
    uint64_t indices = load_u64_le(block) >> 16;
    for (int i = 0; i < TILE_TEXELS; i++, indices >>= 3)
        channel[4 * i] = values[indices & 7];
}

/* Values of signed blocks, with ends in [-1, 1]; -128 and -127 are both -1 but are compared as integers. */
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

/* ---- S3TC ---- */

static void unpack_565(unsigned code, unsigned char rgba[4])
{
    unsigned r = code >> 11, g = code >> 5 & 63, b = code & 31;
    rgba[0] = (unsigned char)(r << 3 | r >> 2);
    rgba[1] = (unsigned char)(g << 2 | g >> 4);
    rgba[2] = (unsigned char)(b << 3 | b >> 2);
    rgba[3] = 255;
}

/* The four colors of a block. If the format has a three-color mode (has_three), a first code not above the
 * second selects three colors and black. */
static void make_colors(const unsigned char block[8], bool has_three, unsigned char fourth_alpha,
                        unsigned char colors[4][4])
{
    unsigned first = block[0] | (unsigned)block[1] << 8;
    unsigned second = block[2] | (unsigned)block[3] << 8;
    unpack_565(first, colors[0]);
    unpack_565(second, colors[1]);
    colors[2][3] = colors[3][3] = 255;
    for (int c = 0; c < 3; c++) {
        unsigned a = colors[0][c], b = colors[1][c];
        if (has_three && first <= second) {
            colors[2][c] = (unsigned char)((a + b + 1) / 2);
            colors[3][c] = 0;
            colors[3][3] = fourth_alpha;
        } else {
            colors[2][c] = (unsigned char)((2 * a + b + 1) / 3);
            colors[3][c] = (unsigned char)((a + 2 * b + 1) / 3);
        }
    }
}

static void decode_colors(const unsigned char block[8], bool has_three, unsigned char fourth_alpha,
                          unsigned char *tile)
{
    unsigned char colors[4][4];
    make_colors(block, has_three, fourth_alpha, colors);
    uint32_t indices = load_u32_le(block + 4);
    for (int i = 0; i < TILE_TEXELS; i++, indices >>= 2)
        memcpy(tile + (size_t)4 * (size_t)i, colors[indices & 3], 4);
}

void bc1_rgb_decode(const unsigned char *block, void *tile)
{
    decode_colors(block, true, 255, tile);
}

void bc1_rgba_decode(const unsigned char *block, void *tile)
{
    decode_colors(block, true, 0, tile);
}

/* Alpha of four bits per texel, then colors. */
void bc2_decode(const unsigned char *block, void *tile)
{
    decode_colors(block + 8, false, 255, tile);
    uint64_t alphas = load_u64_le(block);
    unsigned char *texels = tile;
    for (int i = 0; i < TILE_TEXELS; i++, alphas >>= 4)
        texels[4 * i + 3] = (unsigned char)((alphas & 15) * 17);
}

/* Alpha as in BC4, then colors. */
void bc3_decode(const unsigned char *block, void *tile)
{
    decode_colors(block + 8, false, 255, tile);
    rgtc_decode_channel(block, (unsigned char *)tile + 3);
}
