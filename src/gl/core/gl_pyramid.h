/* gl_pyramid.h - a picture and its halves: half floats, each level a filtered half of the one before. */
#ifndef GL_GL_PYRAMID_H
#define GL_GL_PYRAMID_H

#include "gl/core/gl_program.h"
#include "gl/core/gl_target.h"

typedef struct gl_pyramid {
    uint32_t width, height,
        level_count;      /* of level 0; each next one is half as large, rounded down, at least 1 */
    uint32_t texture;     /* RGBA16F, trilinear, without repetition */
    uint32_t framebuffer; /* to draw into one of its levels */
} gl_pyramid;

/* What its passes draw with. */
typedef struct gl_pyramid_brush {
    gl_programs *programs;
    uint32_t empty_array; /* vertices of what covers the picture */
} gl_pyramid_brush;

/* Resolves the target and takes over what has been drawn into it so far: the opaque surfaces, without a background, premultiplied.
 * The target is bound again afterwards. Fails with FACET_ERROR_MEMORY, FACET_ERROR_SYSTEM. */
facet_result gl_pyramid_take_opaque(gl_pyramid *pyramid, gl_context *context, const gl_pyramid_brush *brush,
                                    const gl_target *target, facet_error *error);
void gl_pyramid_bind_opaque(const gl_pyramid *pyramid); /* to GL_UNIT_OPAQUE */

/* Spreads a share, in (0, 1], of the light and coverage of a resolved image. Over an even background the result is the same as
 * if the background had been there. Energy is kept, except at the border of the image, which reflects none. Fails with
 * FACET_ERROR_MEMORY, FACET_ERROR_SYSTEM. */
facet_result gl_pyramid_bloom(gl_pyramid *pyramid, gl_context *context, const gl_pyramid_brush *brush,
                              const gl_target *target, float share, facet_error *error);

void gl_pyramid_destroy(gl_pyramid *pyramid); /* {0} is allowed; leaves {0} */

#endif
