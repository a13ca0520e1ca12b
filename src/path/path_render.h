/* path_render.h - the path tracer: passes over the image until it has its samples, its noise is below the
 * limit, or time is up. */
#ifndef PATH_RENDER_H
#define PATH_RENDER_H

#include "cpu/render_setup.h"

enum { PATH_DEFAULT_DEPTH = 64 }; /* of facet_path_desc.max_depth */

struct path_surface; /* path_surface.h */

/* The samples of a pixel, numbered from 0, that a part by samples has of all of them. */
static inline void path_part_get_samples(const facet_part_desc *part, uint32_t samples, uint32_t *first,
                                         uint32_t *end)
{
    *first = (uint32_t)((uint64_t)samples * part->index / part->count);
    *end = (uint32_t)((uint64_t)samples * (part->index + 1) / part->count);
}

/* As preview_render_prepared(), for desc->renderer FACET_RENDERER_KIND_PATH. surface: of the scene's
 * primitives that have water; NULL: none has. Past the time limit, or cancelled with keeps_cancelled, the
 * film has the samples so far and stats->is_partial is set; FACET_ERROR_LIMIT, _CANCELLED where a pixel
 * has none. Fails also as path_film_load(), path_checkpoint_check(); a checkpoint that cannot be written
 * is a warning. desc->path.pass is called with NULL for the image: the film has the image so far. */
facet_result path_render_prepared(prepared_scene *p, const facet_render_desc *desc,
                                  const struct path_surface *surface, film *target, facet_render_stats *stats,
                                  facet_error *error);

#endif
