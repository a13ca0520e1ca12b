/* material_table.h - the parameters of a material by their glTF names: the table that reader, writer,
 * description and animation pointers share. */
#ifndef SCENE_MATERIAL_TABLE_H
#define SCENE_MATERIAL_TABLE_H

#include <stddef.h>

#include "scene/scene.h"

/* Numbers of a scene_material: members given by object, texture and key of the JSON. */
typedef struct material_parameter {
    uint32_t extension;     /* SCENE_CLEARCOAT ..; 0: of the core */
    const char *object;     /* "": the material itself; "pbrMetallicRoughness"; else an extension's name */
    const char *texture;    /* textureInfo in object that has the key ("normalTexture"); NULL: object */
    const char *key;        /* "metallicFactor" */
    size_t offset;          /* of the first float */
    uint32_t count;         /* floats */
    float minimum, maximum; /* range of the specification */
} material_parameter;

/* A texture of a scene_material. */
typedef struct material_texture {
    uint32_t extension;
    const char *object;
    const char *key; /* "baseColorTexture" */
    bool is_color;   /* RGB carries the sRGB transfer function */
} material_texture;

/* An extension, by its bit. */
typedef struct material_extension {
    uint32_t bit;
    const char *name;
} material_extension;

enum { MATERIAL_PARAMETER_COUNT = 35, MATERIAL_EXTENSION_COUNT = 15 };
extern const material_parameter material_parameters[MATERIAL_PARAMETER_COUNT];
extern const material_texture material_textures[SCENE_TEXTURE_SLOT_COUNT]; /* by slot */
extern const material_extension material_extensions[MATERIAL_EXTENSION_COUNT];

/* The numbers of a row. */
static inline float *material_floats(scene_material *m, const material_parameter *row)
{
    return (float *)(void *)((char *)m + row->offset);
}
static inline const float *material_floats_const(const scene_material *m, const material_parameter *row)
{
    return (const float *)(const void *)((const char *)m + row->offset);
}

#endif
