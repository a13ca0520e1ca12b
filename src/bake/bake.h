/* bake.h - a facet_cube: an environment filtered for real-time renderers, and what is made of it. */
#ifndef BAKE_BAKE_H
#define BAKE_BAKE_H

#include "facet/facet.h"
#include "ibl/cube.h"
#include "image/image.h"

struct facet_cube {
    facet_allocator allocator;
    facet_lobe lobe;
    uint32_t level_count;
    cube levels[FACET_CUBE_MAX_LEVELS];
    float roughness[FACET_CUBE_MAX_LEVELS]; /* perceptual */
    facet_bake_stats stats;
};

/* The perceptual roughness of a level. */
float bake_roughness(facet_roughness_mapping mapping, uint32_t level, uint32_t level_count);

/* A table of reflectance: F32, facet_dfg_get_channel_count() channels. FACET_ERROR_ARGUMENT, _MEMORY, _CANCELLED. */
facet_result bake_dfg(const facet_dfg_desc *desc, image *out, facet_error *error);

/* A picture (F32, 1 to 4 channels) as a KTX2 file of one level. */
facet_result bake_image_ktx2(const image *picture, const facet_ktx2_desc *desc, unsigned char **bytes,
                             size_t *size, facet_error *error);

#endif
