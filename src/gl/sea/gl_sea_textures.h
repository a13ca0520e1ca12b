/* gl_sea_textures.h - the textures that a sea's shaders read: tiles of waves with their means, foam,
 * origins of patches, the sky, the table of means over microfacets, sunlight on the bed. What does not
 * move is uploaded once. */
#ifndef GL_GL_SEA_TEXTURES_H
#define GL_GL_SEA_TEXTURES_H

#include "gl/core/gl_context.h"
#include "gl/sea/gl_sea_block.h"

/* What patches are computed from: for each tile its size (0: it has none), and the rhombus of the eye. */
typedef struct gl_sea_patches {
    uint64_t seed;
    uint32_t sizes[WAVES_MAX_TILES];
    int64_t i[WAVES_MAX_TILES], j[WAVES_MAX_TILES];
} gl_sea_patches;

/* OpenGL's names; 0: not created yet. Floats of 32 bits where the driver filters them, else of 16. */
typedef struct gl_sea_textures {
    uint32_t low, high, foam, patches, sky, lobes, means, caustics;
    uint32_t size, tile_count, foam_size, caustic_size; /* of the existing textures */
    bool has_patterns;                                  /* of foam */
    gl_sea_patches around;
} gl_sea_textures;

/* A new texture, bound to a unit, with its filter (for GL_LINEAR_MIPMAP_LINEAR the magnification filter is
 * linear). */
uint32_t gl_sea_texture_make(uint32_t unit, uint32_t target, uint32_t filter, uint32_t wrap_s,
                             uint32_t wrap_t);
void gl_sea_texture_bind(uint32_t unit, uint32_t target, uint32_t name);

/* Uploads what is missing, and what moves. FACET_ERROR_MEMORY, _LIMIT: tiles are larger than textures. */
facet_result gl_sea_textures_update(gl_sea_textures *textures, gl_context *context, const water_frame *frame,
                                    const camera_rays *camera, facet_error *error);
/* Images of the sky and the table of means belong to another light from now on. */
void gl_sea_textures_forget_light(gl_sea_textures *textures);
void gl_sea_textures_bind(const gl_sea_textures *textures);
void gl_sea_textures_destroy(gl_sea_textures *textures); /* {0} is allowed; leaves {0} */

#endif
