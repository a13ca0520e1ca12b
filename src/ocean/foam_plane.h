/* foam_plane.h - a tiling scalar field that is read with a footprint, and the two patterns that foam follows:
 * normally distributed with variance 1, the same for every sea. Foam of a coverage lies where a field exceeds
 * the quantile of that coverage. */
#ifndef OCEAN_FOAM_PLANE_H
#define OCEAN_FOAM_PLANE_H

#include "ocean/waves.h"

typedef struct foam_plane {
    uint32_t size, level_count;      /* 0: none */
    float *levels[WAVES_MAX_LEVELS]; /* means of 2 x 2 */
    float hidden[WAVES_MAX_LEVELS];  /* variance within a texel of a level */
} foam_plane;

/* Zeros; size: a power of two. False: out of memory; to be destroyed even then. */
bool foam_plane_create(const facet_allocator *allocator, uint32_t size, foam_plane *p);
void foam_plane_destroy(foam_plane *p);
/* Computes the other levels and their variance from level 0. */
void foam_plane_reduce(foam_plane *p);

typedef struct foam_plane_value {
    float mean, hidden; /* variance within the footprint */
} foam_plane_value;
/* (u, v) in samples; texels: width of the footprint in samples. The level with the nearest texel size is
 * read without blending: since foam depends on mean and hidden variance, its coverage is the same on both
 * sides of a level change and no seam shows. */
foam_plane_value foam_plane_read(const foam_plane *p, double u, double v, float texels);

/* foam_lace() and inverse_normal() of the shader library. */
float wave_foam_lace(float share, float mean, float variance);
float wave_inverse_normal(float u);

/* Highest on the borders of cells of many sizes and lowest in their centers: holes open in the centers,
 * borders get thin and break last. A cell is about FOAM_CELL_SAMPLES wide. */
enum { FOAM_CELL_SAMPLES = 16 };
void foam_pattern_cells(foam_plane *p, uint32_t thread_count);
/* Clouds of all sizes up to a quarter of the plane. */
void foam_pattern_clouds(foam_plane *p, uint32_t thread_count);

#endif
