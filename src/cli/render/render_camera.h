/* render_camera.h - the camera of an image, from options and model. */
#ifndef CLI_RENDER_CAMERA_H
#define CLI_RENDER_CAMERA_H

#include "cli/render/render_options.h"

/* The camera of an image at a pose, rotated around the model by turn, a fraction of a full turn. moves:
 * the same camera frames the whole motion. */
typedef struct render_view {
    const facet_pose_desc *pose;
    double turn;
    bool turns, moves;
} render_view;
facet_result render_camera(const facet_scene *scene, const render_view *view, const render_options *options,
                           facet_camera *camera, facet_error *error);

/* The orbit of the options, with its target if any coordinate is given. */
facet_orbit render_orbit(const facet_scene *scene, const facet_pose_desc *pose,
                         const render_options *options);
/* Keeps target and distance of the first camera for the following images. */
void render_keep_framing(render_options *options, const facet_scene *scene, const facet_camera *camera);

#endif
