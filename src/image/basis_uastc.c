/* basis_uastc.c - blocks of UASTC LDR 4 x 4, a subset of ASTC in another packing (Binomial, "UASTC LDR 4x4
 * Texture Specification", 2020, placed in the public domain; modes, patterns and bit layout are from
 * there; numbers become colors as in KDF, "ASTC compressed texture image formats"). Hints for other
 * formats are skipped. */
#include "image/block.h"

enum { MODE_SOLID = 8, MODE_RESERVED = 19, MAX_ENDS = 18 };

/* A mode; ranges are below. */
typedef struct uastc_mode {
    unsigned char code_bits, hint_bits;
    unsigned char range, weight_bits;
    unsigned char subset_count, plane_count, channel_count; /* 2 channels: luminance and alpha */
    unsigned char pattern_bits;
} uastc_mode;

/* Encoding of end values of a range: whole bits below a trit, a quint, or neither. */
typedef struct uastc_range {
    unsigned char bits, base; /* base: 3, 5 or 1 */
} uastc_range;

enum { Q12, Q16, Q32, Q40, Q48, Q160, Q192, Q256 };
static const uastc_range ranges[] = {[Q12] = {2, 3}, [Q16] = {4, 1},  [Q32] = {5, 1},  [Q40] = {3, 5},
                                     [Q48] = {4, 3}, [Q160] = {5, 5}, [Q192] = {6, 3}, [Q256] = {8, 1}};

static const uastc_mode modes[20] = {
    {4, 15, Q192, 4, 1, 1, 3, 0}, {6, 15, Q256, 2, 1, 1, 3, 0}, {5, 15, Q16, 3, 2, 1, 3, 5},
    {5, 15, Q12, 2, 3, 1, 3, 4},  {5, 15, Q40, 2, 2, 1, 3, 5},  {5, 15, Q256, 3, 1, 1, 3, 0},
    {5, 15, Q160, 2, 1, 2, 3, 0}, {5, 15, Q40, 2, 2, 1, 3, 5},  {5, 0, Q256, 0, 1, 1, 4, 0},
    {5, 23, Q16, 2, 2, 1, 4, 5},  {3, 17, Q48, 4, 1, 1, 4, 0},  {2, 17, Q48, 2, 1, 2, 4, 0},
    {3, 17, Q192, 3, 1, 1, 4, 0}, {5, 23, Q256, 1, 1, 2, 4, 0}, {5, 23, Q256, 2, 1, 1, 4, 0},
    {7, 23, Q256, 4, 1, 1, 2, 0}, {6, 23, Q256, 2, 2, 1, 2, 5}, {6, 23, Q256, 2, 1, 2, 2, 0},
    {4, 15, Q32, 5, 1, 1, 3, 0},  {0, 0, 0, 0, 0, 0, 0, 0},
};

/* Mode by the lowest seven bits of a block, of which its code is a prefix. */
static const unsigned char mode_by_code[128] = {
    11, 0,  10, 3, 11, 15, 12, 7,  11, 18, 10, 5,  11, 14, 12, 9,  11, 0,  10, 4,  11, 16, 12, 8,  11, 18,
    10, 6,  11, 2, 12, 13, 11, 0,  10, 3,  11, 17, 12, 7,  11, 18, 10, 5,  11, 14, 12, 9,  11, 0,  10, 4,
    11, 1,  12, 8, 11, 18, 10, 6,  11, 2,  12, 13, 11, 0,  10, 3,  11, 19, 12, 7,  11, 18, 10, 5,  11, 14,
    12, 9,  11, 0, 10, 4,  11, 16, 12, 8,  11, 18, 10, 6,  11, 2,  12, 13, 11, 0,  10, 3,  11, 17, 12, 7,
    11, 18, 10, 5, 11, 14, 12, 9,  11, 0,  10, 4,  11, 1,  12, 8,  11, 18, 10, 6,  11, 2,  12, 13};

/* Subset of each texel, two bits each, texel 0 lowest. patterns2 are common to ASTC and BC7, patterns3 are
 * those of three subsets, patterns2_of_3 (mode 7) are two subsets of ASTC that merge two of BC7's three. */
static const uint32_t patterns2[30] = {
    0x50505050, 0x40404040, 0x01010101, 0x54505040, 0x05151555, 0x55545450, 0x00010515, 0x01051555,
    0x50400000, 0x00000105, 0x55544000, 0x01155555, 0x00000115, 0x00005555, 0x55555500, 0x00555555,
    0x55551501, 0x40545555, 0x00405054, 0x00004050, 0x15050100, 0x50545555, 0x15050501, 0x00404050,
    0x50545455, 0x14141414, 0x55000055, 0x11111111, 0x00550055, 0x05145041};
