/* view_panels.c - the text over the image: current settings, the sample counter, messages, labels of sides, help. Default
 * settings are omitted, so that the panel stays small. */
#include "view/view_app.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "gl/core/gl_api.h"
#include "scene/scene.h"

/* ---- values ---- */

typedef struct value_rows {
    char *out;
    size_t size, used;
} value_rows;

/* What does not fit is omitted. */
static void add(value_rows *v, const char *name, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
static void add(value_rows *v, const char *name, const char *format, ...)
{
    char value[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(value, sizeof value, format, arguments);
    va_end(arguments);
    int length = snprintf(v->out + v->used, v->size - v->used, "%s%s\t%s", v->used ? "\n" : "", name, value);
    if (length > 0 && (size_t)length < v->size - v->used)
        v->used += (size_t)length;
    else
        v->out[v->used] = 0;
}

static void add_model(value_rows *v, const view_app *a)
{
    const view_state *s = &a->state;
    add(v, "Model", "%.200s", a->path ? path_base_name(a->path) : "built-in scene");
    add(v, "Triangles", "%llu", (unsigned long long)s->counts.drawn_triangles);
    if (s->counts.variants)
        add(v, "Variant", "%.200s", s->pose.has_variant ? a->scene->variants[s->pose.variant] : "none");
    if (s->pose.animation_count == 1) {
        const char *name = a->scene->animations[s->animations[0]].name;
        add(v, "Animation", "%.2f of %.2f s%s%.100s", s->pose.time_s - s->begin_s, s->end_s - s->begin_s,
            *name ? ", " : "", name);
    } else if (s->pose.animation_count) {
        add(v, "Animations", "%u, %.2f of %.2f s", s->pose.animation_count, s->pose.time_s - s->begin_s,
            s->end_s - s->begin_s);
    }
}

static void add_camera(value_rows *v, const view_state *s)
{
    const double degree = 0.017453292519943295; /* pi / 180 */
    if (s->camera != VIEW_NO_CAMERA) {
        const char *name = s->scene->cameras[s->camera].name;
        add(v, "Camera", "%d of %u%s%.200s", s->camera + 1, s->counts.cameras, *name ? ": " : "", name);
        return;
    }
    add(v, "Camera", "%.0f, %.0f degrees, %.3g m%s", (double)s->orbit.azimuth_rad / degree,
        (double)s->orbit.polar_rad / degree, (double)s->orbit.radius,
        s->orbit.is_orthographic ? ", parallel" : "");
}

static uint32_t samples_of(const view_traced *t)
{
    return t->is_current ? t->samples : 0;
}

/* Title of the renderer of the image, or of its right side, which accumulates samples if any side does. */
static const char *title_of(const view_state *s)
{
    facet_render_desc sides[2];
    const char *labels[2];
    view_divider_sides(&s->divider, &s->render, sides, labels);
    return view_renderer_title(sides[1].renderer);
}

/* The sample counter; "": no renderer accumulates. */
static void write_samples(const view_app *a, char *out, size_t size)
{
    const view_state *s = &a->state;
    unsigned sides = view_state_accumulating_sides(s);
    bool is_both = sides == (VIEW_SIDE_LEFT | VIEW_SIDE_RIGHT);
    uint32_t left = samples_of(&a->traced[0]), right = samples_of(&a->traced[1]);
    out[0] = 0;
    if (!sides)
        return;
    if (right >= s->path_samples && (!is_both || left >= s->path_samples))
        snprintf(out, size, "%s: %u samples", title_of(s), s->path_samples);
    else if (is_both)
        snprintf(out, size, "%s: %u | %u of %u samples", title_of(s), left, right, s->path_samples);
    else
        snprintf(out, size, "%s: %u of %u samples", title_of(s), right, s->path_samples);
}

static void add_renderer(value_rows *v, const view_app *a)
{
    const view_state *s = &a->state;
    const facet_render_desc *r = &s->render;
    bool accumulates = view_state_accumulating_sides(s) != 0;
    if (accumulates)
        add(v, title_of(s), "%u of %u samples", samples_of(&a->traced[1]), s->path_samples);
    else
        add(v, title_of(s), "%u samples", r->samples ? r->samples : 4);
    add(v, "Driver", "%.200s", (const char *)glGetString(GL_RENDERER));
    if (!accumulates && a->frame_s > 0.0)
        add(v, "Frame", "%.1f ms%s", 1e3 * a->frame_s,
            a->divisor > 1 ? a->divisor > 2 ? ", a quarter as fine" : ", half as fine" : "");
    if (r->gl.channel != FACET_CHANNEL_LIGHT)
        add(v, "Channel", "%s", view_channel_name(r->gl.channel));
    if (r->gl.brdf != FACET_BRDF_ENERGY)
        add(v, "Specular", "%s", view_brdf_name(r->gl.brdf));
    if (r->energy != FACET_ENERGY_CONSERVING)
        add(v, "Energy", "%s", view_energy_name(r->energy));
    if (r->gl.transparency != FACET_TRANSPARENCY_SORTED)
        add(v, "Transparency", "%s", view_transparency_name(r->gl.transparency));
}

/* The values that Z shows, rows of a name, a tab and a value. */
static void write_values(view_app *a, uint32_t width, uint32_t height, char *out, size_t size)
{
    value_rows v = {.out = out, .size = size};
    const facet_render_desc *r = &a->state.render;
    add_model(&v, a);
    add(&v, "Image", "%u x %u", width, height);
    add_camera(&v, &a->state);
    add_renderer(&v, a);
    add(&v, "Environment", "%.200s", a->environment_name ? path_base_name(a->environment_name) : "default");
    add(&v, "Tone mapping", "%s", view_tonemap_name(r->tonemap));
    if (r->exposure_ev != 0.0f)
        add(&v, "Exposure", "%+.2f", (double)r->exposure_ev);
}

/* ---- panels ---- */

static bool is_made(const view_shown_panel *p, const char *text, float scale, uint32_t max_width,
                    uint32_t max_height)
{
    return p->is_there && strcmp(p->text, text) == 0 && p->scale == scale && p->max_width == max_width &&
           p->max_height == max_height;
}

/* text "": no panel; ignored for VIEW_PANEL_HELP. */
static void make_panel(view_app *a, view_panel_id id, const char *text, float scale, uint32_t max_width,
                       uint32_t max_height)
{
    view_shown_panel *p = &a->panels[id];
    view_state *s = &a->state;
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
                              ? view_overlay_help(scale, max_width, max_height, s->help_page, &s->help_pages,
                                                  allocator, &panel, &error)
                              : view_overlay_text(text, scale, max_width, allocator, &panel, &error);
    p->is_there = result == FACET_OK;
    if (result != FACET_OK) {
        a->has_no_text = true;
        if (a->desc->log.message)
            a->desc->log.message(a->desc->log.user, FACET_LOG_LEVEL_WARNING, error.message);
        return;
    }
    snprintf(p->text, sizeof p->text, "%s", text);
    p->scale = scale;
    p->max_width = max_width;
    p->max_height = max_height;
    view_surface_upload(&p->surface, panel.width, panel.height, panel.pixels);
    view_panel_destroy(&panel);
}

/* Smaller text where the panel would take more than half of the window. */
static float scale_of_values(const view_app *a, const char *values, uint32_t height)
{
    int rows = 1;
    for (const char *p = values; *p; p++)
        rows += *p == '\n';
    float wanted = 0.5f * (float)height / (20.0f * (float)rows);
    return fminf(a->state.scale, fmaxf(wanted, 10.0f / 13.0f * a->state.scale));
}

static void make_help(view_app *a, uint32_t width, uint32_t height)
{
    char text[32] = "";
    view_state *s = &a->state;
    if (s->help_page)
        snprintf(text, sizeof text, "help %u", s->help_page);
    make_panel(a, VIEW_PANEL_HELP, text, s->scale, width, height);
}

void view_panels_make(view_app *a, uint32_t width, uint32_t height, const char *const labels[2])
{
    char values[2048] = "", samples[96] = "";
    float scale = a->state.scale;
    uint32_t margin = (uint32_t)(12.0f * a->state.scale);
    uint32_t inside = width > 2 * margin ? width - 2 * margin : 1;
    uint32_t inside_height = height > 2 * margin ? height - 2 * margin : 1;
    if (a->state.shows_values && a->scene && !a->state.help_page)
        write_values(a, width, height, values, sizeof values);
    else if (a->scene && !a->state.help_page)
        write_samples(a, samples, sizeof samples);
    make_help(a, inside, inside_height);
    make_panel(a, VIEW_PANEL_VALUES, values, scale_of_values(a, values, height), inside * 2 / 3, 0);
    make_panel(a, VIEW_PANEL_MESSAGE, a->message, scale, inside, 0);
    make_panel(a, VIEW_PANEL_SAMPLES, samples, scale, inside, 0);
    make_panel(a, VIEW_PANEL_LEFT, labels[0], scale, inside / 2, 0);
    make_panel(a, VIEW_PANEL_RIGHT, labels[1], scale, inside / 2, 0);
}

static void draw_panel(view_app *a, view_panel_id id, int x, int y, int left, int right)
{
    const view_shown_panel *p = &a->panels[id];
    if (p->is_there)
        view_draw_surface(a->draw, &p->surface, VIEW_LAY_PANEL, x, y, p->surface.width, p->surface.height,
                          left, right);
}

/* Next to the border, or, where a side is narrower than its label, the right label a line below. Returns
 * the y below them. */
static int draw_labels(view_app *a, int width, int border, int margin)
{
    const view_surface *left = &a->panels[VIEW_PANEL_LEFT].surface;
    const view_surface *right = &a->panels[VIEW_PANEL_RIGHT].surface;
    if (!a->panels[VIEW_PANEL_LEFT].is_there || !a->panels[VIEW_PANEL_RIGHT].is_there)
        return margin;
    int x[2];
    const int widths[2] = {(int)left->width, (int)right->width};
    bool is_narrow = view_divider_labels(border, width, margin, widths, x);
    int y = is_narrow ? 2 * margin + (int)left->height : margin;
    draw_panel(a, VIEW_PANEL_LEFT, x[0], margin, 0, width);
    draw_panel(a, VIEW_PANEL_RIGHT, x[1], y, 0, width);
    return y + (int)right->height + margin;
}

/* Bottom left; above a message that leaves no room beside it. */
static void draw_samples(view_app *a, int width, int height, int margin)
{
    const view_shown_panel *samples = &a->panels[VIEW_PANEL_SAMPLES],
                           *message = &a->panels[VIEW_PANEL_MESSAGE];
    int y = height - margin - (int)samples->surface.height;
    if (message->is_there &&
        (int)message->surface.width / 2 + (int)samples->surface.width + 2 * margin > width / 2)
        y -= margin + (int)message->surface.height;
    draw_panel(a, VIEW_PANEL_SAMPLES, margin, y, 0, width);
}

/* Values top right, messages bottom center, labels of sides at the top, help in the middle. */
void view_panels_draw(view_app *a, uint32_t width, uint32_t height)
{
    int margin = (int)(12.0f * a->state.scale);
    int w = (int)width;
    int h = (int)height;
    int border = (int)(a->state.divider.position * width);
    const view_shown_panel *p = a->panels;
    int y = draw_labels(a, w, border, margin);
    draw_panel(a, VIEW_PANEL_VALUES, w - margin - (int)p[VIEW_PANEL_VALUES].surface.width, y, 0, w);
    draw_panel(a, VIEW_PANEL_HELP, (w - (int)p[VIEW_PANEL_HELP].surface.width) / 2,
               (h - (int)p[VIEW_PANEL_HELP].surface.height) / 2, 0, w);
    draw_samples(a, w, h, margin);
    draw_panel(a, VIEW_PANEL_MESSAGE, (w - (int)p[VIEW_PANEL_MESSAGE].surface.width) / 2,
               h - margin - (int)p[VIEW_PANEL_MESSAGE].surface.height, 0, w);
}
