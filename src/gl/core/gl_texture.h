/* gl_texture.h - the images of a scene in OpenGL's memory, with the mips that the CPU's lookups read, and samplers. */
#ifndef GL_GL_TEXTURE_H
#define GL_GL_TEXTURE_H

#include "draw/texture.h"
#include "gl/core/gl_context.h"

typedef struct gl_texture_set gl_texture_set;

/* Nothing is decoded yet. scene outlives the set. FACET_ERROR_MEMORY. */
facet_result gl_texture_create(gl_context *context, const facet_scene *scene,
                               const facet_allocator *allocator, gl_texture_set **out, facet_error *error);
void gl_texture_destroy(gl_texture_set *set); /* NULL is allowed */

/* Decodes, in parallel, and uploads what uses (one per texture of the scene) ask for and is not there; min_lod is not
 * looked at: what a window shows comes nearer. 8-bit colors stay in sRGB, 16-bit texels become half floats. An image that
 * cannot be decoded, or is larger than OpenGL's textures and starts at a coarser mip, is a warning to log, once. Fails
 * with FACET_ERROR_LIMIT (an image larger than scene->max_texture_size), FACET_ERROR_MEMORY. */
facet_result gl_texture_update(gl_texture_set *set, const texture_use *uses, const facet_log *log,
                               uint32_t thread_count, facet_error *error);

/* OpenGL's names of a texture and its sampler; texture may be any number. Texture 0: it reads as white, or was not asked
 * for. Samplers are isotropic: material.glsl makes several lookups where the CPU does. */
uint32_t gl_texture_name(const gl_texture_set *set, uint32_t texture, bool as_color);
bool gl_texture_lacks_red(const gl_texture_set *set, uint32_t texture); /* read as data, and known */
uint32_t gl_texture_sampler(gl_texture_set *set, uint32_t texture);
uint64_t gl_texture_decoded_texels(const gl_texture_set *set); /* since the set was made */

#endif
