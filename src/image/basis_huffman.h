/* basis_huffman.h - bits, variable length numbers and Huffman codes of BasisLZ streams (KTX 2.0 appendix
 * "BasisLZ/ETC1S Bitstream Specification"). */
#ifndef IMAGE_BASIS_HUFFMAN_H
#define IMAGE_BASIS_HUFFMAN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Bits of a stream, least significant first. Reads past the end give 0 and set a flag. */
typedef struct bit_reader {
    const unsigned char *next, *end;
    uint64_t bits;
    unsigned count; /* in bits */
    bool is_past_end;
} bit_reader;

bit_reader bits_open(const unsigned char *bytes, size_t size);
uint32_t bits_read(bit_reader *b, unsigned count); /* 0 to 32 */
/* A variable-length number in groups of group_bits, each with a continuation bit. */
uint32_t bits_read_vlc(bit_reader *b, unsigned group_bits);

enum { HUFFMAN_MAX_SYMBOLS = 16383, HUFFMAN_MAX_LENGTH = 16, HUFFMAN_FAST_BITS = 10 };

/* A canonical code. Codes of up to HUFFMAN_FAST_BITS bits are looked up, longer ones decoded bit by bit. 35
 * kB. */
typedef struct huffman {
    uint16_t fast[1 << HUFFMAN_FAST_BITS];         /* symbol by the next bits */
    unsigned char lengths[1 << HUFFMAN_FAST_BITS]; /* 0: a longer code or none */
    uint16_t counts[HUFFMAN_MAX_LENGTH + 1];       /* codes of each length */
    uint16_t symbols[HUFFMAN_MAX_SYMBOLS];         /* by code */
    uint32_t symbol_count;                         /* 0: an empty table, from which nothing can be read */
    bool is_damaged;                               /* a code without a symbol was read */
} huffman;

/* Reads a table; h need not be initialised. False: the table is invalid. */
bool huffman_read_table(bit_reader *b, huffman *h);
/* The next symbol; 0 and is_damaged on failure. */
uint32_t huffman_read(bit_reader *b, huffman *h);

#endif
