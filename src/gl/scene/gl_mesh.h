/* gl_mesh.h - the geometry of a pose in GPU memory, as batches that one call draws.
 *
 * Instances are in world space; the vertex shader subtracts the eye from the instance's origin before it
 * adds the local position, so a model far from the origin does not jitter and a new camera uploads
 * nothing. */
#ifndef GL_GL_MESH_H
#define GL_GL_MESH_H

#include "gl/scene/gl_mesh_vertices.h"
#include "gl/scene/gl_scene.h"

/* Instances of one primitive with one material, drawn by one call. Sprites (points, lines one pixel wide)
 * are one instance, drawn once per sprite; the vertex shader computes their outlines. */
typedef struct gl_batch {
    const render_geometry *geometry; /* the first instance's */
    const material_plan *plan;
    gl_vertex_use vertices;
    uint32_t vertex_array;
    uint32_t mode; /* GL_TRIANGLES; sprites: GL_TRIANGLE_STRIP */
    uint32_t element_count;
    bool has_elements; /* 32-bit indices; false: vertices in order */
    bool is_sprites;
    uint32_t instance_count, first_instance; /* instance_count of sprites: their number */
    float bounds_min[3], bounds_max[3];      /* of all instances, world, m */
    uint64_t features;                       /* of its program */
    bool is_outside;                         /* entirely outside the image */
    float depth;                             /* of the center along the camera's axis, m */
} gl_batch;

typedef struct gl_mesh_set gl_mesh_set;
struct gl_material_set; /* gl_material.h */

/* Uploads nothing yet. FACET_ERROR_MEMORY. */
facet_result gl_mesh_create(gl_context *context, const facet_allocator *allocator, gl_mesh_set **out,
                            facet_error *error);
void gl_mesh_destroy(gl_mesh_set *set); /* NULL is allowed */

/* Uploads what is missing or has changed (deformed vertices); nothing where the scene's revision is
 * unchanged. scene must not change until the next call. Fails with FACET_ERROR_MEMORY, FACET_ERROR_LIMIT;
 * there are no batches then. */
facet_result gl_mesh_update(gl_mesh_set *meshes, const gl_scene *scene, const facet_log *log,
                            facet_error *error);

typedef enum gl_pass {
    GL_PASS_OPAQUE, /* including alpha masks */
    GL_PASS_TRANSMISSIVE,
    GL_PASS_BLENDED,
    GL_PASS_COUNT
} gl_pass;

/* Sorts the batches of an image by program, then from near to far. Those of GL_PASS_BLENDED keep the order
 * of the scene, on which gl_sort.h relies. */
typedef uint64_t gl_mesh_features_function(const struct gl_material_set *materials, const gl_batch *batch);
void gl_mesh_order(gl_mesh_set *meshes, const gl_frame_block *frame, const struct gl_material_set *materials,
                   gl_mesh_features_function *features_of);

/* Includes the batches outside the image, which may cast shadows into it. */
const gl_batch *gl_mesh_batches(const gl_mesh_set *meshes, gl_pass pass, uint32_t *count);
/* Left, bottom, width and height of the drawn pixels that batches of GL_PASS_OPAQUE may cover, or of the whole target
 * where that is not known, or other batches exist. The frame's order is that of gl_mesh_order(). */
void gl_mesh_area(const gl_mesh_set *meshes, const gl_frame_block *frame, bool is_top_down, uint32_t width,
                  uint32_t height, int area[4]);
/* World-space bounding box of an instance, m. */
void gl_mesh_instance_box(const scene_instance *instance, float low[3], float high[3]);
/* Whether a batch is entirely beyond one side of the frame. */
bool gl_mesh_is_outside(const gl_batch *batch, const gl_frame_block *frame);
/* Features of a batch's program apart from those of its material. */
uint64_t gl_mesh_features(const gl_mesh_set *meshes, const gl_batch *batch);
/* Binds the batch's vertices and draws it. */
void gl_mesh_draw(const gl_mesh_set *meshes, const gl_batch *batch);

/* For calls that draw part of a batch, without instance arrays (gl_attributes_point()): sets missing attributes, and those
 * of the instance (index among all), as constants. */
void gl_mesh_set_constants(const gl_mesh_set *meshes, const gl_batch *batch, uint32_t instance);
/* gl_vertex_store_reorder() of the sprites of a batch. */
facet_result gl_mesh_reorder(gl_mesh_set *meshes, const gl_batch *batch, const uint32_t *order,
                             gl_vertices *out, facet_error *error);
/* Index of the scene's geometry. */
uint32_t gl_mesh_instance_geometry(const gl_mesh_set *meshes, uint32_t instance);

/* Uploads of vertices, indices and instances. */
gl_upload_stats gl_mesh_uploads(const gl_mesh_set *meshes);

#endif
