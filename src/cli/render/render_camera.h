/* render_camera.h - the camera that the options ask for, given the model. */
#ifndef CLI_RENDER_CAMERA_H
#define CLI_RENDER_CAMERA_H

#include "cli/render/render_options.h"

/* The camera of a picture: what shows pose, turned by turn (of a whole turn) around the model. moves: the same camera
 * frames the whole motion. */
typedef struct render_view {
    const facet_pose_desc *pose;
    double turn;
    bool turns, moves;
} render_view;
facet_result render_camera(const facet_scene *scene, const render_view *view, const render_options *options,
                           facet_camera *camera, facet_error *error);

/* The orbit of the options with their target, if any of it is given. */
facet_orbit render_orbit(const facet_scene *scene, const facet_pose_desc *pose,
                         const render_options *options);
/* For the pictures that follow: the target and distance of a camera that frames all of them, found once. */
void render_keep_framing(render_options *options, const facet_scene *scene, const facet_camera *camera);

#endif
