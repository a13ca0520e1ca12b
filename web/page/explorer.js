// explorer.js - the BRDF explorer: settings become words of `facet plot`, which a worker draws; values are read under the pointer.
import { button, check, choice, color, element, icon, range, section } from './fields.js';
import { KINDS, PARAMETERS, commandOf, createWorker, defaultsOf, plotOf, materialText } from './explorer_plots.js';
import { createSphere } from './explorer_sphere.js';
import { fillTables, findAt, marksOf, named, sentenceOf, stepsOf } from './explorer_values.js';

const byId = (id) => document.getElementById(id);
const chart = byId('chart');
const call = createWorker();
const isDark = matchMedia('(prefers-color-scheme: dark)');
const MAX_KEPT = 5;

const state = { kind: 'slice', model: 'pbr', values: defaultsOf('pbr'), kept: [], angle: 30, energy: 'conserving', log: false, cosine: false, fit: false, scale: false };
let data = null; // numbers of the plot that is shown; null: not asked for yet
let reading = null; // {panel, at}
let shown = null; // {kind, svg}
let sphere = null; // of createSphere(), once it was opened

// ---- the link: all settings in the hash ----

function readHash() {
  const words = new URLSearchParams(location.hash.slice(1));
  if (KINDS.some(([kind]) => kind === words.get('plot'))) state.kind = words.get('plot');
  if (Object.hasOwn(PARAMETERS, words.get('model'))) state.model = words.get('model');
  state.values = defaultsOf(state.model);
  for (const [name, fallback] of Object.entries(state.values)) {
    const text = words.get(name);
    if (typeof fallback === 'string') {
      if (/^#[0-9a-f]{6}$/i.test(text ?? '')) state.values[name] = text;
    } else if (text !== null && Number.isFinite(Number(text))) state.values[name] = Number(text);
  }
  const angle = Number(words.get('angle') ?? 30);
  if (angle >= 0 && angle < 90) state.angle = angle;
  state.energy = words.get('energy') === 'gltf' ? 'gltf' : 'conserving';
  for (const name of ['log', 'cosine', 'fit', 'scale']) state[name] = words.has(name);
  state.kept = words.getAll('with').slice(0, MAX_KEPT);
}

function writeHash() {
  const words = new URLSearchParams({ plot: state.kind, model: state.model });
  const defaults = defaultsOf(state.model);
  for (const [name, value] of Object.entries(state.values)) if (value !== defaults[name]) words.set(name, value);
  if (state.angle !== 30) words.set('angle', state.angle);
  if (state.energy !== 'conserving') words.set('energy', state.energy);
  for (const name of ['log', 'cosine', 'fit', 'scale']) if (state[name]) words.set(name, '');
  for (const text of state.kept) words.append('with', text);
  history.replaceState(null, '', `#${words.toString().replace(/=(?=&|$)/g, '')}`);
}

// ---- drawing ----

const sizeOf = () => `${Math.max(240, Math.round(chart.clientWidth))}x${Math.max(160, Math.round(chart.clientHeight))}`;

function showError(text) {
  byId('error').hidden = !text;
  byId('error').textContent = text;
}

function describe(fits) {
  const [, name] = KINDS.find(([kind]) => kind === state.kind);
  const materials = plotOf(state).materials.join(' and ');
  const found = fits.filter(({ parameters }) => parameters).map(({ parameters, E }) => `${parameters} (E ${Number(E).toPrecision(3)})`);
  byId('drawing').alt = `${name} of ${materials || 'several media'}${state.angle && state.kind !== 'albedo' ? `, the eye at ${state.angle} degrees` : ''}`;
  return found.length ? `best fit: ${found.join('; ')}` : 'Point at the plot, or use the arrow keys in it, to read values.';
}

async function showDrawing(svg) {
  const image = byId('drawing');
  const url = URL.createObjectURL(new Blob([svg], { type: 'image/svg+xml' }));
  const next = new Image();
  next.src = url;
  await next.decode();
  const before = image.src;
  image.src = url;
  image.hidden = false;
  if (before) URL.revokeObjectURL(before);
}

// Draws the plot of the settings; while one is computed, only the last that was asked for follows. isNew: settings have changed.
async function draw(isNew = true) {
  const { kind, materials, options } = plotOf(state);
  const all = { ...options, size: sizeOf(), title: '', dark: isDark.matches };
  try {
    const made = await call('draw', 'plot', kind, materials, all);
    if (!made) return;
    showError('');
    shown = { kind, svg: made.svg, plot: { kind, materials, options: all } };
    data = null;
    await showDrawing(made.svg);
    const note = describe(made.fits);
    if (reading && document.activeElement === chart) await readAgain();
    else stopReading();
    if (isNew && !reading) byId('readout').textContent = note;
    chart.dataset.drawn = commandOf(plotOf(state), `${kind}.svg`);
  } catch (error) {
    showError(error.message);
  }
}

function change() {
  writeHash();
  updateSphere();
  draw();
}

// ---- values under the pointer ----

async function loadData() {
  if (data || !shown) return data;
  const { kind, materials, options } = shown.plot;
  const found = await call('data', 'plotData', kind, materials, options);
  if (found && shown.plot.options === options) data = found;
  return data;
}

const svgElement = (tag, attributes) => {
  const made = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  return made;
};

function showReading(next) {
  reading = next;
  const cursor = byId('cursor');
  if (!next) {
    cursor.replaceChildren();
    return;
  }
  const { lines, points } = marksOf(next);
  cursor.setAttribute('viewBox', `0 0 ${data.width} ${data.height}`);
  cursor.replaceChildren(
    ...lines.map(([x1, y1, x2, y2]) => svgElement('line', { x1, y1, x2, y2 })),
    ...points.map(({ x, y, color: fill }) => svgElement('circle', { cx: x, cy: y, r: 4, fill })),
  );
  byId('readout').textContent = sentenceOf(next);
}

const stopReading = () => showReading(null);

// The same place in the plot that has just been drawn.
async function readAgain() {
  const { panel: before, at } = reading;
  await loadData();
  const panel = data?.panels.find(({ kind, title }) => kind === before.kind && title === before.title) ?? data?.panels.find((one) => named(one).length);
  showReading(panel && (panel.kind === 'xy' || panel.kind === 'polar') ? { panel, at } : null);
}

async function readAt(event) {
  const box = chart.getBoundingClientRect();
  const [px, py] = [event.clientX - box.left, event.clientY - box.top];
  await loadData();
  if (!data) return;
  showReading(findAt(data, [(px * data.width) / box.width, (py * data.height) / box.height]));
}

async function readByKey(event) {
  const direction = { ArrowLeft: -1, ArrowRight: 1, PageUp: 10, PageDown: -10, Home: -Infinity, End: Infinity }[event.key];
  if (!direction) return;
  event.preventDefault();
  await loadData();
  const panels = data?.panels.filter((panel) => named(panel).length && (panel.kind === 'xy' || panel.kind === 'polar')) ?? [];
  if (!panels.length) return;
  const panel = reading?.panel ?? panels[0];
  const { from, to, step } = stepsOf(panel);
  const at = reading?.at ?? (from + to) / 2;
  showReading({ panel, at: Math.min(to, Math.max(from, at + direction * step)) });
}

// ---- files, clipboard, table ----

function save(name, blob) {
  const link = element('a', { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

async function saveCsv() {
  const { kind, materials, options } = plotOf(state);
  const args = ['plot', kind, ...materials, ...Object.entries(options).map(([name, value]) => (value === true ? `--${name}` : `--${name}=${value}`)), '--output=-', '--format=csv'];
  const { stdout } = await call('csv', 'run', args);
  save(`${kind}.csv`, new Blob([stdout], { type: 'text/csv' }));
}

async function savePng() {
  const [width, height] = sizeOf().split('x').map((side) => 2 * Number(side));
  const canvas = element('canvas', { width, height });
  canvas.getContext('2d').drawImage(byId('drawing'), 0, 0, width, height);
  save(`${state.kind}.png`, await new Promise((resolve) => { canvas.toBlob(resolve); }));
}

async function copyCommand() {
  const command = commandOf(plotOf(state), `${state.kind}.svg`);
  try {
    await navigator.clipboard.writeText(command);
    byId('readout').textContent = `Copied: ${command}`;
  } catch {
    byId('readout').textContent = command;
  }
}

async function showTable() {
  await loadData();
  if (!data) return;
  fillTables(data, byId('table-body'));
  byId('table').showModal();
}

function makeActions() {
  byId('actions').append(
    button('Table', showTable, { id: 'show-table' }),
    button('SVG', () => shown && save(`${shown.kind}.svg`, new Blob([shown.svg], { type: 'image/svg+xml' })), { 'aria-label': 'Save as SVG' }),
    button('PNG', savePng, { 'aria-label': 'Save as PNG' }),
    button('CSV', saveCsv, { 'aria-label': 'Save as CSV' }),
    element('button', { type: 'button', onclick: copyCommand, id: 'copy-command' }, icon('copy'), 'facet command'),
  );
  byId('table-close').addEventListener('click', () => byId('table').close());
}

// ---- the sphere: fetched and drawn when its section is opened ----

const sphereSection = section('Sphere', false, element('div', { class: 'sphere' }, element('p', { class: 'quiet' }, 'Loading the viewer ...')));

function updateSphere() {
  sphereSection.root.hidden = state.model !== 'pbr';
  if (sphere && state.model === 'pbr') sphere.update(state.values);
}

async function openSphere() {
  if (!sphereSection.root.open || sphere) return;
  sphereSection.root.removeEventListener('toggle', openSphere);
  const place = sphereSection.body.querySelector('.sphere');
  try {
    sphere = await createSphere(place);
    updateSphere();
  } catch (error) {
    place.replaceChildren(element('p', {}, `The sphere cannot be drawn: ${error.message}`));
  }
}

// ---- settings ----

function makeKinds() {
  const select = (kind) => {
    state.kind = kind;
    chart.dataset.kind = kind;
    for (const one of byId('kinds').children) one.setAttribute('aria-pressed', String(one.dataset.kind === kind));
    makeSettings();
  };
  byId('kinds').setAttribute('role', 'group');
  byId('kinds').setAttribute('aria-label', 'Plot');
  byId('kinds').append(...KINDS.map(([kind, name]) => button(name, () => {
    select(kind);
    change();
  }, { 'data-kind': kind })));
  select(state.kind);
}

function makeParameter(parameter) {
  const [name, label] = parameter;
  const set = (value) => {
    state.values[name] = value;
    change();
  };
  if (parameter.length === 3) return color({ label, value: state.values[name], change: set }).root;
  const [, , min, max, step, , unit] = parameter;
  return range({ label, min, max, step, value: state.values[name], unit, change: set }).root;
}

function makeKept() {
  const list = element('ul', { class: 'materials', 'aria-label': 'Materials beside it' }, ...state.kept.map((text, i) => element('li', {}, element('code', {}, text),
    element('button', { type: 'button', class: 'plain icon', 'aria-label': `Remove ${text}`, onclick: () => {
      state.kept.splice(i, 1);
      makeSettings();
      change();
    } }, icon('close')))));
  const keep = button('Keep for comparison', () => {
    const text = materialText(state.model, state.values);
    if (!state.kept.includes(text)) state.kept.push(text);
    makeSettings();
    change();
  }, { id: 'keep', disabled: state.kept.length >= MAX_KEPT });
  return [keep, list];
}

function makeView() {
  const [, , applicable] = KINDS.find(([kind]) => kind === state.kind);
  const set = (name) => (value) => {
    state[name] = value;
    change();
  };
  const fields = {
    angle: () => range({ label: 'Eye from normal', min: 0, max: 89, step: 1, value: state.angle, limits: [0, 89.9], unit: 'degrees', change: set('angle') }),
    energy: () => choice({ label: 'Energy', options: [['conserving', 'with multiple scattering'], ['gltf', 'as glTF']], value: state.energy, change: set('energy') }),
    log: () => check({ label: 'Logarithmic', value: state.log, change: set('log') }),
    cosine: () => check({ label: 'Times the cosine of the light', value: state.cosine, change: set('cosine') }),
    fit: () => check({ label: 'Best fit by the other model', value: state.fit, change: set('fit') }),
    scale: () => check({ label: 'One scale for all lobes', value: state.scale, change: set('scale') }),
  };
  return applicable.map((name) => fields[name]().root);
}

function setModel(model) {
  state.model = model;
  state.values = defaultsOf(model);
  makeSettings();
  change();
}

// The sections are made anew with the model; the fields keep the focus by their labels.
function makeSettings() {
  const focused = document.activeElement?.closest('.field')?.textContent;
  const open = new Map([...byId('settings').querySelectorAll('details')].map((one) => [one.querySelector('summary').textContent, one.open]));
  const isOpen = (title, fallback) => open.get(title) ?? fallback;
  const model = choice({ label: 'Model', options: [['pbr', 'glTF metallic-roughness'], ['ogl1', 'OpenGL 1']], value: state.model, change: setModel });
  const view = makeView();
  const isUsed = (list) => list.some((parameter) => state.values[parameter[0]] !== defaultsOf(state.model)[parameter[0]]);
  const parts = PARAMETERS[state.model].map(([title, list], i) => section(title, isOpen(title, i === 0 || isUsed(list)), ...list.map(makeParameter)).root);
  byId('settings').replaceChildren(
    section('Material', isOpen('Material', true), model.root, ...makeKept()).root,
    sphereSection.root,
    ...(view.length ? [section('View', isOpen('View', true), ...view).root] : []),
    ...parts,
  );
  if (focused) [...byId('settings').querySelectorAll('.field')].find((field) => field.textContent === focused)?.querySelector('input, select')?.focus();
}

// ---- start ----

function listen() {
  let size = '';
  new ResizeObserver(() => {
    if (sizeOf() === size) return;
    draw(size === '');
    size = sizeOf();
  }).observe(chart);
  isDark.addEventListener('change', () => draw(false));
  chart.addEventListener('pointermove', readAt);
  chart.addEventListener('pointerdown', readAt);
  chart.addEventListener('pointerleave', () => { if (document.activeElement !== chart) stopReading(); });
  chart.addEventListener('keydown', readByKey);
  addEventListener('hashchange', () => {
    readHash();
    updateSphere();
    byId('kinds').replaceChildren();
    makeKinds();
    draw();
  });
}

readHash();
makeKinds();
makeActions();
sphereSection.root.addEventListener('toggle', openSphere);
updateSphere();
listen();
