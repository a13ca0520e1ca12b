/* gl_mesh.h - the geometry of a pose in OpenGL's memory, in the order in which it is drawn. */
#ifndef GL_GL_MESH_H
#define GL_GL_MESH_H

#include "draw/material_plan.h"
#include "gl/gl_blocks.h"
#include "gl/gl_context.h"
#include "scene/scene.h"

/* Instances of one primitive with one material, drawn by one call. */
typedef struct gl_batch {
    const render_geometry *geometry; /* the first of them */
    const material_plan *plan;
    uint32_t vertex_array;
    uint32_t mode; /* GL_TRIANGLES.. */
    uint32_t element_count;
    bool has_elements; /* indices of 32 bits; else vertices in their order */
    uint32_t instance_count, first_instance;
    float center[3]; /* of the instance, m: what sorts */
} gl_batch;

typedef struct gl_mesh_set gl_mesh_set;

/* Nothing is uploaded yet. FACET_ERROR_MEMORY. */
facet_result gl_mesh_create(gl_context *context, const facet_allocator *allocator, gl_mesh_set **out,
                            facet_error *error);
void gl_mesh_destroy(gl_mesh_set *set); /* NULL is allowed */

/* Uploads what is not there of geometries with their tangents, or has changed (deformed vertices). set and plans stay
 * until the next call. eye: instances' matrices are relative to it, so that a model far from the origin does not
 * shake. Fails with FACET_ERROR_MEMORY. */
facet_result gl_mesh_update(gl_mesh_set *meshes, const render_geometry_set *set,
                            const material_plan_set *plans, const float eye[3], facet_error *error);

/* The opaque ones (alpha mask too) by program and from front to back, those that light passes through after them, and those
 * that are blended, from back to front as seen from eye along forward. */
typedef enum gl_pass { GL_PASS_OPAQUE, GL_PASS_TRANSMISSIVE, GL_PASS_BLENDED, GL_PASS_COUNT } gl_pass;
const gl_batch *gl_mesh_batches(const gl_mesh_set *meshes, gl_pass pass, uint32_t *count);
/* Binds the batch's vertices and draws them. */
void gl_mesh_draw(const gl_mesh_set *meshes, const gl_batch *batch);

#endif
