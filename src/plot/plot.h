/* plot.h - the charts of reflectance: one file per family of kinds, all numbers from shade/, legacy/ and ibl/. */
#ifndef PLOT_PLOT_H
#define PLOT_PLOT_H

#include "plot/chart.h"

/* The chart of desc: facet_plot_encode() is this and chart.h. The arena is the caller's. */
facet_result plot_create(const facet_plot_desc *desc, arena *memory, chart *out, facet_error *error);

#endif
