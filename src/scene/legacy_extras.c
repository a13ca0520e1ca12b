/* legacy_extras.c - see legacy_extras.h. */
#include "scene/legacy_extras.h"

#include <stddef.h>
#include <string.h>

/* ---- names ---- */

#define ROW(key, field, member, count, minimum, maximum)                                                     \
    {                                                                                                        \
        key, #member, field, offsetof(legacy_material, member), count, minimum, maximum                      \
    }

/* MTL limits Ns to 1000; larger values are common and are kept. Color limits apply to light as well. */
const legacy_parameter legacy_parameters[LEGACY_PARAMETER_COUNT] = {
    ROW("Ka", LEGACY_AMBIENT, ambient, 3, 0, LEGACY_LARGEST),
    ROW("Kd", LEGACY_DIFFUSE, diffuse, 3, 0, LEGACY_LARGEST),
    ROW("Ks", LEGACY_SPECULAR, specular, 3, 0, LEGACY_LARGEST),
    ROW("Ke", LEGACY_EMISSION, emission, 3, 0, LEGACY_LARGEST),
    ROW("Tf", LEGACY_TRANSMISSION_FILTER, transmission_filter, 3, 0, LEGACY_LARGEST),
    ROW("Ns", LEGACY_SHININESS, shininess, 1, 0, 1e6f),
    ROW("d", LEGACY_OPACITY, opacity, 1, 0, 1),
    ROW("Ni", LEGACY_IOR, ior, 1, 0, 1000),
    ROW("sharpness", LEGACY_SHARPNESS, sharpness, 1, 0, 1000),
    ROW("Pr", LEGACY_ROUGHNESS, roughness, 1, 0, 1),
    ROW("Pm", LEGACY_METALLIC, metallic, 1, 0, 1),
    ROW("Ps", LEGACY_SHEEN, sheen, 1, 0, 1),
    ROW("Pc", LEGACY_CLEARCOAT, clearcoat, 1, 0, 1),
    ROW("Pcr", LEGACY_CLEARCOAT_ROUGHNESS, clearcoat_roughness, 1, 0, 1),
    ROW("aniso", LEGACY_ANISOTROPY, anisotropy, 1, -1, 1),
    ROW("anisor", LEGACY_ANISOTROPY_ROTATION, anisotropy_rotation, 1, 0, 1),
};

const char *const legacy_map_names[LEGACY_MAP_COUNT] = {
    "ambient", "diffuse",    "specular", "emission",  "shininess", "opacity", "bump", "displacement",
    "decal",   "reflection", "normal",   "roughness", "metallic",  "sheen",   "orm"};
const char *const legacy_map_keys[LEGACY_MAP_COUNT] = {"map_Ka", "map_Kd",   "map_Ks", "map_Ke", "map_Ns",
                                                       "map_d",  "map_Bump", "disp",   "decal",  "refl",
                                                       "norm",   "map_Pr",   "map_Pm", "map_Ps", "map_ORM"};

const legacy_flag legacy_flags[LEGACY_FLAG_COUNT] = {
    {"halo", offsetof(legacy_material, is_halo), false},
    {"ambiguous", offsetof(legacy_material, is_transparency_ambiguous), false},
    {"lit", offsetof(legacy_material, is_lit), true},
    {"smooth", offsetof(legacy_material, is_smooth), true},
    {"fog", offsetof(legacy_material, has_fog), true},
    {"culled", offsetof(legacy_material, is_culled), false},
    {"environment_map", offsetof(legacy_material, has_environment_map), false},
    {"rma", offsetof(legacy_material, is_rma), false},
};

const char *const legacy_texture_type_names[] = {"rgb", "rgba", "alpha", "luminance", "luminance.alpha",
                                                 NULL};
const char *const legacy_texture_mode_names[] = {"modulate", "replace", "decal", "blend", "add", NULL};
const char *const legacy_fog_names[] = {"none", "linear", "exp", "exp2", NULL};
const char *const legacy_color_names[] = {"default", "srgb", "linear", NULL};
const char *const legacy_dialect_names[] = {"auto",     "spec",        "blender27",   "blender28",
                                            "blender3", "obj2gltf-mr", "obj2gltf-sg", NULL};

const legacy_pbr_factor legacy_pbr_factors[LEGACY_PBR_FACTOR_COUNT] = {
    {"baseColorFactor", 3},
    {"alpha", 1},
    {"metallicFactor", 1},
    {"roughnessFactor", 1},
    {"specularFactor", 1},
    {"specularColorFactor", 3},
    {"ior", 1},
    {"emissiveFactor", 3}, /* times its strength */
};

