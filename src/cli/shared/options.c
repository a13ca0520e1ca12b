/* options.c - the tables of options and verbs, and searches in them. */
#include "cli/shared/options.h"

#include <string.h>

/* ---- the table of options ---- */

#define OPTION(id, name, letter, ...)                                                                        \
    static const char name_of_##id[] = name;                                                                 \
    enum { LETTER_OF_##id = letter };
#define IN(verbs, ...)
#include "cli/shared/options.def"
#undef OPTION
#undef IN

/* Choices that several options share. */
#define IMAGE_FORMATS "png", "png16", "jpg", "webp", "exr", "exr32", "hdr", "pfm"
#define TONE_MAPPINGS /* in the order of facet_tonemap */                                                    \
    "none", "neutral", "aces", "aces-narkowicz", "agx", "reinhard", "reinhard-extended", "hable"

#define LAYERS                                                                                               \
    "all", "depth", "normal", "albedo", "material", "object", "instance", "uv", "occlusion", "variance",     \
        "samples", "cryptomatte", "crypto-object", "crypto-material", "crypto-instance"
#define RENDERERS "preview", "path", "gl" /* as facet_renderer_info.name */

#define KIND_FLAG OPTION_FLAG, 0, 0, 0
#define KIND_COUNT OPTION_COUNT, 0, 0, 0
#define KIND_SWITCH(...) OPTION_SWITCH, OPTION_WORDS(__VA_ARGS__), 0, 0
#define KIND_TEXT OPTION_TEXT, 0, 0, 0
#define KIND_TEXTS OPTION_TEXTS, 0, 0, 0
#define KIND_FILE OPTION_FILE, 0, 0, 0
#define KIND_FOLDER OPTION_FOLDER, 0, 0, 0
#define KIND_NUMBER(minimum, maximum) OPTION_NUMBER, 0, minimum, maximum
#define KIND_INTEGER(minimum, maximum) OPTION_INTEGER, 0, minimum, maximum
#define KIND_TEXT_OR(...) OPTION_TEXT, OPTION_WORDS(__VA_ARGS__), 0, 0
#define KIND_FILE_OR(...) OPTION_FILE, OPTION_WORDS(__VA_ARGS__), 0, 0
#define KIND_CHOICE(...) OPTION_CHOICE, OPTION_WORDS(__VA_ARGS__), 0, 0
#define KIND_CHOICES(...) OPTION_CHOICES, OPTION_WORDS(__VA_ARGS__), 0, 0

#ifdef FACET_WITHOUT_HELP /* programs without a help command */
#define HELP(...) NULL, NULL
#else
#define HELP(...) __VA_ARGS__
#endif
#define OPTION(id, name, letter, kind, argument, default_text, help)                                         \
    {OPT_##id, NULL, name, letter, argument, HELP(default_text, help), KIND_##kind},
#define IN(verbs, id, kind, argument, default_text, help)                                                    \
    {OPT_##id, verbs, name_of_##id, LETTER_OF_##id, argument, HELP(default_text, help), KIND_##kind},

static const option options[] = {
#include "cli/shared/options.def"
};

enum { ROW_COUNT = sizeof options / sizeof *options };

/* ---- groups that verbs share ---- */

const option_group limits_group = {"Limits",
                                   OPTION_IDS(OPT_THREADS, OPT_MAX_MEMORY, OPT_MAX_TEXTURE, OPT_TIME_LIMIT)};
const option_group messages_group = {
    "Messages", OPTION_IDS(OPT_QUIET, OPT_VERBOSE, OPT_JSON, OPT_STRICT, OPT_HELP, OPT_HELP_ALL)};
const option_group environment_group = {"Environment",
                                        OPTION_IDS(OPT_ENV_ROTATION, OPT_ENV_INTENSITY, OPT_ENV_CACHE)};
const option_group light_group = {"Light", OPTION_IDS(OPT_ENV, OPT_LIGHTS, OPT_SUN, OPT_GROUND)};
const option_group color_group = {"Color", OPTION_IDS(OPT_EXPOSURE, OPT_TONE_MAPPING)};
const option_group quality_group = {
    "Quality", OPTION_IDS(OPT_QUALITY, OPT_SAMPLES, OPT_RENDERER, OPT_ENERGY, OPT_ISA, OPT_SPECULAR_AA)};
const option_group gl_group = {"OpenGL (--renderer gl)", OPTION_IDS(GL_OPTIONS)};
const option_group shading_group = {"Shading",
                                    OPTION_IDS(OPT_SHADING, OPT_OGL1_VARIANT, OPT_OGL1_SPACE, OPT_FOG)};
const option_group scene_group = {"Scene", OPTION_IDS(OPT_SCENE, OPT_VARIANT)};
const option_group files_group = {"Files", OPTION_IDS(OPT_FILES_FROM, OPT_ROOT)};
const option_group legacy_group = {"OBJ files and OpenGL 1 materials",
                                   OPTION_IDS(OPT_PARAMETERS, OPT_METHOD, OPT_PROFILE, OPT_FIT_TARGET,
                                              OPT_KEEP_HUE, OPT_MTL_COLORS, OPT_DIALECT, OPT_ILLUM,
                                              OPT_AMBIENT, OPT_GLASS, OPT_MIRRORS, OPT_LIGHT_SCALE,
                                              OPT_NORMALS, OPT_FLIP_TEXTURES)};

/* ---- verbs ---- */

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

bool option_is_planned(const char *name)
{
    return is_among(name, OPTION_WORDS("material-override"));
}

/* ---- options of a verb ---- */

/* Whether a blank-separated list contains word. */
static bool has_word(const char *list, const char *word)
{
    size_t length = strlen(word);
    for (; *list; list += strspn(list, " ")) {
        size_t n = strcspn(list, " ");
        if (n == length && memcmp(list, word, n) == 0)
            return true;
        list += n;
    }
    return false;
}

/* The row of an option for v: that of the verb if there is one, else the general one. */
static const option *find_row(const verb *v, option_id id)
{
    const option *found = NULL;
    for (size_t i = 0; i < ROW_COUNT; i++)
        if (options[i].id == id && (!options[i].verbs || has_word(options[i].verbs, v->name)))
            found = &options[i];
    return found;
}

const option *option_at(const verb *v, size_t index)
{
    for (const option_group *const *g = v->groups; *g; g++)
        for (const option_id *id = (*g)->ids; *id != OPTION_ID_COUNT; id++)
            if (index-- == 0)
                return find_row(v, *id);
    return NULL;
}

const option *option_find_id(const verb *v, option_id id)
{
    for (const option_group *const *g = v->groups; *g; g++)
        for (const option_id *i = (*g)->ids; *i != OPTION_ID_COUNT; i++)
            if (*i == id)
                return find_row(v, id);
    return NULL;
}

const option *option_find(const verb *v, const char *name, size_t length)
{
    for (size_t i = 0; i < ROW_COUNT; i++)
        if (!options[i].verbs && strlen(options[i].name) == length &&
            memcmp(options[i].name, name, length) == 0 && option_find_id(v, options[i].id))
            return option_find_id(v, options[i].id);
    return NULL;
}

const option *option_find_letter(const verb *v, char letter)
{
    for (size_t i = 0; i < ROW_COUNT; i++)
        if (!options[i].verbs && options[i].letter == letter && option_find_id(v, options[i].id))
            return option_find_id(v, options[i].id);
    return NULL;
}

/* Attributes of <model-viewer> with the same values as an option. */
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
