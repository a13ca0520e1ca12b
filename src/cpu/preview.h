/* preview.h - the preview renderer: camera rays, prefiltered light, one shade per surface seen in a pixel. */
#ifndef CPU_PREVIEW_H
#define CPU_PREVIEW_H

#include "film/film.h"
#include "scene/scene.h"

/* Draws scene as desc says (see facet.h; sizes, samples and camera are already resolved, camera is not NULL) into
 * film. The film is linear radiance times 2^exposure_ev, premultiplied: tone mapping and the background color
 * come after. Fails with FACET_ERROR_MEMORY, _LIMIT (time, texture size), _CANCELLED; a texture that cannot be
 * decoded is a warning and sampled as white. */
facet_result preview_render(const facet_scene *scene, const facet_render_desc *desc, film *film,
                            facet_render_stats *stats, facet_error *error);

#endif
