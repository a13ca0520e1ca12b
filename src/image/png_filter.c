/* png_filter.c - see png_filter.h. PNG third edition, section 9. */
#include "image/png_filter.h"

#include <stdint.h>
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

/* ---- the way back: a texel depends on the one before it, so its channels go side by side ---- */

typedef int16_t lanes __attribute__((vector_size(16)));
typedef uint8_t narrow_lanes __attribute__((vector_size(8)));

/* texel (3 or 4) bytes to lanes, through a register: partial writes to memory would stall the read that
 * follows. */
static inline lanes load_texel(const unsigned char *p, size_t texel)
{
    uint64_t bits =
        p[0] | (uint64_t)p[1] << 8 | (uint64_t)p[2] << 16 | (texel == 4 ? (uint64_t)p[3] << 24 : 0);
    narrow_lanes bytes;
    memcpy(&bytes, &bits, sizeof bytes);
    return __builtin_convertvector(bytes, lanes);
}

static inline lanes store_texel(lanes x, unsigned char *p, size_t texel)
{
    narrow_lanes bytes = __builtin_convertvector(x & 0xff, narrow_lanes);
    uint64_t bits;
    memcpy(&bits, &bytes, sizeof bits);
    p[0] = (unsigned char)bits;
    p[1] = (unsigned char)(bits >> 8);
    p[2] = (unsigned char)(bits >> 16);
    if (texel == 4)
        p[3] = (unsigned char)(bits >> 24);
    return x & 0xff;
}

static inline lanes choose(lanes mask, lanes a, lanes b)
{
    return (mask & a) | (~mask & b);
}

static inline lanes magnitude(lanes x)
{
    lanes sign = x >> 15;
    return (x ^ sign) - sign;
}

static inline void unfilter_paeth(const unsigned char *filtered, const unsigned char *above, size_t size,
                                  size_t texel, unsigned char *out)
{
    lanes left = {0};
    lanes corner = {0};
    for (size_t k = 0; k < size; k += texel) {
        lanes up = load_texel(above + k, texel);
        lanes up_less = up - corner;
        lanes left_less = left - corner;
        lanes to_left = magnitude(up_less);
        lanes to_up = magnitude(left_less);
        lanes to_corner = magnitude(up_less + left_less);
        lanes nearest = choose(to_up <= to_corner, up, corner);
        nearest = choose((to_left <= to_up) & (to_left <= to_corner), left, nearest);
        left = store_texel(load_texel(filtered + k, texel) + nearest, out + k, texel);
        corner = up;
    }
}

static inline void unfilter_average(const unsigned char *filtered, const unsigned char *above, size_t size,
                                    size_t texel, unsigned char *out)
{
    lanes left = {0};
    for (size_t k = 0; k < size; k += texel)
        left = store_texel(load_texel(filtered + k, texel) + ((left + load_texel(above + k, texel)) >> 1),
                           out + k, texel);
}

static inline void unfilter_left(const unsigned char *filtered, size_t size, size_t texel, unsigned char *out)
{
    lanes left = {0};
    for (size_t k = 0; k < size; k += texel)
        left = store_texel(load_texel(filtered + k, texel) + left, out + k, texel);
}

/* Any filter, byte by byte. */
static void unfilter_bytes(png_filter filter, const unsigned char *filtered, const unsigned char *above,
                           size_t size, size_t texel, unsigned char *out)
{
    for (size_t k = 0; k < size; k++) {
        int left = k < texel ? 0 : out[k - texel];
        int corner = k < texel ? 0 : above[k - texel];
        int prediction = filter == PNG_LEFT      ? left
                         : filter == PNG_AVERAGE ? (left + above[k]) >> 1
                                                 : paeth(left, above[k], corner);
        out[k] = (unsigned char)(filtered[k] + prediction);
    }
}

void png_unfilter(png_filter filter, const unsigned char *filtered, const unsigned char *above, size_t size,
                  size_t texel, unsigned char *out)
{
    if (filter == PNG_NONE) {
        memmove(out, filtered, size);
    } else if (filter == PNG_UP) {
        for (size_t k = 0; k < size; k++)
            out[k] = (unsigned char)(filtered[k] + above[k]);
    } else if (texel == 3) {
        if (filter == PNG_LEFT)
            unfilter_left(filtered, size, 3, out);
        else if (filter == PNG_AVERAGE)
            unfilter_average(filtered, above, size, 3, out);
        else
            unfilter_paeth(filtered, above, size, 3, out);
    } else if (texel == 4) {
        if (filter == PNG_LEFT)
            unfilter_left(filtered, size, 4, out);
        else if (filter == PNG_AVERAGE)
            unfilter_average(filtered, above, size, 4, out);
        else
            unfilter_paeth(filtered, above, size, 4, out);
    } else {
        unfilter_bytes(filter, filtered, above, size, texel, out);
    }
}
