/* png_whole.h - the usual PNG file inflated in one piece by libdeflate, which takes half the time of zlib. */
#ifndef IMAGE_PNG_WHOLE_H
#define IMAGE_PNG_WHOLE_H

#include "image/image.h"

/* Rows of 1, 2, 3 or 4 channels of 8 bits, each behind the byte of its filter. */
typedef struct png_whole {
    unsigned char *rows;   /* a row of zeros before them */
    unsigned char *memory; /* owned */
    uint32_t width, height, channel_count;
} png_whole;

/* Inflates a file whose chunks are complete. False: it is of another kind (interlaced, palette, transparent color, other
 * depths), damaged, or too large to be in memory in one piece; libspng reads it, or says what is wrong. */
bool png_whole_open(const unsigned char *bytes, size_t size, const facet_allocator *allocator,
                    png_whole *out);
/* Reverses the filter of row y, for all rows in order, and returns its texels. */
const unsigned char *png_whole_row(const png_whole *p, uint32_t y);
void png_whole_close(png_whole *p);

#endif
