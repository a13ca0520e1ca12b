/* ambient_occlusion.c - see ambient_occlusion.h. A pixel traces few rays from its first hit, and filters join those of the
 * pixels around that see the same surface: sparse ones in growing strides (a-trous wavelets, Dammertz et al. 2010). Dark creases
 * of pale surfaces need many rays, since interreflection brightens them, and with them their noise. The pixels' rays are
 * consecutive points of one Sobol' sequence along a Morton curve (Ahmed and Wonka 2020, "Screen-Space Blue-Noise Diffusion of Monte
 * Carlo Sampling Error via Hierarchical Ordering of Pixels"), so that what is joined is stratified at each scale. */
#include "cpu/ambient_occlusion.h"

#include <math.h>
#include <stdatomic.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "cpu/media.h"
#include "cpu/raster.h"
#include "cpu/ray_trace.h"

enum {
    TILE = RASTER_TILE,
    SQUARE = 32, /* pixels along the side of what one sequence serves */
    REACH = 2,   /* of a filter, in strides */
    GRAIN_ROWS = 8
};

/* The filters, in pixels between their taps, with the largest difference that they join: 0: any; else a multiple of the standard error
 * of so many independent rays. */
static const struct stride_filter {
    int stride;
    float rays;
} FILTERS[] = {{1, 0.0f}, {2, 0.0f}, {4, 20.0f}, {8, 60.0f}};
enum { FILTER_COUNT = sizeof FILTERS / sizeof *FILTERS, MARGIN = REACH * (1 + 2 + 4 + 8) + 1 };

/* Rays per pixel: a power of two. */
static const uint32_t RAYS[] = {
    [FACET_QUALITY_NORMAL] = 4, [FACET_QUALITY_DRAFT] = 2, [FACET_QUALITY_FINAL] = 8};

/* Of taps, -REACH .. REACH: the cubic B-spline. */
static const float WEIGHTS[2 * REACH + 1] = {0.0625f, 0.25f, 0.375f, 0.25f, 0.0625f};

/* The place of a pixel of a square along the Morton curve, whose quarters are in random order at each level. */
static uint32_t place_in_square(uint32_t x, uint32_t y)
{
    uint32_t place = 0;
    for (uint32_t bit = SQUARE / 2; bit; bit /= 2) {
        const uint32_t quarter = (x & bit ? 1u : 0u) | (y & bit ? 2u : 0u);
        place = 4 * place + (quarter ^ (hash_uint(place + bit) >> 30));
    }
    return place;
}

/* Where rays start. */
typedef struct sky_point {
    vec3 P;      /* m, off the surface by the rounding error of the intersection */
    vec3 N;      /* unit, smooth, without normal map */
    vec3 facing; /* unit normal of the triangle on the side of the eye */
} sky_point;

/* A first hit. */
typedef struct ambient_pixel {
    float P[3];
    int8_t N[3]; /* 1/127 */
    bool is_known;
} ambient_pixel;

struct ambient_image {
    ambient_desc desc;
    visibility_pattern middle;         /* one sample per pixel */
    uint32_t left, top, width, height; /* the crop with its margin */
    uint32_t tile_columns, tile_rows;
    uint32_t rays; /* per pixel */
    vec2 *points;  /* of a Sobol' sequence, scrambled: SQUARE * SQUARE * rays */
    uint16_t places[SQUARE * SQUARE];
    ambient_pixel *pixels; /* rows of the image */
    float *openness;       /* of them; below 0: not known */
    float *filtered;
    const struct stride_filter *filter; /* of the pass */
    _Atomic uint64_t rays_traced;
};

/* ---- points ---- */

static sky_point point_on(const shading_hit *h, const visibility_hit *hit, bool is_front)
{
    vec3 facing = load3(hit->normal);
    facing = normalize_or(dot(facing, h->direction) > 0.0f ? -facing : facing, -h->direction);
    vec3 N = h->geometry->normals ? normalize_or(shading_frame_normal(h, is_front), facing) : facing;
    float off = media_tolerance(max3(max(abs(h->position), h->farthest)));
    return (sky_point){
        .P = h->position + facing * off, .N = dot(N, facing) > 0.0f ? N : facing, .facing = facing};
}

/* Blended, masked and transmissive surfaces are not kept: a ray to the nearest one may have passed it. */
static bool is_kept(const shading_scene *scene, const visibility_hit *hit)
{
    if (hit->geometry == VISIBILITY_NONE)
        return false;
    const render_geometry *g = &scene->geometries->items[hit->geometry];
    return g->is_lit && g->primitive->mode == SCENE_TRIANGLES && !g->is_see_through &&
           !scene->plans->items[hit->geometry].lets_rays_through;
}

