/* bake.h - a facet_cube: an environment filtered for real-time renderers, and what is made of it.
 *
 * What a texel is, the same for every method:
 * - A texel of the source is of one radiance all over its solid angle; the whole sphere is covered once.
 * - A texel of a level with a lobe is the lobe's mean of that light around the direction of the texel's middle (cube.h says
 *   where): a function of direction alone, so faces continue one another over edges and corners, and no texel is copied from
 *   a neighbour or moved to an edge. Lookups across edges are the reader's part (seamless cube maps).
 * - A texel of a mirror (GGX of roughness 0, no lobe) is the mean of the light over the texel's solid angle. Where the texels
 *   are smaller than those of an equirectangular source, the light between the middles of these is interpolated, and
 *   scaled by what the interpolation changes of the mean. A source that was a cube map is copied where its faces have the
 *   size and are not turned, and averaged, weighted with solid angles, where they have a multiple of it.
 * - No light is lost: the mean over the sphere, texels weighted with solid angles, is that of the source at every level, as
 *   near as sums over few texels come to it.
 * - Charlie's ring of a roughness below BAKE_CHARLIE_MIN is that one's, as in the renderer: at 0 it would be a circle. */
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

/* Fills in the defaults. FACET_ERROR_ARGUMENT. */
facet_result bake_complete(facet_bake_desc *desc, facet_error *error);

/* A mirror's level: what bake.h calls one. */
bool bake_level_is_sharp(const facet_cube *c, uint32_t level);

/* A table of reflectance: F32, facet_dfg_get_channel_count() channels. FACET_ERROR_ARGUMENT, _MEMORY, _CANCELLED. */
facet_result bake_dfg(const facet_dfg_desc *desc, image *out, facet_error *error);

/* An image (F32, 1 to 4 channels) as a KTX2 file of one level. */
facet_result bake_image_ktx2(const image *panorama, const facet_ktx2_desc *desc, unsigned char **bytes,
                             size_t *size, facet_error *error);

#endif
