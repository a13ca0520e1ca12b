/* chart_xy.c - panels with two straight axes: curves over a light grid, fields in false color. */
#include "plot/chart_view.h"

#include <math.h>

/* In units of the size of tick labels. */
static const double TICK = 0.42, LABEL_GAP = 0.4;

static bool is_field(const panel_view *v)
{
    return v->panel->kind == CHART_FIELD && v->panel->field;
}

/* By default the axis of a field ends with the field. */
static chart_axis field_axis(const chart_axis *axis, double from, double to)
{
    chart_axis a = *axis;
    if (!a.has_range) {
        a.has_range = true;
        a.minimum = from;
        a.maximum = to;
    }
    return a;
}

static void measure_bar(const drawing *d, panel_view *v)
{
    const chart_field *field = v->panel->field;
    axis_extent values = AXIS_EXTENT_NONE;
    const bool is_fixed =
        isfinite(field->minimum) && isfinite(field->maximum) && field->minimum < field->maximum;
    if (is_fixed)
        values = (axis_extent){field->minimum, field->maximum};
    else
        axis_extent_add(&values, field->scale, (size_t)field->width * field->height, field->values);
    const double width =
        view_bar_measure(d, field->label, field->scale, values, is_fixed, v->plot.height, &v->bar);
    if (v->detail == VIEW_ALL)
        v->margins.right = fmax(v->margins.right, width);
}

static void create_axes(const drawing *d, panel_view *v)
{
    const chart_panel *p = v->panel;
    chart_axis x = p->x, y = p->y;
    axis_extent ex = AXIS_EXTENT_NONE, ey = AXIS_EXTENT_NONE;
    for (size_t i = 0; i < p->curve_count; i++) {
        axis_extent_add(&ex, p->x.scale, p->curves[i].count, p->curves[i].x);
        axis_extent_add(&ey, p->y.scale, p->curves[i].count, p->curves[i].y);
    }
    const double zero = 0.0;
    if (p->y.has_zero)
        axis_extent_add(&ey, p->y.scale, 1, &zero);
    if (is_field(v)) {
        x = field_axis(&p->x, p->field->x0, p->field->x1);
        y = field_axis(&p->y, p->field->y0, p->field->y1);
    } else if (!x.has_range && x.scale == CHART_LINEAR && ex.maximum > ex.minimum) {
        x.has_range = true; /* curves end at the frame */
        x.minimum = ex.minimum;
        x.maximum = ex.maximum;
    }
    axis_create(d->canvas, view_tick_font(d), &x, ex, v->plot.width, false, &v->x);
    axis_create(d->canvas, view_tick_font(d), &y, ey, v->plot.height, true, &v->y);
}

void view_xy_measure(const drawing *d, panel_view *v)
{
    const chart_panel *p = v->panel;
    const canvas_font tick = view_tick_font(d), name = view_label_font(d);
    create_axes(d, v);
    view_margins *m = &v->margins;
    *m = (view_margins){.left = 2.0, .right = 2.0, .top = 2.0, .bottom = 2.0};
    if (v->detail >= VIEW_TICKS) {
        m->left = tick.size * (TICK + LABEL_GAP) + axis_label_width(d->canvas, tick, &v->y);
        m->bottom = tick.size * (TICK + 1.35);
        const int last = v->x.ticks.count - 1;
        /* half of the last label may protrude */
        m->right = last >= 0 ? 0.5 * label_tick_width(d->canvas, tick, &v->x.ticks.labels[last]) : 0.0;
        m->right = fmax(m->right, 0.6 * tick.size);
        m->top = 0.6 * tick.size;
    }
    if (v->detail >= VIEW_ALL) {
        if (p->y.label && *p->y.label)
            m->left += 1.6 * name.size;
        if ((p->x.label && *p->x.label) || v->x.ticks.power != 0)
            m->bottom += 1.5 * name.size;
        if (v->y.ticks.power != 0 || (is_field(v) && v->bar.ticks.power != 0))
            m->top += 1.3 * tick.size;
    }
    if (is_field(v))
        measure_bar(d, v);
}

