/* chart_space.c - see chart_space.h. */
#include "plot/chart_space.h"

#include <math.h>
#include <string.h>

#include "base/result.h"
#include "plot/chart_ticks.h"

/* ---- the view ---- */

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

/* Coincident points share a normal: count of them from first, stride apart. */
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

/* Seams: the first and last column of a closed grid, and its poles, where all points of a row coincide. */
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

/* ---- the z-buffer ---- */

/* samples per pixel in each direction; rows of pixels that are rendered at a time */
enum { SAMPLES = 3, BAND = 32 };

/* Samples of a band of rows. */
typedef struct band {
    uint32_t first_row, row_count; /* pixels */
    uint32_t columns;              /* samples in a row */
    float *depth;
    uint32_t *color; /* 0: none */
} band;

static uint32_t shaded(const uint32_t colors[256], float value, float shade)
{
    const uint32_t color = colors[(int)(fminf(fmaxf(value, 0.0f), 1.0f) * 255.0f + 0.5f)];
    const uint32_t s = (uint32_t)(fminf(fmaxf(shade, 0.0f), 1.0f) * 256.0f + 0.5f);
    const uint32_t red = (color >> 16 & 0xff) * s >> 8, green = (color >> 8 & 0xff) * s >> 8;
    return 0xff000000u | red << 16 | green << 8 | ((color & 0xff) * s >> 8);
}

static bool is_drawable(const solid_vertex *a)
{
    return fabsf(a->x) < 1e6f && fabsf(a->y) < 1e6f && isfinite(a->depth) && isfinite(a->value) &&
           isfinite(a->shade);
}

/* The whole numbers n with low <= n + 0.5 <= high that are in [first, end). */
static void cover(float low, float high, uint32_t first, uint32_t end, uint32_t *from, uint32_t *to)
{
    const float a = ceilf(low - 0.5f), b = floorf(high - 0.5f) + 1.0f;
    *from = a > (float)first ? (a < (float)end ? (uint32_t)a : end) : first;
    *to = b > (float)first ? (b < (float)end ? (uint32_t)b : end) : first;
}

static float edge(const solid_vertex *a, const solid_vertex *b, float x, float y)
{
    return (b->x - a->x) * (y - a->y) - (b->y - a->y) * (x - a->x);
}

static void draw_triangle(const band *of, const solid_vertex v[3], const uint32_t colors[256])
{
    solid_vertex s[3]; /* in samples */
    for (int i = 0; i < 3; i++) {
        s[i] = v[i];
        s[i].x *= SAMPLES;
        s[i].y *= SAMPLES;
    }
    const float area = edge(&s[0], &s[1], s[2].x, s[2].y);
    uint32_t x0, x1, y0, y1;
    cover(fminf(fminf(s[0].x, s[1].x), s[2].x), fmaxf(fmaxf(s[0].x, s[1].x), s[2].x), 0, of->columns, &x0,
          &x1);
    cover(fminf(fminf(s[0].y, s[1].y), s[2].y), fmaxf(fmaxf(s[0].y, s[1].y), s[2].y), of->first_row * SAMPLES,
          (of->first_row + of->row_count) * SAMPLES, &y0, &y1);
    if (area == 0.0f)
        return;
    for (uint32_t y = y0; y < y1; y++)
        for (uint32_t x = x0; x < x1; x++) {
            const float px = (float)x + 0.5f, py = (float)y + 0.5f;
            const float a = edge(&s[1], &s[2], px, py) / area, b = edge(&s[2], &s[0], px, py) / area;
            const float c = 1.0f - a - b;
            if (a < 0.0f || b < 0.0f || c < 0.0f)
                continue;
            const float depth = a * s[0].depth + b * s[1].depth + c * s[2].depth;
            const size_t i = (size_t)(y - of->first_row * SAMPLES) * of->columns + x;
            if (depth <= of->depth[i])
                continue;
            of->depth[i] = depth;
            of->color[i] = shaded(colors, a * s[0].value + b * s[1].value + c * s[2].value,
                                  a * s[0].shade + b * s[1].shade + c * s[2].shade);
        }
}

