/* gl_casters.h - what casts shadows, drawn as depth alone: what is opaque, masked texels where they are, and bodies of glass,
 * which turn light away; blended surfaces, thin transmissive walls, points and lines do not. */
#ifndef GL_GL_CASTERS_H
#define GL_GL_CASTERS_H

#include "gl/scene/gl_material.h"

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

#endif
