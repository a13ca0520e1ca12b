/* path_options.h - what the options that belong to one renderer ask for: the path tracer's, and OpenGL's. */
#ifndef CLI_PATH_OPTIONS_H
#define CLI_PATH_OPTIONS_H

#include "cli/render/render_options.h"

/* Reads --renderer and what depends on it, after all that is not about it. Fails with FACET_ERROR_ARGUMENT, also where an
 * option says nothing to the renderer. */
facet_result path_options_read(const command_line *c, render_options *out, facet_error *error);

/* Gives the camera its lens. */
void path_options_set_lens(const render_options *o, const facet_scene *scene, const facet_pose_desc *pose,
                           facet_camera *camera);

#endif
