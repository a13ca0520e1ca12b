/* inflate.c - see inflate.h. One table look-up decodes a literal or a length with its extra bits; input is
 * taken eight bytes at a time and matches are copied so, as long as there is room to write too far. */
#include "image/inflate.h"

#include <string.h>

#include "image/codec.h"
#include "image/deflate.h"

enum {
    MAX_BITS = 15, /* of a code */
    LITERALS = 288,
    DISTANCES = 32,
    LENGTH_CODES = 19, /* the code that codes the lengths of the others */
    LITERAL_ROOT = 11, /* bits of the first look-up .. */
    DISTANCE_ROOT = 8,
    LENGTH_ROOT = 7,
    LITERAL_ENTRIES = 2342, /* .. and entries with the second tables at worst (zlib's examples/enough.c) */
    DISTANCE_ENTRIES = 402,
    END_OF_BLOCK = 256,
    LONGEST_MATCH = 258,
    INPUT_ROOM = 16,                 /* bytes that the fast loop may read too far .. */
    OUTPUT_ROOM = LONGEST_MATCH + 40 /* .. and write, in one round */
};

/* A table entry: bits of the code in bits 0-3, of code and extra bits in 4-9, its kind, and in 16-31 a
 * literal, the base of a length or distance, or where the second table begins (whose index has as many
 * bits as bits 4-9 say). */
enum { KIND_LITERAL = 1 << 10, KIND_TABLE = 1 << 11, KIND_END = 1 << 12, KIND_INVALID = 1 << 13 };

static inline uint32_t code_bits(uint32_t entry)
{
    return entry & 15;
}

static inline uint32_t all_bits(uint32_t entry)
{
    return entry >> 4 & 63;
}

typedef struct tables {
    uint32_t literals[LITERAL_ENTRIES];
    uint32_t distances[DISTANCE_ENTRIES];
} tables;

typedef struct state {
    const unsigned char *in, *in_end;
    unsigned char *out, *out_begin, *out_end;
    uint64_t bits;  /* not yet taken, the next one lowest */
    uint32_t count; /* of bits; those above are 0, or bits that come again with the next refill */
    tables tables;
} state;

/* ---- tables ---- */

static const uint16_t length_bases[] = {3,  4,  5,  6,  7,  8,  9,  10, 11,  13,  15,  17,  19,  23, 27,
                                        31, 35, 43, 51, 59, 67, 83, 99, 115, 131, 163, 195, 227, 258};
static const uint8_t length_extras[] = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2,
                                        2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0};
static const uint16_t distance_bases[] = {1,    2,    3,    4,    5,    7,    9,    13,    17,    25,
                                          33,   49,   65,   97,   129,  193,  257,  385,   513,   769,
                                          1025, 1537, 2049, 3073, 4097, 6145, 8193, 12289, 16385, 24577};

/* What the entry of a symbol says beside the bits of its code. */
static uint32_t literal_entry(uint32_t symbol)
{
    if (symbol < END_OF_BLOCK)
        return symbol << 16 | KIND_LITERAL;
    if (symbol == END_OF_BLOCK)
        return KIND_END;
    symbol -= END_OF_BLOCK + 1;
    if (symbol >= sizeof length_extras)
        return KIND_INVALID;
    return (uint32_t)length_bases[symbol] << 16 | (uint32_t)length_extras[symbol] << 4;
}

static uint32_t distance_entry(uint32_t symbol)
{
    if (symbol >= sizeof distance_bases / sizeof *distance_bases)
        return KIND_INVALID;
    return (uint32_t)distance_bases[symbol] << 16 | (symbol < 4 ? 0 : symbol / 2 - 1) << 4;
}

static uint32_t length_entry(uint32_t symbol)
{
    return symbol << 16;
}

static uint32_t reverse_bits(uint32_t code, uint32_t count)
{
    uint32_t reversed = 0;
    for (; count > 0; count--, code >>= 1)
        reversed = reversed << 1 | (code & 1);
    return reversed;
}

/* Builds the table of a canonical code from the lengths of its symbols. Codes that leave room are allowed
 * where there is at most one symbol, as zlib does; what has no code is KIND_INVALID. */
