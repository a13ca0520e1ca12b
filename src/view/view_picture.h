/* view_picture.h - a picture as files for displays have it: sRGB, 8 bits, straight alpha, rows from the top. */
#ifndef VIEW_VIEW_PICTURE_H
#define VIEW_VIEW_PICTURE_H

#include "facet/facet.h"

typedef struct view_picture {
    uint32_t width, height;
    unsigned char *pixels; /* RGBA; a block of mem_alloc() */
} view_picture;

/* From a developed picture: linear, premultiplied. FACET_ERROR_MEMORY. */
facet_result view_picture_create(const facet_image_view *linear, const facet_allocator *allocator,
                                 view_picture *out, facet_error *error);
void view_picture_destroy(view_picture *p); /* {0} is allowed */
/* The same backwards, a block of mem_alloc(): linear, premultiplied RGBA, from which facet_image_save() makes the same
 * numbers again. NULL: no memory. */
float *view_picture_to_linear(const view_picture *p, const facet_allocator *allocator);

#endif
