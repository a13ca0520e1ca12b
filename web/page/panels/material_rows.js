// material_rows.js - the parameters of materials by their glTF names, with labels for people and the ranges of their sliders. Ranges of
// validity are facet's (src/scene/material_table.c); beyond the slider any number may be entered that facet takes.

const share = (key, label, usual) => ({ key, label, min: 0, max: 1, step: 0.01, limits: [0, 1], usual });
const open = (key, label, max, usual, min = 0) => ({ key, label, min, max, step: max > 10 ? 1 : 0.01, limits: [min, Infinity], usual });
const color = (key, label, usual, limit = 1) => ({ key, label, isColor: true, limits: [0, limit], usual });

// fact: the member of facet inspect's material, where it is not the extension's object with glTF's names.
export const GROUPS = [
  { title: 'Base', object: 'pbrMetallicRoughness', rows: [
    { ...color('baseColorFactor', 'Base color', [1, 1, 1, 1]), fact: 'base_color' },
    { ...share('metallicFactor', 'Metallic', 1), fact: 'metallic' },
    { ...share('roughnessFactor', 'Roughness', 1), fact: 'roughness' },
  ], textures: [['base_color_texture', 'Base color'], ['metallic_roughness_texture', 'Metallic, roughness']] },
  { title: 'Surface', object: '', rows: [
    { key: 'scale', texture: 'normalTexture', fact: 'normal_scale', label: 'Normal scale', min: -2, max: 2, step: 0.01, limits: [-Infinity, Infinity], usual: 1, needs: 'normal_texture' },
    { ...share('strength', 'Occlusion', 1), texture: 'occlusionTexture', fact: 'occlusion_strength', needs: 'occlusion_texture' },
    { ...color('emissiveFactor', 'Emission', [0, 0, 0], Infinity), fact: 'emissive', by: 'emissiveStrength' },
  ], textures: [['normal_texture', 'Normal'], ['occlusion_texture', 'Occlusion'], ['emissive_texture', 'Emission']] },
  extension('KHR_materials_emissive_strength', 'Emissive strength', [open('emissiveStrength', 'Strength', 20, 1)]),
  extension('KHR_materials_ior', 'Index of refraction', [open('ior', 'Index', 3, 1.5, 1)]),
  extension('KHR_materials_specular', 'Specular', [share('specularFactor', 'Strength', 1), color('specularColorFactor', 'Color', [1, 1, 1], Infinity)],
    [['specularTexture', 'Strength'], ['specularColorTexture', 'Color']]),
  extension('KHR_materials_clearcoat', 'Clear coat', [
    { ...share('clearcoatFactor', 'Strength', 0), first: 1 }, share('clearcoatRoughnessFactor', 'Roughness', 0),
    { key: 'scale', texture: 'clearcoatNormalTexture', fact: 'normal_scale', label: 'Normal scale', min: -2, max: 2, step: 0.01, limits: [-Infinity, Infinity], usual: 1, needs: 'clearcoatNormalTexture' }],
  [['clearcoatTexture', 'Strength'], ['clearcoatRoughnessTexture', 'Roughness'], ['clearcoatNormalTexture', 'Normal']]),
  extension('KHR_materials_sheen', 'Sheen', [{ ...color('sheenColorFactor', 'Color', [0, 0, 0]), first: [1, 1, 1] }, { ...share('sheenRoughnessFactor', 'Roughness', 0), first: 0.5 }],
    [['sheenColorTexture', 'Color'], ['sheenRoughnessTexture', 'Roughness']]),
  extension('KHR_materials_transmission', 'Transmission', [{ ...share('transmissionFactor', 'Share', 0), first: 1 }], [['transmissionTexture', 'Share']]),
  extension('KHR_materials_volume', 'Volume', [{ ...open('thicknessFactor', 'Thickness, m', 1, 0), first: 0.1 },
    { ...open('attenuationDistance', 'Distance, m', 10, null), first: 1 }, color('attenuationColor', 'Color', [1, 1, 1])], [['thicknessTexture', 'Thickness']]),
  extension('KHR_materials_volume_scatter', 'Scattering', [{ ...color('multiscatterColor', 'Color', [0, 0, 0]), first: [0.8, 0.8, 0.8] },
    { key: 'scatterAnisotropy', label: 'Anisotropy', min: -1, max: 1, step: 0.01, limits: [-1, 1], usual: 0 }]),
  extension('KHR_materials_iridescence', 'Iridescence', [{ ...share('iridescenceFactor', 'Strength', 0), first: 1 }, open('iridescenceIor', 'Index', 3, 1.3, 1),
    open('iridescenceThicknessMinimum', 'Thinnest, nm', 1200, 100), open('iridescenceThicknessMaximum', 'Thickest, nm', 1200, 400)],
  [['iridescenceTexture', 'Strength'], ['iridescenceThicknessTexture', 'Thickness']]),
  extension('KHR_materials_anisotropy', 'Anisotropy', [{ ...share('anisotropyStrength', 'Strength', 0), first: 0.7 },
    { key: 'anisotropyRotation', label: 'Rotation, rad', min: 0, max: 6.28, step: 0.01, limits: [-Infinity, Infinity], usual: 0 }], [['anisotropyTexture', 'Direction, strength']]),
  extension('KHR_materials_dispersion', 'Dispersion', [{ ...open('dispersion', '20 / Abbe number', 2, 0), first: 0.5 }]),
  extension('KHR_materials_diffuse_transmission', 'Diffuse transmission', [{ ...share('diffuseTransmissionFactor', 'Share', 0), first: 0.5 },
    color('diffuseTransmissionColorFactor', 'Color', [1, 1, 1])], [['diffuseTransmissionTexture', 'Share'], ['diffuseTransmissionColorTexture', 'Color']]),
  extension('KHR_materials_diffuse_roughness', 'Diffuse roughness', [{ ...share('diffuseRoughnessFactor', 'Roughness', 0), first: 1 }], [['diffuseRoughnessTexture', 'Roughness']]),
  extension('KHR_materials_pbrSpecularGlossiness', 'Specular and glossiness', [color('diffuseFactor', 'Diffuse', [1, 1, 1, 1]), color('specularFactor', 'Specular', [1, 1, 1]),
    share('glossinessFactor', 'Glossiness', 1)], [['specularGlossinessTexture', 'Specular, glossiness']]),
];

