/* basis_huffman.c - bits, variable-length numbers and Huffman codes of BasisLZ streams; see basis_etc1s.h.
 * Codes are those of Deflate (RFC 1951, section 3.2.2). */
#include "image/basis_etc1s.h"

#include <string.h>

/* ---- bits ---- */

bit_reader bits_open(const unsigned char *bytes, size_t size)
{
    return (bit_reader){.next = bytes, .end = bytes + size};
}

/* At least 32 bits, zeros past the end. */
static void refill(bit_reader *b)
{
    while (b->count <= 56 && b->next < b->end) {
        b->bits |= (uint64_t)*b->next++ << b->count;
        b->count += 8;
    }
}

static void drop(bit_reader *b, unsigned count)
{
    if (count > b->count) {
        b->is_past_end = true;
        b->bits = 0;
        b->count = 0;
        return;
    }
    b->bits >>= count;
    b->count -= count;
}

uint32_t bits_read(bit_reader *b, unsigned count)
{
    if (b->count < count)
        refill(b);
    uint32_t value = (uint32_t)(b->bits & ((UINT64_C(1) << count) - 1));
    drop(b, count);
    return value;
}

uint32_t bits_read_vlc(bit_reader *b, unsigned group_bits)
{
    uint32_t value = 0;
    for (unsigned shift = 0; shift < 32; shift += group_bits) {
        uint32_t group = bits_read(b, group_bits + 1);
        value |= (group & ((1u << group_bits) - 1)) << shift;
        if (!(group >> group_bits))
            break;
    }
    return value;
}

/* ---- codes ---- */

static uint32_t reverse_bits(uint32_t code, unsigned length)
{
    uint32_t reversed = 0;
    for (unsigned i = 0; i < length; i++)
        reversed |= (code >> i & 1) << (length - 1 - i);
    return reversed;
}

/* Canonical codes from their lengths. False: the code is oversubscribed or incomplete (a single code is
 * allowed). */
static bool build(huffman *h, const unsigned char *lengths, uint32_t count)
{
    memset(h->counts, 0, sizeof h->counts);
    memset(h->lengths, 0, sizeof h->lengths);
    h->symbol_count = 0;
    h->is_damaged = false;
    for (uint32_t i = 0; i < count; i++)
        h->counts[lengths[i]]++;
    h->counts[0] = 0;
    uint32_t starts[HUFFMAN_MAX_LENGTH + 2] = {0}, codes[HUFFMAN_MAX_LENGTH + 1] = {0};
    uint32_t code = 0, used = 0;
    for (unsigned length = 1; length <= HUFFMAN_MAX_LENGTH; length++) {
        codes[length] = code;
        code = (code + h->counts[length]) << 1;
        used += (uint32_t)h->counts[length] << (HUFFMAN_MAX_LENGTH - length);
        starts[length + 1] = starts[length] + h->counts[length];
    }
    h->symbol_count = starts[HUFFMAN_MAX_LENGTH + 1];
    if (used > 1u << HUFFMAN_MAX_LENGTH || (used < 1u << HUFFMAN_MAX_LENGTH && h->symbol_count > 1))
        return false;
    for (uint32_t i = 0; i < count; i++) {
        const unsigned length = lengths[i];
        if (length == 0)
            continue;
        h->symbols[starts[length]++] = (uint16_t)i;
        uint32_t reversed = reverse_bits(codes[length]++, length);
        if (length > HUFFMAN_FAST_BITS)
            continue;
        for (uint32_t k = reversed; k < 1u << HUFFMAN_FAST_BITS; k += 1u << length) {
            h->fast[k] = (uint16_t)i;
            h->lengths[k] = (unsigned char)length;
        }
    }
    return true;
}

/* Decodes bit by bit by the number of codes of each length. */
static uint32_t read_slowly(bit_reader *b, huffman *h)
{
    int32_t code = 0, first = 0, index = 0;
    for (unsigned length = 1; length <= HUFFMAN_MAX_LENGTH; length++) {
        code |= (int32_t)(b->bits >> (length - 1) & 1);
        const int32_t count = h->counts[length];
        if (code - count < first) {
            drop(b, length);
            return h->symbols[index + (code - first)];
        }
        index += count;
        first = (first + count) << 1;
        code <<= 1;
    }
    h->is_damaged = true;
    return 0;
}

uint32_t huffman_read(bit_reader *b, huffman *h)
{
    if (b->count < HUFFMAN_MAX_LENGTH)
        refill(b);
    const uint32_t next = (uint32_t)b->bits & ((1u << HUFFMAN_FAST_BITS) - 1);
    const unsigned length = h->lengths[next];
    if (length == 0)
        return read_slowly(b, h);
    drop(b, length);
    return h->fast[next];
}

/* ---- tables ---- */

enum { LENGTH_SYMBOLS = 21 };

/* The run of a symbol of the code lengths: zeros, or repeats of the last length. */
static uint32_t read_run(bit_reader *b, uint32_t symbol)
{
    switch (symbol) {
    case 17:
        return 3 + bits_read(b, 3);
    case 18:
        return 11 + bits_read(b, 7);
    case 19:
        return 3 + bits_read(b, 2);
    default:
        return 7 + bits_read(b, 7);
    }
}

bool huffman_read_table(bit_reader *b, huffman *h)
{
    static const unsigned char order[LENGTH_SYMBOLS] = {17, 18, 19, 20, 0,  8, 7,  9, 6,  10, 5,
                                                        11, 4,  12, 3,  13, 2, 14, 1, 15, 16};
    unsigned char lengths[HUFFMAN_MAX_SYMBOLS + 1] = {0};
    const uint32_t count = bits_read(b, 14);
    if (count == 0)
        return build(h, lengths, 0);
    const uint32_t length_count = bits_read(b, 5);
    unsigned char length_lengths[LENGTH_SYMBOLS] = {0};
    if (length_count < 1 || length_count > LENGTH_SYMBOLS)
        return false;
    for (uint32_t i = 0; i < length_count; i++)
        length_lengths[order[i]] = (unsigned char)bits_read(b, 3);
    if (!build(h, length_lengths, LENGTH_SYMBOLS) || h->symbol_count == 0)
        return false;
    for (uint32_t i = 0; i < count;) {
        const uint32_t symbol = huffman_read(b, h);
        if (b->is_past_end || h->is_damaged)
            return false;
        if (symbol <= HUFFMAN_MAX_LENGTH) {
            lengths[i++] = (unsigned char)symbol;
            continue;
        }
        const bool is_repeat = symbol >= 19;
        const uint32_t run = read_run(b, symbol);
        if (run > count - i || (is_repeat && (i == 0 || lengths[i - 1] == 0)))
            return false;
        memset(lengths + i, is_repeat ? lengths[i - 1] : 0, run);
        i += run;
    }
    return !b->is_past_end && build(h, lengths, count);
}
