/* view_show.c - what the window shows: the model by OpenGL or path traced, one way or two beside each other, text over
 * it. */
#include "view/view_app.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/clock.h"
#include "scene/scene.h"
#include "view/view_camera.h"
#include "view/view_names.h"

#include <epoxy/gl.h>

/* ---- the picture ---- */

/* The orbit's radius and target where they are to be found, or the file's camera at this moment. */
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
    find_camera(a, width, height, NULL); /* a key may have asked for it since the last picture */
    facet_render_desc base = view_state_desc(&a->state, width, height, camera);
    base.environment = a->environment;
    view_divider_sides(&a->state.divider, &base, sides, labels);
    if (sides[1].integrator == FACET_INTEGRATOR_PATH)
        sides[1].samples = a->state.path_samples;
    return sides[1];
}

/* Traces what is still, and draws with OpenGL what moves: a picture that is one sample old says less than one that keeps
 * up. */
static bool trace(view_app *a, const facet_render_desc *side)
{
    facet_render_desc desc = *side;
    if (a->state.is_held || a->state.is_playing) {
        if (a->trace_is_current)
            view_trace_stop(a->tracer);
        a->trace_is_current = false;
        return false;
    }
    desc.samples = a->state.path_samples;
    if (view_trace_start(a->tracer, a->scene, &desc))
        a->trace_is_current = false;
    view_picture picture;
    if (view_trace_take(a->tracer, &picture, &a->trace_samples)) {
        view_surface_upload(&a->traced, picture.width, picture.height, picture.pixels);
        view_picture_destroy(&picture);
        a->trace_is_current = true;
    }
    return a->trace_is_current;
}

/* As facet render draws it: in floats of 32 bits, and with the eye of a parallel view where it has it. */
static facet_result draw_for_file(view_app *a, view_surface *to, const facet_render_desc *wanted,
                                  facet_error *error)
{
    facet_render_desc desc = *wanted;
    facet_camera camera;
    facet_image *image = NULL;
    view_picture picture = {0};
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
        result = view_picture_create(&view, &a->desc->allocator, &picture, error);
    }
    if (result == FACET_OK)
        view_surface_upload(to, picture.width, picture.height, picture.pixels);
    view_picture_destroy(&picture);
    a->host->image_destroy(image);
    return result;
}

static facet_result draw_side(view_app *a, int side, facet_render_desc *desc, facet_error *error)
{
    view_surface *s = &a->sides[side];
    facet_render_stats stats;
    desc->integrator = FACET_INTEGRATOR_GL;
    if (a->is_for_file)
        return draw_for_file(a, s, desc, error);
    facet_result result = view_surface_resize(s, &a->context, desc->width, desc->height, error);
    return result == FACET_OK ? gl_renderer_present(a->renderer, desc, s->framebuffer, 0, 0, &stats, error)
                              : result;
}

/* What each side shows, in *shown[2]; labels are empty without a divider. */
static facet_result draw_picture(view_app *a, uint32_t width, uint32_t height, const view_surface *shown[2],
                                 const char *labels[2], facet_error *error)
{
    facet_camera camera;
    facet_render_desc sides[2];
    facet_result result = find_camera(a, width, height, error);
    if (result != FACET_OK)
        return result;
    facet_render_desc base = view_state_desc(&a->state, width, height, &camera);
    base.environment = a->environment;
    view_divider_sides(&a->state.divider, &base, sides, labels);
    bool is_divided = a->state.divider.comparison != VIEW_COMPARE_NOTHING;
    for (int i = is_divided ? 0 : 1; i < 2 && result == FACET_OK; i++) {
        shown[i] = &a->sides[i];
        bool is_path = sides[i].integrator == FACET_INTEGRATOR_PATH;
        if (is_path && trace(a, &sides[i]))
            shown[i] = &a->traced;
        else if (a->needs_picture || is_path)
            result = draw_side(a, i, &sides[i], error);
    }
    if (!is_divided)
        shown[0] = shown[1];
    return result;
}

/* ---- text ---- */

static bool is_made(const view_shown_panel *p, const char *text, float scale, uint32_t max_width,
                    uint32_t max_height)
{
    return p->is_there && strcmp(p->text, text) == 0 && p->scale == scale && p->max_width == max_width &&
           p->max_height == max_height;
}

