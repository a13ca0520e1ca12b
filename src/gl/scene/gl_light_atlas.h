/* gl_light_atlas.h - an environment's filtered cube maps and images in one texture of half floats.
 *
 * Each part has a border of one texel, which repeats the texels across the edge, and a power of two as its
 * scale, which brings its brightest texel to [2^14, 2^15). The error is 2^-11 of a texel's value, or 2^-40
 * of the brightest texel's where that is larger: beside a sun of 2e9 cd/m^2 a shadow is accurate to 0.002
 * cd/m^2. */
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

/* A part and its position. */
typedef struct gl_atlas_part {
    const void *texels;     /* as uploaded; NULL: none */
    uint32_t x, y;          /* first texel, border included */
    uint32_t width, height; /* of the image, or the edge of the cube's faces twice; without border */
    float scale;            /* radiance is scale times the texel */
} gl_atlas_part;

typedef struct gl_light_atlas {
    uint32_t texture, background; /* OpenGL names; 0: none */
    uint32_t width, height;
    gl_atlas_part parts[GL_ATLAS_PARTS];
    gl_atlas_part behind; /* the background image */
} gl_light_atlas;

/* Uploads the missing parts of the light. Images beyond OpenGL's limit are scaled down. Fails with
 * FACET_ERROR_MEMORY. */
facet_result gl_light_atlas_update(gl_light_atlas *atlas, gl_context *context,
                                   const facet_allocator *allocator, const ibl_light *light,
                                   facet_error *error);
void gl_light_atlas_destroy(gl_light_atlas *atlas); /* {0} is allowed; leaves {0} */
/* Fills in the members of the block that lookups of the light read. */
void gl_light_atlas_describe(const gl_light_atlas *atlas, const ibl_light *light, gl_light_block *block);

#endif
