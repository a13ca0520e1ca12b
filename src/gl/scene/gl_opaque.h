/* gl_opaque.h - what surfaces that let light through see behind them: the picture of what is opaque, without the
 * background, and its blurred halves (transmission.glsl). */
#ifndef GL_GL_OPAQUE_H
#define GL_GL_OPAQUE_H

#include "gl/core/gl_pyramid.h"
#include "gl/core/gl_target.h"

typedef struct gl_opaque {
    gl_pyramid pyramid; /* premultiplied radiance as the target has it; where nothing is, nothing */
} gl_opaque;

/* Takes over what has been drawn into the target, which is bound again afterwards. Fails with FACET_ERROR_MEMORY,
 * FACET_ERROR_SYSTEM. */
facet_result gl_opaque_take(gl_opaque *opaque, gl_context *context, const gl_pyramid_brush *brush,
                            const gl_target *target, facet_error *error);
/* Binds it to its unit. */
void gl_opaque_bind(const gl_opaque *opaque);
void gl_opaque_destroy(gl_opaque *opaque); /* {0} is allowed; leaves {0} */

#endif
