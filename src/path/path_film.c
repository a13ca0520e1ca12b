/* path_film.c - see path_film.h. */
#include "path/path_film.h"

#include <math.h>

#include "base/memory.h"
#include "base/result.h"

typedef struct path_sums {
    double color[4], albedo[3], normal[3], square[3], ground_lit[3], ground_open[3];
    uint32_t samples;
} path_sums;

struct path_film {
    uint32_t width, height;
    uint64_t dropped;
    path_sums *pixels;
};

facet_result path_film_create(const facet_allocator *allocator, uint32_t width, uint32_t height,
                              bool has_ground, path_film **out, facet_error *error)
{
    (void)has_ground;
    *out = mem_zalloc(allocator, 1, sizeof **out);
    if (!*out)
        return fail_memory(error, "film", sizeof **out);
    (*out)->width = width;
    (*out)->height = height;
    (*out)->pixels = mem_zalloc(allocator, (size_t)width * height, sizeof *(*out)->pixels);
    if ((*out)->pixels)
        return FACET_OK;
    path_film_destroy(*out);
    *out = NULL;
    return fail_memory(error, "film", (size_t)width * height * sizeof(path_sums));
}

void path_film_destroy(path_film *f)
{
    if (!f)
        return;
    mem_free(f->pixels);
    mem_free(f);
}

void path_film_add(path_film *f, size_t pixel, const path_sample *sample)
{
    path_sums *p = &f->pixels[pixel];
    p->samples++;
    for (int i = 0; i < 3; i++) {
        p->color[i] += (double)sample->radiance[i];
        p->square[i] += (double)sample->radiance[i] * (double)sample->radiance[i];
        p->albedo[i] += (double)sample->albedo[i];
        p->normal[i] += (double)sample->normal[i];
    }
    p->color[3] += (double)sample->opacity;
}

uint32_t path_film_samples(const path_film *f, size_t pixel)
{
    return f->pixels[pixel].samples;
}

uint64_t path_film_total_samples(const path_film *f)
{
    uint64_t total = 0;
    for (size_t i = 0; i < (size_t)f->width * f->height; i++)
        total += f->pixels[i].samples;
    return total;
}

uint64_t path_film_dropped(const path_film *f)
{
    return f->dropped;
}

void path_film_update(path_film *f, float noise, uint32_t thread_count)
{
    (void)f;
    (void)noise;
    (void)thread_count;
}

bool path_film_needs_more(const path_film *f, size_t pixel)
{
    (void)f;
    (void)pixel;
    return true;
}

float path_film_share_done(const path_film *f)
{
    (void)f;
    return 0.0f;
}

void path_film_resolve(const path_film *f, float scale, film *target, uint32_t thread_count)
{
    (void)thread_count;
    for (size_t i = 0; i < (size_t)f->width * f->height; i++) {
        const path_sums *p = &f->pixels[i];
        double n = p->samples ? (double)p->samples : 1.0;
        for (int c = 0; c < 4; c++)
            target->layers[0].pixels[4 * i + (size_t)c] = (float)(p->color[c] / n) * (c < 3 ? scale : 1.0f);
    }
}

facet_result path_film_save(const path_film *f, const char *key, const char *path, uint32_t thread_count,
                            facet_error *error)
{
    (void)f;
    (void)key;
    (void)thread_count;
    return fail(error, FACET_ERROR_UNSUPPORTED, "%s: checkpoints are not there yet", path);
}

facet_result path_film_load(path_film *f, const char *key, const char *path, bool *exists, facet_error *error)
{
    (void)f;
    (void)key;
    *exists = false;
    return fail(error, FACET_ERROR_UNSUPPORTED, "%s: checkpoints are not there yet", path);
}
