/* chart_view.h - a chart while it is drawn: its axes, legends and panels, shared by the files that draw it. */
#ifndef PLOT_CHART_VIEW_H
#define PLOT_CHART_VIEW_H

#include "plot/chart_text.h"
#include "plot/chart_ticks.h"
#include "plot/chart_trace.h"
#include "plot/palette.h"

/* ---- axes: range, ticks and position in pixels (chart_axis.c) ---- */

/* Smallest and largest of values; minimum > maximum: none yet. */
typedef struct axis_extent {
    double minimum, maximum;
} axis_extent;
#define AXIS_EXTENT_NONE                                                                                     \
    (axis_extent)                                                                                            \
    {                                                                                                        \
        1.0, -1.0                                                                                            \
    }
/* Adds values that can be shown: finite, and positive on a logarithmic axis. */
void axis_extent_add(axis_extent *e, chart_scale scale, size_t count, const double *values);

typedef struct axis_view {
    chart_scale scale;
    ticks ticks;
    double from, to; /* px of the ticks' minimum and maximum */
} axis_view;

/* Chooses range and ticks for a length in px; labels stand upright beside a vertical axis, in a row below
 * others. */
void axis_create(canvas *c, canvas_font font, const chart_axis *axis, axis_extent data, double length,
                 bool is_vertical, axis_view *out);
/* The position of value, 0 to 1 inside the range, limited to +-1e6; NaN: none (not a number, or not
 * positive on a logarithmic axis). */
double axis_fraction(const axis_view *a, double value);
/* The same in px. */
double axis_place(const axis_view *a, double value);

double axis_label_width(canvas *c, canvas_font font, const axis_view *a); /* px of the widest */
/* "x 10^4" if labels omit a power of ten, else text "". */
tick_label axis_power(const axis_view *a);

/* ---- legends: names of curves beside samples of their lines (chart_legend.c) ---- */

typedef enum legend_place { LEGEND_NONE, LEGEND_INSIDE, LEGEND_RIGHT, LEGEND_BELOW } legend_place;

enum { LEGEND_MAX_ENTRIES = 32 };

typedef struct legend {
    legend_place place;
    int count; /* of entries */
    const chart_curve *curves[LEGEND_MAX_ENTRIES];
    int left_out;                          /* curves without an entry: "and 3 more" */
    double widths[LEGEND_MAX_ENTRIES + 1]; /* px of the names as shown */
    double name_width;                     /* px of the widest */
    double width, height;                  /* px as one column, with padding */
    canvas_font font;
    double scale;
    chart_box box; /* where it is drawn */
} legend;

/* The entries for a panel, names cut to max_width; place is LEGEND_NONE if there are none. */
void legend_create(canvas *c, const chart_panel *panel, canvas_font font, double scale, double max_width,
                   legend *out);
/* The position inside plot that covers the least of traces and does not overlap a disc (radius 0: none).
 * Returns the px of covered lines; infinity: there is no space. Sets box. */
double legend_fit_inside(legend *l, const chart_box *plot, const trace_list *traces, double disc_x,
                         double disc_y, double disc_radius);
/* Height in px of entries in rows of that width. */
double legend_rows_height(const legend *l, double width);
/* Draws the legend in box, arranged by its place. */
void legend_draw(canvas *c, const legend *l, bool is_dark);

/* ---- drawings and their panels ---- */

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

/* ---- layout: title, grid of panels, margins and legends (chart_layout.c) ---- */

/* The scale of text and lines: they grow with the size of the chart, and stay readable in small charts and
 * in many panels. */
double layout_scale(const chart *c);

/* Draws the title and fills views (c->panel_count, {0} with panel set): positions, axes, legends.
 * FACET_ERROR_MEMORY. */
facet_result layout_create(const drawing *d, panel_view *views, facet_error *error);

/* Fills traces for the present size of the plot; release with trace_list_destroy(). FACET_ERROR_MEMORY. */
facet_result layout_trace(const drawing *d, panel_view *v, facet_error *error);

/* chart_draw() with another library than libcairo, for tests; NULL: libcairo. */
facet_result chart_draw_with(const chart *c, facet_plot_format format, const char *library,
                             const facet_allocator *allocator, unsigned char **bytes, size_t *size,
                             facet_error *error);

#endif
