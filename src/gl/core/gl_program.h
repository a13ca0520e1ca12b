/* gl_program.h - the programs: the GLSL of each (version, shader library, #defines of the requested features, files
 * of src/gl/shaders), and the compiled ones, each made on first use. */
#ifndef GL_GL_PROGRAM_H
#define GL_GL_PROGRAM_H

#include "base/text.h"
#include "facet/facet.h"
#include "gl/core/gl_context.h"
#include "scene/scene.h"

/* A pair of shaders: NAME.vert and NAME.frag, or screen.vert for passes that cover the whole image. */
typedef enum gl_main {
    GL_MAIN_SURFACE,     /* a glTF material */
    GL_MAIN_SHADOW,      /* its depth in a shadow map; same features */
    GL_MAIN_PHONG,       /* a material of OpenGL 1 */
    GL_MAIN_GROUND_MAP,  /* ambient occlusion of the ground under a uniform sky */
    GL_MAIN_GROUND,      /* shadows on the ground */
    GL_MAIN_BACKGROUND,  /* the background */
    GL_MAIN_COMPOSE,     /* composites blended layers over the image */
    GL_MAIN_PRESENT,     /* tone-maps for a window */
    GL_MAIN_PYRAMID,     /* halves, doubles or copies a level of an image */
    GL_MAIN_LINEARIZE,   /* linearizes the colors of OpenGL 1 */
    GL_MAIN_SEA_GRID,    /* positions of the ocean mesh */
    GL_MAIN_SEA_SURFACE, /* visible water per pixel */
    GL_MAIN_SEA_CLASS,   /* classifies pixels by cost */
    GL_MAIN_SEA,         /* shades the sea */
    GL_MAIN_COUNT
} gl_main;

/* Features of surfaces and of the background that do not follow from the material alone. */
enum {
    GL_SURFACE_HAS_TANGENTS = 1u << 0,
    GL_SURFACE_HAS_ENVIRONMENT = 1u << 1,
    GL_SURFACE_HAS_LIGHTS = 1u << 2, /* punctual lights */
    GL_SURFACE_HAS_SHADOWS = 1u << 3,
    GL_GROUND_HAS_ENVIRONMENT = 1u << 0,
    GL_GROUND_HAS_LIGHTS = 1u << 1,
    GL_GROUND_HAS_SHADOWS = 1u << 2,
    GL_BACKGROUND_HAS_ENVIRONMENT = 1u << 0,
    GL_BACKGROUND_IS_BLURRED = 1u << 1,
    GL_PYRAMID_IS_COPY = 1u << 0,
    GL_PYRAMID_IS_DOUBLED = 1u << 1
};

/* Bit numbers of the features that follow from the material; gl_material.c sets them. */
enum {
    GL_SURFACE_TEXTURES = 4, /* one per scene_texture_slot */
    /* one per pair of gl_slot_pairs: the second slot reads the first one's texel */
    GL_SURFACE_PAIRS = GL_SURFACE_TEXTURES + 21,
    GL_SURFACE_LAYERS = GL_SURFACE_PAIRS + 7, /* one per bit of LAYER_* */
    GL_SURFACE_LAYER_COUNT = 10,
    GL_SURFACE_IS_LIT = GL_SURFACE_LAYERS + GL_SURFACE_LAYER_COUNT,
    GL_SURFACE_IS_UNLIT,  /* KHR_materials_unlit */
    GL_SURFACE_IS_GLOSSY, /* KHR_materials_pbrSpecularGlossiness */
    GL_SURFACE_HAS_ALPHA_MASK,
    GL_SURFACE_HAS_ALPHA_BLEND,
    GL_SURFACE_HAS_COLORS, /* vertex colors */
    GL_SURFACE_IS_VOLUME,
    GL_SURFACE_HAS_SPECULAR_ANTIALIASING,
    GL_SURFACE_HAS_ONE_FOOTPRINT /* all textures have the same size, coordinates and filter */
};

/* GL_MAIN_PHONG has features of its own from GL_SURFACE_TEXTURES to GL_SURFACE_IS_LIT, maps first; the
 * others are those of GL_MAIN_SURFACE. */
enum {
    GL_PHONG_MAP_COUNT = 7,
    GL_PHONG_IS_SPHERE_MAP = GL_SURFACE_TEXTURES + GL_PHONG_MAP_COUNT,
    GL_PHONG_IS_AT_VERTICES, /* Gouraud shading */
    GL_PHONG_IS_FLAT,
    GL_PHONG_IS_SEE_THROUGH
};

