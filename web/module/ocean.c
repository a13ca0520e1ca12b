/* ocean.c - what the ocean page calls: one sea in one canvas, set by the options of facet ocean (ocean_settings.h) and
 * drawn as facet ocean --renderer gl draws it. In motion an image has one sample per pixel; at rest each call adds
 * another, until it has those of the command. */
#include <emscripten/emscripten.h>
#include <emscripten/html5.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "film/film.h"
#include "film/film_image.h"
#include "gl/core/gl_api.h"
#include "gl/sea/gl_sea.h"
#include "image/image.h"
#include "ocean/sea.h"
#include "ocean_settings.h"
#include "render/renderer.h"
#include "water/water_frame.h"

static const double DEGREE = 0.017453292519943295; /* pi / 180 */

/* One of the two images that a divider separates; alone it is the left one with a width of 0. */
typedef struct ocean_side {
    facet_render_desc desc;
    facet_camera camera;
    water_frame *frame; /* of desc; NULL: not prepared */
    gl_target mean;     /* of the samples drawn so far */
} ocean_side;

enum { BEFORE, NOW, SIDES };

static struct {
    gl_context context;
    gl_sea *renderer;
    ocean_settings settings;
    facet_sea_desc sea_desc; /* of settings.run.sea */
    water_cache cache;
    double time_s, ev100;
    uint32_t metered_width, metered_height; /* of the view whose ev100 that is; 0: of none */
    ocean_side sides[SIDES];
    uint32_t passes; /* samples in the last image */
    facet_error error;
    char message[512]; /* the last warning */
} page;

static void note_warning(void *user, facet_log_level level, const char *line)
{
    (void)user;
    if (level == FACET_LOG_LEVEL_WARNING)
        snprintf(page.message, sizeof page.message, "%s", line);
}

/* ---- start, loss ---- */

static facet_result open_context(const char *canvas, facet_error *error)
{
    EmscriptenWebGLContextAttributes wanted;
    emscripten_webgl_init_context_attributes(&wanted);
    wanted.majorVersion = 2;
    wanted.alpha = wanted.antialias = wanted.depth = wanted.stencil = false;
    EMSCRIPTEN_WEBGL_CONTEXT_HANDLE handle = emscripten_webgl_create_context(canvas, &wanted);
    if (handle <= 0 || emscripten_webgl_make_context_current(handle) != EMSCRIPTEN_RESULT_SUCCESS)
        return fail(error, FACET_ERROR_SYSTEM, "this browser has no WebGL 2, which facet draws with");
    return FACET_OK;
}

static facet_result start_drawing(facet_error *error)
{
    page.context = (gl_context){0};
    TRY(gl_context_adopt(&page.context, error));
    return gl_sea_create_within(&page.context, NULL, &page.renderer, error);
}

/* canvas: a selector of CSS, or a name in specialHTMLTargets. */
EMSCRIPTEN_KEEPALIVE int facet_ocean_start(const char *canvas)
{
    facet_result result = open_context(canvas, &page.error);
    if (result == FACET_OK)
        result = start_drawing(&page.error);
    if (result == FACET_OK)
        result = ocean_settings_reset(&page.settings, &page.error);
    return result;
}

EMSCRIPTEN_KEEPALIVE const char *facet_ocean_error(void)
{
    return page.error.message;
}

/* The last warning, once. */
EMSCRIPTEN_KEEPALIVE const char *facet_ocean_message(void)
{
    static char taken[sizeof page.message];
    memcpy(taken, page.message, sizeof taken);
    page.message[0] = 0;
    return taken;
}

/* Frames refer to the sea, and to the light in the cache. */
static void forget_frames(void)
{
    for (int i = 0; i < SIDES; i++) {
        water_frame_destroy(page.sides[i].frame);
        page.sides[i].frame = NULL;
    }
    page.passes = 0;
}

/* The browser has taken the context away. Objects of OpenGL are released now, because those of the old context are
 * errors in the new one. */
EMSCRIPTEN_KEEPALIVE void facet_ocean_lose(void)
{
    page.context.is_lost = true;
    for (int i = 0; i < SIDES; i++)
        gl_target_destroy(&page.sides[i].mean);
    gl_sea_destroy(page.renderer);
    page.renderer = NULL;
    page.passes = 0;
}

EMSCRIPTEN_KEEPALIVE int facet_ocean_restore(void)
{
    return start_drawing(&page.error);
}

