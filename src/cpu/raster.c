/* raster.c - see raster.h: sorts triangles into tiles. raster_tile.c finds the hits of a tile. */
#include "cpu/raster_bins.h"

#include <math.h>

#include "base/parallel.h"
#include "base/result.h"
#include "draw/material_plan.h"

#include "shade/shade.h"

/* ---- triangles ---- */

static void subtract(const float a[3], const float b[3], float out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[i] - b[i];
}

/* The normal of a triangle by that of its two pairs of edges whose products are smaller, per axis: the least
 * rounding. */
static void stable_normal(const float a[3], const float b[3], const float c[3], float out[3])
{
    for (int i = 0; i < 3; i++) {
        const int y = (i + 1) % 3, z = (i + 2) % 3;
        const float ab = a[z] * b[y], bc = b[z] * c[y];
        out[i] = fabsf(ab) < fabsf(bc) ? a[y] * b[z] - ab : b[y] * c[z] - bc;
    }
}

void raster_triangle_set(const render_geometry *g, uint32_t triangle, const float origin[3],
                         raster_triangle *out)
{
    const uint32_t *corner = render_geometry_triangle(g, triangle);
    for (int k = 0; k < 3; k++)
        subtract(g->vertices + 3 * (size_t)corner[k], origin, out->corners[k]);
    for (int k = 0; k < 3; k++)
        subtract(out->corners[(k + 2) % 3], out->corners[k], out->edges[k]);
    stable_normal(out->edges[0], out->edges[1], out->edges[2], out->normal);
    const float *n = out->normal, *v = out->corners[0];
    out->plane = 2.0f * (v[0] * n[0] + (v[1] * n[1] + v[2] * n[2]));
}

bool raster_triangle_is_culled(const render_geometry *g, const raster_triangle *triangle)
{
    return g->is_mirrored ? triangle->plane < 0.0f : triangle->plane > 0.0f;
}

/* Whether rays end at one side only and pass the other. */
static bool is_one_sided(const render_geometry *g)
{
    return !g->is_double_sided && !g->is_see_through &&
           (g->legacy || !g->is_lit || !(material_plan_layers(g->material) & LAYER_TRANSMISSION));
}

/* ---- bounds in the image ---- */

/* Of the projections and the test at edges, pixels: their rounding is far below. */
static const float BOUNDS_MARGIN = 1.0f / 16.0f;

/* Clamps to the pixels of an axis; false: outside. */
static bool find_range(float low, float high, uint32_t size, uint16_t *first, uint16_t *last)
{
    low -= BOUNDS_MARGIN;
    high += BOUNDS_MARGIN;
    if (!(high >= 0.0f && low < (float)size))
        return false;
    *first = low > 0.0f ? (uint16_t)low : 0;
    *last = high < (float)size ? (uint16_t)high : (uint16_t)(size - 1);
    return true;
}

static raster_bounds find_bounds(const camera_rays *camera, const float corners[3][3], uint32_t width,
                                 uint32_t height)
{
    const raster_bounds nowhere = {.x0 = 1},
                        everywhere = {0, 0, (uint16_t)(width - 1), (uint16_t)(height - 1)};
    float low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    int behind_count = 0;
    for (int k = 0; k < 3; k++) {
        float at[2], depth;
        if (!camera_rays_project(camera, corners[k], at, &depth)) {
            behind_count++;
            continue;
        }
        for (int i = 0; i < 2; i++) {
            low[i] = fminf(low[i], at[i]);
            high[i] = fmaxf(high[i], at[i]);
        }
    }
    if (behind_count)
        return behind_count == 3 ? nowhere : everywhere;
    raster_bounds b;
    if (!find_range(low[0], high[0], width, &b.x0, &b.x1) ||
        !find_range(low[1], high[1], height, &b.y0, &b.y1))
        return nowhere;
    return b;
}

/* ---- sorting ---- */

enum { CHUNK_LEAST = 4096, CHUNKS_MOST = 16, COUNTS_MOST = 1 << 20 };

typedef struct sorting {
    raster *r;
    const raster_desc *desc;
    uint32_t triangle_count, chunk_size, chunk_count, tile_count;
    uint32_t *places; /* per chunk and tile: number of entries, then where the next one goes */
    uint64_t *areas;  /* per chunk: pixels in bounds */
} sorting;