/* The direction of a ray of a pixel. Each square has the points rotated (Cranley and Patterson 1976). */
static vec3 direction_of(const ambient_image *a, uint32_t x, uint32_t y, uint32_t ray)
{
    const uint32_t first = a->places[y % SQUARE * SQUARE + x % SQUARE] * a->rays;
    const uint32_t seed = hash_uint(x / SQUARE + hash_uint(y / SQUARE));
    const vec2 turn = vec2((float)(seed >> 16), (float)(seed & 0xffffu)) * (1.0f / 65536.0f);
    return sample_cosine(fract(a->points[(first + ray) % (SQUARE * SQUARE * a->rays)] + turn));
}

/* The share of the first count rays of a pixel, and of those of the pixels after it, that see the sky. Those below the triangle,
 * which a smooth normal that leans away from it brings, do not count. */
static float openness_at(const ambient_image *a, const sky_point *p, uint32_t x, uint32_t y, uint32_t count,
                         uint64_t *rays)
{
    static const ray_spread still = {.moves = false, .turns = false};
    mat3 frame = basis_from_normal(p->N);
    float open = 0.0f;
    float total = 0.0f;
    shading_ray ray = {.far_t = INFINITY, .spread = &still};
    store3(p->P, ray.origin);
    for (uint32_t i = 0; i < count; i++) {
        vec3 L = mul(frame, direction_of(a, x, y, i));
        if (!(dot(L, p->facing) > 0.0f))
            continue;
        store3(L, ray.direction);
        open += ray_trace_daylight(a->desc.scene, &ray);
        total += 1.0f;
    }
    *rays += (uint64_t)total;
    return total > 0.0f ? open / total : 1.0f;
}

/* ---- first hits and their rays ---- */

static size_t index_of(const ambient_image *a, uint32_t x, uint32_t y)
{
    return (size_t)(y - a->top) * a->width + (x - a->left);
}

static bool has_pixel(const ambient_image *a, int64_t x, int64_t y)
{
    return x >= a->left && y >= a->top && x < (int64_t)a->left + a->width && y < (int64_t)a->top + a->height;
}

static void fill_pixel(ambient_image *a, uint32_t x, uint32_t y, const visibility_hit *hit, uint64_t *rays)
{
    const shading_scene *scene = a->desc.scene;
    ambient_pixel *out = &a->pixels[index_of(a, x, y)];
    float *openness = &a->openness[index_of(a, x, y)];
    *out = (ambient_pixel){.is_known = is_kept(scene, hit)};
    *openness = -1.0f;
    if (!out->is_known)
        return;
    shading_ray ray =
        shading_ray_of_camera(scene->camera, &scene->camera_spread, (float)x + 0.5f, (float)y + 0.5f, 1.0f);
    shading_point point = {.hit = hit, .ray = &ray, .x = x, .y = y, .shade_count = 1};
    shading_hit h = shading_hit_make(scene, &point);
    sky_point p = point_on(&h, hit, surface_sees_front(h.geometry, hit, h.direction));
    store3(p.P, out->P);
    for (int i = 0; i < 3; i++)
        out->N[i] = (int8_t)lrintf(127.0f * p.N[i]);
    *openness = openness_at(a, &p, x, y, a->rays, rays);
}

static void fill_block(ambient_image *a, const raster_tile *rastered, uint32_t block, uint32_t x, uint32_t y,
                       uint64_t *rays)
{
    visibility_hit hits[VISIBILITY_BLOCK_PIXELS];
    if (rastered) {
        raster_tile_read(rastered, block, hits);
    } else {
        visibility_trace_block(a->desc.scene->rays, a->desc.scene->camera, x, y, &a->middle, hits);
        *rays += VISIBILITY_BLOCK_PIXELS;
    }
    for (uint32_t i = 0; i < VISIBILITY_BLOCK_PIXELS; i++) {
        uint32_t px = x + i % VISIBILITY_BLOCK;
        uint32_t py = y + i / VISIBILITY_BLOCK;
        if (has_pixel(a, px, py))
            fill_pixel(a, px, py, &hits[visibility_first_hit(&a->middle, i)], rays);
    }
}