/* ---- options ---- */

/* All options get their defaults. */
EMSCRIPTEN_KEEPALIVE int facet_ocean_reset(void)
{
    page.time_s = 0.0;
    page.metered_width = 0;
    forget_frames();
    return ocean_settings_reset(&page.settings, &page.error);
}

/* text NULL: the default again. */
EMSCRIPTEN_KEEPALIVE int facet_ocean_set_option(const char *name, const char *text)
{
    facet_result result = ocean_settings_set(&page.settings, name, text, &page.error);
    if (result != FACET_OK)
        return result;
    if (strcmp(name, "time") == 0)
        page.time_s = page.settings.run.options.render.time_s;
    page.metered_width = 0;
    forget_frames();
    return FACET_OK;
}

static char *finish(text *t)
{
    if (!t->has_failed)
        return t->data; /* blocks of mem_alloc() are freed by facet_ocean_free() */
    text_destroy(t);
    fail_memory(&page.error, "a text", 0);
    return NULL;
}

EMSCRIPTEN_KEEPALIVE void facet_ocean_free(char *text)
{
    mem_free(text);
}

EMSCRIPTEN_KEEPALIVE char *facet_ocean_get_options(void)
{
    text t = {.data = NULL};
    ocean_settings_write(&page.settings, &t);
    return finish(&t);
}

EMSCRIPTEN_KEEPALIVE char *facet_ocean_get_help(void)
{
    text t = {.data = NULL};
    ocean_settings_write_help(&t);
    return finish(&t);
}

EMSCRIPTEN_KEEPALIVE char *facet_ocean_get_values(void)
{
    text t = {.data = NULL};
    ocean_settings_write_values(&page.settings, &t);
    return finish(&t);
}

EMSCRIPTEN_KEEPALIVE char *facet_ocean_command(int width, int height)
{
    text t = {.data = NULL};
    ocean_settings_write_command(&page.settings, page.time_s, width, height, &t);
    return finish(&t);
}

/* ---- the sea at a time ---- */

/* Whether both make the same waves and water. What messages and threads are is the same here. */
static bool is_same_sea(const facet_sea_desc *a, const facet_sea_desc *b)
{
    return memcmp(a, b, sizeof *a) == 0;
}

static facet_result update_sea(facet_error *error)
{
    ocean_run *run = &page.settings.run;
    facet_sea_desc desc;
    memcpy(&desc, &run->options.sea, sizeof desc);
    desc.log = (facet_log){.message = note_warning};
    if (run->sea && is_same_sea(&desc, &page.sea_desc))
        return FACET_OK;
    facet_sea *made;
    TRY(facet_sea_create(&desc, &made, error));
    forget_frames();
    facet_sea_destroy(run->sea);
    run->sea = made;
    memcpy(&page.sea_desc, &desc, sizeof desc);
    page.metered_width = 0;
    return FACET_OK;
}

static facet_result describe_side(ocean_side *side, const ocean_half *half, uint32_t width, uint32_t height,
                                  facet_error *error)
{
    const ocean_options *o = &page.settings.run.options;
    facet_render_desc d = o->render.desc;
    side->camera = ocean_run_camera(&page.settings.run, o);
    d.sea = page.settings.run.sea;
    d.sky = o->sky;
    d.sea_shading = half->shading;
    d.tonemap = half->tonemap;
    d.camera = &side->camera;
    d.width = width;
    d.height = height;
    d.log = (facet_log){.message = note_warning};
    d.exposure_ev = facet_exposure_from_ev100(page.ev100);
    return render_desc_resolve(&d, &side->desc, error);
}

/* Whether the exposure holds for a view: while the sea moves, also for nearly the same proportions, as the page adapts the
 * size of images to the machine. */
static bool is_metered(uint32_t width, uint32_t height, bool is_moving)
{
    double w = page.metered_width, h = page.metered_height;
    if (!is_moving)
        return w == width && h == height;
    return fabs(w * height - h * width) < 0.02 * w * height;
}

