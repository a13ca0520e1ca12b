/* gl_pyramid.c - see gl_pyramid.h. */
#include "gl/core/gl_pyramid.h"

#include "base/result.h"
#include "gl/core/gl_api.h"
#include "gl/core/gl_blocks.h"
#include "gl/core/gl_texture.h"

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

static void begin_level(const gl_pyramid *p, uint32_t level, int from)
{
    glBindFramebuffer(GL_FRAMEBUFFER, p->framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, p->texture, (GLint)level);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    glViewport(0, 0, (GLsizei)halved(p->width, level), (GLsizei)halved(p->height, level));
    if (from < 0)
        return;
    /* A level must not be readable while it is drawn into. */
    glActiveTexture(GL_TEXTURE0 + GL_UNIT_OPAQUE);
    glBindTexture(GL_TEXTURE_2D, p->texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_BASE_LEVEL, from);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, from);
}

static void end_levels(const gl_pyramid *p)
{
    glActiveTexture(GL_TEXTURE0 + GL_UNIT_OPAQUE);
    glBindTexture(GL_TEXTURE_2D, p->texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_BASE_LEVEL, 0);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, (GLint)p->level_count - 1);
}

static void allocate(const gl_pyramid *p, const gl_context *context)
{
    glActiveTexture(GL_TEXTURE0 + GL_UNIT_OPAQUE);
    glBindTexture(GL_TEXTURE_2D, p->texture);
    gl_texture_allocate(context, p->level_count, GL_RGBA16F, p->width, p->height);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    end_levels(p);
}

static facet_result update(gl_pyramid *p, gl_context *context, uint32_t width, uint32_t height,
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
    allocate(p, context);
    begin_level(p, 0, -1);
    facet_result result = gl_context_check_framebuffer(context, "the mip levels of an image",
                                                       "half float images cannot be rendered", error);
    if (result != FACET_OK)
        gl_pyramid_destroy(p);
    return result;
}

static facet_result draw_level(const gl_pyramid *p, const gl_pyramid_brush *brush, gl_program_key key,
                               uint32_t level, facet_error *error)
{
    uint32_t program;
    TRY(gl_programs_get(brush->programs, key, &program, error));
    glUseProgram(program);
    glUniform2f(glGetUniformLocation(program, "u_pixel"), 1.0f / (float)halved(p->width, level),
                1.0f / (float)halved(p->height, level));
    glBindVertexArray(brush->empty_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    return FACET_OK;
}

static facet_result fill(const gl_pyramid *p, const gl_pyramid_brush *brush, uint32_t texture,
                         facet_error *error)
{
    const gl_program_key copy = {GL_MAIN_PYRAMID, GL_PYRAMID_IS_COPY}, halve = {GL_MAIN_PYRAMID, 0};
    begin_level(p, 0, -1);
    glActiveTexture(GL_TEXTURE0 + GL_UNIT_OPAQUE);
    glBindTexture(GL_TEXTURE_2D, texture);
    facet_result result = draw_level(p, brush, copy, 0, error);
    for (uint32_t level = 1; level < p->level_count && result == FACET_OK; level++) {
        begin_level(p, level, (int)level - 1);
        result = draw_level(p, brush, halve, level, error);
    }
    end_levels(p);
    return result;
}

/* ---- the opaque surfaces behind glass ---- */

facet_result gl_pyramid_take_opaque(gl_pyramid *p, gl_context *context, const gl_pyramid_brush *brush,
                                    const gl_target *target, facet_error *error)
{
    facet_result result = update(p, context, target->width, target->height, 0, error);
    if (result == FACET_OK) {
        gl_target_resolve(target);
        result = fill(p, brush, target->color, error);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, target->framebuffer);
    glViewport(0, 0, (GLsizei)target->width, (GLsizei)target->height);
    glEnable(GL_DEPTH_TEST);
    return result;
}

void gl_pyramid_bind_opaque(const gl_pyramid *p)
{
    glActiveTexture(GL_TEXTURE0 + GL_UNIT_OPAQUE);
    glBindTexture(GL_TEXTURE_2D, p->texture);
}

/* ---- bloom ---- */

static const float SPREAD = 0.7f;
enum {
    COARSEST = 2, /* coarsest levels that are left out: they have too few pixels to be smooth */
    /* filter widths in use, from the widest: large images leave out the finer ones, so that the glow covers the same part
     * of an image of any size */
    WIDTHS = 7
};

static uint32_t levels_of(uint32_t width, uint32_t height)
{
    uint32_t count = 1;
    while ((width < height ? width : height) >> count)
        count++;
    return count > 2 + COARSEST ? count - COARSEST : 2;
}

/* From the coarsest level up: mix(level, coarser level, SPREAD). */
static facet_result gather(const gl_pyramid *p, const gl_pyramid_brush *brush, facet_error *error)
{
    const gl_program_key doubled = {GL_MAIN_PYRAMID, GL_PYRAMID_IS_DOUBLED};
    facet_result result = FACET_OK;
    uint32_t count = p->level_count;
    for (uint32_t level = count - 1; level-- > 1 && result == FACET_OK;) {
        begin_level(p, level, (int)level + 1);
        glEnable(GL_BLEND);
        glBlendFunc(GL_CONSTANT_ALPHA, GL_ONE_MINUS_CONSTANT_ALPHA);
        glBlendColor(0.0f, 0.0f, 0.0f, level + WIDTHS >= count ? SPREAD : 1.0f);
        result = draw_level(p, brush, doubled, level, error);
    }
    return result;
}

static facet_result add(const gl_pyramid *p, const gl_pyramid_brush *brush, const gl_target *target,
                        float share, facet_error *error)
{
    const gl_program_key doubled = {GL_MAIN_PYRAMID, GL_PYRAMID_IS_DOUBLED};
    begin_level(p, 0, 1);
    glBindFramebuffer(GL_FRAMEBUFFER, target->resolved_framebuffer);
    glEnable(GL_BLEND);
    glBlendFunc(GL_CONSTANT_ALPHA, GL_ONE_MINUS_CONSTANT_ALPHA);
    glBlendColor(0.0f, 0.0f, 0.0f, share);
    return draw_level(p, brush, doubled, 0, error);
}

facet_result gl_pyramid_bloom(gl_pyramid *p, gl_context *context, const gl_pyramid_brush *brush,
                              const gl_target *target, float share, facet_error *error)
{
    facet_result result =
        update(p, context, target->width, target->height, levels_of(target->width, target->height), error);
    if (result == FACET_OK)
        result = fill(p, brush, target->color, error);
    if (result == FACET_OK && p->level_count > 1) {
        result = gather(p, brush, error);
        if (result == FACET_OK)
            result = add(p, brush, target, share, error);
    }
    glDisable(GL_BLEND);
    end_levels(p);
    return result;
}
