/* denoise_planes.c - from a film to planes of light and its noise; see denoise_planes.h. */
#include "film/denoise_planes.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "film/denoise_noise.h"

enum { ROW_GRAIN = 16 };

typedef struct preparation {
    denoise_planes *planes;
    const float *radiance, *albedo, *normal, *variance; /* layers of the film */
} preparation;

/* ---- the layers, as they are read ---- */

/* x in [least, most], which not a number is not: 0. */
static float bounded(float x, float least, float most)
{
    return x >= most ? most : x > least ? x : x <= least ? least : 0.0f;
}

static bool is_known(const float rgba[4])
{
    return isfinite(rgba[0]) && isfinite(rgba[1]) && isfinite(rgba[2]) && isfinite(rgba[3]);
}

/* The mean of the known pixels around (x, y), 0 where there is none. */
static void mean_around(const preparation *s, uint32_t x, uint32_t y, float out[4])
{
    float count = 0.0f;
    memset(out, 0, 4 * sizeof *out);
    for (uint32_t j = y > 0 ? y - 1 : 0; j <= y + 1 && j < s->planes->height; j++)
        for (uint32_t i = x > 0 ? x - 1 : 0; i <= x + 1 && i < s->planes->width; i++) {
            const float *pixel = s->radiance + 4 * ((size_t)j * s->planes->width + i);
            if (!is_known(pixel))
                continue;
            count += 1.0f;
            for (int c = 0; c < 4; c++)
                out[c] += (pixel[c] - out[c]) / count; /* no sum that could overflow */
        }
}

/* Color relative to scale over albedo; the variance follows. */
static void read_pixel(const preparation *s, uint32_t x, uint32_t y)
{
    const float most = 1e12f; /* times the mean: there are not so many pixels; its square is a number still */
    denoise_planes *p = s->planes;
    size_t i = (size_t)y * p->width + x;
    size_t o = denoise_index(p, (ptrdiff_t)x, (ptrdiff_t)y);
    float mended[4];
    const float *rgba = s->radiance + 4 * i;
    if (!is_known(rgba)) {
        mean_around(s, x, y, mended);
        rgba = mended;
    }
    for (size_t c = 0; c < 3; c++) {
        float albedo = bounded(s->albedo[3 * i + c], 0.0f, 1.0f);
        float to_light = 1.0f / denoise_divisor(albedo);
        float variance = s->variance[3 * i + c] / p->scale / p->scale * to_light * to_light;
        p->albedo[c][o] = albedo;
        p->normal[c][o] = bounded(s->normal[3 * i + c], -1.0f, 1.0f);
        p->light[c][o] = bounded(rgba[c] / p->scale * to_light, -most, most);
        p->noise[c][o] = bounded(variance, 0.0f, most);
    }
    p->opacity[o] = bounded(rgba[3], 0.0f, 1.0f);
}

static void read_rows(void *context, size_t begin, size_t end)
{
    const preparation *s = context;
    for (size_t y = begin; y < end; y++)
        for (uint32_t x = 0; x < s->planes->width; x++)
            read_pixel(s, x, (uint32_t)y);
}

/* The power of two next to the mean of what is finite: nothing that follows sees the unit of the picture. */
static float picture_scale(const film *f)
{
    double sum = 0.0;
    size_t count = (size_t)f->width * f->height;
    for (size_t i = 0; i < 4 * count; i++)
        if (i % 4 < 3 && isfinite(f->layers[0].pixels[i]))
            sum += fabs((double)f->layers[0].pixels[i]);
    int exponent = 0;
    frexp(sum / (3.0 * (double)count), &exponent);
    return ldexpf(1.0f, exponent < -60 ? -60 : exponent > 120 ? 120 : exponent);
}

/* ---- planes ---- */

void denoise_repeat_border(const denoise_planes *p, float *plane)
{
    for (ptrdiff_t y = 0; y < (ptrdiff_t)p->height; y++) {
        float *row = plane + denoise_index(p, -DENOISE_MARGIN, y);
        for (size_t x = 0; x < DENOISE_MARGIN; x++)
            row[x] = row[DENOISE_MARGIN];
        for (size_t x = DENOISE_MARGIN + p->width; x < p->pitch; x++)
            row[x] = row[DENOISE_MARGIN + p->width - 1];
    }
    const float *first = plane + denoise_index(p, -DENOISE_MARGIN, 0);
    const float *last = plane + denoise_index(p, -DENOISE_MARGIN, (ptrdiff_t)p->height - 1);
    for (ptrdiff_t k = 1; k <= DENOISE_MARGIN; k++) {
        memcpy(plane + denoise_index(p, -DENOISE_MARGIN, -k), first, p->pitch * sizeof *plane);
        memcpy(plane + denoise_index(p, -DENOISE_MARGIN, (ptrdiff_t)p->height - 1 + k), last,
               p->pitch * sizeof *plane);
    }
}

facet_result denoise_planes_create(const film *f, const facet_allocator *allocator, uint32_t thread_count,
                                   denoise_planes *out, facet_error *error)
{
    enum { KEPT = 13, PASSING = 2, EXTRA = 8 };
    denoise_planes p = {.width = f->width, .height = f->height, .scale = picture_scale(f)};
    p.pitch = ((size_t)f->width + 2 * DENOISE_MARGIN + EXTRA) / EXTRA * EXTRA;
    size_t plane_size = p.pitch * ((size_t)f->height + 2 * DENOISE_MARGIN);
    p.block = mem_alloc(allocator, plane_size, (KEPT + PASSING) * sizeof(float));
    if (!p.block)
        return fail_memory(error, "planes of the denoiser", plane_size * (KEPT + PASSING) * sizeof(float));
    for (size_t c = 0; c < 3; c++) {
        p.light[c] = p.block + c * plane_size;
        p.noise[c] = p.block + (3 + c) * plane_size;
        p.albedo[c] = p.block + (6 + c) * plane_size;
        p.normal[c] = p.block + (9 + c) * plane_size;
    }
    p.opacity = p.block + 12 * plane_size;
    film *layers = (film *)f; /* film_find() changes nothing */
    preparation s = {.planes = &p,
                     .radiance = f->layers[0].pixels,
                     .albedo = film_find(layers, "albedo")->pixels,
                     .normal = film_find(layers, "normal")->pixels,
                     .variance = film_find(layers, "variance")->pixels};
    parallel_for(thread_count, f->height, ROW_GRAIN, read_rows, &s);
    for (size_t k = 0; k < KEPT; k++)
        denoise_repeat_border(&p, p.block + k * plane_size);
    denoise_find_noise(&p, (float *[2]){p.block + KEPT * plane_size, p.block + (KEPT + 1) * plane_size},
                       thread_count);
    *out = p;
    return FACET_OK;
}

void denoise_planes_destroy(denoise_planes *p)
{
    mem_free(p->block);
    *p = (denoise_planes){0};
}
