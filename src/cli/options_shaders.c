/* options_shaders.c - facet shaders. See options_table.h. */
#include "cli/options_table.h"

static const option shaders_options[] = {
    {.id = OPT_OUTPUT,
     .name = "output",
     .letter = 'o',
     .kind = OPTION_FILE,
     .argument = "FILE",
     .default_text = "standard output",
     .help = "the GLSL file; - is standard output"},
    {.id = OPT_NO_CLOBBER,
     .name = "no-clobber",
     .kind = OPTION_FLAG,
     .help = "keep an output that is there already"},
    {.id = OPT_GLSL,
     .name = "glsl",
     .kind = OPTION_CHOICE,
     .argument = "VERSION",
     .default_text = "300es",
     .help = "what the #version line says; none: no such line, to be put behind one's own",
     .choices = WORDS("300es", "310es", "320es", "330", "410", "450", "460", "none")},
    {.id = OPT_NAMES,
     .name = "names",
     .kind = OPTION_CHOICE,
     .argument = "WHOSE",
     .default_text = "facet",
     .help = "khronos: beside facet's names those of Khronos' Sample Viewer, with its arguments (V_GGX, "
             "BRDF_lambertian, "
             "D_Charlie, Schlick_to_F0 ..), and of the text the parts that they use",
     .choices = WORDS("facet", "khronos")},
    {.id = OPT_LIST,
     .name = "list",
     .kind = OPTION_FLAG,
     .help = "print the names of the parts, in their order"},
    {.id = OPT_QUIET, .name = "quiet", .letter = 'q', .kind = OPTION_FLAG, .help = "errors only"},
    {.id = OPT_HELP, .name = "help", .letter = 'h', .kind = OPTION_FLAG, .help = "this text"},
    {.id = OPT_HELP_ALL, .name = "help-all", .kind = OPTION_FLAG, .help = "help with all options"},
};
static const option_group shaders_group = {"Options", shaders_options, COUNT(shaders_options)};

const verb shaders_verb = {
    .name = "shaders",
    .summary = "print the shading text as GLSL, for other renderers",
    .arguments = "[PART...]",
    .max_arguments = SIZE_MAX,
    .output_types = "glsl",
    .words = WORDS("constants", "color", "brdf", "fresnel", "sampling", "sobol", "pixel_filter", "footprint",
                   "surface", "light", "area_light", "ibl", "sheen", "clearcoat", "anisotropy", "iridescence",
                   "dispersion", "transmission", "glass", "volume", "sky", "water_surface", "water_means",
                   "glint", "water", "water_place", "water_crest", "water_facets", "water_before",
                   "water_caustic", "specular_aa", "specular_glossiness", "layers", "layers_direct",
                   "layers_ibl", "layers_lobes", "material", "layers_sample", "phong", "tonemap"),
    .description =
        "Prints the functions that facet shades with as one file of GLSL, or those parts of it that are "
        "named, with all "
        "that they use. It has no main(): other programs put it before their own shader text, in any stage. "
        "The same "
        "text, compiled as C, is what facet's CPU renderers run; every function is tested to give the same "
        "numbers in both.\n\n"
        "facet shaders --list has the parts; each comment says what a function takes and gives, and where "
        "its formula is "
        "from.",
    .examples = (const example[]){{"facet shaders -o facet.glsl", "all of it, for WebGL 2 and OpenGL ES 3"},
                                  {"facet shaders --glsl 460 brdf fresnel -o ggx.glsl",
                                   "two parts, for desktop OpenGL"},
                                  {"facet shaders --glsl none tonemap | cat head.glsl - main.glsl > my.frag",
                                   "between texts of one's own"},
                                  {NULL, NULL}},
    .groups = (const option_group *const[]){&shaders_group, NULL},
};
