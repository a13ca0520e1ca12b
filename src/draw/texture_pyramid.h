/* texture_pyramid.h - the mips of one image, stored for reading it as colors or as data. */
#ifndef DRAW_TEXTURE_PYRAMID_H
#define DRAW_TEXTURE_PYRAMID_H

#include "image/image.h"

enum { TEXTURE_MAX_LEVELS = 32 };
/* the error of lossy codecs around 0, and an invisible amount of light */
#define TEXTURE_BLACK (4.0f / 255.0f)

/* Conversion tables from and to 8-bit codes. One per texture_set. */
typedef struct texture_tables {
    float color[256], data[256];        /* linear value of a code, read as sRGB and as data */
    uint16_t color16[256], data16[256]; /* the same times 65535, rounded */
    unsigned char color_from_16[65536]; /* code of a linear color times 65535 */
} texture_tables;

void texture_tables_fill(texture_tables *tables);

typedef struct texture_level {
    const unsigned char *texels; /* rows without padding */
    uint32_t width, height;
    float size[2]; /* the same as floats, for sampling */
} texture_level;

/* Level n has max(1, size >> n) texels along an axis of size texels, as in OpenGL. 8-bit images keep their
 * codes (colors in sRGB); 16-bit ones are always linear. */
typedef struct texture_pyramid {
    uint32_t width, height;            /* of the full image, level 0 */
    float texel_size[2];               /* 1 / width, 1 / height */
    uint32_t first_level, level_count; /* levels first_level to level_count - 1 exist */
    uint32_t channel_count;
    image_type type; /* IMAGE_U8 or IMAGE_U16 */
    bool lacks_red;  /* of data: no texel of the finest level has red above TEXTURE_BLACK */
    const float *color_values, *alpha_values; /* IMAGE_U8: values of the codes */
    texture_level levels[TEXTURE_MAX_LEVELS];
    void *blocks[2]; /* of mem_alloc(): the finest level, the others */
} texture_pyramid;

/* Number of levels of an image of that size. */
uint32_t texture_level_count(uint32_t width, uint32_t height);

/* Builds the levels from first_level on.
 *
 * source       level number source_level <= first_level of an image of width x height texels, U8 or U16; taken
 *              over, also on failure: it is {0} afterwards
 * first_level  less than texture_level_count()
 * as_color     color channels are decoded from sRGB before they are averaged, alpha is not
 * tables       must live as long as out
 * Filter       each texel of a level is the mean of what it covers of the next finer one: 2 x 2 texels, or 3 with
 *              polyphase weights along an odd edge (Guthe and Heckbert 2005), so that the mean of the image is that
 *              of every level. Levels follow from each other in 16 bits and are rounded to 8 once.
 * Fails        FACET_ERROR_MEMORY */
facet_result texture_pyramid_create(image *source, uint32_t source_level, uint32_t width, uint32_t height,
                                    uint32_t first_level, bool as_color, const texture_tables *tables,
                                    const facet_allocator *allocator, texture_pyramid *out,
                                    facet_error *error);

/* The same pyramid from an image that arrives row by row, as from a decoder: only a few rows are held
 * besides the result. */
typedef struct texture_growth texture_growth;

/* header: the whole image (level 0), U8 or U16; its pixels are not read. first_level: at least 1, less than
 * texture_level_count(). out must not move until it is complete. Fails with FACET_ERROR_MEMORY. */
facet_result texture_growth_create(const image *header, uint32_t first_level, bool as_color,
                                   const texture_tables *tables, const facet_allocator *allocator,
                                   texture_pyramid *out, texture_growth **grown, facet_error *error);
/* The next row from the top. After the last one the pyramid is complete. */
void texture_growth_add_row(texture_growth *g, const void *texels);
void texture_growth_destroy(texture_growth *g); /* NULL is allowed; the pyramid stays */

void texture_pyramid_destroy(texture_pyramid *p); /* {0} is allowed; leaves {0} */

#endif
