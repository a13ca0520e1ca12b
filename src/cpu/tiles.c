/* tiles.c - see tiles.h. Tiles are scheduled one by one, because some cost a hundred times more than
 * others; pixels are independent of each other. */
#include "cpu/tiles.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "cpu/ambient_occlusion.h"
#include "cpu/pixel.h"
#include "cpu/raster.h"
#include "cpu/surface_layers.h"
#include "draw/render_watch.h"
#include "scene/identity.h"

enum { TILE = RASTER_TILE };
_Static_assert(TILE % VISIBILITY_BLOCK == 0, "tiles are made of whole blocks");

typedef struct tile_job {
    const tiles_desc *desc;
    uint32_t crop[4]; /* x, y, width, height in the whole image */
    uint32_t tile_columns, tile_count;
    visibility_pattern pattern, middle;
    ambient_image *ambient; /* NULL: none */
    film_layer *color;
    surface_layers layers;
    matte_layers mattes;
    bool draws_image, wants_aovs;
    /* shared by the threads */
    render_watch watch;
    _Atomic uint64_t rays, shades;
} tile_job;

/* ---- one block ---- */

/* Buffers of a thread for a tile. */
typedef struct workspace {
    pixel_resolver resolver;
    raster_tile *raster;  /* NULL: hits are traced */
    visibility_hit *hits; /* VISIBILITY_BLOCK_PIXELS * sample_count */
    bool has_hits;        /* of the block */
    visibility_hit middle_hits[VISIBILITY_BLOCK_PIXELS];
} workspace;

static void write_aovs(const tile_job *p, workspace *w, uint32_t x, uint32_t y, const visibility_hit *hit,
                       size_t pixel)
{
    shading_description surface;
    float depth_m;
    uint32_t geometry;
    if (!pixel_nearest_surface(&w->resolver, x, y, hit, &surface, &depth_m, &geometry))
        return; /* the film starts with background values */
    const scene_identity *identities = p->desc->identities;
    surface_layers_store(&p->layers, pixel, depth_m, &surface, identities ? &identities[geometry] : NULL);
}

/* The hits of the block whose top left pixel is (x, y), number block of its tile. */
static void find_hits(const tile_job *p, workspace *w, uint32_t x, uint32_t y, uint32_t block)
{
    if (w->raster)
        raster_tile_read(w->raster, block, w->hits);
    else
        visibility_trace_block(p->desc->scene->rays, p->desc->scene->camera, x, y, &p->pattern, w->hits);
    w->has_hits = true;
}

/* Resolves pixel i, which is (x, y), of a block. */
static bool draw_pixel(const tile_job *p, workspace *w, uint32_t block, uint32_t i, uint32_t x, uint32_t y,
                       float *rgba)
{
    const size_t first = visibility_first_hit(&p->pattern, i);
    visibility_hit one;
    if (w->raster && raster_tile_read_one(w->raster, block, first, p->pattern.sample_count, &one) &&
        pixel_resolve_one(&w->resolver, x, y, &one, rgba))
        return true;
    if (!w->has_hits)
        find_hits(p, w, x - i % VISIBILITY_BLOCK, y - i / VISIBILITY_BLOCK, block);
    return pixel_resolve(&w->resolver, x, y, w->hits + first, rgba);
}

static bool draw_block(const tile_job *p, workspace *w, uint32_t x, uint32_t y, uint32_t block)
{
    const camera_rays *camera = p->desc->scene->camera;
    w->has_hits = false;
    if (p->draws_image)
        w->resolver.rays += (uint64_t)VISIBILITY_BLOCK_PIXELS * p->pattern.sample_count;
    if (p->wants_aovs) {
        visibility_trace_block(p->desc->scene->rays, camera, x, y, &p->middle, w->middle_hits);
        w->resolver.rays += VISIBILITY_BLOCK_PIXELS;
    }
    for (uint32_t i = 0; i < VISIBILITY_BLOCK_PIXELS; i++) {
        uint32_t px = x + i % VISIBILITY_BLOCK;
        uint32_t py = y + i / VISIBILITY_BLOCK;
        if (px < p->crop[0] || py < p->crop[1] || px - p->crop[0] >= p->crop[2] ||
            py - p->crop[1] >= p->crop[3])
            continue;
        size_t pixel = (size_t)(py - p->crop[1]) * p->crop[2] + (px - p->crop[0]);
        float *rgba = p->color->pixels + 4 * pixel;
        if (p->draws_image && !draw_pixel(p, w, block, i, px, py, rgba))
            return false;
        if (p->draws_image && p->mattes.aovs)
            pixel_add_mattes(&w->resolver, p->desc->identities, &p->mattes, pixel);
        if (p->wants_aovs)
            write_aovs(p, w, px, py, &w->middle_hits[visibility_first_hit(&p->middle, i)], pixel);
    }
    return true;
}

/* ---- tiles ---- */

