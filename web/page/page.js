// page.js - the viewer's page: <facet-viewer> with its panels. What is drawn, and what options mean, is the element's; this file opens
// files, carries changes to the element and back to the panels, and applies links.
import './facet-viewer/facet-viewer.js';
import { connectDivider } from './divider.js';
import { createEdits } from './edits.js';
import { button, choice, element, icon, section, tabs } from './fields.js';
import { faultOf, listenForDrops, listenForPicks, MODEL, save } from './files.js';
import { connectKeys } from './keys.js';
import { isOwnModel, readLink, writeLink } from './link.js';
import { createMessages, copyText, sentenceOf } from './messages.js';
import { analysisPanel } from './panels/analysis.js';
import { cameraPanel } from './panels/camera.js';
import { imagePanel } from './panels/image.js';
import { lightPanel } from './panels/light.js';
import { materialPanel } from './panels/material.js';
import { motionBar } from './panels/motion.js';
import { bytesText, reportPanel } from './panels/report.js';
import { scenePanel } from './panels/scene.js';
import { sharePanel } from './panels/share.js';
import { forgetThumbnails } from './panels/textures.js';
import { htmlOf } from './snippet.js';

const byId = (id) => document.getElementById(id);
const viewer = byId('viewer');
const messages = createMessages(byId('messages'));
const edits = createEdits(viewer);
const isNarrow = matchMedia('(max-width: 48rem)');
const prefersCalm = matchMedia('(prefers-reduced-motion: reduce)');
const PAGE_BACKGROUND = 'transparent'; // the stage shows through; facet render's own default is white

let source = null; // { reread } of dropped files; null: of the server, or the built-in scene
let waiting = null; // a link's view for a file that is still to be dropped
let description = null;
let lights = []; // paths of light files
let panels = [];

// ---- errors ----

let isOpening = false; // files that were dropped or picked

// Whoever drops the model alone learns what else it needs.
function showError(error) {
  const text = sentenceOf(error);
  const isMissing = isOpening && /there is no (such )?file/.test(text);
  messages.error(isMissing ? `${text.replace(/\.$/, '')}. Drop the model's whole folder, or all of its files at once.` : text);
}

async function attempt(what) {
  try {
    return await what();
  } catch (error) {
    showError(error);
    return undefined;
  }
}

viewer.addEventListener('error', (event) => showError(event.detail?.message ?? event.detail?.sourceError));
viewer.addEventListener('facet-message', (event) => messages.note(event.detail.text));

// ---- options ----

const optionsNow = () => viewer.options;

async function set(name, text) {
  await attempt(() => viewer.setOption(name, text));
  refreshSoon();
}

const setAll = (options) => Promise.all(Object.entries(options).map(([name, text]) => set(name, text)));

// Of many calls within a frame the last one: preparing a light takes long.
const soon = new Map();
function setSoon(name, apply) {
  if (!soon.has(name)) requestAnimationFrame(() => {
    const last = soon.get(name);
    soon.delete(name);
    last();
  });
  soon.set(name, apply);
}

// ---- panels follow the viewer ----

let isRefreshAsked = false;
function refreshSoon() {
  if (isRefreshAsked) return;
  isRefreshAsked = true;
  requestAnimationFrame(() => {
    isRefreshAsked = false;
    refresh();
  });
}

function refresh() {
  if (!description) return;
  const options = optionsNow();
  const { state } = viewer;
  panels.forEach((panel) => panel.update(options, state));
}

for (const name of ['facet-change', 'camera-change', 'environment-change', 'play', 'pause', 'finished']) viewer.addEventListener(name, refreshSoon);
viewer.addEventListener('before-render', () => { if (!viewer.paused) motion.update(optionsNow(), viewer.state); });
viewer.addEventListener('load', showModel);

function showModel() {
  description = viewer.describe();
  edits.begin(description);
  forgetThumbnails();
  const { state } = viewer;
  showName();
  panels.forEach((panel) => panel.model?.(description, state));
  refresh();
}

