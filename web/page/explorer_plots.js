// explorer_plots.js - the settings of the BRDF explorer as words of `facet plot`, and requests to its worker.

// Kinds of plots that follow a material: [kind, name, options that apply].
export const KINDS = [
  ['slice', 'Curve', ['angle', 'energy', 'log', 'cosine', 'fit']],
  ['brdf', 'Polar lobe', ['angle', 'energy', 'log', 'cosine', 'fit', 'scale']],
  ['lobe', 'Lobe in space', ['angle', 'energy', 'log', 'cosine']],
  ['hemisphere', 'All directions', ['angle', 'energy', 'log', 'cosine']],
  ['albedo', 'Albedo', ['energy']],
  ['terms', 'D, V, F', ['angle', 'log']],
  ['furnace', 'Furnace', ['angle', 'energy']],
  ['fresnel', 'Fresnel', []],
  ['error', 'Fit error', []],
];

// Sliders and colors of a material by parameter of facet plot: [name, label, minimum, maximum, step, default, unit]; colors have
// [name, label, default].
export const PARAMETERS = {
  pbr: [
    ['Base', [['roughness', 'Roughness', 0, 1, 0.01, 0.4], ['metallic', 'Metallic', 0, 1, 0.01, 0], ['color', 'Color', '#ffffff'],
      ['ior', 'Index of refraction', 1, 3, 0.01, 1.5], ['specular', 'Specular', 0, 1, 0.01, 1], ['specular-color', 'Specular color', '#ffffff']]],
    ['Clear coat', [['clearcoat', 'Amount', 0, 1, 0.01, 0], ['clearcoat-roughness', 'Roughness', 0, 1, 0.01, 0]]],
    ['Diffuse', [['diffuse-roughness', 'Roughness', 0, 1, 0.01, 0]]],
    ['Sheen', [['sheen-color', 'Color', '#000000'], ['sheen-roughness', 'Roughness', 0, 1, 0.01, 0]]],
    ['Anisotropy', [['anisotropy', 'Strength', 0, 1, 0.01, 0], ['anisotropy-rotation', 'Rotation', -90, 90, 1, 0, 'degrees']]],
    ['Iridescence', [['iridescence', 'Amount', 0, 1, 0.01, 0], ['iridescence-ior', 'Index of refraction', 1, 3, 0.01, 1.3],
      ['iridescence-thickness', 'Thickness', 0, 1200, 1, 400, 'nanometers']]],
  ],
  ogl1: [['Blinn-Phong', [['diffuse', 'Diffuse', '#808080'], ['specular', 'Specular', '#ffffff'], ['shininess', 'Shininess', 0, 128, 1, 50]]]],
};

export const defaultsOf = (model) => Object.fromEntries(PARAMETERS[model].flatMap(([, list]) => list.map((p) => [p[0], p.length === 3 ? p[2] : p[5]])));

// A material as `facet plot` takes it: the model, and the parameters that differ from its defaults.
export function materialText(model, values) {
  const defaults = defaultsOf(model);
  const always = model === 'pbr' ? ['roughness'] : ['diffuse', 'specular', 'shininess'];
  const words = Object.keys(defaults).filter((name) => always.includes(name) || values[name] !== defaults[name]).map((name) => `${name}=${values[name]}`);
  return [...(model === 'ogl1' ? ['ogl1'] : []), ...words].join(',');
}

// The materials and options of a plot; those of OpenGL 1 have no terms.
export function plotOf(state) {
  const [, , applicable] = KINDS.find(([kind]) => kind === state.kind);
  const all = [...new Set([...state.kept, materialText(state.model, state.values)])];
  const materials = state.kind === 'fresnel' ? [] : all.filter((text) => state.kind !== 'terms' || !text.startsWith('ogl1'));
  const given = { angle: state.angle, energy: state.energy === 'conserving' ? null : state.energy, log: state.log, cosine: state.cosine, fit: state.fit, scale: state.scale ? 'shared' : null };
  const options = Object.fromEntries(Object.entries(given).filter(([name, value]) => applicable.includes(name) && value !== null && value !== false));
  return { kind: state.kind, materials, options };
}

const quoted = (word) => (/^[\w.,:=/-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);

export function commandOf({ kind, materials, options }, output) {
  const words = Object.entries(options).map(([name, value]) => (value === true ? `--${name}` : `--${name} ${value}`));
  return ['facet plot', kind, ...materials.map(quoted), ...words, '-o', output].join(' ');
}

// Calls of Tools in the worker. Of several that were asked for under one name while it works, only the last is done.
export function createWorker() {
  const worker = new Worker(new URL('./explorer_worker.js', import.meta.url), { type: 'module' });
  const waiting = new Map(); // by name: {method, args, resolve, reject}
  let current = null;
  let id = 0;
  const next = () => {
    const [entry] = waiting;
    if (current || !entry) return;
    waiting.delete(entry[0]);
    [, current] = entry;
    worker.postMessage({ id: ++id, method: current.method, args: current.args });
  };
  worker.addEventListener('message', ({ data }) => {
    const { resolve, reject } = current;
    current = null;
    next();
    if (data.error) reject(new Error(data.error));
    else resolve(data.result);
  });
  worker.addEventListener('error', (event) => {
    current?.reject(new Error(`facet could not be started: ${event.message ?? 'its module did not load'}`));
    current = null;
  });
  return (name, method, ...args) => new Promise((resolve, reject) => {
    waiting.get(name)?.resolve(null); // replaced
    waiting.delete(name);
    waiting.set(name, { method, args, resolve, reject });
    next();
  });
}