static void fill_tile(ambient_image *a, uint32_t tile)
{
    enum { ROW = TILE / VISIBILITY_BLOCK };
    const uint32_t left = (a->left / TILE + tile % a->tile_columns) * TILE;
    const uint32_t top = (a->top / TILE + tile / a->tile_columns) * TILE;
    uint64_t rays = 0;
    raster_tile *rastered = NULL;
    if (a->desc.raster)
        rastered = raster_tile_create(a->desc.raster, &a->middle, left, top, a->desc.allocator);
    if (a->desc.raster && !rastered) {
        render_watch_stop(a->desc.watch, FACET_ERROR_MEMORY);
        return;
    }
    for (uint32_t block = 0; block < ROW * ROW; block++) {
        const uint32_t x = left + block % ROW * VISIBILITY_BLOCK;
        const uint32_t y = top + block / ROW * VISIBILITY_BLOCK;
        if (x + VISIBILITY_BLOCK > a->left && y + VISIBILITY_BLOCK > a->top && x < a->left + a->width &&
            y < a->top + a->height)
            fill_block(a, rastered, block, x, y, &rays);
    }
    raster_tile_destroy(rastered);
    atomic_fetch_add(&a->rays_traced, rays);
}

static void fill_tiles(void *context, size_t begin, size_t end)
{
    ambient_image *a = context;
    for (size_t tile = begin; tile < end; tile++) {
        render_watch_look(a->desc.watch);
        if (render_watch_is_stopped(a->desc.watch))
            return;
        fill_tile(a, (uint32_t)tile);
    }
}

/* ---- filters ---- */

static vec3 normal_of(const ambient_pixel *p)
{
    return vec3((float)p->N[0], (float)p->N[1], (float)p->N[2]) * (1.0f / 127.0f);
}

/* How much a pixel's point belongs to the surface at P: within two pixels of its plane, and turned alike. */
static float likeness(vec3 P, vec3 N, const ambient_pixel *q, float pixel_size_m)
{
    const float off_plane = abs(dot(N, load3(q->P) - P));
    return max(2.0f * dot(N, normal_of(q)) - 1.0f, 0.0f) *
           max(1.0f - off_plane / (2.0f * pixel_size_m), 0.0f);
}

/* Below, too few pixels around show the surface, and it has rays of its own. */
static const float LEAST_WEIGHT = 0.2f;

static float pixel_size_at(const ambient_image *a, vec3 P)
{
    const camera_rays *camera = a->desc.scene->camera;
    return camera_rays_pixel_size(camera, length(P - load3(camera->origin)));
}

static float filter_pixel(const ambient_image *a, uint32_t x, uint32_t y)
{
    const size_t at = index_of(a, x, y);
    const struct stride_filter *f = a->filter;
    const float middle = a->openness[at];
    const vec3 P = load3(a->pixels[at].P);
    const vec3 N = normal_of(&a->pixels[at]);
    const float size = pixel_size_at(a, P);
    const float most2 = f->rays > 0.0f ? max(middle * (1.0f - middle), 0.05f) / f->rays : INFINITY;
    float sum = 0.0f;
    float total = 0.0f;
    for (int j = -REACH; j <= REACH; j++)
        for (int i = -REACH; i <= REACH; i++) {
            const int dx = i * f->stride, dy = j * f->stride;
            if (!has_pixel(a, (int64_t)x + dx, (int64_t)y + dy))
                continue;
            const size_t q = index_of(a, x + (uint32_t)dx, y + (uint32_t)dy);
            if (!(a->openness[q] >= 0.0f))
                continue;
            const float off = a->openness[q] - middle;
            const float w = WEIGHTS[i + REACH] * WEIGHTS[j + REACH] * max(1.0f - off * off / most2, 0.0f) *
                            likeness(P, N, &a->pixels[q], size);
            sum += w * a->openness[q];
            total += w;
        }
    return f->stride > 1 || total > LEAST_WEIGHT ? sum / total : -1.0f;
}

static void filter_rows(void *context, size_t begin, size_t end)
{
    ambient_image *a = context;
    for (size_t row = begin; row < end; row++) {
        render_watch_look(a->desc.watch);
        if (render_watch_is_stopped(a->desc.watch))
            return;
        for (uint32_t x = a->left; x < a->left + a->width; x++) {
            const uint32_t y = a->top + (uint32_t)row;
            const size_t at = index_of(a, x, y);
            const bool is_known = a->openness[at] >= 0.0f;
            a->filtered[at] = is_known ? filter_pixel(a, x, y) : -1.0f;
        }
    }
}

static void filter_image(ambient_image *a, const struct stride_filter *filter)
{
    a->filter = filter;
    parallel_for(a->desc.thread_count, a->height, GRAIN_ROWS, filter_rows, a);
    float *swap = a->openness;
    a->openness = a->filtered;
    a->filtered = swap;
}

/* ---- an image ---- */

