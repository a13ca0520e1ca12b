/* options.h - the option table: every verb and every option, described once.
 *
 * Parsing, --help, man pages, completions and suggestions all read it; what an option does is in cmd_NAME.c. */
#ifndef CLI_OPTIONS_H
#define CLI_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>

/* What an option takes. */
typedef enum option_kind {
    OPTION_FLAG,    /* nothing */
    OPTION_COUNT,   /* nothing, and counts: -vv */
    OPTION_TEXT,    /* text that the verb understands */
    OPTION_FILE,    /* text; completed with file names */
    OPTION_FOLDER,  /* text; completed with folders */
    OPTION_CHOICE,  /* one of choices */
    OPTION_CHOICES, /* some of choices, separated by commas */
    OPTION_NUMBER,  /* a real number in [minimum, maximum] */
    OPTION_INTEGER  /* a whole number in [minimum, maximum] */
} option_kind;

typedef enum option_id {
    OPT_OUTPUT,
    OPT_NO_CLOBBER,
    OPT_FORMAT,
    OPT_SIZE,
    OPT_CROP,
    OPT_BACKGROUND,
    OPT_BACKGROUND_BLUR,
    OPT_AOV,
    OPT_JPEG_QUALITY,
    OPT_PNG_COMPRESSION,
    OPT_CAMERA,
    OPT_ORBIT,
    OPT_TARGET,
    OPT_FOV,
    OPT_EYE,
    OPT_CAMERA_MATRIX,
    OPT_VIEW_MATRIX,
    OPT_UP,
    OPT_ORTHO,
    OPT_FRAMING,
    OPT_TURNTABLE,
    OPT_ANIMATION,
    OPT_TIME,
    OPT_FRAMES,
    OPT_FPS,
    OPT_VARIANT,
    OPT_SPECULAR_AA,
    OPT_ENV,
    OPT_ENV_ROTATION,
    OPT_ENV_INTENSITY,
    OPT_ENV_CACHE,
    OPT_LIGHTS,
    OPT_SUN,
    OPT_GROUND,
    OPT_EXPOSURE,
    OPT_TONE_MAPPING,
    OPT_ENERGY,
    OPT_ISA,
    OPT_QUALITY,
    OPT_SAMPLES,
    OPT_RENDERER,
    OPT_BOUNCES,
    OPT_NOISE,
    OPT_SEED,
    OPT_FILTER,
    OPT_DENOISE,
    OPT_CLAMP,
    OPT_GLASS_SHADOWS,
    OPT_LIGHT_SAMPLING,
    OPT_APERTURE,
    OPT_FOCUS,
    OPT_SHUTTER,
    OPT_CHECKPOINT,
    OPT_RESUME,
    OPT_SHADOWS,
    OPT_TRANSPARENCY,
    OPT_BLOOM,
    OPT_CHANNEL,
    OPT_BRDF,
    OPT_SHADING,
    OPT_OGL1_VARIANT,
    OPT_OGL1_SPACE,
    OPT_FOG,
    OPT_SCENE,
    OPT_FILES_FROM,
    OPT_ROOT,
    OPT_PARAMETERS,
    OPT_METHOD,
    OPT_PROFILE,
    OPT_FIT_TARGET,
    OPT_KEEP_HUE,
    OPT_MTL_COLORS,
    OPT_DIALECT,
    OPT_ILLUM,
    OPT_AMBIENT,
    OPT_GLASS,
    OPT_MIRRORS,
    OPT_LIGHT_SCALE,
    OPT_NORMALS,
    OPT_FLIP_TEXTURES,
    OPT_TO,
    OPT_MATERIALS,
    OPT_KEEP_SOURCES,
    OPT_REFIT,
    OPT_BAKE_OCCLUSION,
    OPT_MTL_PBR,
    OPT_MTL_SHININESS_SCALE,
    OPT_REPORT,
    OPT_MAX_ERROR,
    OPT_ROUGHNESS,
    OPT_METALLIC,
    OPT_BASE_COLOR,
    OPT_ANGLE,
    OPT_HEAVISIDE,
    OPT_SMITH,
    OPT_SCALE,
    OPT_FIT,
    OPT_LOG,
    OPT_COSINE,
    OPT_TITLE,
    OPT_DARK,
    OPT_GLSL,
    OPT_NAMES,
    OPT_LIST,
    OPT_METRIC,
    OPT_MAX,
    OPT_MIN,
    OPT_PERCENTILE,
    OPT_THRESHOLD,
    OPT_PIXELS_PER_DEGREE,
    OPT_PEAK,
    OPT_EPSILON,
    OPT_SPACE,
    OPT_ALPHA,
    OPT_MASK,
    OPT_LAYER,
    OPT_HEAT_MAP,
    OPT_GAIN,
    OPT_SHEET,
    OPT_DIFFUSE,
    OPT_SHEEN,
    OPT_SH,
    OPT_SH_WINDOW,
    OPT_PREVIEW,
    OPT_LAYOUT,
    OPT_ZSTD,
    OPT_PROJECTION,
    OPT_LEVEL,
    OPT_RGBM,
    OPT_MIPS,
    OPT_MAPPING,
    OPT_LOBE,
    OPT_REFERENCE,
    OPT_QUICK,
    OPT_VERIFY,
    OPT_INPUT_LAYOUT,
    OPT_ROTATION,
    OPT_DFG,
    OPT_DISTRIBUTION,
    OPT_SCRIPT,
    OPT_WIND,
    OPT_FETCH,
    OPT_SWELL,
    OPT_SPECTRUM,
    OPT_SPREADING,
    OPT_CHOPPINESS,
    OPT_LOOP,
    OPT_TILE_SAMPLES,
    OPT_CASCADES,
    OPT_WATER,
    OPT_CHLOROPHYLL,
    OPT_ABSORPTION,
    OPT_SALINITY,
    OPT_TEMPERATURE,
    OPT_IOR,
    OPT_DEPTH,
    OPT_BED_SLOPE,
    OPT_BED_COLOR,
    OPT_TURBIDITY,
    OPT_EYE_HEIGHT,
    OPT_HEADING,
    OPT_EV100,
    OPT_BEFORE,
    OPT_BEFORE_AFTER,
    OPT_STAGE,
    OPT_MASKING,
    OPT_FRESNEL,
    OPT_NO_GLINTS,
    OPT_NO_FOAM,
    OPT_NO_CAUSTICS,
    OPT_SWEEP,
    OPT_WITH,
    OPT_INFO,
    OPT_MAPS,
    OPT_MESH_SIZE,
    OPT_MESH_SAMPLES,
    OPT_THREADS,
    OPT_MAX_MEMORY,
    OPT_MAX_TEXTURE,
    OPT_TIME_LIMIT,
    OPT_QUIET,
    OPT_VERBOSE,
    OPT_PROGRESS,
    OPT_JSON,
    OPT_STRICT,
    OPT_PRESET,
    OPT_CONFIG,
    OPT_HELP,
    OPT_HELP_ALL,
    OPT_SEARCH,
    OPTION_ID_COUNT
} option_id;

