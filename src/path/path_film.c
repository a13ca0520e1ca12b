/* path_film.c - see path_film.h: samples to means, and means to layers. */
#include "path/path_film_state.h"

#include <float.h>
#include <math.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"

#include "shade/shade.h"

_Static_assert(PIXEL_FILTER_BLACKMAN_HARRIS == (int)FACET_FILTER_BLACKMAN_HARRIS &&
                   PIXEL_FILTER_BOX == (int)FACET_FILTER_BOX &&
                   PIXEL_FILTER_MITCHELL == (int)FACET_FILTER_MITCHELL,
               "the shared text numbers filters as the interface does");

enum { GRAIN = 4096 }; /* pixels: about 0.1 ms */

facet_result path_film_create(const facet_allocator *allocator, uint32_t width, uint32_t height,
                              bool has_ground, path_film **out, facet_error *error)
{
    size_t count = (size_t)width * height;
    uint32_t columns = (width + PATH_FILM_BLOCK - 1) / PATH_FILM_BLOCK;
    uint32_t rows = (height + PATH_FILM_BLOCK - 1) / PATH_FILM_BLOCK;
    path_film *f = mem_zalloc(allocator, 1, sizeof *f);
    *out = NULL;
    if (!f)
        return fail_memory(error, "light samples", sizeof *f);
    *f = (path_film){.allocator = allocator ? *allocator : (facet_allocator){0},
                     .width = width,
                     .height = height,
                     .block_columns = columns,
                     .block_rows = rows,
                     .scale = 1.0f};
    f->pixels = mem_zalloc(allocator, count, sizeof *f->pixels);
    f->ground = has_ground ? mem_zalloc(allocator, count, sizeof *f->ground) : NULL;
    f->block_noise = mem_zalloc(allocator, (size_t)columns * rows, sizeof *f->block_noise);
    f->block_is_done = mem_zalloc(allocator, (size_t)columns * rows, sizeof *f->block_is_done);
    if (!f->pixels || (has_ground && !f->ground) || !f->block_noise || !f->block_is_done) {
        path_film_destroy(f);
        return fail_memory(error, "light samples",
                           count * (sizeof *f->pixels + (has_ground ? sizeof *f->ground : 0)));
    }
    *out = f;
    return FACET_OK;
}

void path_film_destroy(path_film *f)
{
    if (!f)
        return;
    mem_free(f->pixels);
    mem_free(f->ground);
    mem_free(f->block_noise);
    mem_free(f->block_is_done);
    mem_free(f);
}

/* ---- samples to means ---- */

static float luminance_of(const float color[3])
{
    return luminance(vec3(color[0], color[1], color[2]));
}

static bool is_finite(const path_sample *s)
{
    bool is = isfinite(s->opacity) && isfinite(s->filter_excess);
    for (int c = 0; c < 3; c++)
        is = is && isfinite(s->radiance[c]) && isfinite(s->albedo[c]) && isfinite(s->normal[c]) &&
             isfinite(s->ground_lit[c]) && isfinite(s->ground_open[c]);
    return is;
}

/* The mean square distance after one more sample, by how far it is from the mean before it and from the one with it
 * (Welford 1962): nothing cancels, however bright what hardly changes is. share: 1 / n. */
static float spread_with(float spread, double from_before, double from_after, double share)
{
    double square = from_before * from_after;
    square = square < (double)FLT_MAX ? square : (double)FLT_MAX;
    return (float)((double)spread + (square - (double)spread) * share);
}

static float mean_with(float mean, double value, double share)
{
    return (float)((double)mean + (value - (double)mean) * share);
}

/* Channel c of the color. */
static void add_color(path_pixel *p, int c, double value, double share)
{
    double before = (double)p->mean[c] + (double)p->rest[c];
    double after = before + (value - before) * share;
    p->mean[c] = (float)after;
    p->rest[c] = (float)(after - (double)p->mean[c]);
    if (c < 3)
        p->spread[c] = spread_with(p->spread[c], value - before, value - after, share);
}

static void add_ground(path_ground *g, const path_sample *s)
{
    bool is_there = false;
    for (int c = 0; c < 3; c++)
        is_there = is_there || s->ground_lit[c] != 0.0f || s->ground_open[c] != 0.0f;
    if (!is_there)
        return;
    double open = (double)luminance_of(s->ground_open);
    double taken = open - (double)luminance_of(s->ground_lit);
    double share = 1.0 / (double)(g->samples += 1.0f);
    double distance = taken - (double)g->taken;
    g->open = mean_with(g->open, open, share);
    g->taken = mean_with(g->taken, taken, share);
    g->spread = spread_with(g->spread, distance, distance * (1.0 - share), share);
}

void path_film_add(path_film *f, size_t pixel, const path_sample *sample)
{
    static const path_sample black = {0};
    path_pixel *p = &f->pixels[pixel];
    if (p->samples >= (float)PATH_FILM_MOST_SAMPLES)
        return;
    if (!is_finite(sample)) {
        atomic_fetch_add_explicit(&f->dropped, 1, memory_order_relaxed);
        sample = &black;
    }
    double share = 1.0 / (double)(p->samples += 1.0f);
    for (int c = 0; c < 3; c++) {
        add_color(p, c, (double)sample->radiance[c], share);
        p->albedo[c] = mean_with(p->albedo[c], (double)sample->albedo[c], share);
        p->normal[c] = mean_with(p->normal[c], (double)sample->normal[c], share);
    }
    add_color(p, 3, (double)sample->opacity, share);
    p->filter_excess = mean_with(p->filter_excess, (double)sample->filter_excess, share);
    if (f->ground)
        add_ground(&f->ground[pixel], sample);
}

