/* gl_shadow.h - shadow maps of punctual lights and the sun: depth as seen from each light, tiles of one square texture.
 *
 * Spot lights and directional ones have a tile, others six, the faces of a cube (cube.h). A tile's frustum is that of its light
 * with GL_SHADOW_GUARD texels more on each side, so that filters need not look across edges. What casts:
 * gl_casters.h. */
#ifndef GL_GL_SHADOW_H
#define GL_GL_SHADOW_H

#include "draw/light_setup.h"
#include "gl/scene/gl_material.h"
#include "gl/scene/gl_light_block.h"

/* ---- casters ---- */

typedef struct gl_casters {
    gl_context *context;
    gl_programs *programs;
    const gl_mesh_set *meshes;
    const gl_material_set *materials;
    float eye[3];      /* m; of the picture: what casts stands relative to it */
    uint64_t revision; /* of the scene */
    uint32_t block;    /* OpenGL's name of a uniform buffer; 0: made when it is needed */
} gl_casters;

/* A texture of depths (floats), and the framebuffer to draw into it. compares: it is looked up by sampler2DShadow. */
facet_result gl_casters_make_texture(gl_context *context, uint32_t edge, bool compares, uint32_t *texture,
                                     uint32_t *framebuffer, facet_error *error);
/* Into a framebuffer: what clears it and sets the state of depth, from 0 (near) to 1. */
void gl_casters_begin(const gl_casters *casters, uint32_t framebuffer, uint32_t edge);
/* As a matrix to clip space (columns, z from -1 to 1, of points relative to eye) sees them, into a square. The frame's block is
 * another one afterwards. Fails as gl_programs_get(). */
facet_result gl_casters_draw(gl_casters *casters, const float matrix[16], uint32_t x, uint32_t y,
                             uint32_t edge, facet_error *error);

/* ---- shadow maps ---- */

enum {
    GL_SHADOW_GUARD = 4,      /* texels */
    GL_SHADOW_TILE_MIN = 256, /* texels along an edge */
    GL_SHADOW_TILE_MAX = 2048,
    GL_SHADOW_MAP_MAX = 4096 /* of the whole texture */
};

/* How a light's tiles are looked up: shadow.glsl. d: from origin to a point. */
typedef struct gl_shadow_record {
    float origin[3], kind; /* m, world; GL_SHADOW_* */
    float right[3],
        texel;         /* dot(d, right) (over depth) is x in [-1, 1]; edge of a texel in m (at depth 1 m) */
    float up[3], tile; /* number of the first tile */
    float forward[3], scale; /* unit (parallel: 1 over the range of depth); faces of a cube: of s and t */
    float depth_a, depth_b, reserved[2]; /* what is compared: a + b / depth */
} gl_shadow_record;

enum { GL_SHADOW_PARALLEL, GL_SHADOW_SPOT, GL_SHADOW_CUBE };

typedef struct gl_shadow gl_shadow;

facet_result gl_shadow_create(gl_context *context, const facet_allocator *allocator, gl_shadow **out,
                              facet_error *error);
void gl_shadow_destroy(gl_shadow *shadow); /* NULL is allowed */

/* Decides which lights have shadows within the bounds of a scene (m): the brightest, as many as there is room for, with a
 * warning for the others; none where desc does not ask for shadows. FACET_ERROR_MEMORY. */
facet_result gl_shadow_plan(gl_shadow *shadow, const facet_render_desc *desc, const light_setup *setup,
                            const float bounds_min[3], const float bounds_max[3], facet_error *error);
/* As decided. */
const gl_shadow_record *gl_shadow_records(const gl_shadow *shadow, uint32_t *count);
uint32_t gl_shadow_of_light(const gl_shadow *shadow,
                            uint32_t light); /* number of its record, from 1 on; 0: none */
void gl_shadow_describe(const gl_shadow *shadow, gl_light_block *block);

/* Draws the tiles where the scene or the lights are others than before. The framebuffer, the viewport and the frame's block are
 * others afterwards. Fails as gl_programs_get(), with FACET_ERROR_MEMORY. */
facet_result gl_shadow_draw(gl_shadow *shadow, gl_casters *casters, facet_error *error);
uint32_t gl_shadow_texture(const gl_shadow *shadow); /* OpenGL's name; 0: there is none */

#endif
