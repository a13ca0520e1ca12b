/* caustic_map.h - how bright waves make the sun's beam on the bed: its irradiance over its mean, as layers around one another, each
 * wider and coarser than the one before. Whoever draws a sea fills them (water/water_caustics.h). */
#ifndef OCEAN_CAUSTIC_MAP_H
#define OCEAN_CAUSTIC_MAP_H

#include "facet/facet.h"

enum { CAUSTIC_LAYERS = 3, CAUSTIC_MIPS = 10, CAUSTIC_SIZE = 1 << (CAUSTIC_MIPS - 1), CAUSTIC_WIDER = 2 };

/* A square of the bed, seen from above. */
typedef struct caustic_layer {
    double middle[2]; /* X, Z in the world, m */
    float texel_m;
    float *mips[CAUSTIC_MIPS]; /* CAUSTIC_SIZE >> mip texels along an edge; rows go along the second axis */
} caustic_layer;

/* Axes of all: (axis[0], axis[1]) and (-axis[1], axis[0]) in X, Z. */
typedef struct caustic_map {
    bool is_there; /* else the bed is lit evenly */
    float axis[2];
    /* the finest first, each CAUSTIC_WIDER times as wide as the one before */
    caustic_layer layers[CAUSTIC_LAYERS];
} caustic_map;

/* Layers without contents. FACET_ERROR_MEMORY; what is there is to be destroyed, even then. */
facet_result caustic_map_create(const facet_allocator *allocator, caustic_map *map, facet_error *error);
void caustic_map_destroy(caustic_map *map); /* {0} is allowed */

/* Makes a layer's mips, means of 2 x 2, of its first. */
void caustic_layer_reduce(caustic_layer *layer);

/* The factor, >= 0, over a footprint (m) around (X, Z): 1 on average, and 1 beyond all layers. */
float caustic_map_at(const caustic_map *map, double X, double Z, float footprint_m);
/* Of layers only, weighted by their cover; *beyond: share that none of them has, [0, 1]. */
float caustic_map_within(const caustic_map *map, double X, double Z, float footprint_m, float *beyond);

#endif
