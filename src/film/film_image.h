/* film_image.h - conversion of films to images for files. */
#ifndef FILM_FILM_IMAGE_H
#define FILM_FILM_IMAGE_H

#include "film/film.h"
#include "image/image.h"

/* For display-referred files: IMAGE_U8 or IMAGE_U16, sRGB, rounded to nearest, RGBA with straight alpha; RGB
 * over white if has_alpha is false, RGB also if every pixel is opaque. */
facet_result film_to_display_image(const film *f, image_type type, bool has_alpha,
                                   const facet_allocator *allocator, uint32_t thread_count, image *out,
                                   facet_error *error);

/* For linear files without alpha: IMAGE_F32 RGB, over black. */
facet_result film_to_linear_image(const film *f, const facet_allocator *allocator, uint32_t thread_count,
                                  image *out, facet_error *error);

#endif
