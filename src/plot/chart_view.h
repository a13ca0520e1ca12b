/* chart_view.h - what the files that draw a chart share: the drawing, and a panel that is laid out. */
#ifndef PLOT_CHART_VIEW_H
#define PLOT_CHART_VIEW_H

#include "plot/chart_axis.h"
#include "plot/chart_legend.h"
#include "plot/chart_trace.h"
#include "plot/palette.h"

typedef struct drawing {
    const chart *chart;
    canvas *canvas;
    const palette_theme *theme;
    facet_allocator allocator;
    double scale; /* px per px of a chart of 960 x 640 */
} drawing;

typedef struct view_margins {
    double left, top, right, bottom; /* px */
} view_margins;

/* The parts of a panel that fit. */
typedef enum view_detail { VIEW_FRAME, VIEW_TICKS, VIEW_ALL } view_detail;

typedef struct panel_view {
    const chart_panel *panel;
    chart_box cell; /* the area of the panel */
    chart_box plot; /* the area of the data */
    view_detail detail;
    view_margins margins; /* from cell to plot */
    axis_view x, y;       /* XY, FIELD; POLAR: y is the radius */
    axis_view bar;        /* FIELD, DISC, SURFACE: the values of the colors */
    label_line title[2], note[2];
    int title_lines, note_lines;
    double header; /* height of title and note, px */
    legend legend;
    trace_list traces; /* for the present plot */
} panel_view;

/* Sizes of text. */
static inline canvas_font view_title_font(const drawing *d)
{
    return (canvas_font){.size = 13.5 * d->scale, .is_bold = true};
}
static inline canvas_font view_label_font(const drawing *d)
{
    return (canvas_font){.size = 12.5 * d->scale};
}
static inline canvas_font view_tick_font(const drawing *d)
{
    return (canvas_font){.size = 11.5 * d->scale};
}

/* A line aligned with pixels, which keeps hairlines crisp. */
double view_snap(double px);
void view_line(const drawing *d, double x0, double y0, double x1, double y1, canvas_color color,
               double width);

/* ---- kinds of panels ----
 * _measure: axes and margins for a cell, as far as the size of the plot is known. _trace: the points of the curves for the
 * present plot. _draw: everything in the cell but title, note and legend. */
void view_xy_measure(const drawing *d, panel_view *v); /* XY, FIELD */
void view_xy_trace(const drawing *d, panel_view *v);
facet_result view_xy_draw(const drawing *d, panel_view *v, facet_error *error);

void view_polar_measure(const drawing *d, panel_view *v);
void view_polar_trace(const drawing *d, panel_view *v);
facet_result view_polar_draw(const drawing *d, panel_view *v, facet_error *error);

void view_disc_measure(const drawing *d, panel_view *v);
facet_result view_disc_draw(const drawing *d, panel_view *v, facet_error *error);

void view_surface_measure(const drawing *d, panel_view *v);
facet_result view_surface_draw(const drawing *d, panel_view *v, facet_error *error);

/* ---- shared ---- */

/* The color bar: creates its axis and returns its width with labels in px; draws it at the right of box. */
double view_bar_measure(const drawing *d, const char *label, chart_scale scale, axis_extent data,
                        bool is_fixed, double height, axis_view *bar);
void view_bar_draw(const drawing *d, const char *label, axis_view *bar, const chart_box *box);
/* The color of a value, premultiplied 0xAARRGGBB, opaque. */
uint32_t view_bar_color(const axis_view *bar, double value);

/* Draws the part of a field within the extents of x and y in box. FACET_ERROR_MEMORY. */
facet_result view_field_draw(const drawing *d, const chart_field *field, const axis_view *bar,
                             const chart_box *box, facet_error *error);

#endif
