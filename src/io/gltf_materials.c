/* gltf_materials.c - materials: the core model (glTF 2.0 section 3.9), and one function per extension. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "io/gltf_reader.h"

/* ---- textureInfo ---- */

static void read_transform(reader *r, const json_place *info, scene_texture_ref *out)
{
    json_place at = get_extension(r, info, "KHR_texture_transform");
    if (!at.value)
        return;
    get_floats(r, &at, "offset", out->offset, 2);
    get_floats(r, &at, "scale", out->scale, 2);
    out->rotation_rad = get_float(r, &at, "rotation", 0.0f);
    out->texcoord = (uint32_t)get_uint(r, &at, "texCoord", SCENE_NONE - 1, out->texcoord);
    scene_texture_ref_update(out);
}

/* The texture of a parameter; *info is its textureInfo, for members that come with it. */
static scene_texture_ref get_texture(reader *r, const json_place *object, const char *key)
{
    scene_texture_ref out = {.texture = SCENE_NONE, .scale = {1, 1}, .transform = {1, 0, 0, 0, 1, 0}};
    json_place at = get_object(r, object, key);
    if (!at.value)
        return out;
    out.texture = get_required_index(r, &at, "index", r->scene->texture_count, "texture");
    out.texcoord = (uint32_t)get_uint(r, &at, "texCoord", SCENE_NONE - 1, 0);
    read_transform(r, &at, &out);
    return out;
}

/* ---- extensions ---- */

static void read_unlit(reader *r, const json_place *at, scene_material *m)
{
    (void)r;
    (void)at;
    m->extensions |= SCENE_UNLIT;
}

static void read_emissive_strength(reader *r, const json_place *at, scene_material *m)
{
    m->extensions |= SCENE_EMISSIVE_STRENGTH;
    m->emissive_strength = get_float_in(r, at, "emissiveStrength", 0.0f, FLT_MAX, 1.0f);
}

static void read_ior(reader *r, const json_place *at, scene_material *m)
{
    m->ior = get_float(r, at, "ior", 1.5f);
    if (m->ior == 0.0f || m->ior >= 1.0f)
        return;
    reader_warn(r, at, "ior", "%g must be 0 or at least 1; 1 is used", (double)m->ior);
    m->ior = 1.0f;
}

static void read_specular(reader *r, const json_place *at, scene_material *m)
{
    m->specular = get_float_in(r, at, "specularFactor", 0.0f, 1.0f, 1.0f);
    get_floats_in(r, at, "specularColorFactor", 0.0f, FLT_MAX, m->specular_color, 3);
    m->textures[SCENE_SPECULAR_TEXTURE] = get_texture(r, at, "specularTexture");
    m->textures[SCENE_SPECULAR_COLOR_TEXTURE] = get_texture(r, at, "specularColorTexture");
}

/* A new material extension: its members in scene_material, a function here, a line in this table and one in
 * gltf_extensions.c. */
static const struct {
    const char *name;
    void (*read)(reader *r, const json_place *at, scene_material *m);
} EXTENSIONS[] = {
    {"KHR_materials_unlit", read_unlit},
    {"KHR_materials_emissive_strength", read_emissive_strength},
    {"KHR_materials_ior", read_ior},
    {"KHR_materials_specular", read_specular},
};

/* ---- the core ---- */

static void read_metallic_roughness(reader *r, const json_place *material, scene_material *m)
{
    json_place at = get_object(r, material, "pbrMetallicRoughness");
    get_floats_in(r, &at, "baseColorFactor", 0.0f, 1.0f, m->base_color, 4);
    m->metallic = get_float_in(r, &at, "metallicFactor", 0.0f, 1.0f, 1.0f);
    m->perceptual_roughness = get_float_in(r, &at, "roughnessFactor", 0.0f, 1.0f, 1.0f);
    m->textures[SCENE_BASE_COLOR_TEXTURE] = get_texture(r, &at, "baseColorTexture");
    m->textures[SCENE_METALLIC_ROUGHNESS_TEXTURE] = get_texture(r, &at, "metallicRoughnessTexture");
}

static scene_alpha_mode get_alpha_mode(reader *r, const json_place *at)
{
    const char *mode = get_string(r, at, "alphaMode", "OPAQUE");
    if (strcmp(mode, "MASK") == 0)
        return SCENE_ALPHA_MASK;
    if (strcmp(mode, "BLEND") == 0)
        return SCENE_ALPHA_BLEND;
    if (strcmp(mode, "OPAQUE") != 0)
        reader_warn(r, at, "alphaMode", "\"%.40s\" is none of OPAQUE, MASK, BLEND; OPAQUE is used", mode);
    return SCENE_ALPHA_OPAQUE;
}

static void read_material(reader *r, const json_place *at, scene_material *m)
{
    *m = scene_material_default();
    m->name = get_name(r, at);
    read_metallic_roughness(r, at, m);

    m->textures[SCENE_NORMAL_TEXTURE] = get_texture(r, at, "normalTexture");
    json_place normal = get_object(r, at, "normalTexture");
    m->normal_scale = get_float(r, &normal, "scale", 1.0f);
    m->textures[SCENE_OCCLUSION_TEXTURE] = get_texture(r, at, "occlusionTexture");
    json_place occlusion = get_object(r, at, "occlusionTexture");
    m->occlusion_strength = get_float_in(r, &occlusion, "strength", 0.0f, 1.0f, 1.0f);

    /* Factors above 1 were common before emissive_strength; all viewers draw them. */
    get_floats_in(r, at, "emissiveFactor", 0.0f, FLT_MAX, m->emissive, 3);
    for (int i = 0; i < 3; i++)
        if (m->emissive[i] > 1.0f)
            reader_warn(r, at, "emissiveFactor", "is above 1, which needs KHR_materials_emissive_strength");
    m->textures[SCENE_EMISSIVE_TEXTURE] = get_texture(r, at, "emissiveTexture");

    m->alpha_mode = get_alpha_mode(r, at);
    m->alpha_cutoff = get_float_in(r, at, "alphaCutoff", 0.0f, FLT_MAX, 0.5f);
    m->is_double_sided = get_bool(r, at, "doubleSided", false);
    for (size_t i = 0; i < sizeof EXTENSIONS / sizeof *EXTENSIONS; i++) {
        json_place extension = get_extension(r, at, EXTENSIONS[i].name);
        if (extension.value)
            EXTENSIONS[i].read(r, &extension, m);
    }
}

void read_materials(reader *r, const json_place *root)
{
    json_place array = get_array(r, root, "materials");
    size_t count = get_count(&array);
    r->scene->materials = reader_alloc(r, "materials", count, sizeof *r->scene->materials);
    for (size_t i = 0; i < count && reader_is_ok(r); i++) {
        json_place at = get_element_object(r, &array, i);
        read_material(r, &at, &r->scene->materials[i]);
        r->scene->material_count = (uint32_t)(i + 1);
    }
}
