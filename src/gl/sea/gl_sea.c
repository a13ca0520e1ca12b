/* gl_sea.c - see gl_sea.h: an image into a film, and a frame into a window. */
#include "gl/sea/gl_sea.h"

#include "base/clock.h"
#include "base/memory.h"
#include "base/result.h"
#include "draw/render_watch.h"
#include "gl/core/gl_blocks.h"
#include "gl/scene/gl_film.h"
#include "gl/sea/gl_sea_image.h"

/* ---- a film ---- */

static facet_result draw_view(void *self, const gl_target *target, const gl_view *view, facet_error *error)
{
    return gl_sea_image_draw(self, target, view, false, error);
}

static facet_result draw_layers(void *self, const gl_target *target, const gl_view *view, facet_error *error)
{
    return gl_sea_image_draw(self, target, view, true, error);
}

static facet_result draw_film(gl_sea_image *d, double deadline_s, film *target, facet_error *error)
{
    const facet_render_desc *r = d->frame->desc;
    gl_film_desc drawn = {.context = d->s->context,
                          .render = r,
                          .target = &d->s->target,
                          .sampling = {.scale = 1, .samples = 1, .passes = r->samples ? r->samples : 1},
                          .deadline_s = deadline_s,
                          .self = d,
                          .draw = draw_view,
                          .draw_layers = draw_layers};
    scene_identity *identities = NULL;
    facet_result result = FACET_OK;
    if (r->aovs & SCENE_IDENTITY_AOVS)
        result = gl_sea_model_identify(&d->model, d->frame, &identities, &drawn.identity_count, error);
    drawn.identities = identities;
    if (result == FACET_OK)
        result = gl_film_draw(&drawn, target, error);
    mem_free(identities);
    return result;
}

facet_result gl_sea_draw(gl_sea *s, const water_frame *frame, film *target, facet_render_stats *stats,
                         facet_error *error)
{
    double begin = clock_seconds();
    const facet_render_desc *r = frame->desc;
    double deadline_s = r->time_limit_s > 0.0 ? begin + r->time_limit_s : 0.0;
    gl_sea_image d = {.s = s, .frame = frame};
    facet_result result = render_check_limits(r, "prepare", 0.0, deadline_s, error);
    if (result == FACET_OK)
        result = gl_sea_image_prepare(&d, stats, error);
    double drawing_begin = clock_seconds();
    stats->geometry_s += drawing_begin - begin;
    if (result == FACET_OK)
        result = gl_sea_image_draw_grid(&d, error);
    if (result == FACET_OK)
        result = draw_film(&d, deadline_s, target, error);
    if (result == FACET_OK)
        result = render_check_limits(r, "shade", 1.0, 0.0, error);
    stats->shade_s += clock_seconds() - drawing_begin;
    stats->total_s = stats->light_s + (clock_seconds() - begin);
    gl_sea_model_end(&d.model);
    if (result == FACET_ERROR_MEMORY || s->context->is_lost)
        gl_sea_stop(s);
    gl_context_release(s->context);
    return result;
}

/* ---- a window's frame ---- */

facet_result gl_sea_request(gl_sea *s, const water_frame *frame, bool *is_ready, facet_error *error)
{
    TRY(gl_sea_start(s, error));
    return gl_sea_image_request(s, frame, is_ready, error);
}

/* Tone-maps the image's part of a target into a framebuffer, where the whole image has its lower left corner at (x, y). */
static facet_result show(const gl_sea_image *d, const gl_target *mean, const gl_sea_place *to,
                         facet_error *error)
{
    const gl_sea *s = d->s;
    const facet_render_desc *r = d->frame->desc;
    const gl_program_key key = {GL_MAIN_PRESENT, gl_program_present_features(s->context, r->tonemap)};
    const gl_frame_block block = {.size = {(float)r->width, (float)r->height, (float)to->x, (float)to->y}};
    GLuint program;
    TRY(gl_programs_get(s->programs, key, &program, error));
    gl_sea_set_block(s->frame_buffer, GL_BLOCK_FRAME, &block, sizeof block);
    glBindFramebuffer(GL_FRAMEBUFFER, to->framebuffer);
    glViewport(to->x, to->y, (GLsizei)r->width, (GLsizei)r->height);
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_SCISSOR_TEST);
    glScissor(to->x + (GLint)d->part[0], to->y + (GLint)(r->height - d->part[1] - d->part[3]),
              (GLsizei)d->part[2], (GLsizei)d->part[3]);
    gl_sea_texture_bind(0, GL_TEXTURE_2D, mean->color);
    glUseProgram(program);
    glBindVertexArray(s->empty_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDisable(GL_SCISSOR_TEST);
    gl_sea_texture_bind(0, GL_TEXTURE_2D, 0); /* the next image is rendered to it */
    return gl_context_check(s->context, "the window", error);
}

/* The samples of an image lie where those of gl_film_draw() do. */
static facet_result draw_sample(gl_sea_image *d, gl_target *mean, uint32_t pass, facet_error *error)
{
    const facet_render_desc *r = d->frame->desc;
    const gl_sampling sampling = {.scale = 1, .samples = 1, .passes = r->samples ? r->samples : 1};
    float *jitter = mem_alloc(&r->allocator, sampling.passes, 2 * sizeof *jitter);
    if (!jitter)
        return fail_memory(error, "samples", sampling.passes * 2 * sizeof *jitter);
    gl_sampling_jitter(&sampling, jitter);
    const gl_view all = {.scale = 1,
                         .width = r->width,
                         .height = r->height,
                         .jitter = {jitter[2 * pass], jitter[2 * pass + 1]}};
    mem_free(jitter);
    TRY(gl_target_update(mean, d->s->context, GL_TARGET_WINDOW, r->width, r->height, 1, error));
    return gl_sea_image_draw(d, mean, &all, false, error);
}

facet_result gl_sea_present(gl_sea *s, const water_frame *frame, gl_target *mean, uint32_t pass,
                            const uint32_t rows[2], const gl_sea_place *to, facet_render_stats *stats,
                            facet_error *error)
{
    double begin = clock_seconds();
    const uint32_t *crop = frame->desc->crop;
    gl_sea_image d = {.s = s,
                      .frame = frame,
                      .is_clipped = true,
                      .part = {crop[0], crop[1] + rows[0], crop[2], rows[1]},
                      .is_continued = rows[0] > 0,
                      .earlier = pass};
    bool is_complete = pass > 0 && pass >= frame->desc->samples;
    facet_result result = is_complete ? gl_sea_start(s, error) : gl_sea_image_prepare(&d, stats, error);
    if (result == FACET_OK && !is_complete && !d.is_continued)
        result = gl_sea_image_draw_grid(&d, error);
    if (result == FACET_OK && !is_complete)
        result = draw_sample(&d, mean, pass, error);
    if (result == FACET_OK)
        result = show(&d, mean, to, error);
    gl_sea_model_end(&d.model);
    stats->shade_s += clock_seconds() - begin;
    return result;
}
