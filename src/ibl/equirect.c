/* equirect.c - see equirect.h. */
#include "ibl/equirect.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"

static const double pi = 3.14159265358979323846;

/* Which input samples make an output sample, and how much of each, along one axis. */
typedef struct axis_span {
    uint32_t first, count; /* samples first .. first + count - 1, wrapped at the end of the axis */
    uint32_t weight;       /* index of the first weight */
} axis_span;

typedef struct axis_filter {
    axis_span *spans;
    float *weights; /* add up to 1 for each output sample */
} axis_filter;

static void axis_filter_destroy(axis_filter *f)
{
    mem_free(f->spans);
    mem_free(f->weights);
}

/* Measure of the axis between a and b, in samples of in: length, or for latitudes the height of the zone. */
static double axis_measure(double a, double b, uint32_t in, bool is_latitude)
{
    return is_latitude ? cos(pi * a / in) - cos(pi * b / in) : b - a;
}

static bool axis_filter_create(uint32_t in, uint32_t out, bool is_latitude, const facet_allocator *allocator,
                               axis_filter *f)
{
    double step = (double)in / out;
    size_t taps = (size_t)ceil(step) + 2;
    f->spans = mem_alloc(allocator, out, sizeof *f->spans);
    f->weights = mem_alloc(allocator, out, taps * sizeof *f->weights);
    if (!f->spans || !f->weights)
        return false;
    for (uint32_t o = 0; o < out; o++) {
        axis_span *span = &f->spans[o];
        float *w = f->weights + o * taps;
        span->weight = (uint32_t)(o * taps);
        if (in < out) { /* finer: between the two nearest */
            double x = (o + 0.5) * step - 0.5;
            double x0 = floor(x);
            span->count = 2;
            span->first = x0 < 0.0 ? (is_latitude ? 0 : in - 1) : (uint32_t)x0;
            w[0] = (float)(1.0 - (x - x0));
            w[1] = (float)(x - x0);
            if (is_latitude && (x0 < 0.0 || x0 + 1.0 >= in)) {
                span->count = 1;
                w[0] = 1.0f;
            }
            continue;
        }
        double a = o * step;
        double b = o + 1 == out ? in : (o + 1) * step;
        double whole = axis_measure(a, b, in, is_latitude);
        span->first = (uint32_t)a;
        span->count = (uint32_t)ceil(b) - span->first;
        for (uint32_t k = 0; k < span->count; k++) {
            double from = fmax(a, span->first + k);
            double to = fmin(b, span->first + k + 1.0);
            w[k] = (float)(axis_measure(from, to, in, is_latitude) / whole);
        }
    }
    return true;
}

typedef struct resampling {
    const image *picture;
    const axis_filter *columns, *rows;
    equirect *out;
} resampling;

/* One row of the picture, resampled along its columns, times weight added to out. */
static inline void add_row(const resampling *r, uint32_t y, float weight, rgbx *out)
{
    uint32_t in_width = r->picture->width;
    const float *row = (const float *)r->picture->pixels + (size_t)y * in_width * 3;
    for (uint32_t x = 0; x < r->out->width; x++) {
        axis_span span = r->columns->spans[x];
        const float *w = r->columns->weights + span.weight;
        rgbx sum = {0};
        for (uint32_t k = 0; k < span.count; k++) {
            uint32_t i = span.first + k;
            const float *p = row + 3 * (size_t)(i < in_width ? i : i - in_width);
            sum += (rgbx){p[0], p[1], p[2], 0.0f} * w[k];
        }
        out[x] += sum * weight;
    }
}

IBL_DISPATCH static void resample_rows(void *context, size_t begin, size_t end)
{
    const resampling *r = context;
    equirect *out = r->out;
    for (size_t y = begin; y < end; y++) {
        rgbx *row = out->texels + y * ((size_t)out->width + 1);
        axis_span span = r->rows->spans[y];
        if (out->width == r->picture->width && span.count == 1) {
            const float *p = (const float *)r->picture->pixels + (size_t)span.first * out->width * 3;
            for (uint32_t x = 0; x < out->width; x++, p += 3)
                row[x] = (rgbx){p[0], p[1], p[2], 0.0f};
        } else {
            memset(row, 0, out->width * sizeof *row);
            for (uint32_t k = 0; k < span.count; k++)
                add_row(r, span.first + k, r->rows->weights[span.weight + k], row);
        }
        row[out->width] = row[0];
    }
}

/* ---- tiles ---- */

enum { HOT_RATIO = 16 }; /* a texel this much brighter than the mean of its tile outshines it */

static uint32_t tiles_along(uint32_t texels)
{
    return (texels + EQUIRECT_TILE - 1) / EQUIRECT_TILE;
}

