// image.js - how light becomes colors on the screen: exposure, tone mapping, background, bloom.
import { check, choice, color, range, section } from '../fields.js';

const TONE_MAPPINGS = [
  ['neutral', 'Khronos PBR Neutral'], ['aces', 'ACES, Hill'], ['aces-narkowicz', 'ACES, Narkowicz'], ['agx', 'AgX'],
  ['reinhard', 'Reinhard'], ['reinhard-extended', 'Reinhard, extended'], ['hable', 'Hable'], ['none', 'None'],
];
const BACKGROUNDS = [['transparent', 'None'], ['env', 'Environment'], ['white', 'White'], ['black', 'Black'], ['color', 'Color']];
const NAMED = new Set(['transparent', 'env', 'white', 'black']);

const orDefault = (value, usual) => (value === usual ? null : String(value));

export function imagePanel(app) {
  const setExposure = () => app.set('exposure', isMetered.value ? `auto${exposure.value < 0 ? '' : '+'}${exposure.value}`.replace(/\+0$/, '')
    : orDefault(exposure.value, 0));
  const exposure = range({ label: 'Exposure', min: -6, max: 6, step: 0.1, limits: [-100, 100], value: 0, unit: 'stops', change: setExposure });
  const isMetered = check({ label: 'Metered exposure', change: setExposure });
  const tone = choice({ label: 'Tone mapping', options: TONE_MAPPINGS, change: (name) => app.set('tone-mapping', orDefault(name, 'neutral')) });
  const background = choice({ label: 'Background', options: BACKGROUNDS,
    change: (name) => app.set('background', name === 'color' ? plain.value : name) });
  const plain = color({ label: 'Background color', value: '#39424f', change: (text) => app.set('background', text) });
  const blur = range({ label: 'Blur behind', min: 0, max: 1, step: 0.01, value: 0, change: (value) => app.set('background-blur', orDefault(value, 0)) });
  const bloom = range({ label: 'Bloom', min: 0, max: 0.2, step: 0.005, limits: [0, 1], value: 0, change: (value) => app.set('bloom', orDefault(value, 0)) });
  const part = section('Image', true, exposure.root, isMetered.root, tone.root, background.root, plain.root, blur.root, bloom.root);
  return {
    root: part.root,
    update(options) {
      const text = options.exposure ?? '0';
      isMetered.value = text.startsWith('auto');
      const stops = Number(text.replace(/^auto/, '') || 0);
      if (Number.isFinite(stops)) exposure.value = stops;
      tone.value = options['tone-mapping'] ?? 'neutral';
      const behind = options.background ?? 'white';
      background.value = NAMED.has(behind) ? behind : 'color';
      plain.root.hidden = background.value !== 'color';
      if (/^#[0-9a-f]{6}$/i.test(behind)) plain.value = behind;
      blur.root.hidden = background.value !== 'env';
      blur.value = Number(options['background-blur'] ?? 0);
      bloom.value = Number(options.bloom ?? 0);
    },
  };
}
