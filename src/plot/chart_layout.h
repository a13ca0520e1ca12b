/* chart_layout.h - positions in a chart: its title, the grid of its panels, their margins and legends. */
#ifndef PLOT_CHART_LAYOUT_H
#define PLOT_CHART_LAYOUT_H

#include "plot/chart_view.h"

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
