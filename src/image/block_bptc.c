/* block_bptc.c - BC6H and BC7 and the tables that they share (KDF, "BPTC compressed texture image formats"). */
#include "image/block.h"

const unsigned char bptc_weights2[4] = {0, 21, 43, 64};
const unsigned char bptc_weights3[8] = {0, 9, 18, 27, 37, 46, 55, 64};
static const unsigned char bptc_weights4[16] = {0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64};

/* The subset of a texel: of two, bit i for texel i; of three, bits 2 i and 2 i + 1 (KDF tables "partition
 * table for 2-subset" and "3-subset BPTC"). */
static const uint16_t bptc_partitions2[64] = {
    0xcccc, 0x8888, 0xeeee, 0xecc8, 0xc880, 0xfeec, 0xfec8, 0xec80, 0xc800, 0xffec, 0xfe80, 0xe800, 0xffe8,
    0xff00, 0xfff0, 0xf000, 0xf710, 0x008e, 0x7100, 0x08ce, 0x008c, 0x7310, 0x3100, 0x8cce, 0x088c, 0x3110,
    0x6666, 0x366c, 0x17e8, 0x0ff0, 0x718e, 0x399c, 0xaaaa, 0xf0f0, 0x5a5a, 0x33cc, 0x3c3c, 0x55aa, 0x9696,
    0xa55a, 0x73ce, 0x13c8, 0x324c, 0x3bdc, 0x6996, 0xc33c, 0x9966, 0x0660, 0x0272, 0x04e4, 0x4e40, 0x2720,
    0xc936, 0x936c, 0x39c6, 0x639c, 0x9336, 0x9cc6, 0x817e, 0xe718, 0xccf0, 0x0fcc, 0x7744, 0xee22};

static const uint32_t bptc_partitions3[64] = {
    0xaa685050, 0x6a5a5040, 0x5a5a4200, 0x5450a0a8, 0xa5a50000, 0xa0a05050, 0x5555a0a0, 0x5a5a5050,
    0xaa550000, 0xaa555500, 0xaaaa5500, 0x90909090, 0x94949494, 0xa4a4a4a4, 0xa9a59450, 0x2a0a4250,
    0xa5945040, 0x0a425054, 0xa5a5a500, 0x55a0a0a0, 0xa8a85454, 0x6a6a4040, 0xa4a45000, 0x1a1a0500,
    0x0050a4a4, 0xaaa59090, 0x14696914, 0x69691400, 0xa08585a0, 0xaa821414, 0x50a4a450, 0x6a5a0200,
    0xa9a58000, 0x5090a0a8, 0xa8a09050, 0x24242424, 0x00aa5500, 0x24924924, 0x24499224, 0x50a50a50,
    0x500aa550, 0xaaaa4444, 0x66660000, 0xa5a0a5a0, 0x50a050a0, 0x69286928, 0x44aaaa44, 0x66666600,
    0xaa444444, 0x54a854a8, 0x95809580, 0x96969600, 0xa85454a8, 0x80959580, 0xaa141414, 0x96960000,
    0xaaaa1414, 0xa05050a0, 0xa0a5a5a0, 0x96000000, 0x40804080, 0xa9a8a9a8, 0xaaaaaa44, 0x2a4a5254};

/* The texels, besides texel 0, whose index is stored without its highest bit, which is 0. */
static const unsigned char bptc_anchors2[64] = {
    15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 2,  8, 2, 2, 8,
    8,  15, 2,  8,  2,  2,  8,  8,  2,  2,  15, 15, 6,  8,  2,  8,  15, 15, 2, 8, 2, 2,
    2,  15, 15, 6,  6,  2,  6,  8,  15, 15, 2,  2,  15, 15, 15, 15, 15, 2,  2, 15};

static const unsigned char bptc_anchors3_second[64] = {
    3,  3,  15, 15, 8, 3,  15, 15, 8,  8,  6, 6,  6, 5,  3, 3,  3,  3,  8,  15, 3,  3,
    6,  10, 5,  8,  8, 6,  8,  5,  15, 15, 8, 15, 3, 5,  6, 10, 8,  15, 15, 3,  15, 5,
    15, 15, 15, 15, 3, 15, 5,  5,  5,  8,  5, 10, 5, 10, 8, 13, 15, 12, 3,  3};

