/* chart_text.h - text that fits: any bytes as lines of valid UTF-8 within a width. */
#ifndef PLOT_CHART_TEXT_H
#define PLOT_CHART_TEXT_H

#include "plot/canvas.h"
#include "plot/chart_ticks.h"

enum { LABEL_SIZE = 1024, LABEL_MAX_LINES = 4 };

/* One line; longer text is cut before it is measured. */
typedef struct label_line {
    char text[LABEL_SIZE];
    double width; /* px */
} label_line;

/* text (NULL: "") as valid UTF-8, at most LABEL_SIZE - 1 bytes: invalid bytes become U+FFFD, control
 * characters spaces; line feeds stay. */
void label_clean(const char *text, char out[LABEL_SIZE]);
/* One line, cut to max_width with an ellipsis. */
void label_fit(canvas *c, canvas_font font, const char *text, double max_width, label_line *out);
/* Up to max_lines lines (at most LABEL_MAX_LINES), broken at spaces and line feeds; the rest is cut with an
 * ellipsis. Returns the number of lines; "" has none. */
int label_wrap(canvas *c, canvas_font font, const char *text, double max_width, int max_lines,
               label_line *lines);

typedef enum label_align { LABEL_LEFT, LABEL_CENTER, LABEL_RIGHT } label_align;
/* y: the baseline. */
void label_draw(canvas *c, const label_line *l, canvas_font font, canvas_color color, label_align align,
                double x, double y);
/* Centered at (x, y), read from below. */
void label_draw_upright(canvas *c, const label_line *l, canvas_font font, canvas_color color, double x,
                        double y);

double label_tick_width(canvas *c, canvas_font font, const tick_label *t);
void label_draw_tick(canvas *c, const tick_label *t, canvas_font font, canvas_color color, label_align align,
                     double x, double y);

/* Height of the center of figures above the baseline. */
static inline double label_middle(canvas_font font)
{
    return 0.365 * font.size; /* half the height of figures and capitals of DejaVu Sans */
}

#endif
