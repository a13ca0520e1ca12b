/* chart.c - draws a chart: canvas, background, panels. */
#include "plot/chart.h"

#include <math.h>

#include "base/result.h"
#include "plot/chart_view.h"

double view_snap(double px)
{
    return floor(px) + 0.5;
}

void view_line(const drawing *d, double x0, double y0, double x1, double y1, canvas_color color, double width)
{
    /* hairlines scale with the size of the chart, in whole pixels */
    const double whole = fmax(floor(0.9 * d->scale * width), 1.0);
    canvas_move_to(d->canvas, x0, y0);
    canvas_line_to(d->canvas, x1, y1);
    canvas_draw(d->canvas, &(canvas_stroke){.color = color, .width = whole, .is_butt = true});
}

static void draw_header(const drawing *d, const panel_view *v)
{
    const canvas_font title = view_title_font(d), note = view_tick_font(d);
    double y = v->cell.y;
    for (int i = 0; i < v->title_lines; i++, y += 1.25 * title.size)
        label_draw(d->canvas, &v->title[i], title, d->theme->text, LABEL_LEFT, v->cell.x,
                   y + 0.95 * title.size);
    for (int i = 0; i < v->note_lines; i++, y += 1.35 * note.size)
        label_draw(d->canvas, &v->note[i], note, d->theme->muted_text, LABEL_LEFT, v->cell.x,
                   y + 1.05 * note.size);
}

/* A note in a panel whose curves have no visible points. */
static void draw_emptiness(const drawing *d, const panel_view *v)
{
    const chart_box all = {-1e9, -1e9, 2e9, 2e9};
    if (v->panel->field || v->detail != VIEW_ALL || trace_list_length_inside(&v->traces, &all) > 0.0)
        return;
    label_line l;
    label_fit(d->canvas, view_label_font(d), "no data", v->plot.width, &l);
    const double size = view_label_font(d).size, y = v->plot.y + 0.6 * v->plot.height;
    const double x = v->plot.x + 0.5 * v->plot.width;
    canvas_rectangle(d->canvas, x - 0.5 * l.width - 0.5 * size, y - 1.2 * size, l.width + size, 1.7 * size);
    canvas_fill(d->canvas, d->theme->background);
    label_draw(d->canvas, &l, view_label_font(d), d->theme->muted_text, LABEL_CENTER, x, y);
}

static facet_result draw_panel(const drawing *d, panel_view *v, facet_error *error)
{
    draw_header(d, v);
    if (v->panel->kind == CHART_DISC)
        return view_disc_draw(d, v, error);
    if (v->panel->kind == CHART_SURFACE)
        return view_surface_draw(d, v, error);
    facet_result result = layout_trace(d, v, error);
    if (result != FACET_OK)
        return result;
    result = v->panel->kind == CHART_POLAR ? view_polar_draw(d, v, error) : view_xy_draw(d, v, error);
    if (result == FACET_OK) {
        draw_emptiness(d, v);
        legend_draw(d->canvas, &v->legend, d->chart->is_dark);
    }
    trace_list_destroy(&v->traces);
    return result;
}

static facet_result draw_chart(const drawing *d, facet_error *error)
{
    const chart *c = d->chart;
    panel_view *views = mem_zalloc(&d->allocator, c->panel_count, sizeof *views);
    if (!views)
        return fail_memory(error, "panels of a plot", c->panel_count * sizeof *views);
    for (uint32_t i = 0; i < c->panel_count; i++)
        views[i].panel = &c->panels[i];
    canvas_rectangle(d->canvas, 0.0, 0.0, c->width, c->height);
    canvas_fill(d->canvas, d->theme->background);
    facet_result result = layout_create(d, views, error);
    for (uint32_t i = 0; i < c->panel_count && result == FACET_OK; i++)
        result = draw_panel(d, &views[i], error);
    for (uint32_t i = 0; i < c->panel_count; i++)
        trace_list_destroy(&views[i].traces);
    mem_free(views);
    return result;
}

facet_result chart_draw_with(const chart *c, facet_plot_format format, const char *library,
                             const facet_allocator *allocator, unsigned char **bytes, size_t *size,
                             facet_error *error)
{
    *bytes = NULL;
    *size = 0;
    if (format == FACET_PLOT_FORMAT_CSV)
        return chart_write_csv(c, allocator, bytes, size, error);
    if (format == FACET_PLOT_FORMAT_JSON)
        return chart_write_json(c, allocator, bytes, size, error);
    char title[LABEL_SIZE];
    label_clean(c->title, title);
    for (char *p = title; *p; p++)
        *p = *p == '\n' ? ' ' : *p;
    const facet_allocator memory = allocator ? *allocator : (facet_allocator){0};
    drawing d = {.chart = c, .theme = palette_get_theme(c->is_dark), .allocator = memory};
    facet_result result = canvas_create(&(canvas_desc){.allocator = memory,
                                                       .format = format,
                                                       .width = c->width,
                                                       .height = c->height,
                                                       .title = title,
                                                       .library = library},
                                        &d.canvas, error);
    if (result != FACET_OK)
        return result;
    d.scale = layout_scale(c);
    result = draw_chart(&d, error);
    if (result == FACET_OK)
        result = canvas_finish(d.canvas, bytes, size, error);
    canvas_destroy(d.canvas);
    return result;
}

facet_result chart_draw(const chart *c, facet_plot_format format, const facet_allocator *allocator,
                        unsigned char **bytes, size_t *size, facet_error *error)
{
    return chart_draw_with(c, format, NULL, allocator, bytes, size, error);
}
