/* gl_bloom.c - see gl_bloom.h. The filter is a sum of smooth ones, each twice as wide as the one before and with SPREAD of its
 * weight: its density falls with the distance to the power of log2(SPREAD) - 2 = -2.5, between the -2 and -3 of the
 * glare that eyes and lenses have (Vos 1984, "Disability glare"). Down and up a pyramid of halves after Jimenez 2014. */
#include "gl/scene/gl_bloom.h"

#include <epoxy/gl.h>

static const float SPREAD = 0.7f;
enum {
    COARSEST = 2, /* levels that are left out: the last ones have few pixels and are not smooth */
    WIDTHS =
        7 /* of filters, counted from the widest: the finer ones of large pictures have no weight, so that light is
                     spread over the same part of a picture of any size */
};

static uint32_t levels_of(uint32_t width, uint32_t height)
{
    uint32_t count = 1;
    while ((width < height ? width : height) >> count)
        count++;
    return count > 2 + COARSEST ? count - COARSEST : 2;
}

/* Level by level, from the coarsest: mix(this one, what is coarser, SPREAD). */
static facet_result gather(const gl_bloom *b, const gl_pyramid_brush *brush, facet_error *error)
{
    const gl_program_key spread = {GL_MAIN_SPREAD, 0};
    facet_result result = FACET_OK;
    uint32_t count = b->pyramid.level_count;
    for (uint32_t level = count - 1; level-- > 1 && result == FACET_OK;) {
        gl_pyramid_begin_level(&b->pyramid, level, (int)level + 1);
        glEnable(GL_BLEND);
        glBlendFunc(GL_CONSTANT_ALPHA, GL_ONE_MINUS_CONSTANT_ALPHA);
        glBlendColor(0.0f, 0.0f, 0.0f, level + WIDTHS >= count ? SPREAD : 1.0f);
        result = gl_pyramid_draw(&b->pyramid, brush, spread, level, error);
    }
    return result;
}

static facet_result add(const gl_bloom *b, const gl_pyramid_brush *brush, const gl_target *target,
                        float share, facet_error *error)
{
    const gl_program_key spread = {GL_MAIN_SPREAD, 0};
    gl_pyramid_begin_level(&b->pyramid, 0, 1);
    glBindFramebuffer(GL_FRAMEBUFFER, target->resolved_framebuffer);
    glEnable(GL_BLEND);
    glBlendFunc(GL_CONSTANT_ALPHA, GL_ONE_MINUS_CONSTANT_ALPHA);
    glBlendColor(0.0f, 0.0f, 0.0f, share);
    return gl_pyramid_draw(&b->pyramid, brush, spread, 0, error);
}

facet_result gl_bloom_draw(gl_bloom *b, gl_context *context, const gl_pyramid_brush *brush,
                           const gl_target *target, float share, facet_error *error)
{
    facet_result result = gl_pyramid_update(&b->pyramid, context, target->width, target->height,
                                            levels_of(target->width, target->height), error);
    if (result == FACET_OK)
        result = gl_pyramid_fill(&b->pyramid, brush, target->color, error);
    if (result == FACET_OK && b->pyramid.level_count > 1) {
        result = gather(b, brush, error);
        if (result == FACET_OK)
            result = add(b, brush, target, share, error);
    }
    glDisable(GL_BLEND);
    gl_pyramid_end_levels(&b->pyramid);
    return result;
}

void gl_bloom_destroy(gl_bloom *b)
{
    gl_pyramid_destroy(&b->pyramid);
}
