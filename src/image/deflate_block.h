/* deflate_block.h - literals and matches to the bits of deflate blocks. */
#ifndef IMAGE_DEFLATE_BLOCK_H
#define IMAGE_DEFLATE_BLOCK_H

#include "facet/facet.h"

enum {
    DEFLATE_MIN_MATCH = 3,
    DEFLATE_MAX_MATCH = 258,
    DEFLATE_LITERAL_SYMBOLS = 286,
    DEFLATE_DISTANCE_SYMBOLS = 30,
    DEFLATE_BLOCK_TOKENS = 24 * 1024, /* at most in a block */
    DEFLATE_BLOCK_ROOM = 64           /* bytes that writing a block may take beyond the bytes it stands for */
};

/* A literal, or 1 << 31 | (length - 3) << 16 | (distance - 1). */
typedef uint32_t deflate_token;

static inline deflate_token deflate_match(uint32_t length, uint32_t distance)
{
    return 1u << 31 | (length - DEFLATE_MIN_MATCH) << 16 | (distance - 1);
}

/* Bits on their way to memory: those at the low end come first. */
typedef struct bit_writer {
    unsigned char *next;
    uint64_t bits;
    uint32_t count;
} bit_writer;

/* Writes the tokens, which stand for size bytes, in the smallest kind of block: with codes of their own,
 * fixed codes, or stored. */
void deflate_write_block(bit_writer *w, const deflate_token *tokens, size_t count, const unsigned char *bytes,
                         size_t size, bool is_last);
/* An empty stored block, which ends at a byte. */
void deflate_align(bit_writer *w);
/* Writes out the last bits, zeros behind them up to a byte. */
void deflate_finish(bit_writer *w);

#endif
