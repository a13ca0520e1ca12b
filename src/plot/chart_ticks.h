/* chart_ticks.h - numbers as text, and the ticks of an axis with their labels. */
#ifndef PLOT_CHART_TICKS_H
#define PLOT_CHART_TICKS_H

#include "plot/chart.h"

/* ---- numbers as text for files and labels, independent of the locale ---- */

enum { NUMBER_SIZE = 32 };

/* The shortest decimal that reads back as the same double; "": NaN; "inf", "-inf". */
void number_shortest(double value, char out[NUMBER_SIZE]);
/* The given number of decimals, with the typographic minus sign (U+2212); never "-0". */
void number_label(double value, int decimals, char out[NUMBER_SIZE]);

/* ---- ticks ---- */

enum { TICKS_MAX = 24, TICKS_MINOR_MAX = 128, TICKS_EXPONENT_SIZE = 16 };

/* "0.25", or "10" with "-3" above. */
typedef struct tick_label {
    char text[NUMBER_SIZE];
    char exponent[TICKS_EXPONENT_SIZE];
} tick_label;

/* In units of the axis, increasing, within the range. */
typedef struct ticks {
    double minimum, maximum;
    int count, minor_count;
    double values[TICKS_MAX], minor[TICKS_MINOR_MAX];
    tick_label labels[TICKS_MAX];
    int power; /* the labels say values / 10^power */
} ticks;

/* The range of an axis and the number of ticks that suit it. */
typedef struct ticks_desc {
    chart_scale scale;
    bool is_fixed; /* the range stays; else it is widened to round numbers */
    bool is_degrees;
    double minimum, maximum; /* finite, minimum < maximum; logarithmic: positive */
    int target;              /* wanted count, 2 to TICKS_MAX */
} ticks_desc;

void ticks_create(const ticks_desc *desc, ticks *out);

/* The range for values from minimum to maximum as ticks_create() needs it: not empty, including 0 if that
 * is near, within +-1e300; without values (minimum > maximum) 0 to 1, logarithmic 0.1 to 1. */
void ticks_range(chart_scale scale, double *minimum, double *maximum);

#endif
