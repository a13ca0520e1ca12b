/* gl_target.c - see gl_target.h. */
#include "gl/core/gl_target.h"

#include "base/result.h"
#include "gl/core/gl_api.h"

void gl_target_destroy(gl_target *t)
{
    if (t->framebuffer)
        glDeleteFramebuffers(1, &t->framebuffer);
    if (t->resolved_framebuffer && t->resolved_framebuffer != t->framebuffer)
        glDeleteFramebuffers(1, &t->resolved_framebuffer);
    glDeleteTextures(1, &t->color);
    glDeleteTextures(GL_TARGET_LAYERS - 1, t->layers);
    glDeleteTextures(1, &t->depth);
    glDeleteRenderbuffers(2, t->renderbuffers);
    *t = (gl_target){.width = 0};
}

/* Point-sampled, so it also works where float textures cannot be filtered. Left bound to no unit: where a
 * program has a sampler for it that the draw does not need, browsers refuse to draw into it. */
static GLuint make_texture(GLenum format, uint32_t width, uint32_t height)
{
    GLuint name;
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    bool is_depth = format == GL_DEPTH_COMPONENT32F;
    GLenum type = format == GL_RGBA8 ? GL_UNSIGNED_BYTE : format == GL_RGBA16F ? GL_HALF_FLOAT : GL_FLOAT;
    glTexImage2D(GL_TEXTURE_2D, 0, (GLint)format, (GLsizei)width, (GLsizei)height, 0,
                 is_depth ? GL_DEPTH_COMPONENT : GL_RGBA, type, NULL);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glBindTexture(GL_TEXTURE_2D, 0);
    return name;
}

static GLuint make_renderbuffer(GLenum format, const gl_target *t)
{
    GLuint name;
    glGenRenderbuffers(1, &name);
    glBindRenderbuffer(GL_RENDERBUFFER, name);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, (GLsizei)t->samples, format, (GLsizei)t->width,
                                     (GLsizei)t->height);
    return name;
}

static void attach(GLenum where, GLuint texture)
{
    glFramebufferTexture2D(GL_FRAMEBUFFER, where, GL_TEXTURE_2D, texture, 0);
}

static void make_layers(gl_target *t)
{
    GLenum buffers[GL_TARGET_LAYERS] = {GL_COLOR_ATTACHMENT0};
    for (GLuint i = 1; i < GL_TARGET_LAYERS; i++) {
        t->layers[i - 1] = make_texture(t->format, t->width, t->height);
        attach(GL_COLOR_ATTACHMENT0 + i, t->layers[i - 1]);
        buffers[i] = GL_COLOR_ATTACHMENT0 + i;
    }
    glDrawBuffers(GL_TARGET_LAYERS, buffers);
}

static void make(gl_target *t)
{
    if (t->samples == 1 || t->kind != GL_TARGET_DISPLAY)
        t->color = make_texture(t->format, t->width, t->height);
    glGenFramebuffers(1, &t->framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, t->framebuffer);
    if (t->samples == 1) {
        t->depth = make_texture(GL_DEPTH_COMPONENT32F, t->width, t->height);
        attach(GL_COLOR_ATTACHMENT0, t->color);
        attach(GL_DEPTH_ATTACHMENT, t->depth);
        if (t->kind == GL_TARGET_LAYERED)
            make_layers(t);
        t->resolved_framebuffer = t->framebuffer;
        return;
    }
    t->renderbuffers[0] = make_renderbuffer(t->format, t);
    t->renderbuffers[1] = make_renderbuffer(GL_DEPTH_COMPONENT32F, t);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, t->renderbuffers[0]);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, t->renderbuffers[1]);
    if (!t->color)
        return;
    glGenFramebuffers(1, &t->resolved_framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, t->resolved_framebuffer);
    attach(GL_COLOR_ATTACHMENT0, t->color);
    glBindFramebuffer(GL_FRAMEBUFFER, t->framebuffer);
}

/* Renderable formats of the driver, the preferred one first. */
static int list_formats(const gl_context *context, gl_target_kind kind, GLenum formats[2])
{
    bool prefers_half = kind == GL_TARGET_WINDOW;
    int count = 0;
    if (kind == GL_TARGET_DISPLAY)
        formats[count++] = GL_RGBA8;
    for (int i = 0; i < 2 && kind != GL_TARGET_DISPLAY; i++) {
        bool is_half = prefers_half == (i == 0);
        if (is_half ? context->has_half_target : context->has_float_target)
            formats[count++] = is_half ? GL_RGBA16F : GL_RGBA32F;
    }
    return count;
}

facet_result gl_target_update(gl_target *t, gl_context *context, gl_target_kind kind, uint32_t width,
                              uint32_t height, uint32_t samples, facet_error *error)
{
    uint32_t most = (uint32_t)context->max_texture_size;
    if (width > most || height > most)
        return fail(error, FACET_ERROR_LIMIT,
                    "OpenGL (%s): an image of %u x %u pixels; the maximum is %u x %u", context->name, width,
                    height, most, most);
    if (samples > (uint32_t)context->max_samples)
        samples = (uint32_t)context->max_samples;
    if (samples == 0 || kind == GL_TARGET_LAYERED)
        samples = 1;
    if (t->framebuffer && t->kind == kind && t->width == width && t->height == height &&
        t->samples == samples)
        return FACET_OK;
    GLenum formats[2];
    int format_count = list_formats(context, kind, formats);
    for (int i = 0; i < format_count; i++) {
        gl_target_destroy(t);
        *t = (gl_target){
            .kind = kind, .width = width, .height = height, .samples = samples, .format = formats[i]};
        make(t);
        facet_result result = gl_context_check(context, "the image", error);
        if (result == FACET_OK && glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE)
            return FACET_OK;
        if (result == FACET_ERROR_MEMORY) {
            gl_target_destroy(t);
            return result;
        }
    }
    gl_target_destroy(t);
    return fail(error, FACET_ERROR_SYSTEM, "OpenGL (%s): floating point images cannot be rendered",
                context->name);
}

void gl_target_resolve(const gl_target *t)
{
    gl_target_resolve_area(t, (int[4]){0, 0, (int)t->width, (int)t->height});
}

void gl_target_resolve_area(const gl_target *t, const int area[4])
{
    if (t->framebuffer != t->resolved_framebuffer)
        gl_target_resolve_into(t, t->resolved_framebuffer, area);
}

void gl_target_resolve_into(const gl_target *t, uint32_t framebuffer, const int area[4])
{
    glBindFramebuffer(GL_READ_FRAMEBUFFER, t->framebuffer);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
    GLint right = area[0] + area[2], top = area[1] + area[3];
    glBlitFramebuffer(area[0], area[1], right, top, area[0], area[1], right, top, GL_COLOR_BUFFER_BIT,
                      GL_NEAREST);
}

void gl_target_read(const gl_target *t, uint32_t layer, uint32_t x, uint32_t y, uint32_t width,
                    uint32_t height, float *pixels)
{
    glBindFramebuffer(GL_READ_FRAMEBUFFER, t->resolved_framebuffer);
    glReadBuffer(GL_COLOR_ATTACHMENT0 + layer);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels((GLint)x, (GLint)y, (GLsizei)width, (GLsizei)height, GL_RGBA, GL_FLOAT, pixels);
    glReadBuffer(GL_COLOR_ATTACHMENT0);
}
