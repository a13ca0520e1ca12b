// module_page.js - a page with one canvas that uses module.js alone: what web.mjs tests.
import { loadModule } from './facet-viewer/module.js';

const byId = (id) => document.getElementById(id);
const canvas = byId('view');
const POINTER = { press: 1, release: 2, move: 3, wheel: 4 }; // view_event_kind
const KEYS = { ArrowLeft: 256, ArrowRight: 257, ArrowUp: 258, ArrowDown: 259, Enter: 260, Home: 263 }; // view_input.h
let facet = null;
let viewer = 0;
let isAsked = false;
let isLost = false;
let lastTime = 0;

function showError(text) {
  byId('error').hidden = !text;
  byId('error').textContent = text;
}

// True: it succeeded; else the page says why.
function attempt(use) {
  showError('');
  try {
    use();
    return true;
  } catch (error) {
    showError(error.message);
    return false;
  }
}

// ---- frames ----

// In pixels of the screen: the canvas is as sharp as the display.
function fitCanvas() {
  const scale = window.devicePixelRatio || 1;
  const width = Math.max(1, Math.round(canvas.clientWidth * scale));
  const height = Math.max(1, Math.round(canvas.clientHeight * scale));
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
  }
}

function draw(seconds = 0) {
  fitCanvas();
  if (isLost) return false;
  return attempt(() => facet.draw(viewer, canvas.width, canvas.height, seconds));
}

function askForFrame() {
  if (isAsked || isLost || !facet) return;
  isAsked = true;
  requestAnimationFrame((time) => {
    isAsked = false;
    if (isLost) return;
    const isPlaying = facet.isMoving(viewer);
    draw(isPlaying && lastTime ? (time - lastTime) / 1000 : 0);
    lastTime = isPlaying ? time : 0;
    if (isPlaying) askForFrame();
  });
}

// ---- models ----

const MODEL = /\.(glb|gltf|obj|stl|ply)$/i;

// files: [path, bytes]. True: the model is shown; else the last one stays.
function open(path, files, label, status) {
  const isOpen = attempt(() => {
    facet.removeFiles();
    files.forEach(([name, bytes]) => facet.putFile(name, bytes));
    facet.open(viewer, path);
  });
  if (!isOpen) return false;
  canvas.setAttribute('aria-label', label);
  const isDrawn = draw();
  byId('status').textContent = status || facet.state(viewer).message;
  return isDrawn;
}

// bytes null: the built-in scene.
function load(bytes, name) {
  return bytes ? open(name, [[name, bytes]], name) : open('', [], 'The built-in scene: spheres of different roughness and materials');
}

// bytes null: the built-in studio.
function loadLight(bytes, name) {
  return attempt(() => {
    if (bytes) facet.putFile(name, bytes);
    facet.setOption(viewer, 'env', bytes ? `./${name}` : null);
  }) && draw();
}

// Files with paths relative to the folder that was dropped. The first model in it is shown; what it refers to is found among them.
async function loadFiles(files) {
  const models = files.filter(({ path }) => MODEL.test(path)).sort((a, b) => a.path.localeCompare(b.path));
  if (files.length === 1) return loadFile(files[0].file);
  if (!models.length) {
    showError(`none of the ${files.length} files is a model (.glb, .gltf, .obj, .stl, .ply)`);
    return false;
  }
  const contents = await Promise.all(files.map(async ({ path, file }) => [path, new Uint8Array(await file.arrayBuffer())]));
  const { path } = models[0];
  return open(path, contents, path, models.length > 1 ? `${path}, the first of ${models.length} models` : '');
}

