/* gl_sea_textures.h - what a sea's shaders look up: tiles of waves with their means, foam, where patches come from, the sky, the
 * table of means over facets, sunlight on the bed. */
#ifndef GL_GL_SEA_TEXTURES_H
#define GL_GL_SEA_TEXTURES_H

#include "gl/gl_context.h"
#include "gl/gl_sea_block.h"

/* OpenGL's names; 0: not there yet. Floats of 32 bits where the driver filters them, else of 16. */
typedef struct gl_sea_textures {
    uint32_t low, high, foam, patches, sky, means, caustics;
    uint32_t size, tile_count, plane_count, caustic_size; /* of what is there */
} gl_sea_textures;

/* Uploads all of it. FACET_ERROR_MEMORY, _LIMIT: tiles are larger than textures. */
facet_result gl_sea_textures_update(gl_sea_textures *textures, gl_context *context,
                                    const sea_picture *picture, const camera_rays *camera,
                                    facet_error *error);
void gl_sea_textures_bind(const gl_sea_textures *textures);
void gl_sea_textures_destroy(gl_sea_textures *textures); /* {0} is allowed; leaves {0} */

#endif