function extension(object, title, rows, textures = []) {
  return { title, object, rows, textures, isExtension: true };
}

// The extensions that a material can get here: the others change its whole model, or are set elsewhere.
export const canBeAdded = ({ isExtension, object }) => isExtension && object !== 'KHR_materials_pbrSpecularGlossiness';

// The name of a parameter in links and edits: unique among all groups.
export function nameOfRow(group, row) {
  if (row.texture) return `${row.texture}.${row.key}`;
  return group.object === 'KHR_materials_pbrSpecularGlossiness' && row.key === 'specularFactor' ? 'pbrSpecularGlossiness.specularFactor' : row.key;
}

export function findRow(name) {
  for (const group of GROUPS)
    for (const row of group.rows) if (nameOfRow(group, row) === name) return { group, row };
  return null;
}

// The part of a glTF material that says only this value.
export function materialPart(group, row, value) {
  const inner = row.texture ? { [row.texture]: { [row.key]: value } } : { [row.key]: value };
  if (group.isExtension) return { extensions: { [group.object]: inner } };
  return group.object ? { [group.object]: inner } : inner;
}

// The value in the material of facet inspect; undefined: the material has no such layer.
export function valueIn(material, group, row) {
  const own = group.isExtension ? material.extensions[group.object] : material;
  if (!own) return undefined;
  const value = own[row.fact ?? row.key];
  const factor = row.by && material.extensions.KHR_materials_emissive_strength?.[row.by];
  return factor ? value.map((x) => x / factor) : value;
}