const fileName = () => (viewer.modelPath ?? '').split('/').pop();
const fileSize = () => viewer.files.reduce((sum, { file }) => sum + file.size, 0);

function showName() {
  const models = viewer.files.map(({ path }) => path).filter((path) => MODEL.test(path)).sort((a, b) => a.localeCompare(b));
  const name = fileName() || 'Built-in scene';
  const { drawn_triangles: triangles } = description.counts;
  byId('model-facts').textContent = `${triangles.toLocaleString('en')} triangles${fileSize() ? `, ${bytesText(fileSize())}` : ''}`;
  document.title = `${name} – facet`;
  viewer.alt = fileName() || 'The built-in scene: spheres of different roughness and materials';
  byId('invitation').hidden = Boolean(fileName());
  if (models.length < 2) {
    byId('model-name').textContent = name;
    return;
  }
  const list = choice({ label: 'Model', options: models.map((path) => [path, path]), value: viewer.modelPath, change: (path) => openModel(path) });
  list.select.setAttribute('aria-label', `Model, one of ${models.length}`);
  byId('model-name').replaceChildren(list.select);
}

// ---- files ----

function showProgress(text, value) {
  byId('progress').hidden = text === null;
  byId('progress-text').textContent = text ?? '';
  if (value === undefined) byId('progress-bar').removeAttribute('value');
  else byId('progress-bar').value = value;
}

const PHASES = { 'model-load': ['Reading the model', 'Decoding and drawing'], 'environment-update': ['Reading the light', 'Preparing the light'] };
viewer.addEventListener('progress', ({ detail }) => {
  const [reading, preparing] = PHASES[detail.reason] ?? ['Reading', 'Drawing'];
  if (detail.totalProgress >= 1) showProgress(null);
  else showProgress(detail.totalProgress < 0.8 ? `${reading}…` : `${preparing}…`, detail.totalProgress);
});

const nextFrame = () => new Promise((resolve) => { requestAnimationFrame(() => setTimeout(resolve, 0)); });

// Shows that something happens before the page stands still for it.
async function withProgress(text, work) {
  showProgress(text);
  await nextFrame();
  try {
    return await attempt(work);
  } finally {
    showProgress(null);
  }
}

async function openFiles({ files, reread }) {
  const fault = faultOf(files);
  if (fault) {
    messages.error(fault);
    return;
  }
  isOpening = true;
  const models = await withProgress(files.length === 1 ? `Reading ${files[0].path}…` : `Reading ${files.length} files…`, () => viewer.openFiles(files));
  isOpening = false;
  if (!models) return;
  if (!models.length) {
    lights = [...new Set([...lights, ...files.map(({ path }) => path)])];
    refreshSoon();
    return;
  }
  source = { reread };
  tools.reload.hidden = !reread;
  await applyWaiting();
  if (location.hash.length > 1) await shareLink(); // the address is of what is shown
}

const openModel = (path) => withProgress(`Decoding and drawing ${path}…`, () => viewer.openModel(path));

// The same files as they are now, in the same view.
async function reload() {
  if (!source?.reread) return;
  const view = { options: optionsNow(), edits: edits.list() };
  const path = viewer.modelPath;
  await attempt(async () => {
    const files = await source.reread();
    await withProgress('Reading again…', async () => {
      await viewer.openFiles(files);
      if (viewer.modelPath !== path && files.some((entry) => entry.path === path)) await viewer.openModel(path);
    });
    await applyView(view);
  });
}

// ---- links ----

const viewForLink = () => {
  const { background, ...options } = optionsNow();
  if (background !== PAGE_BACKGROUND) options.background = background ?? 'white';
  const isServed = Boolean(viewer.src) && !source;
  return { model: isServed ? viewer.getAttribute('src') : undefined, file: isServed ? undefined : fileName() || undefined, options, edits: edits.list() };
};

const linkOfView = () => `${location.href.replace(/#.*/s, '')}#${writeLink(viewForLink())}`;

const ORDER = ['scene', 'variant', 'shading', 'animation', 'time', 'camera', 'env'];
const rank = (name) => (ORDER.includes(name) ? ORDER.indexOf(name) : ORDER.length);

