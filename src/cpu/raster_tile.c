/* raster_tile.c - see raster.h: the hits of a tile, eight rays at a time. */
#include <float.h>
#include <string.h>

#include "base/memory.h"
#include "base/simd.h"
#include "cpu/raster_bins.h"

typedef int32_t int8x __attribute__((vector_size(32), may_alias));

enum {
    LANES = 8,
    VECTORS_MOST = VISIBILITY_BLOCK_PIXELS * 64 / LANES /* of a block with 64 samples per pixel */
};

/* A triangle as the loop over rays reads it. The edge functions and the normal's product are linear in the ray's
 * direction. */
typedef struct tile_triangle {
    float edges
        [3]
        [3]; /* zero in the plane through the camera and an edge: of the corners 2 and 0, 0 and 1, 1 and 2 */
    float normal[3], plane;
    uint32_t geometry, primitive;
    raster_bounds bounds;
} tile_triangle;

/* Pixels of eight rays, from the block's top left; both ends included. */
typedef struct vector_extent {
    uint16_t x0, y0, x1, y1;
} vector_extent;

/* Values are per ray: blocks in rows, and the rays of a block in the order of the pattern. */
struct raster_tile {
    uint32_t x, y; /* top left pixel */
    uint32_t rays_per_block;
    float near_t;
    float *direction[3];
    float *t, *u, *v;
    int32_t *index; /* of the triangle; -1: no hit */
    tile_triangle *triangles;
    vector_extent extents[VECTORS_MOST]; /* of the vectors of a block */
};

/* ---- the test of rays and a triangle ---- */

#define INLINE static inline __attribute__((always_inline))

/* Pointers, since the calling convention of vectors depends on the instruction set. */

INLINE void dot8(const float a[3], const float8 b[3], float8 *out)
{
    *out = a[0] * b[0] + (a[1] * b[1] + a[2] * b[2]);
}

INLINE void choose8(const int8x *mask, const float8 *a, const float8 *b, float8 *out)
{
    *out = (float8)((*mask & (int8x)*a) | (~*mask & (int8x)*b));
}

INLINE bool has_any(const int8x *mask)
{
    typedef int64_t int4x __attribute__((vector_size(32), may_alias));
    const int4x m = (int4x)*mask;
    return (m[0] | m[1] | m[2] | m[3]) != 0;
}

/* A weight from its edge function: at most 1 in spite of rounding. */
INLINE void keep_weight(const int8x *hits, const float8 *edge, const float8 *scale, float *out)
{
    const float8 one = {1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f};
    float8 weight = *edge * *scale, *kept = (float8 *)out;
    const int8x is_below = weight < one;
    choose8(&is_below, &weight, &one, &weight);
    choose8(hits, &weight, kept, kept);
}

/* Tests the eight rays from first on, and keeps the hits that are nearer than those so far. */
INLINE void test_rays(raster_tile *tile, const tile_triangle *triangle, int32_t number, size_t first)
{
    const float8 d[3] = {*(const float8 *)(tile->direction[0] + first),
                         *(const float8 *)(tile->direction[1] + first),
                         *(const float8 *)(tile->direction[2] + first)};
    const float8 zero = {0.0f};
    float8 u, v, w, divisor;
    dot8(triangle->edges[0], d, &u);
    dot8(triangle->edges[1], d, &v);
    dot8(triangle->edges[2], d, &w);
    const float8 sum = u + v + w;
    const float8 size = (float8)((int8x)sum & 0x7fffffff);
    const float8 slack = size * FLT_EPSILON; /* no ray passes between two triangles */
    int8x hits =
        ((u >= -slack) & (v >= -slack) & (w >= -slack)) | ((u <= slack) & (v <= slack) & (w <= slack));
    if (!has_any(&hits))
        return;
    float8 *nearest = (float8 *)(tile->t + first);
    dot8(triangle->normal, d, &divisor);
    divisor *= 2.0f;
    const float8 t = triangle->plane / divisor;
    hits &= (t >= tile->near_t) & (t < *nearest) & (divisor != zero);
    if (!has_any(&hits))
        return;
    float8 scale = 1.0f / sum;
    const int8x is_degenerate = size < FLT_MIN;
    choose8(&is_degenerate, &zero, &scale, &scale);
    choose8(&hits, &t, nearest, nearest);
    keep_weight(&hits, &u, &scale, tile->u + first);
    keep_weight(&hits, &v, &scale, tile->v + first);
    int8x *kept = (int8x *)(tile->index + first);
    *kept = (hits & number) | (~hits & *kept);
}

