/* chart_trace.c - see chart_trace.h. */
#include "plot/chart_trace.h"

#include <math.h>
#include <string.h>

#include "plot/palette.h"

bool trace_list_create(const facet_allocator *allocator, const chart_panel *panel, trace_list *out)
{
    *out = (trace_list){0};
    size_t point_count = 0;
    for (size_t i = 0; i < panel->curve_count; i++)
        if (!checked_add(point_count, panel->curves[i].count, &point_count))
            return false;
    size_t number_count;
    if (!checked_mul(point_count, 2, &number_count))
        return false;
    out->traces = mem_alloc(allocator, panel->curve_count, sizeof *out->traces);
    out->points = mem_alloc(allocator, number_count, sizeof *out->points);
    if (!out->traces || !out->points) {
        trace_list_destroy(out);
        return false;
    }
    double *next = out->points;
    for (size_t i = 0; i < panel->curve_count; i++) {
        const chart_curve *curve = &panel->curves[i];
        out->traces[i] = (trace){.curve = curve, .count = curve->count, .x = next, .y = next + curve->count};
        next += 2 * curve->count;
    }
    out->count = panel->curve_count;
    return true;
}

void trace_list_destroy(trace_list *list)
{
    mem_free(list->traces);
    mem_free(list->points);
    *list = (trace_list){0};
}

bool trace_clip(const chart_box *box, double x[2], double y[2])
{
    const double dx = x[1] - x[0], dy = y[1] - y[0];
    const double direction[4] = {-dx, dx, -dy, dy};
    const double distance[4] = {x[0] - box->x, box->x + box->width - x[0], y[0] - box->y,
                                box->y + box->height - y[0]};
    double enter = 0.0, leave = 1.0;
    for (int i = 0; i < 4; i++) {
        if (direction[i] == 0.0) {
            if (!(distance[i] >= 0.0))
                return false;
            continue;
        }
        const double t = distance[i] / direction[i];
        if (direction[i] < 0.0)
            enter = fmax(enter, t);
        else
            leave = fmin(leave, t);
    }
    if (!(enter <= leave))
        return false;
    const double x0 = x[0], y0 = y[0];
    if (leave < 1.0) {
        x[1] = x0 + leave * dx;
        y[1] = y0 + leave * dy;
    }
    if (enter > 0.0) {
        x[0] = x0 + enter * dx;
        y[0] = y0 + enter * dy;
    }
    return true;
}

static bool is_point(const trace *t, size_t i)
{
    return i < t->count && !isnan(t->x[i]) && !isnan(t->y[i]);
}

static bool is_inside(const chart_box *box, double x, double y)
{
    return x >= box->x && x <= box->x + box->width && y >= box->y && y <= box->y + box->height;
}

double trace_list_length_inside(const trace_list *list, const chart_box *box)
{
    double length = 0.0;
    for (size_t k = 0; k < list->count; k++) {
        const trace *t = &list->traces[k];
        for (size_t i = 0; i < t->count; i++) {
            if (!is_point(t, i))
                continue;
            if (is_inside(box, t->x[i], t->y[i]) && (t->curve->style.has_markers || !is_point(t, i + 1)))
                length += 1.0;
            if (!is_point(t, i + 1))
                continue;
            double x[2] = {t->x[i], t->x[i + 1]}, y[2] = {t->y[i], t->y[i + 1]};
            if (trace_clip(box, x, y))
                length += hypot(x[1] - x[0], y[1] - y[0]);
        }
    }
    return length;
}

/* ---- drawing ---- */

static unsigned dash_of(const trace *t)
{
    return (unsigned)t->curve->style.dash % 4;
}

/* Whether the segment from point i coincides with the same segment of other. */
static bool runs_along(const trace *t, const trace *other, size_t i, double near)
{
    for (size_t k = i; k <= i + 1; k++)
        if (!is_point(t, k) || !is_point(other, k) || fabs(t->x[k] - other->x[k]) > near ||
            fabs(t->y[k] - other->y[k]) > near)
            return false;
    return true;
}

