/* view_show.c - what the window shows: the model by OpenGL or path tracing, one image or two side by side,
 * with the overlay. */
#include "view/view_app.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/clock.h"
#include "base/result.h"
#include "gl/core/gl_api.h"
#include "scene/scene.h"
#include "view/view_camera.h"

/* ---- the image ---- */

/* Finds the orbit's radius and target where needed, or the file's camera at this time. */
static facet_result find_camera(view_app *a, uint32_t width, uint32_t height, facet_error *error)
{
    view_state *s = &a->state;
    if (s->camera != VIEW_NO_CAMERA)
        return a->host->camera_from_scene(s->scene, &s->pose, (uint32_t)s->camera, &s->file_camera, error);
    return view_state_frame(s, (float)width / (float)height, error);
}

facet_render_desc view_show_desc(view_app *a, uint32_t width, uint32_t height, facet_camera *camera)
{
    facet_render_desc sides[2];
    const char *labels[2];
    find_camera(a, width, height, NULL); /* a key may have asked for it since the last image */
    facet_render_desc base = view_state_desc(&a->state, width, height, camera);
    base.environment = a->environment;
    view_divider_sides(&a->state.divider, &base, sides, labels);
    if (view_renderer_accumulates(sides[1].renderer))
        sides[1].samples = a->state.path_samples;
    return sides[1];
}

/* Path traces still images, and draws moving ones by OpenGL: an image of one sample says less than one
 * that is up to date. Changes by a held pointer that do not affect the image, such as the divider's, do
 * not interrupt tracing. */
static bool trace(view_app *a, int side, const facet_render_desc *wanted)
{
    facet_render_desc desc = *wanted;
    view_traced *t = &a->traced[side];
    desc.samples = a->state.path_samples;
    if (a->state.is_playing || (a->state.is_held && !view_trace_is_of(t->tracer, a->scene, &desc))) {
        if (t->is_current)
            view_trace_stop(t->tracer);
        t->is_current = false;
        return false;
    }
    if (view_trace_start(t->tracer, a->scene, &desc))
        t->is_current = false;
    view_image display;
    if (view_trace_take(t->tracer, &display, &t->samples)) {
        view_surface_upload(&t->surface, display.width, display.height, display.pixels);
        view_image_destroy(&display);
        t->is_current = true;
    }
    return t->is_current;
}

/* The left side is traced only next to the right one. */
static void stop_left(view_app *a)
{
    view_trace_stop(a->traced[0].tracer);
    a->traced[0].is_current = false;
}

/* As facet render draws it: in floats of 32 bits, and with its eye for a parallel view. */
static facet_result draw_for_file(view_app *a, view_surface *to, const facet_render_desc *wanted,
                                  facet_error *error)
{
    facet_render_desc desc = *wanted;
    facet_camera camera;
    facet_image *image = NULL;
    view_image display = {0};
    facet_orbit orbit = view_camera_round(&a->state.orbit);
    facet_result result = FACET_OK;
    if (a->state.camera == VIEW_NO_CAMERA) {
        result = scene_fit_orbit(a->scene, &desc.pose, &orbit, (float)desc.width / (float)desc.height,
                                 &camera, error);
        desc.camera = &camera;
    }
    if (result == FACET_OK)
        result = a->host->render_gl(a->renderer, &desc, &image, error);
    if (result == FACET_OK) {
        facet_image_view view = a->host->image_get_layer(image, 0);
        result = view_image_create(&view, &a->desc->allocator, &display, error);
    }
    if (result == FACET_OK)
        view_surface_upload(to, display.width, display.height, display.pixels);
    view_image_destroy(&display);
    a->host->image_destroy(image);
    return result;
}

static facet_result draw_side(view_app *a, int side, facet_render_desc *desc, facet_error *error)
{
    view_surface *s = &a->sides[side];
    facet_render_stats stats;
    desc->renderer = FACET_RENDERER_KIND_GL;
    a->has_drawn = true;
    if (a->is_for_file)
        return draw_for_file(a, s, desc, error);
    desc->quality = a->is_draft ? FACET_QUALITY_DRAFT : FACET_QUALITY_NORMAL;
    desc->width = desc->crop[2] = (desc->width + a->divisor - 1) / a->divisor;
    desc->height = desc->crop[3] = (desc->height + a->divisor - 1) / a->divisor;
    TRY(view_surface_resize(s, &a->context, desc->width, desc->height, error));
    return gl_renderer_present(a->renderer, desc, s->framebuffer, 0, 0, &stats, error);
}

/* What each side shows, in *shown[2]; labels are empty without a divider. */
static facet_result draw_sides(view_app *a, uint32_t width, uint32_t height, const view_surface *shown[2],
                               const char *labels[2], facet_error *error)
{
    facet_camera camera;
    facet_render_desc sides[2];
    TRY(find_camera(a, width, height, error));
    facet_render_desc base = view_state_desc(&a->state, width, height, &camera);
    base.environment = a->environment;
    view_divider_sides(&a->state.divider, &base, sides, labels);
    bool is_divided = a->state.divider.comparison != VIEW_COMPARE_NOTHING;
    if (a->state.divider.comparison == VIEW_COMPARE_VARIANT) {
        snprintf(a->variant, sizeof a->variant, "Variant: %.100s", a->scene->variants[sides[1].pose.variant]);
        labels[1] = a->variant;
    }
    if (!is_divided || !view_renderer_accumulates(sides[0].renderer))
        stop_left(a);
    for (int i = is_divided ? 0 : 1; i < 2; i++) {
        shown[i] = &a->sides[i];
        bool accumulates = view_renderer_accumulates(sides[i].renderer);
        if (accumulates && trace(a, i, &sides[i]))
            shown[i] = &a->traced[i].surface;
        else if (a->needs_image || accumulates)
            TRY(draw_side(a, i, &sides[i], error));
    }
    if (!is_divided)
        shown[0] = shown[1];
    return FACET_OK;
}

