/* waves_reading.h - many places near each other, read alike: levels, shares and patches of all tiles are those of one of them. */
#ifndef OCEAN_WAVES_READING_H
#define OCEAN_WAVES_READING_H

#include "ocean/wave_patches.h"

/* How a footprint reads a tile around a place. */
typedef struct wave_tile_reading {
    const wave_tile *tile;
    uint32_t level;
    float mix;    /* of the next level, [0, 1) */
    float cubic;  /* its share of level 0, [0, 1] */
    float weight; /* of a patch; 1 */
    float u, v;   /* the place in samples of level 0, [0, 2 size] */
} wave_tile_reading;

/* Tiles with the longest first, each once per patch. */
typedef struct waves_reading {
    const waves *w;
    wave_tile_reading tiles[WAVES_MAX_TILES * WAVES_MAX_PATCHES];
    uint32_t ends[WAVES_MAX_TILES]; /* of what each tile has */
    uint32_t count, tile_count;
} waves_reading;

/* Around (x, z). What is read from it is some footprints away at most. */
waves_reading waves_reading_of(const waves *w, double x, double z, float footprint_m);

/* As waves_height_near() of the place `offset` m from there, by two steps: what displacement is off by shrinks twenty times. */
float waves_reading_height(const waves_reading *r, const float offset[2], float displacement[2]);

/* Of water at rest `back` m before there: -offset, or the displacement of the water that is there. As waves_at(). */
wave_point waves_reading_point(const waves_reading *r, const float back[2]);

#endif
