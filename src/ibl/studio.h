/* studio.h - the built-in light: soft boxes in a grey room. */
#ifndef IBL_STUDIO_H
#define IBL_STUDIO_H

#include "facet/facet.h"
#include "image/image.h"

/* An equirectangular picture, F32 RGB, grey, of mean radiance 1 cd/m^2. FACET_ERROR_MEMORY. */
facet_result studio_create(const facet_allocator *allocator, uint32_t thread_count, image *out,
                           facet_error *error);

#endif
