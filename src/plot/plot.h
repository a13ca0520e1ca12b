/* plot.h - the charts of reflectance: one file per family of kinds, all numbers from shade/, legacy/ and
 * ibl/. */
#ifndef PLOT_PLOT_H
#define PLOT_PLOT_H

#include "plot/chart.h"

/* Makes the chart of desc; facet_plot_encode() then draws it. The arena belongs to the caller. */
facet_result plot_create(const facet_plot_desc *desc, arena *memory, chart *out, facet_error *error);

#endif
