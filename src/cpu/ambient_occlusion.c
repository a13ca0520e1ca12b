/* ambient_occlusion.c - see ambient_occlusion.h. A pixel traces a 64th of a set of directions from its first hit; a filter
 * over the pixels around that see the same surface joins all of them, as in ground_shadow.c. Dark creases of pale
 * surfaces need that many: interreflection brightens them, and with them their noise. */
#include "cpu/ambient_occlusion.h"

#include <math.h>

#include "base/memory.h"
#include "cpu/media.h"
#include "cpu/ray_trace.h"

enum { MARGIN = VISIBILITY_BLOCK, REACH = 4 };
_Static_assert(REACH <= MARGIN, "the filter reads the margin");

/* Rays per pixel; a filtered pixel has 64 times as many. */
static const uint32_t RAYS[] = {
    [FACET_QUALITY_NORMAL] = 4, [FACET_QUALITY_DRAFT] = 2, [FACET_QUALITY_FINAL] = AMBIENT_MOST_RAYS};

/* Weights of the pixels -REACH .. REACH away along an axis: each of eight in a row together 1/8. */
static const float WEIGHTS[2 * REACH + 1] = {0.0625f, 0.125f, 0.125f, 0.125f, 0.125f,
                                             0.125f,  0.125f, 0.125f, 0.0625f};

/* The part of the directions that a pixel of a square of 8 x 8 traces: neighbors have parts that are far apart. */
static uint32_t part_of(uint32_t x, uint32_t y)
{
    static const uint8_t squares[2][2] = {{0, 2}, {3, 1}}; /* Bayer 1973 */
    return 4 * interleave_part(x, y) + squares[y / INTERLEAVE_SIDE % 2][x / INTERLEAVE_SIDE % 2];
}

/* Where rays start. */
typedef struct sky_point {
    vec3 P;      /* m, off the surface by the rounding error of the intersection */
    vec3 N;      /* unit, smooth, without normal map */
    vec3 facing; /* unit normal of the triangle on the side of the eye */
} sky_point;

typedef struct ambient_pixel {
    vec3 P, N;
    float openness;
    bool is_known;
} ambient_pixel;

struct ambient_tile {
    const ambient_sampler *sampler;
    uint32_t left, top, side; /* with the margin */
    bool has_left, has_top;   /* margins, which an image has not at its border */
    ambient_pixel pixels[];   /* side * side */
};

void ambient_sampler_init(ambient_sampler *sampler, const shading_scene *scene,
                          const visibility_pattern *middle)
{
    *sampler = (ambient_sampler){.scene = scene, .middle = middle, .rays = RAYS[scene->quality]};
    for (uint32_t i = 0; i < AMBIENT_PARTS * sampler->rays; i++)
        sampler->directions[i] = sample_cosine(sobol_scrambled(i, 0x7a5c91e3u));
}

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

/* The share of count directions from first on in which the sky is visible. Those below the triangle, which a smooth
 * normal that leans away from it brings, do not count. */
static float openness_at(const ambient_sampler *a, const sky_point *p, uint32_t first, uint32_t count,
                         uint64_t *rays)
{
    static const ray_spread still = {.moves = false, .turns = false};
    mat3 frame = basis_from_normal(p->N);
    float open = 0.0f;
    float total = 0.0f;
    shading_ray ray = {.far_t = INFINITY, .spread = &still};
    store3(p->P, ray.origin);
    for (uint32_t i = first; i < first + count; i++) {
        vec3 L = mul(frame, a->directions[i]);
        if (!(dot(L, p->facing) > 0.0f))
            continue;
        store3(L, ray.direction);
        open += ray_trace_daylight(a->scene, &ray);
        total += 1.0f;
    }
    *rays += (uint64_t)total;
    return total > 0.0f ? open / total : 1.0f;
}

/* ---- a tile ---- */

static void fill_pixel(const ambient_sampler *a, uint32_t x, uint32_t y, const visibility_hit *hit,
                       ambient_pixel *out, uint64_t *rays)
{
    *out = (ambient_pixel){.is_known = is_kept(a->scene, hit)};
    if (!out->is_known)
        return;
    shading_ray ray = shading_ray_of_camera(a->scene->camera, &a->scene->camera_spread, (float)x + 0.5f,
                                            (float)y + 0.5f, 1.0f);
    shading_point point = {.hit = hit, .ray = &ray, .x = x, .y = y, .shade_count = 1};
    shading_hit h = shading_hit_make(a->scene, &point);
    sky_point p = point_on(&h, hit, surface_sees_front(h.geometry, hit, h.direction));
    out->P = p.P;
    out->N = p.N;
    out->openness = openness_at(a, &p, part_of(x, y) * a->rays, a->rays, rays);
}

