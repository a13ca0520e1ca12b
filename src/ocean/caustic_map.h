/* caustic_map.h - sunlight that waves focus on the bed: irradiance of the beam relative to its mean, in
 * nested layers, each wider and coarser than the previous one. water/water_caustics.h fills them. */
#ifndef OCEAN_CAUSTIC_MAP_H
#define OCEAN_CAUSTIC_MAP_H

#include "facet/facet.h"

enum { CAUSTIC_LAYERS = 3, CAUSTIC_MIPS = 10, CAUSTIC_SIZE = 1 << (CAUSTIC_MIPS - 1), CAUSTIC_WIDER = 2 };

/* A square of the bed, from above. */
typedef struct caustic_layer {
    double middle[2]; /* X, Z in the world, m */
    float texel_m;
    float *mips[CAUSTIC_MIPS]; /* CAUSTIC_SIZE >> mip texels per edge; rows along the second axis */
} caustic_layer;

/* Axes of all layers: (axis[0], axis[1]) and (-axis[1], axis[0]) in X, Z. */
typedef struct caustic_map {
    bool is_there; /* false: the bed is lit evenly */
    float axis[2];
    /* the finest first, each CAUSTIC_WIDER times as wide as the previous one */
    caustic_layer layers[CAUSTIC_LAYERS];
} caustic_map;

/* Allocates the layers. FACET_ERROR_MEMORY; to be destroyed even then. */
facet_result caustic_map_create(const facet_allocator *allocator, caustic_map *map, facet_error *error);
void caustic_map_destroy(caustic_map *map); /* {0} is allowed */

/* Reduces mip 0 to the others by means of 2 x 2. */
void caustic_layer_reduce(caustic_layer *layer);

/* The factor, >= 0, over a footprint (m) around (X, Z): 1 on average, and 1 outside of all layers. */
float caustic_map_at(const caustic_map *map, double X, double Z, float footprint_m);
/* Of the layers alone, weighted by coverage; *beyond: the uncovered share, [0, 1]. */
float caustic_map_within(const caustic_map *map, double X, double Z, float footprint_m, float *beyond);

#endif
