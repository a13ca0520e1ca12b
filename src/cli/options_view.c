/* options_view.c - facet view. See options_table.h. */
#include "cli/options_table.h"

static const option script_options[] = {
    {.id = OPT_SCRIPT,
     .name = "script",
     .kind = OPTION_FILE,
     .argument = "FILE",
     .help = "play the input in this file (-: standard input) instead of waiting for a person, then close; "
             "view.md of facet help documents has the words"},
    {.id = OPT_CONFIG,
     .name = "config",
     .kind = OPTION_FILE,
     .argument = "FILE.json",
     .help = "options from a JSON object with the long names as members; the command line wins"},
};
static const option_group script_group = {"Running", script_options, COUNT(script_options)};

static const option view_message_options[] = {
    {.id = OPT_QUIET, .name = "quiet", .letter = 'q', .kind = OPTION_FLAG, .help = "errors only"},
    {.id = OPT_VERBOSE,
     .name = "verbose",
     .letter = 'v',
     .kind = OPTION_COUNT,
     .help = "details of what is read"},
    {.id = OPT_HELP,
     .name = "help",
     .letter = 'h',
     .kind = OPTION_FLAG,
     .help = "help with the options that matter most"},
    {.id = OPT_HELP_ALL, .name = "help-all", .kind = OPTION_FLAG, .help = "help with all options"},
};
static const option_group view_message_group = {"Messages", view_message_options,
                                                COUNT(view_message_options)};

const verb view_verb = {
    .name = "view",
    .summary = "show models in a window",
    .arguments = "[MODEL|FOLDER...]",
    .max_arguments = SIZE_MAX,
    .file_types = "glb gltf obj stl ply json",
    .output_types = "png jpg jpeg webp exr hdr pfm y4m",
    .output_hint = "facet render MODEL -o",
    .description =
        "Opens a window that shows the MODEL; the arrow keys go through the others of its folder, or through "
        "all that are "
        "named. Drag to orbit, right drag to move, the wheel comes nearer; H lists the keys. Models, folders "
        "and "
        "environments can be dropped on it, and a model is read again when its files change. Without a MODEL "
        "the built-in "
        "scene is shown.\n\n"
        "It is drawn with OpenGL as facet render --renderer gl draws it; R switches to path tracing, which "
        "converges while "
        "one looks. Ctrl+C copies the facet render command line of the view. Exit code 8: there is no "
        "display, "
        "GLFW or "
        "OpenGL.",
    .examples = (const example[]){{"facet view helmet.glb", "one model, and the others of its folder"},
                                  {"facet view models/ --env studio.hdr --background env",
                                   "a folder, in a light of your own"},
                                  {"facet view ring.glb --renderer path --ground shadow", "path traced"},
                                  {NULL, NULL}},
    .basics =
        (const option_id[]){OPT_ENV, OPT_BACKGROUND, OPT_EXPOSURE, OPT_TONE_MAPPING, OPT_ORBIT, OPT_RENDERER,
                            OPT_GROUND, OPT_ANIMATION, OPT_SIZE, OPT_SHADING, OPTION_ID_COUNT},
    .groups = (const option_group *const[]){&window_group, &window_camera_group, &light_group,
                                            &environment_group, &color_group, &quality_group, &gl_group,
                                            &window_path_group, &shading_group, &window_motion_group,
                                            &scene_group, &root_group, &legacy_group, &machine_group,
                                            &view_message_group, &script_group, NULL},
};
