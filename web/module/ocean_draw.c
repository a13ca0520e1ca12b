/* ocean_draw.c - images of the sea as facet ocean --renderer gl draws them. In motion an image has one sample per pixel and
 * is drawn at once; at rest each call draws some rows of the next sample, until the image has those of the command. */
#include <emscripten/emscripten.h>
#include <math.h>
#include <string.h>

#include "base/result.h"
#include "gl/core/gl_api.h"
#include "ocean.h"

enum { LEAST_ROWS = 4 };

/* What the last call drew. */
static struct {
    uint32_t width, height;
    double divider;
    bool is_moving;
    bool is_compiling; /* nothing: programs are being compiled */
} last;

/* Columns that a side has. */
static void find_columns(int number, uint32_t *begin, uint32_t *end)
{
    double share = ocean.settings.run.options.is_before_after ? fmin(fmax(last.divider, 0.0), 1.0) : 0.0;
    uint32_t edge = (uint32_t)lround(share * (double)last.width);
    *begin = number == OCEAN_BEFORE ? 0 : edge;
    *end = number == OCEAN_BEFORE ? edge : last.width;
}

static facet_result create_frame(int number, facet_error *error)
{
    const ocean_options *o = &ocean.settings.run.options;
    ocean_side *side = &ocean.sides[number];
    facet_render_stats stats = {0};
    ocean_half halves[OCEAN_SIDES];
    const ocean_half alone = {o->shading, o->render.desc.tonemap};
    if (side->frame)
        return FACET_OK;
    ocean_options_halves(&ocean.settings.line, o, &halves[OCEAN_BEFORE], &halves[OCEAN_NOW]);
    TRY(ocean_describe_side(side, o->is_before_after ? &halves[number] : &alone, last.width, last.height,
                            error));
    if (last.is_moving)
        side->desc.samples = 1;
    return water_frame_create(&ocean.cache, NULL, &side->desc, &side->frame, &stats, error);
}

/* Frames and programs of the sides that have columns. */
static facet_result prepare_sides(facet_error *error)
{
    uint32_t begin, end;
    last.is_compiling = false;
    if (!ocean.sides[OCEAN_BEFORE].frame && !ocean.sides[OCEAN_NOW].frame)
        TRY(ocean_prepare(last.width, last.height, last.is_moving, error));
    for (int i = 0; i < OCEAN_SIDES; i++) {
        bool is_ready;
        find_columns(i, &begin, &end);
        if (begin >= end)
            continue;
        TRY(create_frame(i, error));
        TRY(gl_sea_request(ocean.renderer, ocean.sides[i].frame, &is_ready, error));
        last.is_compiling |= !is_ready;
    }
    return FACET_OK;
}

/* Stretches what was drawn at another size: it is shown until the rows of the new size are drawn. */
static facet_result stretch(gl_target *mean, facet_error *error)
{
    gl_target old = *mean;
    if (old.width == last.width && old.height == last.height)
        return FACET_OK;
    *mean = (gl_target){.width = 0};
    facet_result result =
        gl_target_update(mean, &ocean.context, GL_TARGET_WINDOW, last.width, last.height, 1, error);
    if (result == FACET_OK) {
        glBindFramebuffer(GL_READ_FRAMEBUFFER, old.framebuffer);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, mean->framebuffer);
        glBlitFramebuffer(0, 0, (GLint)old.width, (GLint)old.height, 0, 0, (GLint)last.width,
                          (GLint)last.height, GL_COLOR_BUFFER_BIT, GL_LINEAR);
    }
    gl_target_destroy(&old);
    return result;
}

/* Rows of a side's next sample; pass UINT32_MAX: shows those that are drawn. */
static facet_result draw_side(int number, uint32_t pass, uint32_t row, uint32_t rows, facet_error *error)
{
    ocean_side *side = &ocean.sides[number];
    const gl_sea_place to = {.framebuffer = 0};
    facet_render_stats stats = {0};
    uint32_t begin, end;
    find_columns(number, &begin, &end);
    if (begin >= end)
        return FACET_OK;
    const uint32_t crop[4] = {begin, 0, end - begin, last.height}, part[2] = {row, rows};
    memcpy(side->desc.crop, crop, sizeof crop);
    return gl_sea_present(ocean.renderer, side->frame, &side->mean, pass, part, &to, &stats, error);
}

static facet_result show_stretched(facet_error *error)
{
    for (int i = 0; i < OCEAN_SIDES; i++)
        if (ocean.sides[i].frame && ocean.sides[i].mean.framebuffer) {
            TRY(stretch(&ocean.sides[i].mean, error));
            TRY(draw_side(i, UINT32_MAX, 0, last.height, error));
        }
    return FACET_OK;
}