void view_xy_trace(const drawing *d, panel_view *v)
{
    (void)d;
    v->x.from = v->plot.x;
    v->x.to = v->plot.x + v->plot.width;
    v->y.from = v->plot.y + v->plot.height;
    v->y.to = v->plot.y;
    for (size_t i = 0; i < v->traces.count; i++) {
        trace *t = &v->traces.traces[i];
        for (size_t k = 0; k < t->count; k++) {
            t->x[k] = axis_place(&v->x, t->curve->x[k]);
            t->y[k] = axis_place(&v->y, t->curve->y[k]);
        }
    }
}

/* ---- drawing ---- */

/* Minor lines of the decades if they are far enough apart. */
static bool has_minor_grid(const drawing *d, const axis_view *a)
{
    const double decades = log10(a->ticks.maximum) - log10(a->ticks.minimum);
    return a->scale == CHART_LOG10 && fabs(a->to - a->from) >= 6.0 * view_tick_font(d).size * decades;
}

static void draw_grid(const drawing *d, const panel_view *v)
{
    const chart_box *b = &v->plot;
    const double right = b->x + b->width, bottom = b->y + b->height;
    for (int i = 0; has_minor_grid(d, &v->x) && i < v->x.ticks.minor_count; i++) {
        const double x = view_snap(axis_place(&v->x, v->x.ticks.minor[i]));
        view_line(d, x, b->y, x, bottom, d->theme->minor_grid, 1.0);
    }
    for (int i = 0; has_minor_grid(d, &v->y) && i < v->y.ticks.minor_count; i++) {
        const double y = view_snap(axis_place(&v->y, v->y.ticks.minor[i]));
        view_line(d, b->x, y, right, y, d->theme->minor_grid, 1.0);
    }
    for (int i = 0; i < v->x.ticks.count; i++) {
        const double x = view_snap(axis_place(&v->x, v->x.ticks.values[i]));
        view_line(d, x, b->y, x, bottom, d->theme->grid, 1.0);
    }
    for (int i = 0; i < v->y.ticks.count; i++) {
        const double y = view_snap(axis_place(&v->y, v->y.ticks.values[i]));
        view_line(d, b->x, y, right, y, d->theme->grid, 1.0);
    }
    /* where values change their sign */
    if (v->y.scale == CHART_LINEAR && v->y.ticks.minimum < 0.0 && v->y.ticks.maximum > 0.0) {
        const double y = view_snap(axis_place(&v->y, 0.0));
        view_line(d, b->x, y, right, y, d->theme->axis, 1.0);
    }
}

static void draw_frame(const drawing *d, const panel_view *v)
{
    const double left = view_snap(v->plot.x), right = view_snap(v->plot.x + v->plot.width);
    const double top = view_snap(v->plot.y), bottom = view_snap(v->plot.y + v->plot.height);
    view_line(d, left, bottom, right, bottom, d->theme->axis, 1.0);
    view_line(d, left, bottom, left, top, d->theme->axis, 1.0);
    if (!is_field(v))
        return;
    view_line(d, right, bottom, right, top, d->theme->axis, 1.0);
    view_line(d, left, top, right, top, d->theme->axis, 1.0);
}

static void draw_ticks(const drawing *d, const panel_view *v)
{
    const canvas_font font = view_tick_font(d);
    const double left = view_snap(v->plot.x), bottom = view_snap(v->plot.y + v->plot.height);
    const double length = TICK * font.size;
    for (int i = 0; i < v->x.ticks.minor_count; i++) {
        const double x = view_snap(axis_place(&v->x, v->x.ticks.minor[i]));
        view_line(d, x, bottom, x, bottom + 0.5 * length, d->theme->axis, 1.0);
    }
    for (int i = 0; i < v->y.ticks.minor_count; i++) {
        const double y = view_snap(axis_place(&v->y, v->y.ticks.minor[i]));
        view_line(d, left - 0.5 * length, y, left, y, d->theme->axis, 1.0);
    }
    double end = -HUGE_VAL;
    for (int i = 0; i < v->x.ticks.count; i++) {
        const double x = axis_place(&v->x, v->x.ticks.values[i]);
        const double half = 0.5 * label_tick_width(d->canvas, font, &v->x.ticks.labels[i]);
        view_line(d, view_snap(x), bottom, view_snap(x), bottom + length, d->theme->axis, 1.0);
        if (x - half < end) /* in a very narrow panel */
            continue;
        end = x + half + 0.3 * font.size;
        label_draw_tick(d->canvas, &v->x.ticks.labels[i], font, d->theme->muted_text, LABEL_CENTER, x,
                        bottom + font.size * (TICK + 1.1));
    }
    end = HUGE_VAL;
    for (int i = 0; i < v->y.ticks.count; i++) {
        const double y = axis_place(&v->y, v->y.ticks.values[i]);
        view_line(d, left - length, view_snap(y), left, view_snap(y), d->theme->axis, 1.0);
        if (y > end)
            continue;
        end = y - 1.1 * font.size;
        label_draw_tick(d->canvas, &v->y.ticks.labels[i], font, d->theme->muted_text, LABEL_RIGHT,
                        left - font.size * (TICK + LABEL_GAP), y + label_middle(font));
    }
}

