/* bake.h - a facet_cube: an environment filtered for real-time renderers.
 *
 * Definition of a texel, the same for every method:
 * - A texel of the source has one radiance over its solid angle; the whole sphere is covered once.
 * - A texel of a level with a lobe is the mean of that radiance, weighted with the lobe around the direction
 *   of the texel's center (cube.h): a function of direction alone, so faces are continuous across edges and
 *   corners without copying or moving texels. Readers interpolate across edges (seamless cube maps).
 * - A texel of a sharp level (GGX of roughness 0, or no lobe) is the mean of the radiance over its solid angle.
 *   Where texels are smaller than those of an equirectangular source, radiance is interpolated between the
 *   centers of the source's texels and scaled so that the mean stays the same. A source that was a cube map
 *   is copied if its faces have the same size and are not rotated, and averaged by solid angle if their size
 *   is a multiple.
 * - Energy is preserved: at every level the mean over the sphere, weighted by solid angle, is that of the
 *   source, within the accuracy of a sum over few texels.
 * - For Charlie, roughness below BAKE_CHARLIE_MIN is clamped to it, as in the renderer: at 0 the lobe would
 *   be a circle. */
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

/* Whether the level is sharp, see above. */
bool bake_level_is_sharp(const facet_cube *c, uint32_t level);

/* A LUT of directional albedo: F32, facet_dfg_get_channel_count() channels. FACET_ERROR_ARGUMENT, _MEMORY,
 * _CANCELLED. */
facet_result bake_dfg(const facet_dfg_desc *desc, image *out, facet_error *error);

/* An image (F32, 1 to 4 channels) as a KTX2 file of one level. */
facet_result bake_image_ktx2(const image *panorama, const facet_ktx2_desc *desc, unsigned char **bytes,
                             size_t *size, facet_error *error);

#endif