async function applyView({ options, edits: values }) {
  const wanted = { background: PAGE_BACKGROUND, ...options };
  const { animation, time, ...rest } = wanted;
  // at once: a frame in between would frame the model for some of them
  await setAll(Object.fromEntries(Object.keys(optionsNow()).filter((name) => !(name in wanted)).map((name) => [name, null])));
  for (const name of Object.keys(rest).sort((a, b) => rank(a) - rank(b))) await set(name, rest[name]);
  if (animation !== undefined) await attempt(() => setAnimation(animation, Number(time ?? 0)));
  await attempt(() => edits.resetAll());
  for (const [index, name, value] of values) await attempt(() => edits.set(index, name, value));
  refresh();
  if (description) material.refresh();
}

const waitingNote = ({ file }) => `The link shows ${file}. Drop that file here to see it in the link's view.`;

function waitFor(view) {
  if (waiting) messages.close(waitingNote(waiting));
  waiting = view;
  if (view) messages.note(waitingNote(view));
}

async function applyWaiting() {
  const view = waiting;
  waitFor(null);
  if (view && view.file === fileName()) await applyView(view);
}

async function showServed(name) {
  const wasDropped = Boolean(source);
  source = null;
  tools.reload.hidden = true;
  if (viewer.getAttribute('src') === name && viewer.loaded && !wasDropped) return true;
  if (wasDropped) { // the element still has the address of the model before
    viewer.removeAttribute('src');
    await viewer.updateComplete;
  }
  const done = new Promise((resolve) => {
    viewer.addEventListener('load', () => resolve(true), { once: true });
    viewer.addEventListener('error', () => resolve(false), { once: true });
  });
  viewer.setAttribute('src', name);
  return done;
}

async function applyHash() {
  const view = readLink(location.hash);
  waitFor(null);
  view.faults.forEach((text) => messages.error(text));
  if (view.model === '') {
    messages.error('The link names no model: write its file after model=, as in #model=models/boat.glb.');
    view.model = undefined;
  }
  if (view.model !== undefined && !isOwnModel(view.model, document.baseURI)) {
    messages.error(`The link's model ${view.model} is not on this server; this page loads none from elsewhere. Download it, and drop it here.`);
    view.model = undefined;
  }
  if (view.model !== undefined) {
    if (await showServed(view.model)) await applyView(view);
    else await showBuiltin();
    return;
  }
  const isFirst = !description;
  if (isFirst) await showBuiltin();
  if (view.file !== undefined && view.file !== fileName()) {
    waitFor(view);
    if (isFirst) await applyView({ options: {}, edits: [] });
    return;
  }
  await applyView(view);
}

async function showBuiltin() {
  if (!description) await attempt(() => viewer.openModel(''));
}

async function shareLink() {
  const link = linkOfView();
  history.replaceState(null, '', link);
  return link;
}

function hintOfLink() {
  if (source) return `The link holds the view; whoever opens it also needs ${fileName()}.`;
  return 'The view is in the part behind #, which browsers send to no server.';
}

// Edits are in the saved model, so texts name that one.
const baseName = () => (fileName() || 'model').replace(/\.[^.]*$/, '');
const editedName = () => `${baseName()}-edited.glb`;
const EDITS_HINT = () => `The edited materials are in the model: save it as ${editedName()} first (below).`;

// Returns { text, hint }.
function htmlOfView() {
  const { options } = viewForLink();
  const isServed = Boolean(viewer.src) && !source;
  const src = edits.any ? editedName() : isServed ? viewer.getAttribute('src') : fileName() || 'model.glb';
  const { html, rest } = htmlOf({ src, alt: `3D model: ${baseName()}`, options, names: { variants: viewer.availableVariants, animations: viewer.availableAnimations } });
  const missing = rest.length ? `No attribute sets ${rest.join(', ')}: the element shows the default there.` : '';
  return { text: html, hint: [edits.any ? EDITS_HINT() : '', missing].filter(Boolean).join(' ') };
}

