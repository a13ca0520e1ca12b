/* chart_legend.c - the legend, placed where it covers the least of the curves. See chart_view.h. */
#include "plot/chart_view.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "plot/palette.h"

/* In units of the font size. */
static const double LINE_HEIGHT = 1.5, SAMPLE = 2.5, SAMPLE_GAP = 0.6, PADDING = 0.55, ENTRY_GAP = 1.6;

static double entry_width(const legend *l, int i)
{
    return l->font.size * (SAMPLE + SAMPLE_GAP) + l->widths[i];
}

static int row_count(const legend *l)
{
    return l->count + (l->left_out > 0);
}

static void entry_text(const legend *l, int i, char out[LABEL_SIZE])
{
    if (i < l->count)
        snprintf(out, LABEL_SIZE, "%.*s", LABEL_SIZE - 1, l->curves[i]->name);
    else
        snprintf(out, LABEL_SIZE, "and %d more", l->left_out);
}

void legend_create(canvas *c, const chart_panel *panel, canvas_font font, double scale, double max_width,
                   legend *out)
{
    *out = (legend){.font = font, .scale = scale};
    for (size_t i = 0; panel->has_legend && i < panel->curve_count; i++) {
        if (!panel->curves[i].name || !*panel->curves[i].name)
            continue;
        if (out->count < LEGEND_MAX_ENTRIES)
            out->curves[out->count++] = &panel->curves[i];
        else
            out->left_out++;
    }
    const double room = fmax(max_width - font.size * (SAMPLE + SAMPLE_GAP + 2.0 * PADDING), 2.0 * font.size);
    for (int i = 0; i < row_count(out); i++) {
        char name[LABEL_SIZE];
        label_line l;
        entry_text(out, i, name);
        label_fit(c, font, name, room, &l);
        out->widths[i] = l.width;
        out->name_width = fmax(out->name_width, l.width);
    }
    if (out->count == 0)
        return;
    out->place = LEGEND_INSIDE;
    out->width = font.size * (SAMPLE + SAMPLE_GAP + 2.0 * PADDING) + out->name_width;
    out->height = font.size * (LINE_HEIGHT * row_count(out) + 2.0 * PADDING);
}

static bool overlaps_disc(const chart_box *b, double x, double y, double radius)
{
    const double dx = x - fmin(fmax(x, b->x), b->x + b->width),
                 dy = y - fmin(fmax(y, b->y), b->y + b->height);
    return radius > 0.0 && hypot(dx, dy) < radius;
}

double legend_fit_inside(legend *l, const chart_box *plot, const trace_list *traces, double disc_x,
                         double disc_y, double disc_radius)
{
    /* in order of preference: fractions of the remaining space */
    static const double PLACES[][2] = {{1, 0},    {0, 0},    {1, 1},    {0, 1},    {0.5, 0},  {1, 0.5},
                                       {0, 0.5},  {0.5, 1},  {0.75, 0}, {0.25, 0}, {0.75, 1}, {0.25, 1},
                                       {1, 0.25}, {0, 0.25}, {1, 0.75}, {0, 0.75}, {0.5, 0.5}};
    const double inset = 0.7 * l->font.size;
    const double room_x = plot->width - l->width - 2.0 * inset,
                 room_y = plot->height - l->height - 2.0 * inset;
    double best = HUGE_VAL;
    if (room_x < 0.0 || room_y < 0.0)
        return best;
    for (size_t i = 0; i < sizeof PLACES / sizeof *PLACES; i++) {
        const chart_box box = {plot->x + inset + PLACES[i][0] * room_x,
                               plot->y + inset + PLACES[i][1] * room_y, l->width, l->height};
        if (overlaps_disc(&box, disc_x, disc_y, disc_radius))
            continue;
        const double m = 0.4 * l->font.size;
        const chart_box near = {box.x - m, box.y - m, box.width + 2.0 * m, box.height + 2.0 * m};
        const double covered = trace_list_length_inside(traces, &near);
        if (covered < best) {
            best = covered;
            l->box = box;
        }
    }
    return best;
}

/* Columns of equal width for the entries; 0: all fit in one row, side by side. */
static int column_count(const legend *l, double width)
{
    const double gap = l->font.size * ENTRY_GAP,
                 widest = l->font.size * (SAMPLE + SAMPLE_GAP) + l->name_width;
    double sum = -gap;
    for (int i = 0; i < row_count(l); i++)
        sum += entry_width(l, i) + gap;
    return sum <= width ? 0 : (int)fmax(floor((width + gap) / (widest + gap)), 1.0);
}

/* The position of entry i in rows of that width, relative to (0, 0). */
static void place_in_rows(const legend *l, double width, int i, double *x, double *y)
{
    const double gap = l->font.size * ENTRY_GAP,
                 widest = l->font.size * (SAMPLE + SAMPLE_GAP) + l->name_width;
    const int columns = column_count(l, width);
    *x = *y = 0.0;
    if (columns > 0) {
        *x = (i % columns) * (widest + gap);
        *y = (double)(i / columns) * l->font.size * LINE_HEIGHT;
        return;
    }
    for (int k = 0; k < i; k++)
        *x += entry_width(l, k) + gap;
}

double legend_rows_height(const legend *l, double width)
{
    if (l->place == LEGEND_NONE)
        return 0.0;
    double x, y;
    place_in_rows(l, width, row_count(l) - 1, &x, &y);
    return y + l->font.size * LINE_HEIGHT;
}

static void draw_entry(canvas *c, const legend *l, int i, bool is_dark, double x, double y)
{
    const double middle = y + 0.5 * l->font.size * LINE_HEIGHT, length = l->font.size * SAMPLE;
    if (i < l->count) {
        const chart_style *style = &l->curves[i]->style;
        canvas_stroke stroke = palette_stroke(style, is_dark, l->scale);
        stroke.width = fmin(stroke.width, 0.4 * l->font.size);
        canvas_move_to(c, x + 0.5 * stroke.width, middle);
        canvas_line_to(c, x + length - 0.5 * stroke.width, middle);
        canvas_draw(c, &stroke);
        if (style->has_markers) {
            canvas_arc(c, x + 0.5 * length, middle, 1.6 * stroke.width, 0.0, 6.283185307179586);
            canvas_close(c);
            canvas_fill(c, stroke.color);
        }
    }
    char name[LABEL_SIZE];
    label_line shown;
    entry_text(l, i, name);
    label_fit(c, l->font, name, l->widths[i] + 0.01, &shown);
    label_draw(c, &shown, l->font, palette_get_theme(is_dark)->text, LABEL_LEFT,
               x + length + l->font.size * SAMPLE_GAP, middle + label_middle(l->font));
}

void legend_draw(canvas *c, const legend *l, bool is_dark)
{
    const double padding = l->font.size * PADDING;
    if (l->place == LEGEND_NONE)
        return;
    if (l->place == LEGEND_INSIDE) {
        canvas_color ground = palette_get_theme(is_dark)->background;
        ground.a = 0.86;
        canvas_rectangle(c, l->box.x, l->box.y, l->box.width, l->box.height);
        canvas_fill(c, ground);
    }
    for (int i = 0; i < row_count(l); i++) {
        double x = padding, y = padding + i * l->font.size * LINE_HEIGHT;
        if (l->place == LEGEND_BELOW)
            place_in_rows(l, l->box.width, i, &x, &y);
        draw_entry(c, l, i, is_dark, l->box.x + x, l->box.y + y);
    }
}