/* GL_MAIN_SEA. */
enum {
    GL_SEA_HAS_IMAGE = 1u << 0,  /* an environment image replaces the atmosphere */
    GL_SEA_IS_LEGACY = 1u << 1,  /* a legacy style, in display colors */
    GL_SEA_IS_PAINTED = 1u << 2, /* stage 3 */
    GL_SEA_IS_BELOW = 1u << 3,   /* underwater camera */
    GL_SEA_HAS_BED = 1u << 4,
    GL_SEA_HAS_FOAM = 1u << 5,
    GL_SEA_HAS_GLINTS = 1u << 6,
    GL_SEA_HAS_CUBIC = 1u << 7, /* waves are read with cubic filtering: texels are larger than pixels */
    GL_SEA_IS_BESIDE = 1u << 8, /* pixels without a water surface */
    GL_SEA_HAS_MODEL = 1u << 9,
    GL_SEA_HAS_OTHER_MICROFACETS = 1u << 10, /* GGX or other masking and Fresnel terms than the default's */
    GL_SEA_AOVS = 1u << 11                   /* layers instead of radiance */
};

/* features: bits into the main's list of feature names, each of which becomes a #define. */
typedef struct gl_program_key {
    gl_main main;
    uint64_t features;
} gl_program_key;

/* ---- textures of GL_MAIN_SURFACE ---- */

/* Two slots that often share one texture: the second can then read the first one's texel. */
typedef struct gl_slot_pair {
    scene_texture_slot first, second;
} gl_slot_pair;

enum {
    GL_SLOT_PAIR_COUNT = 7,
    GL_MATERIAL_UNITS = 9 /* of the 16 units that OpenGL guarantees, those that images do not use */
};
extern const gl_slot_pair gl_slot_pairs[GL_SLOT_PAIR_COUNT];

/* Slots in the order in which they are dropped where a material has more textures than there are units. */
extern const uint8_t gl_slots_by_loss[SCENE_TEXTURE_SLOT_COUNT];

/* The unit of each slot, counted from GL_UNIT_MATERIAL; -1: not sampled, or sampled through its pair.
 * Returns the number of units in use. */
int gl_material_slot_units(uint64_t features, int8_t units[SCENE_TEXTURE_SLOT_COUNT]);

/* ---- the text ---- */

/* The complete source of a shader. stage: GL_VERTEX_SHADER or GL_FRAGMENT_SHADER. FACET_ERROR_MEMORY. */
facet_result gl_program_text(const char *glsl_version, gl_program_key key, uint32_t stage, text *out,
                             facet_error *error);
/* Number of features of a main, and their names; "": the feature does not exist. */
uint32_t gl_program_feature_count(gl_main main);
const char *gl_program_feature_name(gl_main main, uint32_t feature);
uint64_t gl_program_feature(gl_main main, const char *name); /* the feature's bit; 0: it does not exist */
uint64_t gl_program_present_features(const gl_context *context,
                                     facet_tonemap tonemap); /* of GL_MAIN_PRESENT */
/* Of GL_MAIN_SURFACE: opaque surfaces put out what a window shows in place of radiance. */
uint64_t gl_program_display_features(facet_tonemap tonemap);
const char *gl_program_main_name(gl_main main);

/* ---- compiled programs ---- */

typedef struct gl_programs gl_programs;

facet_result gl_programs_create(gl_context *context, const facet_allocator *allocator, const facet_log *log,
                                gl_programs **out, facet_error *error);
/* Sets the log of the next image; NULL: none. */
void gl_programs_set_log(gl_programs *programs, const facet_log *log);
/* Sets source that is inserted before the mains of programs compiled from now on; tests use it to break them.
 * NULL: none. */
void gl_programs_set_prelude(gl_programs *programs, const char *prelude);
void gl_programs_destroy(gl_programs *programs); /* NULL is allowed; the context is current */

/* Starts to compile, in the background where the driver can, so that several programs compile at once. */
facet_result gl_programs_request(gl_programs *programs, gl_program_key key, facet_error *error);
/* Whether gl_programs_get() need not wait: false while a requested program is compiled in the background. */
bool gl_programs_is_ready(gl_programs *programs, gl_program_key key);
/* Waits for a compiled and linked program and returns its OpenGL name. Samplers and blocks are bound as in
 * gl_blocks.h. Fails with FACET_ERROR_SYSTEM and the compiler's message; the numbered source goes to the log. */
facet_result gl_programs_get(gl_programs *programs, gl_program_key key, uint32_t *name, facet_error *error);

#endif