/* Adds 1 to the counts of tiles, or writes the triangle there. */
static void visit_tiles(const sorting *s, uint32_t *places, uint32_t triangle, bool writes)
{
    const raster_bounds b = s->r->bounds[triangle];
    if (b.x0 > b.x1)
        return;
    for (uint32_t y = b.y0 / RASTER_TILE; y <= b.y1 / RASTER_TILE; y++)
        for (uint32_t x = b.x0 / RASTER_TILE; x <= b.x1 / RASTER_TILE; x++) {
            uint32_t *place = &places[y * s->r->tile_columns + x];
            if (writes)
                s->r->entries[*place] = triangle;
            ++*place;
        }
}

static void count_chunks(void *context, size_t begin, size_t end)
{
    const sorting *s = context;
    for (size_t chunk = begin; chunk < end; chunk++) {
        uint32_t *counts = s->places + chunk * s->tile_count;
        uint32_t triangle = (uint32_t)chunk * s->chunk_size, geometry = 0;
        uint32_t last =
            s->triangle_count - triangle < s->chunk_size ? s->triangle_count : triangle + s->chunk_size;
        bool culls = false;
        for (uint32_t known = UINT32_MAX; triangle < last; triangle++) {
            raster_triangle t;
            geometry = raster_geometry_of(s->r, triangle, geometry);
            const render_geometry *g = &s->r->geometries->items[geometry];
            if (geometry != known)
                culls = is_one_sided(g);
            known = geometry;
            raster_triangle_set(g, triangle - s->r->first_triangles[geometry], s->r->camera->origin, &t);
            raster_bounds *b = &s->r->bounds[triangle];
            *b = culls && raster_triangle_is_culled(g, &t)
                     ? (raster_bounds){.x0 = 1}
                     : find_bounds(s->r->camera, (const float(*)[3])t.corners, s->desc->width,
                                   s->desc->height);
            if (b->x0 <= b->x1)
                s->areas[chunk] += (uint64_t)(b->x1 - b->x0 + 1) * (uint64_t)(b->y1 - b->y0 + 1);
            visit_tiles(s, counts, triangle, false);
        }
    }
}

static void write_chunks(void *context, size_t begin, size_t end)
{
    const sorting *s = context;
    for (size_t chunk = begin; chunk < end; chunk++) {
        uint32_t triangle = (uint32_t)chunk * s->chunk_size;
        uint32_t last =
            s->triangle_count - triangle < s->chunk_size ? s->triangle_count : triangle + s->chunk_size;
        for (; triangle < last; triangle++)
            visit_tiles(s, s->places + chunk * s->tile_count, triangle, true);
    }
}

/* Nanoseconds of both ways, measured with the models of bench/still.sh. */
enum { TRIANGLE_NS = 40, ENTRY_NS = 80, RAYS8_NS = 6, TRACED_RAY_NS = 30, HIERARCHY_TRIANGLE_NS = 100 };

static bool is_cheaper(const sorting *s, uint64_t entry_count)
{
    const raster_desc *desc = s->desc;
    uint64_t area = 0;
    for (uint32_t i = 0; i < s->chunk_count; i++)
        area += s->areas[i];
    const uint64_t ray_count = (uint64_t)desc->width * desc->height * desc->sample_count;
    const uint64_t rastering = s->triangle_count * (uint64_t)TRIANGLE_NS + entry_count * ENTRY_NS +
                               area * desc->sample_count * RAYS8_NS / 8;
    const uint64_t tracing =
        ray_count * TRACED_RAY_NS +
        (desc->needs_hierarchy ? 0 : (uint64_t)s->triangle_count * HIERARCHY_TRIANGLE_NS);
    return entry_count < UINT32_MAX && rastering < tracing;
}

/* Turns counts into places, tile by tile, and in a tile chunk by chunk: in the order of triangles. */
static uint64_t place_entries(const sorting *s)
{
    uint64_t at = 0;
    for (uint32_t tile = 0; tile < s->tile_count; tile++) {
        s->r->tile_starts[tile] = (uint32_t)at;
        for (uint32_t chunk = 0; chunk < s->chunk_count; chunk++) {
            uint32_t *place = &s->places[(size_t)chunk * s->tile_count + tile];
            uint32_t count = *place;
            *place = (uint32_t)at;
            at += count;
        }
    }
    s->r->tile_starts[s->tile_count] = (uint32_t)at;
    return at;
}

