/* ambient_occlusion.h - the share of the environment's diffuse light that reaches a surface past the model, for the
 * preview: FACET_AMBIENT_OCCLUSION_ON.
 *
 * The openness of a point is the cosine-weighted share of its hemisphere in which no surface blocks rays, however far
 * away. Glass lets light pass. Surfaces around reflect: see ambient_interreflection() of shade/ibl.h. The occlusion of
 * a texture and this one describe the same, so that the darker of both counts. */
#ifndef CPU_AMBIENT_OCCLUSION_H
#define CPU_AMBIENT_OCCLUSION_H

#include "cpu/interleave.h"
#include "cpu/surface_point.h"
#include "cpu/visibility.h"

enum { AMBIENT_PARTS = 4 * INTERLEAVE_PARTS, AMBIENT_MOST_RAYS = 8 };

/* What all tiles of an image share. */
typedef struct ambient_sampler {
    const shading_scene *scene;
    const visibility_pattern *middle;                   /* one sample per pixel */
    uint32_t rays;                                      /* per pixel; a power of two */
    vec3 directions[AMBIENT_PARTS * AMBIENT_MOST_RAYS]; /* around +Z, distributed as the cosine */
} ambient_sampler;

void ambient_sampler_init(ambient_sampler *sampler, const shading_scene *scene,
                          const visibility_pattern *middle);

/* The openness of the first hits of a tile and around it. */
typedef struct ambient_tile ambient_tile;

/* Traces the rays of the tile of size * size pixels, a multiple of VISIBILITY_BLOCK, at (left, top) of the whole image.
 * The values do not depend on what else is rendered. Adds to *rays. NULL: no memory. */
ambient_tile *ambient_tile_create(const ambient_sampler *sampler, uint32_t left, uint32_t top, uint32_t size,
                                  const facet_allocator *allocator, uint64_t *rays);
void ambient_tile_destroy(ambient_tile *tile); /* NULL is allowed */

/* The factor of the environment's diffuse light at a surface of the tile, before the occlusion of its texture. Traces
 * rays where the tile has no point of the same surface near by; adds to *rays. */
vec3 ambient_factor(const ambient_tile *tile, const shading_point *point, const surface_point *s,
                    uint64_t *rays);

#endif
