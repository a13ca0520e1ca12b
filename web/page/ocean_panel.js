// ocean_panel.js - the panel of the ocean page: a field per option of facet ocean, with what it means, its unit and its range.
import { button, check, choice, color, element, facts, range, section, shortNumber } from './fields.js';

const note = (text) => element('p', { class: 'note' }, text);

// Fetch, by the text of --fetch.
const FETCHES = [['inf', 'Unlimited'], ['1000km', '1000 km'], ['300km', '300 km'], ['100km', '100 km'], ['30km', '30 km'], ['10km', '10 km'], ['3km', '3 km'], ['1km', '1 km']];
const PRESETS = { glass: 'Glass', breeze: 'Breeze', 'trade-wind': 'Trade wind', gale: 'Gale', lagoon: 'Lagoon', harbour: 'Harbor' };
// What a preset sets; choosing one clears them.
const SEA_OPTIONS = ['wind', 'fetch', 'swell', 'choppiness', 'water', 'chl', 'bed-slope', 'bed-color', 'depth'];
const LIGHTS = { Noon: 62, Afternoon: 30, Evening: 9, Sunset: 1.5, Dusk: -4 };
const TONES = [['agx', 'AgX'], ['neutral', 'Khronos PBR Neutral'], ['aces', 'ACES (Hill)'], ['aces-narkowicz', 'ACES (Narkowicz)'], ['reinhard', 'Reinhard'], ['hable', 'Hable'], ['none', 'None']];
const STAGES = [['', 'Full model'], ['5', '5: foam and glints'], ['4', '4: refraction and absorption'], ['3', '3: light of the sky'], ['2', '2: microfacets'], ['1', '1: Schlick’s Fresnel']];

const degrees = (angle) => ((Math.round(angle * 100) / 100 % 360) + 360) % 360;

