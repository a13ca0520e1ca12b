/* gl_material.h - materials: which program draws one, its uniform block, its textures. */
#ifndef GL_GL_MATERIAL_H
#define GL_GL_MATERIAL_H

#include "gl/scene/gl_mesh.h"
#include "gl/scene/gl_phong.h"
#include "gl/core/gl_program.h"

typedef struct gl_material_set gl_material_set;

facet_result gl_material_create(gl_context *context, const facet_scene *scene,
                                const facet_allocator *allocator, gl_material_set **out, facet_error *error);
void gl_material_destroy(gl_material_set *set); /* NULL is allowed */

/* What is drawn of surfaces from here on; gl_material_update() sets the desc's. */
void gl_material_show(gl_material_set *set, facet_channel channel);

/* Blocks and textures of what the batches of all passes need; textures are decoded in parallel, once, and scaled down with
 * a warning where OpenGL cannot hold them. Fails with FACET_ERROR_MEMORY, FACET_ERROR_LIMIT. */
facet_result gl_material_update(gl_material_set *set, const gl_mesh_set *meshes,
                                const facet_render_desc *desc, facet_error *error);
/* The main that a batch is drawn by: GL_MAIN_PHONG where it has a material of OpenGL 1 and there is a set of those. */
gl_main gl_material_main(const gl_material_set *set, const gl_batch *batch);
void gl_material_use_phong(gl_material_set *set, const gl_phong *phong); /* NULL: none */
/* The program of a batch, as of the last update, apart from what light and transparency add (features of gl_program.h). */
uint64_t gl_material_features(const gl_material_set *set, const gl_batch *batch);
/* Whether OpenGL makes samples of the alpha of masks, and alpha 1 of those that are there: not OpenGL ES. */
bool gl_material_has_coverage(const gl_context *context);
/* Binds block and textures, and sets culling, and that samples are made of a mask's alpha. */
void gl_material_bind(const gl_material_set *set, const gl_batch *batch);
uint64_t gl_material_decoded_texels(const gl_material_set *set);

#endif
