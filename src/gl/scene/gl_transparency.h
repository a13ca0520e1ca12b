/* gl_transparency.h - what is blended over what is there, in one of the three ways of facet_transparency.
 *
 * Sorted: gl_sort.h. Peeled: each pixel's layers from front to back, the nearest of what lies behind the layer before
 * (Everitt 2001, "Interactive order-independent transparency"); pixels, not samples, have an order, so that the target
 * should have one sample, and a picture several such views. Where OpenGL has no texture unit left for it, sorted. Surfaces that lie in one place are one layer. Weighted: the
 * mean of all layers, weighted by depth and opacity, under the light that passes all of them (McGuire and Bavoil 2013,
 * "Weighted blended order-independent transparency", equations 2, 10; depth is relative to that of what is blended). */
#ifndef GL_GL_TRANSPARENCY_H
#define GL_GL_TRANSPARENCY_H

#include "gl/scene/gl_material.h"
#include "gl/scene/gl_sort.h"
#include "gl/core/gl_target.h"

enum { GL_TRANSPARENCY_LAYERS = 8 }; /* that are peeled */

typedef struct gl_transparency gl_transparency;

/* What a picture is drawn with. */
typedef struct gl_transparency_view {
    facet_transparency mode;
    gl_programs *programs;
    gl_material_set *materials;
    gl_mesh_set *meshes;
    const gl_scene *scene;
    const gl_frame_block *frame; /* as it is bound */
    const gl_target
        *target;       /* bound, opaque and transmissive surfaces are there; blended: as drawn over it */
    uint64_t features; /* of the programs: of light */
    uint32_t thread_count;
} gl_transparency_view;

facet_result gl_transparency_create(gl_context *context, const facet_allocator *allocator,
                                    gl_transparency **out, facet_error *error);
void gl_transparency_destroy(gl_transparency *t); /* NULL is allowed */

/* The most samples that a view should have of those that OpenGL has: 1 where pixels are peeled. */
uint32_t gl_transparency_max_samples(const gl_context *context, facet_transparency mode,
                                     const gl_mesh_set *meshes);
/* Starts to compile the programs. */
facet_result gl_transparency_request(const gl_transparency *t, const gl_transparency_view *view,
                                     facet_error *error);
/* Draws GL_PASS_BLENDED, with the depth test of gl_camera_begin_depth(); leaves the target bound, nothing blended, depth
 * written. Fails with FACET_ERROR_MEMORY, FACET_ERROR_SYSTEM, FACET_ERROR_LIMIT. */
facet_result gl_transparency_draw(gl_transparency *t, const gl_transparency_view *view, facet_error *error);

#endif