/* ---- a tile ---- */

INLINE uint32_t clamp_to_tile(uint32_t pixel, uint32_t start)
{
    const uint32_t from_start = pixel > start ? pixel - start : 0;
    return from_start < RASTER_TILE ? from_start : RASTER_TILE - 1;
}

/* Tests the rays in the bounds of a triangle that overlap the tile. */
INLINE void cover(raster_tile *tile, const tile_triangle *triangle, int32_t number)
{
    const uint32_t x0 = clamp_to_tile(triangle->bounds.x0, tile->x),
                   x1 = clamp_to_tile(triangle->bounds.x1, tile->x);
    const uint32_t y0 = clamp_to_tile(triangle->bounds.y0, tile->y),
                   y1 = clamp_to_tile(triangle->bounds.y1, tile->y);
    const uint32_t vector_count = tile->rays_per_block / LANES;
    for (uint32_t by = y0 / VISIBILITY_BLOCK; by <= y1 / VISIBILITY_BLOCK; by++)
        for (uint32_t bx = x0 / VISIBILITY_BLOCK; bx <= x1 / VISIBILITY_BLOCK; bx++) {
            const size_t first = (size_t)(by * RASTER_TILE_BLOCKS + bx) * tile->rays_per_block;
            const uint32_t left = bx * VISIBILITY_BLOCK, top = by * VISIBILITY_BLOCK;
            for (uint32_t i = 0; i < vector_count; i++) {
                const vector_extent e = tile->extents[i];
                if (left + e.x0 <= x1 && left + e.x1 >= x0 && top + e.y0 <= y1 && top + e.y1 >= y0)
                    test_rays(tile, triangle, number, first + (size_t)i * LANES);
            }
        }
}

DISPATCH_AVX2 static void raster_tile_cover(raster_tile *tile, size_t triangle_count)
{
    for (size_t i = 0; i < triangle_count; i++)
        cover(tile, &tile->triangles[i], (int32_t)i);
}

/* The directions of fill_packet() in visibility.c. */
DISPATCH_AVX2 static void raster_tile_aim(raster_tile *tile, const camera_rays *camera,
                                          const visibility_pattern *pattern)
{
    const size_t n = tile->rays_per_block;
    for (uint32_t block = 0; block < RASTER_TILE_BLOCKS * RASTER_TILE_BLOCKS; block++) {
        const float left = (float)(tile->x + block % RASTER_TILE_BLOCKS * VISIBILITY_BLOCK);
        const float top = (float)(tile->y + block / RASTER_TILE_BLOCKS * VISIBILITY_BLOCK);
        for (int axis = 0; axis < 3; axis++) {
            float *restrict out = tile->direction[axis] + block * n;
            for (size_t i = 0; i < n; i++)
                out[i] = camera->direction[axis] +
                         (left + pattern->offset_x[i] - camera->middle[0]) * camera->direction_dx[axis] +
                         (top + pattern->offset_y[i] - camera->middle[1]) * camera->direction_dy[axis];
        }
    }
}

static void measure_vectors(raster_tile *tile, const visibility_pattern *pattern)
{
    for (uint32_t i = 0; i < tile->rays_per_block; i++) {
        vector_extent *e = &tile->extents[i / LANES];
        const uint16_t x = (uint16_t)pattern->offset_x[i], y = (uint16_t)pattern->offset_y[i];
        if (i % LANES == 0)
            *e = (vector_extent){x, y, x, y};
        e->x0 = x < e->x0 ? x : e->x0;
        e->y0 = y < e->y0 ? y : e->y0;
        e->x1 = x > e->x1 ? x : e->x1;
        e->y1 = y > e->y1 ? y : e->y1;
    }
}

/* cross(edge, sum of its corners) */
static void set_edge(const raster_triangle *t, int edge, int from, int to, float out[3])
{
    const float *e = t->edges[edge];
    float s[3];
    for (int i = 0; i < 3; i++)
        s[i] = t->corners[from][i] + t->corners[to][i];
    for (int i = 0; i < 3; i++) {
        const int y = (i + 1) % 3, z = (i + 2) % 3;
        out[i] = e[y] * s[z] - e[z] * s[y];
    }
}

