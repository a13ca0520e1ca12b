/* compare.h - image metrics: errors per pixel, structural similarity (SSIM), perceived difference (FLIP). */
#ifndef COMPARE_COMPARE_H
#define COMPARE_COMPARE_H

#include "facet/facet.h"
#include "image/image.h"

/* An image to compare, as its file has it: a row is converted to linear, premultiplied RGBA where it is
 * needed. */
typedef struct compare_image {
    const image *texels;
    bool is_straight; /* the colors are not multiplied by alpha yet */
    bool is_display;  /* display-referred: neither tone mapping nor exposure applies */
} compare_image;

/* facet_compare() of bare images. desc->mask is ignored: mask (NULL: all pixels count) is given as an image.
 * difference (may be NULL) receives F32 RGBA, linear Rec.709. */
facet_result compare_images(const compare_image *a, const compare_image *b, const compare_image *mask,
                            const facet_compare_desc *desc, facet_comparison *out, image *difference,
                            facet_error *error);

/* Magma (Smith and van der Walt 2015), a perceptually uniform color map from black over purple, red and
 * orange to light yellow: sRGB-encoded color of an error, which is clamped to [0, 1]. */
void compare_magma(float error, float color[3]);

#endif
