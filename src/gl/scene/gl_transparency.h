/* gl_transparency.h - blended surfaces, in one of the modes of facet_transparency.
 *
 * Sorted: gl_sort.h. Peeled: the layers of each pixel from front to back, each the nearest surface behind
 * the previous layer (Everitt 2001, "Interactive order-independent transparency"). Pixels are ordered, not
 * samples, so the target should have one sample, and an image several views. Surfaces in the same place
 * are one layer. Falls back to sorted where OpenGL has no texture unit left. Weighted: the mean of all
 * layers, weighted by depth and opacity, over the light that they transmit (McGuire and Bavoil 2013,
 * "Weighted blended order-independent transparency", equations 2 and 10, with depth relative to the range
 * of blended surfaces). */
#ifndef GL_GL_TRANSPARENCY_H
#define GL_GL_TRANSPARENCY_H

#include "gl/scene/gl_material.h"
#include "gl/scene/gl_sort.h"
#include "gl/core/gl_target.h"

enum { GL_TRANSPARENCY_LAYERS = 8 }; /* that are peeled */

typedef struct gl_transparency gl_transparency;

/* The input of a draw. */
typedef struct gl_transparency_view {
    facet_transparency mode;
    gl_programs *programs;
    gl_material_set *materials;
    gl_mesh_set *meshes;
    const gl_scene *scene;
    const gl_frame_block *frame; /* as bound */
    const gl_target *target;     /* bound, with opaque and transmissive surfaces in it */
    uint64_t features;           /* of the light, for the programs */
    uint32_t thread_count;
} gl_transparency_view;

facet_result gl_transparency_create(gl_context *context, const facet_allocator *allocator,
                                    gl_transparency **out, facet_error *error);
void gl_transparency_destroy(gl_transparency *t); /* NULL is allowed */

/* The most samples that a target should have: 1 with peeling. */
uint32_t gl_transparency_max_samples(const gl_context *context, facet_transparency mode,
                                     const gl_mesh_set *meshes);
/* Requests the programs. */
facet_result gl_transparency_request(const gl_transparency *t, const gl_transparency_view *view,
                                     facet_error *error);
/* Draws GL_PASS_BLENDED with the depth test of gl_camera_begin_depth(). Leaves the target bound, blending
 * off, depth writes on. Fails with FACET_ERROR_MEMORY, FACET_ERROR_SYSTEM, FACET_ERROR_LIMIT. */
facet_result gl_transparency_draw(gl_transparency *t, const gl_transparency_view *view, facet_error *error);

#endif