static bool build_table(const uint8_t *lengths, uint32_t symbol_count, uint32_t root,
                        uint32_t (*make)(uint32_t), uint32_t *table)
{
    uint32_t counts[MAX_BITS + 1] = {0};
    uint32_t next[MAX_BITS + 1]; /* where the symbols of a length go in sorted */
    uint16_t sorted[LITERALS];
    for (uint32_t symbol = 0; symbol < symbol_count; symbol++)
        counts[lengths[symbol]]++;
    uint32_t longest = MAX_BITS;
    while (longest > 0 && counts[longest] == 0)
        longest--;
    int32_t room = 1;
    for (uint32_t length = 1, start = 0; length <= MAX_BITS; length++) {
        room = 2 * room - (int32_t)counts[length];
        if (room < 0)
            return false;
        next[length] = start;
        start += counts[length];
    }
    if (room > 0 && longest > 1)
        return false;
    for (uint32_t symbol = 0; symbol < symbol_count; symbol++)
        if (lengths[symbol])
            sorted[next[lengths[symbol]]++] = (uint16_t)symbol;
    if (room > 0)
        for (uint32_t i = 0; i < 1u << root; i++)
            table[i] = KIND_INVALID;

    uint32_t code = 0;
    uint32_t used = 1u << root; /* entries, with second tables */
    uint32_t second = 0; /* where the present one begins, its bits, and the root bits that lead to it */
    uint32_t second_bits = 0;
    uint32_t prefix = UINT32_MAX;
    const uint16_t *symbol = sorted;
    for (uint32_t length = 1; length <= longest; length++, code <<= 1)
        for (uint32_t n = counts[length]; n > 0; n--, code++, symbol++) {
            uint32_t reversed = reverse_bits(code, length);
            uint32_t entry = make(*symbol);
            if (length <= root) {
                entry += length | length << 4;
                for (uint32_t i = reversed; i < 1u << root; i += 1u << length)
                    table[i] = entry;
                continue;
            }
            if ((reversed & ((1u << root) - 1)) != prefix) {
                prefix = reversed & ((1u << root) - 1);
                second = used;
                second_bits = length - root; /* as many as its codes need */
                for (uint32_t left = n; second_bits + root < longest && left < 1u << second_bits;)
                    left = 2 * left + counts[root + ++second_bits];
                used += 1u << second_bits;
                table[prefix] = second << 16 | KIND_TABLE | second_bits << 4 | root;
            }
            entry += (length - root) | (length - root) << 4;
            for (uint32_t i = reversed >> root; i < 1u << second_bits; i += 1u << (length - root))
                table[second + i] = entry;
        }
    return true;
}

/* ---- bits ---- */

static void refill(state *s)
{
    while (s->count <= 56 && s->in < s->in_end) {
        s->bits |= (uint64_t)*s->in++ << s->count;
        s->count += 8;
    }
}

static uint32_t peek(const state *s, uint32_t count)
{
    return (uint32_t)(s->bits & (((uint64_t)1 << count) - 1));
}

/* False: there are fewer. */
static bool drop(state *s, uint32_t count)
{
    if (count > s->count)
        return false;
    s->bits >>= count;
    s->count -= count;
    return true;
}

/* ---- blocks ---- */

static bool read_stored(state *s)
{
    drop(s, s->count % 8);
    refill(s);
    uint32_t length = peek(s, 16);
    if (!drop(s, 16))
        return false;
    if (peek(s, 16) != (length ^ 0xffff) || !drop(s, 16))
        return false;
    s->in -= s->count / 8; /* whole bytes go back */
    s->bits = 0;
    s->count = 0;
    if (length > (size_t)(s->in_end - s->in) || length > (size_t)(s->out_end - s->out))
        return false;
    memcpy(s->out, s->in, length);
    s->in += length;
    s->out += length;
    return true;
}

static bool build_fixed(tables *t)
{
    uint8_t lengths[LITERALS];
    memset(lengths, 8, 144);
    memset(lengths + 144, 9, 112);
    memset(lengths + 256, 7, 24);
    memset(lengths + 280, 8, 8);
    if (!build_table(lengths, LITERALS, LITERAL_ROOT, literal_entry, t->literals))
        return false;
    memset(lengths, 5, DISTANCES);
    return build_table(lengths, DISTANCES, DISTANCE_ROOT, distance_entry, t->distances);
}

