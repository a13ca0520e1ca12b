/* gl_mesh_set.h - what gl_mesh.c and gl_mesh_order.c have of a pose. */
#ifndef GL_GL_MESH_SET_H
#define GL_GL_MESH_SET_H

#include "gl/scene/gl_mesh.h"

/* What an instance is drawn with; matrices by rows. */
typedef struct gl_instance {
    float world[12], normal_matrix[9];
    float scale, bitangent_sign, number; /* of the scene's geometry; one attribute, with what follows */
    float sprite_radius;                 /* pixels */
} gl_instance;

/* An array object, and what it was made from. */
typedef struct gl_mesh_array {
    gl_vertices fixed, streamed;
    uint32_t name, elements, first_instance;
    scene_mode mode;
} gl_mesh_array;

struct gl_mesh_set {
    facet_allocator allocator;
    gl_vertex_store store;
    uint64_t revision, generation; /* of the scene; 0: there are no batches */
    uint32_t count;
    gl_batch *batches; /* by pass */
    uint32_t first[GL_PASS_COUNT + 1];
    gl_instance *instances; /* as in OpenGL's memory: those of a batch behind each other */
    uint32_t *instance_geometries;
    gl_mesh_array *arrays; /* of the batches in the order in which they were made */
    size_t array_count, array_capacity;
    uint32_t instance_buffer;
    uint64_t sprite_feature; /* of GL_MAIN_SURFACE */
};

#endif
