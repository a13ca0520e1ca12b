/* ground_shadow.h - the model's shadow on an invisible ground, for the preview: FACET_GROUND_SHADOW.
 *
 * The shadow is the share of the light on a white diffuser at the ground that the model blocks, of the environment,
 * the sun and punctual lights, as in path tracing (path_trace.c), without what the model reflects there. The ground
 * is the plane through the model's lowest point, visible from above. */
#ifndef CPU_GROUND_SHADOW_H
#define CPU_GROUND_SHADOW_H

#include "cpu/shading_scene.h"
#include "film/film.h"

typedef struct ground_shadow_desc {
    const facet_render_desc *render; /* resolved */
    const shading_scene *scene;
    float height_m;     /* of the plane, along +Y */
    float model_size_m; /* largest extent */
    double deadline_s;  /* of clock_seconds(); 0: none */
} ground_shadow_desc;

/* Composites the shadow below the image of target, which has no background yet: black with the opacity of the
 * shadow. The result does not depend on thread_count; a crop has the pixels of the whole image. Adds to stats->rays.
 * Fails with FACET_ERROR_MEMORY, and as render_check_limits(). */
facet_result ground_shadow_draw(const ground_shadow_desc *desc, film *target, facet_render_stats *stats,
                                facet_error *error);

#endif
