/* renderer.h - one interface to all renderers. Each is a row of the table in renderer.c: what it can do
 * (facet_renderer_info) and four functions, resolve, create, draw and destroy. All drawing goes through
 * the table, and src/api and src/cli ask it what a renderer can do. A renderer passes what it finds by
 * itself to the code that it shares with others (render_setup of src/cpu, water_setup_create()), which does
 * not compare desc.renderer. The window (src/view) has a table of its own, but names _KIND_GL where only
 * OpenGL can follow: channels, and the images that it shows while it is used. */
#ifndef RENDER_RENDERER_H
#define RENDER_RENDERER_H

#include "film/film.h"

enum { RENDERER_COUNT = FACET_RENDERER_KIND_GL + 1 };
typedef struct renderer_set renderer_set; /* renderer_set.h */

typedef struct renderer_row {
    const char *title; /* in messages */
    facet_renderer_info info;
    const char *lacks; /* the library that this build lacks for it: there are no functions; NULL: none */
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

/* desc with all defaults but the camera filled in. FACET_ERROR_ARGUMENT: what is wrong with
 * it. FACET_ERROR_SYSTEM: this build has no such renderer. */
facet_result render_desc_resolve(const facet_render_desc *desc, facet_render_desc *out, facet_error *error);

#endif
