/* renderer_set.h - the renderers of one facet_renderer: what they keep, the default camera, drawing through the
 * table of renderer.h, the light meter, and warnings about images that show nothing or white only. */
#ifndef RENDER_RENDERER_SET_H
#define RENDER_RENDERER_SET_H

#include "cpu/prepared_scene.h"
#include "render/renderer.h"
#include "water/water_render.h"

/* The renderers of one facet_renderer, and what they share and keep from image to image. It stays where it
 * is between init and clear. */
struct renderer_set {
    const facet_scene *scene; /* NULL: none, or not at hand (a window's) */
    facet_allocator allocator;
    prepared_scene prepared;      /* of scene, for the renderers on the CPU */
    water_cache water;            /* of the sea that was drawn last */
    void *states[RENDERER_COUNT]; /* NULL: not used yet */
    bool has_warned_of_nothing, has_warned_of_white, has_hinted_at_outline; /* each comes once */
    bool has_checked_sea_camera; /* whether the default camera in a sea shows the scene */
};

void renderer_set_init(renderer_set *set, const facet_scene *scene, const facet_allocator *allocator);
void renderer_set_clear(renderer_set *set); /* as after init */

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
