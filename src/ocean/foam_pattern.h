/* foam_pattern.h - fields that foam lies along, which repeat: numbers of a normal distribution of variance 1, the same for every sea.
 * Foam of a share covers where a field is above the number that this share of it exceeds. */
#ifndef OCEAN_FOAM_PATTERN_H
#define OCEAN_FOAM_PATTERN_H

#include "ocean/foam_plane.h"

/* Highest on borders of cells of many sizes and lowest in their middles: holes open in the middles, borders get thin and break last. A cell
 * is some FOAM_CELL_SAMPLES wide. */
enum { FOAM_CELL_SAMPLES = 16 };
void foam_pattern_cells(foam_plane *p, uint32_t thread_count);
/* Clouds of all sizes from a quarter of the plane down. */
void foam_pattern_clouds(foam_plane *p, uint32_t thread_count);

#endif
