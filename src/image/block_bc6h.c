/* block_bc6h.c - BC6H: colors of half floats, on one or two lines per block (KDF, "BC6H"). */
#include "image/block.h"

/* Where bits of a block go: channel of an end (end * 3 + channel), or the partition. */
enum { R0, G0, B0, R1, G1, B1, R2, G2, B2, R3, G3, B3, PB, VALUE_COUNT };

typedef struct field {
    unsigned char value, shift, count;
} field;

/* One of the 14 modes: bits of the first end, bits of the differences that the others are stored as (or, not
 * transformed, of themselves), and how they lie in the block behind the mode. */
typedef struct bc6h_mode {
    unsigned char code_bits, end_bits, delta_bits[3];
    bool is_transformed;
    unsigned char subset_count;
    field fields[26]; /* up to one of count 0 */
} bc6h_mode;

enum { MODE_COUNT = 14 };

/* In the order of the specification's table of modes; their codes are 0, 1, 2, 6, 10, 14, 18, 22, 26, 30, 3, 7, 11,
 * 15. */
static const bc6h_mode modes[MODE_COUNT] = {
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

/* All ends as numbers of end_bits bits. */
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

/* From end_bits to the 16 bits in which ends are interpolated. */
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

/* From 16 bits to the half float: scaled such that the largest is the largest finite one. */
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
    const bc6h_mode *m = &modes[mode];
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
