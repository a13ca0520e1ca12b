/* gl_material_slots.c - see gl_material_slots.h. */
#include "gl/scene/gl_material_slots.h"

#include "gl/core/gl_program.h"

const gl_slot_pair gl_slot_pairs[GL_SLOT_PAIR_COUNT] = {
    {SCENE_METALLIC_ROUGHNESS_TEXTURE, SCENE_OCCLUSION_TEXTURE},
    {SCENE_SPECULAR_COLOR_TEXTURE, SCENE_SPECULAR_TEXTURE},
    {SCENE_CLEARCOAT_TEXTURE, SCENE_CLEARCOAT_ROUGHNESS_TEXTURE},
    {SCENE_NORMAL_TEXTURE, SCENE_CLEARCOAT_NORMAL_TEXTURE},
    {SCENE_SHEEN_COLOR_TEXTURE, SCENE_SHEEN_ROUGHNESS_TEXTURE},
    {SCENE_IRIDESCENCE_TEXTURE, SCENE_IRIDESCENCE_THICKNESS_TEXTURE},
    {SCENE_DIFFUSE_TRANSMISSION_COLOR_TEXTURE, SCENE_DIFFUSE_TRANSMISSION_TEXTURE}};

const uint8_t gl_slots_by_loss[SCENE_TEXTURE_SLOT_COUNT] = {SCENE_THICKNESS_TEXTURE,
                                                            SCENE_IRIDESCENCE_THICKNESS_TEXTURE,
                                                            SCENE_SPECULAR_TEXTURE,
                                                            SCENE_SPECULAR_COLOR_TEXTURE,
                                                            SCENE_SHEEN_ROUGHNESS_TEXTURE,
                                                            SCENE_CLEARCOAT_ROUGHNESS_TEXTURE,
                                                            SCENE_CLEARCOAT_NORMAL_TEXTURE,
                                                            SCENE_DIFFUSE_TRANSMISSION_COLOR_TEXTURE,
                                                            SCENE_IRIDESCENCE_TEXTURE,
                                                            SCENE_OCCLUSION_TEXTURE,
                                                            SCENE_SHEEN_COLOR_TEXTURE,
                                                            SCENE_CLEARCOAT_TEXTURE,
                                                            SCENE_ANISOTROPY_TEXTURE,
                                                            SCENE_DIFFUSE_TRANSMISSION_TEXTURE,
                                                            SCENE_TRANSMISSION_TEXTURE,
                                                            SCENE_EMISSIVE_TEXTURE,
                                                            SCENE_NORMAL_TEXTURE,
                                                            SCENE_METALLIC_ROUGHNESS_TEXTURE,
                                                            SCENE_SPECULAR_GLOSSINESS_TEXTURE,
                                                            SCENE_BASE_COLOR_TEXTURE};

static const char *const slot_names[SCENE_TEXTURE_SLOT_COUNT] = {
    [SCENE_BASE_COLOR_TEXTURE] = "BASE_COLOR",
    [SCENE_METALLIC_ROUGHNESS_TEXTURE] = "METALLIC_ROUGHNESS",
    [SCENE_NORMAL_TEXTURE] = "NORMAL",
    [SCENE_OCCLUSION_TEXTURE] = "OCCLUSION",
    [SCENE_EMISSIVE_TEXTURE] = "EMISSIVE",
    [SCENE_SPECULAR_TEXTURE] = "SPECULAR",
    [SCENE_SPECULAR_COLOR_TEXTURE] = "SPECULAR_COLOR",
    [SCENE_CLEARCOAT_TEXTURE] = "CLEARCOAT",
    [SCENE_CLEARCOAT_ROUGHNESS_TEXTURE] = "CLEARCOAT_ROUGHNESS",
    [SCENE_CLEARCOAT_NORMAL_TEXTURE] = "CLEARCOAT_NORMAL",
    [SCENE_SHEEN_COLOR_TEXTURE] = "SHEEN_COLOR",
    [SCENE_SHEEN_ROUGHNESS_TEXTURE] = "SHEEN_ROUGHNESS",
    [SCENE_TRANSMISSION_TEXTURE] = "TRANSMISSION",
    [SCENE_THICKNESS_TEXTURE] = "THICKNESS",
    [SCENE_IRIDESCENCE_TEXTURE] = "IRIDESCENCE",
    [SCENE_IRIDESCENCE_THICKNESS_TEXTURE] = "IRIDESCENCE_THICKNESS",
    [SCENE_ANISOTROPY_TEXTURE] = "ANISOTROPY",
    [SCENE_DIFFUSE_TRANSMISSION_TEXTURE] = "DIFFUSE_TRANSMISSION",
    [SCENE_DIFFUSE_TRANSMISSION_COLOR_TEXTURE] = "DIFFUSE_TRANSMISSION_COLOR",
    [SCENE_SPECULAR_GLOSSINESS_TEXTURE] = "SPECULAR_GLOSSINESS"};

static bool has(uint64_t features, int bit)
{
    return features >> bit & 1;
}

/* The slot whose texel it reads: itself, or that of a pair. */
static int source_of(uint64_t features, int slot)
{
    for (int i = 0; i < GL_SLOT_PAIR_COUNT; i++)
        if ((int)gl_slot_pairs[i].second == slot && has(features, GL_SURFACE_PAIRS + i))
            return (int)gl_slot_pairs[i].first;
    return slot;
}

int gl_material_slot_units(uint64_t features, int8_t units[SCENE_TEXTURE_SLOT_COUNT])
{
    int count = 0;
    for (int slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++) {
        units[slot] = -1;
        if (has(features, GL_SURFACE_TEXTURES + slot) && source_of(features, slot) == slot)
            units[slot] = (int8_t)count++;
    }
    return count;
}

void gl_material_slot_text(uint64_t features, text *out)
{
    int8_t units[SCENE_TEXTURE_SLOT_COUNT];
    int count = gl_material_slot_units(features, units);
    unsigned layers = (unsigned)(features >> GL_SURFACE_LAYERS) & ((1u << GL_SURFACE_LAYER_COUNT) - 1u);
    uint64_t by_layers = gl_program_feature(GL_MAIN_SURFACE, "HAS_CHANNEL") |
                         gl_program_feature(GL_MAIN_SURFACE, "HAS_SCHLICK_GGX");
    if (layers || features & by_layers)
        text_addf(out, "#define HAS_LAYERS\n#define MATERIAL_LAYERS %uu\n", layers);
    for (int i = 0; i < count; i++)
        text_addf(out, "uniform sampler2D u_material%d;\n", i);
    for (int slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++) {
        int source = source_of(features, slot);
        if (!has(features, GL_SURFACE_TEXTURES + slot))
            text_addf(out, "#define %s_TEXEL vec4(1.0)\n", slot_names[slot]);
        else if (source != slot)
            text_addf(out, "#define %s_TEXEL %s_TEXEL\n", slot_names[slot], slot_names[source]);
        else
            text_addf(out, "#define %s_TEXEL material_texel(u_material%d, %d)\n", slot_names[slot],
                      units[slot], slot);
    }
}
