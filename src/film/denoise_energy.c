/* denoise_energy.c - light that is lost, and where it goes; see denoise_energy.h.
 *
 * Noise of path tracing is skewed: most pixels are a little too dark and few far too bright. Weights that go by likeness leave
 * the bright ones out, and outliers were taken down, so what comes out is nearer to the median than to the mean: too dark
 * by some percent where noise is strong. The mean over a region is known far better than a pixel is, so it is put right there. */
#include "film/denoise_energy.h"

#include <math.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"

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

/* What light has to be multiplied with: 1 + d where the region lacks a share d of its light, shrunk by how likely d is
 * chance (its variance against its square: one bright sample is). */
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

/* Between the middles of blocks factors are interpolated. */
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

facet_result denoise_restore_energy(const film *f, float *filtered, const facet_allocator *allocator,
                                    uint32_t thread_count, facet_error *error)
{
    energy e = {.film = f,
                .variance = film_find((film *)f, "variance")->pixels, /* film_find() changes nothing */
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
