/* tiles.h - renders an image tile by tile on several threads. */
#ifndef CPU_TILES_H
#define CPU_TILES_H

#include "cpu/shading_scene.h"
#include "film/film.h"

/* The image; {0} members as in facet_render_desc. */
typedef struct tiles_desc {
    const facet_render_desc *render;
    const shading_scene *scene;
    const struct raster *raster;             /* NULL: first hits are traced */
    const struct scene_identity *identities; /* per geometry; NULL: not needed by any layer */
    double deadline_s;                       /* of clock_seconds(); 0: none */
    bool draws_background;                   /* the environment, where nothing covers a pixel */
    bool has_ambient_occlusion;              /* the geometries have a hierarchy */
} tiles_desc;

/* Fills every layer of film. Adds to stats->rays and ->shades. Fails with FACET_ERROR_MEMORY,
 * FACET_ERROR_LIMIT past the deadline, FACET_ERROR_CANCELLED. */
facet_result tiles_draw(const tiles_desc *desc, film *film, facet_render_stats *stats, facet_error *error);
/* All layers of one sample: neither color (layer "") nor Cryptomatte. */
facet_result tiles_draw_aovs(const tiles_desc *desc, film *film, facet_render_stats *stats,
                             facet_error *error);

#endif
