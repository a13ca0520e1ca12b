/* render_check.h - warnings about a rendered image that shows nothing or is far too bright. */
#ifndef RENDER_RENDER_CHECK_H
#define RENDER_RENDER_CHECK_H

#include "film/film.h"
#include "scene/scene.h"

/* Warnings that one renderer has issued already; each comes once. {0}: none. */
typedef struct render_check {
    bool has_warned_of_nothing, has_warned_of_white;
} render_check;

/* Called before tone mapping. pose: of the rendered scene; NULL: computed where needed. desc: resolved. Warns
 * where nothing of the scene is visible, and where the median of the visible part is more than a stop above
 * white. Not for images of a sea. */
void render_check_film(render_check *check, const facet_scene *scene, const scene_pose *pose,
                       const facet_render_desc *desc, const film *drawn);

#endif
