/* denoise.c - see denoise.h. Fits are made for overlapping windows; a pixel is the weighted mean of the fits
 * that cover it. Regions then get the energy back that the filter lost. */
#include "film/film.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "film/denoise.h"

/* ---- energy ---- */

enum {
    BLOCK = 16, /* px */
    REACH = 2   /* blocks that a region reaches to each side, with weights that fall linearly */
};

/* Sums over a block, per channel. */
typedef struct block_light {
    double before[3], after[3], variance[3];
} block_light;

typedef struct energy {
    const film *film;
    const float *variance;
    float *filtered;
    uint32_t blocks_x, blocks_y;
    block_light *blocks;
    float *factors; /* 3 per block */
} energy;

static void sum_block(const energy *e, uint32_t block_x, uint32_t block_y, block_light *out)
{
    const film *f = e->film;
    *out = (block_light){0};
    for (uint32_t y = block_y * BLOCK; y < (block_y + 1) * BLOCK && y < f->height; y++)
        for (uint32_t x = block_x * BLOCK; x < (block_x + 1) * BLOCK && x < f->width; x++) {
            size_t i = (size_t)y * f->width + x;
            if (e->filtered[4 * i + 3] <= 0.0f)
                continue;
            for (size_t c = 0; c < 3; c++) {
                double before = (double)f->layers[0].pixels[4 * i + c];
                double variance = (double)e->variance[3 * i + c];
                if (!isfinite(before) || !isfinite(variance))
                    continue;
                out->before[c] += before;
                out->after[c] += (double)e->filtered[4 * i + c];
                out->variance[c] += fmax(variance, 0.0);
            }
        }
}

static void sum_blocks(void *context, size_t begin, size_t end)
{
    const energy *e = context;
    for (size_t i = begin; i < end; i++)
        sum_block(e, (uint32_t)(i % e->blocks_x), (uint32_t)(i / e->blocks_x), &e->blocks[i]);
}

/* Factor that restores the energy of a region: 1 + d where it lacks a share d of its light, shrunk by the
 * probability that d is chance (its variance against its square: a single bright sample is). */
static float factor_of(double before, double after, double variance)
{
    const double most = 0.5;
    if (!(after > 0.0))
        return 1.0f;
    double share = (before - after) / after, noise = variance / (after * after);
    double square = share * share;
    double kept = square > 0.0 ? share * square / (square + noise) : 0.0;
    return (float)(1.0 + fmin(fmax(kept, -most), most));
}

static void find_factors(void *context, size_t begin, size_t end)
{
    const energy *e = context;
    for (size_t i = begin; i < end; i++) {
        ptrdiff_t x = (ptrdiff_t)(i % e->blocks_x), y = (ptrdiff_t)(i / e->blocks_x);
        block_light sum = {0};
        double square[3] = {0};
        for (ptrdiff_t v = y - REACH; v <= y + REACH; v++)
            for (ptrdiff_t u = x - REACH; u <= x + REACH; u++) {
                if (u < 0 || v < 0 || u >= (ptrdiff_t)e->blocks_x || v >= (ptrdiff_t)e->blocks_y)
                    continue;
                const block_light *b = &e->blocks[(size_t)v * e->blocks_x + (size_t)u];
                double weight =
                    (double)((REACH + 1 - (u > x ? u - x : x - u)) * (REACH + 1 - (v > y ? v - y : y - v)));
                for (int c = 0; c < 3; c++) {
                    sum.before[c] += weight * b->before[c];
                    sum.after[c] += weight * b->after[c];
                    square[c] += weight * weight * b->variance[c];
                }
            }
        for (size_t c = 0; c < 3; c++)
            e->factors[3 * i + c] = factor_of(sum.before[c], sum.after[c], square[c]);
    }
}

/* Factors are interpolated between the centers of blocks. */
static void scale_rows(void *context, size_t begin, size_t end)
{
    const energy *e = context;
    uint32_t width = e->film->width;
    for (size_t y = begin; y < end; y++) {
        float v = fmaxf(((float)y + 0.5f) / (float)BLOCK - 0.5f, 0.0f);
        uint32_t top = (uint32_t)v, bottom = top + 1 < e->blocks_y ? top + 1 : e->blocks_y - 1;
        for (uint32_t x = 0; x < width; x++) {
            float u = fmaxf(((float)x + 0.5f) / (float)BLOCK - 0.5f, 0.0f);
            uint32_t left = (uint32_t)u, right = left + 1 < e->blocks_x ? left + 1 : e->blocks_x - 1;
            float s = u - (float)left, t = v - (float)top;
            for (size_t c = 0; c < 3; c++) {
                const float *f = e->factors + c;
                float above = f[3 * ((size_t)top * e->blocks_x + left)] * (1.0f - s) +
                              f[3 * ((size_t)top * e->blocks_x + right)] * s;
                float below = f[3 * ((size_t)bottom * e->blocks_x + left)] * (1.0f - s) +
                              f[3 * ((size_t)bottom * e->blocks_x + right)] * s;
                e->filtered[4 * (y * width + x) + c] *= above * (1.0f - t) + below * t;
            }
        }
    }
}

