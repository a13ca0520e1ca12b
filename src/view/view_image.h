/* view_image.h - an image as in files for displays: sRGB, 8 bits, straight alpha, rows from the top. */
#ifndef VIEW_VIEW_IMAGE_H
#define VIEW_VIEW_IMAGE_H

#include "facet/facet.h"

typedef struct view_image {
    uint32_t width, height;
    unsigned char *pixels; /* RGBA; a block of mem_alloc() */
} view_image;

/* From a developed image: linear, premultiplied. FACET_ERROR_MEMORY. */
facet_result view_image_create(const facet_image_view *linear, const facet_allocator *allocator,
                               view_image *out, facet_error *error);
void view_image_destroy(view_image *p); /* {0} is allowed */
/* The inverse, a block of mem_alloc(): linear, premultiplied RGBA, from which facet_image_save() writes
 * the same values again. NULL: out of memory. */
float *view_image_to_linear(const view_image *p, const facet_allocator *allocator);

#endif
