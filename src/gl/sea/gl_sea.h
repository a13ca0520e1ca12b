/* gl_sea.h - a sea drawn by OpenGL: water/water_frame.h into a film.
 *
 * The surface is a mesh: a fan around the eye, whose nodes a pass of its own displaces by the waves. Its
 * fragments read the tiles of waves and are shaded by the shader library, as the places of the preview
 * are. The samples of a pixel are images of their own. */
#ifndef GL_GL_SEA_H
#define GL_GL_SEA_H

#include "film/film.h"
#include "gl/core/gl_context.h"
#include "gl/gl_entry.h"
#include "water/water_frame.h"

/* Has a context of its own, current on no thread between calls. FACET_ERROR_SYSTEM, _MEMORY. */
facet_result gl_sea_create(const facet_allocator *allocator, gl_sea **out, facet_error *error);
facet_result gl_sea_create_api(gl_api wanted, const facet_allocator *allocator, gl_sea **out,
                               facet_error *error);
void gl_sea_destroy(gl_sea *sea); /* NULL is allowed */

/* Linear radiance times exposure, as in the preview, or display values for the legacy styles. film: of the
 * desc's crop. Fails as water_render(), with FACET_ERROR_UNSUPPORTED: parallel rays; with
 * FACET_ERROR_SYSTEM. */
facet_result gl_sea_draw(gl_sea *sea, const water_frame *frame, film *target, facet_render_stats *stats,
                         facet_error *error);

#endif
