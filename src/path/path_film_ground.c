/* path_film_ground.c - the shadow on the ground in a film (path_film.h): its opacity and error, and the
 * filter that denoises it. */
#include "path/path_film_state.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"

#include "shade/shade.h"

/* ---- opacity ---- */

/* The standard error of the blocked light; 0 for a single sample. */
static double blocked_error(const path_ground *g)
{
    return g->samples > 1 ? sqrt(path_ground_spread(g) / ((double)g->samples - 1.0)) : 0.0;
}

float path_ground_error(const path_ground *g)
{
    double open = path_ground_open(g);
    double error = open > 0.0 ? blocked_error(g) / open : 0.0;
    return (float)(error < 1.0 ? error : 1.0);
}

/* The blocked share of the light: one minus the ratio of the means (not the mean of ratios) of lit and
 * open. Clamping pure noise at 0 would darken by 0.4 standard errors on average; so the blocked light is
 * first shrunk by the Wiener gain d^2 / (d^2 + e^2), estimated as max(0, 1 - e^2 / d^2) for an observed d
 * with the standard error e, which leaves 0.1 of them, and reduces a real shadow by e^2 / d only. */
float path_ground_opacity(const path_ground *g)
{
    double blocked = path_ground_blocked(g), open = path_ground_open(g), error = blocked_error(g);
    if (!(blocked > error && open > 0.0))
        return 0.0f;
    blocked -= error * error / blocked;
    return (float)(blocked < open ? blocked / open : 1.0);
}

float path_ground_share(const path_ground *g, const path_pixel *p)
{
    float share = p->samples ? (float)((double)g->samples / (double)p->samples) : 0.0f;
    float transmittance = 1.0f - shade_f_clamp(path_pixel_mean(p, 3) * path_pixel_scale(p), 0.0f, 1.0f);
    return share < transmittance ? share : transmittance;
}

/* ---- filter ---- */

enum { LEVELS = 4, GRAIN_ROWS = 8 };

/* The shadow in a pixel. */
typedef struct shadow {
    float blocked;  /* share of the light, not clamped to [0, 1], so that its noise averages out */
    float variance; /* of that */
    float weight;   /* samples of the ground; 0: not visible */
} shadow;

typedef struct filtering {
    uint32_t width, height, step;
    const shadow *from;
    shadow *to;
} filtering;

static float square(float x)
{
    return x * x;
}

/* One level of the a-trous wavelet: 5 x 5 taps of a B3 spline, step pixels apart; taps that differ by more
 * than the noise weigh less. Dammertz et al. 2010; range weight by variance after Schied et al. 2017. */
static shadow filter_pixel(const filtering *f, uint32_t x, uint32_t y)
{
    static const float spline[3] = {0.375f, 0.25f, 0.0625f};
    const shadow *here = &f->from[(size_t)y * f->width + x];
    float sum = 0.0f;
    float blocked = 0.0f;
    float variance = 0.0f;
    for (int dy = -2; dy <= 2; dy++)
        for (int dx = -2; dx <= 2; dx++) {
            int64_t px = (int64_t)x + dx * (int64_t)f->step;
            int64_t py = (int64_t)y + dy * (int64_t)f->step;
            if (px < 0 || py < 0 || px >= f->width || py >= f->height)
                continue;
            const shadow *there = &f->from[(size_t)py * f->width + (size_t)px];
            float noise = here->variance + there->variance;
            float difference = square(here->blocked - there->blocked);
            float w = spline[abs(dx)] * spline[abs(dy)] * there->weight *
                      expf(-0.25f * difference / (noise + 1e-6f));
            sum += w;
            blocked += w * there->blocked;
            variance += w * w * there->variance;
        }
    if (!(sum > 0.0f))
        return *here;
    return (shadow){.blocked = blocked / sum, .variance = variance / square(sum), .weight = here->weight};
}

static void filter_rows(void *context, size_t begin, size_t end)
{
    const filtering *f = context;
    for (size_t y = begin; y < end; y++)
        for (uint32_t x = 0; x < f->width; x++) {
            size_t i = y * f->width + x;
            f->to[i] = f->from[i].weight > 0.0f ? filter_pixel(f, x, (uint32_t)y) : f->from[i];
        }
}

/* A single sample has no variance estimate: it gets the largest that a shadow can have. */
static shadow shadow_of(const path_ground *g)
{
    double open = path_ground_open(g), n = (double)g->samples;
    if (!(open > 0.0))
        return (shadow){.weight = 0.0f};
    float variance = n > 1.0 ? (float)(path_ground_spread(g) / (n - 1.0) / (open * open)) : 0.25f;
    return (shadow){.blocked = (float)(path_ground_blocked(g) / open),
                    .variance = fminf(variance, 1.0f),
                    .weight = (float)g->samples};
}

facet_result path_film_denoise_ground(path_film *f, uint32_t thread_count, facet_error *error)
{
    size_t count = (size_t)f->width * f->height;
    if (!f->ground)
        return FACET_OK;
    shadow *buffers[2] = {mem_alloc(&f->allocator, count, sizeof(shadow)),
                          mem_alloc(&f->allocator, count, sizeof(shadow))};
    if (!buffers[0] || !buffers[1]) {
        mem_free(buffers[0]);
        mem_free(buffers[1]);
        return fail_memory(error, "the shadow on the ground", 2 * count * sizeof(shadow));
    }
    for (size_t i = 0; i < count; i++)
        buffers[0][i] = shadow_of(&f->ground[i]);
    for (uint32_t level = 0; level < LEVELS; level++) {
        filtering pass = {.width = f->width,
                          .height = f->height,
                          .step = 1u << level,
                          .from = buffers[level % 2],
                          .to = buffers[(level + 1) % 2]};
        parallel_for(thread_count, f->height, GRAIN_ROWS, filter_rows, &pass);
    }
    const shadow *filtered = buffers[LEVELS % 2];
    for (size_t i = 0; i < count; i++) {
        path_ground *g = &f->ground[i];
        if (!(filtered[i].weight > 0.0f))
            continue;
        double open = path_ground_open(g);
        path_ground_set_blocked(g, (double)filtered[i].blocked * open,
                                (double)filtered[i].variance * open * open *
                                    fmax((double)g->samples - 1.0, 0.0));
    }
    mem_free(buffers[0]);
    mem_free(buffers[1]);
    return FACET_OK;
}
