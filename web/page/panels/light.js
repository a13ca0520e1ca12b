// light.js - what lights the model: environment, sky, sun, the file's lights, shadows.
import { check, choice, color, element, range, section } from '../fields.js';

const KINDS = [
  ['neutral', 'Studio'], ['white', 'White'], ['none', 'None'],
  { label: 'Clear sky', options: [['sun', 'Sky and sun'], ['preetham', 'Sky and sun, Preetham']] },
  { label: 'Plain', options: [['constant', 'One color'], ['gradient', 'Gradient']] },
];
const SKY = { elevation: 45, azimuth: 135, turbidity: 2.5 };

// "sun:45,135,2.5,lux" -> kind, numbers, and the words behind them, which stay
function parse(env) {
  const [kind, rest = ''] = (env ?? 'neutral').split(/:(.*)/s);
  if (kind === 'studio' || kind === 'neutral') return { kind: 'neutral' };
  if (/^#[0-9a-f]{3,8}$/i.test(kind)) return { kind: 'constant', colors: [kind] };
  if (kind === 'constant' || kind === 'gradient') return { kind, colors: rest.split(',') };
  if (kind !== 'sun' && kind !== 'preetham') return { kind: env };
  const words = rest.split(',').filter((word) => word !== '');
  const numbers = words.filter((word) => !Number.isNaN(Number(word))).map(Number);
  return { kind, elevation: numbers[0], azimuth: numbers[1], turbidity: numbers[2], words: words.filter((word) => Number.isNaN(Number(word))) };
}

export function lightPanel(app) {
  let sky = { ...SKY, words: [] };
  const setEnvironment = (kind) => {
    const text = {
      neutral: null,
      sun: `sun:${sky.elevation},${sky.azimuth},${sky.turbidity}${sky.words.map((word) => `,${word}`).join('')}`,
      preetham: `preetham:${sky.elevation},${sky.azimuth},${sky.turbidity}`,
      constant: `constant:${plain.value}`,
      gradient: `gradient:${zenith.value},${horizon.value},${nadir.value}`,
    }[kind];
    app.set('env', text === undefined ? kind : text);
  };
  const kind = choice({ label: 'Environment', options: KINDS, change: setEnvironment });
  const skyField = (name, label, min, max, step, unit) => range({ label, min, max, step, unit, value: sky[name], change: (value) => {
    sky[name] = value;
    app.setSoon('env', () => setEnvironment(kind.value));
  } });
  const elevation = skyField('elevation', 'Sun elevation', -18, 90, 1, 'degrees');
  const azimuth = skyField('azimuth', 'Sun azimuth', -180, 360, 1, 'degrees');
  const turbidity = skyField('turbidity', 'Turbidity', 1, 10, 0.1, '');
  const skyFields = element('div', { class: 'group' }, elevation.root, azimuth.root, turbidity.root);
  const colorField = (label, value) => color({ label, value, change: () => app.setSoon('env', () => setEnvironment(kind.value)) });
  const plain = colorField('Color', '#ffffff');
  const zenith = colorField('Above', '#a9c8f5');
  const horizon = colorField('Horizon', '#ffffff');
  const nadir = colorField('Below', '#7d7468');
  const gradient = element('div', { class: 'group' }, zenith.root, horizon.root, nadir.root);

  const rotation = range({ label: 'Rotation', min: -180, max: 180, step: 1, limits: [-1e6, 1e6], value: 0, unit: 'degrees',
    change: (value) => app.set('env-rotation', value === 0 ? null : String(value)) });
  const intensity = range({ label: 'Intensity', min: 0, max: 4, step: 0.05, limits: [0, 1e9], value: 1,
    change: (value) => app.set('env-intensity', value === 1 ? null : String(value)) });
  const lights = check({ label: 'Lights of the file', value: true, change: (is) => app.set('lights', is ? null : 'none') });
  const shadows = check({ label: 'Shadows of lights and sun', change: (is) => app.setFlag('shadows', is) });
  const ground = check({ label: 'Shadow on the ground', change: (is) => app.set('ground', is ? 'shadow' : null) });
  const sun = sunFields(app);
  const part = section('Light', true, kind.root, skyFields, plain.root, gradient, rotation.root, intensity.root, ground.root, shadows.root,
    lights.root, ...sun.roots);

  const showKind = (parsed) => {
    const isListed = [...kind.select.options].some((option) => option.value === parsed.kind);
    if (!isListed) kind.options = [...KINDS, { label: 'From a file', options: [...new Set([...app.lights, parsed.kind])].map((path) => [path, path]) }];
    kind.value = parsed.kind;
    skyFields.hidden = parsed.kind !== 'sun' && parsed.kind !== 'preetham';
    plain.root.hidden = parsed.kind !== 'constant';
    gradient.hidden = parsed.kind !== 'gradient';
  };
  const isHex = (text) => /^#[0-9a-f]{6}$/i.test(text ?? '');
  const showColors = ({ kind: name, colors = [] }) => {
    const fields = name === 'constant' ? [plain] : name === 'gradient' ? [zenith, horizon, nadir] : [];
    fields.forEach((field, i) => { if (isHex(colors[i])) field.value = colors[i]; });
  };
  return {
    root: part.root,
    update(options) {
      const parsed = parse(options.env);
      showKind(parsed);
      showColors(parsed);
      if (!skyFields.hidden) {
        sky = { elevation: parsed.elevation ?? SKY.elevation, azimuth: parsed.azimuth ?? 0, turbidity: parsed.turbidity ?? SKY.turbidity, words: parsed.words };
        Object.entries({ elevation, azimuth, turbidity }).forEach(([name, field]) => { field.value = sky[name]; });
      }
      rotation.value = Number(options['env-rotation'] ?? 0);
      intensity.value = Number(options['env-intensity'] ?? 1);
      lights.value = options.lights !== 'none';
      shadows.value = 'shadows' in options;
      ground.value = options.ground === 'shadow';
      sun.update(options);
    },
    model(description) {
      lights.root.hidden = !description.lights.length && !description.image_lights.length;
    },
  };
}

// A directional light beside the environment: --sun AZ,EL,LUX[,DIAMETER].
function sunFields(app) {
  let rest = []; // the diameter, if there is one
  const set = () => app.set('sun', isOn.value ? [azimuth.value, elevation.value, lux.value, ...rest].join(',') : null);
  const isOn = check({ label: 'Directional light', change: set });
  const azimuth = range({ label: 'Azimuth', min: -180, max: 180, step: 1, limits: [-1e6, 1e6], value: 45, unit: 'degrees', change: set });
  const elevation = range({ label: 'Elevation', min: -90, max: 90, step: 1, value: 45, unit: 'degrees', change: set });
  const lux = range({ label: 'Illuminance, lux', min: 0, max: 12, step: 0.01, limits: [0, 1e9], value: 3.14, change: set });
  const group = element('div', { class: 'group' }, azimuth.root, elevation.root, lux.root);
  return {
    roots: [isOn.root, group],
    update(options) {
      isOn.value = 'sun' in options;
      group.hidden = !isOn.value;
      if (!isOn.value) return;
      const numbers = options.sun.split(',').map(Number);
      [azimuth.value, elevation.value, lux.value] = [numbers[0], numbers[1] ?? 45, numbers[2] ?? 3.14];
      rest = numbers.slice(3);
    },
  };
}
