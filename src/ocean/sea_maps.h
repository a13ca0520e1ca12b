/* sea_maps.h - a tile of waves as pictures that programs read which sum tiles by themselves. */
#ifndef OCEAN_SEA_MAPS_H
#define OCEAN_SEA_MAPS_H

#include "ocean/sea.h"

/* Of one texel; see facet_sea_create_maps(). */
typedef struct sea_texel {
    float displacement[3]; /* m: along the tile's x, upwards, along its z */
    float normal[3];
    float slope[2];
    float jacobian;
    float foam; /* [0, 1] */
} sea_texel;

/* Variance of the convergence that the other tiles have. */
float sea_others_variance(const facet_sea *sea, uint32_t tile);
/* Texel number (column, row) of a tile that is there, by its waves alone; foam by what the others, with that variance, may add. */
sea_texel sea_texel_of(const facet_sea *sea, uint32_t tile, float others_variance, uint32_t column,
                       uint32_t row);

#endif