/* The number of earlier traces with the same dash that coincide with the segment from point i. Only the
 * nearest few are compared, as a crowd cannot be distinguished anyway. */
static size_t covered_at(const trace_list *list, size_t index, size_t i, double near)
{
    enum { NEAREST = 32 };
    size_t covered = 0;
    for (size_t k = index > NEAREST ? index - NEAREST : 0; k < index; k++)
        if (dash_of(&list->traces[k]) == dash_of(&list->traces[index]))
            covered += runs_along(&list->traces[index], &list->traces[k], i, near);
    return covered;
}

/* The dash of the rank-th of the coincident lines: a stretch of its own, then gaps for the others. */
static canvas_stroke share_line(canvas_stroke stroke, size_t rank)
{
    const double stretch = 7.0 * stroke.width;
    stroke.dash[0] = stretch;
    stroke.dash[1] = stretch * (double)rank;
    stroke.dash_count = 2;
    stroke.dash_offset = 0.0;
    stroke.is_butt = true;
    return stroke;
}

/* The line from point first to point last, as one path; clipped to box. */
static void draw_stretch(canvas *c, const trace *t, size_t first, size_t last, const chart_box *box,
                         const canvas_stroke *stroke)
{
    bool is_open = false, is_drawn = false;
    for (size_t i = first; i < last; i++) {
        double x[2] = {t->x[i], t->x[i + 1]}, y[2] = {t->y[i], t->y[i + 1]};
        if (!trace_clip(box, x, y)) {
            is_open = false;
            continue;
        }
        if (!is_open)
            canvas_move_to(c, x[0], y[0]);
        canvas_line_to(c, x[1], y[1]);
        is_open = x[1] == t->x[i + 1] && y[1] == t->y[i + 1];
        is_drawn = true;
    }
    if (is_drawn)
        canvas_draw(c, stroke);
}

static void draw_line(canvas *c, const trace_list *list, size_t index, const chart_box *box,
                      const canvas_stroke *stroke)
{
    const trace *t = &list->traces[index];
    for (size_t i = 0; i < t->count; i++) {
        if (!is_point(t, i) || !is_point(t, i + 1))
            continue;
        const size_t rank = covered_at(list, index, i, 0.5 * stroke->width);
        size_t last = i + 1;
        while (is_point(t, last + 1) && covered_at(list, index, last, 0.5 * stroke->width) == rank)
            last++;
        const canvas_stroke shared = rank > 0 ? share_line(*stroke, rank) : *stroke;
        draw_stretch(c, t, i, last, box, &shared);
        i = last - 1;
    }
}

/* Dots where the style has markers, and for isolated points. */
static void draw_markers(canvas *c, const trace *t, const chart_box *box, const canvas_stroke *stroke)
{
    for (size_t i = 0; i < t->count; i++) {
        const bool is_alone = !is_point(t, i + 1) && !(i > 0 && is_point(t, i - 1));
        if (!is_point(t, i) || !is_inside(box, t->x[i], t->y[i]) ||
            !(t->curve->style.has_markers || is_alone))
            continue;
        canvas_arc(c, t->x[i], t->y[i], 1.6 * stroke->width, 0.0, 6.283185307179586);
        canvas_close(c);
        canvas_fill(c, stroke->color);
    }
}

void trace_list_draw(canvas *c, const trace_list *list, const chart_box *box, bool is_dark, double scale)
{
    for (unsigned dash = 0; dash < 4; dash++)
        for (size_t i = 0; i < list->count; i++) {
            const trace *t = &list->traces[i];
            if (dash_of(t) != dash)
                continue;
            const canvas_stroke stroke = palette_stroke(&t->curve->style, is_dark, scale);
            /* lines continue a little outside, which hides their ends */
            const double m = 2.0 * stroke.width;
            const chart_box wide = {box->x - m, box->y - m, box->width + 2.0 * m, box->height + 2.0 * m};
            draw_line(c, list, i, &wide, &stroke);
            draw_markers(c, t, box, &stroke);
        }
}
