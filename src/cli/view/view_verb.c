/* view_verb.c - facet view: its arguments, options and help. */
#include "cli/shared/commands.h"

const verb view_verb = {
    .name = "view",
    .summary = "show models in a window",
    .arguments = "[MODEL|FOLDER...]",
    .max_arguments = SIZE_MAX,
    .file_types = "glb gltf obj stl ply json",
    .output_types = "png jpg jpeg webp exr hdr pfm y4m",
    .output_hint = "facet render MODEL -o",
    .description =
        "Opens a window that shows the MODEL; the arrow keys go through the others of its folder, or "
        "through all that are named. Drag to orbit, right drag to move, the wheel comes nearer; H "
        "lists the keys. Models, folders and environments can be dropped on it, and a model is read "
        "again when its files change. Without a MODEL the built-in scene is shown.\n\n"
        "It is drawn with OpenGL as facet render --renderer gl draws it; R switches to path tracing, "
        "which converges while one looks. Ctrl+C copies the facet render command line of the view. "
        "Exit code 8: there is no display, GLFW or OpenGL.",
    .examples = (const example[]){{"facet view helmet.glb", "one model, and the others of its folder"},
                                  {"facet view models/ --env studio.hdr --background env",
                                   "a folder, in a light of your own"},
                                  {"facet view ring.glb --renderer path --ground shadow", "path traced"},
                                  {NULL, NULL}},
    .basics = OPTION_IDS(OPT_ENV, OPT_BACKGROUND, OPT_EXPOSURE, OPT_TONE_MAPPING, OPT_ORBIT, OPT_RENDERER,
                         OPT_GROUND, OPT_ANIMATION, OPT_SIZE, OPT_SHADING),
    .groups =
        (const option_group *const[]){
            OPTION_GROUP("Window", OPT_SIZE, OPT_BACKGROUND, OPT_BACKGROUND_BLUR),
            OPTION_GROUP("Camera", OPT_ORBIT, OPT_TARGET, OPT_FOV, OPT_EYE, OPT_UP, OPT_ORTHO, OPT_FRAMING,
                         OPT_CAMERA),
            &light_group, &environment_group, &color_group, &quality_group, &gl_group,
            OPTION_GROUP("Path tracing (--renderer path)", PATH_OPTIONS), &shading_group,
            OPTION_GROUP("Motion", OPT_ANIMATION, OPT_TIME), &scene_group, OPTION_GROUP("Files", OPT_ROOT),
            &legacy_group, &limits_group,
            OPTION_GROUP("Messages", OPT_QUIET, OPT_VERBOSE, OPT_HELP, OPT_HELP_ALL),
            OPTION_GROUP("Running", OPT_SCRIPT, OPT_CONFIG), NULL},
};
