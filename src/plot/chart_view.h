/* chart_view.h - what the files that draw a chart share: the drawing, and a panel on its way to the canvas. */
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

/* How much of a panel there is room for. */
typedef enum view_detail { VIEW_FRAME, VIEW_TICKS, VIEW_ALL } view_detail;

typedef struct panel_view {
    const chart_panel *panel;
    chart_box cell; /* all that is the panel's */
    chart_box plot; /* what the data are drawn in */
    view_detail detail;
    view_margins margins; /* from cell to plot */
    axis_view x, y;       /* XY, FIELD; POLAR: y is the radius */
    axis_view bar;        /* FIELD, DISC, SURFACE: the values of the colors */
    label_line title[2], note[2];
    int title_lines, note_lines;
    double header; /* px that title and note take */
    legend legend;
    trace_list traces; /* of the plot as it is */
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

/* A line on whole pixels: hairlines are crisp then. */
double view_snap(double px);
void view_line(const drawing *d, double x0, double y0, double x1, double y1, canvas_color color,
               double width);

/* ---- one file per kind of panel ----
 * _measure: axes and margins for a cell of that size, as far as the plot's size is known (plot).
 * _trace: the curves' points for the plot as it is. _draw: everything in the cell but title, note and legend. */
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

/* ---- shared by them ---- */

/* The bar of false colors: its axis, then its width with labels in px; then the bar right of box. */
double view_bar_measure(const drawing *d, const char *label, chart_scale scale, axis_extent data,
                        bool is_fixed, double height, axis_view *bar);
void view_bar_draw(const drawing *d, const char *label, axis_view *bar, const chart_box *box);
/* The color of a value, premultiplied 0xAARRGGBB, opaque. */
uint32_t view_bar_color(const axis_view *bar, double value);

/* A field in box: its part of the extent of x and y. FACET_ERROR_MEMORY. */
facet_result view_field_draw(const drawing *d, const chart_field *field, const axis_view *bar,
                             const chart_box *box, facet_error *error);

#endif
