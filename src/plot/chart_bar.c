/* chart_bar.c - false colors: which color a value has, and the bar that says so. */
#include "plot/chart_view.h"

#include <math.h>

/* In units of the size of its labels. */
static const double GAP = 1.5, WIDTH = 1.25, TICK = 0.4, LABEL_GAP = 0.35;

double view_bar_measure(const drawing *d, const char *label, chart_scale scale, axis_extent data,
                        bool is_fixed, double height, axis_view *bar)
{
    const canvas_font font = view_tick_font(d);
    chart_axis axis = {.scale = scale};
    if (is_fixed || data.maximum > data.minimum) { /* all colors are used: not widened */
        axis.has_range = true;
        axis.minimum = data.minimum;
        axis.maximum = data.maximum;
    }
    axis_create(d->canvas, font, &axis, data, height, true, bar);
    double width = font.size * (GAP + WIDTH + TICK + LABEL_GAP) + axis_label_width(d->canvas, font, bar);
    if (label && *label)
        width += 1.7 * view_label_font(d).size;
    return width;
}

uint32_t view_bar_color(const axis_view *bar, double value)
{
    const double t = axis_fraction(bar, value);
    const canvas_color color = palette_viridis(isnan(t) ? 0.0 : t);
    return 0xff000000u | (uint32_t)(color.r * 255.0 + 0.5) << 16 | (uint32_t)(color.g * 255.0 + 0.5) << 8 |
           (uint32_t)(color.b * 255.0 + 0.5);
}

static void draw_colors(const drawing *d, const chart_box *box)
{
    enum { ROWS = 512, COLUMNS = 4 };
    uint32_t pixels[ROWS * COLUMNS];
    const axis_view unit = {.ticks = {.minimum = 0.0, .maximum = 1.0}};
    for (int i = 0; i < ROWS * COLUMNS; i++)
        pixels[i] = view_bar_color(&unit, 1.0 - (i / COLUMNS + 0.5) / ROWS);
    canvas_image(d->canvas, box->x, box->y, box->width, box->height, pixels, COLUMNS, ROWS);
}

void view_bar_draw(const drawing *d, const char *label, axis_view *bar, const chart_box *box)
{
    const canvas_font font = view_tick_font(d);
    const chart_box colors = {view_snap(box->x + box->width + GAP * font.size) - 0.5, view_snap(box->y) - 0.5,
                              floor(WIDTH * font.size), floor(box->height)};
    draw_colors(d, &colors);
    bar->from = colors.y + colors.height;
    bar->to = colors.y;
    const double right = colors.x + colors.width, text = right + font.size * (TICK + LABEL_GAP);
    for (int i = 0; i < bar->ticks.minor_count && bar->scale == CHART_LOG10; i++) {
        const double y = view_snap(axis_place(bar, bar->ticks.minor[i]));
        view_line(d, right, y, right + 0.5 * TICK * font.size, y, d->theme->axis, 1.0);
    }
    for (int i = 0; i < bar->ticks.count; i++) {
        const double y = view_snap(axis_place(bar, bar->ticks.values[i]));
        view_line(d, right, y, right + TICK * font.size, y, d->theme->axis, 1.0);
        label_draw_tick(d->canvas, &bar->ticks.labels[i], font, d->theme->muted_text, LABEL_LEFT, text,
                        y + label_middle(font));
    }
    const tick_label power = axis_power(bar);
    if (*power.text)
        label_draw_tick(d->canvas, &power, font, d->theme->muted_text, LABEL_LEFT, colors.x,
                        colors.y - 0.7 * font.size);
    label_line name;
    label_fit(d->canvas, view_label_font(d), label, 1.1 * box->height, &name);
    label_draw_upright(d->canvas, &name, view_label_font(d), d->theme->text,
                       text + axis_label_width(d->canvas, font, bar) + 0.95 * view_label_font(d).size,
                       colors.y + 0.5 * colors.height);
}
