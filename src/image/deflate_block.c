/* deflate_block.c - see deflate_block.h. RFC 1951, 3.2. */
#include "image/deflate_block.h"

#include <string.h>

#include "image/codec.h"

enum {
    MAX_BITS = 15,
    MAX_LENGTH_BITS = 7, /* of the code for the lengths of codes */
    LENGTH_SYMBOLS = 19,
    END_OF_BLOCK = 256,
    MAX_SYMBOLS = 288,
    REPEAT = 16,     /* the length before, 3 to 6 times */
    ZEROS = 17,      /* 3 to 10 */
    MANY_ZEROS = 18, /* 11 to 138 */
    MAX_STORED = 65535
};

/* The code of each symbol, first bit lowest, and its bits. */
typedef struct code {
    uint16_t bits[MAX_SYMBOLS];
    uint8_t lengths[MAX_SYMBOLS];
} code;

/* ---- bits ---- */

static inline void put(bit_writer *w, uint64_t bits, uint32_t count) /* at most 48 at a time */
{
    w->bits |= bits << w->count;
    w->count += count;
    store_u32_le(w->next, (uint32_t)w->bits);
    store_u32_le(w->next + 4, (uint32_t)(w->bits >> 32));
    w->next += w->count / 8;
    w->bits = w->count >= 64 ? 0 : w->bits >> (w->count & ~7u);
    w->count %= 8;
}

void deflate_finish(bit_writer *w)
{
    if (w->count)
        *w->next++ = (unsigned char)w->bits;
    w->bits = 0;
    w->count = 0;
}

void deflate_align(bit_writer *w)
{
    put(w, 0, 3); /* not the last, stored */
    deflate_finish(w);
    memcpy(w->next, "\0\0\xff\xff", 4);
    w->next += 4;
}

/* ---- codes ---- */

static void sort_keys(uint32_t *keys, uint32_t count)
{
    static const uint32_t gaps[] = {132, 57, 23, 10, 4, 1};
    for (size_t g = 0; g < sizeof gaps / sizeof *gaps; g++)
        for (uint32_t i = gaps[g]; i < count; i++) {
            uint32_t key = keys[i];
            uint32_t k = i;
            for (; k >= gaps[g] && keys[k - gaps[g]] > key; k -= gaps[g])
                keys[k] = keys[k - gaps[g]];
            keys[k] = key;
        }
}

/* How many leaves of Huffman's tree over sorted weights (two or more) have each depth, at most limit. Two
 * queues: leaves in their order, nodes as they are made. */
static void count_depths(const uint32_t *keys, uint32_t count, uint32_t limit, uint32_t counts[MAX_BITS + 1])
{
    uint32_t weights[MAX_SYMBOLS];
    uint16_t parents[2 * MAX_SYMBOLS]; /* of leaves, then of nodes */
    uint8_t depths[MAX_SYMBOLS];       /* of nodes; the last one is the root */
    uint32_t leaf = 0;
    uint32_t node = 0;
    for (uint32_t made = 0; made < count - 1; made++) {
        uint32_t weight = 0;
        for (int child = 0; child < 2; child++) {
            bool is_leaf = leaf < count && (node >= made || keys[leaf] >> 9 <= weights[node]);
            weight += is_leaf ? keys[leaf] >> 9 : weights[node];
            parents[is_leaf ? leaf++ : count + node++] = (uint16_t)made;
        }
        weights[made] = weight;
    }
    memset(counts, 0, (MAX_BITS + 1) * sizeof *counts);
    depths[count - 2] = 0;
    for (uint32_t n = count - 2; n-- > 0;)
        depths[n] = (uint8_t)(depths[parents[count + n]] + 1);
    for (uint32_t l = 0; l < count; l++) {
        uint32_t depth = depths[parents[l]] + 1u;
        counts[depth < limit ? depth : limit]++;
    }
    /* Too many at the limit: take a leaf from the deepest level above it and hang two below, one of them
     * from the limit, until the code fits. */
    uint32_t used = 0;
    for (uint32_t depth = 1; depth <= limit; depth++)
        used += counts[depth] << (limit - depth);
    for (; used > 1u << limit; used--) {
        uint32_t depth = limit - 1;
        while (counts[depth] == 0)
            depth--;
        counts[depth]--;
        counts[depth + 1] += 2;
        counts[limit]--;
    }
}

