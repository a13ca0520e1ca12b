/* studio_draw.h - the built-in studio as a panorama, and its harmonics. */
#ifndef IBL_STUDIO_DRAW_H
#define IBL_STUDIO_DRAW_H

#include "ibl/harmonics.h"

/* Of 512 x 256 texels, grey. Fails with FACET_ERROR_MEMORY. */
facet_result studio_draw(const facet_allocator *allocator, uint32_t thread_count, image *out,
                         facet_error *error);

enum { STUDIO_DEGREE = 160, STUDIO_COEFFICIENTS = (STUDIO_DEGREE + 1) * (STUDIO_DEGREE + 2) / 2 };

/* What harmonics_create() finds in that panorama for STUDIO_DEGREE, computed when facet is built: the analysis takes a
 * twentieth of the time of a small image. Fails with FACET_ERROR_MEMORY. */
facet_result studio_harmonics(const image *panorama, const facet_allocator *allocator, uint32_t thread_count,
                              harmonics *out, facet_error *error);

#endif
