/* bake_range.h - light that the numbers of a file cannot hold. */
#ifndef CLI_BAKE_RANGE_H
#define CLI_BAKE_RANGE_H

#include "cli/bake/bake_plan.h"

/* The largest number that a file of light holds; 0: any, or not known. */
float bake_file_limit(const bake_file *file);

/* The share, [0, 1], of a level's light that is above limit, texels weighted by their solid angle. */
double bake_cut_share(const facet_cube *cube, uint32_t level, float limit);

#endif
