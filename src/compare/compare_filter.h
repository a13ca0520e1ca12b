/* compare_filter.h - tiles of an image with the pixels around them, and convolution of planes of floats with
 * symmetric kernels along one axis. Filters work on an image in tiles, so that memory does not grow with the
 * image and a tile stays in a core's cache. Results are written in multiples of 32 floats; those behind the
 * last pixel are undefined. */
#ifndef COMPARE_COMPARE_FILTER_H
#define COMPARE_COMPARE_FILTER_H

#include <stddef.h>
#include <stdint.h>

#include "base/simd.h"
#include "compare/compare_source.h"

/* ---- tiles ---- */

enum {
    TILE_WIDTH = 128, /* a multiple of FILTER_LANES */
    TILE_HEIGHT = 64,
    TILE_GRAIN = 4 /* tiles per block of scratch memory */
};

typedef struct compare_tile {
    uint32_t x, y, width, height; /* in the crop; at most TILE_WIDTH x TILE_HEIGHT */
} compare_tile;

static inline size_t compare_tile_count(const compare_source *s)
{
    return (size_t)((s->width - 1) / TILE_WIDTH + 1) * ((s->height - 1) / TILE_HEIGHT + 1);
}

static inline compare_tile compare_tile_at(const compare_source *s, size_t index)
{
    const uint32_t columns = (s->width - 1) / TILE_WIDTH + 1;
    compare_tile t = {.x = (uint32_t)(index % columns) * TILE_WIDTH,
                      .y = (uint32_t)(index / columns) * TILE_HEIGHT};
    t.width = s->width - t.x < TILE_WIDTH ? s->width - t.x : TILE_WIDTH;
    t.height = s->height - t.y < TILE_HEIGHT ? s->height - t.y : TILE_HEIGHT;
    return t;
}

/* ---- convolution ---- */

enum { FILTER_LANES = 32 };

typedef float filter_vector __attribute__((vector_size(32), may_alias, aligned(4)));

/* out[i] = k[0] in[i] + sum over j from 1 to radius of k[j] (in[i + j step] + in[i - j step]); is_odd: of the
 * difference of these two. The four vectors stay in registers. */
static inline __attribute__((always_inline)) void filter_line(const float *in, ptrdiff_t step, const float *k,
                                                              int radius, bool is_odd, float *out,
                                                              uint32_t count)
{
    for (uint32_t i = 0; i < count; i += FILTER_LANES) {
        const filter_vector *middle = (const filter_vector *)(in + i);
        filter_vector s0 = middle[0] * k[0], s1 = middle[1] * k[0], s2 = middle[2] * k[0],
                      s3 = middle[3] * k[0];
        for (int j = 1; j <= radius; j++) {
            const filter_vector *after = (const filter_vector *)(in + i + j * step);
            const filter_vector *before = (const filter_vector *)(in + i - j * step);
            const float weight = k[j];
            s0 += (is_odd ? after[0] - before[0] : after[0] + before[0]) * weight;
            s1 += (is_odd ? after[1] - before[1] : after[1] + before[1]) * weight;
            s2 += (is_odd ? after[2] - before[2] : after[2] + before[2]) * weight;
            s3 += (is_odd ? after[3] - before[3] : after[3] + before[3]) * weight;
        }
        filter_vector *to = (filter_vector *)(out + i);
        to[0] = s0;
        to[1] = s1;
        to[2] = s2;
        to[3] = s3;
    }
}

typedef double filter_pair __attribute__((vector_size(32), may_alias, aligned(8)));

/* The same in double for an even kernel, in multiples of 16. */
static inline __attribute__((always_inline)) void
filter_line_double(const double *in, ptrdiff_t step, const double *k, int radius, double *out, uint32_t count)
{
    for (uint32_t i = 0; i < count; i += FILTER_LANES / 2) {
        const filter_pair *middle = (const filter_pair *)(in + i);
        filter_pair s0 = middle[0] * k[0], s1 = middle[1] * k[0], s2 = middle[2] * k[0],
                    s3 = middle[3] * k[0];
        for (int j = 1; j <= radius; j++) {
            const filter_pair *after = (const filter_pair *)(in + i + j * step);
            const filter_pair *before = (const filter_pair *)(in + i - j * step);
            const double weight = k[j];
            s0 += (after[0] + before[0]) * weight;
            s1 += (after[1] + before[1]) * weight;
            s2 += (after[2] + before[2]) * weight;
            s3 += (after[3] + before[3]) * weight;
        }
        filter_pair *to = (filter_pair *)(out + i);
        to[0] = s0;
        to[1] = s1;
        to[2] = s2;
        to[3] = s3;
    }
}

#endif
