/* chart_layout.c - where title, panels, margins and legends of a chart are. See chart_view.h. */
#include "plot/chart_view.h"

#include <math.h>

#include "base/result.h"

/* Panels narrower than this, px, get fewer columns if that makes them larger. */
static const double NARROW = 200.0;

/* The smaller of a panel's width and 1.4 times its height, px. */
static double panel_size(const chart *c, uint32_t columns)
{
    const uint32_t rows = (c->panel_count + columns - 1) / columns;
    return fmin((double)c->width / columns, 1.4 * c->height / (rows > 0 ? rows : 1));
}

static uint32_t column_count(const chart *c)
{
    const uint32_t wanted = c->columns > 0 ? c->columns : 1;
    uint32_t columns = wanted < c->panel_count ? wanted : c->panel_count > 0 ? c->panel_count : 1;
    if ((double)c->width / columns >= NARROW)
        return columns;
    for (uint32_t fewer = columns - 1; fewer > 0; fewer--)
        if (panel_size(c, fewer) > panel_size(c, columns))
            columns = fewer;
    return columns;
}

static uint32_t row_count(const chart *c)
{
    const uint32_t columns = column_count(c), rows = (c->panel_count + columns - 1) / columns;
    return rows > 0 ? rows : 1;
}

double layout_scale(const chart *c)
{
    const double size =
        fmin(sqrt((double)c->width * c->height / (960.0 * 640.0)), fmin(c->width, c->height) / 300.0);
    const double whole = size < 1.0 ? sqrt(size) : size;
    const double shared = whole * pow((double)column_count(c) * row_count(c), -0.18);
    return fmax(shared, fmin(whole, 0.72)); /* text below 8 px is not readable */
}

static bool is_cartesian(const panel_view *v)
{
    return v->panel->kind == CHART_XY || v->panel->kind == CHART_FIELD;
}

/* The left end and the width of a legend below: those of the plot. */
static chart_box room_below(const panel_view *v)
{
    const double x = is_cartesian(v) ? v->plot.x - 0.55 * v->legend.font.size : v->cell.x;
    return (chart_box){.x = x, .width = v->cell.x + v->cell.width - x};
}

static void measure(const drawing *d, panel_view *v)
{
    switch (v->panel->kind) {
    case CHART_POLAR:
        view_polar_measure(d, v);
        break;
    case CHART_DISC:
        view_disc_measure(d, v);
        break;
    case CHART_SURFACE:
        view_surface_measure(d, v);
        break;
    default:
        view_xy_measure(d, v);
    }
    const double gap = 0.8 * v->legend.font.size;
    if (v->legend.place == LEGEND_RIGHT)
        v->margins.right += v->legend.width + gap;
    if (v->legend.place == LEGEND_BELOW)
        v->margins.bottom += legend_rows_height(&v->legend, room_below(v).width) + gap;
}

/* ---- panels in their grid ---- */

/* Draws the title of the chart; returns the y below which panels begin. */
static double draw_title(const drawing *d, double margin)
{
    const canvas_font font = {.size = 16.0 * d->scale, .is_bold = true};
    label_line lines[2];
    const int count = label_wrap(d->canvas, font, d->chart->title, d->chart->width - 2.0 * margin, 2, lines);
    if (1.3 * count * font.size > 0.3 * d->chart->height)
        return margin;
    for (int i = 0; i < count; i++)
        label_draw(d->canvas, &lines[i], font, d->theme->text, LABEL_LEFT, margin,
                   margin + font.size * (0.8 + 1.25 * i));
    return margin + (count > 0 ? font.size * (1.25 * count + 0.55) : 0.0);
}

static void make_header(const drawing *d, panel_view *v)
{
    const canvas_font title = view_title_font(d), note = view_tick_font(d);
    v->title_lines = label_wrap(d->canvas, title, v->panel->title, v->cell.width, 2, v->title);
    v->note_lines = label_wrap(d->canvas, note, v->panel->note, v->cell.width, 2, v->note);
    v->header = 1.25 * title.size * v->title_lines + 1.35 * note.size * v->note_lines;
    if (v->header > 0.0)
        v->header += 0.5 * title.size;
    if (v->header > 0.3 * v->cell.height && v->note_lines + v->title_lines > 1) { /* the plot has priority */
        v->note_lines = 0;
        v->title_lines = v->title_lines > 0;
        label_fit(d->canvas, title, v->panel->title, v->cell.width, &v->title[0]);
        v->header = 1.75 * title.size * v->title_lines;
    }
}

