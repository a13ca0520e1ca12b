/* ocean_draw.c - images of a sea, and sheets over options (--sweep). */
#include "cli/ocean/ocean_run.h"

#include "cli/shared/failure.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/suggest.h"
#include "cli/shared/value.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const float BLACK_EV = -200.0f; /* stops; a factor of 0 in float */

facet_result ocean_run_set_sea(ocean_run *run, const ocean_options *options, facet_error *error)
{
    facet_sea_desc desc = options->sea;
    desc.allocator = run->base.allocator;
    desc.log = messages_log(&run->base.messages);
    facet_sea_destroy(run->sea);
    return facet_sea_create(&desc, &run->sea, error);
}

facet_camera ocean_run_camera(const ocean_run *run, const ocean_options *o)
{
    facet_camera camera;
    if (run->has_camera && run->is_afloat &&
        facet_camera_from_scene(run->model, NULL, run->camera, &camera, NULL) == FACET_OK)
        return camera;
    camera = facet_sea_camera(run->sea, o->eye_height_m, o->heading_rad);
    for (int i = 0; i < 3 && o->render.has_eye; i++) {
        camera.target[i] += (float)o->render.eye[i] - camera.eye[i];
        camera.eye[i] = (float)o->render.eye[i];
    }
    if (o->has_target)
        memcpy(camera.target, o->target, sizeof camera.target);
    if (o->fov_y_rad > 0.0f)
        camera.fov_y_rad = o->fov_y_rad;
    return camera;
}

/* The desc of an image, without exposure and camera. */
static facet_render_desc desc_of(ocean_run *run, const ocean_options *o, const facet_sea_shading *shading)
{
    facet_render_desc d = o->render.desc;
    d.sea = run->sea;
    d.sky = o->sky;
    d.sea_shading = *shading;
    d.allocator = run->base.allocator;
    d.log = messages_log(&run->base.messages);
    d.environment = run->environment;
    if (o->render.environment.kind == ENVIRONMENT_NONE) /* a cell of --sweep without light */
        d.environment_ev = BLACK_EV;
    return d;
}

/* Creates the renderer of all images, which caches the sky and OpenGL programs. */
static facet_result make_renderer(ocean_run *run, facet_error *error)
{
    return run->renderer ? FACET_OK
                         : facet_renderer_create(run->model, &run->base.allocator, &run->renderer, error);
}

facet_result ocean_run_meter(ocean_run *run, const ocean_options *o, facet_error *error)
{
    if (run->has_camera)
        TRY(ocean_float_place(run, error));
    const facet_camera camera = ocean_run_camera(run, o);
    facet_render_desc d = desc_of(run, o, &o->shading);
    d.camera = &camera;
    run->ev100 = o->ev100;
    facet_result result = make_renderer(run, error);
    if (result == FACET_OK && !o->has_ev100)
        result = facet_renderer_meter(run->renderer, &d, &run->ev100, error);
    run->ev100 -= (double)d.exposure_ev;
    return result;
}

/* images_left includes this one; path tracing uses all of its time, so that images share the rest evenly. */
static facet_result draw(ocean_run *run, const ocean_options *o, const facet_sea_shading *shading,
                         facet_tonemap tonemap, uint32_t images_left, progress *shown, facet_image **image,
                         facet_error *error)
{
    const facet_camera camera = ocean_run_camera(run, o);
    double left = interrupt_seconds_left();
    facet_result result = interrupt_check(shown->subject, error);
    if (result != FACET_OK)
        return result;
    facet_render_desc d = desc_of(run, o, shading);
    d.camera = &camera;
    d.progress = progress_callback(shown);
    d.tonemap = tonemap;
    bool is_path = o->render.renderer.features & FACET_RENDERER_FEATURE_PATH;
    d.time_limit_s = left > 1e29 ? 0.0 : is_path ? left / images_left : left;
    d.path.keeps_cancelled = true;
    d.exposure_ev = facet_exposure_from_ev100(run->ev100);
    interrupt_begin_polling(shown->subject, "drawing", shown->mode == PROGRESS_BAR);
    result = make_renderer(run, error);
    if (result == FACET_OK)
        result = facet_renderer_render(run->renderer, &d, image, error);
    interrupt_end();
    progress_clear();
    return result;
}