static void draw_tile(tile_job *p, uint32_t tile)
{
    const facet_render_desc *render = p->desc->render;
    workspace w = {.hits =
                       mem_alloc(&render->allocator,
                                 (size_t)VISIBILITY_BLOCK_PIXELS * p->pattern.sample_count, sizeof *w.hits),
                   .resolver = {.allocator = &render->allocator,
                                .scene = p->desc->scene,
                                .pattern = &p->pattern,
                                .ambient = p->ambient,
                                .splits_quarters = render->quality == FACET_QUALITY_FINAL,
                                .has_visible_hits = p->desc->raster && raster_is_final(p->desc->raster),
                                .draws_background = p->desc->draws_background,
                                .background_blur = render->background_blur,
                                .scale = exp2f(render->exposure_ev)}};
    uint32_t left = p->crop[0] / TILE * TILE + tile % p->tile_columns * TILE;
    uint32_t top = p->crop[1] / TILE * TILE + tile / p->tile_columns * TILE;
    bool has_memory = w.hits != NULL;
    if (has_memory && p->draws_image && p->desc->raster) {
        w.raster = raster_tile_create(p->desc->raster, &p->pattern, left, top, &render->allocator);
        has_memory = w.raster != NULL;
    }
    for (uint32_t block = 0; has_memory && block < TILE / VISIBILITY_BLOCK * (TILE / VISIBILITY_BLOCK);
         block++) {
        uint32_t x = left + block % (TILE / VISIBILITY_BLOCK) * VISIBILITY_BLOCK;
        uint32_t y = top + block / (TILE / VISIBILITY_BLOCK) * VISIBILITY_BLOCK;
        if (x + VISIBILITY_BLOCK <= p->crop[0] || y + VISIBILITY_BLOCK <= p->crop[1] ||
            x >= p->crop[0] + p->crop[2] || y >= p->crop[1] + p->crop[3])
            continue;
        if (render_watch_is_stopped(&p->watch))
            break;
        has_memory = draw_block(p, &w, x, y, block);
        render_watch_look(&p->watch); /* a block of glass may cost a hundred times more than others */
    }
    if (!has_memory)
        render_watch_stop(&p->watch, FACET_ERROR_MEMORY);
    atomic_fetch_add(&p->rays, w.resolver.rays);
    atomic_fetch_add(&p->shades, w.resolver.shades);
    pixel_resolver_destroy(&w.resolver);
    raster_tile_destroy(w.raster);
    mem_free(w.hits);
}

static void draw_tiles(void *context, size_t begin, size_t end)
{
    tile_job *p = context;
    for (size_t tile = begin; tile < end; tile++) {
        render_watch_look(&p->watch);
        if (render_watch_is_stopped(&p->watch))
            return;
        draw_tile(p, (uint32_t)tile);
        render_watch_add(&p->watch, 1);
    }
}

/* False: no memory. */
static bool find_ambient(tile_job *p, facet_render_stats *stats)
{
    const facet_render_desc *render = p->desc->render;
    ambient_desc ambient = {.scene = p->desc->scene,
                            .raster = p->desc->raster,
                            .width = render->width,
                            .height = render->height,
                            .thread_count = render->thread_count,
                            .allocator = &render->allocator,
                            .watch = &p->watch};
    memcpy(ambient.crop, p->crop, sizeof ambient.crop);
    p->ambient = ambient_image_create(&ambient, &stats->rays);
    return p->ambient != NULL;
}

static facet_result draw(const tiles_desc *desc, bool draws_image, film *target, facet_render_stats *stats,
                         facet_error *error)
{
    const facet_render_desc *render = desc->render;
    const uint32_t *crop = render->crop;
    tile_job p = {.desc = desc,
                  .crop = {crop[0], crop[1], target->width, target->height},
                  .tile_columns = (crop[0] + target->width - 1) / TILE - crop[0] / TILE + 1,
                  .color = film_find(target, ""),
                  .layers = surface_layers_find(target),
                  .mattes = matte_find(target),
                  .draws_image = draws_image,
                  .wants_aovs = (render->aovs & ~(uint32_t)FACET_AOV_CRYPTOMATTE) != 0};
    if (draws_image)
        matte_clear(&p.mattes,
                    (size_t)target->width * target->height); /* a failed attempt may have filled it */
    p.tile_count = p.tile_columns * ((crop[1] + target->height - 1) / TILE - crop[1] / TILE + 1);
    render_watch_init(&p.watch, &render->progress, "shade", desc->deadline_s, p.tile_count);
    bool has_memory =
        visibility_pattern_create(&render->allocator, draws_image ? render->samples : 1, &p.pattern) &&
        visibility_pattern_create(&render->allocator, 1, &p.middle);
    if (has_memory && draws_image && desc->has_ambient_occlusion)
        has_memory = find_ambient(&p, stats);
    if (has_memory)
        parallel_for(render->thread_count, p.tile_count, 1, draw_tiles, &p);
    visibility_pattern_destroy(&p.pattern);
    visibility_pattern_destroy(&p.middle);
    ambient_image_destroy(p.ambient);
    if (!has_memory)
        return fail_memory(error, "sample pattern", render->samples * sizeof(float));
    stats->rays += atomic_load(&p.rays);
    stats->shades += atomic_load(&p.shades);
    return render_watch_explain(&p.watch, error);
}

facet_result tiles_draw(const tiles_desc *desc, film *target, facet_render_stats *stats, facet_error *error)
{
    return draw(desc, true, target, stats, error);
}

facet_result tiles_draw_aovs(const tiles_desc *desc, film *target, facet_render_stats *stats,
                             facet_error *error)
{
    return draw(desc, false, target, stats, error);
}
