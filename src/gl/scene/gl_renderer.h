/* gl_renderer.h - a scene drawn by OpenGL: for gl_entry.h into a film, for a window into its framebuffer. */
#ifndef GL_GL_RENDERER_H
#define GL_GL_RENDERER_H

#include "film/film.h"
#include "gl/core/gl_context.h"
#include "gl/gl_entry.h"
#include "gl/core/gl_timers.h"

/* With a context of its own, which is current for no thread between calls, or the caller's (a window's), which outlives
 * it. Fails with FACET_ERROR_SYSTEM, FACET_ERROR_MEMORY. */
facet_result gl_renderer_create(const facet_scene *scene, gl_context *context /* NULL: its own */,
                                const facet_allocator *allocator, gl_renderer **out, facet_error *error);
void gl_renderer_destroy(gl_renderer *renderer); /* NULL is allowed */

/* Into a film, which is linear radiance, as that of the preview. A context of its own that was lost, or whose memory ran
 * out, is followed by a new one with the next picture. Fails as preview_render(), and with FACET_ERROR_SYSTEM. */
facet_result gl_renderer_render(gl_renderer *renderer, const facet_render_desc *desc, film *target,
                                facet_render_stats *stats, facet_error *error);
/* As the display wants it (tone-mapped, sRGB-encoded, background behind) into a rectangle of a framebuffer: a frame of a
 * window. desc as above, its size is the rectangle's. x, y: lower left corner. */
facet_result gl_renderer_present(gl_renderer *renderer, const facet_render_desc *desc, uint32_t framebuffer,
                                 int x, int y, facet_render_stats *stats, facet_error *error);

/* Its own, {0} where it has none yet, or the caller's. */
gl_context *gl_renderer_get_context(gl_renderer *renderer);
/* What the passes of the last picture took; of a window: of the last one whose timers have answered. */
gl_times gl_renderer_get_times(const gl_renderer *renderer);

#endif
