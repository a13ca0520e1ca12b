/* options_shared.c - the options that verbs share. See options_table.h. */
#include "cli/options_table.h"

static const option machine_options[] = {
    {.id = OPT_THREADS,
     .name = "threads",
     .letter = 'j',
     .kind = OPTION_INTEGER,
     .argument = "N",
     .default_text = "the CPUs that this process may use",
     .help = "threads to work with; the picture does not depend on it",
     .minimum = 1,
     .maximum = 1024},
    {.id = OPT_MAX_MEMORY,
     .name = "max-memory",
     .kind = OPTION_TEXT,
     .argument = "SIZE",
     .default_text = "80 % of what the machine or container has",
     .help = "give up (exit 7) rather than use more memory than this for data: 512M, 2G; 0: no limit"},
    {.id = OPT_MAX_TEXTURE,
     .name = "max-texture",
     .kind = OPTION_INTEGER,
     .argument = "N",
     .default_text = "16384; environments 32768",
     .help = "refuse images with more texels than this along an edge",
     .minimum = 1,
     .maximum = 65536},
    {.id = OPT_TIME_LIMIT,
     .name = "time-limit",
     .kind = OPTION_TEXT,
     .argument = "TIME",
     .help =
         "for the whole command: 500ms, 30s, 5m; then exit 7. Path tracing writes the image so far, with a "
         "warning (exit 0), unless a pixel has no sample yet"},
};

static const option message_options[] = {
    {.id = OPT_QUIET, .name = "quiet", .letter = 'q', .kind = OPTION_FLAG, .help = "errors only"},
    {.id = OPT_VERBOSE,
     .name = "verbose",
     .letter = 'v',
     .kind = OPTION_COUNT,
     .help = "details; twice (-vv) also timings"},
    {.id = OPT_JSON,
     .name = "json",
     .kind = OPTION_FLAG,
     .help = "the result as one JSON object on standard output"},
    {.id = OPT_STRICT, .name = "strict", .kind = OPTION_FLAG, .help = "warnings become exit code 1"},
    {.id = OPT_HELP,
     .name = "help",
     .letter = 'h',
     .kind = OPTION_FLAG,
     .help = "help with the options that matter most"},
    {.id = OPT_HELP_ALL, .name = "help-all", .kind = OPTION_FLAG, .help = "help with all options"},
};

static const option running_options[] = {
    {.id = OPT_PROGRESS,
     .name = "progress",
     .kind = OPTION_CHOICE,
     .argument = "HOW",
     .default_text = "auto",
     .help =
         "auto shows a bar on a terminal and nothing elsewhere; plain and json write lines to standard error",
     .choices = WORDS("auto", "plain", "json", "none")},
    {.id = OPT_CONFIG,
     .name = "config",
     .kind = OPTION_FILE,
     .argument = "FILE.json",
     .help = "options from a JSON object with the long names as members; the command line wins"},
    {.id = OPT_PRESET,
     .name = "preset",
     .kind = OPTION_CHOICE,
     .argument = "NAME",
     .help =
         "options in one word; what is given beside it wins. thumbnail: --size 256 --background transparent "
         "--time-limit 5s for each model --max-memory 1G --quiet, and --threads 1 when niced",
     .choices = WORDS("thumbnail")},
};

const option_group machine_group = {"Limits", machine_options, COUNT(machine_options)};
const option_group message_group = {"Messages", message_options, COUNT(message_options)};
const option_group running_group = {"Running", running_options, COUNT(running_options)};
/* Without the last one, --preset. */
const option_group working_group = {"Running", running_options, COUNT(running_options) - 1};

static const option environment_options[] = {
    {.id = OPT_ENV_ROTATION,
     .name = "env-rotation",
     .kind = OPTION_TEXT,
     .argument = "DEG",
     .default_text = "0",
     .help = "turn the environment around the upward axis"},
    {.id = OPT_ENV_INTENSITY,
     .name = "env-intensity",
     .kind = OPTION_NUMBER,
     .argument = "X",
     .default_text = "1",
     .help = "factor for the light of the environment",
     .minimum = 0,
     .maximum = 1e9},
    {.id = OPT_ENV_CACHE,
     .name = "env-cache",
     .kind = OPTION_FOLDER,
     .argument = "DIR",
     .help = "keep prepared environments there for the next run (at most 256 MiB)"},
};

const option_group environment_group = {"Environment", environment_options, COUNT(environment_options)};

static const option model_options[] = {
    {.id = OPT_FILES_FROM,
     .name = "files-from",
     .kind = OPTION_FILE,
     .argument = "LIST",
     .help = "also the models that this file names, one a line (or separated by zero bytes, as find -print0 "
             "writes "
             "them); - is standard input"},
    {.id = OPT_ROOT,
     .name = "root",
     .kind = OPTION_FOLDER,
     .argument = "DIR",
     .default_text = "the model's own folder",
     .help = "the folder that files named by the model must be in"},
};

