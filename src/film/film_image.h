/* film_image.h - films to images for files. */
#ifndef FILM_FILM_IMAGE_H
#define FILM_FILM_IMAGE_H

#include "film/film.h"
#include "image/image.h"

/* The image as files for displays have it: IMAGE_U8 or IMAGE_U16, sRGB, rounded to nearest, RGBA with straight
 * alpha; RGB over white where has_alpha is false, and also where every pixel is opaque. */
facet_result film_to_display_image(const film *f, image_type type, bool has_alpha,
                                   const facet_allocator *allocator, uint32_t thread_count, image *out,
                                   facet_error *error);

/* The image as linear files without alpha have it: IMAGE_F32 RGB, over black. */
facet_result film_to_linear_image(const film *f, const facet_allocator *allocator, uint32_t thread_count,
                                  image *out, facet_error *error);

#endif
