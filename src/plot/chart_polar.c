/* chart_polar.c - round panels: half discs with curves over an angle (0 up, -90 degrees at the left), and
 * discs with a field over the hemisphere of directions (rings of the angle from the normal, azimuths
 * around). */
#include <math.h>
#include <stdio.h>

#include "base/result.h"
#include "plot/chart_view.h"

/* ---- half discs: curves over an angle ---- */

static const double DEGREE = 0.017453292519943295;
/* In units of the size of tick labels. */
static const double ANGLE_GAP = 0.55, RADIUS_GAP = 0.45;

typedef struct half_disc {
    double x, y, radius; /* the center of its base, px */
} half_disc;

static half_disc place_half_disc(const panel_view *v)
{
    const double radius = fmax(fmin(0.5 * v->plot.width, v->plot.height), 1.0);
    return (half_disc){.x = rint(v->plot.x + 0.5 * v->plot.width),
                       .y = rint(v->plot.y + 0.5 * (v->plot.height + radius)),
                       .radius = radius};
}

static void angle_label(int degrees, char out[16])
{
    snprintf(out, 16, "%s%d\xc2\xb0", degrees < 0 ? "\xe2\x88\x92" : "", degrees < 0 ? -degrees : degrees);
}

void view_polar_measure(const drawing *d, panel_view *v)
{
    const chart_panel *p = v->panel;
    const canvas_font tick = view_tick_font(d);
    axis_extent e = AXIS_EXTENT_NONE;
    for (size_t i = 0; i < p->curve_count; i++)
        axis_extent_add(&e, p->y.scale, p->curves[i].count, p->curves[i].y);
    if (p->y.scale == CHART_LINEAR && e.minimum <= e.maximum) { /* from the center */
        e.minimum = 0.0;
        e.maximum = fmax(e.maximum, 0.0);
    }
    const double radius = fmin(0.5 * v->plot.width, v->plot.height);
    axis_create(d->canvas, tick, &p->y, e, radius, false, &v->y);
    v->margins = (view_margins){.left = 2.0, .right = 2.0, .top = 2.0, .bottom = 2.0};
    if (v->detail >= VIEW_TICKS) {
        const double width = canvas_text_width(d->canvas, tick,
                                               "\xe2\x88\x92"
                                               "90\xc2\xb0");
        v->margins.left = v->margins.right = width + tick.size * (ANGLE_GAP + 0.2);
        v->margins.top = tick.size * (ANGLE_GAP + 1.1);
        v->margins.bottom = tick.size * (RADIUS_GAP + 1.3);
    }
    if (v->detail >= VIEW_ALL && ((p->y.label && *p->y.label) || v->y.ticks.power != 0))
        v->margins.bottom += 1.5 * view_label_font(d).size;
}

void view_polar_trace(const drawing *d, panel_view *v)
{
    (void)d;
    const half_disc disc = place_half_disc(v);
    v->y.from = disc.x;
    v->y.to = disc.x + disc.radius;
    for (size_t i = 0; i < v->traces.count; i++) {
        trace *t = &v->traces.traces[i];
        for (size_t k = 0; k < t->count; k++) {
            const double angle = t->curve->x[k], value = t->curve->y[k];
            double radius = axis_fraction(&v->y, value);
            if (isfinite(value) && !(radius > 0.0)) /* values below the axis are in the center */
                radius = 0.0;
            const bool is_point = isfinite(angle) && isfinite(radius);
            t->x[k] = is_point ? disc.x + disc.radius * radius * sin(angle) : (double)NAN;
            t->y[k] = is_point ? disc.y - disc.radius * radius * cos(angle) : (double)NAN;
        }
    }
}

static void half_ring(const drawing *d, const half_disc *disc, double radius, canvas_color color)
{
    canvas_arc(d->canvas, disc->x, disc->y, radius, -180.0 * DEGREE, 0.0);
    canvas_draw(d->canvas, &(canvas_stroke){.color = color, .width = 1.0, .is_butt = true});
}

static void draw_grid(const drawing *d, const panel_view *v, const half_disc *disc)
{
    for (int i = 0; i < v->y.ticks.count; i++) {
        const double radius = axis_fraction(&v->y, v->y.ticks.values[i]) * disc->radius;
        if (radius > 1.0 && radius < disc->radius - 1.0)
            half_ring(d, disc, radius, d->theme->grid);
    }
    for (int degrees = -75; degrees <= 75; degrees += 15) {
        const bool is_major = degrees % 30 == 0;
        const double x = sin(degrees * DEGREE), y = -cos(degrees * DEGREE), from = is_major ? 0.0 : 0.985;
        view_line(d, disc->x + from * disc->radius * x, disc->y + from * disc->radius * y,
                  disc->x + disc->radius * x, disc->y + disc->radius * y,
                  is_major ? d->theme->grid : d->theme->axis, 1.0);
    }
}

