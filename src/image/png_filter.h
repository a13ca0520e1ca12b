/* png_filter.h - the filters of PNG's rows: each byte minus its prediction. PNG, third edition (W3C), section 9. */
#ifndef IMAGE_PNG_FILTER_H
#define IMAGE_PNG_FILTER_H

#include <stdlib.h>

typedef enum png_filter { PNG_NONE, PNG_LEFT, PNG_UP, PNG_AVERAGE, PNG_PAETH } png_filter;
enum { PNG_FILTER_COUNT = 5 };

/* Paeth predictor: whichever of left, up and corner is nearest to left + up - corner. */
static inline int png_paeth(int left, int up, int corner)
{
    const int to_left = abs(up - corner);
    const int to_up = abs(left - corner);
    const int to_corner = abs(left + up - 2 * corner);
    const int nearest = to_up <= to_corner ? up : corner;
    return to_left <= to_up && to_left <= to_corner ? left : nearest;
}

#endif
