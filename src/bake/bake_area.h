/* bake_area.h - exact means of a panorama over the texels of a cube map, and sharp levels made of them.
 *
 * By Green's theorem the integral of radiance over a texel is one along its border: of G(phi, h) dphi, where
 * h = cos(theta) (solid angle is dphi dh) and G is the integral of radiance above h on that meridian,
 * precomputed down each column of the panorama. Edges of texels are arcs of great circles, tan(latitude) = T
 * cos(phi - phi0), along which the integral has a closed form between crossings with the edges of the
 * panorama's texels. Neighbours share edges, so no energy is lost at any size (as in first-order conservative
 * remapping, Jones 1999, on grids that fit). */
#ifndef BAKE_BAKE_AREA_H
#define BAKE_BAKE_AREA_H

#include "facet/facet.h"
#include "bake/bake_source.h"
#include "ibl/cube.h"
#include "image/image.h"

/* Column sums of a panorama (F32 RGB). */
typedef struct bake_area {
    const image *panorama;
    uint32_t step;              /* rows between sums */
    double (*sums)[3];          /* [row / step][column]: radiance times height in h of the texels above */
    double (*totals)[3];        /* [column]: of whole columns */
    double *heights, *tangents; /* [row]: h and tan(latitude) of its upper edge; one more than rows */
    double *cosines, *sines;    /* [column]: of phi of its left edge; one more than columns */
    double rotation_rad;        /* from directions of the cube map to those of the panorama */
} bake_area;

/* FACET_ERROR_MEMORY. panorama is referenced, not copied. */
facet_result bake_area_create(const image *panorama, double rotation_rad, const facet_allocator *allocator,
                              uint32_t thread_count, bake_area *out, facet_error *error);
void bake_area_destroy(bake_area *a); /* {0} is allowed; leaves {0} */

/* Fills the faces of out and their borders. is_equiangular: edges of texels are at equal angles,
 * s = tan(pi / 4 (2 i / size - 1)), rather than at s = 2 i / size - 1. */
void bake_area_fill(const bake_area *a, bool is_equiangular, float scale, uint32_t thread_count, cube *out);

/* ---- sharp levels ---- */

/* Fills out, whose size is set, and its borders as bake.h defines sharp levels. FACET_ERROR_MEMORY. */
facet_result bake_sharp(const bake_source *source, float scale, const facet_allocator *allocator,
                        uint32_t thread_count, cube *out, facet_error *error);

/* Whether texels are smaller than those of the panorama, so that radiance is interpolated. */
bool bake_sharp_is_interpolated(const bake_source *source, uint32_t size);

#endif
