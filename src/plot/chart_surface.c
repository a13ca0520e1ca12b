/* chart_surface.c - panels of a surface in space: orthographic, lightly shaded, in false color, over a
 * disc with the directions of x and y. */
#include "plot/chart_view.h"

#include <math.h>
#include <stdio.h>

#include "base/result.h"
#include "plot/chart_space.h"

static const double DEGREE = 0.017453292519943295;

static solid_vertex make_vertex(const space_view *w, const chart_surface *s, const axis_view *bar, size_t i,
                                const double normal[3])
{
    double p[3], x, y;
    if (!space_point(s, i, p))
        return (solid_vertex){.x = NAN};
    space_project(w, p, &x, &y);
    const double value = axis_fraction(bar, s->values ? s->values[i] : s->z[i]);
    return (solid_vertex){.x = (float)((x - w->box.x) * w->fine),
                          .y = (float)((y - w->box.y) * w->fine),
                          .depth = (float)(w->scale * space_dot(p, w->toward)),
                          .value = (float)fmin(fmax(value, 0.0), 1.0), /* fmax: 0 for NaN */
                          .shade = (float)space_shade(w, normal)};
}

static facet_result make_solid(const drawing *d, const space_view *w, const panel_view *v, solid *out,
                               facet_error *error)
{
    const chart_surface *s = v->panel->surface;
    const size_t count = (size_t)s->width * s->height;
    const axis_view unit = {.ticks = {.minimum = 0.0, .maximum = 255.0}};
    uint32_t colors[256];
    for (int i = 0; i < 256; i++)
        colors[i] = view_bar_color(&unit, i);
    double(*normals)[3] = mem_zalloc(&d->allocator, count, sizeof *normals);
    solid_vertex *vertices = mem_alloc(&d->allocator, count, sizeof *vertices);
    facet_result result;
    if (normals && vertices) {
        space_add_normals(s, normals);
        for (size_t i = 0; i < count; i++)
            vertices[i] = make_vertex(w, s, &v->bar, i, normals[i]);
        result = solid_create(&d->allocator, (uint32_t)(w->box.width * w->fine),
                              (uint32_t)(w->box.height * w->fine), vertices, s->width, s->height, colors, out,
                              error);
    } else {
        result = fail_memory(error, "surface", count * sizeof *vertices);
    }
    mem_free(normals);
    mem_free(vertices);
    return result;
}

/* How a line in space is drawn: whole (solid NULL), or the part in front of the surface or on it. */
typedef struct space_line {
    canvas_stroke stroke;
    const solid *solid;
    double slack; /* px of depth by which a line on the surface may appear behind it */
    bool is_over; /* only where the surface is farther */
    int around;   /* neighborhood in pixels, since depth changes fast on a steep surface */
} space_line;

static bool is_visible(const space_view *w, const space_line *line, double x, double y, double depth)
{
    if (!line->solid)
        return true;
    const double px = (x - w->box.x) * w->fine, py = (y - w->box.y) * w->fine;
    double farthest = HUGE_VAL;
    for (int dy = -line->around; dy <= line->around; dy++)
        for (int dx = -line->around; dx <= line->around; dx++) {
            const double here = (double)solid_depth_at(line->solid, px + dx, py + dy);
            if (isfinite(here))
                farthest = fmin(farthest, here);
        }
    if (!isfinite(farthest))
        return !line->is_over;
    return depth >= farthest - line->slack;
}

/* From a to b in steps of about two pixels. */
static void draw_segment(const drawing *d, const space_view *w, const space_line *line, const double a[3],
                         const double b[3], bool *is_open)
{
    double x0, y0, x1, y1;
    space_project(w, a, &x0, &y0);
    space_project(w, b, &x1, &y1);
    const int steps = line->solid ? (int)fmin(ceil(hypot(x1 - x0, y1 - y0) / 2.0) + 1.0, 1000.0) : 1;
    const double za = w->scale * space_dot(a, w->toward), zb = w->scale * space_dot(b, w->toward);
    for (int i = 1; i <= steps; i++) {
        const double t0 = (i - 1.0) / steps, t1 = (double)i / steps, t = 0.5 * (t0 + t1);
        if (!is_visible(w, line, x0 + t * (x1 - x0), y0 + t * (y1 - y0), za + t * (zb - za))) {
            *is_open = false;
            continue;
        }
        if (!*is_open)
            canvas_move_to(d->canvas, x0 + t0 * (x1 - x0), y0 + t0 * (y1 - y0));
        canvas_line_to(d->canvas, x0 + t1 * (x1 - x0), y0 + t1 * (y1 - y0));
        *is_open = true;
    }
}

