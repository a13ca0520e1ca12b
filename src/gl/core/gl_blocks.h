/* gl_blocks.h - uniform blocks and texture units, in the layout of the shaders (blocks.glsl). std140: a
 * vec3 takes four floats. */
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

/* Per image. */
typedef struct gl_frame_block {
    float view_projection[16]; /* column-major, for points relative to the eye */
    float eye[4];              /* m; w: 1 for orthographic cameras */
    /* step per +1 of gl_FragCoord at depth 1 m (orthographic: in m); up points down where rows run from
     * the top: gl_camera.h */
    float right[4], up[4];
    float forward[4]; /* unit vector */
    float size[4];    /* size of the whole drawing in pixels; offset from gl_FragCoord to a position in it */
    /* scale of the environment, cosine and sine of its rotation, number of punctual lights */
    float light[4];
    float exposure;        /* scale of radiance, 2^exposure_ev */
    int32_t energy;        /* ENERGY_* */
    int32_t channel;       /* facet_channel */
    int32_t has_coverage;  /* 1: multisample coverage from mask alpha */
    float background_blur; /* perceptual roughness */
    float far_depth;       /* gl_Position.z / w at infinity: 1, or 0 with reversed depth */
    /* drawn pixels per image pixel along an axis: 2 with FACET_QUALITY_FINAL */
    float pixel_scale;
    int32_t is_draft;    /* 1: one texture lookup for the footprint of a pixel */
    float background[4]; /* display-linear color behind a window's image; w: 0 for none */
    float backdrop[4];   /* of glass; w: 0 the environment, 1 transparent, 2 a color, cd/m^2 */
} gl_frame_block;

/* Texture units; those of materials come last. */
enum {
    GL_UNIT_ENVIRONMENT, /* filtered environment: gl_light.h */
    GL_UNIT_SHARP,       /* the unfiltered environment, for sharp reflections and the background */
    GL_UNIT_TABLES,      /* DFG and sheen albedo LUTs */
    GL_UNIT_GLASS,       /* 3D: transmission LUT */
    GL_UNIT_LIGHTS,      /* punctual lights */
    GL_UNIT_SHADOWS,
    GL_UNIT_OPAQUE,   /* opaque surfaces with mips */
    GL_UNIT_MATERIAL, /* nine units */
    GL_UNIT_RAYS =
        GL_UNIT_MATERIAL + 8, /* triangles for rays through glass, whose materials have eight units */
    /* depths of the last peeled layer, where the driver has enough units */
    GL_UNIT_PEELED = GL_UNIT_MATERIAL + 9,
    /* seas, which have no materials */
    GL_UNIT_SEA_LOW = GL_UNIT_MATERIAL, /* wave tiles, array: displacement, height, one slope */
    GL_UNIT_SEA_HIGH,                   /* the other slope, derivatives */
    GL_UNIT_SEA_FOAM,
    GL_UNIT_SEA_PATCHES, /* source offset of each wave patch */
    GL_UNIT_SEA_SKY,
    GL_UNIT_SEA_MEANS,
    GL_UNIT_SEA_GRID,
    GL_UNIT_SEA_SEEN,
    GL_UNIT_SEA_CAUSTICS, /* the last unit that every driver has */
    /* 3D: the atmosphere's sky, where there is no environment image */
    GL_UNIT_SEA_LOBES = GL_UNIT_ENVIRONMENT,
    /* a model in a sea reuses the units of its own passes */
    GL_UNIT_SEA_MODEL = GL_UNIT_TABLES,
    GL_UNIT_SEA_MODEL_DEPTH,
    GL_UNIT_SEA_MIRRORED,
    GL_UNIT_SEA_MIRRORED_DEPTH,
    GL_UNIT_SEA_CONTACT,
    /* or, for layers, those of the model */
    GL_UNIT_SEA_MODEL_NORMAL = GL_UNIT_SEA_MODEL,
    GL_UNIT_SEA_MODEL_ALBEDO,
    GL_UNIT_SEA_MODEL_NUMBER,
    /* and, for an underwater camera, two units that are otherwise unused there */
    GL_UNIT_SEA_WINDOW = GL_UNIT_SEA_MEANS,
    GL_UNIT_SEA_WINDOW_DEPTH = GL_UNIT_SEA_GRID
};

/* Vertex attributes. */
enum {
    GL_ATTRIBUTE_POSITION,
    GL_ATTRIBUTE_NORMAL,
    GL_ATTRIBUTE_TANGENT, /* w: handedness */
    GL_ATTRIBUTE_COLOR,
    GL_ATTRIBUTE_TEXCOORD, /* four sets */
    /* three rows; per instance, as are the next ones */
    GL_ATTRIBUTE_WORLD = GL_ATTRIBUTE_TEXCOORD + 4,
    GL_ATTRIBUTE_NORMAL_MATRIX = GL_ATTRIBUTE_WORLD + 3, /* three rows */
    /* scale, sign of bitangents, index of the geometry, sprite radius */
    GL_ATTRIBUTE_INSTANCE = GL_ATTRIBUTE_NORMAL_MATRIX + 3,
    GL_ATTRIBUTE_COUNT
};

#endif
