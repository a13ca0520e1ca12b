/* gl_light_block.h - where a picture's light lies in textures, as light_block.glsl has it: std140. */
#ifndef GL_GL_LIGHT_BLOCK_H
#define GL_GL_LIGHT_BLOCK_H

#include <stdint.h>

#include "ibl/narrow.h"
#include "ibl/prefilter.h"

enum {
    GL_LIGHT_IMAGES = 1 + NARROW_COUNT, /* mirror, blurred ones */
    GL_LIGHT_STEPS = NARROW_STEPS + 1,
    GL_LIGHT_ROW = 1024 /* texels in a row of the punctual lights' texture */
};

/* A place: column and row of the first texel, border included, edge (of a picture width and height) in texels; of a cube map
 * the scale of its texels too, 0 where it is not there. */
typedef struct gl_light_block {
    float atlas[4];    /* 1 / width, 1 / height; scale of the background's texels; GLASS_ROOT_MAX of dfg.h */
    int32_t ranges[4]; /* first and last level of GGX, of Charlie */
    float places[PREFILTER_LOBE_COUNT][PREFILTER_LEVEL_COUNT][4];
    float irradiance[4]; /* a place */
    float steps[PREFILTER_LEVEL_COUNT]
               [4]; /* roughness of GGX, 1 over what is missing to the next one; Charlie's */
    float pictures[GL_LIGHT_IMAGES][4];              /* places */
    float narrow_weights[GL_LIGHT_STEPS][4];         /* of the pictures, with their scales */
    float narrow_lobe[(GL_LIGHT_STEPS + 3) / 4 * 4]; /* of level 1 of GGX */
    float grid_origin[4];                            /* m, world */
    float grid_cells[4];                             /* per m */
    int32_t grid_size[4];                            /* per axis; 0: all lights are looked at everywhere */
    float shadow[4]; /* edge of a tile, texels; tiles in a row; 1 over the edge of the map */
    float ground[4]; /* x, z of the middle of its map, half of its edge, height of the plane; m, world */
    float ground_height[4]; /* of what stands on it, m: lowest and highest that the map of heights has */
    int32_t lists[4];       /* first texel of lists, of cells; number of lights that reach everywhere */
} gl_light_block;

#endif