static bool has_memory(ambient_image *a)
{
    const ambient_desc *d = &a->desc;
    const size_t count = (size_t)a->width * a->height;
    a->points = mem_alloc(d->allocator, (size_t)SQUARE * SQUARE * a->rays, sizeof *a->points);
    a->pixels = mem_alloc(d->allocator, count, sizeof *a->pixels);
    a->openness = mem_alloc(d->allocator, count, sizeof *a->openness);
    a->filtered = mem_alloc(d->allocator, count, sizeof *a->filtered);
    return a->points && a->pixels && a->openness && a->filtered &&
           visibility_pattern_create(d->allocator, 1, &a->middle);
}

/* The crop with MARGIN pixels around it, within the image. */
static void place(ambient_image *a)
{
    const uint32_t *crop = a->desc.crop;
    const uint32_t right = crop[0] + crop[2] + MARGIN, bottom = crop[1] + crop[3] + MARGIN;
    a->left = crop[0] > MARGIN ? crop[0] - MARGIN : 0;
    a->top = crop[1] > MARGIN ? crop[1] - MARGIN : 0;
    a->width = (right < a->desc.width ? right : a->desc.width) - a->left;
    a->height = (bottom < a->desc.height ? bottom : a->desc.height) - a->top;
    a->tile_columns = (a->left + a->width - 1) / TILE - a->left / TILE + 1;
    a->tile_rows = (a->top + a->height - 1) / TILE - a->top / TILE + 1;
}

ambient_image *ambient_image_create(const ambient_desc *desc, uint64_t *rays)
{
    ambient_image *a = mem_zalloc(desc->allocator, 1, sizeof *a);
    if (!a)
        return NULL;
    a->desc = *desc;
    a->rays = RAYS[desc->scene->quality];
    place(a);
    if (!has_memory(a)) {
        ambient_image_destroy(a);
        return NULL;
    }
    for (uint32_t i = 0; i < SQUARE * SQUARE * a->rays; i++)
        a->points[i] = sobol_scrambled(i, 0x7a5c91e3u);
    for (uint32_t i = 0; i < SQUARE * SQUARE; i++)
        a->places[i] = (uint16_t)place_in_square(i % SQUARE, i / SQUARE);
    parallel_for(desc->thread_count, (size_t)a->tile_columns * a->tile_rows, 1, fill_tiles, a);
    for (int i = 0; i < FILTER_COUNT; i++)
        filter_image(a, &FILTERS[i]);
    *rays += atomic_load(&a->rays_traced);
    return a;
}

void ambient_image_destroy(ambient_image *image)
{
    if (!image)
        return;
    visibility_pattern_destroy(&image->middle);
    mem_free(image->points);
    mem_free(image->pixels);
    mem_free(image->openness);
    mem_free(image->filtered);
    mem_free(image);
}

/* ---- a surface ---- */

/* By the nearest pixels that see the surface. */
static float openness_near(const ambient_image *a, const shading_point *point, const sky_point *p,
                           uint64_t *rays)
{
    static const float near_by[3] = {0.25f, 0.5f, 0.25f};
    const float size = camera_rays_pixel_size(a->desc.scene->camera, point->hit->t);
    float sum = 0.0f;
    float total = 0.0f;
    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++) {
            if (!has_pixel(a, (int64_t)point->x + dx, (int64_t)point->y + dy))
                continue;
            const size_t q = index_of(a, point->x + (uint32_t)dx, point->y + (uint32_t)dy);
            if (!(a->openness[q] >= 0.0f))
                continue;
            const float w = near_by[dx + 1] * near_by[dy + 1] * likeness(p->P, p->N, &a->pixels[q], size);
            sum += w * a->openness[q];
            total += w;
        }
    return total > 0.05f ? sum / total : openness_at(a, p, point->x, point->y, 8 * a->rays, rays);
}

vec3 ambient_factor(const ambient_image *image, const shading_point *point, const surface_point *s,
                    uint64_t *rays)
{
    const render_geometry *g = s->hit.geometry;
    if (!s->is_lit || g->primitive->mode != SCENE_TRIANGLES || (s->m.layers & LAYER_TRANSMISSION))
        return vec3(1.0f);
    sky_point p = point_on(&s->hit, point->hit, s->is_front);
    float openness = openness_near(image, point, &p, rays);
    vec3 albedo = s->m.base.base_color * (1.0f - s->m.base.metallic);
    vec3 factor = ambient_interreflection(openness, clamp(albedo, vec3(0.0f), vec3(1.0f)));
    return min(factor / max(s->m.base.occlusion, 1e-6f), vec3(1.0f));
}