/* Pixels of the margin that the filter does not reach stay unknown. */
static bool is_read(const ambient_tile *t, uint32_t column, uint32_t row)
{
    const uint32_t unread = MARGIN - REACH;
    return column >= (t->has_left ? unread : 0) && row >= (t->has_top ? unread : 0) &&
           column < t->side - unread && row < t->side - unread;
}

static void fill_block(ambient_tile *t, uint32_t column, uint32_t row, uint64_t *rays)
{
    const ambient_sampler *a = t->sampler;
    visibility_hit hits[VISIBILITY_BLOCK_PIXELS];
    visibility_trace_block(a->scene->rays, a->scene->camera, t->left + column, t->top + row, a->middle, hits);
    *rays += VISIBILITY_BLOCK_PIXELS;
    for (uint32_t i = 0; i < VISIBILITY_BLOCK_PIXELS; i++) {
        uint32_t dx = column + i % VISIBILITY_BLOCK;
        uint32_t dy = row + i / VISIBILITY_BLOCK;
        if (is_read(t, dx, dy))
            fill_pixel(a, t->left + dx, t->top + dy, &hits[visibility_first_hit(a->middle, i)],
                       &t->pixels[dy * t->side + dx], rays);
    }
}

ambient_tile *ambient_tile_create(const ambient_sampler *sampler, uint32_t left, uint32_t top, uint32_t size,
                                  const facet_allocator *allocator, uint64_t *rays)
{
    const uint32_t side = size + 2 * MARGIN;
    ambient_tile *t = mem_zalloc(allocator, 1, sizeof *t + (size_t)side * side * sizeof t->pixels[0]);
    if (!t)
        return NULL;
    t->sampler = sampler;
    t->side = side;
    t->has_left = left >= MARGIN;
    t->has_top = top >= MARGIN;
    t->left = t->has_left ? left - MARGIN : 0;
    t->top = t->has_top ? top - MARGIN : 0;
    for (uint32_t row = 0; row < side; row += VISIBILITY_BLOCK)
        for (uint32_t column = 0; column < side; column += VISIBILITY_BLOCK)
            fill_block(t, column, row, rays);
    return t;
}

void ambient_tile_destroy(ambient_tile *tile)
{
    mem_free(tile);
}

/* ---- a surface ---- */

/* The pixel beside (x, y) of the image; NULL: not known. */
static const ambient_pixel *pixel_beside(const ambient_tile *t, uint32_t x, uint32_t y, int dx, int dy)
{
    int64_t column = (int64_t)x - t->left + dx;
    int64_t row = (int64_t)y - t->top + dy;
    if (column < 0 || row < 0 || column >= t->side || row >= t->side)
        return NULL;
    const ambient_pixel *q = &t->pixels[(size_t)row * t->side + (size_t)column];
    return q->is_known ? q : NULL;
}

/* How much a pixel's point belongs to the surface of p: within two pixels of its plane, and turned alike. */
static float likeness(const sky_point *p, const ambient_pixel *q, float pixel_size_m)
{
    float off_plane = abs(dot(p->N, q->P - p->P));
    return max(2.0f * dot(p->N, q->N) - 1.0f, 0.0f) * max(1.0f - off_plane / (2.0f * pixel_size_m), 0.0f);
}

/* Below, too few pixels around show the surface, and it has rays of its own. */
static const float LEAST_WEIGHT = 0.2f;

static float filtered_openness(const ambient_tile *t, const shading_point *point, const sky_point *p,
                               uint64_t *rays)
{
    const ambient_sampler *a = t->sampler;
    float size = camera_rays_pixel_size(a->scene->camera, point->hit->t);
    float sum = 0.0f;
    float total = 0.0f;
    for (int dy = -REACH; dy <= REACH; dy++)
        for (int dx = -REACH; dx <= REACH; dx++) {
            const ambient_pixel *q = pixel_beside(t, point->x, point->y, dx, dy);
            if (!q)
                continue;
            float w = WEIGHTS[dx + REACH] * WEIGHTS[dy + REACH] * likeness(p, q, size);
            sum += w * q->openness;
            total += w;
        }
    return total > LEAST_WEIGHT ? sum / total : openness_at(a, p, 0, 8 * a->rays, rays);
}

vec3 ambient_factor(const ambient_tile *tile, const shading_point *point, const surface_point *s,
                    uint64_t *rays)
{
    const render_geometry *g = s->hit.geometry;
    if (!s->is_lit || g->primitive->mode != SCENE_TRIANGLES || (s->m.layers & LAYER_TRANSMISSION))
        return vec3(1.0f);
    sky_point p = point_on(&s->hit, point->hit, s->is_front);
    float openness = filtered_openness(tile, point, &p, rays);
    vec3 albedo = s->m.base.base_color * (1.0f - s->m.base.metallic);
    vec3 factor = ambient_interreflection(openness, clamp(albedo, vec3(0.0f), vec3(1.0f)));
    return min(factor / max(s->m.base.occlusion, 1e-6f), vec3(1.0f));
}
