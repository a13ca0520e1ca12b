/* describe_materials.c - materials as JSON, the core by facet's names, extensions by glTF's; textures and
 * images; materials, lights and fog of OpenGL 1, only what is stated. */
#include "scene/describe.h"

#include "scene/legacy_extras.h"
#include "scene/material_table.h"

static void write_texture_ref(text *t, const char *key, const scene_texture_ref *ref)
{
    if (ref->texture == SCENE_NONE)
        return;
    text_json_begin_object(t, key);
    text_json_integer(t, "texture", ref->texture);
    text_json_integer(t, "texcoord", ref->texcoord);
    if (ref->has_transform)
        text_json_floats(t, "transform", ref->transform, 6);
    text_json_end_object(t);
}

/* All parameters and textures of one extension. */
static void write_extension(text *t, const scene_material *m, const material_extension *extension)
{
    text_json_begin_object(t, extension->name);
    for (int i = 0; i < MATERIAL_PARAMETER_COUNT; i++) {
        const material_parameter *row = &material_parameters[i];
        const float *values = material_floats_const(m, row);
        if (row->extension != extension->bit || row->texture)
            continue;
        if (row->count == 1)
            text_json_float(t, row->key, values[0]); /* null: infinite */
        else
            text_json_floats(t, row->key, values, row->count);
    }
    for (int slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++)
        if (material_textures[slot].extension == extension->bit)
            write_texture_ref(t, material_textures[slot].key, &m->textures[slot]);
    if (extension->bit == SCENE_CLEARCOAT)
        text_json_float(t, "normal_scale", m->clearcoat_normal_scale);
    text_json_end_object(t);
}

static void write_material(text *t, const scene_material *m)
{
    static const char *const alpha_modes[] = {"OPAQUE", "MASK", "BLEND"};
    float emissive[3];
    for (int i = 0; i < 3; i++)
        emissive[i] = m->emissive[i] * m->emissive_strength;
    text_json_begin_object(t, NULL);
    text_json_string(t, "name", m->name);
    text_json_floats(t, "base_color", m->base_color, 4);
    text_json_float(t, "metallic", m->metallic);
    text_json_float(t, "roughness", m->perceptual_roughness);
    text_json_float(t, "normal_scale", m->normal_scale);
    text_json_float(t, "occlusion_strength", m->occlusion_strength);
    text_json_floats(t, "emissive", emissive, 3);
    text_json_string(t, "alpha_mode", alpha_modes[m->alpha_mode]);
    text_json_float(t, "alpha_cutoff", m->alpha_cutoff);
    text_json_bool(t, "double_sided", m->is_double_sided);
    text_json_bool(t, "unlit", (m->extensions & SCENE_UNLIT) != 0);
    text_json_float(t, "ior", m->ior);
    text_json_float(t, "specular", m->specular);
    text_json_floats(t, "specular_color", m->specular_color, 3);
    write_texture_ref(t, "base_color_texture", &m->textures[SCENE_BASE_COLOR_TEXTURE]);
    write_texture_ref(t, "metallic_roughness_texture", &m->textures[SCENE_METALLIC_ROUGHNESS_TEXTURE]);
    write_texture_ref(t, "normal_texture", &m->textures[SCENE_NORMAL_TEXTURE]);
    write_texture_ref(t, "occlusion_texture", &m->textures[SCENE_OCCLUSION_TEXTURE]);
    write_texture_ref(t, "emissive_texture", &m->textures[SCENE_EMISSIVE_TEXTURE]);
    write_texture_ref(t, "specular_texture", &m->textures[SCENE_SPECULAR_TEXTURE]);
    write_texture_ref(t, "specular_color_texture", &m->textures[SCENE_SPECULAR_COLOR_TEXTURE]);
    text_json_begin_object(t, "extensions");
    for (int i = 0; i < MATERIAL_EXTENSION_COUNT; i++)
        if (m->extensions & material_extensions[i].bit)
            write_extension(t, m, &material_extensions[i]);
    text_json_end_object(t);
    describe_meta(t, &m->meta);
    text_json_end_object(t);
}

void describe_materials(text *t, const facet_scene *scene)
{
    DESCRIBE_ARRAY("materials", scene->materials, scene->material_count, write_material);
}

/* ---- textures and images ---- */

static void write_texture(text *t, const scene_texture *texture)
{
    static const char *const wraps[] = {"repeat", "clamp", "mirror"};
    static const char *const filters[] = {"linear", "nearest"};
    static const char *const mips[] = {"linear", "nearest", "none"};
    text_json_begin_object(t, NULL);
    text_json_string(t, "name", texture->name);
    describe_index(t, "image", texture->image);
    text_json_string(t, "wrap_u", wraps[texture->wrap_u]);
    text_json_string(t, "wrap_v", wraps[texture->wrap_v]);
    text_json_string(t, "mag_filter", filters[texture->mag_filter]);
    text_json_string(t, "min_filter", filters[texture->min_filter]);
    text_json_string(t, "mip_filter", mips[texture->mip_filter]);
    describe_meta(t, &texture->meta);
    text_json_end_object(t);
}

