/* chart_json.c - a chart as JSON, for programs that show it: its numbers, and where each panel is in the drawing of the same
 * size, so that a pointer's position can be read as values. */
#include <math.h>
#include <stdio.h>

#include "base/result.h"
#include "base/text.h"
#include "plot/chart_view.h"

static const char *const KINDS[] = {"xy", "polar", "field", "disc", "surface"}; /* chart_panel_kind */

static void add_number(text *t, const char *key, double value)
{
    char digits[NUMBER_SIZE];
    number_shortest(value, digits);
    text_json_raw(t, key, isfinite(value) ? digits : NULL);
}

static void add_numbers(text *t, const char *key, size_t count, const double *values)
{
    text_json_begin_array(t, key);
    for (size_t i = 0; i < count; i++)
        add_number(t, NULL, values[i]);
    text_json_end_array(t);
}

/* range: of the drawing, NULL without one. */
static void add_axis(text *t, const char *key, const chart_axis *axis, const ticks *range)
{
    text_json_begin_object(t, key);
    text_json_string(t, "label", axis->label ? axis->label : "");
    text_json_string(t, "scale", axis->scale == CHART_LOG10 ? "log10" : "linear");
    text_json_bool(t, "degrees", axis->is_degrees);
    if (range)
        add_numbers(t, "range", 2, (const double[]){range->minimum, range->maximum});
    text_json_end_object(t);
}

static void add_curve(text *t, const chart_curve *curve, bool is_dark)
{
    const canvas_color c = palette_color(&curve->style, is_dark);
    char color[16];
    snprintf(color, sizeof color, "#%02x%02x%02x", (unsigned)(c.r * 255.0 + 0.5),
             (unsigned)(c.g * 255.0 + 0.5), (unsigned)(c.b * 255.0 + 0.5));
    text_json_begin_object(t, NULL);
    text_json_string(t, "name", curve->name ? curve->name : "");
    text_json_string(t, "color", color);
    text_json_integer(t, "dash", curve->style.dash);
    add_numbers(t, "x", curve->count, curve->x);
    add_numbers(t, "y", curve->count, curve->y);
    text_json_end_object(t);
}

static void add_field(text *t, const chart_field *f)
{
    text_json_begin_object(t, "field");
    text_json_string(t, "label", f->label ? f->label : "");
    text_json_integer(t, "width", f->width);
    text_json_integer(t, "height", f->height);
    add_numbers(t, "extent", 4, (const double[]){f->x0, f->x1, f->y0, f->y1});
    add_numbers(t, "values", (size_t)f->width * f->height, f->values);
    text_json_end_object(t);
}

static void add_surface(text *t, const chart_surface *s)
{
    const size_t count = (size_t)s->width * s->height;
    text_json_begin_object(t, "surface");
    text_json_string(t, "label", s->label ? s->label : "");
    text_json_integer(t, "width", s->width);
    text_json_integer(t, "height", s->height);
    add_numbers(t, "x", count, s->x);
    add_numbers(t, "y", count, s->y);
    add_numbers(t, "z", count, s->z);
    add_numbers(t, "values", count, s->values ? s->values : s->z);
    text_json_end_object(t);
}

/* The area of the data in px: a box; of a half disc also the center of its base and the radius. */
static void add_place(text *t, const panel_view *v)
{
    const chart_box *b = &v->plot;
    add_numbers(t, "plot", 4, (const double[]){b->x, b->y, b->width, b->height});
    if (v->panel->kind == CHART_POLAR)
        add_numbers(t, "center", 2,
                    (const double[]){v->y.from, b->y + 0.5 * (b->height + v->y.to - v->y.from)});
    if (v->panel->kind == CHART_POLAR)
        add_number(t, "radius", v->y.to - v->y.from);
}

/* view NULL: there is no drawing. */
static void add_panel(text *t, const chart_panel *p, const panel_view *view, bool is_dark)
{
    const bool has_axes = p->kind == CHART_XY || p->kind == CHART_FIELD;
    text_json_begin_object(t, NULL);
    text_json_string(t, "kind", KINDS[p->kind]);
    text_json_string(t, "title", p->title ? p->title : "");
    text_json_string(t, "note", p->note ? p->note : "");
    if (view)
        add_place(t, view);
    if (has_axes)
        add_axis(t, "x", &p->x, view ? &view->x.ticks : NULL);
    if (has_axes || p->kind == CHART_POLAR)
        add_axis(t, "y", &p->y, view ? &view->y.ticks : NULL);
    text_json_begin_array(t, "curves");
    for (size_t i = 0; i < p->curve_count; i++)
        add_curve(t, &p->curves[i], is_dark);
    text_json_end_array(t);
    if (p->field)
        add_field(t, p->field);
    if (p->surface)
        add_surface(t, p->surface);
    text_json_end_object(t);
}

/* The panels of the drawing, as chart_draw() places them; NULL: this machine cannot draw. */
static facet_result place_panels(const drawing *d, panel_view **out, facet_error *error)
{
    const chart *c = d->chart;
    panel_view *views = mem_zalloc(&d->allocator, c->panel_count ? c->panel_count : 1, sizeof *views);
    *out = views;
    if (!views)
        return fail_memory(error, "panels of a plot", c->panel_count * sizeof *views);
    for (uint32_t i = 0; i < c->panel_count; i++)
        views[i].panel = &c->panels[i];
    facet_result result = layout_create(d, views, error);
    for (uint32_t i = 0; i < c->panel_count && result == FACET_OK; i++)
        if (views[i].panel->kind == CHART_POLAR) {
            result = layout_trace(d, &views[i], error); /* places the half disc */
            trace_list_destroy(&views[i].traces);
        }
    return result;
}

static void add_chart(text *t, const chart *c, const panel_view *views)
{
    text_json_begin_object(t, NULL);
    text_json_string(t, "title", c->title ? c->title : "");
    text_json_integer(t, "width", c->width);
    text_json_integer(t, "height", c->height);
    text_json_begin_array(t, "panels");
    for (uint32_t i = 0; i < c->panel_count; i++)
        add_panel(t, &c->panels[i], views ? &views[i] : NULL, c->is_dark);
    text_json_end_array(t);
    text_json_end_object(t);
    text_add(t, "\n");
}

facet_result chart_write_json(const chart *c, const facet_allocator *allocator, unsigned char **bytes,
                              size_t *size, facet_error *error)
{
    const facet_allocator memory = allocator ? *allocator : (facet_allocator){0};
    text t = {.allocator = memory};
    panel_view *views = NULL;
    *bytes = NULL;
    *size = 0;
    drawing d = {
        .chart = c, .theme = palette_get_theme(c->is_dark), .allocator = memory, .scale = layout_scale(c)};
    const canvas_desc desc = {
        .allocator = memory, .format = FACET_PLOT_FORMAT_SVG, .width = c->width, .height = c->height};
    facet_result result = canvas_create(&desc, &d.canvas, error);
    if (result == FACET_OK)
        result = place_panels(&d, &views, error);
    else if (result == FACET_ERROR_SYSTEM) /* without cairo there are numbers, but no places */
        result = FACET_OK;
    if (result == FACET_OK)
        add_chart(&t, c, views);
    mem_free(views);
    canvas_destroy(d.canvas);
    if (result == FACET_OK && t.has_failed)
        result = fail_memory(error, "JSON of a plot", t.length);
    if (result != FACET_OK) {
        text_destroy(&t);
        return result;
    }
    *bytes = (unsigned char *)t.data;
    *size = t.length;
    return FACET_OK;
}