// Returns { text, hint }.
function commandOfView({ width, height }) {
  const text = viewer.command(width, height);
  if (!edits.any) return { text, hint: 'The same image from the command line.' };
  const path = viewer.modelPath ?? '';
  const at = path ? text.lastIndexOf(path) : -1;
  return { text: at < 0 ? text : text.slice(0, at) + editedName() + text.slice(at + path.length), hint: EDITS_HINT() };
}

// ---- animation ----

// which: a name, an index, "all", or "" for the model at rest.
async function setAnimation(which, time = 0) {
  const names = viewer.availableAnimations;
  if (which === '' || which === 'none') {
    viewer.pause();
    await setAll({ animation: null, time: null });
    return;
  }
  const index = names.includes(which) ? names.indexOf(which) : Number(which);
  if (which !== 'all' && !Object.hasOwn(names, index)) throw new Error(`The model has no animation "${which}".`);
  viewer.animationName = names[which === 'all' ? 0 : index];
  await viewer.updateComplete;
  viewer.currentTime = time;
  await viewer.setOption('animation', which === 'all' ? which : String(index)); // also of equal names
  viewer.currentTime = time;
  refreshSoon();
}

// At rest the first animation starts.
async function togglePlay() {
  if (!viewer.paused) return viewer.pause();
  const { animation, time } = optionsNow();
  if (animation === undefined) await setAnimation('0', Number(time ?? 0));
  return viewer.play();
}

// ---- images and models ----

async function saveImage({ width, height }) {
  save(await viewer.screenshot({ width, height }), `${(fileName() || 'facet').replace(/\.[^.]*$/, '')}-${width}x${height}.png`);
}

async function saveModel() {
  const blob = await withProgress('Writing the model…', () => viewer.exportScene());
  if (blob) save(blob, editedName());
}

// ---- the page ----

const app = {
  viewer, messages, edits, attempt, set, setAll, setSoon, saveImage, saveModel, shareLink, linkOfView, htmlOfView, commandOfView, hintOfLink,
  setFlag: (name, is) => set(name, is ? '' : null),
  size: () => ({ width: Math.round(viewer.clientWidth * devicePixelRatio), height: Math.round(viewer.clientHeight * devicePixelRatio) }),
  togglePlay: () => attempt(togglePlay),
  chooseAnimation: (which) => attempt(async () => {
    await setAnimation(which);
    if (which !== '' && !prefersCalm.matches) viewer.play();
  }),
  // Of a name or an index in an option, the index as a text; '' for none.
  indexOf: (names, text) => (names?.includes(text) ? String(names.indexOf(text)) : text ?? ''),
  editMaterial: (index, name, value) => attempt(() => edits.set(index, name, value)),
  editOf: (index, name) => edits.get(index, name),
  hasEdits: (index) => edits.has(index),
  resetMaterial(index) {
    attempt(() => edits.reset(index));
    material.show(index);
  },
  showMaterial(index) {
    material.show(index);
    panelTabs.select('material');
  },
  get lights() { return lights; },
  get description() { return description; },
  get fileSize() { return fileSize(); },
};

const light = lightPanel(app);
const image = imagePanel(app);
const camera = cameraPanel(app);
const analysis = analysisPanel(app);
const scene = scenePanel(app);
const material = materialPanel(app);
const report = reportPanel(app);
const share = sharePanel(app);
const motion = motionBar(app);
const divider = connectDivider(byId('divider'), app);

const files = section('Files', true, element('div', { class: 'buttons' }, button('Open files…', () => byId('file-input').click()),
  button('Open folder…', () => byId('folder-input').click()), button('Help', () => openHelp())));