typedef struct option {
    option_id id;
    const char *name; /* long, without the dashes */
    char letter;      /* short, 0: none */
    option_kind kind;
    const char *argument;       /* "WxH"; NULL for flags */
    const char *default_text;   /* NULL: none to tell */
    const char *help;           /* one line, without full stop */
    const char *const *choices; /* ends with NULL; for OPTION_TEXT and _FILE words to complete with */
    double minimum, maximum;    /* for numbers */
} option;

typedef struct option_group {
    const char *title;
    const option *options;
    size_t option_count;
} option_group;

/* A command line that shows something, and what it does. */
typedef struct example {
    const char *command;
    const char *what;
} example;

typedef struct verb {
    const char *name;
    const char *summary;   /* one line */
    const char *arguments; /* "[MODEL...]"; "" none */
    size_t max_arguments;
    const char *file_types;   /* extensions of the arguments: "glb gltf"; NULL: no files */
    const char *output_types; /* extensions of what it writes: "png jpg"; NULL: it writes no files */
    const char *output_hint;  /* what goes before the name of an output; NULL: -o */
    const char *const *words; /* words that an argument may be, for completion; NULL: none */
    const char *description;  /* paragraphs, separated by empty lines; for the man page and --help */
    const example *examples;  /* ends with {NULL} */
    const option_id *basics;  /* what its help shows first, ends with OPTION_ID_COUNT; NULL: everything */
    const option_group *const *groups; /* ends with NULL */
} verb;

extern const verb *const verbs[];        /* ends with NULL */
const verb *verb_find(const char *name); /* NULL: no such verb in this version */
/* Whether a later version is meant to have that verb, that option. */
bool verb_is_planned(const char *name);
bool option_is_planned(const char *name);

const option *option_find(const verb *v, const char *name, size_t length); /* NULL: none */
/* The option that an attribute of <model-viewer> is another name for, as camera-orbit of orbit; NULL: none. */
const option *option_find_attribute(const verb *v, const char *name, size_t length);
const option *option_find_letter(const verb *v, char letter);
const option *option_find_id(const verb *v, option_id id);
static inline bool option_takes_value(const option *o)
{
    return o->kind > OPTION_COUNT;
}

#endif