/* As the command: the sea at its beginning, so that all frames have one exposure. */
static facet_result meter(uint32_t width, uint32_t height, bool is_moving, facet_error *error)
{
    const ocean_options *o = &page.settings.run.options;
    const ocean_half half = {o->shading, o->render.desc.tonemap};
    ocean_side side = {.frame = NULL};
    if (is_metered(width, height, is_moving))
        return FACET_OK;
    page.ev100 = o->ev100;
    if (!o->has_ev100) {
        TRY(facet_sea_set_time(page.settings.run.sea, 0.0, error));
        TRY(describe_side(&side, &half, width, height, error));
        TRY(water_meter(&page.cache, &side.desc, &page.ev100, error));
    }
    page.ev100 -= (double)o->render.desc.exposure_ev;
    page.metered_width = width;
    page.metered_height = height;
    return FACET_OK;
}

static facet_result prepare(uint32_t width, uint32_t height, bool is_moving, facet_error *error)
{
    if (!width || !height)
        return fail(error, FACET_ERROR_ARGUMENT, "the image has no size");
    TRY(update_sea(error));
    TRY(meter(width, height, is_moving, error));
    return facet_sea_set_time(page.settings.run.sea, page.time_s, error);
}

/* ---- drawing ---- */

/* Columns [begin, end) of a side. samples: 0: those of the command. */
static facet_result draw_side(int number, uint32_t width, uint32_t height, uint32_t begin, uint32_t end,
                              uint32_t samples, facet_error *error)
{
    const ocean_options *o = &page.settings.run.options;
    ocean_side *side = &page.sides[number];
    facet_render_stats stats = {0};
    const gl_sea_place to = {.framebuffer = 0};
    if (begin >= end)
        return FACET_OK;
    if (!side->frame) {
        ocean_half halves[SIDES];
        ocean_options_halves(&page.settings.line, o, &halves[BEFORE], &halves[NOW]);
        const ocean_half alone = {o->shading, o->render.desc.tonemap};
        TRY(describe_side(side, o->is_before_after ? &halves[number] : &alone, width, height, error));
        if (samples)
            side->desc.samples = samples;
        TRY(water_frame_create(&page.cache, NULL, &side->desc, &side->frame, &stats, error));
    }
    const uint32_t part[4] = {begin, 0, end - begin, height};
    memcpy(side->desc.crop, part, sizeof part);
    return gl_sea_present(page.renderer, side->frame, &side->mean, page.passes, &to, &stats, error);
}

static uint32_t wanted_samples(void)
{
    for (int i = 0; i < SIDES; i++)
        if (page.sides[i].frame)
            return page.sides[i].desc.samples;
    return 1;
}

/* Whether the image has all samples of the command. */
EMSCRIPTEN_KEEPALIVE bool facet_ocean_is_sharp(void)
{
    return page.passes > 0 && page.passes >= wanted_samples();
}

/* Draws the image into framebuffer 0. divider: the part of the width that shows the legacy style, where before-after is
 * set. seconds: since the last frame; 0: the sea rests, and each call refines the image until facet_ocean_is_sharp(). */
EMSCRIPTEN_KEEPALIVE int facet_ocean_draw(int width, int height, double divider, double seconds)
{
    const ocean_options *o = &page.settings.run.options;
    static struct {
        int width, height;
        double divider;
        bool is_moving;
    } last;
    bool is_moving = seconds > 0.0;
    if (!page.renderer)
        return fail(&page.error, FACET_ERROR_SYSTEM, "the context of WebGL is lost");
    if (is_moving || width != last.width || height != last.height || divider != last.divider ||
        last.is_moving)
        forget_frames();
    last.width = width;
    last.height = height;
    last.divider = divider;
    last.is_moving = is_moving;
    if (is_moving) /* whole milliseconds, which the command line repeats */
        page.time_s = round(1000.0 * (page.time_s + seconds)) / 1000.0;
    facet_result result = prepare((uint32_t)width, (uint32_t)height, is_moving, &page.error);
    double share = o->is_before_after ? fmin(fmax(divider, 0.0), 1.0) : 0.0;
    uint32_t w = (uint32_t)width, h = (uint32_t)height, edge = (uint32_t)lround(share * width);
    if (result == FACET_OK)
        result = draw_side(BEFORE, w, h, 0, edge, is_moving ? 1 : 0, &page.error);
    if (result == FACET_OK)
        result = draw_side(NOW, w, h, edge, w, is_moving ? 1 : 0, &page.error);
    if (result != FACET_OK)
        forget_frames();
    else if (!facet_ocean_is_sharp())
        page.passes++;
    return result;
}

/* The image at any size, by the path of the command: with before-after both sides, divided. *rgba: rows from the top,
 * freed by free(). */