static uint32_t wanted_samples(void)
{
    for (int i = 0; i < OCEAN_SIDES; i++)
        if (ocean.sides[i].frame)
            return ocean.sides[i].desc.samples;
    return 1;
}

/* Whether the image has all samples of the command. */
EMSCRIPTEN_KEEPALIVE bool facet_ocean_is_sharp(void)
{
    return ocean.passes > 0 && ocean.passes >= wanted_samples();
}

/* Whether the last call drew nothing, because programs are being compiled. */
EMSCRIPTEN_KEEPALIVE bool facet_ocean_is_compiling(void)
{
    return last.is_compiling;
}

/* Samples per pixel that are drawn; of an unfinished one the fraction of the image. */
EMSCRIPTEN_KEEPALIVE double facet_ocean_samples(void)
{
    double pixels = 0.0;
    uint32_t begin, end;
    if (last.width == 0)
        return 0.0;
    for (int i = 0; i <= ocean.side && i < OCEAN_SIDES; i++) {
        find_columns(i, &begin, &end);
        pixels += (double)(end - begin) * (i < ocean.side ? last.height : ocean.row);
    }
    return ocean.passes + pixels / ((double)last.width * last.height);
}

/* Of the command. */
EMSCRIPTEN_KEEPALIVE int facet_ocean_wanted_samples(void)
{
    return (int)wanted_samples();
}

/* Rows of the side whose turn it is, at least that many pixels. */
static facet_result draw_rows(uint32_t pixels, facet_error *error)
{
    uint32_t begin, end;
    find_columns(ocean.side, &begin, &end);
    uint32_t rows = begin < end ? pixels / (end - begin) : last.height, left = last.height - ocean.row;
    rows = rows < LEAST_ROWS ? LEAST_ROWS : rows;
    rows = rows < left ? rows : left;
    TRY(draw_side(ocean.side, ocean.passes, ocean.row, rows, error));
    ocean.row += rows;
    if (ocean.row < last.height)
        return FACET_OK;
    ocean.row = 0;
    ocean.side++;
    return FACET_OK;
}

static facet_result draw_part(uint32_t pixels, facet_error *error)
{
    bool is_whole = pixels == 0;
    TRY(prepare_sides(error));
    if (last.is_compiling)
        return FACET_OK;
    if (!is_whole && ocean.passes == 0 && ocean.side == 0 && ocean.row == 0)
        TRY(show_stretched(error));
    if (facet_ocean_is_sharp())
        return FACET_OK;
    uint32_t begin, end;
    find_columns(OCEAN_BEFORE, &begin, &end);
    if (begin >= end && ocean.side == OCEAN_BEFORE)
        ocean.side = OCEAN_NOW;
    do
        TRY(draw_rows(is_whole ? last.width * last.height : pixels, error));
    while (is_whole && ocean.side < OCEAN_SIDES);
    find_columns(OCEAN_NOW, &begin, &end);
    if (ocean.side == OCEAN_SIDES || (ocean.side == OCEAN_NOW && begin >= end)) {
        ocean.passes++;
        ocean.side = OCEAN_BEFORE;
    }
    return FACET_OK;
}

/* Draws into framebuffer 0, which keeps what it has. divider: the part of the width that shows the legacy style, where
 * before-after is set. seconds: since the last frame; 0: the sea rests. pixels: about how many to draw, 0: one sample of all;
 * the next call goes on below them, then with the next sample, until facet_ocean_is_sharp(). */
EMSCRIPTEN_KEEPALIVE int facet_ocean_draw(int width, int height, double divider, double seconds, int pixels)
{
    bool is_moving = seconds > 0.0;
    if (!ocean.renderer)
        return fail(&ocean.error, FACET_ERROR_SYSTEM, "the context of WebGL is lost");
    if (width < 1 || height < 1)
        return fail(&ocean.error, FACET_ERROR_ARGUMENT, "the image has no size");
    if (is_moving || (uint32_t)width != last.width || (uint32_t)height != last.height ||
        divider != last.divider || last.is_moving)
        ocean_forget_frames();
    last.width = (uint32_t)width;
    last.height = (uint32_t)height;
    last.divider = divider;
    last.is_moving = is_moving;
    if (is_moving) /* whole milliseconds, which the command line repeats */
        ocean.time_s = round(1000.0 * (ocean.time_s + seconds)) / 1000.0;
    facet_result result = draw_part(is_moving || pixels < 1 ? 0 : (uint32_t)pixels, &ocean.error);
    if (result != FACET_OK)
        ocean_forget_frames();
    return result;
}