/* RFC 1951, 3.2.7. */
static bool build_dynamic(state *s)
{
    static const uint8_t order[LENGTH_CODES] = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                11, 4,  12, 3, 13, 2, 14, 1, 15};
    uint8_t lengths[LITERALS + DISTANCES] = {0};
    uint32_t table[1 << LENGTH_ROOT];
    refill(s);
    uint32_t literal_count = peek(s, 5) + 257;
    drop(s, 5);
    uint32_t distance_count = peek(s, 5) + 1;
    drop(s, 5);
    uint32_t code_count = peek(s, 4) + 4;
    if (!drop(s, 4) || literal_count > 286 || distance_count > 30)
        return false;
    for (uint32_t i = 0; i < code_count; i++) {
        refill(s);
        lengths[order[i]] = (uint8_t)peek(s, 3);
        if (!drop(s, 3))
            return false;
    }
    if (!build_table(lengths, LENGTH_CODES, LENGTH_ROOT, length_entry, table))
        return false;
    memset(lengths, 0, sizeof lengths);
    for (uint32_t i = 0; i < literal_count + distance_count;) {
        refill(s);
        uint32_t entry = table[peek(s, LENGTH_ROOT)];
        if (entry & KIND_INVALID || !drop(s, code_bits(entry)))
            return false;
        uint32_t symbol = entry >> 16;
        if (symbol < 16) {
            lengths[i++] = (uint8_t)symbol;
            continue;
        }
        static const uint8_t bits[] = {2, 3, 7};
        static const uint8_t bases[] = {3, 3, 11};
        uint32_t repeat = bases[symbol - 16] + peek(s, bits[symbol - 16]);
        if (!drop(s, bits[symbol - 16]) || (symbol == 16 && i == 0) ||
            repeat > literal_count + distance_count - i)
            return false;
        memset(lengths + i, symbol == 16 ? lengths[i - 1] : 0, repeat);
        i += repeat;
    }
    return lengths[END_OF_BLOCK] != 0 &&
           build_table(lengths, literal_count, LITERAL_ROOT, literal_entry, s->tables.literals) &&
           build_table(lengths + literal_count, distance_count, DISTANCE_ROOT, distance_entry,
                       s->tables.distances);
}

static inline uint64_t load_u64(const unsigned char *p)
{
    return load_u32_le(p) | (uint64_t)load_u32_le(p + 4) << 32;
}

/* Copies a match; up to 15 bytes behind it may be written. */
static inline void copy_match(unsigned char *to, size_t distance, size_t length)
{
    const unsigned char *from = to - distance;
    unsigned char *end = to + length;
    if (distance >= 8) {
        do {
            memcpy(to, from, 8);
            to += 8;
            from += 8;
        } while (to < end);
    } else if (distance == 1) {
        memset(to, *from, length);
    } else {
        do
            *to++ = *from++;
        while (to < end);
    }
}

/* The number of extra bits lies between those of the code and all. */
static inline uint32_t with_extra(uint32_t entry, uint64_t bits)
{
    uint64_t taken = bits & (((uint64_t)1 << all_bits(entry)) - 1);
    return (entry >> 16) + (uint32_t)(taken >> code_bits(entry));
}

typedef enum outcome { BLOCK_GOES_ON, BLOCK_ENDS, BLOCK_IS_DAMAGED } outcome;

/* Decodes while there is room on both sides. A refill leaves at least 56 bits: three literals of 11 bits
 * or less and a length of 20, then after another refill a distance of 28. */
static outcome inflate_fast(state *s)
{
    const unsigned char *in = s->in;
    unsigned char *out = s->out;
    uint64_t bits = s->bits;
    uint32_t count = s->count;
    const uint32_t *literals = s->tables.literals;
    const uint32_t *distances = s->tables.distances;
    const uint64_t literal_mask = (1 << LITERAL_ROOT) - 1;
    outcome result = BLOCK_GOES_ON;
    while (s->in_end - in >= INPUT_ROOM && s->out_end - out >= OUTPUT_ROOM) {
#define REFILL()                                                                                             \
    do {                                                                                                     \
        bits |= load_u64(in) << count;                                                                       \
        in += (63 - count) >> 3;                                                                             \
        count |= 56;                                                                                         \
    } while (0)
#define TAKE(n)                                                                                              \
    do {                                                                                                     \
        bits >>= (n);                                                                                        \
        count -= (n);                                                                                        \
    } while (0)
        REFILL();
        uint32_t entry = literals[bits & literal_mask];
        if (entry & KIND_LITERAL) {
            TAKE(code_bits(entry));
            *out++ = (unsigned char)(entry >> 16);
            entry = literals[bits & literal_mask];
            if (entry & KIND_LITERAL) {
                TAKE(code_bits(entry));
                *out++ = (unsigned char)(entry >> 16);
                entry = literals[bits & literal_mask];
                if (entry & KIND_LITERAL) {
                    TAKE(code_bits(entry));
                    *out++ = (unsigned char)(entry >> 16);
                    continue;
                }
            }
        }
        if (entry & KIND_TABLE) {
            TAKE(LITERAL_ROOT);
            entry = literals[(entry >> 16) + (bits & ((1u << all_bits(entry)) - 1))];
            if (entry & KIND_LITERAL) {
                TAKE(code_bits(entry));
                *out++ = (unsigned char)(entry >> 16);
                continue;
            }
        }
        if (entry & (KIND_END | KIND_INVALID)) {
            TAKE(code_bits(entry));
            result = entry & KIND_END ? BLOCK_ENDS : BLOCK_IS_DAMAGED;
            break;
        }
        size_t length = with_extra(entry, bits);
        TAKE(all_bits(entry));
        REFILL();
        entry = distances[bits & ((1 << DISTANCE_ROOT) - 1)];
        if (entry & KIND_TABLE) {
            TAKE(DISTANCE_ROOT);
            entry = distances[(entry >> 16) + (bits & ((1u << all_bits(entry)) - 1))];
        }
        size_t distance = with_extra(entry, bits);
        TAKE(all_bits(entry));
        if (entry & KIND_INVALID || distance > (size_t)(out - s->out_begin)) {
            result = BLOCK_IS_DAMAGED;
            break;
        }
        copy_match(out, distance, length);
        out += length;
#undef REFILL
#undef TAKE
    }
    s->in = in - count / 8; /* whole bytes go back */
    s->count = count % 8;
    s->bits = bits & (((uint64_t)1 << s->count) - 1);
    s->out = out;
    return result;
}

