/* render_camera.h - the camera that the options ask for, given the model. */
#ifndef CLI_RENDER_CAMERA_H
#define CLI_RENDER_CAMERA_H

#include "cli/render_options.h"

/* The camera of one frame (from 0) of a turntable, or of the one picture. */
facet_result render_camera(const facet_scene *scene, const facet_pose_desc *pose,
                           const render_options *options, uint32_t frame, facet_camera *camera,
                           facet_error *error);

#endif
