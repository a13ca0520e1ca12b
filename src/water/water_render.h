/* water_render.h - pictures of a sea on the CPU: each ray marches to the surface, which is shaded by shade/water.h with what it
 * reflects of the sky and what comes up from below. */
#ifndef WATER_WATER_RENDER_H
#define WATER_WATER_RENDER_H

#include "film/film.h"
#include "ocean/sea.h"

/* Draws as desc says (sizes, samples, crop, camera and environment are resolved already) into film: linear radiance (cd/m^2)
 * times 2^exposure_ev. scene: NULL, or what stands and floats in the water. FACET_ERROR_MEMORY, _LIMIT (time), _CANCELLED, _ARGUMENT. */
facet_result water_render(const facet_sea *sea, const facet_scene *scene, const facet_sea_render_desc *desc,
                          film *film, facet_render_stats *stats, facet_error *error);

/* Warns where the camera stands below the bed, which is drawn as it is: dark, as there is no light; and where waves have it on the other side of the
 * surface than still water would. */
void water_warn_of_eye(const facet_sea *sea, const facet_sea_render_desc *d);

#endif
