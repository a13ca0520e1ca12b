/* gl_mesh_vertices.h - vertices and indices in OpenGL's memory, each array there once.
 *
 * Arrays lie behind each other in a buffer, as the scene has them, so that most are uploaded without a copy; what a
 * primitive has not, has no array. Those that do not change are found again by where they stand in the scene; those of
 * deformed geometries go into buffers that are kept for the next frame's. Two things need vertices of their own: tangents
 * of corners (vertices whose corners agree are one again), and sprites, whose ends follow each other in the order of
 * the indices. */
#ifndef GL_GL_MESH_VERTICES_H
#define GL_GL_MESH_VERTICES_H

#include "draw/render_geometry.h"
#include "gl/core/gl_blocks.h"
#include "gl/core/gl_context.h"

enum { GL_VERTEX_ARRAYS = GL_ATTRIBUTE_TEXCOORD + 4, GL_TEXCOORD_SETS = 4 };

/* Arrays in a buffer. */
typedef struct gl_vertices {
    uint32_t buffer;                  /* 0: there are none */
    uint32_t count;                   /* of vertices */
    uint32_t arrays;                  /* bits of GL_ATTRIBUTE_POSITION .. */
    size_t offsets[GL_VERTEX_ARRAYS]; /* bytes */
} gl_vertices;

typedef struct gl_elements {
    uint32_t buffer; /* 0: there are none */
    uint32_t count;
    const uint32_t *indices; /* the same; stays until the next pose */
} gl_elements;

/* What a geometry is drawn with. Sprites: no elements, a vertex per end. */
typedef struct gl_vertex_use {
    gl_vertices fixed, streamed; /* each array is in one of them */
    gl_elements elements;
} gl_vertex_use;

/* What was uploaded since the store was made. */
typedef struct gl_upload_stats {
    uint64_t bytes, uploads;
} gl_upload_stats;

typedef struct gl_vertex_store {
    gl_context *context;
    facet_allocator allocator;
    const char *source; /* of the scene, for messages */
    struct gl_vertex_table *fixed, *streamed;
    gl_upload_stats stats;
} gl_vertex_store;

/* {0} with context, allocator and source set. */
void gl_vertex_store_destroy(gl_vertex_store *store); /* leaves it as it was made */
/* Another pose: what is deformed has to be uploaded again. */
void gl_vertex_store_begin(gl_vertex_store *store);
/* Uploads what is not there. Fails with FACET_ERROR_MEMORY, FACET_ERROR_LIMIT: a mesh has more than 2^31 - 1 bytes of
 * vertices or indices, which is as far as OpenGL counts where a long has 32 bits. */
facet_result gl_vertex_store_use(gl_vertex_store *store, const render_geometry *g, gl_vertex_use *use,
                                 facet_error *error);

/* Sprites in another order, anew in the buffer of out: number order[i] of the geometry's is number i. Fails as above. */
facet_result gl_vertex_store_reorder(gl_vertex_store *store, const render_geometry *g, const uint32_t *order,
                                     gl_vertices *out, facet_error *error);

/* Which sets of texture coordinates go to texcoord0 to texcoord3: those of their numbers, unless the material reads one
 * beyond; then those that it reads, as its slots name them. False: it reads more than GL_TEXCOORD_SETS; those beyond are left out. */
bool gl_texcoord_sets(const scene_material *m, uint32_t sets[GL_TEXCOORD_SETS]);
/* The texcoord attribute with that set; GL_TEXCOORD_SETS: none. */
uint32_t gl_texcoord_attribute(const scene_material *m, uint32_t set);

#endif
