/* water_scene.h - a sea for the path tracer: a scene of its surface and bed as triangles beside the model,
 * and the water as a path_surface. */
#ifndef WATER_WATER_SCENE_H
#define WATER_WATER_SCENE_H

#include "water/water_render.h"

typedef struct water_scene water_scene;

/* Of desc's sea, with scene (NULL: water only) in it. All three outlive it, and the cache, which nothing
 * else uses meanwhile. deadline_s: of clock_seconds(), 0: none. *out NULL where it fails, as
 * water_render() does. */
facet_result water_scene_create(water_cache *cache, const facet_scene *scene, const facet_render_desc *desc,
                                double deadline_s, water_scene **out, facet_render_stats *stats,
                                facet_error *error);
void water_scene_destroy(water_scene *w); /* NULL is allowed */

/* What path_render_prepared() draws; desc has the sky as environment, and the time that is left. */
const facet_scene *water_scene_get_scene(const water_scene *w);
const facet_render_desc *water_scene_get_desc(const water_scene *w);
const struct path_surface *water_scene_get_surface(const water_scene *w); /* path/path_surface.h */

#endif
