/* chart_legend.h - the legend: names of curves beside samples of their lines, placed where it covers the
 * least. */
#ifndef PLOT_CHART_LEGEND_H
#define PLOT_CHART_LEGEND_H

#include "plot/chart_text.h"
#include "plot/chart_trace.h"

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
/* The position inside plot that covers the least of traces and does not touch a disc (radius 0: none).
 * Returns the px of covered lines; infinity: there is no space. Sets box. */
double legend_fit_inside(legend *l, const chart_box *plot, const trace_list *traces, double disc_x,
                         double disc_y, double disc_radius);
/* Height in px of entries in rows of that width. */
double legend_rows_height(const legend *l, double width);
/* Draws the legend in box, arranged by its place. */
void legend_draw(canvas *c, const legend *l, bool is_dark);

#endif
