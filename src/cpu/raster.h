/* raster.h - the first hits of a perspective camera's rays by rasterisation: the triangles are tested against the
 * rays near them, without a bounding volume hierarchy.
 *
 * The hits are those of ray tracing: the same robust test of a ray and a triangle (Embree's, after Plücker
 * coordinates; Davidovic et al. 2012, "3D Rasterization: A Bridge between Rasterization and Ray Casting"), the
 * nearest hit. Of hits at equal distances the first triangle's counts. */
#ifndef CPU_RASTER_H
#define CPU_RASTER_H

#include "cpu/visibility.h"

/* Side of a tile, pixels; tiles are aligned to multiples of it in the whole image. */
enum { RASTER_TILE = 32, RASTER_TILE_BLOCKS = RASTER_TILE / VISIBILITY_BLOCK };

typedef struct raster_desc {
    const render_geometry_set *geometries; /* with their vertices; they outlive the raster */
    const camera_rays *camera;             /* outlives it */
    uint32_t width, height;                /* of the whole image */
    uint32_t sample_count;                 /* per pixel */
    uint32_t thread_count;
    bool needs_hierarchy; /* other rays are traced as well */
} raster_desc;

/* Which triangles may be seen in which tile. */
typedef struct raster raster;

/* *out is NULL where tracing rays is cheaper, or the only way: instances, points and lines, orthographic cameras.
 * Depends on desc alone but for thread_count. Fails with FACET_ERROR_MEMORY. */
facet_result raster_create(const raster_desc *desc, const facet_allocator *allocator, raster **out,
                           facet_error *error);
/* Whether all that rays do is to end at the hits: none is on the invisible side of a surface. */
bool raster_is_final(const raster *r);
void raster_destroy(raster *r); /* NULL is allowed */

/* The hits of a tile. */
typedef struct raster_tile raster_tile;

/* Hits of the tile whose top left pixel is (x, y), of one side only where a surface is not double-sided, opaque, and
 * no boundary of glass. NULL: no memory. */
raster_tile *raster_tile_create(const raster *r, const visibility_pattern *pattern, uint32_t x, uint32_t y,
                                const facet_allocator *allocator);
/* Hits of a block of the tile, as visibility_trace_block() has them; blocks are numbered in rows. */
void raster_tile_read(const raster_tile *tile, uint32_t block, visibility_hit *hits);
/* Whether count samples of that block from number first on hit one triangle or nothing; if so, hit is the mean of
 * their hits, or VISIBILITY_NONE. */
bool raster_tile_read_one(const raster_tile *tile, uint32_t block, size_t first, uint32_t count,
                          visibility_hit *hit);
void raster_tile_destroy(raster_tile *tile); /* NULL is allowed */

#endif