static void set_triangle(const raster *r, uint32_t number, uint32_t geometry, tile_triangle *out)
{
    raster_triangle t;
    *out = (tile_triangle){.geometry = geometry,
                           .primitive = number - r->first_triangles[geometry],
                           .bounds = r->bounds[number]};
    raster_triangle_set(&r->geometries->items[geometry], out->primitive, r->camera->origin, &t);
    for (int i = 0; i < 3; i++) {
        set_edge(&t, i, i, (i + 2) % 3, out->edges[i]);
        out->normal[i] = t.normal[i];
    }
    out->plane = t.plane;
}

raster_tile *raster_tile_create(const raster *r, const visibility_pattern *pattern, uint32_t x, uint32_t y,
                                const facet_allocator *allocator)
{
    const size_t number = y / RASTER_TILE * r->tile_columns + x / RASTER_TILE;
    const uint32_t *entries = r->entries + r->tile_starts[number];
    const size_t count = r->tile_starts[number + 1] - r->tile_starts[number];
    const uint32_t rays_per_block = VISIBILITY_BLOCK_PIXELS * pattern->sample_count;
    const size_t ray_count = (size_t)rays_per_block * RASTER_TILE_BLOCKS * RASTER_TILE_BLOCKS;
    enum { VALUES = 7 };
    const size_t head = (sizeof(raster_tile) + 63) & ~(size_t)63;
    raster_tile *tile =
        mem_alloc(allocator, 1, head + ray_count * VALUES * sizeof(float) + count * sizeof(tile_triangle));
    if (!tile)
        return NULL;
    float *values = (float *)(void *)((unsigned char *)tile + head);
    tile->x = x;
    tile->y = y;
    tile->rays_per_block = rays_per_block;
    tile->near_t = r->camera->near_m;
    for (int axis = 0; axis < 3; axis++)
        tile->direction[axis] = values + (size_t)axis * ray_count;
    tile->t = values + 3 * ray_count;
    tile->u = values + 4 * ray_count;
    tile->v = values + 5 * ray_count;
    tile->index = (int32_t *)(void *)(values + 6 * ray_count);
    tile->triangles = (tile_triangle *)(void *)(values + VALUES * ray_count);
    memset(tile->index, 0xff, ray_count * sizeof *tile->index);
    if (count == 0)
        return tile;
    for (size_t i = 0; i < ray_count; i++)
        tile->t[i] = r->camera->far_m;
    measure_vectors(tile, pattern);
    raster_tile_aim(tile, r->camera, pattern);
    uint32_t geometry = 0;
    for (size_t i = 0; i < count; i++) {
        geometry = raster_geometry_of(r, entries[i], geometry);
        set_triangle(r, entries[i], geometry, &tile->triangles[i]);
    }
    raster_tile_cover(tile, count);
    return tile;
}

/* The triangle of a hit, without where it is. */
static visibility_hit hit_of(const tile_triangle *triangle)
{
    visibility_hit hit = {.geometry = triangle->geometry, .primitive = triangle->primitive};
    memcpy(hit.normal, triangle->normal, sizeof triangle->normal);
    return hit;
}

void raster_tile_read(const raster_tile *tile, uint32_t block, visibility_hit *hits)
{
    const size_t first = (size_t)block * tile->rays_per_block;
    for (size_t i = 0; i < tile->rays_per_block; i++) {
        const int32_t index = tile->index[first + i];
        if (index < 0) {
            hits[i].geometry = VISIBILITY_NONE;
            continue;
        }
        hits[i] = hit_of(&tile->triangles[index]);
        hits[i].t = tile->t[first + i];
        hits[i].u = tile->u[first + i];
        hits[i].v = tile->v[first + i];
    }
}

bool raster_tile_read_one(const raster_tile *tile, uint32_t block, size_t first, uint32_t count,
                          visibility_hit *hit)
{
    const size_t begin = (size_t)block * tile->rays_per_block + first;
    const int32_t index = tile->index[begin];
    for (size_t i = begin + 1; i < begin + count; i++)
        if (tile->index[i] != index)
            return false;
    hit->geometry = VISIBILITY_NONE;
    if (index < 0)
        return true;
    float t = 0.0f, u = 0.0f, v = 0.0f;
    for (size_t i = begin; i < begin + count; i++) {
        t += tile->t[i];
        u += tile->u[i];
        v += tile->v[i];
    }
    *hit = hit_of(&tile->triangles[index]);
    hit->t = t / (float)count;
    hit->u = u / (float)count;
    hit->v = v / (float)count;
    return true;
}

void raster_tile_destroy(raster_tile *tile)
{
    mem_free(tile);
}
