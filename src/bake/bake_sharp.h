/* bake_sharp.h - the environment itself as a cube map: level 0 of mirrors, and what samples are looked up in. */
#ifndef BAKE_BAKE_SHARP_H
#define BAKE_BAKE_SHARP_H

#include "bake/bake_source.h"
#include "ibl/cube.h"

/* Fills out (its size is set), borders included: bake.h says how. FACET_ERROR_MEMORY. */
facet_result bake_sharp(const bake_source *source, float scale, const facet_allocator *allocator,
                        uint32_t thread_count, cube *out, facet_error *error);

/* From the faces of the source as they are, not from its picture: they are there, not turned, and fit. */
bool bake_sharp_is_of_faces(const bake_source *source, uint32_t size);
/* Texels are smaller than the picture's, and are interpolated. */
bool bake_sharp_is_interpolated(const bake_source *source, uint32_t size);

#endif
