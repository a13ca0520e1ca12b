/* render_camera.h - the camera that the options ask for, given the model. */
#ifndef CLI_RENDER_CAMERA_H
#define CLI_RENDER_CAMERA_H

#include "cli/render_options.h"

/* How far the camera stays from the model, the same for all pictures of a turntable. {0}: as each picture fits. */
typedef struct turntable_fit {
    float radius, ortho_height; /* m */
} turntable_fit;

/* The largest fit of all frames, so that the model neither leaves the picture nor changes its size. */
facet_result render_turntable_fit(const facet_scene *scene, uint32_t scene_index,
                                  const render_options *options, turntable_fit *fit, facet_error *error);

/* The camera of one frame (from 0) of a turntable, or of the one picture. */
facet_result render_camera(const facet_scene *scene, uint32_t scene_index, const render_options *options,
                           const turntable_fit *fit, uint32_t frame, facet_camera *camera,
                           facet_error *error);

#endif