static const uint32_t patterns3[11] = {0xa5a50000, 0xaa005555, 0xaa000055, 0x0000aa55, 0x25252525, 0x94949494,
                                       0x58585858, 0x56560202, 0x92929292, 0x55aa0055, 0xa05050a0};
static const uint32_t patterns2_of_3[19] = {0x00005500, 0x10101010, 0x00010505, 0x50504000, 0x55005555,
                                            0x04040404, 0x55555040, 0x50505054, 0x05500005, 0x00005454,
                                            0x15150000, 0x05000005, 0x00005054, 0x55554000, 0x14555555,
                                            0x01050505, 0x01015555, 0x01051450, 0x00005455};

/* False: the pattern does not exist. */
static bool get_pattern(unsigned mode, unsigned number, uint32_t *subsets)
{
    *subsets = 0;
    if (modes[mode].subset_count == 1)
        return true;
    const uint32_t *patterns = mode == 3 ? patterns3 : mode == 7 ? patterns2_of_3 : patterns2;
    const unsigned count = mode == 3 ? 11 : mode == 7 ? 19 : 30;
    *subsets = number < count ? patterns[number] : 0;
    return number < count;
}

/* Anchor texels, whose weight lacks its highest bit: the first of each subset. */
static uint32_t get_anchors(uint32_t subsets, unsigned subset_count)
{
    uint32_t anchors = 0;
    for (unsigned s = 0; s < subset_count; s++) {
        uint32_t other = subsets ^ s * 0x55555555u;
        uint32_t is_in = ~(other | other >> 1) & 0x55555555u; /* bit 2 i for texel i */
        anchors |= 1u << (unsigned)__builtin_ctz(is_in) / 2;  /* every subset of a pattern has texels */
    }
    return anchors;
}

/* Spreads bits as in the patterns of the specification, such as "dcb000dcb". */
static unsigned spread_bits(unsigned value, unsigned base, unsigned bits)
{
    const unsigned x = value >> 1; /* without the lowest bit */
    if (base == 3)
        switch (bits) {
        case 1:
            return 0;
        case 2: /* b000b0bb0 */
            return x << 8 | x << 4 | x << 2 | x << 1;
        case 3: /* cb000cbcb */
            return x << 7 | x << 2 | x;
        case 4: /* dcb000dcb */
            return x << 6 | x;
        case 5: /* edcb000ed */
            return x << 5 | x >> 2;
        default: /* fedcb000f */
            return x << 4 | x >> 4;
        }
    switch (bits) {
    case 1:
        return 0;
    case 2: /* b0000bb00 */
        return x << 8 | x << 3 | x << 2;
    case 3: /* cb0000cbc */
        return x << 7 | x << 1 | x >> 1;
    case 4: /* dcb0000dc */
        return x << 6 | x >> 1;
    default: /* edcb0000e */
        return x << 5 | x >> 3;
    }
}

/* Unquantizes bits and a trit or quint to 8 bits (KDF, "ASTC endpoint unquantization"). */
static unsigned unquantize(unsigned value, unsigned digit, const uastc_range *r)
{
    static const unsigned char factors3[7] = {0, 204, 93, 44, 22, 11, 5};
    static const unsigned char factors5[6] = {0, 113, 54, 26, 13, 6};
    if (r->base == 1) {
        unsigned wide = value << (8 - r->bits);
        return wide | wide >> r->bits;
    }
    const unsigned mask = value & 1 ? 0x1ff : 0;
    const unsigned factor = r->base == 3 ? factors3[r->bits] : factors5[r->bits];
    const unsigned t = (digit * factor + spread_bits(value, r->base, r->bits)) ^ mask;
    return (mask & 0x80) | t >> 2;
}

/* Trits (5 in 8 bits) or quints (3 in 7) of all values come first, then their bits. */
static void read_ends(block_bits *b, const uastc_range *r, unsigned count, unsigned char ends[MAX_ENDS])
{
    static const unsigned char trit_bits[6] = {0, 2, 4, 5, 7, 8}, quint_bits[4] = {0, 3, 5, 7};
    unsigned char digits[MAX_ENDS] = {0};
    const unsigned group = r->base == 3 ? 5 : 3;
    for (unsigned i = 0; r->base > 1 && i < count; i += group) {
        const unsigned n = count - i < group ? count - i : group;
        unsigned packed = take_bits(b, r->base == 3 ? trit_bits[n] : quint_bits[n]);
        for (unsigned k = 0; k < n; k++, packed /= r->base)
            digits[i + k] = (unsigned char)(packed % r->base);
    }
    for (unsigned i = 0; i < count; i++)
        ends[i] = (unsigned char)unquantize(take_bits(b, r->bits), digits[i], r);
}

