/* compare_ssim.c - SSIM, see compare_metrics.h. The Gaussian is separable: rows, then columns. In double,
 * because variances are small differences of large numbers. */
#include "compare/compare_metrics.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "base/simd.h"
#include "compare/compare_filter.h"

enum {
    RADIUS = 5,
    TILE_STRIDE = TILE_WIDTH + 2 * RADIUS,
    TILE_ROWS = TILE_HEIGHT + 2 * RADIUS,
    MAX_PLANES = 6, /* luminance over black and over white, R, G, B, opacity */
    MOMENTS = 4     /* a, b, a^2 + b^2, a b */
};

typedef struct ssim_sums {
    double planes[MAX_PLANES];
    uint64_t count; /* windows */
} ssim_sums;

typedef struct ssim_job {
    const compare_source *source;
    uint32_t plane_count;
    bool has_opacity;
    double c1, c2, kernel[RADIUS + 1];
    const facet_allocator *allocator;
    ssim_sums *tiles;
    atomic_bool has_no_memory;
} ssim_job;

/* Scratch memory for a tile. */
typedef struct ssim_work {
    float a[5][TILE_ROWS][TILE_STRIDE],
        b[5][TILE_ROWS][TILE_STRIDE]; /* R, G, B, opacity, luminance over white */
    unsigned char flags[TILE_ROWS][TILE_STRIDE];
    double products[MOMENTS][TILE_STRIDE];
    double moments[MOMENTS][TILE_ROWS][TILE_WIDTH];
} ssim_work;

static float luminance(float *const c[4], uint32_t i)
{
    return 0.2126f * c[0][i] + 0.7152f * c[1][i] + 0.0722f * c[2][i];
}

static void load_tile(const ssim_job *job, const compare_tile *t, ssim_work *w)
{
    static const float white[3] = {1.0f, 1.0f, 1.0f};
    const uint32_t width = t->width + 2 * RADIUS;
    for (uint32_t row = 0; row < t->height + 2 * RADIUS; row++) {
        const int64_t x = (int64_t)t->x - RADIUS, y = (int64_t)t->y + row - RADIUS;
        compare_row out = {.flags = w->flags[row]};
        for (int k = 0; k < 4; k++) {
            out.a[k] = w->a[k][row];
            out.b[k] = w->b[k][row];
        }
        if (job->has_opacity) {
            compare_source_load(job->source, COMPARE_CODES, white, x, y, width, &out);
            for (uint32_t i = 0; i < width; i++) {
                w->a[4][row][i] = luminance(out.a, i);
                w->b[4][row][i] = luminance(out.b, i);
            }
        }
        compare_source_load(job->source, COMPARE_CODES, NULL, x, y, width, &out);
    }
}

/* Values and products of a row of plane p in double: luminance, luminance over white, then the channels. */
static inline __attribute__((always_inline)) void take_products(const ssim_job *job, ssim_work *w, uint32_t p,
                                                                uint32_t row, uint32_t width)
{
    const uint32_t channel = p == 0 ? 0 : job->has_opacity ? (p == 1 ? 4 : p - 2) : p - 1;
    double *restrict a = w->products[0], *restrict b = w->products[1];
    for (uint32_t i = 0; i < width && p != 0; i++) {
        a[i] = (double)w->a[channel][row][i];
        b[i] = (double)w->b[channel][row][i];
    }
    for (uint32_t i = 0; i < width && p == 0; i++) {
        a[i] = 0.2126 * (double)w->a[0][row][i] + 0.7152 * (double)w->a[1][row][i] +
               0.0722 * (double)w->a[2][row][i];
        b[i] = 0.2126 * (double)w->b[0][row][i] + 0.7152 * (double)w->b[1][row][i] +
               0.0722 * (double)w->b[2][row][i];
    }
    double *restrict squares = w->products[2], *restrict product = w->products[3];
    for (uint32_t i = 0; i < width; i++) {
        squares[i] = a[i] * a[i] + b[i] * b[i];
        product[i] = a[i] * b[i];
    }
}

DISPATCH_AVX2 static void ssim_filter_rows(const ssim_job *job, ssim_work *w, uint32_t p,
                                           const compare_tile *t)
{
    for (uint32_t row = 0; row < t->height + 2 * RADIUS; row++) {
        take_products(job, w, p, row, t->width + 2 * RADIUS);
        for (int m = 0; m < MOMENTS; m++)
            filter_line_double(w->products[m] + RADIUS, 1, job->kernel, RADIUS, w->moments[m][row], t->width);
    }
}

