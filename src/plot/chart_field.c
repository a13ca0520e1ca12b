/* chart_field.c - fields in false color, interpolated between cell centers, and the color bar. */
#include <math.h>

#include "base/result.h"
#include "plot/chart_view.h"

/* ---- the bar ---- */

/* In units of the label size. */
static const double GAP = 1.5, WIDTH = 1.25, TICK = 0.4, LABEL_GAP = 0.35;

double view_bar_measure(const drawing *d, const char *label, chart_scale scale, axis_extent data,
                        bool is_fixed, double height, axis_view *bar)
{
    const canvas_font font = view_tick_font(d);
    chart_axis axis = {.scale = scale};
    if (is_fixed || data.maximum > data.minimum) { /* the range of colors is not widened to round numbers */
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

/* ---- the field ---- */

/* Positions on the color bar; NaN: outside of the field. */
static void find_fractions(const chart_field *field, const axis_view *bar, float *fractions)
{
    const size_t count = (size_t)field->width * field->height;
    for (size_t i = 0; i < count; i++) {
        const double v = field->values[i];
        const double t = axis_fraction(bar, isinf(v) ? copysign(1e300, v) : v);
        /* values that are not positive are below the end of a logarithmic bar */
        fractions[i] = isnan(v) ? NAN : isnan(t) ? 0.0f : (float)fmin(fmax(t, 0.0), 1.0);
    }
}

/* The position of a pixel center between cell centers: the lower cell, the upper one, the weight of the
 * upper. */
static double between(uint32_t pixel, uint32_t pixel_count, uint32_t cell_count, uint32_t *low,
                      uint32_t *high)
{
    const double place = fmin(fmax((pixel + 0.5) / pixel_count * cell_count - 0.5, 0.0), cell_count - 1.0);
    *low = (uint32_t)place;
    *high = *low + 1 < cell_count ? *low + 1 : *low;
    return place - *low;
}

/* Interpolates those of the four surrounding cells that have a value; premultiplied, 0: none has. */
static uint32_t pixel_color(const float *top, const float *bottom, uint32_t x0, uint32_t x1, double fx,
                            double fy, const uint32_t *colors, uint32_t last_color)
{
    const float cells[4] = {top[x0], top[x1], bottom[x0], bottom[x1]};
    const double weights[4] = {(1.0 - fx) * (1.0 - fy), fx * (1.0 - fy), (1.0 - fx) * fy, fx * fy};
    double sum = 0.0, weight = 0.0;
    for (int i = 0; i < 4; i++)
        if (!isnan(cells[i])) {
            sum += weights[i] * (double)cells[i];
            weight += weights[i];
        }
    return weight > 1e-9 ? colors[(uint32_t)(sum / weight * last_color + 0.5)] : 0;
}

static void paint(const chart_field *field, const float *fractions, uint32_t *pixels, uint32_t width,
                  uint32_t height)
{
    enum { LAST_COLOR = 1023 };
    const axis_view unit = {.ticks = {.minimum = 0.0, .maximum = 1.0}};
    uint32_t colors[LAST_COLOR + 1];
    for (int i = 0; i <= LAST_COLOR; i++)
        colors[i] = view_bar_color(&unit, (double)i / LAST_COLOR);
    for (uint32_t y = 0; y < height; y++) {
        uint32_t y0, y1;
        const double fy = between(y, height, field->height, &y0, &y1);
        const float *top = fractions + (size_t)y0 * field->width,
                    *bottom = fractions + (size_t)y1 * field->width;
        for (uint32_t x = 0; x < width; x++) {
            uint32_t x0, x1;
            const double fx = between(x, width, field->width, &x0, &x1);
            pixels[(size_t)y * width + x] = pixel_color(top, bottom, x0, x1, fx, fy, colors, LAST_COLOR);
        }
    }
}

facet_result view_field_draw(const drawing *d, const chart_field *field, const axis_view *bar,
                             const chart_box *box, facet_error *error)
{
    /* pixels of the file; two per pixel in vector files, which are magnified */
    const double fine = canvas_is_raster(d->canvas) ? 1.0 : 2.0;
    const uint32_t width = (uint32_t)fmin(fmax(rint(box->width * fine), 1.0), CANVAS_MAX_SIZE);
    const uint32_t height = (uint32_t)fmin(fmax(rint(box->height * fine), 1.0), CANVAS_MAX_SIZE);
    size_t cell_count;
    if (field->width == 0 || field->height == 0)
        return FACET_OK;
    float *fractions = checked_mul(field->width, field->height, &cell_count)
                           ? mem_alloc(&d->allocator, cell_count, sizeof *fractions)
                           : NULL;
    uint32_t *pixels = mem_alloc(&d->allocator, (size_t)width * height, sizeof *pixels);
    facet_result result = FACET_OK;
    if (fractions && pixels) {
        find_fractions(field, bar, fractions);
        paint(field, fractions, pixels, width, height);
        canvas_image(d->canvas, box->x, box->y, box->width, box->height, pixels, width, height);
    } else {
        result = fail_memory(error, "image of a field", (size_t)width * height * sizeof *pixels);
    }
    mem_free(fractions);
    mem_free(pixels);
    return result;
}
