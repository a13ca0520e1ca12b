/* view_values.c - the panel of current settings, rendering and frame time. Default settings are omitted,
 * so that the panel stays small. */
#include "view/view_app.h"

#include <stdarg.h>
#include <stdio.h>

#include "base/file.h"
#include "scene/scene.h"
#include "view/view_state.h"

#include <epoxy/gl.h>

typedef struct values {
    char *out;
    size_t size, used;
} values;

/* What does not fit is omitted. */
static void add(values *v, const char *name, const char *format, ...) __attribute__((format(printf, 3, 4)));
static void add(values *v, const char *name, const char *format, ...)
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

static void add_model(values *v, const view_app *a)
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

static void add_camera(values *v, const view_state *s)
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

void view_values_write_samples(const view_app *a, char *out, size_t size)
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

static void add_renderer(values *v, const view_app *a)
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
    if (r->energy != FACET_ENERGY_GLTF)
        add(v, "Energy", "%s", view_energy_name(r->energy));
    if (r->gl.transparency != FACET_TRANSPARENCY_SORTED)
        add(v, "Transparency", "%s", view_transparency_name(r->gl.transparency));
}

void view_values_write(view_app *a, uint32_t width, uint32_t height, char *out, size_t size)
{
    values v = {.out = out, .size = size};
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
