/* gl_mesh_vertices.h - vertices and indices in GPU memory, each array once.
 *
 * The arrays of a buffer are stored one after the other, as in the scene, so most are uploaded without a
 * copy; attributes that a primitive lacks have no array. Static arrays are found again by their address in
 * the scene; those of deformed geometries go into buffers that the next frame reuses. Two cases need
 * generated vertices: tangents per corner (corners that agree are merged again), and sprites, whose ends
 * are stored in the order of the indices. */
#ifndef GL_GL_MESH_VERTICES_H
#define GL_GL_MESH_VERTICES_H

#include "draw/render_geometry.h"
#include "gl/core/gl_blocks.h"
#include "gl/core/gl_context.h"

enum { GL_VERTEX_ARRAYS = GL_ATTRIBUTE_TEXCOORD + 4, GL_TEXCOORD_SETS = 4 };

/* Arrays in one buffer. */
typedef struct gl_vertices {
    uint32_t buffer;                  /* 0: none */
    uint32_t count;                   /* of vertices */
    uint32_t arrays;                  /* bits of GL_ATTRIBUTE_POSITION .. */
    size_t offsets[GL_VERTEX_ARRAYS]; /* bytes */
} gl_vertices;

typedef struct gl_elements {
    uint32_t buffer; /* 0: none */
    uint32_t count;
    const uint32_t *indices; /* the same on the CPU; valid until the next pose */
} gl_elements;

/* Buffers of a geometry. Sprites have no elements, and one vertex per end. */
typedef struct gl_vertex_use {
    gl_vertices fixed, streamed; /* each array is in one of them */
    gl_elements elements;
} gl_vertex_use;

/* Uploads since the store was created. */
typedef struct gl_upload_stats {
    uint64_t bytes, uploads;
} gl_upload_stats;

typedef struct gl_vertex_store {
    gl_context *context;
    facet_allocator allocator;
    const char *source; /* name of the scene, for messages */
    struct gl_vertex_table *fixed, *streamed;
    gl_upload_stats stats;
} gl_vertex_store;

/* Initialize with {.context, .allocator, .source}. */
void gl_vertex_store_destroy(gl_vertex_store *store); /* leaves the initial state */
/* Begins a new pose: deformed vertices are uploaded again. */
void gl_vertex_store_begin(gl_vertex_store *store);
/* Uploads what is missing. Fails with FACET_ERROR_MEMORY, FACET_ERROR_LIMIT: a mesh has more than 2^31 - 1
 * bytes of vertices or indices, OpenGL's limit where a long has 32 bits. */
facet_result gl_vertex_store_use(gl_vertex_store *store, const render_geometry *g, gl_vertex_use *use,
                                 facet_error *error);

/* Uploads sprites in another order into the buffer of out: sprite order[i] of the geometry becomes sprite
 * i. Fails as above. */
facet_result gl_vertex_store_reorder(gl_vertex_store *store, const render_geometry *g, const uint32_t *order,
                                     gl_vertices *out, facet_error *error);

/* Texture coordinate sets of the attributes texcoord0 to texcoord3: the sets 0 to 3, unless the material
 * reads a higher one; then those that it reads, in the order of its slots. False: it reads more than
 * GL_TEXCOORD_SETS; the rest is left out. */
bool gl_texcoord_sets(const scene_material *m, uint32_t sets[GL_TEXCOORD_SETS]);
/* The texcoord attribute of a set; GL_TEXCOORD_SETS: none. */
uint32_t gl_texcoord_attribute(const scene_material *m, uint32_t set);

#endif
