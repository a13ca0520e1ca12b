/* chart_axis.h - an axis with its range, its ticks and its position in pixels. */
#ifndef PLOT_CHART_AXIS_H
#define PLOT_CHART_AXIS_H

#include "plot/chart_text.h"
#include "plot/chart_ticks.h"

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

#endif
