/* bake_pyramid.c - the pyramid of bake_sampling.h. */
#include <math.h>

#include "bake/bake_sampling.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"

static const double pi = 3.14159265358979323846;

enum { MAX_BASE = 2048 };

/* ---- means ---- */

typedef struct halving {
    const cube *from, *out;
} halving;

static void halve_rows(void *context, size_t begin, size_t end)
{
    const halving *job = context;
    uint32_t size = job->out->size;
    for (size_t i = begin; i < end; i++) {
        uint32_t face = (uint32_t)(i / size);
        int y = (int)(i % size);
        for (int x = 0; x < (int)size; x++) {
            rgbx sum = {0};
            float whole = 0.0f;
            for (int k = 0; k < 4; k++) {
                int fx = 2 * x + (k & 1);
                int fy = 2 * y + (k >> 1);
                float w = (float)cube_texel_solid_angle(job->from->size, (uint32_t)fx, (uint32_t)fy);
                sum += *cube_texel(job->from, face, fx, fy) * w;
                whole += w;
            }
            *cube_texel(job->out, face, x, y) = sum * (1.0f / whole);
        }
    }
}

void bake_halve(const cube *from, uint32_t thread_count, cube *out)
{
    halving job = {.from = from, .out = out};
    parallel_for(thread_count, 6 * (size_t)out->size, 16, halve_rows, &job);
    cube_fill_borders(out);
}

/* ---- tents ---- */

/* Adds the integral of solid angle against bilinear weights over the square between four texel middles, or the half or quarter
 * of it that is on the face, to the bordered array of a face. */
static void add_square(uint32_t size, int x, int y, double *tents)
{
    static const double node = 0.28867513459481287; /* Gauss and Legendre's, of two in [-1/2, 1/2] */
    int n = (int)size;
    size_t stride = (size_t)size + 2;
    double x0 = x < 0 ? 0.0 : x + 0.5;
    double x1 = x + 1 >= n ? n : x + 1.5;
    double y0 = y < 0 ? 0.0 : y + 0.5;
    double y1 = y + 1 >= n ? n : y + 1.5;
    double *to = tents + (size_t)(y + 1) * stride + (size_t)(x + 1);
    for (int k = 0; k < 4; k++) {
        double px = 0.5 * (x0 + x1) + (k & 1 ? node : -node) * (x1 - x0);
        double py = 0.5 * (y0 + y1) + (k & 2 ? node : -node) * (y1 - y0);
        double s = 2.0 * px / size - 1.0;
        double t = 2.0 * py / size - 1.0;
        double r2 = 1.0 + s * s + t * t;
        double w = 0.25 * (x1 - x0) * (y1 - y0) * 4.0 / ((double)size * size) / (r2 * sqrt(r2));
        double wx = px - 0.5 - x;
        double wy = py - 0.5 - y;
        to[0] += w * (1.0 - wx) * (1.0 - wy);
        to[1] += w * wx * (1.0 - wy);
        to[stride] += w * (1.0 - wx) * wy;
        to[stride + 1] += w * wx * wy;
    }
}

/* All faces are alike, and what a face's lookups take of its border is what
 * those of the face across take of the texels at its own edge. */
static void divide_by_tents(cube *c, double *tents)
{
    int n = (int)c->size;
    size_t stride = (size_t)c->size + 2;
    for (size_t i = 0; i < stride * stride; i++)
        tents[i] = 0.0;
    for (int y = -1; y < n; y++)
        for (int x = -1; x < n; x++)
            add_square(c->size, x, y, tents);
    for (int y = 0; y < n; y++)
        for (int x = 0; x < n; x++) {
            /* borders left, right, above, below, and those at corners, which are means of three texels */
            const double *own = tents + (size_t)(y + 1) * stride + (size_t)(x + 1);
            double tent = *own;
            for (int side = 0; side < 4; side++) {
                bool is_at_x = side & 1 ? x == n - 1 : x == 0;
                bool is_at_y = side & 2 ? y == n - 1 : y == 0;
                const double *across = own + (side & 1 ? 1 : -1);
                const double *over = side & 2 ? own + stride : own - stride;
                if (is_at_x && side < 2)
                    tent += *across;
                if (is_at_y && !(side & 1))
                    tent += *over;
                if (is_at_x && is_at_y)
                    tent += *(over + (side & 1 ? 1 : -1));
            }
            for (uint32_t face = 0; face < 6; face++)
                *cube_texel(c, face, x, y) *= (float)(1.0 / tent);
        }
    cube_fill_borders(c);
}

