/* exr_huffman.c - the Huffman coding of 16-bit numbers inside OpenEXR's PIZ and DWA.
 *
 * A block begins with five numbers of 32 bits: least and greatest symbol that has a code, size of the code
 * table, bits of the data, and an unused one. The table gives the length of each symbol's code in 6 bits,
 * runs of symbols without code in 6 or 14. Codes are canonical: among those of one length ordered by
 * symbol, and long codes before short ones. The greatest symbol stands for a run: 8 bits follow, so often
 * the last number comes again. Bits are taken from the high end of each byte. */
#include "image/codec.h"
#include "image/exr.h"

#include <string.h>

#include "base/memory.h"

enum {
    SYMBOLS = 65537, /* the numbers, and the run symbol above them */
    HEADER_SIZE = 20,
    MAX_LENGTH =
        57, /* of a code, what a refilled bit_reader holds; the 58 of the format take 10^12 samples */
    FAST_BITS = 13,
    ZEROS_2 = 59, /* in place of a length: 2 to 5 symbols without code .. */
    ZEROS_6 = 63  /* .. 6 and more, as 8 bits say */
};

typedef struct bit_reader {
    const unsigned char *bytes;
    size_t next, size; /* next counts on behind the end, where all bits are 0 */
    uint64_t bits;     /* those not yet taken, at the high end; below them zeros */
    uint32_t count;    /* of bits, in [0, 64] */
} bit_reader;

/* At least 57 bits afterwards. */
static void refill(bit_reader *r)
{
    while (r->count <= 56) {
        uint64_t byte = r->next < r->size ? r->bytes[r->next] : 0;
        r->next++;
        r->bits |= byte << (56 - r->count);
        r->count += 8;
    }
}

static uint32_t take_bits(bit_reader *r,
                          uint32_t count) /* 1 to 32 of the at least that many that are there */
{
    uint32_t value = (uint32_t)(r->bits >> (64 - count));
    r->bits <<= count;
    r->count -= count;
    return value;
}

static uint64_t taken_bits(const bit_reader *r)
{
    return (uint64_t)r->next * 8 - r->count;
}

typedef struct huffman {
    uint32_t counts[MAX_LENGTH + 1]; /* codes of each length */
    uint64_t first[MAX_LENGTH + 1];  /* the least code of each length */
    uint32_t start[MAX_LENGTH + 1];  /* where its symbols begin in sorted */
    uint32_t longest;
    uint32_t run_symbol;
    uint32_t fast[1 << FAST_BITS]; /* symbol << 8 | length by the next bits; 0: a longer code, or none */
    uint8_t lengths[SYMBOLS];
    uint32_t sorted[SYMBOLS]; /* symbols by length of code, then by number */
} huffman;

/* Lengths from the packed table; *size is that of all, then of the table. False: damaged. */
static bool read_lengths(huffman *h, const unsigned char *packed, size_t *size, uint32_t least,
                         uint32_t greatest)
{
    bit_reader r = {.bytes = packed, .size = *size};
    for (uint32_t symbol = least; symbol <= greatest;) {
        refill(&r);
        uint32_t length = take_bits(&r, 6);
        if (length >= ZEROS_2) {
            uint32_t zeros = length == ZEROS_6 ? take_bits(&r, 8) + 6 : length - ZEROS_2 + 2;
            if (zeros > greatest + 1 - symbol)
                return false;
            symbol += zeros;
        } else {
            if (length > MAX_LENGTH)
                return false;
            h->lengths[symbol++] = (uint8_t)length;
        }
    }
    bool is_whole = taken_bits(&r) <= (uint64_t)*size * 8;
    *size = (size_t)((taken_bits(&r) + 7) / 8);
    return is_whole;
}

