/* chart_solid.c - see chart_solid.h. */
#include "plot/chart_solid.h"

#include <math.h>
#include <string.h>

#include "base/result.h"

enum { SAMPLES = 3, BAND = 32 }; /* samples of a pixel each way; rows of pixels that are in work at a time */

/* The samples of some rows of the picture. */
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

/* The mean of a pixel's samples. */
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
    return fail_memory(error, "picture of a surface", (size_t)width * height * 8);
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