static facet_result restore_energy(const film *f, float *filtered, const facet_allocator *allocator,
                                   uint32_t thread_count, facet_error *error)
{
    energy e = {.film = f,
                .variance = film_find((film *)f, "variance")->pixels, /* film_find() does not write */
                .filtered = filtered,
                .blocks_x = (f->width + BLOCK - 1) / BLOCK,
                .blocks_y = (f->height + BLOCK - 1) / BLOCK};
    size_t count = (size_t)e.blocks_x * e.blocks_y;
    e.blocks = mem_alloc(allocator, count, sizeof *e.blocks + 3 * sizeof *e.factors);
    if (!e.blocks)
        return fail_memory(error, "blocks of the denoiser",
                           count * (sizeof *e.blocks + 3 * sizeof *e.factors));
    e.factors = (float *)(e.blocks + count);
    parallel_for(thread_count, count, 1, sum_blocks, &e);
    parallel_for(thread_count, count, BLOCK, find_factors, &e);
    parallel_for(thread_count, f->height, BLOCK, scale_rows, &e);
    mem_free(e.blocks);
    return FACET_OK;
}

enum {
    TILE = 32,  /* px; more than the reach of two windows: tiles that are not neighbours share no pixel */
    STRIDE = 4, /* px from center to center */
    PHASES = 8  /* four sets of tiles of which no two are neighbours, twice */
};
_Static_assert(TILE > 2 * DENOISE_RADIUS, "tiles of one phase do not meet");

typedef struct denoising {
    const denoise_planes *planes;
    film *film;
    float *sums; /* 3 channels and their weight per pixel */
    uint32_t tiles_x, tiles_y;
    int phase;
} denoising;

static void add_window(const denoising *d, uint32_t x, uint32_t y)
{
    const denoise_planes *p = d->planes;
    denoise_fit fit;
    denoise_fit_window(p, (ptrdiff_t)x, (ptrdiff_t)y, &fit);
    for (uint32_t j = 0; j < DENOISE_SIDE; j++)
        for (uint32_t i = 0; i < DENOISE_SIDE; i++) {
            uint32_t k = j * DENOISE_ROW + i;
            float weight = fit.weight[k];
            if (weight <= 0.0f)
                continue;
            float *sum = d->sums + 4 * ((size_t)(y + j - DENOISE_RADIUS) * p->width + x + i - DENOISE_RADIUS);
            for (int c = 0; c < 3; c++)
                sum[c] += weight * fit.value[c][k];
            sum[3] += weight;
        }
}

/* Pixels without noise stay as they are. */
static bool is_clean(const denoise_planes *p, uint32_t x, uint32_t y)
{
    size_t o = denoise_index(p, (ptrdiff_t)x, (ptrdiff_t)y);
    return p->noise[0][o] == 0.0f && p->noise[1][o] == 0.0f && p->noise[2][o] == 0.0f;
}

/* First a window at every STRIDE-th pixel, then one at each pixel that those windows weigh little. */
static void filter_tile(const denoising *d, uint32_t tile_x, uint32_t tile_y)
{
    const float enough = 1.0f;
    const denoise_planes *p = d->planes;
    bool is_regular = d->phase < PHASES / 2;
    uint32_t step = is_regular ? STRIDE : 1, first = is_regular ? STRIDE / 2 : 0;
    for (uint32_t y = tile_y * TILE + first; y < (tile_y + 1) * TILE && y < p->height; y += step)
        for (uint32_t x = tile_x * TILE + first; x < (tile_x + 1) * TILE && x < p->width; x += step) {
            bool has_enough = !is_regular && d->sums[4 * ((size_t)y * p->width + x) + 3] >= enough;
            if (!has_enough && !is_clean(p, x, y))
                add_window(d, x, y);
        }
}

/* Tiles of which no two are neighbours: their windows write different pixels, and each pixel receives its
 * sums in the same order whichever thread takes a tile. */
