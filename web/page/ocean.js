// ocean.js - the ocean page: input, the link and the buttons. The sea is C (ocean_module.js); ocean_frames.js draws it.
import { button, element, icon } from './fields.js';
import { makeDivider } from './ocean_divider.js';
import { makeFrames } from './ocean_frames.js';
import { loadOcean } from './ocean_module.js';
import { makePanel } from './ocean_panel.js';

const byId = (id) => document.getElementById(id);
const canvas = byId('view');
const stage = byId('stage');
const isNarrow = matchMedia('(max-width: 48rem)');
const calm = matchMedia('(prefers-reduced-motion: reduce)');

let ocean = null;
let panel = null;
let isPlaying = false;
let frames = null;

// ---- messages ----

let statusTimer = 0;
function say(text) {
  byId('status').textContent = text;
  clearTimeout(statusTimer);
  if (text) statusTimer = setTimeout(() => { byId('status').textContent = ''; }, 6000);
}

function showError(text) {
  byId('error').hidden = !text;
  byId('error').textContent = text;
}

// Runs f; its error is shown. True: there was none; the last error stays.
function attempt(f) {
  try {
    f();
    return true;
  } catch (error) {
    showError(error.message);
    return false;
  }
}

// ---- frames ----

// What takes long says so.
function report({ isWaiting, isCompiling, share, isSharp }) {
  const bar = byId('progress-bar');
  const warning = ocean.takeWarning();
  if (warning) say(warning);
  byId('progress').hidden = !isWaiting;
  byId('progress-text').textContent = isCompiling ? 'Preparing the shaders…' : share === null ? 'Drawing…' : 'Refining the image…';
  if (share === null) bar.removeAttribute('value');
  else bar.value = share;
  document.body.dataset.sharp = String(isSharp);
  stage.setAttribute('aria-busy', String(isWaiting));
}

function play(is) {
  isPlaying = is;
  playButton.setAttribute('aria-label', is ? 'Pause' : 'Play');
  playButton.replaceChildren(icon(is ? 'pause' : 'play'));
  if (!is) settle();
  frames.turn(is);
}

// ---- settings, the link ----

let linkTimer = 0;
const writeLink = () => history.replaceState(null, '', `#${linkText()}`);

// After a change: the panel shows what is set, the link holds it.
function settle() {
  const isDivided = ocean.options['before-after'] !== undefined;
  divider.hidden = byId('label-before').hidden = byId('label-now').hidden = !isDivided;
  panel.refresh(ocean.command(...frames.fullSize()));
  clearTimeout(linkTimer);
  linkTimer = setTimeout(writeLink, 200); // browsers limit how often an address may change
}

function change(f) {
  showError('');
  attempt(f);
  settle();
  frames.restart();
}

const set = (changes) => change(() => {
  const before = ocean.options;
  try {
    for (const [name, text] of Object.entries(changes)) ocean.setOption(name, text);
  } catch (error) {
    for (const name of Object.keys(changes)) ocean.setOption(name, null);
    for (const name of Object.keys(changes)) if (before[name] !== undefined) ocean.setOption(name, before[name]);
    throw error;
  }
});

function linkText() {
  const parts = new URLSearchParams(ocean.options);
  const { time } = ocean.state;
  parts.delete('time');
  if (!isPlaying && time) parts.set('time', String(time));
  if (ocean.options['before-after'] !== undefined) parts.set('divider', divider.value.toFixed(3));
  return parts.toString().replaceAll('%2C', ',').replaceAll('=&', '&').replace(/=$/, '');
}

// Options that cannot be set are reported, the others are set all the same. Returns whether there are any.
function readLink() {
  const wanted = new URLSearchParams(location.hash.slice(1));
  const refused = [];
  ocean.reset();
  for (const [name, text] of wanted) {
    try {
      if (name === 'divider') divider.value = Number(text) || 0;
      else ocean.setOption(name, text);
    } catch (error) {
      refused.push(error.message);
    }
  }
  showError(refused.join('\n'));
  return { isEmpty: wanted.size === 0, hasTime: wanted.has('time') };
}

// ---- buttons ----

const divider = makeDivider(byId('divider'), stage, () => change(() => {}));
const playButton = button('', () => play(!isPlaying), { class: 'icon' });

async function copy(text, what) {
  try {
    await navigator.clipboard.writeText(text);
    say(`${what} copied.`);
  } catch {
    say(`This browser does not let pages copy. ${what}: ${text}`);
  }
}

