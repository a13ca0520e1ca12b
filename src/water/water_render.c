/* water_render.c - see water_render.h: tiles, pixels, samples. What a pixel shows depends on nothing but itself. */
#include "water/water_render.h"

#include <math.h>
#include <stdatomic.h>

#include "base/clock.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "draw/render_watch.h"
#include "draw/sample_pattern.h"

#include "water/water_below.h"
#include "water/water_look.h"

enum { TILE = 32 };
static const double FAR_M = 1e7;

typedef struct picture {
    const water_setup *setup;
    uint32_t crop[4]; /* x, y, width, height in the whole picture */
    uint32_t tile_columns, tile_count, sample_count;
    float *pattern; /* x, y of each sample in a pixel */
    float *pixels;  /* RGBA */
    render_watch watch;
    _Atomic uint64_t rays;
} picture;

/* ---- one sample ---- */

static march_ray camera_ray(const water_setup *s, float x, float y)
{
    float o[3], d[3];
    camera_rays_at(&s->camera, x, y, o, d);
    double length =
        (sqrt)((double)d[0] * (double)d[0] + (double)d[1] * (double)d[1] + (double)d[2] * (double)d[2]);
    march_ray ray = {.near_m = (double)s->camera.near_m * length,
                     .far_m = fmin((double)s->camera.far_m * length, FAR_M),
                     .is_below = s->is_below};
    for (int i = 0; i < 3; i++) {
        ray.origin[i] = (double)o[i];
        ray.direction[i] = (double)d[i] / length;
    }
    if (s->camera.is_orthographic)
        ray.width = s->camera.pixel_size * s->footprint;
    else
        ray.spread = s->camera.pixel_size * s->footprint / (float)length;
    return ray;
}

/* Where a ray from above meets ground that the water leaves dry; HUGE_VAL: nowhere before t. */
static double land_before(const water_setup *s, const march_ray *ray, double t)
{
    const facet_sea_bed *bed = &s->sea->desc.bed;
    if (!water_has_bed(s) || bed->slope <= 0.0f)
        return HUGE_VAL;
    const double *o = ray->origin, *e = ray->direction;
    double closing = water_bed_rise(bed, vec3((float)e[0], (float)e[1], (float)e[2])) - e[1];
    double land = (o[1] - water_bed_height(bed, o[0], o[2])) / closing;
    return closing > 0.0 && land > ray->near_m && land < t ? land : HUGE_VAL;
}

static vec3 shade_hit(const water_setup *s, const march_ray *ray, const march_hit *hit, vec3 d)
{
    water_place place = water_place_of(s, ray, hit);
    if (water_look_is_before(&s->desc->look))
        return water_look_shade(s, &place, d);
    const water_findings none = {.has_mirrored = false};
    if (s->desc->look.stage == 3)
        return water_look_painted(s, &place);
    return water_shade(s, &place, &none);
}

static vec3 through_air(const water_setup *s, vec3 L, vec3 d, double t, double height)
{
    water_air air = water_sky_air(&s->sky, d, (float)t, (float)height);
    return L * air.transmittance + air.light;
}

/* What comes along a ray, for the film. */
static vec3 trace(const water_setup *s, const march_ray *ray)
{
    const double *e = ray->direction;
    vec3 d = vec3((float)e[0], (float)e[1], (float)e[2]);
    bool is_before = water_look_is_before(&s->desc->look);
    march_hit hit;
    bool is_met = water_profile_find(&s->profile, ray, &hit);
    if (is_before)
        return is_met ? shade_hit(s, ray, &hit, d) : water_look_sky(d);
    vec3 L;
    if (ray->is_below) {
        L = water_shade_from_below(s, ray, is_met ? &hit : NULL);
    } else {
        double land = land_before(s, ray, is_met ? hit.t : ray->far_m);
        if (land < HUGE_VAL)
            L = through_air(s, water_shade_land(s), d, land, ray->origin[1] + land * e[1]);
        else if (is_met)
            L = through_air(s, shade_hit(s, ray, &hit, d), d, hit.t, 0.0);
        else
            L = water_sky_seen(&s->sky, d);
    }
    L = L * s->exposure;
    float most = s->desc->look.clamp;
    return most > 0.0f ? min(L, most) : L;
}

/* ---- pixels, tiles ---- */

static void draw_pixel(const picture *p, uint32_t x, uint32_t y)
{
    vec3 sum = vec3(0.0f);
    for (uint32_t i = 0; i < p->sample_count; i++) {
        march_ray ray = camera_ray(p->setup, (float)x + p->pattern[2 * i], (float)y + p->pattern[2 * i + 1]);
        sum = sum + trace(p->setup, &ray);
    }
    float *rgba = p->pixels + 4 * ((size_t)(y - p->crop[1]) * p->crop[2] + (x - p->crop[0]));
    for (int i = 0; i < 3; i++)
        rgba[i] = sum[i] / (float)p->sample_count;
    rgba[3] = 1.0f;
}

static void draw_tile(picture *p, uint32_t tile)
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
    picture *p = context;
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
    const facet_render_desc *r = &s->desc->render;
    film_layer *color = film_find(target, "");
    picture p = {.setup = s,
                 .crop = {r->crop[0], r->crop[1], target->width, target->height},
                 .tile_columns = (target->width + TILE - 1) / TILE,
                 .sample_count = r->samples ? r->samples : 1,
                 .pixels = color->pixels};
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

facet_result water_render(const facet_sea *sea, const facet_scene *scene, const facet_sea_render_desc *desc,
                          film *target, facet_render_stats *stats, facet_error *error)
{
    (void)scene;
    double start = clock_seconds();
    double limit_s = desc->render.time_limit_s, deadline_s = limit_s > 0.0 ? start + limit_s : 0.0;
    *stats = (facet_render_stats){.thread_count = desc->render.thread_count};
    water_setup setup;
    facet_result result = render_check_limits(&desc->render, "prepare", 0.0, deadline_s, error);
    if (result != FACET_OK)
        return result;
    result = water_setup_create(sea, desc, &setup, error);
    stats->light_s = clock_seconds() - start;
    double drawing = clock_seconds();
    if (result == FACET_OK)
        result = draw(&setup, deadline_s, target, stats, error);
    stats->shade_s = clock_seconds() - drawing;
    if (result == FACET_OK)
        result = render_check_limits(&desc->render, "shade", 1.0, 0.0, error);
    water_setup_destroy(&setup);
    stats->total_s = clock_seconds() - start;
    return result;
}
