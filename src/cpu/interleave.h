/* interleave.h - interleaved sampling (Keller and Heidrich 2001): each pixel of a 4 x 4 square has its own part of a set
 * of samples, and a filter in which all sixteen parts have the same weight joins the pixels around. */
#ifndef CPU_INTERLEAVE_H
#define CPU_INTERLEAVE_H

#include <stdint.h>

enum { INTERLEAVE_SIDE = 4, INTERLEAVE_PARTS = INTERLEAVE_SIDE * INTERLEAVE_SIDE };

/* The part of a pixel: neighbors have parts that are far apart. Bayer 1973. */
static inline uint32_t interleave_part(uint32_t x, uint32_t y)
{
    static const uint8_t parts[INTERLEAVE_SIDE][INTERLEAVE_SIDE] = {
        {0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};
    return parts[y % INTERLEAVE_SIDE][x % INTERLEAVE_SIDE];
}

/* Weights of the pixels -2 .. 2 away along an axis: of those with the same part together 1/4. */
static const float INTERLEAVE_WEIGHTS[5] = {0.125f, 0.25f, 0.25f, 0.25f, 0.125f};

#endif
