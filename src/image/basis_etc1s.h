/* basis_etc1s.h - images of ETC1S blocks in BasisLZ supercompression: codebooks that a file's images
 * share, and slices of blocks that refer to them (KTX 2.0 appendices "BasisLZ Global Data" and
 * "BasisLZ/ETC1S Bitstream Specification"). */
#ifndef IMAGE_BASIS_ETC1S_H
#define IMAGE_BASIS_ETC1S_H

#include "image/image.h"

/* ---- bits, variable-length numbers and Huffman codes (basis_huffman.c) ---- */

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

/* ---- images ---- */

/* A color of 5 bits per channel and a modifier table. */
typedef struct etc1s_end {
    unsigned char color[3], table;
} etc1s_end;

typedef struct etc1s_codebook {
    etc1s_end *ends;
    uint32_t *selectors; /* two bits per texel, texel 0 lowest, row-major; 0 is darkest */
    uint32_t end_count, selector_count, history_size;
    huffman *tables; /* ETC1S_TABLE_COUNT */
} etc1s_codebook;

enum { ETC1S_TABLE_COUNT = 4, ETC1S_GLOBAL_HEADER = 20, ETC1S_IMAGE_RECORD = 20 };

/* Position of the slices of an image in their level. */
typedef struct etc1s_image {
    uint32_t flags, color_offset, color_size, alpha_offset, alpha_size; /* alpha_size 0: no alpha */
} etc1s_image;

enum { ETC1S_P_FRAME = 2 };

/* Reads the record of image index out of image_count. FACET_ERROR_INVALID if the global data is smaller than
 * it states. */
facet_result etc1s_read_image(const unsigned char *global, size_t size, uint64_t image_count, uint64_t index,
                              const char *name, etc1s_image *out, facet_error *error);

facet_result etc1s_codebook_create(const unsigned char *global, size_t size, uint64_t image_count,
                                   const char *name, const facet_allocator *allocator, etc1s_codebook *out,
                                   facet_error *error);
void etc1s_codebook_destroy(etc1s_codebook *c); /* {0} is allowed */

/* A block: indices into the codebook. */
typedef struct etc1s_block {
    uint16_t end, selector;
} etc1s_block;

/* Decodes the blocks of one slice, row-major. P frames, which refer to the previous image, are not supported. */
facet_result etc1s_decode_slice(const etc1s_codebook *c, const unsigned char *bytes, size_t size,
                                uint32_t columns, uint32_t rows, const char *name,
                                const facet_allocator *allocator, etc1s_block *blocks, facet_error *error);

/* Write the color channels of a tile of RGBA texels (block.h), or its alpha from green. */
void etc1s_decode_color(const etc1s_codebook *c, etc1s_block block, unsigned char *tile);
void etc1s_decode_alpha(const etc1s_codebook *c, etc1s_block block, unsigned char *tile);

#endif
