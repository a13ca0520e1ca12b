/* water_render.c - see water_render.h: tiles, pixels, samples. Pixels are independent of each other. */
#include "water/water_render.h"

#include <math.h>
#include <stdatomic.h>

#include "base/clock.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "cpu/surface_layers.h"
#include "draw/camera_rays.h"
#include "draw/render_watch.h"
#include "film/meter.h"

#include "water/water_trace.h"

enum { TILE = 32 };

typedef struct drawing {
    const water_setup *setup;
    uint32_t crop[4]; /* x, y, width, height in the whole image */
    uint32_t tile_columns, tile_count, sample_count;
    float *pattern; /* x, y of each sample in a pixel */
    float *pixels;  /* RGBA */
    matte_layers mattes;
    surface_layers layers;
    bool has_layers; /* any of them */
    render_watch watch;
    _Atomic uint64_t rays;
} drawing;

/* ---- pixels, tiles ---- */

static void draw_pixel(const drawing *p, uint32_t x, uint32_t y)
{
    size_t number = (size_t)(y - p->crop[1]) * p->crop[2] + (x - p->crop[0]);
    const water_pixel pixel = {.x = x,
                               .y = y,
                               .count = p->sample_count,
                               .pattern = p->pattern,
                               .mattes = p->mattes.aovs ? &p->mattes : NULL,
                               .number = number};
    vec3 L = water_pixel_trace(p->setup, &pixel);
    float *rgba = p->pixels + 4 * number;
    for (int i = 0; i < 3; i++)
        rgba[i] = L[i];
    rgba[3] = 1.0f;
    water_description nearest;
    if (p->has_layers && water_pixel_describe(p->setup, x, y, &nearest))
        surface_layers_store(&p->layers, number, nearest.depth_m, &nearest.surface, nearest.identity);
}

static void draw_tile(drawing *p, uint32_t tile)
{
    uint32_t left = tile % p->tile_columns * TILE, top = tile / p->tile_columns * TILE;
    for (uint32_t y = top; y < top + TILE && y < p->crop[3]; y++) {
        for (uint32_t x = left; x < left + TILE && x < p->crop[2]; x++)
            draw_pixel(p, p->crop[0] + x, p->crop[1] + y);
        render_watch_look(&p->watch);
        if (render_watch_is_stopped(&p->watch))
            return;
    }
    atomic_fetch_add(&p->rays, (uint64_t)TILE * TILE * p->sample_count);
}

static void draw_tiles(void *context, size_t begin, size_t end)
{
    drawing *p = context;
    for (size_t tile = begin; tile < end; tile++) {
        if (render_watch_is_stopped(&p->watch))
            return;
        draw_tile(p, (uint32_t)tile);
        render_watch_add(&p->watch, 1);
    }
}

static facet_result draw(const water_setup *s, double deadline_s, film *target, facet_render_stats *stats,
                         facet_error *error)
{
    const facet_render_desc *r = s->desc;
    film_layer *color = film_find(target, "");
    drawing p = {.setup = s,
                 .crop = {r->crop[0], r->crop[1], target->width, target->height},
                 .tile_columns = (target->width + TILE - 1) / TILE,
                 .sample_count = r->samples ? r->samples : 1,
                 .pixels = color->pixels,
                 .mattes = matte_find(target),
                 .layers = surface_layers_find(target),
                 .has_layers = (r->aovs & ~(uint32_t)FACET_AOV_CRYPTOMATTE) != 0};
    p.tile_count = p.tile_columns * ((target->height + TILE - 1) / TILE);
    p.pattern = mem_alloc(&r->allocator, p.sample_count, 2 * sizeof *p.pattern);
    if (!p.pattern)
        return fail_memory(error, "sample pattern", 2 * p.sample_count * sizeof *p.pattern);
    sample_pattern(p.sample_count, p.pattern);
    render_watch_init(&p.watch, &r->progress, "shade", deadline_s, p.tile_count);
    parallel_for(r->thread_count, p.tile_count, 1, draw_tiles, &p);
    mem_free(p.pattern);
    stats->rays += atomic_load(&p.rays);
    return render_watch_explain(&p.watch, error);
}

facet_result water_render(water_cache *cache, const facet_scene *scene, const facet_render_desc *desc,
                          film *target, facet_render_stats *stats, facet_error *error)
{
    double start = clock_seconds();
    double limit_s = desc->time_limit_s, deadline_s = limit_s > 0.0 ? start + limit_s : 0.0;
    *stats = (facet_render_stats){.thread_count = desc->thread_count};
    water_setup setup;
    facet_result result = render_check_limits(desc, "prepare", 0.0, deadline_s, error);
    if (result != FACET_OK)
        return result;
    result = water_setup_create(cache, scene, desc, WATER_SETUP_ALL, &setup, stats, error);
    stats->light_s += clock_seconds() - start;
    double begin = clock_seconds();
    if (result == FACET_OK)
        result = draw(&setup, deadline_s, target, stats, error);
    stats->shade_s = clock_seconds() - begin;
    if (result == FACET_OK)
        result = render_check_limits(desc, "shade", 1.0, 0.0, error);
    water_setup_destroy(&setup);
    stats->total_s = clock_seconds() - start;
    return result;
}

/* ---- the light meter ---- */

static const double DARKEST = 1e-3; /* cd/m^2 */
enum { METER_SIZE = 64 };           /* pixels along the longer edge */

/* The same view, small. */
static facet_render_desc meter_desc(const facet_render_desc *desc)
{
    facet_render_desc d = *desc;
    facet_render_desc *r = &d;
    double longer = r->width > r->height ? r->width : r->height;
    r->width = (uint32_t)ceil(METER_SIZE * r->width / longer);
    r->height = (uint32_t)ceil(METER_SIZE * r->height / longer);
    r->crop[0] = r->crop[1] = 0;
    r->crop[2] = r->width;
    r->crop[3] = r->height;
    r->samples = 1;
    r->quality = FACET_QUALITY_DRAFT;
    r->exposure_ev = 0.0f;
    r->aovs = 0;
    r->progress = (facet_progress){0};
    d.sea_shading = (facet_sea_shading){.omits_glints = true};
    return d;
}

facet_result water_meter(water_cache *cache, const facet_render_desc *desc, double *ev100, facet_error *error)
{
    const facet_render_desc d = meter_desc(desc);
    facet_render_stats stats;
    film f = {0};
    *ev100 = 0.0;
    facet_result result = film_create(&d.allocator, d.width, d.height, 0, &f, error);
    if (result == FACET_OK)
        result = water_render(cache, NULL, &d, &f, &stats, error);
    if (result == FACET_OK) {
        double L = film_log_average(&f, 1e-6);
        if (L < DARKEST)
            log_warning(&d.log, "sea: the scene is nearly dark; set the exposure");
        *ev100 = meter_ev100(fmax(L, DARKEST));
    }
    film_destroy(&f);
    return result;
}
