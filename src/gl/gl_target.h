/* gl_target.h - what is drawn into: radiance, half floats, several samples a pixel; and what is made of it. */
#ifndef GL_GL_TARGET_H
#define GL_GL_TARGET_H

#include "gl/gl_context.h"

typedef struct gl_target {
    uint32_t width, height, samples; /* samples 1: color is what is drawn into */
    uint32_t framebuffer;            /* to draw into: color and depth */
    uint32_t resolved_framebuffer;   /* one sample */
    uint32_t color; /* texture of the resolved picture: RGBA16F, or RGBA32F where that can be drawn into */
    uint32_t renderbuffers[2]; /* color and depth of several samples */
    uint32_t depth;            /* texture, of one sample */
} gl_target;

/* Makes it, or makes it anew where size or samples differ. samples: as many or the next fewer that OpenGL has. Fails with
 * FACET_ERROR_MEMORY, FACET_ERROR_LIMIT (larger than OpenGL's textures). */
facet_result gl_target_update(gl_target *target, gl_context *context, uint32_t width, uint32_t height,
                              uint32_t samples, facet_error *error);
void gl_target_destroy(gl_target *target); /* {0} is allowed */
void gl_target_resolve(const gl_target *target);

#endif
