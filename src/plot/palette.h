/* palette.h - the colors and dashes of charts. */
#ifndef PLOT_PALETTE_H
#define PLOT_PALETTE_H

#include "plot/canvas.h"
#include "plot/chart.h"

/* The colors of everything but the data. */
typedef struct palette_theme {
    canvas_color background, text, muted_text, axis, grid, minor_grid;
} palette_theme;
const palette_theme *palette_get_theme(bool is_dark);

/* Contrast of two colors by WCAG 2.1, 1 (equal) to 21. */
double palette_contrast(canvas_color a, canvas_color b);

enum { PALETTE_COUNT = 8 };
static const double PALETTE_MIN_CONTRAST = 2.2;
/* The color of a curve. On a dark background the darkest colors of the palette are lighter and black is
 * white; a color of its own is moved away from the background if its contrast is below
 * PALETTE_MIN_CONTRAST. */
canvas_color palette_color(const chart_style *style, bool is_dark);
/* The stroke of a curve; scale: px per px of style. */
canvas_stroke palette_stroke(const chart_style *style, bool is_dark, double scale);

/* viridis (van der Walt and Smith 2015, released under CC0) at t, clamped to [0, 1]. Its lightness
 * increases with t, also for color-blind viewers and in grayscale print. */
canvas_color palette_viridis(double t);

#endif