static view_detail choose_detail(const drawing *d, const chart_box *cell)
{
    const double size = view_tick_font(d).size;
    if (cell->width < 7.0 * size || cell->height < 6.0 * size)
        return VIEW_FRAME;
    return cell->width < 14.0 * size || cell->height < 11.0 * size ? VIEW_TICKS : VIEW_ALL;
}

static void place_cells(const drawing *d, panel_view *views)
{
    const chart *c = d->chart;
    const uint32_t columns = column_count(c), rows = row_count(c);
    const double margin = fmin(14.0 * d->scale, 0.06 * fmin(c->width, c->height));
    const double top = draw_title(d, margin);
    const double gap_x = fmin(22.0 * d->scale, 0.1 * c->width / columns);
    const double gap_y = fmin(20.0 * d->scale, 0.1 * c->height / rows);
    const double width = (c->width - 2.0 * margin - gap_x * (columns - 1)) / columns;
    const double height = (c->height - margin - top - gap_y * (rows - 1)) / rows;
    for (uint32_t i = 0; i < c->panel_count; i++) {
        panel_view *v = &views[i];
        v->cell = (chart_box){.x = margin + (i % columns) * (width + gap_x),
                              .y = top + (i / columns) * (height + gap_y),
                              .width = fmax(width, 1.0),
                              .height = fmax(height, 1.0)};
        v->detail = choose_detail(d, &v->cell);
        if (v->detail >= VIEW_TICKS)
            make_header(d, v);
        v->plot = v->cell;
    }
}

/* The plot is the cell without its margins. */
static void place_plot(panel_view *v)
{
    const view_margins *m = &v->margins;
    const double left = rint(v->cell.x + m->left), top = rint(v->cell.y + v->header + m->top);
    v->plot = (chart_box){.x = left,
                          .y = top,
                          .width = fmax(rint(v->cell.x + v->cell.width - m->right) - left, 4.0),
                          .height = fmax(rint(v->cell.y + v->cell.height - m->bottom) - top, 4.0)};
}

static void align_rows(panel_view *a, panel_view *b)
{
    a->margins.top = b->margins.top = fmax(a->margins.top, b->margins.top);
    a->margins.bottom = b->margins.bottom = fmax(a->margins.bottom, b->margins.bottom);
}

static void align_columns(panel_view *a, panel_view *b)
{
    a->margins.left = b->margins.left = fmax(a->margins.left, b->margins.left);
    a->margins.right = b->margins.right = fmax(a->margins.right, b->margins.right);
}

/* Axes in a column, and axes in a row, are aligned; discs, half discs and surfaces of a chart are of equal
 * size. */
static void align(const chart *c, panel_view *views)
{
    const uint32_t columns = column_count(c);
    for (int pass = 0; pass < 2; pass++) /* the second pass propagates margins that the first found late */
        for (uint32_t i = 0; i < c->panel_count; i++)
            for (uint32_t k = 0; k < i; k++) {
                panel_view *a = &views[i], *b = &views[k];
                const bool is_row = i / columns == k / columns, is_column = i % columns == k % columns;
                const bool is_same = !is_cartesian(a) && a->panel->kind == b->panel->kind;
                const bool are_axes = is_cartesian(a) && is_cartesian(b);
                if (is_row)
                    a->header = b->header = fmax(a->header, b->header);
                if (is_same || (are_axes && is_row))
                    align_rows(a, b);
                if (is_same || (are_axes && is_column))
                    align_columns(a, b);
            }
}

static void measure_all(const drawing *d, panel_view *views)
{
    const chart *c = d->chart;
    /* the number of ticks depends on the size of the plot, and that on the width of their labels */
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t i = 0; i < c->panel_count; i++)
            measure(d, &views[i]);
        align(c, views);
        for (uint32_t i = 0; i < c->panel_count; i++)
            place_plot(&views[i]);
    }
}

/* ---- legends ---- */

facet_result layout_trace(const drawing *d, panel_view *v, facet_error *error)
{
    if (!trace_list_create(&d->allocator, v->panel, &v->traces))
        return fail_memory(error, "curves of a plot", 0);
    if (v->panel->kind == CHART_POLAR)
        view_polar_trace(d, v);
    else if (is_cartesian(v))
        view_xy_trace(d, v);
    return FACET_OK;
}

