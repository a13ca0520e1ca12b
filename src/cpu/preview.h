/* preview.h - the preview renderer: camera rays, prefiltered light, one shade per surface seen in a pixel. */
#ifndef CPU_PREVIEW_H
#define CPU_PREVIEW_H

#include "film/film.h"

struct prepared_scene; /* cpu/prepared_scene.h */

/* Renders scene into film as desc says (see facet.h; sizes, samples, crop and camera are resolved, camera
 * is not NULL). The film is linear radiance times 2^exposure_ev, premultiplied, before tone mapping and
 * background color. Fails with FACET_ERROR_MEMORY, _LIMIT (time, texture size), _CANCELLED, _ARGUMENT (a
 * camera without direction); a texture that cannot be decoded is a warning and sampled as white. */
facet_result preview_render(const facet_scene *scene, const facet_render_desc *desc, film *film,
                            facet_render_stats *stats, facet_error *error);
/* The same with a prepared scene, to which it adds what this image needs. Out of memory, it retries with
 * nothing prepared. p is valid after success and failure. Warns once of textures that cannot be decoded. */
facet_result preview_render_prepared(struct prepared_scene *p, const facet_render_desc *desc, film *film,
                                     facet_render_stats *stats, facet_error *error);

#endif
