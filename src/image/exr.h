/* exr.h - what the parts of the OpenEXR reader share: a chunk and the codings it may come in. */
#ifndef IMAGE_EXR_H
#define IMAGE_EXR_H

#include "facet/facet.h"

typedef enum exr_type { EXR_UINT, EXR_HALF, EXR_FLOAT } exr_type;

typedef enum exr_compression {
    EXR_NONE,
    EXR_RLE,
    EXR_ZIPS,
    EXR_ZIP,
    EXR_PIZ,
    EXR_PXR24,
    EXR_B44,
    EXR_B44A,
    EXR_DWAA,
    EXR_DWAB,
    EXR_COMPRESSION_COUNT
} exr_compression;

typedef struct exr_channel {
    const char *name; /* in the file's bytes */
    exr_type type;
    bool is_linear; /* "pLinear": B44 codes its logarithm, DWA its value */
} exr_channel;

static inline size_t exr_sample_size(const exr_channel *c)
{
    return c->type == EXR_HALF ? 2 : 4;
}

/* The samples of a chunk, all channels of a row before the next row, little-endian. */
typedef struct exr_chunk {
    const exr_channel *channels;
    uint32_t channel_count;
    uint32_t width, height;
    size_t size; /* bytes of all samples */
    const facet_allocator *allocator;
} exr_chunk;

/* Fill samples (chunk->size bytes) from packed. Fail, without a message, with FACET_ERROR_INVALID where
 * packed is damaged or does not hold exactly the chunk, and with FACET_ERROR_MEMORY. samples are then
 * undefined. */
typedef facet_result exr_unpacker(const exr_chunk *chunk, const unsigned char *packed, size_t packed_size,
                                  unsigned char *samples);
exr_unpacker exr_unpack_rle, exr_unpack_zip, exr_unpack_pxr24; /* exr_zip.c; zip: also for ZIPS */
exr_unpacker exr_unpack_piz;                                   /* exr_piz.c */
exr_unpacker exr_unpack_b44;                                   /* exr_b44.c; also for B44A */
exr_unpacker exr_unpack_dwa;                                   /* exr_dwa.c; DWAA and DWAB */

/* Shared by codings, failing as above. */
facet_result exr_expand_runs(const unsigned char *packed, size_t packed_size, unsigned char *out,
                             size_t size);
void exr_unpredict(unsigned char *predicted, size_t size, unsigned char *out); /* clobbers predicted */
facet_result exr_huffman_decode(const facet_allocator *allocator, const unsigned char *packed,
                                size_t packed_size, uint16_t *out, size_t count);

#endif