// The image at rest, once it has all samples; a sea in motion waits for it.
async function saveImage() {
  const wasPlaying = isPlaying;
  play(false);
  say('Drawing the image…');
  if (!await frames.sharpen()) {
    say('The image was not saved: the sea moved on.');
    return;
  }
  const blob = await new Promise((resolve) => canvas.toBlob(resolve, 'image/png'));
  const link = element('a', { href: URL.createObjectURL(blob), download: 'sea.png' });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  say('Saved as sea.png.');
  if (wasPlaying) play(true);
}

function addButtons() {
  const labelled = (name, text, press) => {
    const made = button('', press, { 'aria-label': text, title: text });
    made.append(icon(name), element('span', { class: 'wide' }, text));
    return made;
  };
  const made = [
    labelled('copy', 'Copy command', () => copy(ocean.command(...frames.fullSize()), 'Command')),
    labelled('camera', 'Save image', saveImage),
    labelled('share', 'Share', () => {
      writeLink();
      copy(location.href, 'Link');
    })];
  byId('controls').append(playButton);
  const place = () => byId(isNarrow.matches ? 'controls' : 'actions').append(...made); // the bar has no room for them
  isNarrow.addEventListener('change', place);
  place();
}

// ---- input ----

const look = (azimuth, elevation) => change(() => ocean.look(azimuth, elevation));
const rise = (height) => change(() => ocean.rise(height));

const pointers = new Map();
function listenToPointer() {
  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  canvas.addEventListener('pointermove', (event) => {
    const last = pointers.get(event.pointerId);
    if (!last) return;
    const [dx, dy] = [event.clientX - last[0], event.clientY - last[1]];
    const apart = () => { const [a, b] = [...pointers.values()]; return Math.hypot(a[0] - b[0], a[1] - b[1]); };
    const before = pointers.size === 2 ? apart() : 0;
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
    if (pointers.size === 2) change(() => ocean.zoom((apart() - before) / 40));
    else change(() => ocean.turn(-dx, dy, canvas.clientHeight));
  });
  for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, (event) => pointers.delete(event.pointerId));
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    change(() => ocean.zoom(-Math.sign(event.deltaY)));
  }, { passive: false });
}

function listenToKeys() {
  const step = () => canvas.clientHeight / 12;
  const actions = {
    ArrowLeft: () => ocean.turn(-step(), 0, canvas.clientHeight),
    ArrowRight: () => ocean.turn(step(), 0, canvas.clientHeight),
    ArrowUp: () => ocean.turn(0, step(), canvas.clientHeight),
    ArrowDown: () => ocean.turn(0, -step(), canvas.clientHeight),
    PageUp: () => ocean.rise(Math.round(ocean.state.height) + 1),
    PageDown: () => ocean.rise(Math.round(ocean.state.height) - 1),
    '+': () => ocean.zoom(1),
    '-': () => ocean.zoom(-1),
  };
  canvas.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === ' ') play(!isPlaying);
    else if (actions[event.key]) change(actions[event.key]);
    else return;
    event.preventDefault();
  });
}

function listenToLoss() {
  canvas.addEventListener('webglcontextlost', (event) => {
    event.preventDefault();
    frames.lose();
    ocean.lose();
  });
  canvas.addEventListener('webglcontextrestored', () => {
    if (attempt(() => ocean.restore())) frames.restore();
  });
}

// ---- start ----

// The first image, where the link says nothing: a fresh breeze, and the glitter of the low sun.
const FIRST = { wind: '8,90', sun: '12,0', heading: '14', 'before-after': '' };

async function start() {
  ocean = await loadOcean(canvas);
  frames = makeFrames({ canvas, ocean, attempt, report, read: () => ({ divider: divider.value, isPlaying }) });
  panel = makePanel({ set, look, rise, read: () => ({ options: ocean.options, values: ocean.values, state: ocean.state }) });
  panel.setHelp(ocean.help);
  byId('panel').append(panel.root);
  addButtons();
  listenToPointer();
  listenToKeys();
  listenToLoss();
  const { isEmpty, hasTime } = readLink();
  if (isEmpty) {
    for (const [name, text] of Object.entries(FIRST)) ocean.setOption(name, text);
    divider.value = 0.3;
  }
  window.addEventListener('hashchange', () => {
    readLink();
    settle();
    frames.restart();
  });
  new ResizeObserver(frames.restart).observe(canvas);
  calm.addEventListener('change', () => { if (calm.matches) play(false); });
  say('');
  play(!hasTime && !calm.matches);
  settle();
}

// For tests and scripts of the page.
window.oceanPage = { ready: start(), get ocean() { return ocean; }, get frames() { return frames; }, get isPlaying() { return isPlaying; }, play, set };
window.oceanPage.ready.catch((error) => showError(`The sea could not start: ${error.message}`));