static const unsigned char bptc_anchors3_third[64] = {
    15, 8, 8, 3,  15, 15, 3,  8,  15, 15, 15, 15, 15, 15, 15, 8,  15, 8,  15, 3,  15, 8,
    15, 8, 3, 15, 6,  10, 15, 15, 10, 8,  15, 3,  15, 10, 10, 8,  9,  10, 6,  15, 8,  15,
    3,  6, 6, 8,  15, 3,  15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 3,  15, 15, 8};

/* ---- BC6H ---- */

/* Targets of the bits of a block: channel of an end (end * 3 + channel), or the partition. */
enum { R0, G0, B0, R1, G1, B1, R2, G2, B2, R3, G3, B3, PB, VALUE_COUNT };

typedef struct field {
    unsigned char value, shift, count;
} field;

/* One of the 14 modes: bits of the first end, bits of the differences of the others (if not transformed, of
 * the ends themselves), and their layout in the block after the mode. */
typedef struct bc6h_mode {
    unsigned char code_bits, end_bits, delta_bits[3];
    bool is_transformed;
    unsigned char subset_count;
    field fields[26]; /* up to one of count 0 */
} bc6h_mode;

enum { MODE_COUNT = 14 };

/* In the order of the specification's table; their codes are 0, 1, 2, 6, 10, 14, 18, 22, 26, 30, 3, 7, 11,
 * 15. */
