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
               "the shader library numbers filters as the interface does");

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

static bool is_finite(const path_sample *s)
{
    bool is = isfinite(s->opacity) && isfinite(s->filter_excess);
    for (int c = 0; c < 3; c++)
        is = is && isfinite(s->radiance[c]) && isfinite(s->albedo[c]) && isfinite(s->normal[c]) &&
             isfinite(s->ground_lit[c]) && isfinite(s->ground_open[c]);
    return is;
}

void path_film_add(path_film *f, size_t pixel, const path_sample *sample)
{
    static const path_sample black = {0};
    path_pixel *p = &f->pixels[pixel];
    if (p->samples >= PATH_FILM_MAX_SAMPLES)
        return;
    if (!is_finite(sample)) {
        atomic_fetch_add_explicit(&f->dropped, 1, memory_order_relaxed);
        sample = &black;
    }
    path_pixel_add(p, f->ground ? &f->ground[pixel] : NULL, sample);
}

uint32_t path_film_samples(const path_film *f, size_t pixel)
{
    return f->pixels[pixel].samples;
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

void path_film_set_dropped(path_film *f, uint64_t count)
{
    atomic_store(&f->dropped, count);
}

/* ---- means to layers ---- */

float path_pixel_scale(const path_pixel *p)
{
    float weight = 1.0f + (float)path_pixel_share(p, p->filter_excess);
    return fabsf(weight) > 0.25f ? 1.0f / weight : 1.0f; /* the weights of a few samples may nearly cancel */
}

float path_film_share(const path_film *f, size_t pixel)
{
    const path_pixel *p = &f->pixels[pixel];
    return p->samples ? path_pixel_scale(p) / (float)p->samples : 0.0f;
}

typedef struct resolving {
    const path_film *film;
    float scale;
    float *color, *albedo, *normal, *variance, *samples; /* NULL: not requested */
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
        out[c] = shade_f_clamp(path_pixel_mean(p, c) * (r->scale * scale), -FLT_MAX, FLT_MAX);
    out[3] = shade_f_clamp(path_pixel_mean(p, 3) * scale, 0.0f, 1.0f);
    if (r->film->ground) { /* black below the model: no premultiplied color */
        const path_ground *g = &r->film->ground[i];
        out[3] += path_ground_share(g, p) * path_ground_opacity(g);
        out[3] = out[3] < 1.0f ? out[3] : 1.0f;
    }
}

/* The variance of the mean: that of one sample, estimated without bias (n / (n - 1)), divided by their
 * number. Stratified samples have better means. The error of a single sample is taken to be its value. */
static float resolve_variance(const path_pixel *p, int c, float scale)
{
    double mean = (double)path_pixel_mean(p, c);
    double square = p->samples > 1 ? path_pixel_spread(p, c) / ((double)p->samples - 1.0) : mean * mean;
    square *= (double)scale * (double)scale;
    return (float)(square < (double)FLT_MAX ? square : (double)FLT_MAX);
}

static void resolve_normal(const path_pixel *p, float out[3])
{
    double square = 0.0, mean[3];
    for (int c = 0; c < 3; c++) {
        mean[c] = path_pixel_share(p, p->normal[c]);
        square += mean[c] * mean[c];
    }
    double scale = square > 1e-12 ? 1.0 / sqrt(square) : 0.0; /* opposite normals cancel */
    for (int c = 0; c < 3; c++)
        out[c] = (float)(mean[c] * scale);
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
            r->samples[i] = (float)p->samples;
        for (size_t c = 0; c < 3; c++) {
            if (r->albedo)
                r->albedo[3 * i + c] = (float)path_pixel_share(p, p->albedo[c]);
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

/* ---- adaptive sampling: the noise of a pixel ---- */

/* Depends on the samples alone, not on earlier decisions, so that an interrupted render continues as one
 * that was not. */

/* The displayed size of a standard error. A display shows roughly the square root v^(1/2) of linear light
 * v, 1 being white, whose slope is 1 / (2 v^(1/2)): the normalisation of Dammertz et al. 2010 ("A
 * Hierarchical Automatic Stopping Condition for Monte Carlo Global Illumination", equation 1). The offset
 * keeps black from requiring infinitely many samples; with it the slope ends at 10, near the 12.9 of the
 * sRGB curve at 0. */
static double displayed(double error, double value)
{
    return error / (2.0 * sqrt((value > 0.0 ? value : 0.0) + 0.0025));
}

/* The square of the standard error as displayed, where 1 is the range of the display. The errors of the
 * channels are added with the weights of luminance as if fully correlated, as those of light mostly are,
 * so that colored noise of even luminance counts. The shadow on the ground is judged over white. */
static double pixel_noise_square(const path_film *f, size_t i)
{
    static const double weights[3] = {0.2126, 0.7152, 0.0722};
    const path_pixel *p = &f->pixels[i];
    double error = 0.0, value = 0.0;
    for (int c = 0; c < 3; c++) {
        error += weights[c] * sqrt(path_pixel_spread(p, c) / ((double)p->samples - 1.0));
        value += weights[c] * (double)path_pixel_mean(p, c);
    }
    double noise = displayed(error * (double)f->scale, value * (double)f->scale);
    double square = noise * noise;
    if (f->ground) {
        const path_ground *g = &f->ground[i];
        double share = (double)path_ground_share(g, p);
        double shadow =
            displayed(share * (double)path_ground_error(g),
                      1.0 - (double)path_pixel_mean(p, 3) - share * (double)path_ground_opacity(g));
        square += shadow * shadow;
    }
    return square < 1e30 ? square : 1e30;
}

/* ---- adaptive sampling: blocks ---- */

typedef struct judging {
    path_film *film;
    float noise;
} judging;

/* The mean square over a block; infinite while a pixel of it has too few samples. */
static float block_noise_square(const path_film *f, uint32_t column, uint32_t row)
{
    uint32_t x_end = (column + 1) * PATH_FILM_BLOCK, y_end = (row + 1) * PATH_FILM_BLOCK;
    x_end = x_end < f->width ? x_end : f->width;
    y_end = y_end < f->height ? y_end : f->height;
    double sum = 0.0;
    uint32_t count = 0;
    for (uint32_t y = row * PATH_FILM_BLOCK; y < y_end; y++)
        for (uint32_t x = column * PATH_FILM_BLOCK; x < x_end; x++, count++) {
            size_t i = (size_t)y * f->width + x;
            if (f->pixels[i].samples < PATH_FILM_MIN_SAMPLES)
                return INFINITY;
            sum += pixel_noise_square(f, i);
        }
    return (float)(sum / count);
}

static void measure_blocks(void *context, size_t begin, size_t end)
{
    const judging *j = context;
    uint32_t columns = j->film->block_columns;
    for (size_t b = begin; b < end; b++)
        j->film->block_noise[b] =
            block_noise_square(j->film, (uint32_t)(b % columns), (uint32_t)(b / columns));
}

/* The mean square over a block and its neighbors: rare light that few samples of one block have missed may
 * be found by a neighbor. */
static float region_noise_square(const path_film *f, uint32_t column, uint32_t row)
{
    uint32_t left = column ? column - 1 : 0, right = column + 1 < f->block_columns ? column + 1 : column;
    uint32_t top = row ? row - 1 : 0, bottom = row + 1 < f->block_rows ? row + 1 : row;
    float sum = 0.0f, count = 0.0f;
    for (uint32_t y = top; y <= bottom; y++)
        for (uint32_t x = left; x <= right; x++, count += 1.0f)
            sum += f->block_noise[(size_t)y * f->block_columns + x];
    return sum / count;
}

static void judge_blocks(void *context, size_t begin, size_t end)
{
    const judging *j = context;
    path_film *f = j->film;
    float limit = j->noise * j->noise;
    for (size_t b = begin; b < end; b++) {
        uint32_t column = (uint32_t)(b % f->block_columns), row = (uint32_t)(b / f->block_columns);
        f->block_is_done[b] = f->block_noise[b] <= limit && region_noise_square(f, column, row) <= limit;
    }
}

static float share_done(const path_film *f)
{
    uint64_t done = 0;
    for (uint32_t row = 0; row < f->block_rows; row++)
        for (uint32_t column = 0; column < f->block_columns; column++) {
            if (!f->block_is_done[(size_t)row * f->block_columns + column])
                continue;
            uint32_t width = f->width - column * PATH_FILM_BLOCK, height = f->height - row * PATH_FILM_BLOCK;
            done += (uint64_t)(width < PATH_FILM_BLOCK ? width : PATH_FILM_BLOCK) *
                    (height < PATH_FILM_BLOCK ? height : PATH_FILM_BLOCK);
        }
    return (float)((double)done / ((double)f->width * f->height));
}

void path_film_set_scale(path_film *f, float scale)
{
    f->scale = scale;
}

void path_film_update(path_film *f, float noise, uint32_t thread_count)
{
    judging j = {.film = f, .noise = noise};
    size_t count = (size_t)f->block_columns * f->block_rows;
    if (noise > 0.0f) {
        parallel_for(thread_count, count, 16, measure_blocks, &j);
        parallel_for(thread_count, count, 256, judge_blocks, &j);
    } else {
        for (size_t b = 0; b < count; b++)
            f->block_is_done[b] = false;
    }
    f->share_done = share_done(f);
}

bool path_film_needs_more(const path_film *f, size_t pixel)
{
    size_t column = pixel % f->width / PATH_FILM_BLOCK, row = pixel / f->width / PATH_FILM_BLOCK;
    return !f->block_is_done[row * f->block_columns + column];
}

float path_film_share_done(const path_film *f)
{
    return f->share_done;
}
