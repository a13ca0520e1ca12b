/* chart_trace.h - curves as lines in pixels: clipped, dashed, and visible where they coincide. */
#ifndef PLOT_CHART_TRACE_H
#define PLOT_CHART_TRACE_H

#include "plot/canvas.h"
#include "plot/chart.h"

typedef struct chart_box {
    double x, y, width, height; /* px, from the top left corner */
} chart_box;

/* The points of a curve in px; NaN breaks the line. */
typedef struct trace {
    const chart_curve *curve;
    size_t count;
    double *x, *y;
} trace;

typedef struct trace_list {
    size_t count;
    trace *traces;
    double *points; /* of all of them */
} trace_list;

/* Traces for the curves of a panel, with undefined points. False: out of memory. */
bool trace_list_create(const facet_allocator *allocator, const chart_panel *panel, trace_list *out);
void trace_list_destroy(trace_list *list); /* {0} is allowed; leaves {0} */

/* Clips the line from (x[0], y[0]) to (x[1], y[1]) to box, in place; false: nothing is inside. Liang and
 * Barsky
 * 1984. */
bool trace_clip(const chart_box *box, double x[2], double y[2]);
/* Length in px of all traces inside box; a point alone counts 1. */
double trace_list_length_inside(const trace_list *list, const chart_box *box);

/* Draws all: solid lines first, so that they show through the gaps of dashed ones. Lines of equal dash that
 * coincide are drawn in alternating stretches. scale: px per px of style. */
void trace_list_draw(canvas *c, const trace_list *list, const chart_box *box, bool is_dark, double scale);

#endif
