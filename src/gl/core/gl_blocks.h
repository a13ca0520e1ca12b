/* gl_blocks.h - uniform blocks and texture units, as C and the shaders (blocks.glsl) have them. std140: vec3 takes four
 * floats. */
#ifndef GL_GL_BLOCKS_H
#define GL_GL_BLOCKS_H

#include <stdint.h>

enum {
    GL_BLOCK_FRAME,
    GL_BLOCK_MATERIAL,
    GL_BLOCK_LIGHT,
    GL_BLOCK_OGL1,
    GL_BLOCK_SEA,
    GL_BLOCK_COUNT
}; /* binding points */

/* Of a picture. */
typedef struct gl_frame_block {
    float view_projection[16]; /* columns; of points relative to the eye */
    float eye[4];              /* m; w: 1 orthographic */
    float right[4], up[4]; /* per +1 of gl_FragCoord at depth 1 m (orthographic: m); up points down where rows
                                  run from the top: gl_camera.h */
    float forward[4];      /* unit */
    float size[4];   /* width, height of what is drawn, pixels; what gl_FragCoord lacks to be a place in it */
    float light[4];  /* scale of the environment, cos and sin of its rotation, number of punctual lights */
    float exposure;  /* scale of radiance */
    int32_t energy;  /* ENERGY_* */
    int32_t channel; /* facet_channel */
    int32_t has_coverage;  /* 1: samples are made of the alpha of masks */
    float background_blur; /* perceptual roughness */
    float tonemap;
    float far_depth; /* gl_Position.z / w of what is infinitely far away: 1, or 0 where depth is reversed */
    /* pixels that are drawn, in a row, for one of the picture: 2 with FACET_QUALITY_FINAL */
    float pixel_scale;
    float background[4]; /* display-linear color that is laid behind for a window; w: 0: none */
} gl_frame_block;

/* Texture units; those of materials come behind. */
enum {
    GL_UNIT_ENVIRONMENT, /* all that is filtered: gl_light.h */
    GL_UNIT_SHARP,       /* the picture that mirrors show, or behind the model */
    GL_UNIT_TABLES,      /* DFG and sheen's albedo */
    GL_UNIT_GLASS,       /* 3D */
    GL_UNIT_LIGHTS,      /* punctual ones */
    GL_UNIT_SHADOWS,
    GL_UNIT_OPAQUE,                        /* the opaque frame with its mips */
    GL_UNIT_MATERIAL,                      /* nine */
    GL_UNIT_PEELED = GL_UNIT_MATERIAL + 9, /* depths of a layer, where there are so many units */
    /* of a sea, which has no materials */
    GL_UNIT_SEA_LOW = GL_UNIT_MATERIAL, /* tiles of waves, arrays: displacement, height, a slope; */
    GL_UNIT_SEA_HIGH,                   /* the other slope, derivatives */
    GL_UNIT_SEA_FOAM,
    GL_UNIT_SEA_PATCHES, /* from where in its tile each patch comes */
    GL_UNIT_SEA_SKY,
    GL_UNIT_SEA_MEANS,
    GL_UNIT_SEA_GRID,
    GL_UNIT_SEA_SEEN,
    GL_UNIT_SEA_CAUSTICS,                    /* the last that every driver has */
    GL_UNIT_SEA_LOBES = GL_UNIT_ENVIRONMENT, /* 3D: the atmosphere's sky, where there is no picture */
    /* of a model in it, in the places of what its own passes look up */
    GL_UNIT_SEA_MODEL = GL_UNIT_TABLES,
    GL_UNIT_SEA_MODEL_DEPTH,
    GL_UNIT_SEA_MIRRORED,
    GL_UNIT_SEA_MIRRORED_DEPTH,
    GL_UNIT_SEA_TOUCH,
    /* and for an eye in the water, in the places of what others look up */
    GL_UNIT_SEA_WINDOW = GL_UNIT_SEA_MEANS,
    GL_UNIT_SEA_WINDOW_DEPTH = GL_UNIT_SEA_GRID
};

/* Vertex attributes. */
enum {
    GL_ATTRIBUTE_POSITION,
    GL_ATTRIBUTE_NORMAL,
    GL_ATTRIBUTE_TANGENT, /* w: handedness */
    GL_ATTRIBUTE_COLOR,
    GL_ATTRIBUTE_TEXCOORD,                                  /* four sets */
    GL_ATTRIBUTE_WORLD = GL_ATTRIBUTE_TEXCOORD + 4,         /* three rows; of an instance, as what follows */
    GL_ATTRIBUTE_NORMAL_MATRIX = GL_ATTRIBUTE_WORLD + 3,    /* three rows */
    GL_ATTRIBUTE_INSTANCE = GL_ATTRIBUTE_NORMAL_MATRIX + 3, /* scale, sign of bitangents, material id + 1 */
    GL_ATTRIBUTE_COUNT
};

#endif
