/* foam_plane.h - a field of one number per texel that repeats, read as wide as a footprint is. */
#ifndef OCEAN_FOAM_PLANE_H
#define OCEAN_FOAM_PLANE_H

#include "ocean/waves.h"

typedef struct foam_plane {
    uint32_t size, level_count;      /* 0: none */
    float *levels[WAVES_MAX_LEVELS]; /* means of 2 x 2 */
    float hidden[WAVES_MAX_LEVELS];  /* variance that reading a level loses */
} foam_plane;

/* All 0; size: a power of two. False: no memory; what there is is to be destroyed. */
bool foam_plane_create(const facet_allocator *allocator, uint32_t size, foam_plane *p);
void foam_plane_destroy(foam_plane *p);
/* The other levels and what they hide, from level 0. */
void foam_plane_reduce(foam_plane *p);

typedef struct foam_plane_value {
    float mean, hidden; /* variance within the footprint */
} foam_plane_value;
/* (u, v) in samples; texels: the footprint's width in them. Of the level whose texels are nearest to it in size: as foam is made of the mean and of
 * what is hidden, it is as much of it to either side of where levels change, and no line is seen. */
foam_plane_value foam_plane_read(const foam_plane *p, double u, double v, float texels);

/* foam_lace() and inverse_normal() of the shader library. */
float wave_foam_lace(float share, float mean, float variance);
float wave_inverse_normal(float u);

/* Highest on borders of cells of many sizes and lowest in their middles: holes open in the middles, borders get thin and break last. A cell
 * is some FOAM_CELL_SAMPLES wide. */
enum { FOAM_CELL_SAMPLES = 16 };
void foam_pattern_cells(foam_plane *p, uint32_t thread_count);
/* Clouds of all sizes from a quarter of the plane down. */
void foam_pattern_clouds(foam_plane *p, uint32_t thread_count);

#endif