/* ---- all of it ---- */

static void draw_border(view_app *a, int x)
{
    const float dark[4] = {0.0f, 0.0f, 0.0f, 0.5f};
    const float light[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    int thickness = (int)fmaxf(1.0f, roundf(2.0f * a->state.scale));
    view_draw_bar(a->draw, x, thickness + 2, dark);
    view_draw_bar(a->draw, x, thickness, light);
}

/* square 0: transparent pixels stay transparent. */
static facet_result compose(view_app *a, uint32_t framebuffer, uint32_t width, uint32_t height, float square,
                            bool has_panels, facet_error *error)
{
    const view_surface *shown[2] = {NULL, NULL};
    const char *labels[2] = {"", ""};
    if (a->scene) {
        TRY(draw_sides(a, width, height, shown, labels, error));
    }
    if (has_panels)
        view_panels_make(a, width, height, labels);
    view_draw_begin(a->draw, framebuffer, width, height, square);
    if (!a->scene) {
        glClearColor(0.18f, 0.18f, 0.19f, 1.0f);
        glClear(GL_COLOR_BUFFER_BIT);
    } else {
        bool is_divided = a->state.divider.comparison != VIEW_COMPARE_NOTHING;
        int border = is_divided ? (int)(a->state.divider.position * width) : 0;
        view_draw_surface(a->draw, shown[0], VIEW_LAY_IMAGE, 0, 0, width, height, 0, border);
        view_draw_surface(a->draw, shown[1], VIEW_LAY_IMAGE, 0, 0, width, height, border, (int)width);
        if (is_divided && has_panels)
            draw_border(a, border);
    }
    if (has_panels)
        view_panels_draw(a, width, height);
    return gl_context_check(&a->context, "the window", error);
}

/* Waits for the driver: otherwise it would measure only the submission. */
static void measure_frame(view_app *a, double start, bool is_moving)
{
    if (!a->has_drawn || !a->needs_image || (a->script.count && !a->state.shows_values))
        return;
    glFinish();
    double s = clock_seconds() - start;
    view_pace_measure(&a->pace, a->divisor, s);
    bool is_smoothed = (a->state.is_playing || is_moving) && a->frame_s > 0.0;
    a->frame_s = is_smoothed ? a->frame_s + 0.2 * (s - a->frame_s) : s;
}

facet_result view_show(view_app *a, facet_error *error)
{
    uint32_t width;
    uint32_t height;
    view_window *w = a->window;
    view_window_size(w, &width, &height);
    if (!width || !height)
        return FACET_OK;
    double start = clock_seconds();
    bool is_moving = !a->script.count && start < a->moves_until_s;
    uint32_t divisor = view_pace_divisor(&a->pace, is_moving);
    bool is_playing = !a->script.count && a->state.is_playing;
    bool is_draft = view_pace_drafts(&a->pace, is_moving || is_playing);
    if (divisor != a->divisor || is_draft != a->is_draft) {
        a->needs_image = true;
        a->frame_s = 0.0;
    }
    a->divisor = divisor;
    a->is_draft = is_draft;
    a->has_drawn = false;
    a->state.width = width;
    a->state.height = height;
    a->state.scale = view_window_scale(w);
    TRY(compose(a, 0, width, height, 8.0f * a->state.scale, true, error));
    bool had_image = a->needs_image;
    measure_frame(a, start, is_moving);
    a->needs_image = false;
    /* to show the measured time */
    a->needs_frame = had_image && a->state.shows_values && !a->state.is_playing;
    view_window_present(w);
    return FACET_OK;
}

facet_result view_show_into(view_app *a, bool has_panels, facet_error *error)
{
    uint32_t width;
    uint32_t height;
    view_window_size(a->window, &width, &height);
    width = width ? width : a->desc->render.width;
    height = height ? height : a->desc->render.height;
    facet_result result = view_surface_resize(&a->shot, &a->context, width, height, error);
    a->needs_image = true; /* sides may have another size */
    a->divisor = 1;
    a->is_draft = false;
    a->is_for_file = !has_panels;
    if (result == FACET_OK)
        result = compose(a, a->shot.framebuffer, width, height, has_panels ? 8.0f * a->state.scale : 0.0f,
                         has_panels, error);
    a->is_for_file = false;
    return result;
}

void view_show_end(view_app *a)
{
    for (int i = 0; i < 2; i++) {
        view_surface_destroy(&a->sides[i]);
        view_surface_destroy(&a->traced[i].surface);
    }
    view_surface_destroy(&a->shot);
    for (int i = 0; i < VIEW_PANEL_COUNT; i++)
        view_surface_destroy(&a->panels[i].surface);
}
