/* chart_disc.c - panels of a field over the directions of a hemisphere, seen from above: rings of the angle from the
 * normal, a compass of azimuth. */
#include "plot/chart_view.h"

#include <math.h>
#include <stdio.h>

static const double DEGREE = 0.017453292519943295;
/* In units of the size of tick labels. */
static const double LABEL_GAP = 0.55, TICK = 0.4;

typedef struct full_disc {
    double x, y, radius; /* px */
} full_disc;

static full_disc place_disc(const panel_view *v)
{
    const double radius = fmax(floor(0.5 * fmin(v->plot.width, v->plot.height)), 1.0);
    return (full_disc){.x = rint(v->plot.x + 0.5 * v->plot.width),
                       .y = rint(v->plot.y + 0.5 * v->plot.height),
                       .radius = radius};
}

void view_disc_measure(const drawing *d, panel_view *v)
{
    const chart_field *f = v->panel->field;
    const canvas_font tick = view_tick_font(d);
    v->margins = (view_margins){.left = 2.0, .right = 2.0, .top = 2.0, .bottom = 2.0};
    if (v->detail >= VIEW_TICKS) {
        const double width =
            canvas_text_width(d->canvas, tick, "180\xc2\xb0") + tick.size * (LABEL_GAP + TICK);
        v->margins.left = v->margins.right = width;
        v->margins.top = v->margins.bottom = tick.size * (LABEL_GAP + TICK + 1.1);
    }
    if (!f)
        return;
    axis_extent values = AXIS_EXTENT_NONE;
    const bool is_fixed = isfinite(f->minimum) && isfinite(f->maximum) && f->minimum < f->maximum;
    if (is_fixed)
        values = (axis_extent){f->minimum, f->maximum};
    else
        axis_extent_add(&values, f->scale, (size_t)f->width * f->height, f->values);
    const double size = fmin(v->plot.width, v->plot.height);
    const double width = view_bar_measure(d, f->label, f->scale, values, is_fixed, size, &v->bar);
    if (v->detail == VIEW_ALL)
        v->margins.right += width;
}

/* Of the disc's radius: where directions that far from the normal are. */
static double ring_radius(const chart_field *f, int degrees)
{
    return f && f->is_equidistant ? degrees / 90.0 : sin(degrees * DEGREE);
}

static facet_result draw_field(const drawing *d, const panel_view *v, const full_disc *disc,
                               facet_error *error)
{
    const chart_field *f = v->panel->field;
    if (!f || !(f->x1 > f->x0) || !(f->y1 > f->y0) || f->x1 - f->x0 > 100.0 || f->y1 - f->y0 > 100.0)
        return FACET_OK;
    const double x0 = rint(disc->x + f->x0 * disc->radius), x1 = rint(disc->x + f->x1 * disc->radius);
    const double y0 = rint(disc->y - f->y0 * disc->radius), y1 = rint(disc->y - f->y1 * disc->radius);
    if (!(x1 > x0) || !(y0 > y1))
        return FACET_OK;
    const chart_box box = {x0, y1, x1 - x0, y0 - y1};
    canvas_save(d->canvas);
    canvas_arc(d->canvas, disc->x, disc->y, disc->radius, 0.0, 360.0 * DEGREE);
    canvas_clip(d->canvas);
    const facet_result result = view_field_draw(d, f, &v->bar, &box, error);
    canvas_restore(d->canvas);
    return result;
}

/* A line that is seen on every color: dark below, light above. */
static void draw_on_colors(const drawing *d, double width)
{
    canvas_draw(d->canvas, &(canvas_stroke){.color = {1.0, 1.0, 1.0, 0.45}, .width = width, .is_butt = true});
}

