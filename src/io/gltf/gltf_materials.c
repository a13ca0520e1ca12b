/* gltf_materials.c - materials: the parameters and textures of scene/material_table.h, and rules beyond
 * the ranges of that table (glTF 2.0 section 3.9 and the extensions of materials). */
#include <math.h>
#include <string.h>

#include "io/gltf/gltf_reader.h"
#include "scene/material_table.h"

/* ---- textureInfo ---- */

static void read_transform(io_reader *r, const json_place *info, scene_texture_ref *out)
{
    json_place at = io_get_extension(r, info, "KHR_texture_transform");
    if (!at.value)
        return;
    io_get_floats(r, &at, "offset", out->offset, 2);
    io_get_floats(r, &at, "scale", out->scale, 2);
    out->rotation_rad = io_get_float(r, &at, "rotation", 0.0f);
    out->texcoord = (uint32_t)io_get_uint(r, &at, "texCoord", SCENE_NONE - 1, out->texcoord);
    scene_texture_ref_update(out);
}

static void read_texture(io_reader *r, const json_place *object, const char *key, scene_texture_ref *out)
{
    json_place at = io_get_object(r, object, key);
    if (!at.value)
        return;
    if (out->texture == SCENE_NONE || json_object_get(at.value, "index"))
        out->texture = io_get_required_index(r, &at, "index", r->scene->texture_count, "texture");
    out->texcoord = (uint32_t)io_get_uint(r, &at, "texCoord", SCENE_NONE - 1, out->texcoord);
    read_transform(r, &at, out);
}

/* ---- rows of the table ---- */

/* The object of a material that a row of the table names. */
static json_place get_row_object(io_reader *r, const json_place *material, uint32_t extension,
                                 const char *object)
{
    return extension ? io_get_extension(r, material, object)
           : *object ? io_get_object(r, material, object)
                     : *material;
}

static void read_parameter(io_reader *r, const json_place *material, const material_parameter *row,
                           scene_material *m)
{
    json_place object = get_row_object(r, material, row->extension, row->object);
    json_place at = row->texture ? io_get_object(r, &object, row->texture) : object;
    float *out = material_floats(m, row);
    if (row->count > 1)
        io_get_floats_in(r, &at, row->key, row->minimum, row->maximum, out, row->count);
    else
        *out = io_get_float_in(r, &at, row->key, row->minimum, row->maximum, *out);
}

/* Reads the rows of one extension (0: of the core). */
static void read_rows(io_reader *r, const json_place *material, uint32_t extension, scene_material *m)
{
    for (size_t i = 0; i < MATERIAL_PARAMETER_COUNT; i++)
        if (material_parameters[i].extension == extension)
            read_parameter(r, material, &material_parameters[i], m);
    for (size_t i = 0; i < SCENE_TEXTURE_SLOT_COUNT; i++) {
        const material_texture *row = &material_textures[i];
        if (row->extension != extension)
            continue;
        json_place object = get_row_object(r, material, extension, row->object);
        read_texture(r, &object, row->key, &m->textures[i]);
    }
}

/* ---- rules of single extensions ---- */

static void check_ior(io_reader *r, const json_place *at, scene_material *m)
{
    if (m->ior == 0.0f || m->ior >= 1.0f)
        return;
    io_warn(r, at, "ior", "%g must be 0 or at least 1; 1 is used", (double)m->ior);
    m->ior = 1.0f;
}

static void check_volume(io_reader *r, const json_place *at, scene_material *m)
{
    if (m->attenuation_distance > 0.0f)
        return;
    io_warn(r, at, "attenuationDistance", "must be above 0; it is taken as infinite");
    m->attenuation_distance = INFINITY;
}

/* At -1 and 1 the phase function is a delta. */
static void check_volume_scatter(io_reader *r, const json_place *at, scene_material *m)
{
    const float most = 0.999f;
    if (fabsf(m->scatter_anisotropy) < 1.0f)
        return;
    io_warn(r, at, "scatterAnisotropy", "must be between -1 and 1; %g is used",
            (double)copysignf(most, m->scatter_anisotropy));
    m->scatter_anisotropy = copysignf(most, m->scatter_anisotropy);
}

/* The extension replaces metallic-roughness, which such files have as a fallback and which is discarded
 * here. */
static void take_specular_glossiness(io_reader *r, const json_place *at, scene_material *m)
{
    static const scene_texture_slot core[] = {SCENE_BASE_COLOR_TEXTURE, SCENE_METALLIC_ROUGHNESS_TEXTURE};
    const scene_material defaults = scene_material_default();
    memcpy(m->base_color, defaults.base_color, sizeof m->base_color);
    m->metallic = defaults.metallic;
    m->perceptual_roughness = defaults.perceptual_roughness;
    for (size_t i = 0; i < sizeof core / sizeof *core; i++)
        m->textures[core[i]] = defaults.textures[core[i]];
    read_texture(r, at, "diffuseTexture", &m->textures[SCENE_BASE_COLOR_TEXTURE]);
}

