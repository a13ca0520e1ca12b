/* png_filter.c - see png_filter.h. PNG third edition, section 9. */
#include "image/png_filter.h"

#include <stdlib.h>
#include <string.h>

/* The predictor of Paeth: of left, up and their corner what is nearest to left + up - corner. */
static inline int paeth(int left, int up, int corner)
{
    int to_left = abs(up - corner);
    int to_up = abs(left - corner);
    int to_corner = abs(left + up - 2 * corner);
    int nearest = to_up <= to_corner ? up : corner;
    return to_left <= to_up && to_left <= to_corner ? left : nearest;
}

void png_filter_row(png_filter filter, const unsigned char *row, const unsigned char *above, size_t size,
                    size_t texel, unsigned char *restrict out)
{
    const unsigned char *left = row - texel;
    const unsigned char *corner = above - texel;
    switch (filter) {
    case PNG_NONE:
        memcpy(out, row, size);
        return;
    case PNG_LEFT:
        for (size_t k = 0; k < size; k++)
            out[k] = (unsigned char)(row[k] - left[k]);
        return;
    case PNG_UP:
        for (size_t k = 0; k < size; k++)
            out[k] = (unsigned char)(row[k] - above[k]);
        return;
    case PNG_AVERAGE:
        for (size_t k = 0; k < size; k++)
            out[k] = (unsigned char)(row[k] - ((left[k] + above[k]) >> 1));
        return;
    case PNG_PAETH:
        for (size_t k = 0; k < size; k++)
            out[k] = (unsigned char)(row[k] - paeth(left[k], above[k], corner[k]));
        return;
    }
}
