/* convert_state.h - what the stages of a conversion share:
 *   convert_read.c       interprets a legacy material: its dialect and switches; convert_illum.c its illum
 *   convert_solve.c      converts the values of all materials in parallel, each distinct input once, with errors
 *   convert_build.c      builds a glTF material; convert_build_maps.c its textures
 *   convert_to_ogl1.c    builds legacy materials from glTF ones; convert_ogl1_maps.c their textures
 *   convert.c            the order of these, extras, dropped textures
 *   specular_glossiness.c, lights.c */
#ifndef LEGACY_CONVERT_STATE_H
#define LEGACY_CONVERT_STATE_H

#include "legacy/convert.h"
#include "legacy/convert_maps.h"
#include "legacy/convert_notes.h"
#include "legacy/convert_surface.h"
#include "legacy/fit.h"
#include "legacy/texture_baker.h"

/* Which textures are dropped, and the new indices of the others. Everything is in the arena of the scene. */
typedef struct drop_plan {
    bool is_needed;                      /* some are dropped */
    uint32_t texture_count, image_count; /* as texture_baker_finish() leaves them */
    uint32_t *textures, *images;         /* new index of each; SCENE_NONE: dropped */
    scene_texture *new_textures;
    scene_image *new_images;
    struct scene_conversion_source *source;
} drop_plan;

typedef struct conversion {
    facet_scene *scene;
    facet_legacy_desc desc;
    const facet_log *log;
    texture_baker *baker;
    note_list notes;
    scene_conversion *out;       /* in the arena of the scene, which takes it over on success */
    scene_material *materials;   /* the new ones, in the arena of the scene; NULL: unchanged */
    struct scene_legacy *legacy; /* the same */
    bool *has_vertex_colors;     /* per material: a primitive of it has vertex colors */
    bool hides_everything;       /* MTL: all materials of primitives have opacity 0 */
    drop_plan drop;              /* of desc.drops_sources */
    facet_legacy_target target;  /* target of the fits; set by solve_all(), never _AUTO */
} conversion;

/* ---- interpreted legacy materials ---- */

typedef enum reading_kind {
    READING_OGL1,     /* diffuse, specular, shininess: fitted */
    READING_METALLIC, /* base color, metallic, roughness, as stated */
    READING_GLOSSY,   /* diffuse, specular, glossiness, as stated */
    READING_UNLIT,
    READING_KEPT /* the glTF material is already right */
} reading_kind;

typedef struct legacy_reading {
    reading_kind kind;
    legacy_material m;    /* unreadable and ignored maps are SCENE_NONE */
    ogl1_surface surface; /* factors, linear; diffuse: base color, specular: of READING_GLOSSY */
    float emission[3];    /* linear, factor of its map */
    float opacity;
    float metallic, perceptual_roughness; /* READING_METALLIC; READING_GLOSSY: roughness without a map */
    float glossiness;                     /* READING_GLOSSY: factor of its map */
    float F90;                            /* READING_GLOSSY: reflectance at grazing angles; 1 */
    float specular_level;                 /* F0 in units of glTF's 0.04; 1 */
    bool has_shininess_as_roughness;      /* map_Ns is a roughness or glossiness map, map_Ks metallic */
    bool has_roughness_from_shininess;    /* perceptual_roughness is that of the closed form */
    bool has_diffuse_alpha;               /* alpha of map_Kd is used */
    float transmission;                   /* 0: none */
    float ior;                            /* of glass; 0: not stated */
    bool is_refracting;
} legacy_reading;

void legacy_read(conversion *c, uint32_t material, legacy_reading *out);
/* convert_illum.c: the last step, by illum and the colors and maps of r. */
void legacy_read_illum(conversion *c, uint32_t material, legacy_reading *r);

/* The material is converted without that map. */
static inline void legacy_remove_map(legacy_map *map)
{
    map->ref.texture = SCENE_NONE;
}

/* ---- values ---- */

