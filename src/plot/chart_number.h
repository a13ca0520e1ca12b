/* chart_number.h - numbers as text for files and tick labels, independent of the locale. */
#ifndef PLOT_CHART_NUMBER_H
#define PLOT_CHART_NUMBER_H

#include "facet/facet.h"

enum { NUMBER_SIZE = 32 };

/* The shortest decimal that reads back as the same double; "": NaN; "inf", "-inf". */
void number_shortest(double value, char out[NUMBER_SIZE]);
/* The given number of decimals, with the typographic minus sign (U+2212); never "-0". */
void number_label(double value, int decimals, char out[NUMBER_SIZE]);

#endif
