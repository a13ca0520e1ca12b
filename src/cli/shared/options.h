/* options.h - the tables of verbs and options (verbs.def, options.def), which parsing, help, man pages,
 * completions and suggestions read. */
#ifndef CLI_OPTIONS_H
#define CLI_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Type of an option's value. */
typedef enum option_kind {
    OPTION_FLAG,    /* none */
    OPTION_COUNT,   /* none; occurrences count: -vv */
    OPTION_SWITCH,  /* none, or one of choices after "=" */
    OPTION_TEXT,    /* parsed by the verb */
    OPTION_TEXTS,   /* the same, of every occurrence */
    OPTION_FILE,    /* completed with file names */
    OPTION_FOLDER,  /* completed with folders */
    OPTION_CHOICE,  /* one of choices */
    OPTION_CHOICES, /* comma-separated choices */
    OPTION_NUMBER,  /* a real number in [minimum, maximum] */
    OPTION_INTEGER  /* a whole number in [minimum, maximum] */
} option_kind;

typedef enum option_id {
#define OPTION(id, ...) OPT_##id,
#define IN(verbs, ...)
#include "cli/shared/options.def"
#undef OPTION
#undef IN
    OPTION_ID_COUNT
} option_id;

typedef struct option {
    option_id id;
    const char *verbs;        /* blank-separated verbs of this description; NULL: all others */
    const char *name;         /* long, without the dashes */
    char letter;              /* short, 0: none */
    const char *argument;     /* "WxH"; NULL for flags */
    const char *default_text; /* NULL: none */
    const char *help;         /* one line, without full stop */
    option_kind kind;
    const char *const *choices; /* ends with NULL; for OPTION_TEXT and _FILE words to complete with */
    double minimum, maximum;    /* for numbers */
} option;

/* Options under one heading of help. Several verbs may share a group. */
typedef struct option_group {
    const char *title;
    const option_id *ids; /* ends with OPTION_ID_COUNT */
} option_group;

#define OPTION_IDS(...)                                                                                      \
    (const option_id[])                                                                                      \
    {                                                                                                        \
        __VA_ARGS__, OPTION_ID_COUNT                                                                         \
    }
/* A group of one verb, for verb.groups. */
#define OPTION_GROUP(title, ...)                                                                             \
    &(const option_group)                                                                                    \
    {                                                                                                        \
        title, OPTION_IDS(__VA_ARGS__)                                                                       \
    }
/* Options of --renderer path in render and view. */
#define PATH_OPTIONS                                                                                         \
    OPT_BOUNCES, OPT_NOISE, OPT_SEED, OPT_FILTER, OPT_DENOISE, OPT_CLAMP, OPT_GLASS_SHADOWS,                 \
        OPT_LIGHT_SAMPLING, OPT_APERTURE, OPT_FOCUS, OPT_SHUTTER

/* Options of --renderer gl. */
#define GL_OPTIONS OPT_SHADOWS, OPT_TRANSPARENCY, OPT_BLOOM, OPT_CHANNEL, OPT_BRDF

/* The view: what keys and panels of a viewer change. */
#define VIEW_OPTIONS                                                                                         \
    OPT_BACKGROUND, OPT_BACKGROUND_BLUR, OPT_ORBIT, OPT_TARGET, OPT_FOV, OPT_EYE, OPT_UP, OPT_ORTHO,         \
        OPT_FRAMING, OPT_CAMERA, OPT_ENV, OPT_ENV_ROTATION, OPT_ENV_INTENSITY, OPT_LIGHTS, OPT_GROUND,       \
        OPT_EXPOSURE, OPT_TONE_MAPPING, OPT_ENERGY, OPT_ANIMATION, OPT_TIME, OPT_SCENE, OPT_VARIANT,         \
        GL_OPTIONS

/* A list of words. */
#define OPTION_WORDS(...)                                                                                    \
    (const char *const[])                                                                                    \
    {                                                                                                        \
        __VA_ARGS__, NULL                                                                                    \
    }

/* Groups that several verbs have. */
extern const option_group limits_group, messages_group, environment_group, light_group, color_group,
    quality_group, gl_group, shading_group, scene_group, files_group, legacy_group;

/* An example command line, and what it does. */
typedef struct example {
    const char *command;
    const char *what;
} example;

typedef struct verb {
    const char *name;
    const char *summary;   /* one line */
    const char *arguments; /* "[MODEL...]"; "" none */
    size_t max_arguments;
    const char *file_types;            /* extensions of the arguments: "glb gltf"; NULL: no files */
    const char *output_types;          /* extensions of the outputs: "png jpg"; NULL: none */
    const char *output_hint;           /* shown before the name of an output; NULL: -o */
    const char *const *words;          /* words that an argument may be, for completion; NULL: none */
    const char *description;           /* paragraphs, separated by empty lines; for the man page and --help */
    const example *examples;           /* ends with {NULL} */
    const option_id *basics;           /* main options, ends with OPTION_ID_COUNT; NULL: all */
    const option_group *const *groups; /* ends with NULL */
} verb;

/* NAME/cmd_NAME.c of each verb in verbs.def defines NAME_verb, its arguments, options and help, and
 * cmd_NAME(), which runs it: it reports failures and returns the exit code. */
struct command_line;
#define VERB(name)                                                                                           \
    extern const verb name##_verb;                                                                           \
    int cmd_##name(struct command_line *c);
#include "cli/shared/verbs.def"
#undef VERB

extern const verb *const verbs[];        /* in the order of verbs.def; ends with NULL */
const verb *verb_find(const char *name); /* NULL: no such verb in this version */
/* Whether that option is planned for a later version. */
bool option_is_planned(const char *name);

/* An option of a verb, in that verb's description; NULL: none. */
const option *option_at(const verb *v, size_t index); /* in the order of its groups */
const option *option_find(const verb *v, const char *name, size_t length);
/* The option for an attribute of <model-viewer>: orbit for camera-orbit. */
const option *option_find_attribute(const verb *v, const char *name, size_t length);
const option *option_find_letter(const verb *v, char letter);
const option *option_find_id(const verb *v, option_id id);

static inline bool option_takes_value(const option *o)
{
    return o->kind > OPTION_SWITCH;
}

/* ids: OPTION_IDS(...). */
static inline bool option_is_among(option_id id, const option_id *ids)
{
    while (*ids != OPTION_ID_COUNT && *ids != id)
        ids++;
    return *ids == id;
}

#endif
