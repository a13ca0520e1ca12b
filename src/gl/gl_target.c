/* gl_target.c - see gl_target.h. */
#include "gl/gl_target.h"

#include <epoxy/gl.h>

#include "base/result.h"

void gl_target_destroy(gl_target *t)
{
    if (t->framebuffer)
        glDeleteFramebuffers(1, &t->framebuffer);
    if (t->resolved_framebuffer && t->resolved_framebuffer != t->framebuffer)
        glDeleteFramebuffers(1, &t->resolved_framebuffer);
    glDeleteTextures(1, &t->color);
    glDeleteTextures(1, &t->depth);
    glDeleteRenderbuffers(2, t->renderbuffers);
    *t = (gl_target){0};
}

static GLuint make_texture(GLenum format, uint32_t width, uint32_t height)
{
    GLuint name;
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    GLenum layout = format == GL_DEPTH_COMPONENT32F ? GL_DEPTH_COMPONENT : GL_RGBA;
    GLenum type = format == GL_DEPTH_COMPONENT32F ? GL_FLOAT
                  : format == GL_RGBA32F          ? GL_FLOAT
                                                  : GL_HALF_FLOAT;
    glTexImage2D(GL_TEXTURE_2D, 0, (GLint)format, (GLsizei)width, (GLsizei)height, 0, layout, type, NULL);
    GLint filter = layout == GL_RGBA ? GL_LINEAR : GL_NEAREST;
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return name;
}

static GLuint make_renderbuffer(GLenum format, uint32_t width, uint32_t height, uint32_t samples)
{
    GLuint name;
    glGenRenderbuffers(1, &name);
    glBindRenderbuffer(GL_RENDERBUFFER, name);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, (GLsizei)samples, format, (GLsizei)width,
                                     (GLsizei)height);
    return name;
}

static void make(gl_target *t, GLenum format)
{
    t->color = make_texture(format, t->width, t->height);
    glGenFramebuffers(1, &t->framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, t->framebuffer);
    if (t->samples == 1) {
        t->depth = make_texture(GL_DEPTH_COMPONENT32F, t->width, t->height);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, t->color, 0);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, t->depth, 0);
        t->resolved_framebuffer = t->framebuffer;
        return;
    }
    t->renderbuffers[0] = make_renderbuffer(format, t->width, t->height, t->samples);
    t->renderbuffers[1] = make_renderbuffer(GL_DEPTH_COMPONENT32F, t->width, t->height, t->samples);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, t->renderbuffers[0]);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, t->renderbuffers[1]);
    glGenFramebuffers(1, &t->resolved_framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, t->resolved_framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, t->color, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, t->framebuffer);
}

facet_result gl_target_update(gl_target *t, gl_context *context, uint32_t width, uint32_t height,
                              uint32_t samples, facet_error *error)
{
    uint32_t most = (uint32_t)context->max_texture_size;
    if (width > most || height > most)
        return fail(error, FACET_ERROR_LIMIT,
                    "OpenGL (%s): a picture of %u x %u pixels; the most are %u x %u", context->name, width,
                    height, most, most);
    samples = samples > (uint32_t)context->max_samples ? (uint32_t)context->max_samples
              : samples                                ? samples
                                                       : 1;
    if (t->framebuffer && t->width == width && t->height == height && t->samples == samples)
        return FACET_OK;
    static const GLenum formats[] = {GL_RGBA32F, GL_RGBA16F};
    for (int i = 0; i < 2; i++) {
        gl_target_destroy(t);
        *t = (gl_target){.width = width, .height = height, .samples = samples};
        make(t, formats[i]);
        if (glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE)
            return gl_context_check(context, "picture", error);
    }
    gl_target_destroy(t);
    return fail(error, FACET_ERROR_ENVIRONMENT, "OpenGL (%s): floating point pictures cannot be drawn",
                context->name);
}

void gl_target_resolve(const gl_target *t)
{
    if (t->framebuffer == t->resolved_framebuffer)
        return;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, t->framebuffer);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, t->resolved_framebuffer);
    GLint w = (GLint)t->width, h = (GLint)t->height;
    glBlitFramebuffer(0, 0, w, h, 0, 0, w, h, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}
