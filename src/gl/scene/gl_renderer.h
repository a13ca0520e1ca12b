/* gl_renderer.h - renders a scene with OpenGL, into a film (gl_entry.h) or into the framebuffer of a window. */
#ifndef GL_GL_RENDERER_H
#define GL_GL_RENDERER_H

#include "film/film.h"
#include "gl/core/gl_context.h"
#include "gl/gl_entry.h"
#include "gl/core/gl_timers.h"

/* context: the caller's (a window's), which outlives the renderer; NULL: a context of its own, which is
 * current for no thread between calls. Fails with FACET_ERROR_SYSTEM, FACET_ERROR_MEMORY. */
facet_result gl_renderer_create(const facet_scene *scene, gl_context *context,
                                const facet_allocator *allocator, gl_renderer **out, facet_error *error);
void gl_renderer_destroy(gl_renderer *renderer); /* NULL is allowed */

/* Renders into a film: linear radiance, as the preview does. The renderer's own context is replaced for
 * the next image where it was lost or ran out of memory. Fails as preview_render(), and with
 * FACET_ERROR_SYSTEM. */
facet_result gl_renderer_render(gl_renderer *renderer, const facet_render_desc *desc, film *target,
                                facet_render_stats *stats, facet_error *error);
/* Renders a frame of a window: tone-mapped, sRGB-encoded, over the background, into a rectangle of a
 * framebuffer with lower left corner (x, y) and desc's size. FACET_QUALITY_DRAFT, for frames of a motion: textures
 * are read once for the footprint of a pixel. */
facet_result gl_renderer_present(gl_renderer *renderer, const facet_render_desc *desc, uint32_t framebuffer,
                                 int x, int y, facet_render_stats *stats, facet_error *error);

/* The renderer's own context ({0} where it does not exist yet), or the caller's. */
gl_context *gl_renderer_get_context(gl_renderer *renderer);
/* Times of the passes of the last image; for a window, of the last one whose results have arrived. */
gl_times gl_renderer_get_times(const gl_renderer *renderer);

#endif
