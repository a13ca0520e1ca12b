/* gl_light_atlas.h - an environment's filtered cube maps and pictures in one texture of half floats.
 *
 * Each has a border of one texel, which repeats what is across the edge, and a scale of its own, a power of two that brings
 * its brightest texel to between 2^14 and 2^15. What half floats leave is 2^-11 of a texel's value, and 2^-40 of the
 * brightest texel's where that is more: beside a sun of 2e9 cd/m^2 a shadow is right to 0.002 cd/m^2. */
#ifndef GL_GL_LIGHT_ATLAS_H
#define GL_GL_LIGHT_ATLAS_H

#include "gl/core/gl_context.h"
#include "gl/scene/gl_light_block.h"
#include "ibl/light.h"

enum {
    GL_ATLAS_LEVELS = PREFILTER_LOBE_COUNT * PREFILTER_LEVEL_COUNT,
    GL_ATLAS_IRRADIANCE = GL_ATLAS_LEVELS,
    GL_ATLAS_IMAGES,
    GL_ATLAS_PARTS = GL_ATLAS_IMAGES + GL_LIGHT_IMAGES
};

/* A part and its place. */
typedef struct gl_atlas_part {
    const void *texels;     /* what was uploaded; NULL: nothing */
    uint32_t x, y;          /* of the first texel, border included */
    uint32_t width, height; /* of the picture, or an edge of the cube's faces twice; without border */
    float scale;            /* of texels: radiance is scale times what the texture holds */
} gl_atlas_part;

typedef struct gl_light_atlas {
    uint32_t texture, background; /* OpenGL's names; 0: nothing was uploaded */
    uint32_t width, height;
    gl_atlas_part parts[GL_ATLAS_PARTS];
    gl_atlas_part behind; /* the background's */
} gl_light_atlas;

/* Uploads the parts of the light, or those that are not there. Pictures larger than OpenGL's textures are scaled down. Fails
 * with FACET_ERROR_MEMORY. */
facet_result gl_light_atlas_update(gl_light_atlas *atlas, gl_context *context,
                                   const facet_allocator *allocator, const ibl_light *light,
                                   facet_error *error);
void gl_light_atlas_destroy(gl_light_atlas *atlas); /* {0} is allowed; leaves {0} */
/* What a light's lookups read of the block. */
void gl_light_atlas_describe(const gl_light_atlas *atlas, const ibl_light *light, gl_light_block *block);

#endif
