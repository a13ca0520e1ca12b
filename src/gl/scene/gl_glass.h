/* gl_glass.h - the light behind the nearest transmissive surface of each pixel: rays are traced once for a pixel, before
 * the surfaces are drawn, which look it up. Otherwise each triangle in a pixel would trace its own. */
#ifndef GL_GL_GLASS_H
#define GL_GL_GLASS_H

#include "gl/core/gl_target.h"

typedef struct gl_glass {
    uint32_t width, height;
    uint32_t texture;     /* array, RGBA32F or RGBA16F: surface_io.glsl has its layers */
    uint32_t framebuffer; /* with all layers */
    uint32_t depth;       /* renderbuffer */
} gl_glass;

/* Binds the framebuffer, as large as the target, and clears it. Fails with FACET_ERROR_MEMORY, FACET_ERROR_SYSTEM. */
facet_result gl_glass_begin(gl_glass *glass, gl_context *context, const gl_target *target,
                            facet_error *error);
/* Binds the target's framebuffer again, and the texture to GL_UNIT_RAYS. */
void gl_glass_end(const gl_glass *glass, const gl_target *target);
void gl_glass_destroy(gl_glass *glass); /* {0} is allowed; leaves {0} */

#endif
