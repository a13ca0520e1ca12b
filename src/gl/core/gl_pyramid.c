/* gl_pyramid.c - see gl_pyramid.h. */
#include "gl/core/gl_pyramid.h"

#include <epoxy/gl.h>

#include "base/result.h"
#include "gl/core/gl_blocks.h"

static uint32_t halved(uint32_t size, uint32_t level)
{
    return size >> level ? size >> level : 1;
}

static uint32_t all_levels(uint32_t width, uint32_t height)
{
    uint32_t count = 1;
    while ((width | height) >> count)
        count++;
    return count;
}

void gl_pyramid_destroy(gl_pyramid *p)
{
    if (p->framebuffer)
        glDeleteFramebuffers(1, &p->framebuffer);
    if (p->texture)
        glDeleteTextures(1, &p->texture);
    *p = (gl_pyramid){0};
}

static void allocate(const gl_pyramid *p)
{
    glActiveTexture(GL_TEXTURE0 + GL_UNIT_OPAQUE);
    glBindTexture(GL_TEXTURE_2D, p->texture);
    for (uint32_t level = 0; level < p->level_count; level++)
        glTexImage2D(GL_TEXTURE_2D, (GLint)level, GL_RGBA16F, (GLsizei)halved(p->width, level),
                     (GLsizei)halved(p->height, level), 0, GL_RGBA, GL_HALF_FLOAT, NULL);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    gl_pyramid_end_levels(p);
}

facet_result gl_pyramid_update(gl_pyramid *p, gl_context *context, uint32_t width, uint32_t height,
                               uint32_t level_count, facet_error *error)
{
    uint32_t most = all_levels(width, height);
    level_count = level_count == 0 || level_count > most ? most : level_count;
    if (p->texture && p->width == width && p->height == height && p->level_count == level_count)
        return FACET_OK;
    gl_pyramid_destroy(p);
    *p = (gl_pyramid){.width = width, .height = height, .level_count = level_count};
    glGenTextures(1, &p->texture);
    glGenFramebuffers(1, &p->framebuffer);
    allocate(p);
    gl_pyramid_begin_level(p, 0, -1);
    bool is_complete = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    facet_result result = gl_context_check(context, "the levels of a picture", error);
    if (result == FACET_OK && !is_complete)
        result =
            fail(error, FACET_ERROR_SYSTEM, "OpenGL (%s): half floats cannot be drawn into", context->name);
    if (result != FACET_OK)
        gl_pyramid_destroy(p);
    return result;
}

void gl_pyramid_begin_level(const gl_pyramid *p, uint32_t level, int from)
{
    glBindFramebuffer(GL_FRAMEBUFFER, p->framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, p->texture, (GLint)level);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    glViewport(0, 0, (GLsizei)halved(p->width, level), (GLsizei)halved(p->height, level));
    if (from < 0)
        return;
    /* What is drawn into must not be among what can be read. */
    glActiveTexture(GL_TEXTURE0 + GL_UNIT_OPAQUE);
    glBindTexture(GL_TEXTURE_2D, p->texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_BASE_LEVEL, from);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, from);
}

void gl_pyramid_end_levels(const gl_pyramid *p)
{
    glActiveTexture(GL_TEXTURE0 + GL_UNIT_OPAQUE);
    glBindTexture(GL_TEXTURE_2D, p->texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_BASE_LEVEL, 0);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, (GLint)p->level_count - 1);
}

facet_result gl_pyramid_draw(const gl_pyramid *p, const gl_pyramid_brush *brush, gl_program_key key,
                             uint32_t level, facet_error *error)
{
    uint32_t program;
    facet_result result = gl_programs_get(brush->programs, key, &program, error);
    if (result != FACET_OK)
        return result;
    glUseProgram(program);
    glUniform2f(glGetUniformLocation(program, "u_pixel"), 1.0f / (float)halved(p->width, level),
                1.0f / (float)halved(p->height, level));
    glBindVertexArray(brush->empty_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    return FACET_OK;
}

facet_result gl_pyramid_fill(const gl_pyramid *p, const gl_pyramid_brush *brush, uint32_t picture,
                             facet_error *error)
{
    const gl_program_key copy = {GL_MAIN_HALVE, GL_HALVE_IS_COPY}, halve = {GL_MAIN_HALVE, 0};
    gl_pyramid_begin_level(p, 0, -1);
    glActiveTexture(GL_TEXTURE0 + GL_UNIT_OPAQUE);
    glBindTexture(GL_TEXTURE_2D, picture);
    facet_result result = gl_pyramid_draw(p, brush, copy, 0, error);
    for (uint32_t level = 1; level < p->level_count && result == FACET_OK; level++) {
        gl_pyramid_begin_level(p, level, (int)level - 1);
        result = gl_pyramid_draw(p, brush, halve, level, error);
    }
    gl_pyramid_end_levels(p);
    return result;
}