static uint32_t reverse_bits(uint32_t bits, uint32_t count)
{
    uint32_t reversed = 0;
    for (; count > 0; count--, bits >>= 1)
        reversed = reversed << 1 | (bits & 1);
    return reversed;
}

static void assign_codes(code *c, uint32_t symbols)
{
    uint32_t counts[MAX_BITS + 1] = {0};
    uint32_t next[MAX_BITS + 1];
    for (uint32_t s = 0; s < symbols; s++)
        counts[c->lengths[s]]++;
    counts[0] = 0;
    for (uint32_t length = 1, bits = 0; length <= MAX_BITS; length++) {
        bits = (bits + counts[length - 1]) << 1;
        next[length] = bits;
    }
    for (uint32_t s = 0; s < symbols; s++)
        if (c->lengths[s])
            c->bits[s] = (uint16_t)reverse_bits(next[c->lengths[s]]++, c->lengths[s]);
}

/* The best prefix code for the frequencies (less than 2^23) with at most limit bits. One symbol gets one
 * bit. */
static void make_code(const uint32_t *frequencies, uint32_t symbols, uint32_t limit, code *c)
{
    uint32_t keys[MAX_SYMBOLS]; /* frequency << 9 | symbol */
    uint32_t count = 0;
    memset(c->lengths, 0, sizeof c->lengths);
    for (uint32_t s = 0; s < symbols; s++)
        if (frequencies[s])
            keys[count++] = frequencies[s] << 9 | s;
    if (count == 1)
        c->lengths[keys[0] & 511] = 1;
    if (count > 1) {
        uint32_t counts[MAX_BITS + 1];
        sort_keys(keys, count);
        count_depths(keys, count, limit, counts);
        for (uint32_t length = limit, k = 0; length > 0; length--)
            for (uint32_t n = counts[length]; n > 0; n--)
                c->lengths[keys[k++] & 511] = (uint8_t)length;
    }
    assign_codes(c, symbols);
}

static void make_fixed_codes(code *literals, code *distances)
{
    memset(literals->lengths, 8, 144);
    memset(literals->lengths + 144, 9, 112);
    memset(literals->lengths + 256, 7, 24);
    memset(literals->lengths + 280, 8, 8);
    memset(distances->lengths, 5, 32);
    assign_codes(literals, MAX_SYMBOLS);
    assign_codes(distances, 32);
}

/* ---- symbols ---- */

/* A length or distance as symbol and extra bits: numbers below 2^(n + 1), then 2^n symbols per octave. */
static inline uint32_t symbol_of(uint32_t x, uint32_t n, uint32_t *extra_count)
{
    if (x < 2u << n) {
        *extra_count = 0;
        return x;
    }
    uint32_t octave = 31 - (uint32_t)__builtin_clz(x);
    *extra_count = octave - n;
    return ((octave - n) << n) + (x >> (octave - n));
}

static inline uint32_t length_symbol(uint32_t length_less_3, uint32_t *extra_count)
{
    if (length_less_3 == DEFLATE_MAX_MATCH - DEFLATE_MIN_MATCH) { /* has one of its own */
        *extra_count = 0;
        return DEFLATE_LITERAL_SYMBOLS - 1;
    }
    return END_OF_BLOCK + 1 + symbol_of(length_less_3, 2, extra_count);
}

static inline uint32_t token_length(deflate_token t)
{
    return t >> 16 & 0xff;
}

static inline uint32_t token_distance(deflate_token t)
{
    return t & 0xffff;
}

