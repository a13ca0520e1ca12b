// analysis.js - looking into the image: single channels and lobes, two versions side by side, formulas and orders of blending.
import { check, choice, element, section } from '../fields.js';

const CHANNELS = [
  ['light', 'All light'],
  { label: 'Light of one lobe', options: [['diffuse', 'Diffuse'], ['specular', 'Specular'], ['clearcoat', 'Clear coat'], ['sheen', 'Sheen'],
    ['transmission', 'Transmission'], ['emission', 'Emission']] },
  { label: 'Material', options: [['base-color', 'Base color'], ['roughness', 'Roughness'], ['metallic', 'Metallic'], ['occlusion', 'Occlusion'],
    ['opacity', 'Opacity']] },
  { label: 'Geometry', options: [['normal', 'Normal'], ['ndotv', 'Cosine of the view angle']] },
  { label: 'Energy', options: [['furnace', 'White furnace']] },
];
const COMPARISONS = [
  ['', 'Nothing'], ['masking', 'Schlick-GGX | Smith masking'], ['scattering', 'Single | multiple scattering'],
  ['tone-mapping', 'No | chosen tone mapping'], ['variant', 'File’s materials | variant'],
];

const usual = (value, common) => (value === common ? null : value);

export function analysisPanel(app) {
  const channel = choice({ label: 'Show', options: CHANNELS, change: (name) => app.set('channel', usual(name, 'light')) });
  const compare = choice({ label: 'Compare', options: COMPARISONS, change: (name) => app.set('compare', name || null) });
  const brdf = choice({ label: 'Specular lobe', options: [['energy', 'Default'], ['schlick-ggx', 'Schlick-GGX masking'], ['multiscatter', 'Multiple scattering']],
    change: (name) => app.set('brdf', usual(name, 'energy')) });
  const energy = choice({ label: 'Energy', options: [['conserving', 'Conserving'], ['gltf', 'As Khronos’ renderer']], change: (name) => app.set('energy', usual(name, 'conserving')) });
  const transparency = choice({ label: 'Blending', options: [['sorted', 'Sorted triangles'], ['peeled', 'Depth peeling (exact)'], ['weighted', 'Weighted (fast)']],
    change: (name) => app.set('transparency', usual(name, 'sorted')) });
  const isSmooth = check({ label: 'Specular antialiasing', change: (is) => app.setFlag('specular-aa', is) });
  const shading = choice({ label: 'Shading', options: [['gltf', 'Physically based'], ['ogl1', 'OpenGL 1']], change: (name) => app.set('shading', usual(name, 'gltf')) });
  const views = section('Channels and comparison', false, channel.root, compare.root,
    element('p', { class: 'hint' }, 'Drag the border between the two sides.'));
  const methods = section('Rendering', false, energy.root, brdf.root, transparency.root, shading.root, isSmooth.root);
  const hint = views.body.querySelector('.hint');
  return {
    root: element('div', {}, views.root, methods.root),
    update(options) {
      channel.value = options.channel ?? 'light';
      compare.value = options.compare ?? '';
      hint.hidden = !compare.value;
      brdf.value = options.brdf ?? 'energy';
      energy.value = options.energy ?? 'conserving';
      transparency.value = options.transparency ?? 'sorted';
      isSmooth.value = 'specular-aa' in options;
      shading.value = options.shading ?? 'gltf';
    },
    model(description) {
      const variant = [...compare.select.options].find((option) => option.value === 'variant');
      variant.disabled = variant.hidden = !description.variants.length;
    },
  };
}
