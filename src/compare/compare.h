/* compare.h - how far two pictures are from each other: errors per pixel, structure, and what an eye sees. */
#ifndef COMPARE_COMPARE_H
#define COMPARE_COMPARE_H

#include "facet/facet.h"

/* RGBA, linear Rec.709, premultiplied; rows without padding. */
typedef struct compare_picture {
    const float *rgba;
    uint32_t width, height;
    bool is_display; /* the colors are those of a screen: no tone mapping, no exposure */
} compare_picture;

/* The difference picture: RGBA as compare_picture has it. */
typedef struct compare_difference {
    float *rgba; /* block of mem_alloc() */
    uint32_t width, height;
} compare_difference;

/* facet_compare() on bare pixels. desc->mask is not read: mask (NULL: all pixels count) is the picture itself.
 * difference: NULL: not wanted. */
facet_result compare_pictures(const compare_picture *a, const compare_picture *b, const compare_picture *mask,
                              const facet_compare_desc *desc, facet_comparison *out,
                              compare_difference *difference, facet_error *error);

/* The colors of errors from 0 to 1, sRGB-encoded: magma (Smith and van der Walt 2015), from black over purple, red and
 * orange to light yellow, evenly perceived. What lies outside is clamped. */
void compare_magma(float error, float color[3]);

#endif
