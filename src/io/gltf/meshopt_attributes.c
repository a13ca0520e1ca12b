/* meshopt_attributes.c - mode ATTRIBUTES, versions 0 and 1: elements of 4 to 256 bytes as deltas between
 * neighbors, byte by byte ("planes"), in blocks of at most 256 elements, each plane in groups of 16 bytes
 * that are packed to 0, 1, 2, 4 or 8 bits.
 *
 * Whole words serve as vectors of bytes ("SWAR": Lamport, "Multiple byte processing with full-word
 * instructions", 1975), so that the code is the same for every machine. */
#include <string.h>

#include "io/gltf/meshopt.h"

enum {
    BLOCK_BYTES = 8192,
    MAX_BLOCK = 256, /* elements */
    GROUP = 16,
    GROUP_ROOM =
        24 /* the maximal size of a group in bytes; that many bytes are readable wherever a group may begin */
};

typedef struct layout {
    bool is_v1;
    size_t tail;  /* bytes: padding, the element before the first, the modes of the channels */
    size_t block; /* elements of every block but the last */
} layout;

static layout make_layout(bool is_v1, size_t stride)
{
    size_t needed = is_v1 ? stride + stride / 4 : stride;
    size_t least = is_v1 ? 24 : 32;
    size_t fitting = BLOCK_BYTES / stride & ~(size_t)(GROUP - 1);
    return (layout){.is_v1 = is_v1,
                    .tail = needed > least ? needed : least,
                    .block = fitting < MAX_BLOCK ? fitting : MAX_BLOCK};
}

/* The minimal size of a block. Version 1: a control byte for 4 planes; version 0: 2 bits for each group of
 * each plane. */
static size_t block_size(const layout *l, size_t count, size_t stride)
{
    const size_t groups = (count + GROUP - 1) / GROUP;
    return count == 0 ? 0 : l->is_v1 ? stride / 4 : stride * ((groups + 3) / 4);
}

static size_t smallest_attributes(const meshopt_stream *s)
{
    const layout l = make_layout(s->size == 0 || s->bytes[0] != 0xa0, s->stride);
    const size_t whole = s->count / l.block;
    const size_t size = block_size(&l, l.block, s->stride);
    if (whole > (SIZE_MAX >> 1) / size)
        return SIZE_MAX;
    return 1 + whole * size + block_size(&l, s->count % l.block, s->stride) + l.tail;
}

size_t meshopt_smallest_size(const meshopt_stream *s)
{
    if (s->mode == MESHOPT_ATTRIBUTES)
        return smallest_attributes(s);
    if (s->count > SIZE_MAX >> 8)
        return SIZE_MAX;
    return s->mode == MESHOPT_TRIANGLES ? 1 + s->count / 3 + 16 : 1 + s->count + 4;
}

/* ---- words ---- */

