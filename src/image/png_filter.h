/* png_filter.h - the five filters that PNG puts before deflate, each byte less a prediction of it. */
#ifndef IMAGE_PNG_FILTER_H
#define IMAGE_PNG_FILTER_H

#include <stddef.h>

typedef enum png_filter { PNG_NONE, PNG_LEFT, PNG_UP, PNG_AVERAGE, PNG_PAETH } png_filter;
enum { PNG_FILTER_COUNT = 5 };

/* row less the prediction into out. above is the row before, zeros at the top; texel (1 to 8) zeros stand
 * before row and above. */
void png_filter_row(png_filter filter, const unsigned char *row, const unsigned char *above, size_t size,
                    size_t texel, unsigned char *restrict out);

#endif
