/* material_table.c - see material_table.h. Ranges are those of the glTF 2.0 specification (section 3.9)
 * and of each extension, except that factors of emissiveFactor above 1 were common before
 * KHR_materials_emissive_strength. */
#include "scene/material_table.h"

#include <float.h>

#define MANY FLT_MAX
#define AT(member) offsetof(scene_material, member)

static const char ROOT[] = "";
static const char CORE[] = "pbrMetallicRoughness";
static const char ANISOTROPY[] = "KHR_materials_anisotropy";
static const char CLEARCOAT[] = "KHR_materials_clearcoat";
static const char DIFFUSE_ROUGHNESS[] = "KHR_materials_diffuse_roughness";
static const char DIFFUSE_TRANSMISSION[] = "KHR_materials_diffuse_transmission";
static const char DISPERSION[] = "KHR_materials_dispersion";
static const char EMISSIVE_STRENGTH[] = "KHR_materials_emissive_strength";
static const char IOR[] = "KHR_materials_ior";
static const char IRIDESCENCE[] = "KHR_materials_iridescence";
static const char SHEEN[] = "KHR_materials_sheen";
static const char SPECULAR[] = "KHR_materials_specular";
static const char SPECULAR_GLOSSINESS[] = "KHR_materials_pbrSpecularGlossiness";
static const char TRANSMISSION[] = "KHR_materials_transmission";
static const char UNLIT[] = "KHR_materials_unlit";
static const char VOLUME[] = "KHR_materials_volume";
static const char VOLUME_SCATTER[] = "KHR_materials_volume_scatter";

/* base_color and specular_color have a row for metallic-roughness and one for specular-glossiness: a
 * material has one of the two. */
const material_parameter material_parameters[MATERIAL_PARAMETER_COUNT] = {
    {0, CORE, NULL, "baseColorFactor", AT(base_color), 4, 0, 1},
    {0, CORE, NULL, "metallicFactor", AT(metallic), 1, 0, 1},
    {0, CORE, NULL, "roughnessFactor", AT(perceptual_roughness), 1, 0, 1},
    {0, ROOT, "normalTexture", "scale", AT(normal_scale), 1, -MANY, MANY},
    {0, ROOT, "occlusionTexture", "strength", AT(occlusion_strength), 1, 0, 1},
    {0, ROOT, NULL, "emissiveFactor", AT(emissive), 3, 0, MANY},
    {0, ROOT, NULL, "alphaCutoff", AT(alpha_cutoff), 1, 0, MANY},
    {SCENE_EMISSIVE_STRENGTH, EMISSIVE_STRENGTH, NULL, "emissiveStrength", AT(emissive_strength), 1, 0, MANY},
    {SCENE_IOR, IOR, NULL, "ior", AT(ior), 1, 0, MANY},
    {SCENE_SPECULAR, SPECULAR, NULL, "specularFactor", AT(specular), 1, 0, 1},
    {SCENE_SPECULAR, SPECULAR, NULL, "specularColorFactor", AT(specular_color), 3, 0, MANY},
    {SCENE_CLEARCOAT, CLEARCOAT, NULL, "clearcoatFactor", AT(clearcoat), 1, 0, 1},
    {SCENE_CLEARCOAT, CLEARCOAT, NULL, "clearcoatRoughnessFactor", AT(clearcoat_roughness), 1, 0, 1},
    {SCENE_CLEARCOAT, CLEARCOAT, "clearcoatNormalTexture", "scale", AT(clearcoat_normal_scale), 1, -MANY,
     MANY},
    {SCENE_SHEEN, SHEEN, NULL, "sheenColorFactor", AT(sheen_color), 3, 0, 1},
    {SCENE_SHEEN, SHEEN, NULL, "sheenRoughnessFactor", AT(sheen_roughness), 1, 0, 1},
    {SCENE_TRANSMISSION, TRANSMISSION, NULL, "transmissionFactor", AT(transmission), 1, 0, 1},
    {SCENE_VOLUME, VOLUME, NULL, "thicknessFactor", AT(thickness), 1, 0, MANY},
    {SCENE_VOLUME, VOLUME, NULL, "attenuationDistance", AT(attenuation_distance), 1, 0, MANY},
    {SCENE_VOLUME, VOLUME, NULL, "attenuationColor", AT(attenuation_color), 3, 0, 1},
    {SCENE_IRIDESCENCE, IRIDESCENCE, NULL, "iridescenceFactor", AT(iridescence), 1, 0, 1},
    {SCENE_IRIDESCENCE, IRIDESCENCE, NULL, "iridescenceIor", AT(iridescence_ior), 1, 1, MANY},
    {SCENE_IRIDESCENCE, IRIDESCENCE, NULL, "iridescenceThicknessMinimum", AT(iridescence_thickness_minimum),
     1, 0, MANY},
    {SCENE_IRIDESCENCE, IRIDESCENCE, NULL, "iridescenceThicknessMaximum", AT(iridescence_thickness_maximum),
     1, 0, MANY},
    {SCENE_ANISOTROPY, ANISOTROPY, NULL, "anisotropyStrength", AT(anisotropy), 1, 0, 1},
    {SCENE_ANISOTROPY, ANISOTROPY, NULL, "anisotropyRotation", AT(anisotropy_rotation), 1, -MANY, MANY},
    {SCENE_DISPERSION, DISPERSION, NULL, "dispersion", AT(dispersion), 1, 0, MANY},
    {SCENE_DIFFUSE_TRANSMISSION, DIFFUSE_TRANSMISSION, NULL, "diffuseTransmissionFactor",
     AT(diffuse_transmission), 1, 0, 1},
    {SCENE_DIFFUSE_TRANSMISSION, DIFFUSE_TRANSMISSION, NULL, "diffuseTransmissionColorFactor",
     AT(diffuse_transmission_color), 3, 0, 1},
    {SCENE_VOLUME_SCATTER, VOLUME_SCATTER, NULL, "multiscatterColor", AT(multiscatter_color), 3, 0, 1},
    {SCENE_VOLUME_SCATTER, VOLUME_SCATTER, NULL, "scatterAnisotropy", AT(scatter_anisotropy), 1, -1, 1},
    {SCENE_SPECULAR_GLOSSINESS, SPECULAR_GLOSSINESS, NULL, "diffuseFactor", AT(base_color), 4, 0, 1},
    {SCENE_SPECULAR_GLOSSINESS, SPECULAR_GLOSSINESS, NULL, "specularFactor", AT(specular_color), 3, 0, 1},
    {SCENE_SPECULAR_GLOSSINESS, SPECULAR_GLOSSINESS, NULL, "glossinessFactor", AT(glossiness), 1, 0, 1},
    {SCENE_DIFFUSE_ROUGHNESS, DIFFUSE_ROUGHNESS, NULL, "diffuseRoughnessFactor", AT(diffuse_roughness), 1, 0,
     1},
};

