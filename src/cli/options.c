/* options.c - the verbs of this version, and how their options are found. */
#include "cli/options.h"

#include "cli/options_table.h"

#include <string.h>

/* ---- inspect, version, help ---- */

static const verb inspect_verb = {
    .name = "inspect",
    .summary = "say what is in a model",
    .arguments = "MODEL|FOLDER...",
    .max_arguments = SIZE_MAX,
    .file_types = "glb gltf obj stl ply json",
    .output_types = "txt",
    .output_hint = ">",
    .description =
        "Reads each MODEL (.glb, .gltf, .obj with its .mtl, .stl, .ply, .json of rgl's parameters; - is "
        "standard input) and prints counts, bounds, materials, "
        "textures, images, cameras, lights, the extensions with what facet makes of them, and the "
        "warnings of reading. With -v lists are printed to their end.\n\n"
        "The exit code is 0 when the model can be read, also with warnings (--strict: 1).",
    .examples = (const example[]){{"facet inspect helmet.glb", "for reading"},
                                  {"facet inspect helmet.glb --json | jq .materials", "for a program"},
                                  {"facet inspect --strict models/", "check all in a folder and below it"},
                                  {NULL, NULL}},
    .basics = (const option_id[]){OPT_JSON, OPT_VERBOSE, OPT_STRICT, OPT_FILES_FROM, OPT_ROOT, OPT_TIME_LIMIT,
                                  OPT_MAX_MEMORY, OPTION_ID_COUNT},
    .groups =
        (const option_group *const[]){&model_group, &legacy_group, &machine_group, &message_group, NULL},
};

static const option version_options[] = {
    {.id = OPT_VERBOSE,
     .name = "verbose",
     .letter = 'v',
     .kind = OPTION_COUNT,
     .help = "also compiler, libraries, CPU and threads: what a bug report needs"},
    {.id = OPT_JSON, .name = "json", .kind = OPTION_FLAG, .help = "as one JSON object"},
    {.id = OPT_HELP, .name = "help", .letter = 'h', .kind = OPTION_FLAG, .help = "this text"},
    {.id = OPT_HELP_ALL, .name = "help-all", .kind = OPTION_FLAG, .help = "help with all options"},
};
static const option_group version_group = {"Options", version_options, COUNT(version_options)};

static const verb version_verb = {
    .name = "version",
    .summary = "say which facet this is",
    .arguments = "",
    .description = "Prints the version; with -v also how it was built and what it found on this machine.",
    .examples = (const example[]){{"facet version -v", "for a bug report"}, {NULL, NULL}},
    .groups = (const option_group *const[]){&version_group, NULL},
};

static const option help_options[] = {
    {.id = OPT_SEARCH,
     .name = "search",
     .kind = OPTION_TEXT,
     .argument = "WORD",
     .help = "all options, examples and documents that mention a word"},
    {.id = OPT_HELP, .name = "help", .letter = 'h', .kind = OPTION_FLAG, .help = "this text"},
    {.id = OPT_HELP_ALL, .name = "help-all", .kind = OPTION_FLAG, .help = "help with all options"},
};
static const option_group help_group = {"Options", help_options, COUNT(help_options)};

static const verb help_verb = {
    .name = "help",
    .summary = "explain facet or one of its commands",
    .arguments = "[COMMAND|OPTION|WORD]",
    .max_arguments = 1,
    .words = WORDS("render", "ocean", "view", "bake", "convert", "inspect", "plot", "compare", "shaders",
                   "version", "help", "exit-codes", "documents"),
    .description =
        "Prints what facet --help or facet COMMAND --help print; of an option what it means and which "
        "commands have it; of another word all that mentions it. exit-codes and documents are topics.",
    .examples =
        (const example[]){{"facet help render", "render in short; with --help-all all of its options"},
                          {"facet help orbit", "an option, in all commands that have it"},
                          {"facet help --search ground", "all that mentions a word"},
                          {"facet help documents", "where the manual is"},
                          {"facet help exit-codes", "what 0 to 75 mean"},
                          {NULL, NULL}},
    .groups = (const option_group *const[]){&help_group, NULL},
};

const verb *const verbs[] = {&render_verb,  &ocean_verb,   &view_verb, &bake_verb,
                             &convert_verb, &inspect_verb, &plot_verb, &compare_verb,
                             &shaders_verb, &version_verb, &help_verb, NULL};

/* ---- looking up ---- */

const verb *verb_find(const char *name)
{
    for (const verb *const *v = verbs; *v; v++)
        if (strcmp((*v)->name, name) == 0)
            return *v;
    return NULL;
}

static bool is_among(const char *name, const char *const *words)
{
    for (; *words; words++)
        if (strcmp(name, *words) == 0)
            return true;
    return false;
}

bool verb_is_planned(const char *name)
{
    return is_among(name, WORDS("batch", "serve", "merge"));
}

bool option_is_planned(const char *name)
{
    return is_among(name, WORDS("material-override", "shard"));
}

/* Attributes of <model-viewer> whose values are those of an option here. */
static const struct {
    const char *name;
    option_id id;
} attributes[] = {{"camera-orbit", OPT_ORBIT},   {"camera-target", OPT_TARGET},
                  {"field-of-view", OPT_FOV},    {"environment-image", OPT_ENV},
                  {"variant-name", OPT_VARIANT}, {"animation-name", OPT_ANIMATION}};

const option *option_find_attribute(const verb *v, const char *name, size_t length)
{
    for (size_t i = 0; i < sizeof attributes / sizeof *attributes; i++)
        if (strlen(attributes[i].name) == length && memcmp(attributes[i].name, name, length) == 0)
            return option_find_id(v, attributes[i].id);
    return NULL;
}

const option *option_find(const verb *v, const char *name, size_t length)
{
    for (const option_group *const *g = v->groups; *g; g++)
        for (size_t i = 0; i < (*g)->option_count; i++) {
            const option *o = &(*g)->options[i];
            if (strlen(o->name) == length && memcmp(o->name, name, length) == 0)
                return o;
        }
    return NULL;
}

const option *option_find_letter(const verb *v, char letter)
{
    for (const option_group *const *g = v->groups; *g; g++)
        for (size_t i = 0; i < (*g)->option_count; i++)
            if ((*g)->options[i].letter == letter)
                return &(*g)->options[i];
    return NULL;
}

const option *option_find_id(const verb *v, option_id id)
{
    for (const option_group *const *g = v->groups; *g; g++)
        for (size_t i = 0; i < (*g)->option_count; i++)
            if ((*g)->options[i].id == id)
                return &(*g)->options[i];
    return NULL;
}