/* The grid line of points first, first + stride .. */
static void draw_mesh_line(const drawing *d, const space_view *w, const chart_surface *s,
                           const space_line *line, size_t first, size_t stride, size_t count)
{
    bool is_open = false;
    for (size_t i = 0; i + 1 < count; i++) {
        double a[3], b[3];
        if (space_point(s, first + i * stride, a) && space_point(s, first + (i + 1) * stride, b))
            draw_segment(d, w, line, a, b, &is_open);
        else
            is_open = false;
    }
    canvas_draw(d->canvas, &line->stroke);
}

static void draw_mesh(const drawing *d, const space_view *w, const chart_surface *s, const solid *rendered)
{
    enum { LINES = 12 }; /* about this many in each direction */
    const space_line line = {.stroke = {.color = {1.0, 1.0, 1.0, 0.3}, .width = fmax(0.7 * d->scale, 0.6)},
                             .solid = rendered,
                             .slack = 0.012 * w->scale * w->base_radius,
                             .is_over = true,
                             .around = 1};
    const size_t row_step = (s->height + LINES - 1) / LINES, column_step = (s->width + LINES - 1) / LINES;
    for (size_t row = 0; row < s->height; row += row_step)
        draw_mesh_line(d, w, s, &line, row * s->width, 1, s->width);
    for (size_t column = 0; column < s->width; column += column_step)
        draw_mesh_line(d, w, s, &line, column, s->width, s->height);
}

static void draw_ring(const drawing *d, const space_view *w, const space_line *line, double radius)
{
    bool is_open = false;
    for (int degrees = 0; degrees < 360; degrees += 3) {
        const double a[3] = {radius * cos(degrees * DEGREE), radius * sin(degrees * DEGREE), 0.0};
        const double b[3] = {radius * cos((degrees + 3) * DEGREE), radius * sin((degrees + 3) * DEGREE), 0.0};
        draw_segment(d, w, line, a, b, &is_open);
    }
    canvas_draw(d->canvas, &line->stroke);
}

/* The disc at z = 0 and the z axis: all of it below the surface, then the part in front of it. */
static void draw_base(const drawing *d, const space_view *w, const solid *rendered)
{
    space_line line = {.stroke = {.color = d->theme->grid, .width = 1.0},
                       .solid = rendered,
                       .slack = 0.001 * w->scale * w->base_radius,
                       .is_over = true};
    for (int degrees = 0; degrees < 360; degrees += 30) {
        const double center[3] = {0.0};
        const double rim[3] = {w->base_radius * cos(degrees * DEGREE), w->base_radius * sin(degrees * DEGREE),
                               0.0};
        bool is_open = false;
        draw_segment(d, w, &line, center, rim, &is_open);
        canvas_draw(d->canvas, &line.stroke);
    }
    draw_ring(d, w, &line, 0.5 * w->base_radius);
    line.stroke.color = d->theme->axis;
    draw_ring(d, w, &line, w->base_radius);
    const double foot[3] = {0.0}, tip[3] = {0.0, 0.0, 1.1 * w->top};
    bool is_open = false;
    draw_segment(d, w, &line, foot, tip, &is_open);
    canvas_draw(d->canvas, &line.stroke);
}

/* Whether the surface leaves a box uncovered. */
static bool is_free(const space_view *w, const solid *rendered, const chart_box *box)
{
    for (int row = 0; row <= 4; row++)
        for (int column = 0; column <= 4; column++) {
            const double x = box->x + 0.25 * column * box->width, y = box->y + 0.25 * row * box->height;
            if (isfinite(solid_depth_at(rendered, (x - w->box.x) * w->fine, (y - w->box.y) * w->fine)))
                return false;
        }
    return true;
}