uint32_t path_film_samples(const path_film *f, size_t pixel)
{
    return (uint32_t)f->pixels[pixel].samples;
}

uint64_t path_film_total_samples(const path_film *f)
{
    uint64_t total = 0;
    for (size_t i = 0; i < (size_t)f->width * f->height; i++)
        total += path_film_samples(f, i);
    return total;
}

uint64_t path_film_dropped(const path_film *f)
{
    return atomic_load(&f->dropped);
}

/* ---- the ground ---- */

/* The standard error of what is taken. One sample says nothing of it. */
static double taken_error(const path_ground *g)
{
    return g->samples > 1.0f ? (sqrt)((double)g->spread / ((double)g->samples - 1.0)) : 0.0;
}

float path_ground_error(const path_ground *g)
{
    double error = g->open > 0.0f ? taken_error(g) / (double)g->open : 0.0;
    return (float)(error < 1.0 ? error : 1.0);
}

/* The share of the light that is taken: one minus the ratio of the means (not the mean of ratios) of lit and open. Where
 * nothing is taken but for noise, clamping at 0 would darken by 0.4 standard errors in the mean; so what is taken is
 * first drawn towards 0 by the gain d^2 / (d^2 + e^2) of Wiener's filter, estimated as max(0, 1 - e^2 / d^2) for an
 * observed d with the standard error e, which leaves 0.1 of them and a real shadow as it is: e^2 / d less. */
float path_ground_opacity(const path_ground *g)
{
    double taken = (double)g->taken, error = taken_error(g);
    if (!(taken > error && g->open > 0.0f))
        return 0.0f;
    taken -= error * error / taken;
    return (float)(taken < (double)g->open ? taken / (double)g->open : 1.0);
}

float path_ground_share(const path_ground *g, const path_pixel *p)
{
    float share = p->samples > 0.0f ? (float)((double)g->samples / (double)p->samples) : 0.0f;
    float left = 1.0f - shade_f_clamp(p->mean[3] * path_pixel_scale(p), 0.0f, 1.0f);
    return share < left ? share : left;
}

/* ---- means to layers ---- */

float path_pixel_scale(const path_pixel *p)
{
    float weight = 1.0f + p->filter_excess;
    return fabsf(weight) > 0.25f ? 1.0f / weight : 1.0f; /* a few samples may all but cancel */
}

float path_film_share(const path_film *f, size_t pixel)
{
    const path_pixel *p = &f->pixels[pixel];
    return p->samples > 0.0f ? path_pixel_scale(p) / p->samples : 0.0f;
}

typedef struct resolving {
    const path_film *film;
    float scale;
    float *color, *albedo, *normal, *variance, *samples; /* NULL: not asked for */
} resolving;

static float *pixels_of(film *target, const char *name)
{
    film_layer *layer = film_find(target, name);
    return layer ? layer->pixels : NULL;
}

static void resolve_color(const resolving *r, size_t i, float out[4])
{
    const path_pixel *p = &r->film->pixels[i];
    float scale = path_pixel_scale(p);
    for (int c = 0; c < 3; c++)
        out[c] = shade_f_clamp(p->mean[c] * (r->scale * scale), -FLT_MAX, FLT_MAX);
    out[3] = shade_f_clamp(p->mean[3] * scale, 0.0f, 1.0f);
    if (r->film->ground) { /* black under the model, so its premultiplied color is none */
        const path_ground *g = &r->film->ground[i];
        out[3] += path_ground_share(g, p) * path_ground_opacity(g);
        out[3] = out[3] < 1.0f ? out[3] : 1.0f;
    }
}

/* The variance of the mean: of one sample, estimated without bias (n / (n - 1)), by their number. Samples that fill the
 * pixel evenly make better means than this says. One sample alone is taken to be as far off as it is large. */
static float resolve_variance(const path_pixel *p, int c, float scale)
{
    double square = p->samples > 1.0f ? (double)p->spread[c] / ((double)p->samples - 1.0)
                                      : (double)p->mean[c] * (double)p->mean[c];
    square *= (double)scale * (double)scale;
    return (float)(square < (double)FLT_MAX ? square : (double)FLT_MAX);
}

static void resolve_normal(const path_pixel *p, float out[3])
{
    double square = 0.0;
    for (int c = 0; c < 3; c++)
        square += (double)p->normal[c] * (double)p->normal[c];
    double scale = square > 1e-12 ? 1.0 / (sqrt)(square) : 0.0; /* opposite normals: none */
    for (int c = 0; c < 3; c++)
        out[c] = (float)((double)p->normal[c] * scale);
}

static void resolve_pixels(void *context, size_t begin, size_t end)
{
    const resolving *r = context;
    for (size_t i = begin; i < end; i++) {
        const path_pixel *p = &r->film->pixels[i];
        if (r->color)
            resolve_color(r, i, r->color + 4 * i);
        if (r->normal)
            resolve_normal(p, r->normal + 3 * i);
        if (r->samples)
            r->samples[i] = p->samples;
        for (size_t c = 0; c < 3; c++) {
            if (r->albedo)
                r->albedo[3 * i + c] = p->albedo[c];
            if (r->variance)
                r->variance[3 * i + c] = resolve_variance(p, (int)c, r->scale * path_pixel_scale(p));
        }
    }
}

void path_film_resolve(const path_film *f, float scale, film *target, uint32_t thread_count)
{
    resolving r = {.film = f,
                   .scale = scale,
                   .color = pixels_of(target, ""),
                   .albedo = pixels_of(target, "albedo"),
                   .normal = pixels_of(target, "normal"),
                   .variance = pixels_of(target, "variance"),
                   .samples = pixels_of(target, "samples")};
    parallel_for(thread_count, (size_t)f->width * f->height, GRAIN, resolve_pixels, &r);
}
