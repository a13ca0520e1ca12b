/* gl_light.h - the light of an image as textures, with the texels that light_setup.h prepares for the CPU.
 *
 * The environment's filtered cube maps and images are in one texture of half floats (gl_light_atlas.h),
 * punctual lights in one of 32-bit words. Shaders look them up as ibl.h and light_grid.h do:
 * environment.glsl, lights.glsl. */
#ifndef GL_GL_LIGHT_H
#define GL_GL_LIGHT_H

#include "draw/light_setup.h"
#include "gl/core/gl_blocks.h"
#include "gl/core/gl_context.h"
#include "gl/scene/gl_material.h"

typedef struct gl_light gl_light;

facet_result gl_light_create(gl_context *context, const facet_allocator *allocator, gl_light **out,
                             facet_error *error);
void gl_light_destroy(gl_light *light); /* NULL is allowed */
/* Uploads what is missing; keeps the environment until another one, or none, is used. desc: shadows and log;
 * bounds: of the scene. Fails with FACET_ERROR_MEMORY, FACET_ERROR_LIMIT. */
facet_result gl_light_update(gl_light *light, const light_setup *setup, const facet_render_desc *desc,
                             const float bounds_min[3], const float bounds_max[3], facet_error *error);
/* Draws the shadow maps and the ground's map where they are outdated: gl_shadow_draw(), gl_ground_draw(). */
facet_result gl_light_draw_shadows(gl_light *light, gl_programs *programs, const gl_mesh_set *meshes,
                                   const gl_material_set *materials, const float eye[3], uint64_t revision,
                                   facet_error *error);
/* Features that an image's programs have because of its light: GL_SURFACE_HAS_ENVIRONMENT and so on. */
uint64_t gl_light_features(const gl_light *light);
uint64_t gl_light_background_features(const gl_light *light, const facet_render_desc *desc);
/* Requests the programs of the shadow and ground passes. FACET_ERROR_MEMORY. */
facet_result gl_light_request_programs(const gl_light *light, gl_programs *programs, facet_error *error);
/* Whether there is a ground, the features of its program, and its texture, bound to GL_UNIT_MATERIAL. */
bool gl_light_has_ground(const gl_light *light);
uint64_t gl_light_ground_features(const gl_light *light);
void gl_light_bind_ground(const gl_light *light);
/* Binds the textures and the light block, and fills in the light members of the frame block. */
void gl_light_bind(const gl_light *light, gl_frame_block *block);

#endif
