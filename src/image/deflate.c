/* deflate.c - see deflate.h. Levels 1 to 5 are ours: zlib's fast ones are made for streams that come in
 * parts, and take twice the time for as many bytes. Here all is in memory, matches begin with four equal
 * bytes, and are looked for in short chains. */
#include "image/deflate.h"

#include <string.h>

#include <zlib.h>

#include "base/memory.h"
#include "image/codec.h"
#include "image/deflate_block.h"

enum { HASH_BITS = 15, HASHED_BYTES = 4, OWN_LEVELS = 5 };

/* How hard a level looks. */
typedef struct effort {
    uint32_t chain;      /* places that are compared */
    uint32_t lazy_below; /* matches shorter than this have to be no shorter than the one that begins next */
    uint32_t insert;     /* places inside a match that are remembered */
} effort;

static const effort efforts[OWN_LEVELS + 1] = {
    [1] = {1, 0, 1}, [2] = {2, 0, 4}, [3] = {3, 8, 8}, [4] = {4, 8, 16}, [5] = {16, 32, 258}};

typedef struct matcher {
    const unsigned char *base;       /* position 0: where the history begins */
    uint32_t end;                    /* of all bytes */
    uint32_t heads[1 << HASH_BITS];  /* the last position of each hash, plus 1 */
    uint32_t before[DEFLATE_WINDOW]; /* that of the same hash before a position, plus 1 */
    deflate_token tokens[DEFLATE_BLOCK_TOKENS];
} matcher;

static inline uint32_t hash_at(const matcher *m, uint32_t position)
{
    return load_u32_le(m->base + position) * 2654435761u >> (32 - HASH_BITS);
}

static inline void insert(matcher *m, uint32_t position)
{
    uint32_t hash = hash_at(m, position);
    m->before[position % DEFLATE_WINDOW] = m->heads[hash];
    m->heads[hash] = position + 1;
}

/* Equal bytes at both, at most most. */
static inline uint32_t common_length(const unsigned char *a, const unsigned char *b, uint32_t most)
{
    uint32_t length = 0;
    for (; length + 8 <= most; length += 8) {
        uint64_t x, y;
        memcpy(&x, a + length, 8);
        memcpy(&y, b + length, 8);
        if (x != y) /* the first byte that differs is the lowest one */
            return length + (uint32_t)__builtin_ctzll(x ^ y) / 8;
    }
    while (length < most && a[length] == b[length])
        length++;
    return length;
}

/* The longest match of more than longer bytes at position, which has not been inserted; 0: there is none. */
static inline uint32_t find_match(const matcher *m, uint32_t position, uint32_t chain, uint32_t longer,
                                  uint32_t *distance)
{
    const unsigned char *here = m->base + position;
    const uint32_t left = m->end - position;
    const uint32_t most = left < DEFLATE_MAX_MATCH ? left : DEFLATE_MAX_MATCH;
    uint32_t best = longer;
    uint32_t found = 0;
    if (most <= best)
        return 0;
    uint32_t next = m->heads[hash_at(m, position)];
    for (; chain > 0 && next != 0; chain--) {
        uint32_t candidate = next - 1;
        if (position - candidate > DEFLATE_WINDOW)
            break;
        const unsigned char *there = m->base + candidate;
        if (there[best] == here[best] && load_u32_le(there) == load_u32_le(here)) {
            uint32_t length = common_length(there, here, most);
            if (length > best) {
                best = found = length;
                *distance = position - candidate;
                if (length == most)
                    break;
            }
        }
        next = m->before[candidate % DEFLATE_WINDOW];
        if (next > candidate) /* overwritten since */
            break;
    }
    return found;
}

