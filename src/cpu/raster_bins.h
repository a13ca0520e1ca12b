/* raster_bins.h - what raster.c sorts and raster_tile.c reads. */
#ifndef CPU_RASTER_BINS_H
#define CPU_RASTER_BINS_H

#include "cpu/raster.h"

/* Pixels that a triangle may cover, both ends included; x0 > x1: none. */
typedef struct raster_bounds {
    uint16_t x0, y0, x1, y1;
} raster_bounds;

/* Triangles are numbered through all geometries. */
struct raster {
    const render_geometry_set *geometries;
    const camera_rays *camera;
    bool is_final;
    uint32_t tile_columns, tile_rows;
    uint32_t *first_triangles; /* per geometry, and the number of all */
    raster_bounds *bounds;     /* per triangle */
    uint32_t *tile_starts;     /* per tile, and the end: into entries */
    uint32_t *entries;         /* triangle numbers, ascending in each tile */
};

/* The geometry of a triangle; from: a geometry at or before it. */
static inline uint32_t raster_geometry_of(const raster *r, uint32_t triangle, uint32_t from)
{
    while (r->first_triangles[from + 1] <= triangle)
        from++;
    return from;
}

/* A triangle as the test of rays reads it, relative to the camera's position. */
typedef struct raster_triangle {
    float corners[3][3];
    float edges[3][3]; /* the edge against corner 1, 2 and 0 */
    float normal[3];   /* of any length, outward for counter-clockwise triangles */
    float plane;       /* twice the product of normal and corner 0: negative where the outside is seen */
} raster_triangle;

void raster_triangle_set(const render_geometry *g, uint32_t triangle, const float origin[3],
                         raster_triangle *out);
/* Whether only its other side faces the camera, and is not drawn. */
bool raster_triangle_is_culled(const render_geometry *g, const raster_triangle *triangle);

#endif
