/* gl_program_text.h - the GLSL of each program: version, shader library, #defines of the requested features, and a main of
 * src/gl/shaders. */
#ifndef GL_GL_PROGRAM_TEXT_H
#define GL_GL_PROGRAM_TEXT_H

#include "base/text.h"
#include "facet/facet.h"
#include "scene/scene.h"

/* A pair of shaders: NAME.vert and NAME.frag of this folder, or screen.vert for what covers the picture. */
typedef enum gl_main {
    GL_MAIN_SURFACE,     /* a material */
    GL_MAIN_SHADOW,      /* a material as what casts a shadow; features as of the former */
    GL_MAIN_PHONG,       /* a material of OpenGL 1 */
    GL_MAIN_GROUND_MAP,  /* how much of a uniform sky the model hides from the ground */
    GL_MAIN_GROUND,      /* the shadow on the ground */
    GL_MAIN_BACKGROUND,  /* the environment behind the model */
    GL_MAIN_COMPOSE,     /* blended surfaces that were drawn beside the picture */
    GL_MAIN_PRESENT,     /* radiance to a display's numbers */
    GL_MAIN_HALVE,       /* a picture at half its size */
    GL_MAIN_SPREAD,      /* and at twice its size */
    GL_MAIN_DEVELOP,     /* what OpenGL 1 computed as light */
    GL_MAIN_SEA_GRID,    /* where the surface of a sea lies */
    GL_MAIN_SEA_SURFACE, /* which water is seen in each pixel */
    GL_MAIN_SEA_CLASS,   /* what is to be done for a pixel */
    GL_MAIN_SEA,         /* what it looks like */
    GL_MAIN_COUNT
} gl_main;

/* Features of GL_MAIN_SURFACE that do not come of the material alone; and those of GL_MAIN_BACKGROUND. */
enum {
    GL_SURFACE_HAS_TANGENTS = 1u << 0,
    GL_SURFACE_HAS_ENVIRONMENT = 1u << 1,
    GL_SURFACE_HAS_LIGHTS = 1u << 2, /* punctual ones */
    GL_SURFACE_HAS_SHADOWS = 1u << 3,
    GL_GROUND_HAS_ENVIRONMENT = 1u << 0,
    GL_GROUND_HAS_LIGHTS = 1u << 1,
    GL_GROUND_HAS_SHADOWS = 1u << 2,
    GL_BACKGROUND_HAS_ENVIRONMENT = 1u << 0,
    GL_BACKGROUND_IS_BLURRED = 1u << 1,
    GL_HALVE_IS_COPY = 1u << 0 /* not halved */
};

/* Numbers of the first features of GL_MAIN_SURFACE that come of the material, as many of each as stand behind them, and of
 * single ones; gl_material.c sets all of them. */
enum {
    GL_SURFACE_TEXTURES = 4,                     /* by scene_texture_slot */
    GL_SURFACE_PAIRS = GL_SURFACE_TEXTURES + 20, /* by gl_slot_pairs: the second reads the first's texel */
    GL_SURFACE_LAYERS = GL_SURFACE_PAIRS + 7,    /* by bits of LAYER_* */
    GL_SURFACE_LAYER_COUNT = 9,
    GL_SURFACE_IS_LIT = GL_SURFACE_LAYERS + GL_SURFACE_LAYER_COUNT,
    GL_SURFACE_IS_UNLIT,  /* KHR_materials_unlit */
    GL_SURFACE_IS_GLOSSY, /* specular-glossiness */
    GL_SURFACE_HAS_ALPHA_MASK,
    GL_SURFACE_HAS_ALPHA_BLEND,
    GL_SURFACE_HAS_COLORS, /* of vertices */
    GL_SURFACE_IS_VOLUME,
    GL_SURFACE_HAS_SPECULAR_ANTIALIASING
};

/* GL_MAIN_PHONG has features of its own from GL_SURFACE_TEXTURES to GL_SURFACE_IS_LIT, first of all those of its maps in the
 * order of gl_phong_slots; the others are those of GL_MAIN_SURFACE. */
enum {
    GL_PHONG_MAP_COUNT = 7,
    GL_PHONG_IS_SPHERE_MAP = GL_SURFACE_TEXTURES + GL_PHONG_MAP_COUNT,
    GL_PHONG_IS_AT_VERTICES, /* light is computed there */
    GL_PHONG_IS_FLAT,
    GL_PHONG_IS_SEE_THROUGH
};

/* GL_MAIN_SEA. */
enum {
    GL_SEA_HAS_IMAGE = 1u << 0,  /* an environment's in the sky's place */
    GL_SEA_IS_LEGACY = 1u << 1,  /* looks without physics */
    GL_SEA_IS_PAINTED = 1u << 2, /* stage 3 */
    GL_SEA_IS_BELOW = 1u << 3,   /* the eye is in the water */
    GL_SEA_HAS_BED = 1u << 4,
    GL_SEA_HAS_FOAM = 1u << 5,
    GL_SEA_HAS_GLINTS = 1u << 6,
    GL_SEA_HAS_CUBIC = 1u << 7, /* near enough that samples of waves are wider than pixels */
    GL_SEA_IS_BESIDE = 1u << 8, /* where the surface is not seen */
    GL_SEA_HAS_MODEL = 1u << 9,
    GL_SEA_HAS_OTHER_MICROFACETS = 1u << 10 /* than Gaussian ones with Smith's masking and exact Fresnel */
};

/* features: bits of the main's list of names in gl_program.c, each of which becomes a #define. */
typedef struct gl_program_key {
    gl_main main;
    uint64_t features;
} gl_program_key;

/* ---- textures of GL_MAIN_SURFACE ---- */

/* Two slots that are often one texture in one file: the second one then reads the first one's texel. */
typedef struct gl_slot_pair {
    scene_texture_slot first, second;
} gl_slot_pair;

enum {
    GL_SLOT_PAIR_COUNT = 7,
    GL_MATERIAL_UNITS = 9 /* of the 16 that every OpenGL has, what is not the picture's */
};
extern const gl_slot_pair gl_slot_pairs[GL_SLOT_PAIR_COUNT];

/* Slots in the order in which they are given up where a material has more textures than there are units. */
extern const uint8_t gl_slots_by_loss[SCENE_TEXTURE_SLOT_COUNT];

/* The unit of each slot behind GL_UNIT_MATERIAL, -1: it is not read, or with the texel of another; returns how many
 * units are taken. */
int gl_material_slot_units(uint64_t features, int8_t units[SCENE_TEXTURE_SLOT_COUNT]);

/* ---- the text ---- */

/* The whole text of a shader, as it is compiled. stage: GL_VERTEX_SHADER or GL_FRAGMENT_SHADER. FACET_ERROR_MEMORY. */
facet_result gl_program_text(const char *glsl_version, gl_program_key key, uint32_t stage, text *out,
                             facet_error *error);
/* Number of features of a main, and their names ("": there is no such feature). */
uint32_t gl_program_feature_count(gl_main main);
const char *gl_program_feature_name(gl_main main, uint32_t feature);
uint64_t gl_program_feature(gl_main main, const char *name); /* its bit; 0: there is no such feature */
const char *gl_program_main_name(gl_main main);

#endif