// set({ option: text or null, .. }) changes the sea, look(azimuth, elevation) and rise(height) its camera; read() gives
// { options, values, state }. Returns { root, refresh() }.
export function makePanel({ set, look, rise, read }) {
  const now = () => read();
  const part = (name, index, value) => now().values[name].map((x, i) => shortNumber(i === index ? value : x)).join(',');
  const chip = (text, press) => button(text, press);
  const flag = (name) => (is) => set({ [name]: is ? null : '' });
  const optional = (name) => (text) => set({ [name]: text || null });

  const f = {
    wind: range({ label: 'Wind speed', min: 0, max: 25, step: 0.5, limits: [0, 40], unit: 'meters per second', symbol: 'm/s', change: (v) => set({ wind: part('wind', 0, v) }) }),
    windTo: range({ label: 'Wind blows to', min: 0, max: 360, step: 1, unit: 'degrees', symbol: '°', change: (v) => set({ wind: part('wind', 1, v) }) }),
    fetch: choice({ label: 'Fetch', options: FETCHES, change: (v) => set({ fetch: v }) }),
    swell: range({ label: 'Swell height', min: 0, max: 6, step: 0.1, limits: [0, 30], unit: 'meters', symbol: 'm', change: (v) => set({ swell: swellOf(0, v) }) }),
    swellPeriod: range({ label: 'Swell period', min: 4, max: 20, step: 0.5, limits: [0.1, 40], unit: 'seconds', symbol: 's', change: (v) => set({ swell: swellOf(1, v) }) }),
    swellTo: range({ label: 'Swell runs to', min: 0, max: 360, step: 1, unit: 'degrees', symbol: '°', change: (v) => set({ swell: swellOf(2, v) }) }),
    choppiness: range({ label: 'Choppiness', min: 0, max: 2, step: 0.05, change: (v) => set({ choppiness: shortNumber(v) }) }),
    chl: range({ label: 'Chlorophyll', min: 0, max: 10, step: 0.05, limits: [0, 30], unit: 'milligrams per cubic meter', symbol: 'mg/m³', change: (v) => set({ water: null, chl: shortNumber(v) }) }),
    water: choice({ label: 'Water type', options: [], change: (v) => set(v ? { chl: null, water: v } : { water: null }) }),
    bed: check({ label: 'Sea bed', change: (is) => set(is ? { depth: '3' } : { 'bed-slope': null, 'bed-color': null, depth: 'inf' }) }),
    depth: range({ label: 'Depth', min: 0.2, max: 30, step: 0.1, limits: [0.001, 1e7], unit: 'meters', symbol: 'm', change: (v) => set({ depth: shortNumber(v) }) }),
    slope: range({ label: 'Slope of the bed', min: 0, max: 0.3, step: 0.01, limits: [0, 1], change: (v) => set({ 'bed-slope': part('bed-slope', 0, v) }) }),
    bedColor: color({ label: 'Color of the bed', change: (v) => set({ 'bed-color': v }) }),
    sun: range({ label: 'Sun elevation', min: -10, max: 90, step: 0.5, limits: [-90, 90], unit: 'degrees', symbol: '°', change: (v) => set({ sun: part('sun', 0, v) }) }),
    sunTo: range({ label: 'Sun azimuth', min: 0, max: 360, step: 1, unit: 'degrees', symbol: '°', change: turnSun }),
    turbidity: range({ label: 'Turbidity', min: 1, max: 10, step: 0.1, change: (v) => set({ turbidity: shortNumber(v) }) }),
    exposure: range({ label: 'Exposure', min: -4, max: 4, step: 0.1, limits: [-20, 20], unit: 'stops', symbol: 'EV', change: (v) => set({ exposure: shortNumber(v) }) }),
    tone: choice({ label: 'Tone mapping', options: TONES, change: (v) => set({ 'tone-mapping': v }) }),
    height: range({ label: 'Height of the eye', min: -10, max: 40, step: 0.5, limits: [-1000, 50000], unit: 'meters', symbol: 'm', change: rise }),
    azimuth: range({ label: 'Looks to', min: 0, max: 360, step: 1, unit: 'degrees', symbol: '°', change: (v) => look(v, now().state.elevation) }),
    elevation: range({ label: 'Up or down', min: -89, max: 89, step: 1, unit: 'degrees', symbol: '°', change: (v) => look(now().state.azimuth, v) }),
    fov: range({ label: 'Field of view', min: 5, max: 100, step: 1, limits: [0.1, 170], unit: 'degrees', symbol: '°', change: (v) => set({ fov: shortNumber(v) }) }),
    compare: check({ label: 'Compare with the legacy look', change: (is) => set({ 'before-after': is ? '' : null, ...(is ? { stage: null } : {}) }) }),
    before: choice({ label: 'Legacy formulas', options: [['', 'Corrected (B)'], ['A', 'Original (A)']], change: (v) => set({ before: v || null }) }),
    stage: choice({ label: 'Shading stage', options: STAGES, change: optional('stage') }),
    glints: check({ label: 'Single glints of the sun', change: flag('no-glints') }),
    foam: check({ label: 'Whitecaps', change: flag('no-foam') }),
    caustics: check({ label: 'Caustics on the bed', change: flag('no-caustics') }),
    normals: choice({ label: 'Microfacets', options: [['', 'Gaussian (Beckmann)'], ['ggx', 'GGX']], change: optional('normals') }),
    masking: choice({ label: 'Masking', options: [['', 'Waves of all lengths'], ['smith', 'Smith'], ['schlick', 'Schlick-Karis']], change: optional('masking') }),
    fresnel: choice({ label: 'Fresnel', options: [['', 'Exact'], ['schlick', 'Schlick']], change: optional('fresnel') }),
  };

  // A swell has a period from the start.
  function swellOf(index, value) {
    const swell = now().values.swell.map((x, i) => (i === index ? value : x));
    if (!swell[1]) swell[1] = 10;
    return swell[0] > 0 ? swell.map((x) => shortNumber(x)).join(',') : null;
  }

  // Without a heading the camera follows the sun.
  function turnSun(azimuth) {
    const { state } = now();
    look(state.azimuth, state.elevation);
    set({ sun: part('sun', 1, azimuth) });
  }

  const presets = Object.entries(PRESETS).map(([name, text]) => [name, chip(text, () => set({ ...Object.fromEntries(SEA_OPTIONS.map((option) => [option, null])), preset: name }))]);
  const lights = Object.entries(LIGHTS).map(([text, elevation]) => [elevation, chip(text, () => set({ sun: part('sun', 0, elevation) }))]);
  const numbers = element('div');
  const command = element('pre', { class: 'command', tabindex: '0', 'aria-label': 'Command' });

  const body = element('form', { class: 'panel-body', id: 'fields' },
    section('Sea', true,
      element('div', { class: 'chips', role: 'group', 'aria-label': 'Presets' }, ...presets.map(([, made]) => made)),
      f.wind.root, note('At 10 m above the water, 0 to 40 m/s. It sets the height, the length and the steepness of the waves.'),
      f.windTo.root, note('Degrees, like all directions here: 0 is +Z, 90 is +X.'),
      f.fetch.root, note('The distance over water that the wind has blown: near a windward shore waves are short and steep.'),
      f.swell.root, f.swellPeriod.root, f.swellTo.root, note('Long waves from a storm far away: significant height in m, period in s.'),
      f.choppiness.root, note('How sharp crests are: 1 is physical, below it waves are rounder.')).root,
    section('Light', true,
      element('div', { class: 'chips', role: 'group', 'aria-label': 'Time of day' }, ...lights.map(([, made]) => made)),
      f.sun.root, note('Degrees above the horizon; below 0 the sun has set, and the sky still glows.'),
      f.sunTo.root, f.turbidity.root, note('Haze, 1 to 10: 1.55 is clear sea air, 4 a hazy day.'),
      f.exposure.root, note('Stops relative to the light meter: +1 is twice as bright.'),
      f.tone.root).root,
    section('Water and bed', true,
      f.chl.root, note('mg/m³ of chlorophyll, 0 to 30: 0.05 is deep blue, 10 is green.'),
      f.water.root, note('Jerlov’s types instead, from the clearest ocean (I) to the most turbid coast (9C).'),
      f.bed.root, f.depth.root, f.slope.root, f.bedColor.root, note('Depth in m below the still water; the slope is its rise per meter, 0 to 1.')).root,
    section('Camera', false,
      f.height.root, note('Meters above the still water; below 0 the camera is under water. It keeps 1 m above the waves.'),
      f.azimuth.root, f.elevation.root, f.fov.root,
      element('dl', { class: 'keys', id: 'keys' },
        ...[['Drag, arrow keys', 'look around'], ['Wheel, + and −', 'zoom'], ['Page Up, Page Down', 'rise and sink'], ['Space', 'play and pause']].flatMap(([key, what]) => [element('dt', {}, key), element('dd', {}, what)]))).root,
    section('Shading', true,
      f.compare.root, f.before.root, note('The legacy look: a color, a mirror image of the sky and a highlight, without units. Drag the border over the image.'),
      f.stage.root, note('The steps from the legacy look to the physical one.'),
      f.glints.root, f.foam.root, f.caustics.root,
      f.normals.root, f.masking.root, f.fresnel.root, note('What game engines use instead, for comparison.')).root,
    section('In numbers', true, numbers).root,
    section('The same image on the command line', false, command).root);
  body.addEventListener('submit', (event) => event.preventDefault());

  const refreshSea = ({ options, values }) => {
    for (const [name, made] of presets) made.setAttribute('aria-pressed', String(options.preset === name));
    f.wind.value = values.wind[0];
    f.windTo.value = degrees(values.wind[1]);
    f.fetch.value = FETCHES.find(([text]) => text === options.fetch)?.[0] ?? nearestFetch(values.fetch);
    f.swell.value = values.swell[0];
    f.swellPeriod.value = values.swell[1] || 10;
    f.swellTo.value = degrees(values.swell[2]);
    f.swellPeriod.disabled = f.swellTo.disabled = !(values.swell[0] > 0);
    f.choppiness.value = values.choppiness;
    f.chl.value = values.chl ?? 0.2;
    f.water.value = values.water ?? '';
    f.bed.value = values.depth !== null;
    f.depth.value = values.depth ?? 3;
    f.slope.value = values['bed-slope'][0];
    f.bedColor.value = values['bed-color'];
    for (const field of [f.depth, f.slope, f.bedColor]) field.disabled = values.depth === null;
  };

  const refreshLight = ({ options, values, state }) => {
    for (const [elevation, made] of lights) made.setAttribute('aria-pressed', String(Math.abs(values.sun[0] - elevation) < 0.01));
    f.sun.value = values.sun[0];
    f.sunTo.value = degrees(values.sun[1]);
    f.turbidity.value = options.turbidity ?? 1.55;
    f.exposure.value = values.exposure;
    f.tone.value = options['tone-mapping'] ?? 'agx';
    f.height.value = state.height;
    f.azimuth.value = degrees(state.azimuth);
    f.elevation.value = state.elevation;
    f.fov.value = state.fov;
  };

  const refreshShading = ({ options, values }) => {
    f.compare.value = options['before-after'] !== undefined;
    f.before.value = options.before === 'A' ? 'A' : '';
    f.before.disabled = !f.compare.value;
    f.stage.disabled = f.compare.value || options.before !== undefined;
    for (const name of ['stage', 'normals', 'masking', 'fresnel']) f[name].value = options[name] ?? '';
    for (const name of ['glints', 'foam', 'caustics']) f[name].value = options[`no-${name}`] === undefined;
    f.caustics.disabled = values.depth === null;
  };

  return {
    root: body,
    setHelp(help) { f.water.options = [['', 'By chlorophyll'], ...help.water.choices.map((type) => [type, `Jerlov ${type}`])]; },
    refresh(text) {
      const all = now();
      refreshSea(all);
      refreshLight(all);
      refreshShading(all);
      command.textContent = text;
      const { state } = all;
      numbers.replaceChildren(facts([
        ['Significant wave height', `${shortNumber(state.waveHeight, 3)} m`],
        ['Period of the highest waves', state.waveHeight > 0 && `${shortNumber(state.wavePeriod, 3)} s`],
        ['Their length', state.waveHeight > 0 && `${shortNumber(state.waveLength, 3)} m`],
        ['Covered by foam', `${shortNumber(100 * state.foam, 2)} %`],
        ['Index of refraction', shortNumber(state.ior, 5)],
        ['Exposure value at ISO 100', shortNumber(state.ev100, 4)],
      ].filter(([, value]) => value)));
    },
  };
}

const nearestFetch = (meters) => (meters === null ? 'inf'
  : FETCHES.slice(1).reduce((best, [text]) => (Math.abs(Math.log(parseFloat(text) * 1000 / meters)) < Math.abs(Math.log(parseFloat(best) * 1000 / meters)) ? text : best), '1km'));
