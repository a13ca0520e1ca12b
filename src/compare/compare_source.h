/* compare_source.h - the pixels of two images as they are compared: the crop, tone-mapped, over a background, what the
 * mask leaves out made equal, and what is no number taken out. Read a row at a time; nothing is copied. */
#ifndef COMPARE_COMPARE_SOURCE_H
#define COMPARE_COMPARE_SOURCE_H

#include "compare/compare.h"

/* One of the images with what its rows are read by. */
typedef struct compare_side {
    compare_image image;
    image_reader reader;
} compare_side;

typedef struct compare_source {
    compare_side a, b, mask;
    bool has_mask;                /* else all pixels count */
    uint32_t x, y, width, height; /* the crop */
    bool is_display;              /* the space */
    bool has_opacity;             /* is compared: alpha is a channel and some pixel is not opaque */
    facet_tonemap tonemap;
    float scale; /* 2^exposure_ev */
    float background[3];
} compare_source;

typedef enum compare_values {
    COMPARE_LIGHT, /* linear; in display space tone-mapped and in [0, 1] */
    COMPARE_CODES  /* the numbers that are compared: in display space light encoded as sRGB */
} compare_values;

enum {
    COMPARE_COUNTS = 1, /* the mask lets it count */
    COMPARE_INVALID = 2 /* NaN or infinity that is not the same in both: both are 0 here */
};

/* Channels of count pixels, planes of floats, and COMPARE_* of each (NULL: not wanted). */
typedef struct compare_row {
    float *a[4], *b[4];
    unsigned char *flags;
} compare_row;

/* The space, crop and all else that desc says of the images; has_opacity is what alpha asks for, before the pixels were
 * looked at. FACET_ERROR_ARGUMENT, _MEMORY. */
facet_result compare_source_open(const compare_image *a, const compare_image *b, const compare_image *mask,
                                 const facet_compare_desc *desc, compare_source *out, facet_error *error);
void compare_source_close(compare_source *s); /* {0} is allowed */

/* The pixels from (x, y) of the crop to the right. Those outside of the crop are its nearest ones. background replaces that
 * of the source where it is not NULL. */
void compare_source_load(const compare_source *s, compare_values values, const float background[3], int64_t x,
                         int64_t y, uint32_t count, const compare_row *out);

/* Texels of both images before anything is done to them. */
enum { COMPARE_TEXELS = 128 };
typedef struct compare_texels {
    const float *a, *b;          /* RGBA, linear, premultiplied */
    bool counts[COMPARE_TEXELS]; /* by the mask */
    float memory[2][4 * COMPARE_TEXELS];
} compare_texels;
/* Up to COMPARE_TEXELS of them from (x, y) to the right, inside the crop. */
void compare_source_read(const compare_source *s, uint32_t x, uint32_t y, uint32_t count,
                         compare_texels *out);

#endif