/* The smallest cover of a legend inside, and its position. */
static double fit_inside(const drawing *d, panel_view *v)
{
    if (v->panel->kind != CHART_POLAR)
        return legend_fit_inside(&v->legend, &v->plot, &v->traces, 0.0, 0.0, 0.0);
    /* the corners beside the half disc */
    const double radius = fmin(0.5 * v->plot.width, v->plot.height);
    const double bottom = v->plot.y + 0.5 * (v->plot.height + radius), top = v->cell.y + v->header;
    const chart_box free = {v->cell.x, top, v->cell.width, bottom - top};
    return legend_fit_inside(&v->legend, &free, &v->traces, v->plot.x + 0.5 * v->plot.width, bottom,
                             radius + 2.2 * view_tick_font(d).size);
}

/* Inside if it covers nothing, else where it takes the smaller part of the plot. */
static void choose_place(const drawing *d, panel_view *v)
{
    const canvas_font font = view_tick_font(d);
    legend right, below;
    /* beside a half disc all of the cell is free */
    const double inside = v->panel->kind == CHART_POLAR ? 0.9 * v->cell.width : 0.55 * v->plot.width;
    legend_create(d->canvas, v->panel, font, d->scale, inside, &v->legend);
    if (v->legend.place == LEGEND_NONE)
        return;
    legend_create(d->canvas, v->panel, font, d->scale, 0.36 * v->cell.width, &right);
    legend_create(d->canvas, v->panel, font, d->scale, room_below(v).width, &below);
    right.place = LEGEND_RIGHT;
    below.place = LEGEND_BELOW;
    /* cut names are hardly readable */
    const double covered = fit_inside(d, v);
    if (covered == 0.0 && v->legend.name_width >= below.name_width - 0.5)
        return;
    const bool is_whole = right.height <= v->plot.height && right.name_width >= below.name_width - 0.5;
    const double lost_right = is_whole ? right.width / v->plot.width : 1.0;
    const double lost_below = legend_rows_height(&below, room_below(v).width) / v->plot.height;
    /* missing names are worse than a small plot */
    if (fmin(lost_right, lost_below) < (isfinite(covered) ? 0.45 : 0.7))
        v->legend = lost_right < lost_below ? right : below;
    else if (!isfinite(covered))
        v->legend.place = LEGEND_NONE; /* the panel is too small */
}

static void place_legend(const drawing *d, panel_view *v)
{
    legend *l = &v->legend;
    const chart_box *cell = &v->cell;
    if (l->place == LEGEND_RIGHT) {
        l->box = (chart_box){cell->x + cell->width - l->width, v->plot.y, l->width, l->height};
    } else if (l->place == LEGEND_BELOW) {
        l->box = room_below(v);
        l->box.height = legend_rows_height(l, l->box.width);
        l->box.y = cell->y + cell->height - l->box.height;
    } else if (l->place == LEGEND_INSIDE && !isfinite(fit_inside(d, v))) {
        l->place = LEGEND_NONE;
    }
}

/* If the plot has become too small for a legend inside, as a neighbor has one below, it goes below as well. */
static void settle_place(const drawing *d, panel_view *v)
{
    if (v->legend.place != LEGEND_INSIDE || isfinite(fit_inside(d, v)))
        return;
    const double width = room_below(v).width;
    legend_create(d->canvas, v->panel, view_tick_font(d), d->scale, width, &v->legend);
    if (legend_rows_height(&v->legend, width) < 0.42 * v->cell.height)
        v->legend.place = LEGEND_BELOW;
}

typedef void legend_step(const drawing *d, panel_view *v);

static facet_result for_legends(const drawing *d, panel_view *views, legend_step *step, facet_error *error)
{
    for (uint32_t i = 0; i < d->chart->panel_count; i++) {
        panel_view *v = &views[i];
        if (v->detail != VIEW_ALL || !v->panel->has_legend || v->panel->curve_count == 0 ||
            !(is_cartesian(v) || v->panel->kind == CHART_POLAR))
            continue;
        TRY(layout_trace(d, v, error));
        step(d, v);
        trace_list_destroy(&v->traces);
    }
    return FACET_OK;
}

facet_result layout_create(const drawing *d, panel_view *views, facet_error *error)
{
    static legend_step *const STEPS[] = {choose_place, settle_place, place_legend};
    place_cells(d, views);
    for (int i = 0; i < 3; i++) { /* legends outside make plots smaller */
        measure_all(d, views);
        TRY(for_legends(d, views, STEPS[i], error));
    }
    return FACET_OK;
}
