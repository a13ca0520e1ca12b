/* preview.h - the preview renderer: camera rays, prefiltered light, one shade per surface seen in a pixel. */
#ifndef CPU_PREVIEW_H
#define CPU_PREVIEW_H

#include "cpu/prepared_scene.h"
#include "film/film.h"

/* Draws scene as desc says (see facet.h; sizes, samples, crop and camera are already resolved, camera is not NULL) into
 * film. The film is linear radiance times 2^exposure_ev, premultiplied: tone mapping and the background color come
 * after. Fails with FACET_ERROR_MEMORY, _LIMIT (time, texture size), _CANCELLED, _ARGUMENT (a camera that looks
 * nowhere); a texture that cannot be decoded is a warning and sampled as white. */
facet_result preview_render(const facet_scene *scene, const facet_render_desc *desc, film *film,
                            facet_render_stats *stats, facet_error *error);
/* The same with what is prepared already; what this image needs beside is added. Where memory runs out it starts
 * again with nothing prepared. Whatever comes back, p can be used on. Of textures that cannot be decoded it warns once. */
facet_result preview_render_prepared(prepared_scene *p, const facet_render_desc *desc, film *film,
                                     facet_render_stats *stats, facet_error *error);

#endif
