/* block_s3tc.c - BC1, BC2 and BC3, once DXT1 to DXT5 (KDF, "S3TC compressed texture image formats"). The
 * specification interpolates in real numbers; here the result is the nearest code. */
#include "image/block.h"

#include "image/codec.h"

static void unpack_565(unsigned code, unsigned char rgba[4])
{
    unsigned r = code >> 11, g = code >> 5 & 63, b = code & 31;
    rgba[0] = (unsigned char)(r << 3 | r >> 2);
    rgba[1] = (unsigned char)(g << 2 | g >> 4);
    rgba[2] = (unsigned char)(b << 3 | b >> 2);
    rgba[3] = 255;
}

/* The four colors of a block. A first code not above the second means three colors and black, where the format
 * has that (has_three). */
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