static facet_result read_side(int number, uint32_t width, uint32_t height, uint32_t begin, uint32_t end,
                              unsigned char *rgba, facet_error *error)
{
    const ocean_options *o = &page.settings.run.options;
    ocean_half halves[SIDES] = {{o->shading, o->render.desc.tonemap}, {o->shading, o->render.desc.tonemap}};
    ocean_side side = {.frame = NULL};
    facet_render_stats stats = {0};
    film f = {0};
    image coded = {0};
    if (begin >= end)
        return FACET_OK;
    if (o->is_before_after)
        ocean_options_halves(&page.settings.line, o, &halves[BEFORE], &halves[NOW]);
    TRY(describe_side(&side, &halves[number], width, height, error));
    const uint32_t part[4] = {begin, 0, end - begin, height};
    memcpy(side.desc.crop, part, sizeof part);
    facet_result result = water_frame_create(&page.cache, NULL, &side.desc, &side.frame, &stats, error);
    if (result == FACET_OK)
        result = film_create(NULL, part[2], height, 0, &f, error);
    if (result == FACET_OK)
        result = gl_sea_draw(page.renderer, side.frame, &f, &stats, error);
    if (result == FACET_OK) {
        film_tone_map(&f, side.desc.tonemap, NULL, 1);
        result = film_to_display_image(&f, IMAGE_U8, true, NULL, 1, &coded, error);
    }
    for (uint32_t y = 0; result == FACET_OK && y < height; y++)
        for (uint32_t x = 0; x < part[2]; x++) {
            const unsigned char *from =
                (const unsigned char *)coded.pixels + (size_t)coded.channel_count * ((size_t)y * part[2] + x);
            unsigned char *to = rgba + 4 * ((size_t)y * width + begin + x);
            memcpy(to, from, 3);
            to[3] = 255;
        }
    image_destroy(&coded);
    film_destroy(&f);
    water_frame_destroy(side.frame);
    return result;
}

enum { MAX_EDGE = 16384 };

EMSCRIPTEN_KEEPALIVE int facet_ocean_read_image(int width, int height, double divider, void **rgba)
{
    *rgba = NULL;
    if (width < 1 || height < 1 || width > MAX_EDGE || height > MAX_EDGE)
        return fail(&page.error, FACET_ERROR_ARGUMENT,
                    "an image of %d x %d pixels: each edge is from 1 to %d", width, height, MAX_EDGE);
    if (!page.renderer)
        return fail(&page.error, FACET_ERROR_SYSTEM, "the context of WebGL is lost");
    forget_frames();
    uint32_t w = (uint32_t)width, h = (uint32_t)height;
    double share = page.settings.run.options.is_before_after ? fmin(fmax(divider, 0.0), 1.0) : 0.0;
    uint32_t edge = (uint32_t)lround(share * width);
    unsigned char *pixels = malloc(4 * (size_t)width * (size_t)height);
    if (!pixels)
        return fail_memory(&page.error, "an image", 4 * (size_t)width * (size_t)height);
    facet_result result = prepare(w, h, false, &page.error);
    if (result == FACET_OK)
        result = read_side(BEFORE, w, h, 0, edge, pixels, &page.error);
    if (result == FACET_OK)
        result = read_side(NOW, w, h, edge, w, pixels, &page.error);
    if (result != FACET_OK) {
        free(pixels);
        return result;
    }
    *rgba = pixels;
    return FACET_OK;
}

/* ---- the camera ---- */

static void find_angles(const facet_camera *c, double *azimuth, double *elevation)
{
    double d[3];
    for (int i = 0; i < 3; i++)
        d[i] = (double)c->target[i] - (double)c->eye[i];
    *azimuth = atan2(d[0], d[2]) / DEGREE;
    *elevation = atan2(d[1], hypot(d[0], d[2])) / DEGREE;
}

/* The default's elevation, which --heading keeps. */
static double default_elevation(void)
{
    const facet_camera c = facet_sea_camera(page.settings.run.sea, 3.0f, 0.0f);
    double azimuth, elevation;
    find_angles(&c, &azimuth, &elevation);
    return elevation;
}

static int set_both(const char *heading, const char *target)
{
    int result = facet_ocean_set_option(heading ? "target" : "heading", NULL);
    return result == FACET_OK
               ? facet_ocean_set_option(heading ? "heading" : "target", heading ? heading : target)
               : result;
}