const material_texture material_textures[SCENE_TEXTURE_SLOT_COUNT] = {
    [SCENE_BASE_COLOR_TEXTURE] = {0, CORE, "baseColorTexture", true},
    [SCENE_METALLIC_ROUGHNESS_TEXTURE] = {0, CORE, "metallicRoughnessTexture", false},
    [SCENE_NORMAL_TEXTURE] = {0, ROOT, "normalTexture", false},
    [SCENE_OCCLUSION_TEXTURE] = {0, ROOT, "occlusionTexture", false},
    [SCENE_EMISSIVE_TEXTURE] = {0, ROOT, "emissiveTexture", true},
    [SCENE_SPECULAR_TEXTURE] = {SCENE_SPECULAR, SPECULAR, "specularTexture", false},
    [SCENE_SPECULAR_COLOR_TEXTURE] = {SCENE_SPECULAR, SPECULAR, "specularColorTexture", true},
    [SCENE_CLEARCOAT_TEXTURE] = {SCENE_CLEARCOAT, CLEARCOAT, "clearcoatTexture", false},
    [SCENE_CLEARCOAT_ROUGHNESS_TEXTURE] = {SCENE_CLEARCOAT, CLEARCOAT, "clearcoatRoughnessTexture", false},
    [SCENE_CLEARCOAT_NORMAL_TEXTURE] = {SCENE_CLEARCOAT, CLEARCOAT, "clearcoatNormalTexture", false},
    [SCENE_SHEEN_COLOR_TEXTURE] = {SCENE_SHEEN, SHEEN, "sheenColorTexture", true},
    [SCENE_SHEEN_ROUGHNESS_TEXTURE] = {SCENE_SHEEN, SHEEN, "sheenRoughnessTexture", false},
    [SCENE_TRANSMISSION_TEXTURE] = {SCENE_TRANSMISSION, TRANSMISSION, "transmissionTexture", false},
    [SCENE_THICKNESS_TEXTURE] = {SCENE_VOLUME, VOLUME, "thicknessTexture", false},
    [SCENE_IRIDESCENCE_TEXTURE] = {SCENE_IRIDESCENCE, IRIDESCENCE, "iridescenceTexture", false},
    [SCENE_IRIDESCENCE_THICKNESS_TEXTURE] = {SCENE_IRIDESCENCE, IRIDESCENCE, "iridescenceThicknessTexture",
                                             false},
    [SCENE_ANISOTROPY_TEXTURE] = {SCENE_ANISOTROPY, ANISOTROPY, "anisotropyTexture", false},
    [SCENE_DIFFUSE_TRANSMISSION_TEXTURE] = {SCENE_DIFFUSE_TRANSMISSION, DIFFUSE_TRANSMISSION,
                                            "diffuseTransmissionTexture", false},
    [SCENE_DIFFUSE_TRANSMISSION_COLOR_TEXTURE] = {SCENE_DIFFUSE_TRANSMISSION, DIFFUSE_TRANSMISSION,
                                                  "diffuseTransmissionColorTexture", true},
    [SCENE_SPECULAR_GLOSSINESS_TEXTURE] = {SCENE_SPECULAR_GLOSSINESS, SPECULAR_GLOSSINESS,
                                           "specularGlossinessTexture", true},
    [SCENE_DIFFUSE_ROUGHNESS_TEXTURE] = {SCENE_DIFFUSE_ROUGHNESS, DIFFUSE_ROUGHNESS,
                                         "diffuseRoughnessTexture", false},
};

const material_extension material_extensions[MATERIAL_EXTENSION_COUNT] = {
    {SCENE_UNLIT, UNLIT},
    {SCENE_EMISSIVE_STRENGTH, EMISSIVE_STRENGTH},
    {SCENE_IOR, IOR},
    {SCENE_SPECULAR, SPECULAR},
    {SCENE_CLEARCOAT, CLEARCOAT},
    {SCENE_SHEEN, SHEEN},
    {SCENE_TRANSMISSION, TRANSMISSION},
    {SCENE_VOLUME, VOLUME},
    {SCENE_IRIDESCENCE, IRIDESCENCE},
    {SCENE_ANISOTROPY, ANISOTROPY},
    {SCENE_DISPERSION, DISPERSION},
    {SCENE_DIFFUSE_TRANSMISSION, DIFFUSE_TRANSMISSION},
    {SCENE_VOLUME_SCATTER, VOLUME_SCATTER},
    {SCENE_SPECULAR_GLOSSINESS, SPECULAR_GLOSSINESS},
    {SCENE_DIFFUSE_ROUGHNESS, DIFFUSE_ROUGHNESS},
};