static void put_tokens(bit_writer *w, const deflate_token *tokens, size_t count, const code *literals,
                       const code *distances)
{
    for (size_t k = 0; k < count; k++) {
        deflate_token t = tokens[k];
        if (!(t >> 31)) { /* up to 48 bits of literals at once */
            uint64_t bits = literals->bits[t];
            uint32_t bits_count = literals->lengths[t];
            while (bits_count <= 48 - MAX_BITS && k + 1 < count && !(tokens[k + 1] >> 31)) {
                t = tokens[++k];
                bits |= (uint64_t)literals->bits[t] << bits_count;
                bits_count += literals->lengths[t];
            }
            put(w, bits, bits_count);
            continue;
        }
        uint32_t extra;
        uint32_t symbol = length_symbol(token_length(t), &extra);
        uint32_t bits_count = literals->lengths[symbol];
        uint64_t bits = literals->bits[symbol] | (uint64_t)(token_length(t) & ((1u << extra) - 1))
                                                     << bits_count;
        bits_count += extra;
        symbol = symbol_of(token_distance(t), 1, &extra);
        bits |= (uint64_t)distances->bits[symbol] << bits_count;
        bits_count += distances->lengths[symbol];
        bits |= (uint64_t)(token_distance(t) & ((1u << extra) - 1)) << bits_count;
        put(w, bits, bits_count + extra);
    }
    put(w, literals->bits[END_OF_BLOCK], literals->lengths[END_OF_BLOCK]);
}

/* ---- blocks ---- */

/* The lengths of both codes with runs shortened: symbols, with the number of a run in the high byte. */
static uint32_t pack_lengths(const uint8_t *lengths, uint32_t count, uint16_t *out)
{
    uint32_t used = 0;
    for (uint32_t i = 0; i < count;) {
        uint32_t run = 1;
        while (i + run < count && lengths[i + run] == lengths[i] && run < 138)
            run++;
        if (lengths[i] == 0 && run >= 11) {
            out[used++] = (uint16_t)(MANY_ZEROS | (run - 11) << 8);
        } else if (lengths[i] == 0 && run >= 3) {
            out[used++] = (uint16_t)(ZEROS | (run - 3) << 8);
        } else if (run >= 4) { /* one as it is, then 3 to 6 repeats */
            run = run < 7 ? run : 7;
            out[used++] = lengths[i];
            out[used++] = (uint16_t)(REPEAT | (run - 4) << 8);
        } else {
            run = 1;
            out[used++] = lengths[i];
        }
        i += run;
    }
    return used;
}

typedef struct dynamic_header {
    uint32_t literal_count, distance_count, length_count;
    uint16_t packed[DEFLATE_LITERAL_SYMBOLS + DEFLATE_DISTANCE_SYMBOLS];
    uint32_t packed_count;
    code lengths;
} dynamic_header;

static const uint8_t length_order[LENGTH_SYMBOLS] = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                     11, 4,  12, 3, 13, 2, 14, 1, 15};
static const uint8_t run_bits[LENGTH_SYMBOLS] = {[REPEAT] = 2, [ZEROS] = 3, [MANY_ZEROS] = 7};

/* Returns the bits that the header takes. */
static size_t make_header(const code *literals, const code *distances, dynamic_header *h)
{
    uint8_t all[DEFLATE_LITERAL_SYMBOLS + DEFLATE_DISTANCE_SYMBOLS];
    uint32_t frequencies[LENGTH_SYMBOLS] = {0};
    h->literal_count = DEFLATE_LITERAL_SYMBOLS;
    while (h->literal_count > 257 && literals->lengths[h->literal_count - 1] == 0)
        h->literal_count--;
    h->distance_count = DEFLATE_DISTANCE_SYMBOLS;
    while (h->distance_count > 1 && distances->lengths[h->distance_count - 1] == 0)
        h->distance_count--;
    memcpy(all, literals->lengths, h->literal_count);
    memcpy(all + h->literal_count, distances->lengths, h->distance_count);
    h->packed_count = pack_lengths(all, h->literal_count + h->distance_count, h->packed);
    for (uint32_t i = 0; i < h->packed_count; i++)
        frequencies[h->packed[i] & 0xff]++;
    make_code(frequencies, LENGTH_SYMBOLS, MAX_LENGTH_BITS, &h->lengths);
    h->length_count = LENGTH_SYMBOLS;
    while (h->length_count > 4 && h->lengths.lengths[length_order[h->length_count - 1]] == 0)
        h->length_count--;
    size_t bits = 14 + 3 * h->length_count;
    for (uint32_t s = 0; s < LENGTH_SYMBOLS; s++)
        bits += frequencies[s] * (h->lengths.lengths[s] + run_bits[s]);
    return bits;
}

