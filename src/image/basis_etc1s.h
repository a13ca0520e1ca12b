/* basis_etc1s.h - images of ETC1S blocks in BasisLZ supercompression: codebooks that a file's images
 * share, and slices of blocks that refer to them (KTX 2.0 appendices "BasisLZ Global Data" and
 * "BasisLZ/ETC1S Bitstream Specification"). */
#ifndef IMAGE_BASIS_ETC1S_H
#define IMAGE_BASIS_ETC1S_H

#include "image/basis_huffman.h"
#include "image/image.h"

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
