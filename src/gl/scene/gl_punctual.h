/* gl_punctual.h - punctual lights and the grid that says where they reach (light_grid.h), as one texture.
 *
 * Rows of GL_LIGHT_ROW texels of four 32-bit words, one behind the other: four texels per light (position and range, spot's
 * direction and scale, intensity and spot's offset, whether it is directional and where its shadow's record is), records of
 * shadows (gl_shadow.h), then lists of numbers (four a texel: the
 * lights that reach everywhere, then those of the cells), then the cells (two a texel: first and end of the list). Positions
 * stay those of the world, so that a camera that moves costs nothing. A lookup of a point costs one texel for its cell, each
 * light one for its number and four for itself: a thousand lights with a range cost what the few near the point cost. */
#ifndef GL_GL_PUNCTUAL_H
#define GL_GL_PUNCTUAL_H

#include "draw/light_setup.h"
#include "gl/core/gl_context.h"
#include "gl/scene/gl_light_block.h"

struct gl_shadow; /* gl_shadow.h */

typedef struct gl_punctual {
    uint32_t texture;
    uint32_t *words; /* what was uploaded */
    uint32_t rows;
} gl_punctual;

/* Uploads what has changed, and says where it is. Fails with FACET_ERROR_MEMORY, FACET_ERROR_LIMIT (millions of lights). */
facet_result gl_punctual_update(gl_punctual *punctual, gl_context *context, const facet_allocator *allocator,
                                const light_setup *setup, const struct gl_shadow *shadow,
                                gl_light_block *block, facet_error *error);
void gl_punctual_destroy(gl_punctual *punctual); /* {0} is allowed; leaves {0} */

#endif