/* Azimuths around the disc, where the surface does not cover them. */
static void draw_compass(const drawing *d, const space_view *w, const solid *rendered)
{
    const canvas_font font = view_tick_font(d);
    for (int degrees = 0; degrees < 360; degrees += 90) {
        const double direction[3] = {cos(degrees * DEGREE), sin(degrees * DEGREE), 0.0};
        const double rim[3] = {w->base_radius * direction[0], w->base_radius * direction[1], 0.0};
        char text[16];
        double x, y;
        label_line l;
        space_project(w, rim, &x, &y);
        snprintf(text, sizeof text, "%d\xc2\xb0", degrees);
        label_fit(d->canvas, font, text, 1e4, &l);
        double dx = space_dot(direction, w->right), dy = -space_dot(direction, w->up);
        const double length = fmax(hypot(dx, dy), 1e-9);
        dx /= length;
        dy /= length;
        x += dx * (0.5 * font.size + 0.5 * l.width);
        y += dy * 0.95 * font.size;
        const chart_box box = {x - 0.5 * l.width, y - 0.5 * font.size, l.width, font.size};
        if (is_free(w, rendered, &box))
            label_draw(d->canvas, &l, font, d->theme->muted_text, LABEL_CENTER, x, y + label_middle(font));
    }
}

void view_surface_measure(const drawing *d, panel_view *v)
{
    const chart_surface *s = v->panel->surface;
    const canvas_font tick = view_tick_font(d);
    v->margins = (view_margins){.left = 2.0, .right = 2.0, .top = 2.0, .bottom = 2.0};
    if (v->detail >= VIEW_TICKS) {
        v->margins.left = v->margins.right =
            canvas_text_width(d->canvas, tick, "180\xc2\xb0") + 0.7 * tick.size;
        v->margins.top = v->margins.bottom = 1.6 * tick.size;
    }
    if (!s)
        return;
    axis_extent values = AXIS_EXTENT_NONE;
    axis_extent_add(&values, CHART_LINEAR, (size_t)s->width * s->height, s->values ? s->values : s->z);
    const double width =
        view_bar_measure(d, s->label, CHART_LINEAR, values, false, 0.8 * v->plot.height, &v->bar);
    if (v->detail == VIEW_ALL)
        v->margins.right += width;
}

/* The bounds of the surface, in whole px. */
static chart_box image_box(const space_view *w)
{
    const double x0 = floor(w->x + w->scale * w->low[0]) - 1.0, x1 = ceil(w->x + w->scale * w->high[0]) + 1.0;
    const double y0 = floor(w->y - w->scale * w->high[1]) - 1.0, y1 = ceil(w->y - w->scale * w->low[1]) + 1.0;
    return (chart_box){x0, y0, x1 - x0, y1 - y0};
}

facet_result view_surface_draw(const drawing *d, panel_view *v, facet_error *error)
{
    const chart_surface *s = v->panel->surface;
    if (!s || s->width == 0 || s->height == 0)
        return FACET_OK;
    space_view w = space_look_at(s);
    space_place(&w, &v->plot);
    w.box = image_box(&w);
    w.fine = canvas_is_raster(d->canvas) ? 1.0 : 2.0;
    w.fine = fmin(w.fine, CANVAS_MAX_SIZE / fmax(w.box.width, w.box.height));
    solid rendered;
    TRY(make_solid(d, &w, v, &rendered, error));
    draw_base(d, &w, NULL);
    canvas_image(d->canvas, w.box.x, w.box.y, w.box.width, w.box.height, rendered.pixels, rendered.width,
                 rendered.height);
    draw_mesh(d, &w, s, &rendered);
    draw_base(d, &w, &rendered);
    if (v->detail >= VIEW_TICKS)
        draw_compass(d, &w, &rendered);
    solid_destroy(&rendered);
    if (v->detail >= VIEW_ALL) {
        const double height = 0.8 * v->plot.height;
        const double side = v->margins.left - 2.0; /* of the labels on the right */
        const chart_box box = {v->plot.x, v->plot.y + 0.1 * v->plot.height, v->plot.width + side, height};
        view_bar_draw(d, s->label, &v->bar, &box);
    }
    return FACET_OK;
}
