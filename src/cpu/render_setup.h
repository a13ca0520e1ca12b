/* render_setup.h - the prepared data of one image: geometry, BVH, textures, lights. prepared_scene.h has
 * what is kept from image to image. */
#ifndef CPU_RENDER_SETUP_H
#define CPU_RENDER_SETUP_H

#include "cpu/prepared_scene.h"
#include "cpu/shading_scene.h"
#include "draw/render_watch.h"
#include "film/film.h"

typedef struct render_setup {
    prepared_scene *prepared;
    const facet_render_desc *desc;
    facet_render_stats *stats;
    /* What the renderer does: */
    bool reads_everywhere;   /* textures are read at full size and outside of the view as well */
    bool reads_opacity_only; /* of textures of glTF materials: no hit is shaded */
    bool samples_light;      /* of light_setup_create() */
    bool rasterises;         /* first hits, where that is cheaper than tracing rays */
    camera_rays camera;
    struct raster *raster; /* NULL: first hits are traced */
    texture_use *uses;
    texture_set *textures;
    light_setup light;
    material_plan_set plans;
    struct scene_identity *identities; /* per geometry; NULL: not needed by any layer */
    shading_scene shading;             /* without ogl1 */
    double hierarchy_s, tangents_s;
} render_setup;

/* Prepares for desc (resolved, as for preview_render()); stages run concurrently where they can. Adds
 * times to stats. *setup comes with the members up to samples_light set and the rest {0};
 * release it with render_setup_destroy(), also after a failure. Fails as preview_render(). */
facet_result render_setup_create(render_setup *setup, facet_error *error);
void render_setup_destroy(render_setup *setup);

/* Calls attempt with the prepared scene; out of memory, it retries with nothing prepared. attempt: as
 * preview_render_prepared(), with context passed on; *has_setup: preparation was complete. p is valid
 * after success and failure. */
typedef facet_result render_attempt(const void *context, prepared_scene *p, const facet_render_desc *desc,
                                    double deadline_s, film *target, facet_render_stats *stats,
                                    bool *has_setup, facet_error *error);
facet_result render_with_prepared(render_attempt *attempt, const void *context, prepared_scene *p,
                                  const facet_render_desc *desc, film *target, facet_render_stats *stats,
                                  facet_error *error);

#endif
