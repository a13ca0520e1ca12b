/* png_chunk.h - the chunks of a PNG file. Portable Network Graphics, third edition (W3C), section 5.3. */
#ifndef IMAGE_PNG_CHUNK_H
#define IMAGE_PNG_CHUNK_H

#include <string.h>

#include "image/codec.h"

enum {
    PNG_SIGNATURE_SIZE = 8,
    PNG_CHUNK_FRAME = 12, /* length, type, CRC */
    PNG_IHDR_SIZE = 13
};

typedef struct png_chunk {
    const unsigned char *start; /* its length */
    const unsigned char *type, *data, *end;
} png_chunk;

static inline bool png_chunk_is(const png_chunk *c, const char type[4])
{
    return memcmp(c->type, type, 4) == 0;
}

static inline size_t png_chunk_size(const png_chunk *c)
{
    return (size_t)(c->end - c->start) - PNG_CHUNK_FRAME;
}

/* Reads the chunk at *p and advances *p; false: truncated. */
static inline bool png_chunk_next(const unsigned char **p, const unsigned char *end, png_chunk *c)
{
    if (end - *p < PNG_CHUNK_FRAME)
        return false;
    const size_t size = load_u32_be(*p);
    if (size > (size_t)(end - *p) - PNG_CHUNK_FRAME)
        return false;
    *c = (png_chunk){*p, *p + 4, *p + 8, *p + PNG_CHUNK_FRAME + size};
    *p = c->end;
    return true;
}

#endif
