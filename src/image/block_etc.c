/* block_etc.c - ETC2 with and without alpha, of which ETC1 is a part, and EAC (KDF, "ETC2 compressed texture
 * image formats"). Bits are numbered as there: 63 is the first of byte 0. Texels are column-major: number x *
 * 4 + y. */
#include "image/block.h"

/* ---- EAC ---- */

static const signed char eac_modifiers[16][8] = {
    {-3, -6, -9, -15, 2, 5, 8, 14}, {-3, -7, -10, -13, 2, 6, 9, 12}, {-2, -5, -8, -13, 1, 4, 7, 12},
    {-2, -4, -6, -13, 1, 3, 5, 12}, {-3, -6, -8, -12, 2, 5, 7, 11},  {-3, -7, -9, -11, 2, 6, 8, 10},
    {-4, -7, -8, -11, 3, 6, 7, 10}, {-3, -5, -8, -11, 2, 4, 7, 10},  {-2, -6, -8, -10, 1, 5, 7, 9},
    {-2, -5, -8, -10, 1, 4, 7, 9},  {-2, -4, -8, -10, 1, 3, 7, 9},   {-2, -5, -7, -10, 1, 4, 6, 9},
    {-3, -4, -7, -10, 2, 3, 6, 9},  {-1, -2, -3, -10, 0, 1, 2, 9},   {-4, -6, -8, -9, 3, 5, 7, 8},
    {-3, -5, -7, -9, 2, 4, 6, 8}};

/* The offset of a texel, numbered x * 4 + y; the first has the highest bits. */
static int get_modifier(uint64_t block, int texel)
{
    return eac_modifiers[block >> 48 & 15][block >> (45 - 3 * texel) & 7];
}

/* Position of a texel in a tile, in texels. */
static size_t get_place(int texel)
{
    return (size_t)(texel % 4 * 4 + texel / 4);
}

static void eac_decode_alpha(const unsigned char bytes[8], unsigned char *channel)
{
    const uint64_t block = load_u64_be(bytes);
    const int base = bytes[0], multiplier = bytes[1] >> 4;
    for (int i = 0; i < TILE_TEXELS; i++)
        channel[4 * get_place(i)] = clamp_u8(base + get_modifier(block, i) * multiplier);
}

/* In [0, 2047]; only here does a multiplier of 0 mean 1/8. */
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

/* ---- ETC1 and ETC2 ---- */

static const int16_t etc1_modifiers[8][4] = {{2, 8, -2, -8},       {5, 17, -5, -17},    {9, 29, -9, -29},
                                             {13, 42, -13, -42},   {18, 60, -18, -60},  {24, 80, -24, -80},
                                             {33, 106, -33, -106}, {47, 183, -47, -183}}; /* by index bits */
static const unsigned char distances[8] = {3, 6, 11, 16, 23, 32, 41, 64};

/* count bits from bit low on. */
static int get_bits(uint64_t block, unsigned low, unsigned count)
{
    return (int)(block >> low & ((UINT64_C(1) << count) - 1));
}

static int extend4(int x)
{
    return x << 4 | x;
}
static int extend5(int x)
{
    return x << 3 | x >> 2;
}
static int extend6(int x)
{
    return x << 2 | x >> 4;
}
static int extend7(int x)
{
    return x << 1 | x >> 6;
}

static void set_color(unsigned char color[4], const int base[3], int offset)
{
    for (int c = 0; c < 3; c++)
        color[c] = clamp_u8(base[c] + offset);
    color[3] = 255;
}

/* Index of a texel; its high bit is 16 above its low bit. */
static int get_index(uint64_t block, int texel)
{
    return (int)(block >> (texel + 15) & 2) | (int)(block >> texel & 1);
}

/* T and H modes: each texel has one of four colors. */
static void paint(uint64_t block, unsigned char colors[4][4], unsigned char *tile)
{
    for (int i = 0; i < TILE_TEXELS; i++)
        memcpy(tile + (i % 4 * 4 + i / 4) * 4, colors[get_index(block, i)], 4);
}

/* Individual and differential modes: two halves, each with a color and modifiers of its brightness.
 * is_punched: the block has transparent texels (punch-through alpha). */
static void decode_halves(uint64_t block, int base[2][3], bool is_punched, unsigned char *tile)
{
    const bool is_flipped = get_bits(block, 32, 1) != 0;
    unsigned char colors[2][4][4];
    for (int half = 0; half < 2; half++) {
        const int16_t *m = etc1_modifiers[get_bits(block, half ? 34 : 37, 3)];
        for (int i = 0; i < 4; i++)
            set_color(colors[half][i], base[half], is_punched && i % 2 == 0 ? 0 : m[i]);
        if (is_punched)
            memset(colors[half][2], 0, 4);
    }
    for (int i = 0; i < TILE_TEXELS; i++) {
        int x = i / 4, y = i % 4;
        int half = is_flipped ? y / 2 : x / 2;
        memcpy(tile + (y * 4 + x) * 4, colors[half][get_index(block, i)], 4);
    }
}