static const option legacy_options[] = {
    {.id = OPT_PARAMETERS,
     .name = "parameters",
     .kind = OPTION_FILE,
     .argument = "FILE.json",
     .help = "rgl's parameters of materials, lights and fog in place of the model's (r.md of facet help "
             "documents)"},
    {.id = OPT_METHOD,
     .name = "method",
     .kind = OPTION_CHOICE,
     .argument = "HOW",
     .default_text = "closed",
     .help = "closed: by formulas and tables where the target is linear light, else as fit; fit: searched "
             "for the "
             "least error",
     .choices = WORDS("closed", "fit")},
    {.id = OPT_PROFILE,
     .name = "profile",
     .kind = OPTION_CHOICE,
     .argument = "WHAT",
     .default_text = "specular+ior",
     .help = "specular+ior: with these two extensions, nearest to the old look; core: without extensions",
     .choices = WORDS("specular+ior", "core")},
    {.id = OPT_FIT_TARGET,
     .name = "fit-target",
     .kind = OPTION_CHOICE,
     .argument = "WHAT",
     .default_text = "auto",
     .help = "which error is made small: linear: of light; display: of light clamped as a screen does; "
             "drawn: of what an "
             "OpenGL 1 program draws, which adds display numbers; auto: drawn to OpenGL 1 and from rgl's "
             "parameters, "
             "linear from MTL",
     .choices = WORDS("auto", "linear", "display", "drawn")},
    {.id = OPT_KEEP_HUE,
     .name = "keep-hue",
     .help = "where a broad white highlight would make a material white, keep the hue of its diffuse color; "
             "the report "
             "states by how much the error grows"},
    {.id = OPT_MTL_COLORS,
     .name = "mtl-colors",
     .kind = OPTION_CHOICE,
     .argument = "SPACE",
     .default_text = "srgb",
     .help = "what the color numbers of MTL and rgl mean; the formats do not say",
     .choices = WORDS("srgb", "linear")},
    {.id = OPT_DIALECT,
     .name = "dialect",
     .kind = OPTION_CHOICE,
     .argument = "NAME",
     .default_text = "auto, by the first comment",
     .help = "the program whose habits an MTL file follows; spec: none, a highlight over the whole "
             "surface (Ns 0) counts as well",
     .choices = WORDS("auto", "spec", "blender27", "blender28", "blender3", "obj2gltf-mr", "obj2gltf-sg")},
    {.id = OPT_ILLUM,
     .name = "illum",
     .kind = OPTION_CHOICE,
     .argument = "HOW",
     .default_text = "auto",
     .help = "whether illum 0 and 1 switch light and highlight off; auto: where Ks is black anyway or the "
             "program is known to mean it",
     .choices = WORDS("auto", "honor", "ignore")},
    {.id = OPT_AMBIENT,
     .name = "ambient",
     .kind = OPTION_CHOICE,
     .argument = "HOW",
     .default_text = "drop",
     .help = "what becomes of ambient colors: nothing, emission, or (its map) occlusion",
     .choices = WORDS("drop", "emissive", "occlusion")},
    {.id = OPT_GLASS,
     .name = "glass",
     .kind = OPTION_FLAG,
     .help = "Ni, Tf and illum 4, 6, 7, 9 become transmission with refraction rather than alpha"},
    {.id = OPT_MIRRORS,
     .name = "mirrors",
     .kind = OPTION_FLAG,
     .help = "illum 3, 5, 7, 8 reflect their surroundings, by Ks, rather than show a highlight only"},
    {.id = OPT_LIGHT_SCALE,
     .name = "light-scale",
     .kind = OPTION_CHOICE,
     .argument = "X",
     .default_text = "pi",
     .help = "factor of legacy lights; pi makes both models agree",
     .choices = WORDS("pi", "1")},
    {.id = OPT_NORMALS,
     .name = "normals",
     .kind = OPTION_CHOICE,
     .argument = "HOW",
     .default_text = "auto",
     .help =
         "of OBJ, STL and PLY files without normals: auto goes by smoothing groups, else smooths edges below "
         "45 degrees",
     .choices = WORDS("auto", "flat", "smooth")},
    {.id = OPT_FLIP_TEXTURES,
     .name = "flip-textures",
     .kind = OPTION_FLAG,
     .help = "OBJ files, read or written, whose texture coordinates begin at the top, not at the bottom"},
};

const option_group model_group = {"Files", model_options, COUNT(model_options)};
/* Without the first one, --files-from. */
const option_group root_group = {"Files", model_options + 1, COUNT(model_options) - 1};
const option_group legacy_group = {"OBJ files and old materials", legacy_options, COUNT(legacy_options)};
