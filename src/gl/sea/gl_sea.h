/* gl_sea.h - a sea drawn by OpenGL: water/water_frame.h into a film.
 *
 * The surface is a mesh: a fan around the eye, whose nodes a pass of its own displaces by the waves. Its
 * fragments read the tiles of waves and are shaded by the shader library, as the places of the preview
 * are. The samples of a pixel are images of their own. */
#ifndef GL_GL_SEA_H
#define GL_GL_SEA_H

#include "film/film.h"
#include "gl/core/gl_target.h"
#include "gl/gl_entry.h"
#include "water/water_frame.h"

/* Has a context of its own, current on no thread between calls. FACET_ERROR_SYSTEM, _MEMORY. */
facet_result gl_sea_create(const facet_allocator *allocator, gl_sea **out, facet_error *error);
facet_result gl_sea_create_api(gl_api wanted, const facet_allocator *allocator, gl_sea **out,
                               facet_error *error);
/* In the caller's context (a window's), which outlives it and is current in all calls. */
facet_result gl_sea_create_within(gl_context *context, const facet_allocator *allocator, gl_sea **out,
                                  facet_error *error);
void gl_sea_destroy(gl_sea *sea); /* NULL is allowed */

/* Linear radiance times exposure, as in the preview, or display values for the legacy styles. film: of the
 * desc's crop. Fails as water_render(), with FACET_ERROR_UNSUPPORTED: parallel rays; with
 * FACET_ERROR_SYSTEM. */
facet_result gl_sea_draw(gl_sea *sea, const water_frame *frame, film *target, facet_render_stats *stats,
                         facet_error *error);

/* Starts to compile what the frame needs. *is_ready: drawing it waits for no compiler. */
facet_result gl_sea_request(gl_sea *sea, const water_frame *frame, bool *is_ready, facet_error *error);

/* Where a window shows an image: the framebuffer, and the image's lower left corner in it. */
typedef struct gl_sea_place {
    uint32_t framebuffer;
    int x, y;
} gl_sea_place;

/* Shows rows of the crop of desc's image in a window, tone-mapped and sRGB-encoded: sample number `pass` of
 * desc->samples, averaged with the earlier ones of the same frame (after the last one nothing is drawn anew), which are in
 * `mean`. It is the caller's: {0} at first, gl_target_destroy() at last.
 * rows: the first one, counted from the top of the crop, and their number. Where the first one is not 0, the last call was
 * for the rows above of the same frame and sample: what the whole image needs is drawn with its first rows.
 * Fails as gl_sea_draw(). */
facet_result gl_sea_present(gl_sea *sea, const water_frame *frame, gl_target *mean, uint32_t pass,
                            const uint32_t rows[2], const gl_sea_place *to, facet_render_stats *stats,
                            facet_error *error);

#endif
