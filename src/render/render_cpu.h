/* render_cpu.h - the functions of the preview's row and of path tracing's in renderer.c. Both need Embree. */
#ifndef RENDER_RENDER_CPU_H
#define RENDER_RENDER_CPU_H

#include "render/renderer_set.h"

facet_result render_cpu_create(renderer_set *set, void **state, facet_error *error);
void render_cpu_destroy(void *state);
facet_result render_preview_draw(void *state, const facet_render_desc *desc, film *target,
                                 facet_render_stats *stats, facet_error *error);
facet_result render_path_resolve(facet_render_desc *desc, facet_error *error);
facet_result render_path_draw(void *state, const facet_render_desc *desc, film *target,
                              facet_render_stats *stats, facet_error *error);

#endif