/* Legacy style and now side by side. */
static facet_result draw_both(ocean_run *run, const ocean_options *o, progress *shown, facet_image **image,
                              facet_error *error)
{
    facet_image *halves[2] = {NULL, NULL};
    static const char *const labels[] = {"before", "now"};
    ocean_half before, now;
    ocean_options_halves(run->base.line, o, &before, &now);
    facet_result result = draw(run, o, &before.shading, before.tonemap, 1, shown, &halves[0], error);
    if (result == FACET_OK)
        result = draw(run, o, &now.shading, now.tonemap, 1, shown, &halves[1], error);
    const facet_contact_sheet_desc sheet = {.allocator = run->base.allocator,
                                            .log = messages_log(&run->base.messages),
                                            .column_count = 2,
                                            .gap = 2,
                                            .labels = labels};
    if (result == FACET_OK)
        result = facet_image_create_sheet((const facet_image *const *)halves, 2, &sheet, image, error);
    facet_image_destroy(halves[0]);
    facet_image_destroy(halves[1]);
    return result;
}

facet_result ocean_run_draw(ocean_run *run, const ocean_options *o, ocean_step step, facet_image **image,
                            facet_error *error)
{
    progress shown = {.mode = run->base.progress,
                      .subject = step.output,
                      .start = interrupt_clock(),
                      .done_before = (double)step.index / step.count,
                      .share = 1.0 / step.count,
                      .last_percent = -10};
    return o->is_before_after ? draw_both(run, o, &shown, image, error)
                              : draw(run, o, &o->shading, o->render.desc.tonemap, step.count - step.index,
                                     &shown, image, error);
}

/* ---- sweeps ---- */

enum { MAX_STEPS = 64, AXES = 2, LABEL_SIZE = 96, MAX_EDGE = 65536 };

static const double MAX_NUMBER = 1e15; /* largest number, up to which integers are exact */

typedef struct axis {
    const option *option;
    double from, to;
    uint32_t count;
} axis;

static const char expected[] =
    "NAME=FROM:TO:COUNT, or two of them separated by a comma: roughness=0.01:0.1:5,"
    "ior=1.3:1.4:5";

static bool takes_number(const option *o)
{
    static const option_id texts[] = {OPT_WIND, OPT_FETCH,   OPT_DEPTH, OPT_BED_SLOPE,
                                      OPT_SUN,  OPT_HEADING, OPT_FOV,   OPT_EXPOSURE};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        if (o->id == texts[i])
            return true;
    static const option_id others[] = {OPT_THREADS,      OPT_MAX_TEXTURE,  OPT_MESH_SIZE,
                                       OPT_MESH_SAMPLES, OPT_JPEG_QUALITY, OPT_FPS};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (o->id == others[i])
            return false;
    return o->kind == OPTION_NUMBER || o->kind == OPTION_INTEGER;
}

static facet_result read_axis(const command_line *c, const char **at, axis *out, facet_error *error)
{
    size_t length = strcspn(*at, "=");
    out->option = option_find(c->verb, *at, length);
    if (length == 0 || !(*at)[length])
        return option_fail(c, OPT_SWEEP, expected, error);
    if (!out->option) {
        facet_error unknown;
        facet_result result = suggest_option(c->verb, *at, length, &unknown);
        return fail(error, result, "--sweep: %.400s", unknown.message);
    }
    if (!takes_number(out->option))
        return fail(error, FACET_ERROR_ARGUMENT, "--sweep: --%s is not one number that changes the image",
                    out->option->name);
    *at += length + 1;
    double count = 0.0;
    bool is_range = scan_number(at, &out->from) && *(*at)++ == ':' && scan_number(at, &out->to) &&
                    *(*at)++ == ':' && scan_number(at, &count);
    if (!is_range || !(fabs(out->from) <= MAX_NUMBER && fabs(out->to) <= MAX_NUMBER) || count < 1.0 ||
        count > MAX_STEPS || count != floor(count))
        return option_fail(c, OPT_SWEEP, expected, error);
    out->count = (uint32_t)count;
    return FACET_OK;
}