static void filter_tiles(void *context, size_t begin, size_t end)
{
    const denoising *d = context;
    uint32_t odd_x = (uint32_t)d->phase & 1, odd_y = (uint32_t)d->phase >> 1 & 1;
    uint32_t row = (d->tiles_x + 1) / 2;
    for (size_t i = begin; i < end; i++) {
        uint32_t tile_x = 2 * (uint32_t)(i % row) + odd_x, tile_y = 2 * (uint32_t)(i / row) + odd_y;
        if (tile_x < d->tiles_x && tile_y < d->tiles_y)
            filter_tile(d, tile_x, tile_y);
    }
}

/* Limits value to a distance from the pixel that noise explains, so that the filter fades out as samples
 * accumulate, and to at least black, unless the pixel was darker (pixel filters may have negative lobes). */
static float within_noise(float value, float before, float standard_error)
{
    const float most = 8.0f; /* standard deviations; the estimate of one pixel may be far too small */
    float range = most * standard_error;
    float least = before - range;
    if (before >= 0.0f && least < 0.0f)
        least = 0.0f;
    return value < least ? least : value > before + range ? before + range : value;
}

/* Resolves the sums of a pixel; weight 0 leaves it as it is. */
static void finish_rows(void *context, size_t begin, size_t end)
{
    const denoising *d = context;
    const denoise_planes *p = d->planes;
    for (size_t y = begin; y < end; y++)
        for (uint32_t x = 0; x < p->width; x++) {
            float *sum = d->sums + 4 * (y * p->width + x);
            if (is_clean(p, x, (uint32_t)y) || d->film->layers[0].pixels[4 * (y * p->width + x) + 3] == 0.0f)
                sum[3] = 0.0f;
            for (int c = 0; c < 3; c++)
                sum[c] = sum[3] > 0.0f ? sum[c] / sum[3] * p->scale : 0.0f;
        }
}

static void write_pixel(const denoising *d, uint32_t x, uint32_t y)
{
    const denoise_planes *p = d->planes;
    size_t i = (size_t)y * p->width + x, o = denoise_index(p, (ptrdiff_t)x, (ptrdiff_t)y);
    const float *filtered = d->sums + 4 * i;
    float *pixel = d->film->layers[0].pixels + 4 * i;
    for (int c = 0; c < 3; c++) {
        float divisor = denoise_divisor(p->albedo[c][o]);
        float before = p->light[c][o] * divisor * p->scale;
        if (filtered[3] > 0.0f)
            pixel[c] = within_noise(filtered[c], before, sqrtf(p->noise[c][o]) * divisor * p->scale);
        else if (!isfinite(pixel[c]))
            pixel[c] = before;
    }
    if (!isfinite(pixel[3]))
        pixel[3] = p->opacity[o];
}

static void write_rows(void *context, size_t begin, size_t end)
{
    const denoising *d = context;
    for (size_t y = begin; y < end; y++)
        for (uint32_t x = 0; x < d->film->width; x++)
            write_pixel(d, x, (uint32_t)y);
}

facet_result film_denoise(film *f, const facet_allocator *allocator, uint32_t thread_count,
                          facet_error *error)
{
    static const char *const guides[] = {"albedo", "normal", "variance"};
    for (size_t k = 0; k < sizeof guides / sizeof *guides; k++)
        if (!film_find(f, guides[k]))
            return fail(error, FACET_ERROR_ARGUMENT, "denoising: the film has no layer \"%s\"", guides[k]);
    denoise_planes planes = {0};
    size_t pixel_count = (size_t)f->width * f->height;
    float *sums = mem_zalloc(allocator, pixel_count, 4 * sizeof *sums);
    facet_result result = sums ? denoise_planes_create(f, allocator, thread_count, &planes, error)
                               : fail_memory(error, "sums of the denoiser", pixel_count * 4 * sizeof *sums);
    if (result != FACET_OK)
        goto done;
    denoising d = {.planes = &planes,
                   .film = f,
                   .sums = sums,
                   .tiles_x = (f->width + TILE - 1) / TILE,
                   .tiles_y = (f->height + TILE - 1) / TILE};
    size_t tile_count = (size_t)((d.tiles_x + 1) / 2) * ((d.tiles_y + 1) / 2);
    for (d.phase = 0; d.phase < PHASES; d.phase++)
        parallel_for(thread_count, tile_count, 1, filter_tiles, &d);
    parallel_for(thread_count, f->height, TILE, finish_rows, &d);
    result = restore_energy(f, sums, allocator, thread_count, error);
    if (result == FACET_OK)
        parallel_for(thread_count, f->height, TILE, write_rows, &d);
done:
    denoise_planes_destroy(&planes);
    mem_free(sums);
    return result;
}
