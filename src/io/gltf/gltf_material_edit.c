/* gltf_material_edit.c - changes of a material after reading, in glTF's own words. */
#include <string.h>

#include "base/result.h"
#include "io/gltf/gltf.h"
#include "io/gltf/gltf_reader.h"
#include "scene/material_table.h"

/* Takes out of json what is null, and gives it its default in m. */
static void take_away(scene_material *m, json_t *json, const char *object_name)
{
    const scene_material usual = scene_material_default();
    for (size_t i = 0; i < SCENE_TEXTURE_SLOT_COUNT; i++) {
        const material_texture *row = &material_textures[i];
        if (strcmp(row->object, object_name) != 0 || !json_is_null(json_object_get(json, row->key)))
            continue;
        m->textures[i] = usual.textures[i];
        json_object_del(json, row->key);
    }
}

static void take_extension_away(scene_material *m, const material_extension *extension)
{
    const scene_material usual = scene_material_default();
    m->extensions &= ~extension->bit;
    for (size_t i = 0; i < MATERIAL_PARAMETER_COUNT; i++) {
        const material_parameter *row = &material_parameters[i];
        if (row->extension == extension->bit)
            memcpy(material_floats(m, row), material_floats_const(&usual, row), row->count * sizeof(float));
    }
    for (size_t i = 0; i < SCENE_TEXTURE_SLOT_COUNT; i++)
        if (material_textures[i].extension == extension->bit)
            m->textures[i] = usual.textures[i];
}

static void take_nulls_away(scene_material *m, json_t *json)
{
    take_away(m, json, "");
    take_away(m, json_object_get(json, "pbrMetallicRoughness"), "pbrMetallicRoughness");
    json_t *extensions = json_object_get(json, "extensions");
    for (size_t i = 0; i < MATERIAL_EXTENSION_COUNT; i++) {
        const char *name = material_extensions[i].name;
        json_t *extension = json_object_get(extensions, name);
        if (json_is_null(extension)) {
            take_extension_away(m, &material_extensions[i]);
            json_object_del(extensions, name);
        } else {
            take_away(m, extension, name);
        }
    }
}

facet_result gltf_edit_material(facet_scene *scene, uint32_t material, const char *json, facet_error *error)
{
    const facet_log silent = {0};
    if (material >= scene->material_count)
        return fail(error, FACET_ERROR_ARGUMENT, "%s: there is no material %u; it has %u", scene->source,
                    material, scene->material_count);
    io_reader r = {.scene = scene, .allocator = &scene->allocator, .log = &silent, .error = error};
    json_t *parsed = io_parse_json(&r, json, strlen(json));
    const json_place root = {.value = parsed}, array = {.parent = &root, .key = "materials", .value = parsed};
    const json_place at =
        io_as_object(&r, (json_place){.parent = &array, .index = material, .value = parsed});
    scene_material changed = scene->materials[material];
    if (io_is_ok(&r)) {
        take_nulls_away(&changed, parsed);
        gltf_read_material_members(&r, &at, &changed);
    }
    if (io_is_ok(&r)) {
        scene->materials[material] = changed;
        scene->place_revision++;
    }
    json_decref(parsed);
    return r.result;
}
