/* compare_source.h - the pixels of two images as the metrics see them: cropped, tone-mapped, over a
 * background, equal where the mask hides them, 0 where they are not finite. Pixels are read a few at a time;
 * nothing is copied. */
#ifndef COMPARE_COMPARE_SOURCE_H
#define COMPARE_COMPARE_SOURCE_H

#include "compare/compare.h"

/* An image and its reader. */
typedef struct compare_side {
    compare_image image;
    image_reader reader;
} compare_side;

typedef struct compare_source {
    compare_side a, b, mask;
    bool has_mask;                /* otherwise all pixels count */
    uint32_t x, y, width, height; /* the crop */
    bool is_display;              /* the metrics work in display space */
    bool has_opacity;             /* alpha is compared, and some pixel is not opaque */
    facet_tonemap tonemap;
    float scale; /* 2^exposure_ev */
    float background[3];
} compare_source;

typedef enum compare_values {
    COMPARE_LIGHT, /* linear, tone-mapped to [0, 1] in display space */
    COMPARE_CODES  /* the values that are compared: sRGB-encoded in display space */
} compare_values;

enum {
    COMPARE_COUNTS = 1, /* not hidden by the mask */
    COMPARE_INVALID = 2 /* NaN or infinity in one image only; both values are replaced by 0 */
};

/* Planes of count floats per channel, and the COMPARE_* flags of each pixel (NULL: not wanted). */
typedef struct compare_row {
    float *a[4], *b[4];
    unsigned char *flags;
} compare_row;

/* Resolves space, crop and compositing from desc; has_opacity is what desc->alpha asks for, before the pixels
 * are known. FACET_ERROR_ARGUMENT, _MEMORY. */
facet_result compare_source_open(const compare_image *a, const compare_image *b, const compare_image *mask,
                                 const facet_compare_desc *desc, compare_source *out, facet_error *error);
void compare_source_close(compare_source *s); /* {0} is allowed */

/* Loads pixels from (x, y) of the crop to the right; coordinates outside of the crop are clamped to it.
 * background (NULL: that of the source) is composited under them. */
void compare_source_load(const compare_source *s, compare_values values, const float background[3], int64_t x,
                         int64_t y, uint32_t count, const compare_row *out);

/* Source texels of both images. */
enum { COMPARE_TEXELS = 128 };
typedef struct compare_texels {
    const float *a, *b;          /* RGBA, linear, premultiplied */
    bool counts[COMPARE_TEXELS]; /* not hidden by the mask */
    float memory[2][4 * COMPARE_TEXELS];
} compare_texels;
/* Reads up to COMPARE_TEXELS texels from (x, y) to the right, inside the crop. */
void compare_source_read(const compare_source *s, uint32_t x, uint32_t y, uint32_t count,
                         compare_texels *out);

#endif