static void draw_grid(const band *of, const solid_vertex *vertices, uint32_t columns, uint32_t rows,
                      const uint32_t colors[256])
{
    for (uint32_t row = 0; row + 1 < rows; row++)
        for (uint32_t column = 0; column + 1 < columns; column++) {
            const solid_vertex *a = &vertices[(size_t)row * columns + column], *b = a + columns;
            const solid_vertex corners[4] = {a[0], a[1], b[0], b[1]};
            static const int TRIANGLES[2][3] = {{0, 1, 2}, {1, 3, 2}};
            for (int t = 0; t < 2; t++) {
                const solid_vertex v[3] = {corners[TRIANGLES[t][0]], corners[TRIANGLES[t][1]],
                                           corners[TRIANGLES[t][2]]};
                if (is_drawable(&v[0]) && is_drawable(&v[1]) && is_drawable(&v[2]))
                    draw_triangle(of, v, colors);
            }
        }
}

/* The mean of the samples of a pixel. */
static void resolve(const band *of, solid *out)
{
    for (uint32_t row = 0; row < of->row_count; row++)
        for (uint32_t column = 0; column < out->width; column++) {
            uint32_t sums[4] = {0};
            float nearest = -INFINITY;
            for (uint32_t k = 0; k < SAMPLES * SAMPLES; k++) {
                const size_t i =
                    (size_t)(row * SAMPLES + k / SAMPLES) * of->columns + column * SAMPLES + k % SAMPLES;
                nearest = fmaxf(nearest, of->depth[i]);
                for (int channel = 0; channel < 4; channel++)
                    sums[channel] += of->color[i] >> (8 * channel) & 0xff;
            }
            uint32_t pixel = 0;
            for (int channel = 0; channel < 4; channel++)
                pixel |= (sums[channel] + SAMPLES * SAMPLES / 2) / (SAMPLES * SAMPLES) << (8 * channel);
            const size_t place = (size_t)(of->first_row + row) * out->width + column;
            out->pixels[place] = pixel;
            out->depth[place] = nearest;
        }
}

facet_result solid_create(const facet_allocator *allocator, uint32_t width, uint32_t height,
                          const solid_vertex *vertices, uint32_t columns, uint32_t rows,
                          const uint32_t colors[256], solid *out, facet_error *error)
{
    const size_t sample_count = (size_t)width * SAMPLES * BAND * SAMPLES;
    *out = (solid){.width = width, .height = height};
    out->pixels = mem_alloc(allocator, (size_t)width * height, sizeof *out->pixels);
    out->depth = mem_alloc(allocator, (size_t)width * height, sizeof *out->depth);
    band b = {.columns = width * SAMPLES,
              .depth = mem_alloc(allocator, sample_count, sizeof *b.depth),
              .color = mem_alloc(allocator, sample_count, sizeof *b.color)};
    const bool has_memory = out->pixels && out->depth && b.depth && b.color;
    for (b.first_row = 0; has_memory && b.first_row < height; b.first_row += BAND) {
        b.row_count = height - b.first_row < BAND ? height - b.first_row : BAND;
        for (size_t i = 0; i < sample_count; i++)
            b.depth[i] = -INFINITY;
        memset(b.color, 0, sample_count * sizeof *b.color);
        draw_grid(&b, vertices, columns, rows, colors);
        resolve(&b, out);
    }
    mem_free(b.depth);
    mem_free(b.color);
    if (has_memory)
        return FACET_OK;
    solid_destroy(out);
    return fail_memory(error, "image of a surface", (size_t)width * height * 8);
}

void solid_destroy(solid *s)
{
    mem_free(s->pixels);
    mem_free(s->depth);
    *s = (solid){0};
}

float solid_depth_at(const solid *s, double x, double y)
{
    if (!(x >= 0.0 && y >= 0.0 && x < s->width && y < s->height))
        return -INFINITY;
    return s->depth[(size_t)y * s->width + (size_t)x];
}