static const bc6h_mode bc6h_modes[MODE_COUNT] = {
    {2, 10, {5, 5, 5}, true, 2, {{G2, 4, 1},  {B2, 4, 1}, {B3, 4, 1}, {R0, 0, 10}, {G0, 0, 10},
                                 {B0, 0, 10}, {R1, 0, 5}, {G3, 4, 1}, {G2, 0, 4},  {G1, 0, 5},
                                 {B3, 0, 1},  {G3, 0, 4}, {B1, 0, 5}, {B3, 1, 1},  {B2, 0, 4},
                                 {R2, 0, 5},  {B3, 2, 1}, {R3, 0, 5}, {B3, 3, 1},  {PB, 0, 5}}},
    {2, 7, {6, 6, 6}, true, 2, {{G2, 5, 1}, {G3, 4, 2}, {R0, 0, 7}, {B3, 0, 2}, {B2, 4, 1}, {G0, 0, 7},
                                {B2, 5, 1}, {B3, 2, 1}, {G2, 4, 1}, {B0, 0, 7}, {B3, 3, 1}, {B3, 5, 1},
                                {B3, 4, 1}, {R1, 0, 6}, {G2, 0, 4}, {G1, 0, 6}, {G3, 0, 4}, {B1, 0, 6},
                                {B2, 0, 4}, {R2, 0, 6}, {R3, 0, 6}, {PB, 0, 5}}},
    {5,
     11,
     {5, 4, 4},
     true,
     2,
     {{R0, 0, 10},
      {G0, 0, 10},
      {B0, 0, 10},
      {R1, 0, 5},
      {R0, 10, 1},
      {G2, 0, 4},
      {G1, 0, 4},
      {G0, 10, 1},
      {B3, 0, 1},
      {G3, 0, 4},
      {B1, 0, 4},
      {B0, 10, 1},
      {B3, 1, 1},
      {B2, 0, 4},
      {R2, 0, 5},
      {B3, 2, 1},
      {R3, 0, 5},
      {B3, 3, 1},
      {PB, 0, 5}}},
    {5, 11, {4, 5, 4}, true, 2, {{R0, 0, 10}, {G0, 0, 10}, {B0, 0, 10}, {R1, 0, 4}, {R0, 10, 1}, {G3, 4, 1},
                                 {G2, 0, 4},  {G1, 0, 5},  {G0, 10, 1}, {G3, 0, 4}, {B1, 0, 4},  {B0, 10, 1},
                                 {B3, 1, 1},  {B2, 0, 4},  {R2, 0, 4},  {B3, 0, 1}, {B3, 2, 1},  {R3, 0, 4},
                                 {G2, 4, 1},  {B3, 3, 1},  {PB, 0, 5}}},
    {5, 11, {4, 4, 5}, true, 2, {{R0, 0, 10}, {G0, 0, 10}, {B0, 0, 10}, {R1, 0, 4},  {R0, 10, 1},
                                 {B2, 4, 1},  {G2, 0, 4},  {G1, 0, 4},  {G0, 10, 1}, {B3, 0, 1},
                                 {G3, 0, 4},  {B1, 0, 5},  {B0, 10, 1}, {B2, 0, 4},  {R2, 0, 4},
                                 {B3, 1, 2},  {R3, 0, 4},  {B3, 4, 1},  {B3, 3, 1},  {PB, 0, 5}}},
    {5, 9, {5, 5, 5}, true, 2, {{R0, 0, 9}, {B2, 4, 1}, {G0, 0, 9}, {G2, 4, 1}, {B0, 0, 9},
                                {B3, 4, 1}, {R1, 0, 5}, {G3, 4, 1}, {G2, 0, 4}, {G1, 0, 5},
                                {B3, 0, 1}, {G3, 0, 4}, {B1, 0, 5}, {B3, 1, 1}, {B2, 0, 4},
                                {R2, 0, 5}, {B3, 2, 1}, {R3, 0, 5}, {B3, 3, 1}, {PB, 0, 5}}},
    {5,
     8,
     {6, 5, 5},
     true,
     2,
     {{R0, 0, 8},
      {G3, 4, 1},
      {B2, 4, 1},
      {G0, 0, 8},
      {B3, 2, 1},
      {G2, 4, 1},
      {B0, 0, 8},
      {B3, 3, 2},
      {R1, 0, 6},
      {G2, 0, 4},
      {G1, 0, 5},
      {B3, 0, 1},
      {G3, 0, 4},
      {B1, 0, 5},
      {B3, 1, 1},
      {B2, 0, 4},
      {R2, 0, 6},
      {R3, 0, 6},
      {PB, 0, 5}}},
    {5, 8, {5, 6, 5}, true, 2, {{R0, 0, 8}, {B3, 0, 1}, {B2, 4, 1}, {G0, 0, 8}, {G2, 5, 1}, {G2, 4, 1},
                                {B0, 0, 8}, {G3, 5, 1}, {B3, 4, 1}, {R1, 0, 5}, {G3, 4, 1}, {G2, 0, 4},
                                {G1, 0, 6}, {G3, 0, 4}, {B1, 0, 5}, {B3, 1, 1}, {B2, 0, 4}, {R2, 0, 5},
                                {B3, 2, 1}, {R3, 0, 5}, {B3, 3, 1}, {PB, 0, 5}}},
    {5, 8, {5, 5, 6}, true, 2, {{R0, 0, 8}, {B3, 1, 1}, {B2, 4, 1}, {G0, 0, 8}, {B2, 5, 1}, {G2, 4, 1},
                                {B0, 0, 8}, {B3, 5, 1}, {B3, 4, 1}, {R1, 0, 5}, {G3, 4, 1}, {G2, 0, 4},
                                {G1, 0, 5}, {B3, 0, 1}, {G3, 0, 4}, {B1, 0, 6}, {B2, 0, 4}, {R2, 0, 5},
                                {B3, 2, 1}, {R3, 0, 5}, {B3, 3, 1}, {PB, 0, 5}}},
    {5, 6, {6, 6, 6}, false, 2, {{R0, 0, 6}, {G3, 4, 1}, {B3, 0, 2}, {B2, 4, 1}, {G0, 0, 6}, {G2, 5, 1},
                                 {B2, 5, 1}, {B3, 2, 1}, {G2, 4, 1}, {B0, 0, 6}, {G3, 5, 1}, {B3, 3, 1},
                                 {B3, 5, 1}, {B3, 4, 1}, {R1, 0, 6}, {G2, 0, 4}, {G1, 0, 6}, {G3, 0, 4},
                                 {B1, 0, 6}, {B2, 0, 4}, {R2, 0, 6}, {R3, 0, 6}, {PB, 0, 5}}},
    {5,
     10,
     {10, 10, 10},
     false,
     1,
     {{R0, 0, 10}, {G0, 0, 10}, {B0, 0, 10}, {R1, 0, 10}, {G1, 0, 10}, {B1, 0, 10}}},
    {5,
     11,
     {9, 9, 9},
     true,
     1,
     {{R0, 0, 10},
      {G0, 0, 10},
      {B0, 0, 10},
      {R1, 0, 9},
      {R0, 10, 1},
      {G1, 0, 9},
      {G0, 10, 1},
      {B1, 0, 9},
      {B0, 10, 1}}},
    {5,
     12,
     {8, 8, 8},
     true,
     1,
     {{R0, 0, 10},
      {G0, 0, 10},
      {B0, 0, 10},
      {R1, 0, 8},
      {R0, 11, 1},
      {R0, 10, 1},
      {G1, 0, 8},
      {G0, 11, 1},
      {G0, 10, 1},
      {B1, 0, 8},
      {B0, 11, 1},
      {B0, 10, 1}}},
    {5, 16, {4, 4, 4}, true, 1, {{R0, 0, 10}, {G0, 0, 10}, {B0, 0, 10}, {R1, 0, 4},  {R0, 15, 1},
                                 {R0, 14, 1}, {R0, 13, 1}, {R0, 12, 1}, {R0, 11, 1}, {R0, 10, 1},
                                 {G1, 0, 4},  {G0, 15, 1}, {G0, 14, 1}, {G0, 13, 1}, {G0, 12, 1},
                                 {G0, 11, 1}, {G0, 10, 1}, {B1, 0, 4},  {B0, 15, 1}, {B0, 14, 1},
                                 {B0, 13, 1}, {B0, 12, 1}, {B0, 11, 1}, {B0, 10, 1}}},
};