static void write_image(text *t, const scene_image *image)
{
    text_json_begin_object(t, NULL);
    text_json_string(t, "name", image->name);
    text_json_string(t, "mime_type", image->mime_type[0] ? image->mime_type : NULL);
    text_json_integer(t, "bytes", (int64_t)image->size);
    text_json_integer(t, "width", image->width);
    text_json_integer(t, "height", image->height);
    text_json_bool(t, "readable", image->bytes != NULL);
    describe_meta(t, &image->meta);
    text_json_end_object(t);
}

void describe_images(text *t, const facet_scene *scene)
{
    DESCRIBE_ARRAY("textures", scene->textures, scene->texture_count, write_texture);
    DESCRIBE_ARRAY("images", scene->images, scene->image_count, write_image);
}

/* ---- OpenGL 1 ---- */

static void write_maps(text *t, const legacy_material *m)
{
    text_json_begin_object(t, "maps");
    for (int i = 0; i < LEGACY_MAP_COUNT; i++) {
        const legacy_map *map = &m->maps[i];
        if (!map->path && map->ref.texture == SCENE_NONE)
            continue;
        text_json_begin_object(t, legacy_map_names[i]);
        text_json_string(t, "path", map->path);
        describe_index(t, "texture", map->ref.texture);
        if (map->options)
            text_json_string(t, "options", map->options);
        text_json_end_object(t);
    }
    text_json_end_object(t);
}

static void write_flag(text *t, const char *key, bool value, bool usual)
{
    if (value != usual)
        text_json_bool(t, key, value);
}

static void write_legacy_material(text *t, const legacy_material *m)
{
    text_json_begin_object(t, NULL);
    text_json_string(t, "name", m->name);
    for (int i = 0; i < LEGACY_PARAMETER_COUNT; i++) {
        const legacy_parameter *row = &legacy_parameters[i];
        if (m->fields & row->field && row->count == 1)
            text_json_float(t, row->name, *legacy_floats_const(m, row));
        else if (m->fields & row->field)
            text_json_floats(t, row->name, legacy_floats_const(m, row), row->count);
    }
    if (m->fields & LEGACY_ILLUM)
        text_json_integer(t, "illum", m->illum);
    write_flag(t, "lit", m->is_lit, true);
    write_flag(t, "smooth", m->is_smooth, true);
    write_flag(t, "fog", m->has_fog, true);
    write_flag(t, "halo", m->is_halo, false);
    write_flag(t, "environment_map", m->has_environment_map, false);
    if (m->texture_type != LEGACY_RGB || m->texture_mode != LEGACY_MODULATE) {
        text_json_string(t, "texture_type", legacy_texture_type_names[m->texture_type]);
        text_json_string(t, "texture_mode", legacy_texture_mode_names[m->texture_mode]);
    }
    write_maps(t, m);
    if (m->unknown)
        text_json_string(t, "unknown", m->unknown);
    text_json_end_object(t);
}

static void write_light(text *t, const legacy_light *l)
{
    text_json_begin_object(t, NULL);
    text_json_string(t, "type", l->is_point ? "point" : "directional");
    text_json_bool(t, "viewpoint_relative", l->is_viewpoint_relative);
    text_json_floats(t, l->is_point ? "position" : "direction", l->position, 3);
    text_json_floats(t, "ambient", l->ambient, 3);
    text_json_floats(t, "diffuse", l->diffuse, 3);
    text_json_floats(t, "specular", l->specular, 3);
    text_json_end_object(t);
}

static void write_fog(text *t, const legacy_fog *fog)
{
    text_json_begin_object(t, "fog");
    text_json_string(t, "mode", legacy_fog_names[fog->mode]);
    text_json_floats(t, "color", fog->color, 3);
    text_json_float(t, "scale", fog->scale);
    text_json_end_object(t);
}

void describe_legacy(text *t, const facet_scene *scene)
{
    const scene_legacy *legacy = scene->legacy;
    if (!legacy)
        return;
    text_json_begin_object(t, "legacy");
    text_json_bool(t, "converted", !legacy->is_source);
    text_json_string(t, "colors", legacy->colors == FACET_LEGACY_COLORS_LINEAR ? "linear" : "srgb");
    text_json_string(t, "dialect", legacy_dialect_names[legacy->dialect]);
    text_json_bool(t, "dialect_guessed", legacy->is_dialect_guessed);
    DESCRIBE_ARRAY("materials", legacy->materials, scene->material_count, write_legacy_material);
    DESCRIBE_ARRAY("lights", legacy->lights, legacy->light_count, write_light);
    if (legacy->fog.mode != LEGACY_FOG_NONE)
        write_fog(t, &legacy->fog);
    text_json_end_object(t);
}
