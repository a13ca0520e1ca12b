/* gl_phong.h - materials of OpenGL 1 (FACET_SHADING_OGL1): the counterpart of gl_material.h for batches
 * with a legacy material. */
#ifndef GL_GL_PHONG_H
#define GL_GL_PHONG_H

#include "draw/camera_rays.h"
#include "draw/light_setup.h"
#include "gl/scene/gl_mesh.h"
#include "gl/core/gl_pyramid.h"
#include "gl/core/gl_target.h"

typedef struct gl_phong gl_phong;

facet_result gl_phong_create(gl_context *context, const facet_scene *scene, const facet_allocator *allocator,
                             gl_phong **out, facet_error *error);
void gl_phong_destroy(gl_phong *phong); /* NULL is allowed */

/* The input of an update; meshes are up to date. */
typedef struct gl_phong_view {
    const gl_scene *scene;
    const camera_rays *camera;
    const light_setup *light;
    const gl_mesh_set *meshes;
    const facet_render_desc *render;
} gl_phong_view;

/* Uploads the blocks of the image and of its materials, and the textures that they read. Fails with
 * FACET_ERROR_MEMORY, FACET_ERROR_LIMIT. */
facet_result gl_phong_update(gl_phong *phong, const gl_phong_view *view, facet_error *error);
/* Features of GL_MAIN_PHONG that follow from a batch's material. */
uint64_t gl_phong_features(const gl_phong *phong, const gl_batch *batch);
/* Binds blocks and textures. */
void gl_phong_bind(const gl_phong *phong, const gl_batch *batch);
/* Converts a resolved image from display colors to radiance, unless it was shaded in linear light. The
 * frame block is bound. */
facet_result gl_phong_linearize(gl_phong *phong, const gl_pyramid_brush *brush, const gl_target *target,
                                facet_error *error);
uint64_t gl_phong_decoded_texels(const gl_phong *phong);

#endif
