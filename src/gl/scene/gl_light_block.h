/* gl_light_block.h - the uniform block of an image's light, in the layout of light_block.glsl (std140). */
#ifndef GL_GL_LIGHT_BLOCK_H
#define GL_GL_LIGHT_BLOCK_H

#include <stdint.h>

#include "ibl/narrow.h"
#include "ibl/prefilter.h"

enum {
    GL_LIGHT_IMAGES = 1 + NARROW_COUNT, /* unfiltered, then blurred */
    GL_LIGHT_STEPS = NARROW_STEPS + 1,
    GL_LIGHT_ROW = 1024 /* texels per row of the punctual lights' texture */
};

/* A place is the column and row of the first texel, border included, then the edge (of an image width and
 * height) in texels; for a cube map also the scale of its texels, 0 where it is missing. */
typedef struct gl_light_block {
    float atlas[4];    /* 1 / width, 1 / height; scale of the background's texels; GLASS_ROOT_MAX of dfg.h */
    int32_t ranges[4]; /* first and last level of GGX, of Charlie */
    float places[PREFILTER_LOBE_COUNT][PREFILTER_LEVEL_COUNT][4];
    float irradiance[4];                                       /* a place */
    float steps[PREFILTER_LOBE_COUNT][PREFILTER_LEVEL_COUNT];  /* roughness */
    float slopes[PREFILTER_LOBE_COUNT][PREFILTER_LEVEL_COUNT]; /* 1 / distance to the next; 0 out of range */
    float images[GL_LIGHT_IMAGES][4];                          /* places */
    float narrow_weights[GL_LIGHT_STEPS][4];                   /* weights of the images, times their scales */
    float narrow_lobe[GL_LIGHT_STEPS][4];                      /* [0]: weight of level 1 of GGX */
    float grid_origin[4];                                      /* m, world */
    float grid_cells[4];                                       /* per m */
    /* per axis; 0: no grid, all lights are evaluated everywhere */
    int32_t grid_size[4];
    float shadow[4];        /* edge of a tile, texels; tiles per row; 1 / edge of the map */
    float ground[4];        /* x, z of the center of the map, half its edge, height of the plane; m, world */
    float ground_height[4]; /* lowest and highest height in the map of heights, m */
    int32_t lists[4];       /* first texel of the lists, of the cells; number of lights without range */
} gl_light_block;

#endif