/* Unquantizes a weight to [0, 64]. */
static unsigned get_weight(unsigned index, unsigned bits)
{
    switch (bits) {
    case 1:
        return index * 64;
    case 2:
        return bptc_weights2[index];
    case 3:
        return bptc_weights3[index];
    default: { /* repeated to 6 bits; the upper half is one more */
        unsigned weight = bits == 4 ? index << 2 | index >> 2 : index << 1 | index >> 4;
        return weight + (weight > 32);
    }
    }
}

static unsigned char mix(unsigned a, unsigned b, unsigned weight, bool is_srgb)
{
    a = a << 8 | (is_srgb ? 0x80 : a);
    b = b << 8 | (is_srgb ? 0x80 : b);
    return (unsigned char)((a * (64 - weight) + b * weight + 32) >> 14);
}

/* Colors of the weights of a subset. ends: low and high of each channel. */
static void make_palette(const unsigned char *ends, const uastc_mode *m, bool is_srgb,
                         unsigned char palette[32][4])
{
    for (unsigned i = 0; i < 1u << m->weight_bits; i++) {
        const unsigned weight = get_weight(i, m->weight_bits);
        unsigned char *color = palette[i];
        for (unsigned c = 0; c < 3 && c < m->channel_count; c++)
            color[c] = mix(ends[2 * c], ends[2 * c + 1], weight, is_srgb);
        color[3] = 255;
        if (m->channel_count == 4)
            color[3] = mix(ends[6], ends[7], weight, false);
        if (m->channel_count == 2) {
            color[3] = mix(ends[2], ends[3], weight, false);
            color[1] = color[2] = color[0];
        }
    }
}

static void fill(unsigned char *texels, const unsigned char color[4])
{
    for (size_t i = 0; i < TILE_TEXELS; i++)
        memcpy(texels + 4 * i, color, 4);
}

static void decode(const unsigned char *block, bool is_srgb, unsigned char *texels)
{
    static const unsigned char magenta[4] = {255, 0, 255, 255}; /* the error color of ASTC */
    const unsigned mode = mode_by_code[block[0] & 127];
    const uastc_mode *m = &modes[mode];
    block_bits b = block_bits_load(block);
    take_bits(&b, m->code_bits);
    if (mode == MODE_SOLID) {
        unsigned char color[4];
        for (int c = 0; c < 4; c++)
            color[c] = (unsigned char)take_bits(&b, 8);
        fill(texels, color);
        return;
    }
    take_bits(&b, m->hint_bits);
    uint32_t subsets;
    if (mode == MODE_RESERVED || !get_pattern(mode, take_bits(&b, m->pattern_bits), &subsets)) {
        fill(texels, magenta);
        return;
    }
    unsigned second_plane = 4; /* none */
    if (m->plane_count == 2)
        second_plane = m->channel_count == 2 ? 3 : take_bits(&b, 2);
    unsigned char ends[MAX_ENDS];
    const unsigned ends_per_subset = 2u * m->channel_count;
    read_ends(&b, &ranges[m->range], ends_per_subset * m->subset_count, ends);
    unsigned char palettes[3][32][4];
    for (unsigned s = 0; s < m->subset_count; s++)
        make_palette(ends + (size_t)s * ends_per_subset, m, is_srgb, palettes[s]);
    const uint32_t anchors = get_anchors(subsets, m->subset_count);
    for (unsigned i = 0; i < TILE_TEXELS; i++, texels += 4, subsets >>= 2) {
        const unsigned bits = m->weight_bits - (anchors >> i & 1);
        memcpy(texels, palettes[subsets & 3][take_bits(&b, bits)], 4);
        if (second_plane < 4)
            texels[second_plane] = palettes[0][take_bits(&b, bits)][second_plane];
    }
}

void uastc_decode(const unsigned char *block, void *tile)
{
    decode(block, false, tile);
}

void uastc_srgb_decode(const unsigned char *block, void *tile)
{
    decode(block, true, tile);
}
