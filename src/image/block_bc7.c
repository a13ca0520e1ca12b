/* block_bc7.c - BC7: eight modes of one to three subsets of a block, each a line between two colors (KDF, "BC7").
 */
#include "image/block.h"

/* Bits that a mode spends, in the order of the block. */
typedef struct bc7_mode {
    unsigned char subset_count, partition, rotation, selection, color, alpha;
    unsigned char end_p, subset_p; /* low bits of a color, for each end or shared by both */
    unsigned char index, index2;   /* of a texel */
} bc7_mode;

static const bc7_mode modes[8] = {
    {3, 4, 0, 0, 4, 0, 1, 0, 3, 0}, {2, 6, 0, 0, 6, 0, 0, 1, 3, 0}, {3, 6, 0, 0, 5, 0, 0, 0, 2, 0},
    {2, 6, 0, 0, 7, 0, 1, 0, 2, 0}, {1, 0, 2, 1, 5, 6, 0, 0, 2, 3}, {1, 0, 2, 0, 7, 8, 0, 0, 2, 2},
    {1, 0, 0, 0, 7, 7, 1, 0, 4, 0}, {2, 6, 0, 0, 5, 5, 1, 0, 2, 0},
};

static const unsigned char *get_weights(unsigned bits)
{
    return bits == 2 ? bptc_weights2 : bits == 3 ? bptc_weights3 : bptc_weights4;
}

/* A value of that many bits, at most 8, repeated downwards to fill 8. */
static unsigned char widen(unsigned value, unsigned bits)
{
    value <<= 8 - bits;
    return (unsigned char)(value | value >> bits);
}

/* The colors at both ends of each subset. */
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

/* The subset of each texel, two bits each; *anchors: the texels that lack a bit. */
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
    const bc7_mode *m = &modes[mode];
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