static void draw_rings(const drawing *d, const panel_view *v, const full_disc *disc)
{
    for (int degrees = 30; degrees < 90; degrees += 30) {
        canvas_arc(d->canvas, disc->x, disc->y, ring_radius(v->panel->field, degrees) * disc->radius, 0.0,
                   360.0 * DEGREE);
        canvas_close(d->canvas);
        draw_on_colors(d, fmax(0.9 * d->scale, 0.8));
    }
    for (int degrees = 0; degrees < 180; degrees += 90) {
        const double x = cos(degrees * DEGREE) * disc->radius, y = sin(degrees * DEGREE) * disc->radius;
        canvas_move_to(d->canvas, disc->x - x, disc->y + y);
        canvas_line_to(d->canvas, disc->x + x, disc->y - y);
        draw_on_colors(d, fmax(0.7 * d->scale, 0.6));
    }
    canvas_arc(d->canvas, disc->x, disc->y, disc->radius, 0.0, 360.0 * DEGREE);
    canvas_close(d->canvas);
    canvas_draw(d->canvas, &(canvas_stroke){.color = d->theme->axis, .width = fmax(1.2 * d->scale, 1.0)});
}

/* "30 deg" beside its ring, on a plate that lets it be read on every color. */
static void draw_ring_labels(const drawing *d, const panel_view *v, const full_disc *disc)
{
    canvas_font font = view_tick_font(d);
    font.size *= 0.9;
    const double direction = -68.0 * DEGREE;
    if (disc->radius < 6.0 * font.size)
        return;
    for (int degrees = 30; degrees < 90; degrees += 30) {
        char text[16];
        label_line l;
        snprintf(text, sizeof text, "%d\xc2\xb0", degrees);
        label_fit(d->canvas, font, text, 1e4, &l);
        const double radius = ring_radius(v->panel->field, degrees) * disc->radius;
        const double x = disc->x + radius * cos(direction), y = disc->y - radius * sin(direction);
        const double width = l.width + 0.5 * font.size, height = 1.15 * font.size;
        canvas_rectangle(d->canvas, x - 0.5 * width, y - 0.5 * height, width, height);
        canvas_fill(d->canvas, (canvas_color){0.0, 0.0, 0.0, 0.5});
        label_draw(d->canvas, &l, font, (canvas_color){1.0, 1.0, 1.0, 1.0}, LABEL_CENTER, x,
                   y + label_middle(font));
    }
}

static void draw_compass(const drawing *d, const full_disc *disc)
{
    const canvas_font font = view_tick_font(d);
    for (int degrees = 0; degrees < 360; degrees += 30) {
        const double x = cos(degrees * DEGREE), y = -sin(degrees * DEGREE);
        const bool is_major = degrees % 90 == 0;
        const double to = disc->radius + font.size * TICK * (is_major ? 1.0 : 0.6);
        view_line(d, disc->x + disc->radius * x, disc->y + disc->radius * y, disc->x + to * x,
                  disc->y + to * y, d->theme->axis, 1.0);
        if (!is_major)
            continue;
        char text[16];
        label_line l;
        snprintf(text, sizeof text, "%d\xc2\xb0", degrees);
        label_fit(d->canvas, font, text, 1e4, &l);
        const double reach = disc->radius + font.size * (TICK + 0.35);
        label_draw(d->canvas, &l, font, d->theme->muted_text, LABEL_CENTER,
                   disc->x + (reach + 0.5 * l.width) * x,
                   disc->y + (reach + 0.4 * font.size) * y + label_middle(font));
    }
}

facet_result view_disc_draw(const drawing *d, panel_view *v, facet_error *error)
{
    const full_disc disc = place_disc(v);
    const facet_result result = draw_field(d, v, &disc, error);
    if (result != FACET_OK)
        return result;
    draw_rings(d, v, &disc);
    if (v->detail >= VIEW_TICKS) {
        draw_ring_labels(d, v, &disc);
        draw_compass(d, &disc);
    }
    if (v->detail >= VIEW_ALL && v->panel->field) {
        const double side = disc.radius + canvas_text_width(d->canvas, view_tick_font(d), "180\xc2\xb0");
        const chart_box box = {disc.x - side, disc.y - disc.radius, 2.0 * side, 2.0 * disc.radius};
        view_bar_draw(d, v->panel->field->label, &v->bar, &box);
    }
    return FACET_OK;
}
