/* chart_field.c - a field of values as a picture in false color, interpolated between the middles of its cells. */
#include "plot/chart_view.h"

#include <math.h>

#include "base/result.h"

/* Fractions of the bar; NaN: outside of the field. */
static void find_fractions(const chart_field *field, const axis_view *bar, float *fractions)
{
    const size_t count = (size_t)field->width * field->height;
    for (size_t i = 0; i < count; i++) {
        const double v = field->values[i];
        const double t = axis_fraction(bar, isinf(v) ? copysign(1e300, v) : v);
        /* on a logarithmic bar what is not positive is below its end */
        fractions[i] = isnan(v) ? NAN : isnan(t) ? 0.0f : (float)fmin(fmax(t, 0.0), 1.0);
    }
}

/* Where a pixel's middle lies between the middles of cells: the lower cell, the upper one, the weight of the upper. */
static double between(uint32_t pixel, uint32_t pixel_count, uint32_t cell_count, uint32_t *low,
                      uint32_t *high)
{
    const double place = fmin(fmax((pixel + 0.5) / pixel_count * cell_count - 0.5, 0.0), cell_count - 1.0);
    *low = (uint32_t)place;
    *high = *low + 1 < cell_count ? *low + 1 : *low;
    return place - *low;
}

/* Of the four cells around, those that have a value; premultiplied, 0: none has. */
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
    /* in the file's pixels; two to one in vector files, which are magnified */
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
        result = fail_memory(error, "picture of a field", (size_t)width * height * sizeof *pixels);
    }
    mem_free(fractions);
    mem_free(pixels);
    return result;
}
