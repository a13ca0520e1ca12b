/* empty_view.h - why an image of a scene shows nothing of it: one sentence with what to do. */
#ifndef DRAW_EMPTY_VIEW_H
#define DRAW_EMPTY_VIEW_H

#include "draw/camera_rays.h"
#include "scene/scene.h"

/* Examines what the pose draws through the camera of desc (resolved, with a camera). Writes to why what
 * keeps it from being seen, and what helps. False: something may be seen, except for transparent textures
 * and details smaller than a pixel, which why then mentions. */
bool empty_view_explain(const facet_scene *scene, const scene_pose *pose, const facet_render_desc *desc,
                        const camera_rays *camera, char *why, size_t size);

#endif