/* The mode of a block by its first five bits; -1: reserved. */
static int find_mode(unsigned code)
{
    static const signed char by_code[32] = {0, 1, 2, 10, 0, 1, 3, 11, 0, 1, 4, 12, 0, 1, 5, 13,
                                            0, 1, 6, -1, 0, 1, 7, -1, 0, 1, 8, -1, 0, 1, 9, -1};
    return by_code[code];
}

static int extend_sign(unsigned value, unsigned bits)
{
    unsigned sign = 1u << (bits - 1);
    return (int)((value & (2 * sign - 1)) ^ sign) - (int)sign;
}

/* Decodes all ends as numbers of end_bits bits. */
static void compute_ends(const bc6h_mode *m, bool is_signed, const unsigned values[VALUE_COUNT],
                         int ends[4][3])
{
    const unsigned mask = (1u << m->end_bits) - 1;
    for (int e = 0; e < 4; e++)
        for (int c = 0; c < 3; c++) {
            unsigned value = values[e * 3 + c];
            if (e > 0 && m->is_transformed)
                value = (values[c] + (unsigned)extend_sign(value, m->delta_bits[c])) & mask;
            ends[e][c] = is_signed ? extend_sign(value, m->end_bits) : (int)value;
        }
}

/* Unquantizes from end_bits to the 16 bits of interpolation. */
static int unquantize(int value, unsigned bits, bool is_signed)
{
    if (!is_signed) {
        if (bits >= 15 || value == 0)
            return value;
        return value == (1 << bits) - 1 ? 0xffff : ((value << 15) + 0x4000) >> (bits - 1);
    }
    int magnitude = value < 0 ? -value : value;
    if (bits >= 16 || magnitude == 0)
        return value;
    magnitude = magnitude >= (1 << (bits - 1)) - 1 ? 0x7fff : ((magnitude << 15) + 0x4000) >> (bits - 1);
    return value < 0 ? -magnitude : magnitude;
}