/* Looks in a direction, degrees, from where the camera is. */
EMSCRIPTEN_KEEPALIVE int facet_ocean_look(double azimuth, double elevation)
{
    static const double FAR_M = 100.0;
    char value[96];
    facet_result result = update_sea(&page.error);
    if (result != FACET_OK)
        return result;
    azimuth = remainder(azimuth, 360.0);
    elevation = fmin(fmax(elevation, -89.0), 89.0);
    if (fabs(elevation - default_elevation()) < 0.05) {
        snprintf(value, sizeof value, "%.2f", azimuth);
        return set_both(value, NULL);
    }
    const facet_camera c = ocean_run_camera(&page.settings.run, &page.settings.run.options);
    double level = FAR_M * cos(elevation * DEGREE);
    snprintf(value, sizeof value, "%.2f,%.2f,%.2f", (double)c.eye[0] + level * sin(azimuth * DEGREE),
             (double)c.eye[1] + FAR_M * sin(elevation * DEGREE),
             (double)c.eye[2] + level * cos(azimuth * DEGREE));
    return set_both(NULL, value);
}

/* Turns the camera as the pointer drags the image: by pixels of an image of that height. */
EMSCRIPTEN_KEEPALIVE int facet_ocean_turn(double dx, double dy, double height)
{
    double azimuth, elevation;
    facet_result result = update_sea(&page.error);
    if (result != FACET_OK)
        return result;
    const facet_camera c = ocean_run_camera(&page.settings.run, &page.settings.run.options);
    double per_pixel = (double)c.fov_y_rad / DEGREE / height;
    find_angles(&c, &azimuth, &elevation);
    return facet_ocean_look(azimuth + dx * per_pixel, elevation + dy * per_pixel);
}

/* Height above the still water, m; below 0: under water. The direction stays. */
EMSCRIPTEN_KEEPALIVE int facet_ocean_rise(double height_m)
{
    double azimuth, elevation;
    char value[32];
    facet_result result = update_sea(&page.error);
    if (result != FACET_OK)
        return result;
    const facet_camera c = ocean_run_camera(&page.settings.run, &page.settings.run.options);
    find_angles(&c, &azimuth, &elevation);
    snprintf(value, sizeof value, "%.4g", height_m);
    result = facet_ocean_set_option("height-of-eye", value);
    return result == FACET_OK ? facet_ocean_look(azimuth, elevation) : result;
}

/* Narrows the field of view by steps of a wheel; negative: widens it. */
EMSCRIPTEN_KEEPALIVE int facet_ocean_zoom(double steps)
{
    char value[32];
    facet_result result = update_sea(&page.error);
    if (result != FACET_OK)
        return result;
    const facet_camera c = ocean_run_camera(&page.settings.run, &page.settings.run.options);
    double degrees = (double)c.fov_y_rad / DEGREE * pow(0.9, steps);
    snprintf(value, sizeof value, "%.1f", fmin(fmax(degrees, 1.0), 120.0));
    return facet_ocean_set_option("fov", value);
}

/* JSON: time, camera, and what is known of the sea. */
EMSCRIPTEN_KEEPALIVE char *facet_ocean_state(void)
{
    if (update_sea(&page.error) != FACET_OK)
        return NULL;
    const facet_camera c = ocean_run_camera(&page.settings.run, &page.settings.run.options);
    const facet_sea_info info = facet_sea_get_info(page.settings.run.sea);
    double azimuth, elevation;
    find_angles(&c, &azimuth, &elevation);
    text t = {.data = NULL};
    text_json_begin_object(&t, NULL);
    text_json_float(&t, "time", (float)page.time_s);
    text_json_float(&t, "ev100", (float)page.ev100);
    text_json_float(&t, "azimuth", (float)azimuth);
    text_json_float(&t, "elevation", (float)elevation);
    text_json_float(&t, "height", c.eye[1]);
    text_json_float(&t, "fov", c.fov_y_rad / DEGREE);
    text_json_float(&t, "waveHeight", (float)info.height_m);
    text_json_float(&t, "wavePeriod", (float)info.peak_period_s);
    text_json_float(&t, "waveLength", (float)info.peak_length_m);
    text_json_float(&t, "foam", (float)info.foam_coverage);
    text_json_float(&t, "ior", (float)info.ior);
    text_json_end_object(&t);
    return finish(&t);
}
