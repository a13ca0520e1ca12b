/* gl_ground.h - shadow casters, drawn as depth; and the shadow on the ground that is made from them.
 *
 * Opaque surfaces cast shadows, masked texels where they are opaque, and so do closed volumes, which
 * refract light away; blended surfaces, thin transmissive walls, points and lines cast none.
 *
 * The ground is an invisible plane under the model's lowest point. Its shadow is the ambient occlusion by the model
 * under a uniform sky, a map that is made when the scene changes.
 *
 * The lowest and highest heights above the plane, seen from below and from above, are drawn into squares of 2
 * GL_GROUND_EDGE texels around the model. From them ground_map.frag computes the hidden share of the sky for
 * GL_GROUND_EDGE texels along an edge. */
#ifndef GL_GL_GROUND_H
#define GL_GL_GROUND_H

#include "gl/scene/gl_light_block.h"
#include "gl/scene/gl_material.h"

/* ---- casters ---- */

typedef struct gl_casters {
    gl_context *context;
    gl_programs *programs;
    const gl_mesh_set *meshes;
    const gl_material_set *materials;
    float eye[3];      /* m; of the image: casters are drawn relative to it */
    uint64_t revision; /* of the scene */
    uint32_t block;    /* uniform buffer; 0: not created yet */
} gl_casters;

/* Creates a float depth texture and its framebuffer. compares: for sampler2DShadow. */
facet_result gl_casters_make_texture(gl_context *context, uint32_t edge, bool compares, uint32_t *texture,
                                     uint32_t *framebuffer, facet_error *error);
/* Clears a framebuffer and sets the depth state, from 0 (near) to 1. */
void gl_casters_begin(const gl_casters *casters, uint32_t framebuffer, uint32_t edge);
/* Draws the casters into a square of the framebuffer, through a matrix to clip space (column-major, z from
 * -1 to 1, for points relative to eye). Changes the frame block. Fails as gl_programs_get(). */
facet_result gl_casters_draw(gl_casters *casters, const float matrix[16], uint32_t x, uint32_t y,
                             uint32_t edge, facet_error *error);

/* ---- the ground ---- */

enum { GL_GROUND_EDGE = 256 };

/* Initialize with {.context}. */
typedef struct gl_ground {
    gl_context *context;
    bool is_wanted;
    float place[4];  /* x, z of the center, half the edge, height of the plane; m, world */
    float height[2]; /* above the plane, m: lowest and highest that the depth buffer represents */
    uint32_t heights, heights_framebuffer, map, map_framebuffer, empty_array; /* OpenGL names */
    uint64_t drawn_revision; /* scene revision of the map; 0: none */
} gl_ground;

/* Places the ground and sets is_wanted. */
void gl_ground_plan(gl_ground *ground, const facet_render_desc *desc, const float bounds_min[3],
                    const float bounds_max[3]);
void gl_ground_describe(const gl_ground *ground, gl_light_block *block);
/* Makes the map where the scene has changed. Changes the framebuffer, the viewport and the frame block;
 * the light block is bound. Fails as gl_programs_get(), with FACET_ERROR_MEMORY. */
facet_result gl_ground_draw(gl_ground *ground, gl_casters *casters, facet_error *error);
void gl_ground_destroy(gl_ground *ground); /* {0} is allowed; leaves {.context} */

#endif