/* Converts 16 bits to a half, scaled so that the largest value is the largest finite half. */
static uint16_t finish(int value, bool is_signed)
{
    if (!is_signed)
        return (uint16_t)(value * 31 >> 6);
    return (uint16_t)(value < 0 ? 0x8000 | (-value * 31 >> 5) : value * 31 >> 5);
}

static void decode(const unsigned char *block, bool is_signed, uint16_t *texels)
{
    const int mode = find_mode(block[0] & 31);
    for (int i = 0; i < TILE_TEXELS; i++) {
        texels[4 * i] = texels[4 * i + 1] = texels[4 * i + 2] = 0;
        texels[4 * i + 3] = 0x3c00; /* 1 */
    }
    if (mode < 0)
        return;
    const bc6h_mode *m = &bc6h_modes[mode];
    block_bits b = block_bits_load(block);
    take_bits(&b, m->code_bits);
    unsigned values[VALUE_COUNT] = {0};
    for (size_t i = 0; i < sizeof m->fields / sizeof *m->fields && m->fields[i].count; i++)
        values[m->fields[i].value] |= take_bits(&b, m->fields[i].count) << m->fields[i].shift;
    int ends[4][3];
    compute_ends(m, is_signed, values, ends);
    for (int e = 0; e < 2 * m->subset_count; e++)
        for (int c = 0; c < 3; c++)
            ends[e][c] = unquantize(ends[e][c], m->end_bits, is_signed);

    const unsigned partition = values[PB];
    const bool is_split = m->subset_count == 2;
    const unsigned subsets = is_split ? bptc_partitions2[partition] : 0;
    const unsigned anchors = 1u | (is_split ? 1u << bptc_anchors2[partition] : 0u);
    const unsigned char *weights = is_split ? bptc_weights3 : bptc_weights4;
    for (unsigned i = 0; i < TILE_TEXELS; i++) {
        const unsigned bits = is_split ? 3 : 4;
        const int weight = weights[take_bits(&b, bits - (anchors >> i & 1))];
        int(*const end)[3] = ends + 2 * (subsets >> i & 1);
        for (int c = 0; c < 3; c++)
            texels[4 * i + (unsigned)c] =
                finish((end[0][c] * (64 - weight) + end[1][c] * weight + 32) >> 6, is_signed);
    }
}

void bc6h_decode(const unsigned char *block, void *tile)
{
    decode(block, false, tile);
}

void bc6h_signed_decode(const unsigned char *block, void *tile)
{
    decode(block, true, tile);
}

/* ---- BC7 ---- */

/* Bit counts of a mode, in the order of the block. */
typedef struct bc7_mode {
    unsigned char subset_count, partition, rotation, selection, color, alpha;
    unsigned char end_p, subset_p; /* low bits of a color, for each end or shared by both */
    unsigned char index, index2;   /* of a texel */
} bc7_mode;

static const bc7_mode bc7_modes[8] = {
    {3, 4, 0, 0, 4, 0, 1, 0, 3, 0}, {2, 6, 0, 0, 6, 0, 0, 1, 3, 0}, {3, 6, 0, 0, 5, 0, 0, 0, 2, 0},
    {2, 6, 0, 0, 7, 0, 1, 0, 2, 0}, {1, 0, 2, 1, 5, 6, 0, 0, 2, 3}, {1, 0, 2, 0, 7, 8, 0, 0, 2, 2},
    {1, 0, 0, 0, 7, 7, 1, 0, 4, 0}, {2, 6, 0, 0, 5, 5, 1, 0, 2, 0},
};

static const unsigned char *get_weights(unsigned bits)
{
    return bits == 2 ? bptc_weights2 : bits == 3 ? bptc_weights3 : bptc_weights4;
}

/* Extends a value of bits <= 8 to 8 bits by replication. */
static unsigned char widen(unsigned value, unsigned bits)
{
    value <<= 8 - bits;
    return (unsigned char)(value | value >> bits);
}

