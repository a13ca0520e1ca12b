/* path_render.h - the path tracer: passes over the picture until it has its samples, is calm enough, or time is up. */
#ifndef PATH_RENDER_H
#define PATH_RENDER_H

#include "cpu/render_setup.h"

struct path_surface; /* path_surface.h */

/* As preview_render_prepared(), for desc->renderer FACET_RENDERER_KIND_PATH. surface: of the scene's primitives that have water; NULL: none has. Past the time limit, or cancelled with
 * keeps_cancelled, the film has what there is and stats->is_partial is set; FACET_ERROR_LIMIT, _CANCELLED where that is
 * not a sample for each pixel. Fails also as path_film_load(), path_checkpoint_check(); a checkpoint that cannot be written is a warning. desc->path.pass is told of
 * passes with NULL for the image: the picture so far is in the film. */
facet_result path_render_prepared(prepared_scene *p, const facet_render_desc *desc,
                                  const struct path_surface *surface, film *target, facet_render_stats *stats,
                                  facet_error *error);

#endif
