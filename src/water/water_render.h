/* water_render.h - images of a sea on the CPU: each ray marches to the surface, which is shaded by
 * shade/water.h with what it reflects of the sky and what comes up from below. */
#ifndef WATER_WATER_RENDER_H
#define WATER_WATER_RENDER_H

#include "film/film.h"
#include "ocean/sea.h"

/* What images of a sea share from one to the next, so that a frame pays only for what moves: the prepared
 * sky and the history of its foam. It changes no pixel. {0} but for the allocator: empty. */
typedef struct water_cache {
    facet_allocator allocator;
    uint64_t sea_serial; /* of the sea that all of it was made for; 0: none */
    struct water_light *light;
    struct foam_history *foam;
} water_cache;
void water_cache_clear(water_cache *cache);

/* Draws as desc says (it has a sea; sizes, samples, crop, camera and environment are resolved already)
 * into film: linear radiance (cd/m^2) times 2^exposure_ev. scene: NULL, or what stands and floats in the
 * water. FACET_ERROR_MEMORY, _LIMIT (time), _CANCELLED, _ARGUMENT. */
facet_result water_render(water_cache *cache, const facet_scene *scene, const facet_render_desc *desc,
                          film *film, facet_render_stats *stats, facet_error *error);

/* EV at ISO 100 for what desc's camera sees of its sea, by a meter for reflected light:
 *   EV100 = log2(L / (1.2 key)),  L = exp(mean of ln(L_i))  over the pixels of a small image, in cd/m^2
 * (film/meter.h). Averages below 1e-3 cd/m^2 count as that, with a warning: a night without a moon stays
 * dark. Samples, crop and exposure of desc do not matter, and the surface counts as physical without
 * glints. Fails as water_render(). */
facet_result water_meter(water_cache *cache, const facet_render_desc *desc, double *ev100,
                         facet_error *error);

/* Warns where the camera stands below the bed, which is drawn dark, as no light gets there; and where
 * waves put it on the other side of the surface than still water would. */
void water_warn_of_eye(const facet_render_desc *desc);

#endif