static void put_header(bit_writer *w, const dynamic_header *h)
{
    put(w, h->literal_count - 257, 5);
    put(w, h->distance_count - 1, 5);
    put(w, h->length_count - 4, 4);
    for (uint32_t i = 0; i < h->length_count; i++)
        put(w, h->lengths.lengths[length_order[i]], 3);
    for (uint32_t i = 0; i < h->packed_count; i++) {
        uint32_t symbol = h->packed[i] & 0xff;
        put(w, h->lengths.bits[symbol], h->lengths.lengths[symbol]);
        put(w, h->packed[i] >> 8, run_bits[symbol]);
    }
}

static void put_stored(bit_writer *w, const unsigned char *bytes, size_t size, bool is_last)
{
    do {
        uint32_t length = size < MAX_STORED ? (uint32_t)size : MAX_STORED;
        size -= length;
        put(w, is_last && size == 0, 3);
        deflate_finish(w);
        put(w, length | (uint64_t)(length ^ MAX_STORED) << 16, 32);
        memcpy(w->next, bytes, length);
        w->next += length;
        bytes += length;
    } while (size > 0);
}

/* Bits of the extra bits of all tokens, which no code changes; frequencies of the symbols, both zero
 * before. */
static size_t count_symbols(const deflate_token *tokens, size_t count, uint32_t *literals,
                            uint32_t *distances)
{
    size_t extra_bits = 0;
    for (size_t k = 0; k < count; k++) {
        uint32_t extra = 0;
        if (tokens[k] >> 31) {
            literals[length_symbol(token_length(tokens[k]), &extra)]++;
            extra_bits += extra;
            distances[symbol_of(token_distance(tokens[k]), 1, &extra)]++;
            extra_bits += extra;
        } else {
            literals[tokens[k]]++;
        }
    }
    literals[END_OF_BLOCK]++;
    return extra_bits;
}

static size_t code_bits(const uint32_t *frequencies, uint32_t symbols, const code *c)
{
    size_t bits = 0;
    for (uint32_t s = 0; s < symbols; s++)
        bits += (size_t)frequencies[s] * c->lengths[s];
    return bits;
}

void deflate_write_block(bit_writer *w, const deflate_token *tokens, size_t count, const unsigned char *bytes,
                         size_t size, bool is_last)
{
    uint32_t literal_frequencies[MAX_SYMBOLS] = {0};
    uint32_t distance_frequencies[32] = {0};
    code literals, distances, fixed_literals, fixed_distances;
    dynamic_header header;
    size_t extra = count_symbols(tokens, count, literal_frequencies, distance_frequencies);
    make_code(literal_frequencies, DEFLATE_LITERAL_SYMBOLS, MAX_BITS, &literals);
    make_code(distance_frequencies, DEFLATE_DISTANCE_SYMBOLS, MAX_BITS, &distances);
    make_fixed_codes(&fixed_literals, &fixed_distances);
    size_t dynamic_bits = make_header(&literals, &distances, &header) + extra +
                          code_bits(literal_frequencies, DEFLATE_LITERAL_SYMBOLS, &literals) +
                          code_bits(distance_frequencies, DEFLATE_DISTANCE_SYMBOLS, &distances);
    size_t fixed_bits = extra + code_bits(literal_frequencies, DEFLATE_LITERAL_SYMBOLS, &fixed_literals) +
                        code_bits(distance_frequencies, DEFLATE_DISTANCE_SYMBOLS, &fixed_distances);
    size_t stored_bits = 8 * size + 40 * (size / MAX_STORED + 1);
    if (stored_bits <= dynamic_bits && stored_bits <= fixed_bits) {
        put_stored(w, bytes, size, is_last);
    } else if (fixed_bits <= dynamic_bits) {
        put(w, 1 << 1 | is_last, 3);
        put_tokens(w, tokens, count, &fixed_literals, &fixed_distances);
    } else {
        put(w, 2 << 1 | is_last, 3);
        put_header(w, &header);
        put_tokens(w, tokens, count, &literals, &distances);
    }
}
