/* render_check.h - what is looked for in every image that was drawn, whatever drew it. */
#ifndef RENDER_RENDER_CHECK_H
#define RENDER_RENDER_CHECK_H

#include "film/film.h"
#include "scene/scene.h"

/* What was reported of the images of one renderer: each warning comes once. {0}: nothing. */
typedef struct render_check {
    bool has_warned_of_nothing, has_warned_of_white;
} render_check;

/* Before development. pose: what was drawn, where it is at hand; NULL: is found out where it is needed. desc: as resolved. Warns
 * to desc's log where nothing of the scene is seen, and where the median of what is seen is more than a stop beyond white. Not for
 * images of a sea. */
void render_check_film(render_check *check, const facet_scene *scene, const scene_pose *pose,
                       const facet_render_desc *desc, const film *drawn);

#endif