static void decode_t(uint64_t block, bool is_punched, unsigned char *tile)
{
    const int first[3] = {extend4(get_bits(block, 59, 2) << 2 | get_bits(block, 56, 2)),
                          extend4(get_bits(block, 52, 4)), extend4(get_bits(block, 48, 4))};
    const int second[3] = {extend4(get_bits(block, 44, 4)), extend4(get_bits(block, 40, 4)),
                           extend4(get_bits(block, 36, 4))};
    const int distance = distances[get_bits(block, 34, 2) << 1 | get_bits(block, 32, 1)];
    unsigned char colors[4][4];
    set_color(colors[0], first, 0);
    set_color(colors[1], second, distance);
    set_color(colors[2], second, 0);
    set_color(colors[3], second, -distance);
    if (is_punched)
        memset(colors[2], 0, 4);
    paint(block, colors, tile);
}

static void decode_h(uint64_t block, bool is_punched, unsigned char *tile)
{
    const int first[3] = {extend4(get_bits(block, 59, 4)),
                          extend4(get_bits(block, 56, 3) << 1 | get_bits(block, 52, 1)),
                          extend4(get_bits(block, 51, 1) << 3 | get_bits(block, 47, 3))};
    const int second[3] = {extend4(get_bits(block, 43, 4)), extend4(get_bits(block, 39, 4)),
                           extend4(get_bits(block, 35, 4))};
    const bool is_larger =
        (first[0] << 16 | first[1] << 8 | first[2]) >= (second[0] << 16 | second[1] << 8 | second[2]);
    const int distance = distances[get_bits(block, 34, 1) << 2 | get_bits(block, 32, 1) << 1 | is_larger];
    unsigned char colors[4][4];
    set_color(colors[0], first, distance);
    set_color(colors[1], first, -distance);
    set_color(colors[2], second, distance);
    set_color(colors[3], second, -distance);
    if (is_punched)
        memset(colors[2], 0, 4);
    paint(block, colors, tile);
}

/* Planar mode: a plane through the colors at texels (0, 0), (4, 0) and (0, 4). */
static void decode_planar(uint64_t block, unsigned char *tile)
{
    const int origin[3] = {
        extend6(get_bits(block, 57, 6)), extend7(get_bits(block, 56, 1) << 6 | get_bits(block, 49, 6)),
        extend6(get_bits(block, 48, 1) << 5 | get_bits(block, 43, 2) << 3 | get_bits(block, 39, 3))};
    const int right[3] = {extend6(get_bits(block, 34, 5) << 1 | get_bits(block, 32, 1)),
                          extend7(get_bits(block, 25, 7)), extend6(get_bits(block, 19, 6))};
    const int down[3] = {extend6(get_bits(block, 13, 6)), extend7(get_bits(block, 6, 7)),
                         extend6(get_bits(block, 0, 6))};
    for (int y = 0; y < 4; y++)
        for (int x = 0; x < 4; x++, tile += 4) {
            for (int c = 0; c < 3; c++)
                tile[c] = clamp_u8(
                    (x * (right[c] - origin[c]) + y * (down[c] - origin[c]) + 4 * origin[c] + 2) >> 2);
            tile[3] = 255;
        }
}

/* has_punch: bit 33 selects punch-through alpha instead of one of ETC1's two modes. */
static void decode(uint64_t block, bool has_punch, unsigned char *tile)
{
    const bool bit33 = get_bits(block, 33, 1) != 0;
    const bool is_punched = has_punch && !bit33;
    int base[2][3];
    if (!has_punch && !bit33) {
        for (int c = 0; c < 3; c++) {
            base[0][c] = extend4(get_bits(block, 60 - 8u * (unsigned)c, 4));
            base[1][c] = extend4(get_bits(block, 56 - 8u * (unsigned)c, 4));
        }
        decode_halves(block, base, false, tile);
        return;
    }
    bool is_outside[3];
    for (int c = 0; c < 3; c++) {
        int first = get_bits(block, 59 - 8u * (unsigned)c, 5);
        int second = first + (get_bits(block, 56 - 8u * (unsigned)c, 3) ^ 4) - 4;
        is_outside[c] = second < 0 || second > 31;
        base[0][c] = extend5(first);
        base[1][c] = extend5(second & 31);
    }
    if (is_outside[0])
        decode_t(block, is_punched, tile);
    else if (is_outside[1])
        decode_h(block, is_punched, tile);
    else if (is_outside[2])
        decode_planar(block, tile);
    else
        decode_halves(block, base, is_punched, tile);
}

void etc2_rgb_decode(const unsigned char *block, void *tile)
{
    decode(load_u64_be(block), false, tile);
}

void etc2_rgb_a1_decode(const unsigned char *block, void *tile)
{
    decode(load_u64_be(block), true, tile);
}

void etc2_rgba_decode(const unsigned char *block, void *tile)
{
    decode(load_u64_be(block + 8), false, tile);
    eac_decode_alpha(block, (unsigned char *)tile + 3);
}