/* SSIM of a row of windows. */
DISPATCH_AVX2 static void ssim_filter_columns(const ssim_job *job, const ssim_work *w, uint32_t row,
                                              uint32_t width, double *restrict index)
{
    double sums[MOMENTS][TILE_WIDTH];
    const double c1 = job->c1, c2 = job->c2;
    for (int m = 0; m < MOMENTS; m++)
        filter_line_double(w->moments[m][row + RADIUS], TILE_WIDTH, job->kernel, RADIUS, sums[m], width);
    for (uint32_t i = 0; i < width; i++) {
        const double product = sums[0][i] * sums[1][i],
                     squares = sums[0][i] * sums[0][i] + sums[1][i] * sums[1][i];
        index[i] = (2.0 * product + c1) * (2.0 * (sums[3][i] - product) + c2) /
                   ((squares + c1) * (sums[2][i] - squares + c2));
    }
}

static void tile_planes(const ssim_job *job, const compare_tile *t, ssim_work *w, ssim_sums *sums)
{
    const compare_source *s = job->source;
    load_tile(job, t, w);
    for (uint32_t p = 0; p < job->plane_count; p++) {
        ssim_filter_rows(job, w, p, t);
        for (uint32_t row = 0; row < t->height; row++) {
            double index[TILE_WIDTH];
            if (t->y + row < RADIUS || t->y + row + RADIUS >= s->height)
                continue;
            ssim_filter_columns(job, w, row, t->width, index);
            for (uint32_t i = 0; i < t->width; i++) {
                const bool is_inside = t->x + i >= RADIUS && t->x + i + RADIUS < s->width;
                if (!is_inside || !(w->flags[row + RADIUS][i + RADIUS] & COMPARE_COUNTS))
                    continue;
                sums->planes[p] += index[i];
                sums->count += p == 0;
            }
        }
    }
}

static void ssim_tiles(void *context, size_t begin, size_t end)
{
    ssim_job *job = context;
    ssim_work *w = mem_alloc(job->allocator, 1, sizeof *w);
    if (!w) {
        atomic_store(&job->has_no_memory, true);
        return;
    }
    for (size_t i = begin; i < end; i++) {
        const compare_tile t = compare_tile_at(job->source, i);
        job->tiles[i] = (ssim_sums){.count = 0};
        tile_planes(job, &t, w, &job->tiles[i]);
    }
    mem_free(w);
}

static void set_constants(ssim_job *job, double peak)
{
    double sum = 0.0;
    job->c1 = 0.01 * peak * 0.01 * peak;
    job->c2 = 0.03 * peak * 0.03 * peak;
    for (int j = 0; j <= RADIUS; j++) {
        job->kernel[j] = exp(-j * j / (2.0 * 1.5 * 1.5));
        sum += j ? 2.0 * job->kernel[j] : job->kernel[j];
    }
    for (int j = 0; j <= RADIUS; j++)
        job->kernel[j] /= sum;
}

facet_result compare_ssim_make(const compare_source *s, const facet_compare_desc *desc, facet_comparison *out,
                               facet_error *error)
{
    const size_t tile_count = compare_tile_count(s);
    ssim_job job = {.source = s,
                    .has_opacity = out->channel_count == 4,
                    .plane_count = out->channel_count == 4 ? 6 : 4,
                    .allocator = &desc->allocator};
    set_constants(&job, out->peak);
    job.tiles = mem_alloc(&desc->allocator, tile_count, sizeof *job.tiles);
    if (!job.tiles)
        return fail_memory(error, "sums of tiles", tile_count * sizeof *job.tiles);
    parallel_for(desc->thread_count, tile_count, TILE_GRAIN, ssim_tiles, &job);
    if (atomic_load(&job.has_no_memory)) {
        mem_free(job.tiles);
        return fail_memory(error, "tile", sizeof(ssim_work));
    }
    ssim_sums sums = {.count = 0};
    for (size_t i = 0; i < tile_count; i++) {
        for (int p = 0; p < MAX_PLANES; p++)
            sums.planes[p] += job.tiles[i].planes[p];
        sums.count += job.tiles[i].count;
    }
    mem_free(job.tiles);
    if (sums.count == 0) /* out keeps NAN */
        return FACET_OK;
    const uint32_t first = job.has_opacity ? 2 : 1;
    double channels = 0.0;
    for (uint32_t p = first; p < job.plane_count; p++)
        channels += sums.planes[p];
    double least = sums.planes[0]; /* differences that black hides show over white */
    least = job.has_opacity && sums.planes[1] < least ? sums.planes[1] : least;
    out->ssim = least / (double)sums.count;
    out->ssim_channels = channels / ((double)sums.count * (job.plane_count - first));
    return FACET_OK;
}
