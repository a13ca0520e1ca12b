/* plot_check.h - whether a desc asks for a plot that can be. */
#ifndef PLOT_PLOT_CHECK_H
#define PLOT_PLOT_CHECK_H

#include "facet/facet.h"

/* Counts, angles, sizes and every number of the materials; FACET_ERROR_ARGUMENT with the one that is wrong. */
facet_result plot_check(const facet_plot_desc *desc, facet_error *error);

#endif
