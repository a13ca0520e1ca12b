/* options_table.h - what the files of the option table share: one file per verb, options_shared.c for what several have.
 * options.h is what all others read. */
#ifndef CLI_OPTIONS_TABLE_H
#define CLI_OPTIONS_TABLE_H

#include "cli/options.h"

#include <stdint.h>

#define COUNT(array) (sizeof(array) / sizeof *(array))
#define WORDS(...)                                                                                           \
    (const char *const[])                                                                                    \
    {                                                                                                        \
        __VA_ARGS__, NULL                                                                                    \
    }

extern const option_group machine_group, message_group, running_group, working_group, model_group, root_group,
    legacy_group, path_group, gl_group, light_group, environment_group, color_group, shading_group,
    quality_group, scene_group, sea_group, water_group, window_group, window_camera_group,
    window_motion_group, window_path_group;
extern const verb render_verb, convert_verb, plot_verb, compare_verb, bake_verb, shaders_verb, view_verb,
    ocean_verb;

#endif
