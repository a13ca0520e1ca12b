// page.js - the page around viewer.wasm: hands over files and events, and asks for a frame when something changed. What is drawn and
// how the camera moves is C (viewer.c).
import createFacet from './facet-viewer/viewer.js';

const byId = (id) => document.getElementById(id);
const canvas = byId('view');
const POINTER = { press: 1, release: 2, move: 3, wheel: 4 }; // view_event_kind
const KEYS = { ArrowLeft: 256, ArrowRight: 257, ArrowUp: 258, ArrowDown: 259, Enter: 260, Home: 263 }; // view_input.h
let facet = null;
let isAsked = false;
let isLost = false;
let lastTime = 0;

function showError(text) {
  byId('error').hidden = !text;
  byId('error').textContent = text;
}

// ---- strings and bytes of C ----

function withText(text, use) {
  const size = 4 * text.length + 1;
  const at = facet._malloc(size);
  facet.stringToUTF8(text, at, size);
  try {
    return use(at);
  } finally {
    facet._free(at);
  }
}

const lastError = () => facet.UTF8ToString(facet._facet_web_error());
const lastMessage = () => facet.UTF8ToString(facet._facet_web_message());

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
  const failed = facet._facet_web_draw(canvas.width, canvas.height, seconds) !== 0;
  if (failed) showError(lastError());
  return !failed;
}

function askForFrame() {
  if (isAsked || isLost || !facet) return;
  isAsked = true;
  requestAnimationFrame((time) => {
    isAsked = false;
    if (isLost) return;
    const isPlaying = facet._facet_web_is_playing() !== 0;
    draw(isPlaying && lastTime ? (time - lastTime) / 1000 : 0);
    lastTime = isPlaying ? time : 0;
    if (isPlaying) askForFrame();
  });
}

// ---- models ----

// Hands bytes to a function of C that takes (bytes, size, name). True: it succeeded; else the page says why.
function hand(read, bytes, name) {
  showError('');
  let at = 0;
  if (bytes) {
    at = facet._malloc(bytes.length || 1);
    if (!at) {
      showError(`${name}: there is no memory for ${bytes.length} bytes`);
      return false;
    }
    facet.HEAPU8.set(bytes, at);
  }
  const failed = withText(name, (text) => read(at, bytes ? bytes.length : 0, text)) !== 0;
  if (at) facet._free(at);
  if (failed) showError(lastError());
  return !failed;
}

// bytes null: the built-in scene. True: it is shown; else the last model stays.
function load(bytes, name) {
  if (!hand(facet._facet_web_load, bytes, name)) return false;
  canvas.setAttribute('aria-label', bytes ? name : 'The built-in scene: spheres of different roughness and materials');
  const isDrawn = draw();
  byId('status').textContent = lastMessage();
  return isDrawn;
}

// bytes null: the built-in studio.
function loadLight(bytes, name) {
  return hand(facet._facet_web_light, bytes, name) && draw();
}

const MODEL = /\.(glb|gltf|obj|stl|ply)$/i;
const FOLDER = '/dropped';

function removeAll(path) {
  for (const name of facet.FS.readdir(path)) {
    if (name === '.' || name === '..') continue;
    const at = `${path}/${name}`;
    if (facet.FS.isDir(facet.FS.stat(at).mode)) removeAll(at);
    else facet.FS.unlink(at);
  }
  facet.FS.rmdir(path);
}

// Files with paths relative to the folder that was dropped. The first model in it is shown; what it refers to is found among them.
async function loadFiles(files) {
  const models = files.filter(({ path }) => MODEL.test(path)).sort((a, b) => a.path.localeCompare(b.path));
  if (files.length === 1) return loadFile(files[0].file);
  if (!models.length) {
    showError(`none of the ${files.length} files is a model (.glb, .gltf, .obj, .stl, .ply)`);
    return false;
  }
  showError('');
  const contents = await Promise.all(files.map(({ file }) => file.arrayBuffer()));
  facet.FS.mkdirTree(FOLDER);
  files.forEach(({ path }, i) => {
    const at = `${FOLDER}/${path}`;
    facet.FS.mkdirTree(at.slice(0, at.lastIndexOf('/')));
    facet.FS.writeFile(at, new Uint8Array(contents[i]));
  });
  const { path } = models[0];
  const failed = withText(`${FOLDER}/${path}`, (text) => withText(FOLDER, (root) => facet._facet_web_open(text, root))) !== 0;
  removeAll(FOLDER);
  if (failed) {
    showError(lastError());
    return false;
  }
  canvas.setAttribute('aria-label', path);
  const isDrawn = draw();
  byId('status').textContent = models.length > 1 ? `${path}, the first of ${models.length} models` : lastMessage();
  return isDrawn;
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
  if (facet && facet._facet_web_point(kind, button, modifiersOf(event), x, y)) askForFrame();
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
    facet._facet_web_lose();
  });
  canvas.addEventListener('webglcontextrestored', () => {
    isLost = false;
    if (facet._facet_web_restore() !== 0) showError(lastError());
    else askForFrame();
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
    if (!key || event.ctrlKey || event.metaKey || !facet._facet_web_key(key, modifiersOf(event))) return;
    event.preventDefault();
    byId('status').textContent = lastMessage();
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
  withText(name, (text) => facet._facet_web_set(text, value));
  askForFrame();
}

function connectControls() {
  byId('file').addEventListener('change', (event) => {
    const files = [...event.target.files].map((file) => ({ path: file.webkitRelativePath || file.name, file }));
    if (files.length) loadFiles(files);
  });
  byId('exposure').addEventListener('input', (event) => {
    byId('exposure-value').textContent = `${event.target.value} stops`;
    set('exposure', Number(event.target.value));
  });
  byId('rotation').addEventListener('input', (event) => {
    byId('rotation-value').textContent = `${event.target.value}°`;
    set('rotation', (Number(event.target.value) * Math.PI) / 180);
  });
  byId('tonemap').addEventListener('change', (event) => set('tonemap', Number(event.target.value)));
  byId('background').addEventListener('change', (event) => set('background', event.target.checked ? 2 : 0));
}

// ---- start ----

async function start() {
  facet = await createFacet();
  facet.specialHTMLTargets['!view'] = canvas;
  if (withText('!view', (text) => facet._facet_web_start(text)) !== 0) {
    showError(lastError());
    return;
  }
  listen();
  listenForLoss();
  connectControls();
  byId('status').textContent = '';
  load(null, 'built-in scene');
}

// For tests and for scripts of the page: ready is fulfilled when the first image is there.
window.facetPage = { ready: start(), load, loadLight, loadFiles, draw, memory: () => facet.HEAPU8.length, get canvas() { return canvas; } };
window.facetPage.ready.catch((error) => showError(`facet could not start: ${error.message}`));
