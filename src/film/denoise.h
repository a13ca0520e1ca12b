/* denoise.h - denoising of Monte Carlo renderings with few samples per pixel. */
#ifndef FILM_DENOISE_H
#define FILM_DENOISE_H

#include "film/film.h"

/* Filters layer "" of f in place, guided by the layers "albedo", "normal" and "variance" and by opacity,
 * which stays as it is: radiance is averaged where surface and color agree, as widely as the variance asks
 * for. Biased: detail below the noise is lost. The result does not depend on thread_count.
 * FACET_ERROR_MEMORY; FACET_ERROR_ARGUMENT if a layer is missing. */
facet_result film_denoise(film *f, const facet_allocator *allocator, uint32_t thread_count,
                          facet_error *error);

#endif