static void draw_angles(const drawing *d, const half_disc *disc)
{
    const canvas_font font = view_tick_font(d);
    double end = -HUGE_VAL;
    for (int degrees = -90; degrees <= 90; degrees += 30) {
        const double x = sin(degrees * DEGREE), y = -cos(degrees * DEGREE);
        const double reach = disc->radius + ANGLE_GAP * font.size;
        label_line l;
        char text[16];
        angle_label(degrees, text);
        label_fit(d->canvas, font, text, 1e4, &l);
        /* the near edge of the label touches the circle of that radius in every direction */
        const double middle = disc->x + reach * x + 0.5 * l.width * x;
        if (middle - 0.5 * l.width < end && fabs(y) > 0.9) /* in a very small panel */
            continue;
        end = middle + 0.5 * l.width;
        label_draw(d->canvas, &l, font, d->theme->muted_text, LABEL_CENTER, middle,
                   disc->y + reach * y + 0.4 * font.size * y + label_middle(font));
    }
}

static void draw_radii(const drawing *d, const panel_view *v, const half_disc *disc)
{
    const canvas_font font = view_tick_font(d);
    const double base = disc->y + font.size * (RADIUS_GAP + 1.0);
    for (int i = 0; i < v->y.ticks.count; i++) {
        const double radius = axis_fraction(&v->y, v->y.ticks.values[i]) * disc->radius;
        view_line(d, view_snap(disc->x + radius), disc->y, view_snap(disc->x + radius),
                  disc->y + 0.35 * font.size, d->theme->axis, 1.0);
        label_draw_tick(d->canvas, &v->y.ticks.labels[i], font, d->theme->muted_text, LABEL_CENTER,
                        disc->x + radius, base);
    }
}

static void draw_names(const drawing *d, const panel_view *v, const half_disc *disc)
{
    const canvas_font font = view_label_font(d), tick = view_tick_font(d);
    const double base = disc->y + tick.size * (RADIUS_GAP + 1.3) + 1.1 * font.size;
    label_line name;
    label_fit(d->canvas, font, v->panel->y.label, v->cell.width, &name);
    /* below the radii, if there is space */
    const double x = name.width <= disc->radius ? disc->x + 0.5 * disc->radius : disc->x;
    label_draw(d->canvas, &name, font, d->theme->text, LABEL_CENTER, x, base);
    const tick_label power = axis_power(&v->y);
    if (*power.text)
        label_draw_tick(d->canvas, &power, tick, d->theme->muted_text, LABEL_RIGHT,
                        x - 0.5 * name.width - font.size, base);
}

facet_result view_polar_draw(const drawing *d, panel_view *v, facet_error *error)
{
    (void)error;
    const half_disc disc = place_half_disc(v);
    const chart_box box = {disc.x - disc.radius, disc.y - disc.radius, 2.0 * disc.radius, disc.radius};
    draw_grid(d, v, &disc);
    canvas_save(d->canvas);
    const double slack = 2.0 * d->scale;
    canvas_arc(d->canvas, disc.x, disc.y, disc.radius + slack, -180.0 * DEGREE, 0.0);
    canvas_line_to(d->canvas, disc.x + disc.radius + slack, disc.y + slack);
    canvas_line_to(d->canvas, disc.x - disc.radius - slack, disc.y + slack);
    canvas_close(d->canvas);
    canvas_clip(d->canvas);
    trace_list_draw(d->canvas, &v->traces, &box, d->chart->is_dark, d->scale);
    canvas_restore(d->canvas);
    half_ring(d, &disc, disc.radius, d->theme->axis);
    view_line(d, disc.x - disc.radius, disc.y, disc.x + disc.radius, disc.y, d->theme->axis, 1.0);
    if (v->detail >= VIEW_TICKS) {
        draw_angles(d, &disc);
        draw_radii(d, v, &disc);
    }
    if (v->detail >= VIEW_ALL)
        draw_names(d, v, &disc);
    return FACET_OK;
}

/* ---- discs: fields over a hemisphere ---- */

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

/* The radius of directions at that angle from the normal, over that of the disc. */
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

/* A line that is visible on every color: dark below, light above. */
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

/* "30 deg" beside its ring, on a plate that makes it readable on every color. */
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
    TRY(draw_field(d, v, &disc, error));
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
