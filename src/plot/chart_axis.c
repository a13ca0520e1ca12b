/* chart_axis.c - an axis: its range, ticks and position in pixels. See chart_view.h. */
#include "plot/chart_view.h"

#include <math.h>
#include <stdio.h>

void axis_extent_add(axis_extent *e, chart_scale scale, size_t count, const double *values)
{
    for (size_t i = 0; i < count; i++) {
        const double v = values[i];
        if (!isfinite(v) || (scale == CHART_LOG10 && v <= 0.0))
            continue;
        if (e->minimum > e->maximum) {
            e->minimum = e->maximum = v;
        } else {
            e->minimum = fmin(e->minimum, v);
            e->maximum = fmax(e->maximum, v);
        }
    }
}

/* The requested range if there is a valid one, else that of the data. */
static ticks_desc describe(const chart_axis *axis, axis_extent data)
{
    ticks_desc d = {.scale = axis->scale == CHART_LOG10 ? CHART_LOG10 : CHART_LINEAR,
                    .is_degrees = axis->is_degrees,
                    .minimum = data.minimum,
                    .maximum = data.maximum};
    const double low = fmin(axis->minimum, axis->maximum), high = fmax(axis->minimum, axis->maximum);
    if (axis->has_range && isfinite(low) && isfinite(high) && high > low && fabs(low) <= 1e300 &&
        fabs(high) <= 1e300) {
        d.is_fixed = true;
        d.minimum = low;
        d.maximum = high;
        if (d.scale == CHART_LOG10 && low <= 0.0) { /* down to the smallest value */
            d.is_fixed = high > 0.0;
            d.minimum = data.minimum > 0.0 && data.minimum < high ? data.minimum : 1e-3 * high;
            d.minimum = fmax(d.minimum, 1e-300);
            d.maximum = high;
        }
        if (d.is_fixed && d.maximum - d.minimum > 1e-12 * fmax(fabs(d.minimum), fabs(d.maximum)) &&
            d.maximum - d.minimum > 1e-290)
            return d;
        d.is_fixed = false;
    }
    ticks_range(d.scale, &d.minimum, &d.maximum);
    return d;
}

/* Whether neighboring labels of a row do not touch. */
static bool labels_fit(canvas *c, canvas_font font, const axis_view *a)
{
    double end = -HUGE_VAL;
    for (int i = 0; i < a->ticks.count; i++) {
        const double middle = axis_place(a, a->ticks.values[i]);
        const double half = 0.5 * label_tick_width(c, font, &a->ticks.labels[i]);
        if (middle - half < end)
            return false;
        end = middle + half + 0.9 * font.size;
    }
    return true;
}

void axis_create(canvas *c, canvas_font font, const chart_axis *axis, axis_extent data, double length,
                 bool is_vertical, axis_view *out)
{
    ticks_desc d = describe(axis, data);
    out->scale = d.scale;
    out->from = 0.0;
    out->to = fmax(length, 1.0);
    const double wanted = length / (font.size * (is_vertical ? 3.6 : 6.5));
    d.target = (int)fmin(fmax(wanted, 2.0), 9.0);
    ticks_create(&d, &out->ticks);
    while (!is_vertical && d.target > 2 && !labels_fit(c, font, out)) {
        d.target--;
        ticks_create(&d, &out->ticks);
    }
}

double axis_fraction(const axis_view *a, double value)
{
    const double low = a->ticks.minimum, high = a->ticks.maximum;
    double t;
    if (!isfinite(value))
        return (double)NAN;
    if (a->scale == CHART_LOG10)
        t = value > 0.0 ? (log10(value) - log10(low)) / (log10(high) - log10(low)) : (double)NAN;
    else
        t = (value - low) / (high - low);
    return isnan(t) ? (double)NAN : fmin(fmax(t, -1e6), 1e6);
}

double axis_place(const axis_view *a, double value)
{
    const double t = axis_fraction(a, value);
    return isnan(t) ? (double)NAN : a->from + t * (a->to - a->from);
}

double axis_label_width(canvas *c, canvas_font font, const axis_view *a)
{
    double width = 0.0;
    for (int i = 0; i < a->ticks.count; i++)
        width = fmax(width, label_tick_width(c, font, &a->ticks.labels[i]));
    return width;
}

tick_label axis_power(const axis_view *a)
{
    tick_label power = {.text = ""};
    const int exponent = a->ticks.power;
    if (exponent != 0) {
        snprintf(power.text, sizeof power.text,
                 "\xc3\x97"
                 "10");
        snprintf(power.exponent, sizeof power.exponent, "%s%d", exponent < 0 ? "\xe2\x88\x92" : "",
                 exponent < 0 ? -exponent : exponent);
    }
    return power;
}
