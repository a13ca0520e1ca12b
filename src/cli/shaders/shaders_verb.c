/* shaders_verb.c - facet shaders: its arguments, options and help. */
#include "cli/shared/commands.h"

const verb shaders_verb = {
    .name = "shaders",
    .summary = "print the shading text as GLSL, for other renderers",
    .arguments = "[PART...]",
    .max_arguments = SIZE_MAX,
    .output_types = "glsl",
    .words = OPTION_WORDS("constants", "color", "brdf", "fresnel", "sampling", "sobol", "pixel_filter",
                          "footprint", "surface", "light", "area_light", "ibl", "sheen", "clearcoat",
                          "anisotropy", "iridescence", "dispersion", "transmission", "glass", "volume", "sky",
                          "water_surface", "water_means", "glint", "water", "water_place", "water_crest",
                          "water_facets", "water_before", "water_caustic", "specular_aa",
                          "specular_glossiness", "layers", "layers_direct", "layers_ibl", "layers_lobes",
                          "material", "layers_sample", "phong", "tonemap"),
    .description =
        "Prints the functions that facet shades with as one file of GLSL, or those parts of it that "
        "are named, with all that they use. It has no main(): other programs put it before their own "
        "shader text, in any stage. The same text, compiled as C, is what facet's CPU renderers run; "
        "every function is tested to give the same numbers in both.\n\n"
        "facet shaders --list has the parts; each comment says what a function takes and gives, and "
        "where its formula is from.",
    .examples = (const example[]){{"facet shaders -o facet.glsl", "all of it, for WebGL 2 and OpenGL ES 3"},
                                  {"facet shaders --glsl 460 brdf fresnel -o ggx.glsl",
                                   "two parts, for desktop OpenGL"},
                                  {"facet shaders --glsl none tonemap | cat head.glsl - main.glsl > my.frag",
                                   "between texts of one's own"},
                                  {NULL, NULL}},
    .groups =
        (const option_group *const[]){OPTION_GROUP("Options", OPT_OUTPUT, OPT_NO_CLOBBER, OPT_GLSL, OPT_NAMES,
                                                   OPT_LIST, OPT_QUIET, OPT_HELP, OPT_HELP_ALL),
                                      NULL},
};