/* text "": none; for VIEW_PANEL_HELP any. */
static void make_panel(view_app *a, view_panel_id id, const char *text, uint32_t max_width,
                       uint32_t max_height)
{
    view_shown_panel *p = &a->panels[id];
    float scale = a->state.scale;
    if (!*text || a->has_no_text) {
        p->is_there = false;
        return;
    }
    if (is_made(p, text, scale, max_width, max_height))
        return;
    view_panel panel;
    facet_error error;
    const facet_allocator *allocator = &a->desc->allocator;
    facet_result result = id == VIEW_PANEL_HELP
                              ? view_overlay_help(scale, max_width, max_height, allocator, &panel, &error)
                              : view_overlay_text(text, scale, max_width, allocator, &panel, &error);
    p->is_there = result == FACET_OK;
    if (result != FACET_OK) {
        a->has_no_text = true;
        if (a->desc->log.message)
            a->desc->log.message(a->desc->log.user, FACET_LOG_WARNING, error.message);
        return;
    }
    snprintf(p->text, sizeof p->text, "%s", text);
    p->scale = scale;
    p->max_width = max_width;
    p->max_height = max_height;
    view_surface_upload(&p->surface, panel.width, panel.height, panel.pixels);
    view_panel_destroy(&panel);
}

/* Name, how it is drawn, how long that took. */
static void write_values(view_app *a, uint32_t width, uint32_t height, char *out, size_t size)
{
    const view_state *s = &a->state;
    const facet_render_desc *r = &s->render;
    bool is_path = r->integrator == FACET_INTEGRATOR_PATH || s->divider.comparison == VIEW_COMPARE_RENDERER;
    int used = snprintf(out, size, "Triangles\t%llu\nPicture\t%u x %u\nRenderer\t%s\n",
                        (unsigned long long)s->counts.drawn_triangles, width, height,
                        is_path ? "path tracing" : "OpenGL");
    char *at = out + used;
    char *end = out + size;
    if (is_path)
        at += snprintf(at, (size_t)(end - at), "Samples\t%u of %u\n",
                       a->trace_is_current ? a->trace_samples : 0, s->path_samples);
    else
        at += snprintf(at, (size_t)(end - at), "Frame\t%.2f ms\nChannel\t%s\nSpecular\t%s\n",
                       1e3 * a->frame_s, view_channel_name(r->gl.channel), view_brdf_name(r->gl.brdf));
    at += snprintf(at, (size_t)(end - at), "Energy\t%s\nTone mapping\t%s\nExposure\t%+.2f\n",
                   view_energy_name(r->energy), view_tonemap_name(r->tonemap), (double)r->exposure_ev);
    at += snprintf(at, (size_t)(end - at), "Environment\t%s",
                   a->environment_name ? a->environment_name : "default");
    if (s->pose.animation_count && at < end)
        snprintf(at, (size_t)(end - at), "\nAnimation\t%.2f of %.2f s", s->pose.time_s - s->begin_s,
                 s->end_s - s->begin_s);
}

static void make_panels(view_app *a, uint32_t width, uint32_t height, const char *const labels[2])
{
    char values[2048] = "";
    uint32_t margin = (uint32_t)(12.0f * a->state.scale);
    uint32_t inside = width > 2 * margin ? width - 2 * margin : 1;
    uint32_t inside_height = height > 2 * margin ? height - 2 * margin : 1;
    if (a->state.shows_values && a->scene && !a->state.shows_help)
        write_values(a, width, height, values, sizeof values);
    make_panel(a, VIEW_PANEL_HELP, a->state.shows_help ? "help" : "", inside, inside_height);
    make_panel(a, VIEW_PANEL_VALUES, values, inside, 0);
    make_panel(a, VIEW_PANEL_MESSAGE, a->message, inside, 0);
    make_panel(a, VIEW_PANEL_LEFT, labels[0], inside / 2, 0);
    make_panel(a, VIEW_PANEL_RIGHT, labels[1], inside / 2, 0);
}

static void draw_panel(view_app *a, view_panel_id id, int x, int y, int left, int right)
{
    const view_shown_panel *p = &a->panels[id];
    if (p->is_there)
        view_draw_surface(a->draw, &p->surface, VIEW_LAY_PANEL, x, y, p->surface.width, p->surface.height,
                          left, right);
}