const bodies = {
  look: element('div', { class: 'panel-body' }, light.root, image.root, camera.root, analysis.root),
  scene: element('div', { class: 'panel-body' }, report.first, scene.root, report.last, files.root),
  material: element('div', { class: 'panel-body' }, material.root),
  share: element('div', { class: 'panel-body' }, share.root),
};
const panel = byId('panel');
const openSheet = (is) => { panel.dataset.open = String(is); };
const panelTabs = tabs('Settings', [['look', 'Look', bodies.look], ['scene', 'Scene', bodies.scene], ['material', 'Material', bodies.material], ['share', 'Share', bodies.share]], {
  again: () => openSheet(!isNarrow.matches || panel.dataset.open === 'false'),
  change: (id) => {
    if (panel.isConnected && description) openSheet(true);
    if (id === 'share') share.refresh();
  },
});
panel.append(panelTabs.root, ...Object.values(bodies));
openSheet(!isNarrow.matches);
panels = [light, image, camera, analysis, scene, material, report, share, motion, divider];
[light, image, camera, analysis].forEach((one) => one.update({ background: PAGE_BACKGROUND }, {}));

const toolButton = (label, name, press) => {
  const made = button('', press, { class: 'icon', 'aria-label': label, title: label });
  made.append(icon(name));
  return made;
};
const tools = {
  whole: toolButton('Show the whole model', 'whole', () => setAll({ camera: null, target: null, orbit: null })),
  image: toolButton('Save the image as PNG', 'camera', () => attempt(() => saveImage(app.size()))),
  link: toolButton('Copy a link to this view', 'share', () => attempt(async () => {
    await copyText(await shareLink());
    messages.note('The link to this view is copied.');
  })),
  reload: toolButton('Read the files again', 'reload', reload),
};
tools.reload.hidden = true;
byId('tools').append(...Object.values(tools), motion.root);

// ---- click: the material there ----

let pressed = null;
viewer.addEventListener('pointerdown', (event) => { pressed = event.button === 0 ? { x: event.clientX, y: event.clientY } : null; });
viewer.addEventListener('pointerup', (event) => {
  if (!pressed || Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) > 4) return;
  const box = viewer.getBoundingClientRect();
  const hit = viewer.pick(event.clientX - box.x, event.clientY - box.y);
  if (!hit || !(hit.material >= 0)) return;
  material.show(hit.material);
  if (!isNarrow.matches) panelTabs.select('material');
});

// ---- keys, drop, help ----

const step = (select, by) => {
  const open = [...select.options].filter((option) => !option.disabled);
  const next = open[(open.indexOf(select.selectedOptions[0]) + by + open.length) % open.length];
  select.value = next.value;
  select.dispatchEvent(new Event('change'));
};
const stops = (by) => set('exposure', String(Number((Number.parseFloat(optionsNow().exposure ?? '0') + by / 3).toFixed(3))));
const openHelp = () => byId('help').showModal();
const selectOf = (root, label) => [...root.querySelectorAll('.field')].find((field) => field.querySelector('label').textContent === label).querySelector('select');

connectKeys([
  ['H ?', 'this help', openHelp],
  ['O', 'open files', () => byId('file-input').click()],
  ['R', 'read the files again', reload],
  ['Home .', 'show the whole model', () => tools.whole.click()],
  ['Space', 'play, pause', () => { if (!motion.root.hidden) app.togglePlay(); }],
  ['+', 'brighter', () => stops(1)],
  ['-', 'darker', () => stops(-1)],
  ['T Shift+T', 'next, previous tone mapping', (by) => step(selectOf(image.root, 'Tone mapping'), by)],
  ['J', 'background', () => step(selectOf(image.root, 'Background'), 1)],
  ['N Shift+N', 'next, previous channel', (by) => step(selectOf(analysis.root, 'Show'), by)],
  ['0', 'all channels, no comparison', () => setAll({ channel: null, compare: null })],
  ['G', 'shadow on the ground', () => set('ground', optionsNow().ground ? null : 'shadow')],
  ['F12', 'save the image', () => tools.image.click()],
], byId('help-keys'));

listenForDrops(byId('cover'), openFiles, (error) => messages.error(error));
listenForPicks(byId('file-input'), byId('folder-input'), openFiles);
byId('open-files').addEventListener('click', () => byId('file-input').click());
byId('open-folder').addEventListener('click', () => byId('folder-input').click());
byId('help-open').addEventListener('click', openHelp);
byId('help-close').addEventListener('click', () => byId('help').close());
window.addEventListener('hashchange', applyHash);
applyHash();
