/* gl_glass.c - see gl_glass.h. */
#include "gl/scene/gl_glass.h"

#include "gl/core/gl_api.h"
#include "gl/core/gl_blocks.h"

enum { LAYERS = 3 };

static void bind_texture(const gl_glass *g)
{
    glActiveTexture(GL_TEXTURE0 + GL_UNIT_RAYS);
    glBindSampler(GL_UNIT_RAYS, 0);
    glBindTexture(GL_TEXTURE_2D_ARRAY, g->texture);
}

static void make(gl_glass *g, bool is_half)
{
    static const GLenum buffers[LAYERS] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2};
    glGenTextures(1, &g->texture);
    bind_texture(g);
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, is_half ? GL_RGBA16F : GL_RGBA32F, (GLsizei)g->width,
                 (GLsizei)g->height, LAYERS, 0, GL_RGBA, is_half ? GL_HALF_FLOAT : GL_FLOAT, NULL);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, 0);
    glGenRenderbuffers(1, &g->depth);
    glBindRenderbuffer(GL_RENDERBUFFER, g->depth);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, (GLsizei)g->width, (GLsizei)g->height);
    glGenFramebuffers(1, &g->framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, g->framebuffer);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, g->depth);
    for (int i = 0; i < LAYERS; i++)
        glFramebufferTextureLayer(GL_FRAMEBUFFER, buffers[i], g->texture, 0, i);
    glDrawBuffers(LAYERS, buffers);
}

static facet_result update(gl_glass *g, gl_context *context, const gl_target *target, facet_error *error)
{
    if (g->texture && g->width == target->width && g->height == target->height)
        return FACET_OK;
    gl_glass_destroy(g);
    *g = (gl_glass){.width = target->width, .height = target->height};
    make(g, !context->has_float_target);
    facet_result result = gl_context_check_framebuffer(context, "the light behind glass",
                                                       "floating point images cannot be rendered", error);
    if (result != FACET_OK)
        gl_glass_destroy(g);
    return result;
}

facet_result gl_glass_begin(gl_glass *g, gl_context *context, const gl_target *target, facet_error *error)
{
    facet_result result = update(g, context, target, error);
    if (result != FACET_OK)
        return result;
    glBindFramebuffer(GL_FRAMEBUFFER, g->framebuffer);
    glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    return FACET_OK;
}

void gl_glass_end(const gl_glass *g, const gl_target *target)
{
    glBindFramebuffer(GL_FRAMEBUFFER, target->framebuffer);
    bind_texture(g);
}

void gl_glass_destroy(gl_glass *g)
{
    glDeleteFramebuffers(1, &g->framebuffer);
    glDeleteRenderbuffers(1, &g->depth);
    glDeleteTextures(1, &g->texture);
    *g = (gl_glass){.width = 0};
}