static bool is_tile_hot(const equirect *e, uint32_t tile_x, uint32_t tile_y)
{
    uint32_t x1 = (tile_x + 1) * EQUIRECT_TILE < e->width ? (tile_x + 1) * EQUIRECT_TILE : e->width;
    uint32_t y1 = (tile_y + 1) * EQUIRECT_TILE < e->height ? (tile_y + 1) * EQUIRECT_TILE : e->height;
    rgbx sum = {0};
    rgbx most = {0};
    for (uint32_t y = tile_y * EQUIRECT_TILE; y < y1; y++)
        for (uint32_t x = tile_x * EQUIRECT_TILE; x < x1; x++) {
            rgbx c = e->texels[y * ((size_t)e->width + 1) + x];
            sum += c;
            for (int i = 0; i < 3; i++)
                most[i] = c[i] > most[i] ? c[i] : most[i];
        }
    uint32_t texel_count = (x1 - tile_x * EQUIRECT_TILE) * (y1 - tile_y * EQUIRECT_TILE);
    for (int i = 0; i < 3; i++)
        if (most[i] * (float)texel_count > sum[i] * HOT_RATIO)
            return true;
    return false;
}

static void find_hot_tiles(void *context, size_t begin, size_t end)
{
    equirect *e = context;
    uint32_t columns = tiles_along(e->width);
    for (size_t y = begin; y < end; y++)
        for (uint32_t x = 0; x < columns; x++)
            e->tiles[y * columns + x] = is_tile_hot(e, x, (uint32_t)y) ? 2 : 0;
}

/* Marks the neighbours of hot tiles, so that a filter that reaches over an edge is warned. */
static void spread_hot_tiles(equirect *e)
{
    uint32_t columns = tiles_along(e->width);
    uint32_t rows = tiles_along(e->height);
    for (uint32_t y = 0; y < rows; y++)
        for (uint32_t x = 0; x < columns; x++) {
            if (e->tiles[(size_t)y * columns + x] != 2)
                continue;
            for (uint32_t v = y ? y - 1 : 0; v <= y + 1 && v < rows; v++)
                for (uint32_t i = 0; i < 3; i++) {
                    uint8_t *t = &e->tiles[(size_t)v * columns + (x + columns - 1 + i) % columns];
                    *t = *t ? *t : 1;
                }
        }
}

/* ---- the rest ---- */

facet_result equirect_create(const image *picture, uint32_t width, uint32_t height, bool needs_tiles,
                             const facet_allocator *allocator, uint32_t thread_count, equirect *out,
                             facet_error *error)
{
    *out = (equirect){0};
    axis_filter columns = {0};
    axis_filter rows = {0};
    equirect e = {.width = width, .height = height};
    facet_result result = FACET_OK;
    size_t tile_count = (size_t)tiles_along(width) * tiles_along(height);

    e.texels = mem_alloc(allocator, height, ((size_t)width + 1) * sizeof *e.texels);
    if (needs_tiles)
        e.tiles = mem_alloc(allocator, tile_count, 1);
    if (!e.texels || (needs_tiles && !e.tiles) ||
        !axis_filter_create(picture->width, width, false, allocator, &columns) ||
        !axis_filter_create(picture->height, height, true, allocator, &rows)) {
        equirect_destroy(&e);
        result = fail_memory(error, "environment", (size_t)width * height * sizeof(rgbx));
        goto done;
    }
    resampling r = {picture, &columns, &rows, &e};
    parallel_for(thread_count, height, 8, resample_rows, &r);
    if (needs_tiles) {
        parallel_for(thread_count, tiles_along(height), 1, find_hot_tiles, &e);
        spread_hot_tiles(&e);
    }
    *out = e;
done:
    axis_filter_destroy(&columns);
    axis_filter_destroy(&rows);
    return result;
}

void equirect_destroy(equirect *e)
{
    mem_free(e->texels);
    mem_free(e->tiles);
    *e = (equirect){0};
}

double equirect_texel_solid_angle(uint32_t width, uint32_t height, uint32_t y)
{
    /* cos a - cos b = 2 sin((a + b) / 2) sin((b - a) / 2): no cancellation at the poles */
    return 2.0 * pi / width * 2.0 * sin(pi * (y + 0.5) / height) * sin(0.5 * pi / height);
}

void equirect_direction(uint32_t width, uint32_t height, double x, double y, float d[3])
{
    double phi = 2.0 * pi * ((x + 0.5) / width - 0.5);
    double theta = pi * (y + 0.5) / height;
    d[0] = (float)(sin(theta) * cos(phi));
    d[1] = (float)cos(theta);
    d[2] = (float)(sin(theta) * sin(phi));
}

void equirect_mean(const equirect *e, float mean[3])
{
    double sum[3] = {0.0, 0.0, 0.0};
    for (uint32_t y = 0; y < e->height; y++) {
        double row[3] = {0.0, 0.0, 0.0};
        const rgbx *t = e->texels + y * ((size_t)e->width + 1);
        for (uint32_t x = 0; x < e->width; x++)
            for (int i = 0; i < 3; i++)
                row[i] += (double)t[x][i];
        double weight = equirect_texel_solid_angle(e->width, e->height, y) / (4.0 * pi);
        for (int i = 0; i < 3; i++)
            sum[i] += row[i] * weight;
    }
    for (int i = 0; i < 3; i++)
        mean[i] = (float)sum[i];
}