void legacy_pbr_factor_get(const scene_material *m, int factor, float out[3])
{
    const float *const sources[LEGACY_PBR_FACTOR_COUNT] = {
        m->base_color, &m->base_color[3], &m->metallic, &m->perceptual_roughness,
        &m->specular,  m->specular_color, &m->ior,      m->emissive};
    memcpy(out, sources[factor], legacy_pbr_factors[factor].count * sizeof *out);
    for (int i = 0; factor == LEGACY_PBR_FACTOR_COUNT - 1 && i < 3; i++)
        out[i] *= m->emissive_strength;
}

/* ---- one material ---- */

static void write_values(text *out, const char *key, const float *values, uint32_t count)
{
    if (count == 1)
        text_json_float(out, key, *values);
    else
        text_json_floats(out, key, values, count);
}

static void write_map(const legacy_map *map, const char *key, text *out)
{
    const legacy_map defaults = legacy_map_default();
    const scene_texture_ref *ref = &map->ref;
    const char channel[2] = {map->channel, 0};
    text_json_begin_object(out, key);
    if (map->path)
        text_json_string(out, "path", map->path);
    if (map->options)
        text_json_string(out, "options", map->options);
    if (map->dropped)
        text_json_string(out, "dropped", map->dropped);
    if (ref->texture != SCENE_NONE)
        text_json_integer(out, "texture", ref->texture);
    if (map->is_left_out)
        text_json_bool(out, "left_out", true);
    if (ref->texcoord)
        text_json_integer(out, "texCoord", ref->texcoord);
    if (ref->offset[0] != 0.0f || ref->offset[1] != 0.0f)
        text_json_floats(out, "offset", ref->offset, 2);
    if (ref->scale[0] != 1.0f || ref->scale[1] != 1.0f)
        text_json_floats(out, "scale", ref->scale, 2);
    if (ref->rotation_rad != 0.0f)
        text_json_float(out, "rotation", ref->rotation_rad);
    if (map->base != defaults.base)
        text_json_float(out, "base", map->base);
    if (map->gain != defaults.gain)
        text_json_float(out, "gain", map->gain);
    if (map->bump_multiplier != defaults.bump_multiplier)
        text_json_float(out, "bm", map->bump_multiplier);
    if (map->channel)
        text_json_string(out, "imfchan", channel);
    text_json_end_object(out);
}

static void write_pbr(const scene_material *pbr, text *out)
{
    text_json_begin_object(out, "pbr");
    for (int i = 0; i < LEGACY_PBR_FACTOR_COUNT; i++) {
        float values[3];
        legacy_pbr_factor_get(pbr, i, values);
        write_values(out, legacy_pbr_factors[i].key, values, legacy_pbr_factors[i].count);
    }
    text_json_end_object(out);
}

void legacy_extras_write_material(const legacy_material *m, const scene_material *pbr, text *out)
{
    text_json_begin_object(out, NULL);
    for (int i = 0; i < LEGACY_PARAMETER_COUNT; i++)
        if (legacy_has(m, legacy_parameters[i].field))
            write_values(out, legacy_parameters[i].key, legacy_floats_const(m, &legacy_parameters[i]),
                         legacy_parameters[i].count);
    if (legacy_has(m, LEGACY_ILLUM))
        text_json_integer(out, "illum", m->illum);
    for (int i = 0; i < LEGACY_FLAG_COUNT; i++) {
        bool value = *(const bool *)((const char *)m + legacy_flags[i].offset);
        if (value != legacy_flags[i].fallback)
            text_json_bool(out, legacy_flags[i].key, value);
    }
    if (m->texture_type != LEGACY_RGB)
        text_json_string(out, "texture_type", legacy_texture_type_names[m->texture_type]);
    if (m->texture_mode != LEGACY_MODULATE)
        text_json_string(out, "texture_mode", legacy_texture_mode_names[m->texture_mode]);
    for (int i = 0; i < LEGACY_MAP_COUNT; i++)
        if (m->maps[i].path || m->maps[i].ref.texture != SCENE_NONE || m->maps[i].is_left_out)
            write_map(&m->maps[i], legacy_map_keys[i], out);
    if (m->unknown)
        text_json_string(out, "unknown", m->unknown);
    if (pbr)
        write_pbr(pbr, out);
    text_json_end_object(out);
}

