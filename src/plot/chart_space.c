/* chart_space.c - see chart_space.h. */
#include "plot/chart_space.h"

#include <math.h>

#include "plot/chart_ticks.h"

static const double DEGREE = 0.017453292519943295;

double space_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

bool space_point(const chart_surface *s, size_t i, double p[3])
{
    p[0] = s->x[i];
    p[1] = s->y[i];
    p[2] = s->z[i];
    return fabs(p[0]) < 1e100 && fabs(p[1]) < 1e100 && fabs(p[2]) < 1e100; /* false for NaN */
}

static void include(space_view *w, const double p[3])
{
    const double at[2] = {space_dot(p, w->right), space_dot(p, w->up)};
    for (int i = 0; i < 2; i++) {
        w->low[i] = fmin(w->low[i], at[i]);
        w->high[i] = fmax(w->high[i], at[i]);
    }
}

space_view space_look_at(const chart_surface *s)
{
    const double azimuth = isfinite(s->azimuth_rad) ? s->azimuth_rad : 0.0;
    const double elevation = isfinite(s->elevation_rad)
                                 ? fmin(fmax(s->elevation_rad, -90.0 * DEGREE), 90.0 * DEGREE)
                                 : 30.0 * DEGREE;
    const double ca = cos(azimuth), sa = sin(azimuth), ce = cos(elevation), se = sin(elevation);
    space_view w = {
        .right = {-sa, ca, 0.0}, .up = {-se * ca, -se * sa, ce}, .toward = {ce * ca, ce * sa, se}};
    double reach = 0.0;
    for (size_t i = 0; i < (size_t)s->width * s->height; i++) {
        double p[3];
        if (!space_point(s, i, p))
            continue;
        include(&w, p);
        reach = fmax(reach, hypot(p[0], p[1]));
        w.top = fmax(w.top, p[2]);
    }
    double center = 0.0, rim = reach;
    ticks_range(CHART_LINEAR, &center, &rim);
    ticks t;
    ticks_create(&(ticks_desc){.minimum = 0.0, .maximum = rim, .target = 4}, &t);
    w.base_radius = t.maximum;
    for (int degrees = 0; degrees < 360; degrees += 10) {
        const double p[3] = {w.base_radius * cos(degrees * DEGREE), w.base_radius * sin(degrees * DEGREE),
                             0.0};
        include(&w, p);
    }
    const double tip[3] = {0.0, 0.0, 1.1 * w.top};
    include(&w, tip);
    return w;
}

void space_place(space_view *w, const chart_box *plot)
{
    const double width = w->high[0] - w->low[0], height = w->high[1] - w->low[1];
    w->scale = fmin(plot->width / width, plot->height / height);
    w->x = plot->x + 0.5 * (plot->width - w->scale * (w->low[0] + w->high[0]));
    w->y = plot->y + 0.5 * (plot->height + w->scale * (w->low[1] + w->high[1]));
}

void space_project(const space_view *w, const double p[3], double *x, double *y)
{
    *x = w->x + w->scale * space_dot(p, w->right);
    *y = w->y - w->scale * space_dot(p, w->up);
}

/* ---- light ---- */

/* Adds the normals of the triangles around each vertex, weighted by their areas. */
static void add_triangles(const chart_surface *s, double (*normals)[3])
{
    for (uint32_t row = 0; row + 1 < s->height; row++)
        for (uint32_t column = 0; column + 1 < s->width; column++) {
            const size_t i = (size_t)row * s->width + column;
            const size_t corners[4] = {i, i + 1, i + s->width, i + s->width + 1};
            static const int TRIANGLES[2][3] = {{0, 1, 2}, {1, 3, 2}};
            for (int t = 0; t < 2; t++) {
                double p[3][3], a[3], b[3], n[3];
                bool is_there = true;
                for (int k = 0; k < 3; k++)
                    is_there = space_point(s, corners[TRIANGLES[t][k]], p[k]) && is_there;
                for (int k = 0; k < 3; k++) {
                    a[k] = p[1][k] - p[0][k];
                    b[k] = p[2][k] - p[0][k];
                }
                cross(a, b, n);
                for (int k = 0; k < 3 && is_there; k++)
                    for (int c = 0; c < 3; c++)
                        normals[corners[TRIANGLES[t][k]]][c] += n[c];
            }
        }
}

static bool is_same_point(const chart_surface *s, size_t i, size_t k)
{
    const double size = fabs(s->x[i]) + fabs(s->y[i]) + fabs(s->z[i]);
    return fabs(s->x[i] - s->x[k]) + fabs(s->y[i] - s->y[k]) + fabs(s->z[i] - s->z[k]) <= 1e-6 * size;
}

/* Points that are one in space have one normal: count of them from first, stride apart. */
static void join_normals(const chart_surface *s, double (*normals)[3], size_t first, size_t stride,
                         size_t count)
{
    double sum[3] = {0.0};
    for (size_t i = 0; i < count; i++) {
        if (!is_same_point(s, first, first + i * stride))
            return;
        for (int c = 0; c < 3; c++)
            sum[c] += normals[first + i * stride][c];
    }
    for (size_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++)
            normals[first + i * stride][c] = sum[c];
}

/* Where a grid goes round (its first and last column are one), and at its poles (all points of a row are one). */
static void join_seams(const chart_surface *s, double (*normals)[3])
{
    const size_t columns = s->width, rows = s->height;
    for (size_t row = 0; row < rows; row++)
        join_normals(s, normals, row * columns, columns - 1, 2);
    for (size_t column = 0; column < columns; column++)
        join_normals(s, normals, column, (rows - 1) * columns, 2);
    join_normals(s, normals, 0, 1, columns);
    join_normals(s, normals, (rows - 1) * columns, 1, columns);
}

void space_add_normals(const chart_surface *s, double (*normals)[3])
{
    add_triangles(s, normals);
    join_seams(s, normals);
}

double space_shade(const space_view *w, const double normal[3])
{
    static const double LIGHT[3] = {-0.42, 0.52, 0.743};
    const double length = sqrt(space_dot(normal, normal));
    if (!(length > 0.0) || !isfinite(length))
        return 1.0;
    double n[3] = {space_dot(normal, w->right) / length, space_dot(normal, w->up) / length,
                   space_dot(normal, w->toward) / length};
    const double side = n[2] < 0.0 ? -1.0 : 1.0;
    return 0.58 + 0.42 * fmax(side * space_dot(n, LIGHT), 0.0);
}
