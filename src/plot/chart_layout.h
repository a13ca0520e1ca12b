/* chart_layout.h - where everything of a chart stands: its title, the grid of its panels, their margins and legends. */
#ifndef PLOT_CHART_LAYOUT_H
#define PLOT_CHART_LAYOUT_H

#include "plot/chart_view.h"

/* The scale of a chart: text and lines keep their share of large pictures, and stay readable in small ones and where
 * many panels share one. */
double layout_scale(const chart *c);

/* Draws the title and fills views (c->panel_count, {0} with panel set): places, axes, legends. FACET_ERROR_MEMORY. */
facet_result layout_create(const drawing *d, panel_view *views, facet_error *error);

/* Fills traces for the plot as it is; trace_list_destroy(). FACET_ERROR_MEMORY. */
facet_result layout_trace(const drawing *d, panel_view *v, facet_error *error);

/* chart_draw() with another library than libcairo (NULL: that one), for tests. */
facet_result chart_draw_with(const chart *c, facet_plot_format format, const char *library,
                             const facet_allocator *allocator, unsigned char **bytes, size_t *size,
                             facet_error *error);

#endif