/* Radiance to sums, not yet over tents. */
static void weigh_base(void *context, size_t begin, size_t end)
{
    const cube *c = context;
    uint32_t size = c->size;
    for (size_t i = begin; i < end; i++)
        for (uint32_t x = 0; x < size; x++) {
            rgbx *texel = cube_texel(c, (uint32_t)(i / size), (int)x, (int)(i % size));
            (*texel)[3] = 1.0f;
            *texel *= (float)cube_texel_solid_angle(size, x, (uint32_t)(i % size));
        }
}

static void spread_rows(void *context, size_t begin, size_t end)
{
    const halving *job = context;
    uint32_t size = job->out->size;
    for (size_t i = begin; i < end; i++) {
        uint32_t face = (uint32_t)(i / size);
        int y = (int)(i % size);
        for (int x = 0; x < (int)size; x++) {
            static const float share[4] = {0.25f, 0.75f, 0.75f, 0.25f};
            rgbx sum = {0};
            for (int k = 0; k < 16; k++)
                sum += *cube_texel(job->from, face, 2 * x - 1 + k % 4, 2 * y - 1 + k / 4) *
                       (share[k % 4] * share[k / 4]);
            *cube_texel(job->out, face, x, y) = sum;
        }
    }
}

facet_result bake_pyramid_create(cube *base, const facet_allocator *allocator, uint32_t thread_count,
                                 bake_pyramid *out, facet_error *error)
{
    bake_pyramid p = {.levels = {*base}, .level_count = 1};
    *base = (cube){0};
    parallel_for(thread_count, 6 * (size_t)p.levels[0].size, 16, weigh_base, &p.levels[0]);
    cube_fill_borders(&p.levels[0]);
    facet_result result = FACET_OK;
    for (uint32_t size = p.levels[0].size / 2; result == FACET_OK && size > 0; size /= 2) {
        cube *level = &p.levels[p.level_count];
        result = cube_create(size, allocator, level, error);
        if (result == FACET_OK) {
            halving job = {.from = &p.levels[p.level_count - 1], .out = level};
            parallel_for(thread_count, 6 * (size_t)size, 16, spread_rows, &job);
            cube_fill_borders(level);
            p.level_count++;
        }
    }
    size_t stride = (size_t)p.levels[0].size + 2;
    double *tents = result == FACET_OK ? mem_alloc(allocator, stride * stride, sizeof *tents) : NULL;
    if (result == FACET_OK && !tents)
        result = fail_memory(error, "cube map", stride * stride * sizeof *tents);
    for (uint32_t i = 0; result == FACET_OK && i < p.level_count; i++)
        divide_by_tents(&p.levels[i], tents);
    mem_free(tents);
    if (result != FACET_OK) {
        bake_pyramid_destroy(&p);
        return result;
    }
    *out = p;
    return FACET_OK;
}

void bake_pyramid_destroy(bake_pyramid *p)
{
    for (uint32_t i = 0; i < p->level_count; i++)
        cube_destroy(&p->levels[i]);
    *p = (bake_pyramid){0};
}

uint32_t bake_pyramid_size(const bake_lobe *lobe, uint32_t sample_count, uint32_t picture_height)
{
    float s2, pdf;
    bake_lobe_sample(lobe, 1, &s2, &pdf);
    double most =
        lobe->kind == FACET_LOBE_CHARLIE ? (double)pdf * 2.0 : 1.0 / (4.0 * pi * lobe->alpha * lobe->alpha);
    double solid_angle = 4.0 / (sample_count * most);
    double wanted = sqrt(4.0 * pi / (6.0 * solid_angle));
    uint32_t size = 1;
    while (size < MAX_BASE && size < wanted && size < 2 * picture_height)
        size *= 2;
    return size;
}