/* Colors of both ends of each subset. */
static void read_ends(block_bits *b, const bc7_mode *m, unsigned char ends[6][4])
{
    const unsigned count = 2u * m->subset_count;
    unsigned values[6][4];
    for (int c = 0; c < 4; c++)
        for (unsigned e = 0; e < count; e++)
            values[e][c] = take_bits(b, c < 3 ? m->color : m->alpha);
    unsigned low[6] = {0};
    for (unsigned e = 0; m->end_p && e < count; e++)
        low[e] = take_bits(b, 1);
    for (unsigned s = 0; m->subset_p && s < m->subset_count; s++)
        low[2 * s] = low[2 * s + 1] = take_bits(b, 1);
    const unsigned p = m->end_p | m->subset_p;
    for (unsigned e = 0; e < count; e++) {
        for (int c = 0; c < 3; c++)
            ends[e][c] = widen(values[e][c] << p | (p ? low[e] : 0), m->color + p);
        ends[e][3] = m->alpha ? widen(values[e][3] << p | (p ? low[e] : 0), m->alpha + p) : 255;
    }
}

static void read_indices(block_bits *b, unsigned bits, uint32_t anchors, unsigned char indices[TILE_TEXELS])
{
    for (unsigned i = 0; i < TILE_TEXELS; i++)
        indices[i] = (unsigned char)take_bits(b, bits - (anchors >> i & 1));
}

static unsigned char mix(unsigned a, unsigned b, unsigned weight)
{
    return (unsigned char)(((64 - weight) * a + weight * b + 32) >> 6);
}

static void swap_channels(unsigned char *texel, unsigned rotation)
{
    unsigned char alpha = texel[3];
    texel[3] = texel[rotation - 1];
    texel[rotation - 1] = alpha;
}

/* Subset of each texel, two bits each; *anchors: the texels whose index lacks a bit. */
static uint32_t get_subsets(unsigned subset_count, unsigned partition, uint32_t *anchors)
{
    *anchors = 1;
    if (subset_count == 1)
        return 0;
    if (subset_count == 3) {
        *anchors |= 1u << bptc_anchors3_second[partition] | 1u << bptc_anchors3_third[partition];
        return bptc_partitions3[partition];
    }
    *anchors |= 1u << bptc_anchors2[partition];
    uint32_t subsets = 0;
    for (unsigned i = 0; i < TILE_TEXELS; i++)
        subsets |= (bptc_partitions2[partition] >> i & 1u) << 2 * i;
    return subsets;
}

void bc7_decode(const unsigned char *block, void *tile)
{
    unsigned char *texels = tile;
    if (block[0] == 0) { /* reserved */
        memset(texels, 0, (size_t)4 * TILE_TEXELS);
        return;
    }
    const unsigned mode = (unsigned)__builtin_ctz(block[0]);
    const bc7_mode *m = &bc7_modes[mode];
    block_bits b = block_bits_load(block);
    take_bits(&b, mode + 1);
    const unsigned partition = take_bits(&b, m->partition);
    const unsigned rotation = take_bits(&b, m->rotation);
    const bool is_swapped = take_bits(&b, m->selection) != 0;
    unsigned char ends[6][4];
    read_ends(&b, m, ends);

    uint32_t anchors;
    uint32_t subsets = get_subsets(m->subset_count, partition, &anchors);
    unsigned char first[TILE_TEXELS], second[TILE_TEXELS];
    read_indices(&b, m->index, anchors, first);
    if (m->index2)
        read_indices(&b, m->index2, anchors, second);
    const unsigned char *color_indices = is_swapped ? second : first;
    const unsigned char *alpha_indices = m->index2 && !is_swapped ? second : first;
    const unsigned char *color_weights = get_weights(is_swapped ? m->index2 : m->index);
    const unsigned char *alpha_weights = get_weights(m->index2 && !is_swapped ? m->index2 : m->index);
    for (int i = 0; i < TILE_TEXELS; i++, texels += 4, subsets >>= 2) {
        unsigned char(*const end)[4] = ends + 2 * (subsets & 3);
        for (int c = 0; c < 3; c++)
            texels[c] = mix(end[0][c], end[1][c], color_weights[color_indices[i]]);
        texels[3] = mix(end[0][3], end[1][3], alpha_weights[alpha_indices[i]]);
        if (rotation)
            swap_channels(texels, rotation);
    }
}
