/* describe_legacy.c - materials, lights and fog of OpenGL 1 as JSON; only what is stated. */
#include "scene/describe.h"
#include "scene/legacy.h"

static const char *const MAP_NAMES[LEGACY_MAP_COUNT] = {
    "ambient", "diffuse",    "specular", "emission",  "shininess", "opacity", "bump", "displacement",
    "decal",   "reflection", "normal",   "roughness", "metallic",  "sheen",   "orm"};

static void write_maps(text *t, const legacy_material *m)
{
    text_json_begin_object(t, "maps");
    for (int i = 0; i < LEGACY_MAP_COUNT; i++) {
        const legacy_map *map = &m->maps[i];
        if (!map->path && map->ref.texture == SCENE_NONE)
            continue;
        text_json_begin_object(t, MAP_NAMES[i]);
        text_json_string(t, "path", map->path);
        describe_index(t, "texture", map->ref.texture);
        if (map->options)
            text_json_string(t, "options", map->options);
        text_json_end_object(t);
    }
    text_json_end_object(t);
}

static void write_number(text *t, const legacy_material *m, uint32_t field, const char *key, float value)
{
    if (m->fields & field)
        text_json_float(t, key, value);
}

static void write_color(text *t, const legacy_material *m, uint32_t field, const char *key,
                        const float value[3])
{
    if (m->fields & field)
        text_json_floats(t, key, value, 3);
}

static void write_flag(text *t, const char *key, bool value, bool usual)
{
    if (value != usual)
        text_json_bool(t, key, value);
}

static void write_material(text *t, const legacy_material *m)
{
    static const char *const types[] = {"rgb", "rgba", "alpha", "luminance", "luminance.alpha"};
    static const char *const modes[] = {"modulate", "replace", "decal", "blend", "add"};
    text_json_begin_object(t, NULL);
    text_json_string(t, "name", m->name);
    write_color(t, m, LEGACY_AMBIENT, "ambient", m->ambient);
    write_color(t, m, LEGACY_DIFFUSE, "diffuse", m->diffuse);
    write_color(t, m, LEGACY_SPECULAR, "specular", m->specular);
    write_color(t, m, LEGACY_EMISSION, "emission", m->emission);
    write_number(t, m, LEGACY_SHININESS, "shininess", m->shininess);
    write_number(t, m, LEGACY_OPACITY, "opacity", m->opacity);
    if (m->fields & LEGACY_ILLUM)
        text_json_integer(t, "illum", m->illum);
    write_number(t, m, LEGACY_IOR, "ior", m->ior);
    write_color(t, m, LEGACY_TRANSMISSION_FILTER, "transmission_filter", m->transmission_filter);
    write_number(t, m, LEGACY_SHARPNESS, "sharpness", m->sharpness);
    write_number(t, m, LEGACY_ROUGHNESS, "roughness", m->roughness);
    write_number(t, m, LEGACY_METALLIC, "metallic", m->metallic);
    write_number(t, m, LEGACY_SHEEN, "sheen", m->sheen);
    write_number(t, m, LEGACY_CLEARCOAT, "clearcoat", m->clearcoat);
    write_number(t, m, LEGACY_CLEARCOAT_ROUGHNESS, "clearcoat_roughness", m->clearcoat_roughness);
    write_number(t, m, LEGACY_ANISOTROPY, "anisotropy", m->anisotropy);
    write_number(t, m, LEGACY_ANISOTROPY_ROTATION, "anisotropy_rotation", m->anisotropy_rotation);
    write_flag(t, "lit", m->is_lit, true);
    write_flag(t, "smooth", m->is_smooth, true);
    write_flag(t, "fog", m->has_fog, true);
    write_flag(t, "halo", m->is_halo, false);
    write_flag(t, "environment_map", m->has_environment_map, false);
    if (m->texture_type != LEGACY_RGB || m->texture_mode != LEGACY_MODULATE) {
        text_json_string(t, "texture_type", types[m->texture_type]);
        text_json_string(t, "texture_mode", modes[m->texture_mode]);
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
    static const char *const modes[] = {"none", "linear", "exp", "exp2"};
    text_json_begin_object(t, "fog");
    text_json_string(t, "mode", modes[fog->mode]);
    text_json_floats(t, "color", fog->color, 3);
    text_json_float(t, "scale", fog->scale);
    text_json_end_object(t);
}

void describe_legacy(text *t, const facet_scene *scene)
{
    static const char *const dialects[] = {"auto",     "spec",        "blender27",  "blender28",
                                           "blender3", "obj2gltf-mr", "obj2gltf-sg"};
    const scene_legacy *legacy = scene->legacy;
    if (!legacy)
        return;
    text_json_begin_object(t, "legacy");
    text_json_bool(t, "converted", !legacy->is_source);
    text_json_string(t, "colors", legacy->colors == FACET_LEGACY_COLORS_LINEAR ? "linear" : "srgb");
    text_json_string(t, "dialect", dialects[legacy->dialect]);
    text_json_bool(t, "dialect_guessed", legacy->is_dialect_guessed);
    text_json_begin_array(t, "materials");
    for (uint32_t i = 0; i < scene->material_count; i++)
        write_material(t, &legacy->materials[i]);
    text_json_end_array(t);
    text_json_begin_array(t, "lights");
    for (uint32_t i = 0; i < legacy->light_count; i++)
        write_light(t, &legacy->lights[i]);
    text_json_end_array(t);
    if (legacy->fog.mode != LEGACY_FOG_NONE)
        write_fog(t, &legacy->fog);
    text_json_end_object(t);
}
