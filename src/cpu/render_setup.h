/* render_setup.h - all that is made for one image before light is computed: geometry, its hierarchy, textures,
 * lights. What is kept from image to image is in prepared_scene.h. */
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
    bool reads_everywhere; /* textures are read at full size and off the image as well: rays go anywhere */
    camera_rays camera;
    texture_use *uses;
    texture_set *textures;
    light_setup light;
    material_plan_set plans;
    struct scene_identity *identities; /* per geometry; NULL: no layer asks for them */
    shading_scene shading;             /* without ogl1 */
    double hierarchy_s, tangents_s;
} render_setup;

/* Makes it for desc (resolved, as for preview_render()); the stages run at the same time where they can. Fills the
 * times of stats. *setup comes with prepared, desc, stats and reads_everywhere set and the rest {0}; whatever comes
 * back, release it with render_setup_destroy(). Fails as preview_render(). */
facet_result render_setup_create(render_setup *setup, facet_error *error);
void render_setup_destroy(render_setup *setup);

/* Draws once with what is prepared; where memory runs out it starts again with nothing prepared. draw: as
 * preview_render_prepared(); context is passed on to it; *has_setup tells whether all was prepared. Whatever comes back, p can be used on. */
typedef facet_result render_attempt(const void *context, prepared_scene *p, const facet_render_desc *desc,
                                    double deadline_s, film *target, facet_render_stats *stats,
                                    bool *has_setup, facet_error *error);
facet_result render_with_prepared(render_attempt *attempt, const void *context, prepared_scene *p,
                                  const facet_render_desc *desc, film *target, facet_render_stats *stats,
                                  facet_error *error);

#endif
