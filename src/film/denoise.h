/* denoise.h - an image of few samples per pixel, made calm. */
#ifndef FILM_DENOISE_H
#define FILM_DENOISE_H

#include "film/film.h"

/* Filters layer "" of f in place, guided by its layers "albedo", "normal" and "variance", which it has (see facet_aov):
 * light is averaged where surface and color are the same, as widely as the variance asks for. Opacity
 * is a guide as well, and stays.
 * Biased: detail of light below the noise is lost. Does not depend on thread_count. Fails with FACET_ERROR_MEMORY,
 * FACET_ERROR_ARGUMENT where a layer is missing. */
facet_result film_denoise(film *f, const facet_allocator *allocator, uint32_t thread_count,
                          facet_error *error);

#endif