/* Values top right, messages bottom middle, what the sides are at their feet beside the border, help in the middle. */
static void draw_panels(view_app *a, uint32_t width, uint32_t height)
{
    int margin = (int)(12.0f * a->state.scale);
    int w = (int)width;
    int h = (int)height;
    int border = (int)(a->state.divider.position * width);
    const view_shown_panel *p = a->panels;
    draw_panel(a, VIEW_PANEL_LEFT, border - margin - (int)p[VIEW_PANEL_LEFT].surface.width, margin, 0,
               border);
    draw_panel(a, VIEW_PANEL_RIGHT, border + margin, margin, border, w);
    draw_panel(a, VIEW_PANEL_VALUES, w - margin - (int)p[VIEW_PANEL_VALUES].surface.width,
               p[VIEW_PANEL_RIGHT].is_there ? 2 * margin + (int)p[VIEW_PANEL_RIGHT].surface.height : margin,
               0, w);
    draw_panel(a, VIEW_PANEL_HELP, (w - (int)p[VIEW_PANEL_HELP].surface.width) / 2,
               (h - (int)p[VIEW_PANEL_HELP].surface.height) / 2, 0, w);
    draw_panel(a, VIEW_PANEL_MESSAGE, (w - (int)p[VIEW_PANEL_MESSAGE].surface.width) / 2,
               h - margin - (int)p[VIEW_PANEL_MESSAGE].surface.height, 0, w);
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

/* square 0: transparent pixels stay so. */
static facet_result compose(view_app *a, uint32_t framebuffer, uint32_t width, uint32_t height, float square,
                            bool has_panels, facet_error *error)
{
    const view_surface *shown[2] = {NULL, NULL};
    const char *labels[2] = {"", ""};
    if (a->scene) {
        facet_result result = draw_picture(a, width, height, shown, labels, error);
        if (result != FACET_OK)
            return result;
    }
    if (has_panels)
        make_panels(a, width, height, labels);
    view_draw_begin(a->draw, framebuffer, width, height, square);
    if (!a->scene) {
        glClearColor(0.18f, 0.18f, 0.19f, 1.0f);
        glClear(GL_COLOR_BUFFER_BIT);
    } else {
        bool is_divided = a->state.divider.comparison != VIEW_COMPARE_NOTHING;
        int border = is_divided ? (int)(a->state.divider.position * width) : 0;
        view_draw_surface(a->draw, shown[0], VIEW_LAY_PICTURE, 0, 0, width, height, 0, border);
        view_draw_surface(a->draw, shown[1], VIEW_LAY_PICTURE, 0, 0, width, height, border, (int)width);
        if (is_divided && has_panels)
            draw_border(a, border);
    }
    if (has_panels)
        draw_panels(a, width, height);
    return gl_context_check(&a->context, "the window", error);
}

static void measure_frame(view_app *a, double start)
{
    if (!a->state.shows_values || !a->needs_picture)
        return;
    glFinish(); /* else it is how long asking took */
    double s = clock_seconds() - start;
    bool is_moving = a->state.is_playing || a->state.is_held;
    a->frame_s = is_moving && a->frame_s > 0.0 ? a->frame_s + 0.2 * (s - a->frame_s) : s;
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
    a->state.width = width;
    a->state.height = height;
    a->state.scale = view_window_scale(w);
    facet_result result = compose(a, 0, width, height, 8.0f * a->state.scale, true, error);
    if (result != FACET_OK)
        return result;
    measure_frame(a, start);
    a->needs_picture = a->needs_frame = false;
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
    a->needs_picture = true; /* sides may have another size */
    a->is_for_file = !has_panels;
    if (result == FACET_OK)
        result = compose(a, a->shot.framebuffer, width, height, has_panels ? 8.0f * a->state.scale : 0.0f,
                         has_panels, error);
    a->is_for_file = false;
    return result;
}

void view_show_end(view_app *a)
{
    for (int i = 0; i < 2; i++)
        view_surface_destroy(&a->sides[i]);
    view_surface_destroy(&a->traced);
    view_surface_destroy(&a->shot);
    for (int i = 0; i < VIEW_PANEL_COUNT; i++)
        view_surface_destroy(&a->panels[i].surface);
}
