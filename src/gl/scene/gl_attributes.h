/* gl_attributes.h - the vertex attributes of a batch: the arrays that its vertex array object reads, and constants in
 * place of missing ones. */
#ifndef GL_GL_ATTRIBUTES_H
#define GL_GL_ATTRIBUTES_H

#include "gl/scene/gl_mesh.h"

/* Attributes of an instance; matrices are row-major. */
typedef struct gl_instance {
    float world[12], normal_matrix[9];
    /* index of the scene's geometry; one attribute together with the next member */
    float scale, bitangent_sign, number;
    float sprite_radius; /* pixels */
} gl_instance;

void gl_instance_load(const render_geometry *g, uint32_t number, gl_instance *out);

/* A vertex array object and what it was made from. {0}: none. */
typedef struct gl_vertex_array {
    gl_vertices fixed, streamed;
    uint32_t name, elements, first_instance;
    scene_mode mode;
} gl_vertex_array;

/* Sets the vertex array object of a batch; makes a new one where the buffers have changed since the previous pose. */
void gl_vertex_array_use(gl_vertex_array *array, gl_batch *batch, uint32_t instance_buffer);

/* Into the bound vertex array object: sets the arrays of the batch's vertices, those of sprites from index first on. */
void gl_attributes_point(const gl_batch *batch, size_t first);
/* Sets missing attributes, and those of the instance if there is one, as constants. */
void gl_attributes_set_constants(const gl_batch *batch, const gl_instance *instance);

#endif
