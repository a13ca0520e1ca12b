/* gl_opaque.c - see gl_opaque.h. The background is left out because what glass shows of it lies elsewhere: a ray that meets
 * nothing sees the environment in its direction, as it does on the CPU. */
#include "gl/scene/gl_opaque.h"

#include <epoxy/gl.h>

#include "gl/core/gl_blocks.h"

facet_result gl_opaque_take(gl_opaque *o, gl_context *context, const gl_pyramid_brush *brush,
                            const gl_target *target, facet_error *error)
{
    facet_result result = gl_pyramid_update(&o->pyramid, context, target->width, target->height, 0, error);
    if (result == FACET_OK) {
        gl_target_resolve(target);
        result = gl_pyramid_fill(&o->pyramid, brush, target->color, error);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, target->framebuffer);
    glViewport(0, 0, (GLsizei)target->width, (GLsizei)target->height);
    glEnable(GL_DEPTH_TEST);
    return result;
}

void gl_opaque_bind(const gl_opaque *o)
{
    glActiveTexture(GL_TEXTURE0 + GL_UNIT_OPAQUE);
    glBindTexture(GL_TEXTURE_2D, o->pyramid.texture);
}

void gl_opaque_destroy(gl_opaque *o)
{
    gl_pyramid_destroy(&o->pyramid);
}
