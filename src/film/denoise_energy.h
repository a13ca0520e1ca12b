/* denoise_energy.h - gives a filtered picture the light back that it lost on the way. */
#ifndef FILM_DENOISE_ENERGY_H
#define FILM_DENOISE_ENERGY_H

#include "film/denoise_planes.h"

/* Scales filtered, 4 floats per pixel: RGB in the unit of f, and above 0 where the pixel was filtered, so that regions of some
 * 50 pixels have the light that f has there, as far as that is not chance. FACET_ERROR_MEMORY. */
facet_result denoise_restore_energy(const film *f, float *filtered, const facet_allocator *allocator,
                                    uint32_t thread_count, facet_error *error);

#endif