// Entries must be asked for before the event returns; a folder gives its entries by the hundred.
async function filesOf(entries) {
  const files = [];
  for (const entry of entries) {
    if (entry.isFile) {
      const file = await new Promise((resolve, reject) => entry.file(resolve, reject));
      files.push({ path: entry.fullPath.replace(/^\//, ''), file });
    } else if (entry.isDirectory) {
      const reader = entry.createReader();
      for (;;) {
        const some = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
        if (!some.length) break;
        files.push(...(await filesOf(some)));
      }
    }
  }
  return files;
}

async function loadFile(file) {
  const bytes = new Uint8Array(await file.arrayBuffer());
  return (/\.(hdr|ktx2|png|jpe?g)$/i.test(file.name) ? loadLight : load)(bytes, file.name);
}

// ---- events ----

const modifiersOf = (event) => (event.shiftKey ? 1 : 0) | (event.ctrlKey ? 2 : 0) | (event.altKey ? 4 : 0);

function point(kind, event, x, y, button = 0) {
  if (facet && facet.point(viewer, kind, button, modifiersOf(event), x, y)) askForFrame();
}

function pointAt(kind, event) {
  const scale = window.devicePixelRatio || 1;
  const button = event.button === 2 ? 1 : event.button === 1 ? 2 : 0; // view_button
  point(kind, event, event.offsetX * scale, event.offsetY * scale, button);
}

// The last image stays until the browser gives the context back.
function listenForLoss() {
  canvas.addEventListener('webglcontextlost', (event) => {
    event.preventDefault();
    isLost = true;
    facet.lose();
  });
  canvas.addEventListener('webglcontextrestored', () => {
    isLost = false;
    if (attempt(() => facet.restore())) askForFrame();
  });
}

function listen() {
  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointAt(POINTER.press, event);
  });
  canvas.addEventListener('pointermove', (event) => pointAt(POINTER.move, event));
  canvas.addEventListener('pointerup', (event) => pointAt(POINTER.release, event));
  canvas.addEventListener('pointercancel', (event) => pointAt(POINTER.release, event));
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    point(POINTER.wheel, event, 0, -Math.sign(event.deltaY));
  }, { passive: false });
  canvas.addEventListener('keydown', (event) => {
    const key = KEYS[event.key] ?? (event.key.length === 1 ? event.key.toUpperCase().codePointAt(0) : 0);
    if (!key || event.ctrlKey || event.metaKey || !facet.key(viewer, key, modifiersOf(event))) return;
    event.preventDefault();
    byId('status').textContent = facet.state(viewer).message;
    askForFrame();
  });
  window.addEventListener('dragover', (event) => event.preventDefault());
  window.addEventListener('drop', (event) => {
    event.preventDefault();
    const entries = [...event.dataTransfer.items].map((item) => item.webkitGetAsEntry()).filter(Boolean);
    filesOf(entries).then(loadFiles).catch((error) => showError(String(error.message ?? error)));
  });
  new ResizeObserver(askForFrame).observe(canvas);
}

function set(name, value) {
  attempt(() => facet.setOption(viewer, name, value));
  askForFrame();
}

function connectControls() {
  byId('file').addEventListener('change', (event) => {
    const files = [...event.target.files].map((file) => ({ path: file.webkitRelativePath || file.name, file }));
    if (files.length) loadFiles(files);
  });
  byId('exposure').addEventListener('input', (event) => {
    byId('exposure-value').textContent = `${event.target.value} stops`;
    set('exposure', event.target.value);
  });
  byId('rotation').addEventListener('input', (event) => {
    byId('rotation-value').textContent = `${event.target.value}°`;
    set('env-rotation', event.target.value);
  });
  byId('tonemap').addEventListener('change', (event) => set('tone-mapping', event.target.value));
  byId('background').addEventListener('change', (event) => set('background', event.target.checked ? 'env' : 'transparent'));
}

// ---- start ----

async function start() {
  facet = await loadModule();
  const isReady = attempt(() => {
    facet.start(canvas);
    viewer = facet.create();
    facet.setOption(viewer, 'background', 'transparent');
  });
  if (!isReady) return;
  listen();
  listenForLoss();
  connectControls();
  byId('status').textContent = '';
  load(null, 'built-in scene');
}

// For tests and for scripts of the page: ready is fulfilled when the first image is there.
window.facetPage = { ready: start(), load, loadLight, loadFiles, draw, memory: () => facet.memorySize, get canvas() { return canvas; }, get module() { return facet; }, get viewer() { return viewer; } };
window.facetPage.ready.catch((error) => showError(`facet could not start: ${error.message}`));
