/* legacy_extras.h - materials of OpenGL 1 as JSON, by MTL's names: "extras.facet_legacy" of materials and
 * of the root of a glTF file. The reader is io/gltf/gltf_extras.c. */
#ifndef SCENE_LEGACY_EXTRAS_H
#define SCENE_LEGACY_EXTRAS_H

#include "base/text.h"
#include "scene/legacy.h"

/* ---- names ---- */

/* Numbers of a legacy_material that a file may state. */
typedef struct legacy_parameter {
    const char *key;  /* "Kd": in MTL and extras */
    const char *name; /* "diffuse": in descriptions */
    uint32_t field;   /* LEGACY_DIFFUSE .. */
    size_t offset;    /* of the first float */
    uint32_t count;   /* floats */
    float minimum, maximum;
} legacy_parameter;

enum { LEGACY_PARAMETER_COUNT = 16, LEGACY_PBR_FACTOR_COUNT = 8 };
extern const legacy_parameter legacy_parameters[LEGACY_PARAMETER_COUNT];
extern const char *const legacy_map_keys[LEGACY_MAP_COUNT];  /* "map_Kd"; of map_RMA: "map_ORM" */
extern const char *const legacy_map_names[LEGACY_MAP_COUNT]; /* "diffuse" */

static inline float *legacy_floats(legacy_material *m, const legacy_parameter *row)
{
    return (float *)(void *)((char *)m + row->offset);
}
static inline const float *legacy_floats_const(const legacy_material *m, const legacy_parameter *row)
{
    return (const float *)(const void *)((const char *)m + row->offset);
}

/* Booleans of a legacy_material, with their defaults in JSON. */
typedef struct legacy_flag {
    const char *key;
    size_t offset;
    bool fallback;
} legacy_flag;
enum { LEGACY_FLAG_COUNT = 8 };
extern const legacy_flag legacy_flags[LEGACY_FLAG_COUNT];

/* Names of enumerators, in order, NULL at the end. */
extern const char *const legacy_texture_type_names[], *const legacy_texture_mode_names[];
extern const char *const legacy_fog_names[];
extern const char *const legacy_color_names[];   /* of facet_legacy_colors */
extern const char *const legacy_dialect_names[]; /* of facet_mtl_dialect */

/* The numbers of a glTF material that show whether it has changed since the conversion: "pbr". */
typedef struct legacy_pbr_factor {
    const char *key; /* "roughnessFactor" */
    uint32_t count;
} legacy_pbr_factor;
extern const legacy_pbr_factor legacy_pbr_factors[LEGACY_PBR_FACTOR_COUNT];
void legacy_pbr_factor_get(const scene_material *m, int factor, float out[3]);

/* ---- text ---- */

/* A material as an object. pbr: the glTF material converted from it, whose factors become the member
 * "pbr"; NULL: without. Textures are given by index in the scene. */
void legacy_extras_write_material(const legacy_material *m, const scene_material *pbr, text *out);
/* The same for material `material`: the member "facet_legacy" of a glTF material's extras. */
void legacy_extras_write(const scene_legacy *legacy, uint32_t material, const scene_material *pbr, text *out);
/* Lights, fog, colors and dialect: "facet_legacy" of the root object's extras. */
void legacy_extras_write_scene(const scene_legacy *legacy, text *out);
/* Sets the member "facet_legacy" of extras (JSON text of any kind, NULL: none) to object; all else stays.
 * Extras that are not an object become its member "extras". object NULL: removes the member; nothing is
 * added if nothing else is left. */
void legacy_extras_merge(const char *extras, const char *object, text *out);

#endif
