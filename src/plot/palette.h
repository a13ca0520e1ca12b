/* palette.h - the colors and dashes of charts. */
#ifndef PLOT_PALETTE_H
#define PLOT_PALETTE_H

#include "plot/cairo_canvas.h"
#include "plot/chart.h"

/* The colors of everything but the data. */
typedef struct palette_theme {
    canvas_color background, text, muted_text, axis, grid, minor_grid;
} palette_theme;
const palette_theme *palette_get_theme(bool is_dark);

/* The contrast of two colors as WCAG 2.1 defines it: 1 (the same) to 21. */
double palette_contrast(canvas_color a, canvas_color b);

enum { PALETTE_COUNT = 8 };
static const double PALETTE_MIN_CONTRAST = 2.2;
/* The color of a curve. On dark ground the palette's darkest colors are lighter, its black is white; a color of its own
 * is moved away from the ground where its contrast is less than PALETTE_MIN_CONTRAST. */
canvas_color palette_color(const chart_style *style, bool is_dark);
/* The stroke of a curve, scale px wide per px of style. */
canvas_stroke palette_stroke(const chart_style *style, bool is_dark, double scale);

/* viridis (van der Walt and Smith 2015, released under CC0) at t, clamped to [0, 1]. Its lightness rises with t, also
 * for color blind eyes and in grey print. */
canvas_color palette_viridis(double t);

#endif