void legacy_extras_write(const scene_legacy *legacy, uint32_t material, const scene_material *pbr, text *out)
{
    legacy_extras_write_material(&legacy->materials[material], pbr, out);
}

/* ---- the scene ---- */

static void write_light(const legacy_light *light, text *out)
{
    text_json_begin_object(out, NULL);
    text_json_bool(out, "point", light->is_point);
    text_json_bool(out, "viewpoint_relative", light->is_viewpoint_relative);
    text_json_floats(out, "position", light->position, 3);
    text_json_floats(out, "ambient", light->ambient, 3);
    text_json_floats(out, "diffuse", light->diffuse, 3);
    text_json_floats(out, "specular", light->specular, 3);
    text_json_end_object(out);
}

void legacy_extras_write_scene(const scene_legacy *legacy, text *out)
{
    text_json_begin_object(out, NULL);
    if (legacy->light_count > 0) {
        text_json_begin_array(out, "lights");
        for (uint32_t i = 0; i < legacy->light_count; i++)
            write_light(&legacy->lights[i], out);
        text_json_end_array(out);
    }
    if (legacy->fog.mode != LEGACY_FOG_NONE) {
        text_json_begin_object(out, "fog");
        text_json_string(out, "mode", legacy_fog_names[legacy->fog.mode]);
        text_json_floats(out, "color", legacy->fog.color, 3);
        text_json_float(out, "scale", legacy->fog.scale);
        text_json_end_object(out);
    }
    text_json_string(out, "colors", legacy_color_names[legacy->colors]);
    text_json_string(out, "dialect", legacy_dialect_names[legacy->dialect]);
    if (legacy->is_rgl)
        text_json_bool(out, "rgl", true);
    text_json_end_object(out);
}

/* ---- merging: extras are well-formed JSON, as io keeps them ---- */

static const char *skip_space(const char *s)
{
    return s + strspn(s, " \t\r\n");
}

/* The position behind the string at s. */
static const char *skip_string(const char *s)
{
    for (s++; *s && *s != '"'; s++)
        s += *s == '\\' && s[1];
    return *s ? s + 1 : s;
}

/* The position behind the value at s: a comma or bracket outside of it. */
static const char *skip_value(const char *s)
{
    size_t depth = 0;
    for (; *s; s++) {
        if (*s == '"') {
            s = skip_string(s) - 1;
            continue;
        }
        if (depth == 0 && (*s == ',' || *s == '}' || *s == ']'))
            break;
        depth += *s == '{' || *s == '[';
        depth -= *s == '}' || *s == ']';
    }
    return s;
}

static const char MEMBER[] = "\"facet_legacy\"";

/* Copies the members of an object except MEMBER. True: there were some. */
static bool copy_members(const char *extras, text *out)
{
    bool has_any = false;
    const char *s = skip_space(extras + 1);
    while (*s == '"') {
        const char *key_end = skip_string(s);
        const char *colon = skip_space(key_end);
        const char *end = *colon == ':' ? skip_value(colon + 1) : colon;
        bool is_ours =
            (size_t)(key_end - s) == sizeof MEMBER - 1 && memcmp(s, MEMBER, sizeof MEMBER - 1) == 0;
        if (!is_ours) {
            if (has_any)
                text_add(out, ",");
            text_add_bytes(out, s, (size_t)(end - s));
            has_any = true;
        }
        s = skip_space(*end == ',' ? end + 1 : end);
    }
    return has_any;
}

void legacy_extras_merge(const char *extras, const char *object, text *out)
{
    const char *start = extras ? skip_space(extras) : "";
    bool is_object = *start == '{';
    bool has_others = false;
    text members = {.allocator = out->allocator};
    if (is_object) {
        has_others = copy_members(start, &members);
    } else if (*start && object) {
        text_add(&members, "\"extras\":");
        text_add(&members, start);
        has_others = true;
    }
    if (!object && *start && !is_object) {
        text_add(out, start);
    } else if (object || has_others) {
        text_add(out, "{");
        if (has_others && members.data)
            text_add(out, members.data);
        if (object) {
            text_add(out, has_others ? "," : "");
            text_add(out, MEMBER);
            text_add(out, ":");
            text_add(out, object);
        }
        text_add(out, "}");
    }
    out->has_failed = out->has_failed || members.has_failed;
    text_destroy(&members);
}