static const struct {
    uint32_t bit;
    void (*apply)(io_reader *r, const json_place *at,
                  scene_material *m); /* before or after its rows are read */
    bool is_before;
} RULES[] = {
    {SCENE_IOR, check_ior, false},
    {SCENE_VOLUME, check_volume, false},
    {SCENE_VOLUME_SCATTER, check_volume_scatter, false},
    {SCENE_SPECULAR_GLOSSINESS, take_specular_glossiness, true},
};

static void apply_rules(io_reader *r, const json_place *at, uint32_t bit, bool is_before, scene_material *m)
{
    for (size_t i = 0; i < sizeof RULES / sizeof *RULES; i++)
        if (RULES[i].bit == bit && RULES[i].is_before == is_before)
            RULES[i].apply(r, at, m);
}

/* ---- which extensions count ---- */

/* Removes the extensions of bits, which `winner` excludes, with a warning for each. */
static uint32_t exclude(io_reader *r, const json_place *material, uint32_t bits, uint32_t winner,
                        uint32_t others, const char *winner_name)
{
    if (!(bits & winner))
        return bits;
    for (size_t i = 0; i < MATERIAL_EXTENSION_COUNT; i++)
        if (bits & others & material_extensions[i].bit)
            io_note(r, material, NULL, "has %s, which excludes %s; the latter is ignored", winner_name,
                    material_extensions[i].name);
    return bits & ~others;
}

/* Unlit excludes all other reflection models, pbrSpecularGlossiness all extensions of metallic-roughness;
 * emission is independent of the latter. */
static uint32_t exclude_others(io_reader *r, const json_place *material, uint32_t bits)
{
    bits = exclude(r, material, bits, SCENE_UNLIT, ~(uint32_t)SCENE_UNLIT, "KHR_materials_unlit");
    return exclude(r, material, bits, SCENE_SPECULAR_GLOSSINESS,
                   ~(uint32_t)(SCENE_SPECULAR_GLOSSINESS | SCENE_EMISSIVE_STRENGTH),
                   "KHR_materials_pbrSpecularGlossiness");
}

static uint32_t find_extensions(io_reader *r, const json_place *material)
{
    uint32_t bits = 0;
    for (size_t i = 0; i < MATERIAL_EXTENSION_COUNT; i++)
        if (io_get_extension(r, material, material_extensions[i].name).value)
            bits |= material_extensions[i].bit;
    return exclude_others(r, material, bits);
}

/* ---- materials ---- */

static scene_alpha_mode get_alpha_mode(io_reader *r, const json_place *at, scene_alpha_mode otherwise)
{
    const char *mode = io_get_string(r, at, "alphaMode", NULL);
    if (!mode)
        return otherwise;
    if (strcmp(mode, "MASK") == 0)
        return SCENE_ALPHA_MASK;
    if (strcmp(mode, "BLEND") == 0)
        return SCENE_ALPHA_BLEND;
    if (strcmp(mode, "OPAQUE") != 0)
        io_warn(r, at, "alphaMode", "\"%.40s\" is not one of OPAQUE, MASK, BLEND; OPAQUE is used", mode);
    return SCENE_ALPHA_OPAQUE;
}

void gltf_read_material_members(io_reader *r, const json_place *at, scene_material *m)
{
    m->alpha_mode = get_alpha_mode(r, at, m->alpha_mode);
    m->is_double_sided = io_get_bool(r, at, "doubleSided", m->is_double_sided);
    uint32_t before = m->extensions, there = find_extensions(r, at);
    read_rows(r, at, 0, m);
    /* Factors above 1 were common before emissive_strength, and all viewers draw them. */
    for (int i = 0; i < 3; i++)
        if (m->emissive[i] > 1.0f)
            io_note(r, at, "emissiveFactor", "is above 1, which needs KHR_materials_emissive_strength");
    for (size_t i = 0; i < MATERIAL_EXTENSION_COUNT; i++) {
        uint32_t bit = material_extensions[i].bit;
        if (!(there & bit))
            continue;
        json_place extension = io_get_extension(r, at, material_extensions[i].name);
        if (!(before & bit))
            apply_rules(r, &extension, bit, true, m);
        read_rows(r, at, bit, m);
        apply_rules(r, &extension, bit, false, m);
    }
    m->extensions = before ? exclude_others(r, at, before | there) : there;
}

void gltf_read_material(io_reader *r, const json_place *at, scene_material *m)
{
    *m = scene_material_default();
    m->name = io_get_name(r, at);
    gltf_read_material_members(r, at, m);
    m->meta = gltf_get_meta(r, at);
}

void gltf_read_materials(io_reader *r, const json_place *root)
{
    json_place array = io_get_array(r, root, "materials");
    size_t count = io_get_count(&array);
    r->scene->materials = io_alloc(r, "materials", count, sizeof *r->scene->materials);
    r->gltf->material_problems = io_alloc(r, "materials", count, sizeof *r->gltf->material_problems);
    for (size_t i = 0; i < count && io_is_ok(r); i++) {
        json_place at = io_get_element_object(r, &array, i);
        scene_material *m = &r->scene->materials[i];
        gltf_read_material(r, &at, m);
        if (io_defer(r, &r->gltf->material_problems[i])) {
            const char *name = m->name;
            *m = scene_material_default();
            m->name = name;
        }
        r->scene->material_count = (uint32_t)(i + 1);
    }
}
