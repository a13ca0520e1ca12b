/* gl_texture.h - the images of a scene as textures, with the same mips as on the CPU, and samplers. */
#ifndef GL_GL_TEXTURE_H
#define GL_GL_TEXTURE_H

#include "draw/texture.h"
#include "gl/core/gl_context.h"

/* Allocates the mip levels of the texture that is bound to GL_TEXTURE_2D, in GL_RGBA8, GL_SRGB8_ALPHA8 or
 * GL_RGBA16F. The storage is immutable where the context has that: drivers of ES 3.0 may refuse to draw into
 * a level outside of BASE_LEVEL and MAX_LEVEL otherwise, and Mesa holds two copies of the finest level for a
 * while. */
void gl_texture_allocate(const gl_context *context, uint32_t level_count, uint32_t format, uint32_t width,
                         uint32_t height);

typedef struct gl_texture_set gl_texture_set;

/* Decodes nothing yet. scene outlives the set. FACET_ERROR_MEMORY. */
facet_result gl_texture_create(gl_context *context, const facet_scene *scene,
                               const facet_allocator *allocator, gl_texture_set **out, facet_error *error);
void gl_texture_destroy(gl_texture_set *set); /* NULL is allowed */

/* Decodes, in parallel, and uploads the missing images of uses, one per texture of the scene. min_lod is
 * ignored, because the camera of a window moves. 8-bit colors stay in sRGB, 16-bit texels become half
 * floats. Warns once of an image that cannot be decoded, or that starts at a coarser mip because it
 * exceeds OpenGL's limit. Fails with FACET_ERROR_LIMIT (an image larger than scene->max_texture_size),
 * FACET_ERROR_MEMORY. */
facet_result gl_texture_update(gl_texture_set *set, const texture_use *uses, const facet_log *log,
                               uint32_t thread_count, facet_error *error);

/* OpenGL names of a texture and its sampler; texture may be any number. Texture 0: it reads as white, or
 * was not requested. Samplers are isotropic: surface_io.glsl takes the CPU's anisotropic probes. */
uint32_t gl_texture_name(const gl_texture_set *set, uint32_t texture, bool as_color);
const uint32_t *gl_texture_size(const gl_texture_set *set, uint32_t texture,
                                bool as_color); /* width, height */
/* Linear RGBA of the coarsest level; white where there is no such texture, or it is not uploaded. */
void gl_texture_mean(const gl_texture_set *set, uint32_t texture, bool as_color, float mean[4]);
bool gl_texture_lacks_red(const gl_texture_set *set, uint32_t texture); /* as data, after an update */
uint32_t gl_texture_sampler(gl_texture_set *set, uint32_t texture);
uint64_t gl_texture_decoded_texels(const gl_texture_set *set); /* since the set was created */

#endif
