/* gl_mesh.h - the geometry of a pose in OpenGL's memory, as batches: what one call draws.
 *
 * Instances stand in world space; the shader takes the eye away from where they are before it adds what is within them, so
 * that a model far from the origin does not shake, and nothing has to be uploaded for another camera. */
#ifndef GL_GL_MESH_H
#define GL_GL_MESH_H

#include "gl/scene/gl_mesh_vertices.h"
#include "gl/scene/gl_scene.h"

/* Instances of one primitive with one material, drawn by one call. Sprites, which are points and lines a pixel wide: one
 * instance, drawn as many times as it has sprites; the shader makes outlines of them. */
typedef struct gl_batch {
    const render_geometry *geometry; /* the first of them */
    const material_plan *plan;
    gl_vertex_use vertices;
    uint32_t vertex_array;
    uint32_t mode; /* GL_TRIANGLES; of sprites: GL_TRIANGLE_STRIP */
    uint32_t element_count;
    bool has_elements; /* indices of 32 bits; else vertices in their order */
    bool is_sprites;
    uint32_t instance_count, first_instance; /* of all instances; of sprites: how often it is drawn */
    float bounds_min[3], bounds_max[3];      /* of all of them, world, m */
    uint64_t features;                       /* of its program */
    bool is_outside;                         /* of the picture, for sure */
    float depth;                             /* of the middle along the camera's axis, m */
} gl_batch;

typedef struct gl_mesh_set gl_mesh_set;
struct gl_material_set; /* gl_material.h */

/* Nothing is uploaded yet. FACET_ERROR_MEMORY. */
facet_result gl_mesh_create(gl_context *context, const facet_allocator *allocator, gl_mesh_set **out,
                            facet_error *error);
void gl_mesh_destroy(gl_mesh_set *set); /* NULL is allowed */

/* Uploads what is not there of the scene's geometries, or has changed (deformed vertices); where the scene's revision is
 * the one of the last call, nothing. scene stays as it is until the next call. Fails with FACET_ERROR_MEMORY,
 * FACET_ERROR_LIMIT; there are no batches then. */
facet_result gl_mesh_update(gl_mesh_set *meshes, const gl_scene *scene, const facet_log *log,
                            facet_error *error);

typedef enum gl_pass {
    GL_PASS_OPAQUE, /* alpha mask too */
    GL_PASS_TRANSMISSIVE,
    GL_PASS_BLENDED,
    GL_PASS_COUNT
} gl_pass;

/* Orders them for a picture: by program, the nearest first. Those of GL_PASS_BLENDED stay in the order of the scene, which
 * gl_sort.h goes by. */
typedef uint64_t gl_mesh_features_function(const struct gl_material_set *materials, const gl_batch *batch);
void gl_mesh_order(gl_mesh_set *meshes, const gl_frame_block *frame, const struct gl_material_set *materials,
                   gl_mesh_features_function *features_of);

/* Those that are outside of the picture, too: shadows fall into it. */
const gl_batch *gl_mesh_batches(const gl_mesh_set *meshes, gl_pass pass, uint32_t *count);
/* World-space bounding box of an instance, m. */
void gl_mesh_instance_box(const scene_instance *instance, float low[3], float high[3]);
/* Whether all of a batch is beyond one side of what a frame sees. */
bool gl_mesh_is_outside(const gl_batch *batch, const gl_frame_block *frame);
/* What the program of a batch needs apart from its material. */
uint64_t gl_mesh_features(const gl_mesh_set *meshes, const gl_batch *batch);
/* Binds the batch's vertices and draws them. */
void gl_mesh_draw(const gl_mesh_set *meshes, const gl_batch *batch);

/* For calls that draw a part of a batch, into an array object without arrays of instances. Points the arrays of its vertices,
 * those of sprites from number first on, into the array object that is bound. */
void gl_mesh_point_arrays(const gl_batch *batch, size_t first);
/* What the batch has no arrays for, and the instance (of all), as constants. */
void gl_mesh_set_constants(const gl_mesh_set *meshes, const gl_batch *batch, uint32_t instance);
/* gl_vertex_store_reorder() of the sprites of a batch. */
facet_result gl_mesh_reorder(gl_mesh_set *meshes, const gl_batch *batch, const uint32_t *order,
                             gl_vertices *out, facet_error *error);
/* Number of the scene's geometry. */
uint32_t gl_mesh_instance_geometry(const gl_mesh_set *meshes, uint32_t instance);

/* Of vertices, indices and instances. */
gl_upload_stats gl_mesh_uploads(const gl_mesh_set *meshes);

#endif