static facet_result read_axes(const ocean_run *run, axis axes[AXES], facet_error *error)
{
    const command_line *c = run->base.line;
    const char *at = option_text(c, OPT_SWEEP, "");
    facet_result result = read_axis(c, &at, &axes[0], error);
    if (result == FACET_OK && *at == ',') {
        at++;
        result = read_axis(c, &at, &axes[1], error);
    }
    if (result == FACET_OK && *at)
        result = option_fail(c, OPT_SWEEP, expected, error);
    const render_options *p = &run->options.render;
    uint64_t columns = axes[0].count, rows = axes[1].count; /* 0: the number of columns is free */
    if (result == FACET_OK && (columns * p->desc.width > MAX_EDGE || rows * p->desc.height > MAX_EDGE))
        result = fail(error, FACET_ERROR_ARGUMENT,
                      "--sweep: %u x %u images of %u x %u pixels exceed a sheet of %d x %d", axes[0].count,
                      (unsigned)rows, p->desc.width, p->desc.height, MAX_EDGE, MAX_EDGE);
    if (result == FACET_OK && axes[0].option == axes[1].option)
        result = fail(error, FACET_ERROR_ARGUMENT, "--sweep: both axes are --%s", axes[0].option->name);
    return result;
}

static void put_number(const axis *a, uint32_t i, char *text, size_t size)
{
    double share = a->count > 1 ? (double)i / (a->count - 1) : 0.0;
    double number = a->from + share * (a->to - a->from);
    if (a->option->kind == OPTION_INTEGER)
        snprintf(text, size, "%.0f", round(number));
    else
        snprintf(text, size, "%.6g", number); /* the image is rendered with the number in its label */
}

/* Renders a cell: the command line with both numbers. */
static facet_result draw_cell(ocean_run *run, const axis *axes, uint32_t cell, ocean_step step, char *label,
                              facet_image **image, facet_error *error)
{
    command_line line = *run->base.line;
    char numbers[AXES][32];
    *label = 0;
    for (int i = 0; i < AXES && axes[i].option; i++) {
        const option *o = axes[i].option;
        put_number(&axes[i], i ? cell / axes[0].count : cell % axes[0].count, numbers[i], sizeof numbers[i]);
        line.values[o->id] = (option_value){.text = NULL};
        TRY(command_line_set(&line, o, numbers[i], SOURCE_COMMAND_LINE, error));
        size_t used = strlen(label);
        snprintf(label + used, LABEL_SIZE - used, "%s%s %s", i ? ", " : "", o->name, numbers[i]);
    }
    ocean_options options;
    TRY(ocean_options_read(&line, &options, error));
    TRY(ocean_run_set_sea(run, &options, error));
    TRY(ocean_run_meter(run, &options, error));
    TRY(facet_sea_set_time(run->sea, options.render.time_s, error));
    if (run->model)
        TRY(ocean_float_place(run, error));
    return ocean_run_draw(run, &options, step, image, error);
}

facet_result ocean_sweep(ocean_run *run, const char *output, facet_image **image, facet_error *error)
{
    axis axes[AXES] = {{.option = NULL}, {.option = NULL}};
    facet_result result = read_axes(run, axes, error);
    if (result != FACET_OK)
        return result;
    uint32_t count = axes[0].count * (axes[1].option ? axes[1].count : 1);
    facet_image **images = calloc(count, sizeof *images);
    char(*labels)[LABEL_SIZE] = calloc(count, sizeof *labels);
    const char **words = calloc(count, sizeof *words);
    if (!images || !labels || !words)
        result = fail(error, FACET_ERROR_MEMORY, "out of memory: sheet");
    for (uint32_t i = 0; i < count && result == FACET_OK; i++) {
        result = draw_cell(run, axes, i, (ocean_step){output, i, count}, labels[i], &images[i], error);
        words[i] = labels[i];
    }
    const facet_contact_sheet_desc desc = {.allocator = run->base.allocator,
                                           .log = messages_log(&run->base.messages),
                                           .column_count = axes[1].option ? axes[0].count : 0,
                                           .labels = words};
    if (result == FACET_OK)
        result = facet_image_create_sheet((const facet_image *const *)images, count, &desc, image, error);
    for (uint32_t i = 0; images && i < count; i++)
        facet_image_destroy(images[i]);
    free(images);
    free(labels);
    free(words);
    return result;
}
