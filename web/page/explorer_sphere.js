// explorer_sphere.js - a sphere of the explorer's material, drawn by <facet-viewer>, which is fetched when it is first wanted.
import { element } from './fields.js';

const ROWS = 32;
const COLUMNS = 64;

// A sphere of radius 1 as an OBJ file with texture coordinates, whose directions anisotropy follows.
function sphereText() {
  const lines = ['mtllib sphere.mtl', 'usemtl sphere'];
  const at = (row, column) => row * (COLUMNS + 1) + column + 1;
  for (let row = 0; row <= ROWS; row++) {
    for (let column = 0; column <= COLUMNS; column++) {
      const [polar, azimuth] = [(Math.PI * row) / ROWS, (2 * Math.PI * column) / COLUMNS];
      const point = [Math.sin(polar) * Math.sin(azimuth), Math.cos(polar), Math.sin(polar) * Math.cos(azimuth)].map((value) => value.toFixed(6)).join(' ');
      lines.push(`v ${point}`, `vn ${point}`, `vt ${column / COLUMNS} ${1 - row / ROWS}`);
    }
  }
  const corner = (index) => `${index}/${index}/${index}`;
  for (let row = 0; row < ROWS; row++) {
    for (let column = 0; column < COLUMNS; column++) {
      const [a, b, c, d] = [at(row, column), at(row + 1, column), at(row + 1, column + 1), at(row, column + 1)].map(corner);
      if (row < ROWS - 1) lines.push(`f ${a} ${b} ${c}`);
      if (row > 0) lines.push(`f ${a} ${c} ${d}`);
    }
  }
  return lines.join('\n');
}

// A color of the screen in linear light, converted by the browser; null: it cannot.
function linearOf(hex) {
  const probe = element('span', { hidden: true });
  probe.style.color = `color(from ${hex} srgb-linear r g b)`;
  document.body.append(probe);
  const numbers = getComputedStyle(probe).color.match(/srgb-linear ([-\d.e]+) ([-\d.e]+) ([-\d.e]+)/);
  probe.remove();
  return numbers ? numbers.slice(1).map(Number) : null;
}

// The parameters of facet plot as a glTF material.
function materialOf(values) {
  const base = linearOf(values.color) ?? [1, 1, 1];
  return {
    pbrMetallicRoughness: { baseColorFactor: [...base, 1], metallicFactor: values.metallic, roughnessFactor: values.roughness },
    extensions: {
      KHR_materials_ior: { ior: values.ior },
      KHR_materials_specular: { specularFactor: values.specular, specularColorFactor: linearOf(values['specular-color']) ?? [1, 1, 1] },
      KHR_materials_clearcoat: { clearcoatFactor: values.clearcoat, clearcoatRoughnessFactor: values['clearcoat-roughness'] },
      KHR_materials_sheen: { sheenColorFactor: linearOf(values['sheen-color']) ?? [0, 0, 0], sheenRoughnessFactor: values['sheen-roughness'] },
      KHR_materials_diffuse_roughness: { diffuseRoughnessFactor: values['diffuse-roughness'] },
      KHR_materials_anisotropy: { anisotropyStrength: values.anisotropy, anisotropyRotation: (values['anisotropy-rotation'] * Math.PI) / 180 },
      KHR_materials_iridescence: { iridescenceFactor: values.iridescence, iridescenceIor: values['iridescence-ior'], iridescenceThicknessMaximum: values['iridescence-thickness'] },
    },
  };
}

// The viewer in place; update(values) changes its material.
export async function createSphere(place) {
  await import('./facet-viewer/facet-viewer.js');
  const viewer = element('facet-viewer', { 'camera-controls': true, 'interaction-prompt': 'none', loading: 'eager', 'field-of-view': '20deg', alt: 'A sphere of this material' });
  place.replaceChildren(viewer);
  await viewer.openFiles([
    { path: 'sphere.obj', file: new Blob([sphereText()]) },
    { path: 'sphere.mtl', file: new Blob(['newmtl sphere\nKd 1 1 1\nPr 0.5\nPm 0\n']) },
  ]);
  return { viewer, update: (values) => viewer.setMaterial(0, materialOf(values)) };
}