static void draw_names(const drawing *d, const panel_view *v)
{
    const canvas_font font = view_label_font(d), tick = view_tick_font(d);
    const double bottom = v->plot.y + v->plot.height + tick.size * (TICK + 1.35) + 1.2 * font.size;
    label_line name;
    label_fit(d->canvas, font, v->panel->x.label, v->plot.width, &name);
    label_draw(d->canvas, &name, font, d->theme->text, LABEL_CENTER, v->plot.x + 0.5 * v->plot.width, bottom);
    label_fit(d->canvas, font, v->panel->y.label, v->plot.height, &name);
    const double ticks_width = tick.size * (TICK + LABEL_GAP) + axis_label_width(d->canvas, tick, &v->y);
    label_draw_upright(d->canvas, &name, font, d->theme->text, v->plot.x - ticks_width - 0.85 * font.size,
                       v->plot.y + 0.5 * v->plot.height);
    tick_label power = axis_power(&v->x);
    if (*power.text)
        label_draw_tick(d->canvas, &power, tick, d->theme->muted_text, LABEL_RIGHT, v->plot.x + v->plot.width,
                        bottom);
    power = axis_power(&v->y);
    if (*power.text)
        label_draw_tick(d->canvas, &power, tick, d->theme->muted_text, LABEL_LEFT, v->plot.x,
                        v->plot.y - 0.7 * tick.size);
}

/* The part of the field that is in the plot. */
static facet_result draw_field(const drawing *d, const panel_view *v, facet_error *error)
{
    const chart_field *f = v->panel->field;
    const double x0 = axis_place(&v->x, f->x0), x1 = axis_place(&v->x, f->x1);
    const double y0 = axis_place(&v->y, f->y0), y1 = axis_place(&v->y, f->y1);
    if (!(x1 > x0) || !(y0 > y1) || x1 - x0 > 1e5 || y0 - y1 > 1e5)
        return FACET_OK;
    /* aligned with pixels of the file */
    const chart_box box = {rint(x0), rint(y1), fmax(rint(x1) - rint(x0), 1.0),
                           fmax(rint(y0) - rint(y1), 1.0)};
    canvas_save(d->canvas);
    canvas_rectangle(d->canvas, v->plot.x, v->plot.y, v->plot.width, v->plot.height);
    canvas_clip(d->canvas);
    facet_result result = view_field_draw(d, f, &v->bar, &box, error);
    canvas_restore(d->canvas);
    return result;
}

facet_result view_xy_draw(const drawing *d, panel_view *v, facet_error *error)
{
    facet_result result = FACET_OK;
    if (is_field(v))
        result = draw_field(d, v, error);
    else
        draw_grid(d, v);
    if (result != FACET_OK)
        return result;
    canvas_save(d->canvas);
    const double slack = 2.0 * d->scale; /* lines along the frame keep their width */
    canvas_rectangle(d->canvas, v->plot.x - slack, v->plot.y - slack, v->plot.width + 2.0 * slack,
                     v->plot.height + 2.0 * slack);
    canvas_clip(d->canvas);
    trace_list_draw(d->canvas, &v->traces, &v->plot, d->chart->is_dark, d->scale);
    canvas_restore(d->canvas);
    draw_frame(d, v);
    if (v->detail >= VIEW_TICKS)
        draw_ticks(d, v);
    if (v->detail >= VIEW_ALL) {
        draw_names(d, v);
        if (is_field(v))
            view_bar_draw(d, v->panel->field->label, &v->bar, &v->plot);
    }
    return FACET_OK;
}
