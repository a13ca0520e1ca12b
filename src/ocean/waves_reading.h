/* waves_reading.h - lookups at many nearby places that share the levels, blend factors and patches of one of
 * them. */
#ifndef OCEAN_WAVES_READING_H
#define OCEAN_WAVES_READING_H

#include "ocean/wave_patches.h"

/* Lookup of a tile with a footprint around a place. */
typedef struct wave_tile_reading {
    const wave_tile *tile;
    uint32_t level;
    float mix;    /* blend factor of the next level, [0, 1) */
    float cubic;  /* share of cubic interpolation of level 0, [0, 1] */
    float weight; /* of a patch; 1 */
    float u, v;   /* the place in samples of level 0, [0, 2 size] */
} wave_tile_reading;

/* Tiles, the longest first, once per patch. */
typedef struct waves_reading {
    const waves *w;
    wave_tile_reading tiles[WAVES_MAX_TILES * WAVES_MAX_PATCHES];
    uint32_t ends[WAVES_MAX_TILES]; /* end index per tile */
    uint32_t count, tile_count;
} waves_reading;

/* Around (x, z), for lookups at most some footprints away. */
waves_reading waves_reading_of(const waves *w, double x, double z, float footprint_m);

/* As waves_height_near() `offset` m away, in two steps, each of which reduces the displacement's error
 * twentyfold. */
float waves_reading_height(const waves_reading *r, const float offset[2], float displacement[2]);

/* As waves_at() for water at rest `back` m before the place: -offset, or the displacement of the water
 * that is there. */
wave_point waves_reading_point(const waves_reading *r, const float back[2]);

#endif