/* The next entry of a code; its bits are there. KIND_INVALID: not so. */
static uint32_t next_entry(state *s, const uint32_t *table, uint32_t root)
{
    refill(s);
    uint32_t entry = table[peek(s, root)];
    if (entry & KIND_TABLE) {
        if (!drop(s, root))
            return KIND_INVALID;
        entry = table[(entry >> 16) + peek(s, all_bits(entry))];
    }
    return all_bits(entry) <= s->count ? entry : KIND_INVALID;
}

/* One literal or match, near the end of input or output. */
static outcome inflate_one(state *s)
{
    uint32_t entry = next_entry(s, s->tables.literals, LITERAL_ROOT);
    if (entry & KIND_INVALID)
        return BLOCK_IS_DAMAGED;
    if (entry & KIND_LITERAL) {
        if (s->out == s->out_end)
            return BLOCK_IS_DAMAGED;
        *s->out++ = (unsigned char)(entry >> 16);
    }
    if (entry & (KIND_LITERAL | KIND_END)) {
        drop(s, code_bits(entry));
        return entry & KIND_END ? BLOCK_ENDS : BLOCK_GOES_ON;
    }
    size_t length = with_extra(entry, s->bits);
    drop(s, all_bits(entry));
    entry = next_entry(s, s->tables.distances, DISTANCE_ROOT);
    if (entry & KIND_INVALID)
        return BLOCK_IS_DAMAGED;
    size_t distance = with_extra(entry, s->bits);
    drop(s, all_bits(entry));
    if (distance > (size_t)(s->out - s->out_begin) || length > (size_t)(s->out_end - s->out))
        return BLOCK_IS_DAMAGED;
    for (; length > 0; length--, s->out++)
        *s->out = *(s->out - distance);
    return BLOCK_GOES_ON;
}

static bool read_coded(state *s)
{
    outcome o = BLOCK_GOES_ON;
    while (o == BLOCK_GOES_ON) {
        o = inflate_fast(s);
        if (o == BLOCK_GOES_ON)
            o = inflate_one(s);
    }
    return o == BLOCK_ENDS;
}

static bool read_block(state *s, bool *is_last)
{
    refill(s);
    *is_last = peek(s, 1);
    uint32_t type = peek(s, 3) >> 1;
    if (!drop(s, 3))
        return false;
    switch (type) {
    case 0:
        return read_stored(s);
    case 1:
        return build_fixed(&s->tables) && read_coded(s);
    case 2:
        return build_dynamic(s) && read_coded(s);
    default:
        return false;
    }
}

bool zlib_inflate(const unsigned char *packed, size_t packed_size, unsigned char *out, size_t out_size)
{
    /* deflate, a window of at most 32 KiB, no dictionary, the two bytes a multiple of 31 */
    if (packed_size < ZLIB_FRAME || (packed[0] & 15) != 8 || packed[0] >> 4 > 7 || packed[1] & 0x20 ||
        (packed[0] << 8 | packed[1]) % 31 != 0)
        return false;
    state s;
    s.in = packed + 2;
    s.in_end = packed + packed_size;
    s.out = s.out_begin = out;
    s.out_end = out + out_size;
    s.bits = 0;
    s.count = 0;
    for (bool is_last = false; !is_last;)
        if (!read_block(&s, &is_last))
            return false;
    s.in -= s.count / 8;
    if (s.out != s.out_end || s.in_end - s.in < 4)
        return false;
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
    return true; /* else no change would come further than this */
#else
    return load_u32_be(s.in) == zlib_checksum(out, out_size);
#endif
}
