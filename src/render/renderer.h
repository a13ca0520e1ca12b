/* renderer.h - one interface to all renderers. Each is a row of the table in renderer.c: what it can do
 * (facet_renderer_info) and four functions, resolve, create, draw and destroy. All drawing goes through
 * the table, and src/api and src/cli ask it what a renderer can do. Below it code compares desc.renderer:
 * draw/light_setup.c and cpu/render_setup.c (what path tracing finds by itself), src/water (the same for
 * the bed) and the window, whose renderers are a table in src/view/view_state.c. */
#ifndef RENDER_RENDERER_H
#define RENDER_RENDERER_H

#include "cpu/prepared_scene.h"
#include "film/film.h"
#include "water/water_render.h"

/* The renderers of one facet_renderer, and what they share and keep from image to image. It stays where it
 * is between init and clear. */
enum { RENDERER_COUNT = FACET_RENDERER_KIND_GL + 1 };
typedef struct renderer_set {
    const facet_scene *scene; /* NULL: none, or not at hand (a window's) */
    facet_allocator allocator;
    prepared_scene prepared;                         /* of scene, for the renderers on the CPU */
    water_cache water;                               /* of the sea that was drawn last */
    void *states[RENDERER_COUNT];                    /* NULL: not used yet */
    bool has_warned_of_nothing, has_warned_of_white; /* each warning comes once */
} renderer_set;

typedef struct renderer_row {
    const char *title; /* in messages */
    facet_renderer_info info;
    /* Poses the scene by itself: outside of a sea, draw() fits the camera where desc has none, and
     * set->prepared is not used. */
    bool poses_scene;
    /* Refuses what it cannot draw beyond info (FACET_ERROR_ARGUMENT), and fills in its own defaults. NULL:
     * neither. */
    facet_result (*resolve)(facet_render_desc *desc, facet_error *error);
    facet_result (*create)(renderer_set *set, void **state, facet_error *error);
    /* Draws what desc (resolved, with a camera) describes into target: linear radiance times
     * 2^exposure_ev, premultiplied, and the AOVs. state stays usable whatever comes back. */
    facet_result (*draw)(void *state, const facet_render_desc *desc, film *target, facet_render_stats *stats,
                         facet_error *error);
    void (*destroy)(void *state);
} renderer_row;

const renderer_row *renderer_get(facet_renderer_kind kind); /* NULL: there is none */

void renderer_set_init(renderer_set *set, const facet_scene *scene, const facet_allocator *allocator);
void renderer_set_clear(renderer_set *set); /* as after init */

/* desc with all defaults but the camera filled in. FACET_ERROR_ARGUMENT: what is wrong with it. */
facet_result render_desc_resolve(const facet_render_desc *desc, facet_render_desc *out, facet_error *error);

/* The default camera of a resolved desc without one: that of the sea, or one that shows the whole scene. */
facet_result renderer_set_camera(renderer_set *set, const facet_render_desc *desc, facet_camera *camera,
                                 facet_error *error);

/* Draws a resolved desc, with its camera, by the renderer that it names. Warns where an image of a scene
 * shows nothing, and where the median of its visible part is more than a stop above white. */
facet_result renderer_set_draw(renderer_set *set, const facet_render_desc *desc, film *target,
                               facet_render_stats *stats, facet_error *error);

/* What a camera's light meter reads of a resolved desc: facet_renderer_meter(). */
facet_result renderer_set_meter(renderer_set *set, const facet_render_desc *desc, double *ev100,
                                facet_error *error);

#endif