/* False: more codes than there can be. */
static bool build_codes(huffman *h, uint32_t least, uint32_t greatest)
{
    for (uint32_t symbol = least; symbol <= greatest; symbol++)
        h->counts[h->lengths[symbol]]++;
    h->counts[0] = 0;
    uint64_t code = 0;
    uint32_t next[MAX_LENGTH + 1];
    for (uint32_t length = MAX_LENGTH; length > 0; length--) {
        h->first[length] = code;
        if (code + h->counts[length] > (uint64_t)1 << length)
            return false;
        code = (code + h->counts[length]) >> 1;
        if (h->counts[length] && !h->longest)
            h->longest = length;
    }
    for (uint32_t length = 1, start = 0; length <= MAX_LENGTH; length++) {
        h->start[length] = next[length] = start;
        start += h->counts[length];
    }
    for (uint32_t symbol = least; symbol <= greatest; symbol++) {
        uint32_t length = h->lengths[symbol];
        if (length == 0)
            continue;
        uint32_t rank = next[length]++;
        h->sorted[rank] = symbol;
        if (length > FAST_BITS)
            continue;
        uint64_t value = h->first[length] + (rank - h->start[length]);
        uint32_t *entry = h->fast + (value << (FAST_BITS - length));
        for (uint32_t k = 0; k < 1u << (FAST_BITS - length); k++)
            entry[k] = symbol << 8 | length;
    }
    return true;
}

/* The next symbol; SYMBOLS: no code matches. Codes of a length are the greatest prefixes of that length. */
static uint32_t read_symbol(const huffman *h, bit_reader *r)
{
    uint32_t entry = h->fast[r->bits >> (64 - FAST_BITS)];
    if (entry) {
        take_bits(r, entry & 0xff);
        return entry >> 8;
    }
    for (uint32_t length = FAST_BITS + 1; length <= h->longest; length++) {
        uint64_t code = r->bits >> (64 - length);
        if (code < h->first[length] || code - h->first[length] >= h->counts[length])
            continue;
        r->bits <<= length;
        r->count -= length;
        return h->sorted[h->start[length] + (uint32_t)(code - h->first[length])];
    }
    return SYMBOLS;
}

static facet_result decode(const huffman *h, bit_reader *r, uint64_t bit_count, uint16_t *out, size_t count)
{
    size_t at = 0;
    while (at < count) {
        refill(r);
        uint32_t symbol = read_symbol(h, r);
        if (symbol == h->run_symbol) {
            refill(r);
            size_t run = take_bits(r, 8);
            if (at == 0 || run > count - at)
                return FACET_ERROR_INVALID;
            for (size_t k = 0; k < run; k++, at++)
                out[at] = out[at - 1];
        } else if (symbol < SYMBOLS - 1) {
            out[at++] = (uint16_t)symbol;
        } else {
            return FACET_ERROR_INVALID;
        }
        if (r->next > r->size && taken_bits(r) > bit_count)
            return FACET_ERROR_INVALID;
    }
    return taken_bits(r) <= bit_count ? FACET_OK : FACET_ERROR_INVALID;
}

facet_result exr_huffman_decode(const facet_allocator *allocator, const unsigned char *packed,
                                size_t packed_size, uint16_t *out, size_t count)
{
    if (count == 0)
        return FACET_OK;
    if (packed_size < HEADER_SIZE)
        return FACET_ERROR_INVALID;
    const uint32_t least = load_u32_le(packed);
    const uint32_t greatest = load_u32_le(packed + 4);
    const uint64_t bit_count = load_u32_le(packed + 12);
    if (least > greatest || greatest >= SYMBOLS)
        return FACET_ERROR_INVALID;
    huffman *h = mem_zalloc(allocator, 1, sizeof *h);
    if (!h)
        return FACET_ERROR_MEMORY;
    h->run_symbol = greatest;
    facet_result result = FACET_ERROR_INVALID;
    const size_t data_size = (size_t)((bit_count + 7) / 8);
    size_t table_size = packed_size - HEADER_SIZE;
    if (read_lengths(h, packed + HEADER_SIZE, &table_size, least, greatest) &&
        build_codes(h, least, greatest) && data_size <= packed_size - HEADER_SIZE - table_size) {
        bit_reader r = {.bytes = packed + HEADER_SIZE + table_size, .size = data_size};
        result = decode(h, &r, bit_count, out, count);
    }
    mem_free(h);
    return result;
}
