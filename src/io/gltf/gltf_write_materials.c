/* gltf_write_materials.c - materials, by the table that they are read by. */
#include <string.h>

#include "io/gltf/gltf_writer.h"
#include "scene/material_table.h"

/* The object of the JSON that a row names; borrowed. */
static json_t *object_of(gltf_writer *w, json_t *material, const char *name, uint32_t extension)
{
    if (name[0] == 0)
        return material;
    return extension ? gltf_put_extension(w, material, name) : gltf_put_object(w, material, name);
}

/* pbrSpecularGlossiness stands in place of pbrMetallicRoughness and shares members with it: whether the material is
 * of the kind that a row belongs to. */
static bool is_of_kind(const scene_material *m, uint32_t extension, const char *object)
{
    if (extension == SCENE_SPECULAR_GLOSSINESS)
        return (m->extensions & SCENE_SPECULAR_GLOSSINESS) != 0;
    if (m->extensions & SCENE_SPECULAR_GLOSSINESS)
        return strcmp(object, "pbrMetallicRoughness") != 0 && extension != SCENE_SPECULAR;
    return true;
}

/* In place of the texture's number: its image by the name of the file, its sampler and its name. */
static void put_named_texture(gltf_writer *w, json_t *info, uint32_t texture)
{
    const scene_texture *t = &w->scene->textures[texture];
    const char *file = t->image == SCENE_NONE || !w->image_names ? NULL : w->image_names[t->image];
    gltf_put(w, info, "image", file ? gltf_json_text(w, file) : json_null());
    gltf_put(w, info, "sampler", gltf_new_sampler(w, t));
    gltf_put_name(w, info, t->name);
}

static json_t *new_texture_info(gltf_writer *w, const scene_texture_ref *ref)
{
    json_t *info = json_object();
    if (w->names_images)
        put_named_texture(w, info, ref->texture);
    else
        gltf_put_index(w, info, "index", ref->texture);
    if (ref->texcoord)
        gltf_put(w, info, "texCoord", json_integer(ref->texcoord));
    const float one[2] = {1, 1};
    bool is_moved = ref->offset[0] != 0.0f || ref->offset[1] != 0.0f || ref->rotation_rad != 0.0f ||
                    ref->scale[0] != 1.0f || ref->scale[1] != 1.0f;
    if (is_moved) {
        json_t *transform = gltf_put_extension(w, info, "KHR_texture_transform");
        gltf_put_floats(w, transform, "offset", ref->offset, NULL, 2);
        gltf_put_float(w, transform, "rotation", ref->rotation_rad, 0.0f);
        gltf_put_floats(w, transform, "scale", ref->scale, one, 2);
    }
    return info;
}

static void write_texture_infos(gltf_writer *w, json_t *out, const scene_material *m)
{
    for (int slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++) {
        const material_texture *row = &material_textures[slot];
        const scene_texture_ref *ref = &m->textures[slot];
        const char *key = row->key;
        const char *object = row->object;
        uint32_t extension = row->extension;
        if (ref->texture == SCENE_NONE)
            continue;
        if (slot == SCENE_BASE_COLOR_TEXTURE && m->extensions & SCENE_SPECULAR_GLOSSINESS) {
            object = material_textures[SCENE_SPECULAR_GLOSSINESS_TEXTURE].object;
            extension = SCENE_SPECULAR_GLOSSINESS;
            key = "diffuseTexture";
        } else if (!is_of_kind(m, extension, object) || (extension && !(m->extensions & extension))) {
            continue;
        }
        gltf_put(w, object_of(w, out, object, extension), key, new_texture_info(w, ref));
    }
}

static void write_parameters(gltf_writer *w, json_t *out, const scene_material *m)
{
    scene_material defaults = scene_material_default();
    for (int i = 0; i < MATERIAL_PARAMETER_COUNT; i++) {
        const material_parameter *row = &material_parameters[i];
        const float *values = material_floats_const(m, row);
        if (!is_of_kind(m, row->extension, row->object) ||
            (row->extension && !(m->extensions & row->extension)) ||
            memcmp(values, material_floats_const(&defaults, row), row->count * sizeof *values) == 0)
            continue;
        json_t *object = object_of(w, out, row->object, row->extension);
        if (row->texture) /* a member of the texture's object, which is there or says nothing */
            object = json_object_get(object, row->texture);
        if (object)
            gltf_put_floats(w, object, row->key, values, material_floats_const(&defaults, row), row->count);
    }
}

json_t *gltf_new_material(gltf_writer *w, const scene_material *m)
{
    static const char *const alpha_modes[] = {"OPAQUE", "MASK", "BLEND"};
    json_t *out = json_object();
    gltf_put_name(w, out, m->name);
    for (int i = 0; i < MATERIAL_EXTENSION_COUNT; i++)
        if (m->extensions & material_extensions[i].bit)
            gltf_put_extension(w, out, material_extensions[i].name);
    write_texture_infos(w, out, m);
    write_parameters(w, out, m);
    if (m->alpha_mode != SCENE_ALPHA_OPAQUE)
        gltf_put(w, out, "alphaMode", json_string(alpha_modes[m->alpha_mode]));
    if (m->alpha_mode != SCENE_ALPHA_MASK)
        json_object_del(out, "alphaCutoff");
    if (m->is_double_sided)
        gltf_put(w, out, "doubleSided", json_true());
    gltf_put_meta(w, out, &m->meta);
    return out;
}

void gltf_write_materials(gltf_writer *w)
{
    for (uint32_t i = 0; i < w->scene->material_count; i++)
        gltf_append(w, gltf_put_array(w, w->root, "materials"),
                    gltf_new_material(w, &w->scene->materials[i]));
}
