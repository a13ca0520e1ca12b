/* gl_material.h - materials: program, uniform block and textures of each. */
#ifndef GL_GL_MATERIAL_H
#define GL_GL_MATERIAL_H

#include "gl/scene/gl_mesh.h"
#include "gl/scene/gl_phong.h"
#include "gl/core/gl_program.h"

typedef struct gl_material_set gl_material_set;

facet_result gl_material_create(gl_context *context, const facet_scene *scene,
                                const facet_allocator *allocator, gl_material_set **out, facet_error *error);
void gl_material_destroy(gl_material_set *set); /* NULL is allowed */

/* Selects the channel that is drawn from now on; gl_material_update() sets the desc's. */
void gl_material_show(gl_material_set *set, facet_channel channel);

/* Uploads the blocks and textures of all batches. Textures are decoded in parallel, once, and scaled down
 * with a warning where they exceed OpenGL's limit. Fails with FACET_ERROR_MEMORY, FACET_ERROR_LIMIT. */
facet_result gl_material_update(gl_material_set *set, const gl_mesh_set *meshes,
                                const facet_render_desc *desc, facet_error *error);
/* The main of a batch: GL_MAIN_PHONG for legacy materials where gl_material_use_phong() was called. */
gl_main gl_material_main(const gl_material_set *set, const gl_batch *batch);
void gl_material_use_phong(gl_material_set *set, const gl_phong *phong); /* NULL: none */
/* Features of a batch's program as of the last update, without those of light and transparency
 * (gl_program.h). */
uint64_t gl_material_features(const gl_material_set *set, const gl_batch *batch);
/* Whether alpha-to-coverage with alpha-to-one is available, which OpenGL ES lacks. */
bool gl_material_has_coverage(const gl_context *context);
/* No block of a material is larger, bytes. */
enum { GL_MATERIAL_BLOCK_SIZE = 1024 };
/* Binds block and textures, and sets culling and alpha-to-coverage. */
void gl_material_bind(const gl_material_set *set, const gl_batch *batch);
/* Uses the batch's program with all of these features, and binds its material. Fails as gl_programs_get(). */
facet_result gl_material_use(const gl_material_set *set, gl_programs *programs, const gl_batch *batch,
                             uint64_t features, facet_error *error);
/* Linear RGBA of a texture of a material, averaged; white: it has none. After an update. */
void gl_material_mean(const gl_material_set *set, const scene_material *material, scene_texture_slot slot,
                      float mean[4]);
/* OpenGL's name of a slot's texture, with its size in texels; 0: there is none, and the size is 0. */
uint32_t gl_material_texture(const gl_material_set *set, const scene_material *material,
                             scene_texture_slot slot, uint32_t size[2]);
/* Whether the texture shows its texels as squares where they are larger than pixels. */
bool gl_material_is_nearest(const gl_material_set *set, const scene_material *material,
                            scene_texture_slot slot);

/* A small copy of the textures that decide what a ray sees of a material where no fragment of it is drawn: four floats
 * per texel, base color (linear), and 255 alpha + 256 (255 transmission) + 65536 (255 roughness), each rounded. Texels
 * of one size, at the coordinates of one slot; texture coordinates repeat. */
typedef struct gl_material_sheet {
    uint32_t width, height;
    bool is_nearest; /* read without interpolation */
} gl_material_sheet;
enum { GL_MATERIAL_SHEET_SIZE = 256 }; /* most texels along an edge */
/* The slot with its coordinates. */
scene_texture_slot gl_material_sheet_slot(const scene_material *material);
gl_material_sheet gl_material_sheet_size(const gl_material_set *set, const scene_material *material);
/* Reads it back from OpenGL's textures. */
void gl_material_sheet_read(const gl_material_set *set, const scene_material *material,
                            const gl_material_sheet *sheet, float *texels);
uint64_t gl_material_decoded_texels(const gl_material_set *set);

#endif
