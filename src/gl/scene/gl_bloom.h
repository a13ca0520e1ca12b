/* gl_bloom.h - light that a lens spreads around what is bright. */
#ifndef GL_GL_BLOOM_H
#define GL_GL_BLOOM_H

#include "gl/core/gl_pyramid.h"
#include "gl/core/gl_target.h"

typedef struct gl_bloom {
    gl_pyramid pyramid;
} gl_bloom;

/* Spreads a share, in (0, 1], of the light of a resolved picture, its coverage with it: over any even background that is the
 * same as if the background had been there. The sum of light stays what it is, but for what the picture's border keeps
 * in. Fails with FACET_ERROR_MEMORY, FACET_ERROR_SYSTEM. */
facet_result gl_bloom_draw(gl_bloom *bloom, gl_context *context, const gl_pyramid_brush *brush,
                           const gl_target *target, float share, facet_error *error);
void gl_bloom_destroy(gl_bloom *bloom); /* {0} is allowed; leaves {0} */

#endif