static uint32_t load_u32(const uint8_t *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static void store_u32(uint8_t *p, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        p[i] = (uint8_t)(value >> (8 * i));
}

static uint32_t load_u32_big(const uint8_t *p)
{
    return (uint32_t)p[3] | (uint32_t)p[2] << 8 | (uint32_t)p[1] << 16 | (uint32_t)p[0] << 24;
}

static void store_u64_big(uint8_t *p, uint64_t value)
{
    for (int i = 0; i < 8; i++)
        p[i] = (uint8_t)(value >> (56 - 8 * i));
}

/* ---- groups: 16 bytes that are packed ---- */

/* Expands 8 fields of 2 or 4 bits, the first one highest, to 8 bytes. */
static uint64_t spread_2(uint32_t fields)
{
    uint64_t x = fields;
    x = (x | x << 24) & UINT64_C(0x000000ff000000ff);
    x = (x | x << 12) & UINT64_C(0x000f000f000f000f);
    return (x | x << 6) & UINT64_C(0x0303030303030303);
}

static uint64_t spread_4(uint32_t fields)
{
    uint64_t x = fields;
    x = (x | x << 16) & UINT64_C(0x0000ffff0000ffff);
    x = (x | x << 8) & UINT64_C(0x00ff00ff00ff00ff);
    return (x | x << 4) & UINT64_C(0x0f0f0f0f0f0f0f0f);
}

/* Each decodes one group to out[16] and returns the position behind it. A field of all ones ("sentinel")
 * means that the value is a byte behind the fields, in the same order. */

static const uint8_t *unpack_1(const uint8_t *in, uint8_t *out)
{
    uint32_t sentinels = (uint32_t)in[0] | (uint32_t)in[1] << 8;
    in += 2;
    memset(out, 0, GROUP);
    for (; sentinels; sentinels &= sentinels - 1)
        out[__builtin_ctz(sentinels)] = *in++;
    return in;
}

static const uint8_t *unpack_2(const uint8_t *in, uint8_t *out)
{
    uint32_t fields = load_u32_big(in);
    in += 4;
    store_u64_big(out, spread_2(fields >> 16));
    store_u64_big(out + 8, spread_2(fields & 0xffff));
    uint32_t sentinels = fields & fields >> 1 & 0x55555555;
    while (sentinels) {
        int place = __builtin_clz(sentinels);
        out[place / 2] = *in++;
        sentinels &= ~(UINT32_C(0x80000000) >> place);
    }
    return in;
}

static const uint8_t *unpack_4(const uint8_t *in, uint8_t *out)
{
    uint32_t first = load_u32_big(in);
    uint32_t second = load_u32_big(in + 4);
    in += 8;
    store_u64_big(out, spread_4(first));
    store_u64_big(out + 8, spread_4(second));
    uint64_t sentinels = (uint64_t)first << 32 | second;
    sentinels &= sentinels >> 1;
    sentinels &= sentinels >> 2 & UINT64_C(0x1111111111111111);
    while (sentinels) {
        int place = __builtin_clzll(sentinels);
        out[place / 4] = *in++;
        sentinels &= ~(UINT64_C(1) << 63 >> place);
    }
    return in;
}

static const uint8_t *unpack_group(unsigned bits, const uint8_t *in, uint8_t *out)
{
    switch (bits) {
    case 0:
        memset(out, 0, GROUP);
        return in;
    case 1:
        return unpack_1(in, out);
    case 2:
        return unpack_2(in, out);
    case 4:
        return unpack_4(in, out);
    default:
        memcpy(out, in, GROUP);
        return in + GROUP;
    }
}

/* ---- planes: one byte of each element of a block ---- */

/* A plane of groups; end: where the tail begins. NULL: the plane exceeds it. */
static const uint8_t *decode_groups(const uint8_t *in, const uint8_t *end, const uint8_t bits[4],
                                    size_t group_count, uint8_t *plane)
{
    const uint8_t *modes = in;
    size_t modes_size = (group_count + 3) / 4;
    if ((size_t)(end - in) < modes_size)
        return NULL;
    in += modes_size;
    for (size_t g = 0; g < group_count; g++) {
        if (in > end)
            return NULL;
        in = unpack_group(bits[modes[g / 4] >> (g % 4 * 2) & 3], in, plane + g * GROUP);
    }
    return in > end ? NULL : in;
}

/* A plane in one of the control modes of version 1; 4: the mode of version 0. */
static const uint8_t *decode_plane(unsigned control, const uint8_t *in, const uint8_t *end, size_t count,
                                   uint8_t *plane)
{
    static const uint8_t group_bits[5][4] = {{0, 1, 2, 4}, {1, 2, 4, 8}, {0}, {0}, {0, 2, 4, 8}};
    if (control == 2) {
        memset(plane, 0, count);
        return in;
    }
    if (control == 3) {
        if ((size_t)(end - in) < count)
            return NULL;
        memcpy(plane, in, count);
        return in + count;
    }
    return decode_groups(in, end, group_bits[control], (count + GROUP - 1) / GROUP, plane);
}

/* ---- channels: four planes to the words of the elements ---- */

typedef uint8_t planes_of_channel[4][MAX_BLOCK];

/* Zigzag: even codes are 0, 1, 2 .., odd ones -1, -2 .., in each byte or half of a word. */
static uint32_t unzigzag_bytes(uint32_t v)
{
    return (v >> 1 & 0x7f7f7f7f) ^ (v & 0x01010101) * 0xff;
}

static uint32_t unzigzag_halves(uint32_t v)
{
    return (v >> 1 & 0x7fff7fff) ^ (v & 0x00010001) * 0xffff;
}

/* Sums in lanes whose highest bits are those of high, without carries between them. */
static inline uint32_t add_lanes(uint32_t a, uint32_t b, uint32_t high)
{
    return ((a & ~high) + (b & ~high)) ^ ((a ^ b) & high);
}

static uint32_t rotate_right(uint32_t v, unsigned by)
{
    return v >> by | v << ((32 - by) & 31);
}

/* Undoes the deltas of one channel: *last is its word in the element before the block, and becomes that of
 * the last element. mode: its byte in the tail. out: the word of the block's first element. */
static void decode_channel(planes_of_channel planes, unsigned mode, size_t count, size_t stride,
                           uint32_t *last, uint8_t *out)
{
    uint32_t deltas[MAX_BLOCK];
    uint32_t value = *last;
    for (size_t i = 0; i < count; i++)
        deltas[i] = (uint32_t)planes[0][i] | (uint32_t)planes[1][i] << 8 | (uint32_t)planes[2][i] << 16 |
                    (uint32_t)planes[3][i] << 24;
    if (mode == 0) {
        for (size_t i = 0; i < count; i++)
            deltas[i] = unzigzag_bytes(deltas[i]);
        for (size_t i = 0; i < count; i++)
            store_u32(out + i * stride, value = add_lanes(value, deltas[i], 0x80808080));
    } else if (mode == 1) {
        for (size_t i = 0; i < count; i++)
            deltas[i] = unzigzag_halves(deltas[i]);
        for (size_t i = 0; i < count; i++)
            store_u32(out + i * stride, value = add_lanes(value, deltas[i], 0x80008000));
    } else {
        for (size_t i = 0; i < count; i++)
            deltas[i] = rotate_right(deltas[i], mode >> 4);
        for (size_t i = 0; i < count; i++)
            store_u32(out + i * stride, value ^= deltas[i]);
    }
    *last = value;
}

/* ---- the stream ---- */

static bool are_channel_modes(const uint8_t *modes, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (modes[i] > 1 && (modes[i] & 15) != 2)
            return false;
    return true;
}

/* Decodes one block of count elements; returns the position behind it. */
static const uint8_t *decode_block(const layout *l, const uint8_t *in, const uint8_t *end,
                                   const uint8_t *channel_modes, size_t count, size_t stride, uint32_t *last,
                                   uint8_t *out)
{
    planes_of_channel planes;
    const uint8_t *controls = in;
    if (l->is_v1) {
        if ((size_t)(end - in) < stride / 4)
            return NULL;
        in += stride / 4;
    }
    for (size_t c = 0; c < stride / 4; c++) {
        for (unsigned k = 0; k < 4 && in; k++)
            in = decode_plane(l->is_v1 ? (unsigned)controls[c] >> 2 * k & 3 : 4, in, end, count, planes[k]);
        if (!in)
            return NULL;
        decode_channel(planes, l->is_v1 ? channel_modes[c] : 0, count, stride, &last[c], out + 4 * c);
    }
    return in;
}

const char *meshopt_decode_attributes(const meshopt_stream *s, uint8_t *out)
{
    if (s->size == 0 || (s->bytes[0] != 0xa0 && s->bytes[0] != 0xa1))
        return MESHOPT_NO_HEADER;
    if (s->size < smallest_attributes(s))
        return MESHOPT_TOO_SHORT;
    const layout l = make_layout(s->bytes[0] == 0xa1, s->stride);
    const uint8_t *end = s->bytes + s->size - l.tail;
    const uint8_t *channel_modes = s->bytes + s->size - s->stride / 4; /* version 1 */
    const uint8_t *first = s->bytes + s->size - s->stride - (l.is_v1 ? s->stride / 4 : 0);
    if (l.is_v1 && !are_channel_modes(channel_modes, s->stride / 4))
        return "has an unknown channel mode";
    uint32_t last[64];
    for (size_t c = 0; c < s->stride / 4; c++)
        last[c] = load_u32(first + 4 * c);
    const uint8_t *in = s->bytes + 1;
    for (size_t i = 0; i < s->count; i += l.block) {
        size_t count = s->count - i < l.block ? s->count - i : l.block;
        in = decode_block(&l, in, end, channel_modes, count, s->stride, last, out + i * s->stride);
        if (!in)
            return MESHOPT_TOO_SHORT;
    }
    return in == end ? NULL : MESHOPT_TOO_LONG;
}