/* All bytes from position on to tokens and blocks. */
static void write_blocks(matcher *m, const effort *e, uint32_t position, bool is_last, bit_writer *w)
{
    const uint32_t hash_end = m->end < HASHED_BYTES ? 0 : m->end - HASHED_BYTES + 1; /* positions to hash */
    uint32_t block = position;
    size_t count = 0;
    while (position < m->end) {
        uint32_t distance = 0;
        uint32_t length = 0;
        if (position < hash_end) {
            length = find_match(m, position, e->chain, HASHED_BYTES - 1, &distance);
            insert(m, position);
        }
        if (length && length < e->lazy_below && position + 1 < hash_end) {
            uint32_t next_distance;
            if (find_match(m, position + 1, e->chain, length, &next_distance))
                length = 0;
        }
        if (length) {
            m->tokens[count++] = deflate_match(length, distance);
            uint32_t inserted = length - 1 < e->insert ? length - 1 : e->insert;
            for (uint32_t k = 1; k <= inserted && position + k < hash_end; k++)
                insert(m, position + k);
            position += length;
        } else {
            m->tokens[count++] = m->base[position++];
        }
        if (count == DEFLATE_BLOCK_TOKENS || position == m->end) {
            deflate_write_block(w, m->tokens, count, m->base + block, position - block,
                                is_last && position == m->end);
            block = position;
            count = 0;
        }
    }
}

static size_t deflate_ours(const facet_allocator *allocator, const effort *e, const unsigned char *bytes,
                           size_t size, size_t history_size, bool is_last, unsigned char *out)
{
    matcher *m = mem_alloc(allocator, 1, sizeof *m);
    if (!m)
        return 0;
    memset(m->heads, 0, sizeof m->heads);
    m->base = bytes - history_size;
    m->end = (uint32_t)(history_size + size);
    for (uint32_t position = 0; position < history_size && position + HASHED_BYTES <= m->end; position++)
        insert(m, position);
    bit_writer w = {.next = out};
    if (size > 0)
        write_blocks(m, e, (uint32_t)history_size, is_last, &w);
    else if (is_last)
        deflate_write_block(&w, NULL, 0, bytes, 0, true);
    if (is_last)
        deflate_finish(&w);
    else
        deflate_align(&w);
    mem_free(m);
    return (size_t)(w.next - out);
}

/* ---- zlib ---- */

static void *zlib_alloc(void *allocator, unsigned count, unsigned size)
{
    return mem_alloc(allocator, count, size);
}

static void zlib_free(void *allocator, void *memory)
{
    (void)allocator;
    mem_free(memory);
}

static size_t deflate_zlib(const facet_allocator *allocator, uint32_t level, const unsigned char *bytes,
                           size_t size, size_t history_size, bool is_last, unsigned char *out)
{
    z_stream z = {.zalloc = zlib_alloc, .zfree = zlib_free, .opaque = (void *)allocator};
    if (deflateInit2(&z, (int)level, Z_DEFLATED, -15, 8, Z_DEFAULT_STRATEGY) != Z_OK)
        return 0;
    if (history_size)
        deflateSetDictionary(&z, bytes - history_size, (unsigned)history_size);
    z.next_in = (unsigned char *)bytes;
    z.avail_in = (unsigned)size;
    z.next_out = out;
    z.avail_out = (unsigned)deflate_bound(size);
    deflate(&z, is_last ? Z_FINISH : Z_SYNC_FLUSH); /* the latter ends with an empty stored block, too */
    size_t used = z.total_out;
    deflateEnd(&z);
    return used;
}

size_t deflate_bound(size_t size)
{
    /* Blocks are stored where that is smaller; ours hold 24576 bytes and more, zlib's 16383, and add 5 or
     * 6. */
    return size + size / 1024 + 2 * DEFLATE_BLOCK_ROOM;
}

size_t deflate_piece(const facet_allocator *allocator, uint32_t level, const unsigned char *bytes,
                     size_t size, size_t history_size, bool is_last, unsigned char *out)
{
    if (level <= OWN_LEVELS)
        return deflate_ours(allocator, &efforts[level], bytes, size, history_size, is_last, out);
    return deflate_zlib(allocator, level, bytes, size, history_size, is_last, out);
}

void zlib_begin(unsigned char out[2])
{
    out[0] = 0x78; /* deflate, window of 32 KiB */
    out[1] = 0x5e; /* makes both a multiple of 31 */
}

uint32_t zlib_checksum(const unsigned char *bytes, size_t size)
{
    return bytes ? (uint32_t)adler32_z(1, bytes, size) : 1;
}

uint32_t zlib_checksum_join(uint32_t first, uint32_t second, size_t second_size)
{
    return (uint32_t)adler32_combine(first, second, (z_off_t)second_size);
}