/* The conversion of one material. The input comes first and is compared byte by byte. */
typedef struct solve_item {
    struct solve_input {
        ogl1_surface ogl1; /* from OpenGL 1 */
        pbr_surface pbr;   /* to OpenGL 1 */
        float is_closed;   /* 1: with textures, whose texels use closed forms */
    } input;
    bool is_wanted;
    pbr_surface pbr;   /* the answer */
    ogl1_surface ogl1; /* the answer */
    uint32_t remarks;  /* fit_remark */
    fit_error error;
    double naive, core;
    double hue_share;    /* of fit_hue_share() */
    bool is_hue_kept;    /* by desc.keeps_hue */
    fit_error hue_error; /* if is_hue_kept: the error with the hue lost */
} solve_item;

/* Converts the items that are wanted. to: FACET_MATERIAL_MODEL_METALLIC_ROUGHNESS or _OGL1. */
facet_result solve_all(conversion *c, facet_material_model to, solve_item *items, uint32_t count,
                       facet_error *error);
/* Whether an item was converted in closed form rather than by a fit. */
bool solve_is_closed(const conversion *c, facet_material_model to, const solve_item *item);
/* Adds the remarks of a fit as notes. */
void solve_note(conversion *c, uint32_t material, const solve_item *item);

/* Fills the report of a material from its conversion. */
void summary_solved(const conversion *c, facet_conversion *summary, const solve_item *item);
/* The same where nothing is lost, or nothing can be compared. */
void summary_exact(facet_conversion *summary, const char *method);
facet_conversion_grade grade_of(double error);

/* ---- glTF materials of legacy ones ---- */

/* The surface that represents a reading in its conversion: maps at their means. */
ogl1_surface build_representative(const conversion *c, const legacy_reading *reading);
/* Builds textures and factors. Fails with FACET_ERROR_MEMORY. */
facet_result build_material(conversion *c, uint32_t material, legacy_reading *reading, const solve_item *item,
                            scene_material *out, facet_error *error);
facet_result build_surface_maps(conversion *c, uint32_t material, legacy_reading *reading,
                                const solve_item *item, scene_material *out, facet_error *error);

/* ---- legacy materials of glTF ones ---- */

/* Whether the statistics of a texture in that slot are needed. */
bool ogl1_reads_slot(scene_texture_slot slot);
/* The surface that represents a material in its conversion: textures at their means. */
pbr_surface ogl1_representative(const conversion *c, const scene_material *m);
/* Whether textures do more than scale the base color of a dielectric. */
bool ogl1_needs_texels(const conversion *c, const scene_material *m);
/* Builds maps and their factors. Fails with FACET_ERROR_MEMORY. */
facet_result ogl1_build_maps(conversion *c, uint32_t material, const scene_material *m,
                             const solve_item *item, legacy_material *out, facet_error *error);

/* ---- lights ----
 *
 * A white surface that faces a white light of 1 shows 1 in OpenGL 1 and 1 / pi in glTF: illuminances are pi times legacy
 * colors. */

/* Makes punctual lights, each with a node in the default scene, of scene->legacy; those of an earlier
 * conversion are replaced. Lights relative to the viewer are placed for the default camera; point lights
 * get the intensity that is right at the center of the scene. Fails with FACET_ERROR_MEMORY and then
 * leaves the scene unchanged. */
facet_result lights_from_legacy(conversion *c, facet_error *error);

/* Sets the lights of c->legacy from the punctual lights of the default scene at rest. */
facet_result lights_to_legacy(conversion *c, facet_error *error);

/* ---- the directions of a conversion ---- */

facet_result convert_from_ogl1(conversion *c, facet_error *error);
facet_result convert_to_ogl1(conversion *c, facet_error *error);
facet_result convert_from_glossiness(conversion *c, facet_error *error);
facet_result convert_to_glossiness(conversion *c, facet_error *error);

/* A name such as "wood_specular" for a texture made of map; in the arena, "" without memory. */
const char *made_name(conversion *c, uint32_t texture, const char *purpose);

#endif