/* *is_chosen: rasterising is cheaper. False: no memory. */
static bool sort(sorting *s, const facet_allocator *allocator, bool *is_chosen)
{
    raster *r = s->r;
    s->chunk_count = s->triangle_count / CHUNK_LEAST + 1;
    s->chunk_count = s->chunk_count < CHUNKS_MOST ? s->chunk_count : CHUNKS_MOST;
    if (s->chunk_count > COUNTS_MOST / s->tile_count + 1)
        s->chunk_count = COUNTS_MOST / s->tile_count + 1;
    s->chunk_size = s->triangle_count / s->chunk_count + 1;
    s->chunk_count = (s->triangle_count + s->chunk_size - 1) / s->chunk_size;
    s->places = mem_zalloc(allocator, (size_t)s->chunk_count * s->tile_count, sizeof *s->places);
    s->areas = mem_zalloc(allocator, s->chunk_count, sizeof *s->areas);
    r->bounds = mem_alloc(allocator, s->triangle_count, sizeof *r->bounds);
    r->tile_starts = mem_alloc(allocator, (size_t)s->tile_count + 1, sizeof *r->tile_starts);
    if (!s->places || !s->areas || !r->bounds || !r->tile_starts)
        return false;
    parallel_for(s->desc->thread_count, s->chunk_count, 1, count_chunks, s);
    const uint64_t entry_count = place_entries(s);
    *is_chosen = is_cheaper(s, entry_count);
    if (!*is_chosen)
        return true;
    r->entries = mem_alloc(allocator, entry_count, sizeof *r->entries);
    if (!r->entries)
        return false;
    parallel_for(s->desc->thread_count, s->chunk_count, 1, write_chunks, s);
    return true;
}

/* ---- all ---- */

enum { SIZE_MOST = 32768, SAMPLES_MOST = 64 };

/* Numbers the triangles; 0: none, too many, or others than triangles in world space. */
static uint32_t number_triangles(const render_geometry_set *set, uint32_t *first_triangles)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < set->count; i++) {
        const render_geometry *g = &set->items[i];
        if (g->primitive->mode != SCENE_TRIANGLES || g->role == RENDER_INSTANCED)
            return 0;
        first_triangles[i] = (uint32_t)count;
        count += g->primitive->index_count / 3;
        if (count >= UINT32_MAX)
            return 0;
    }
    first_triangles[set->count] = (uint32_t)count;
    return (uint32_t)count;
}

facet_result raster_create(const raster_desc *desc, const facet_allocator *allocator, raster **out,
                           facet_error *error)
{
    *out = NULL;
    if (desc->camera->is_orthographic || desc->width > SIZE_MOST || desc->height > SIZE_MOST ||
        desc->sample_count > SAMPLES_MOST)
        return FACET_OK;
    raster *r = mem_zalloc(allocator, 1, sizeof *r);
    sorting s = {.r = r, .desc = desc};
    bool has_memory = r != NULL, is_chosen = false;
    if (has_memory) {
        r->geometries = desc->geometries;
        r->camera = desc->camera;
        r->is_final = !desc->needs_hierarchy;
        r->tile_columns = (desc->width + RASTER_TILE - 1) / RASTER_TILE;
        r->tile_rows = (desc->height + RASTER_TILE - 1) / RASTER_TILE;
        s.tile_count = r->tile_columns * r->tile_rows;
        r->first_triangles =
            mem_alloc(allocator, (size_t)desc->geometries->count + 1, sizeof *r->first_triangles);
        has_memory = r->first_triangles != NULL;
    }
    if (has_memory)
        s.triangle_count = number_triangles(desc->geometries, r->first_triangles);
    if (s.triangle_count)
        has_memory = sort(&s, allocator, &is_chosen);
    mem_free(s.places);
    mem_free(s.areas);
    if (has_memory && is_chosen) {
        *out = r;
        return FACET_OK;
    }
    raster_destroy(r);
    return has_memory ? FACET_OK
                      : fail_memory(error, "triangles in tiles", s.triangle_count * sizeof(uint64_t));
}

bool raster_is_final(const raster *r)
{
    return r->is_final;
}

void raster_destroy(raster *r)
{
    if (!r)
        return;
    mem_free(r->first_triangles);
    mem_free(r->bounds);
    mem_free(r->tile_starts);
    mem_free(r->entries);
    mem_free(r);
}
