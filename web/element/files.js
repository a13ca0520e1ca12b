// files.js - the bytes of models: fetched with progress, kept for elements that show the same, and found by what a model refers to.
const kept = new Map(); // key of a request -> Blob, the oldest first
let keptCount = 5;

export const fileCache = {
  get size() { return keptCount; },
  set size(value) {
    keptCount = Math.max(0, Math.floor(value) || 0);
    shrink();
  },
  clear() { kept.clear(); },
};

function shrink() {
  for (const key of kept.keys()) {
    if (kept.size <= keptCount) return;
    kept.delete(key);
  }
}

function keep(key, blob) {
  kept.delete(key);
  kept.set(key, blob);
  shrink();
}

async function readBody(response, onProgress) {
  const total = Number(response.headers.get('content-length')) || 0;
  const isEncoded = response.headers.get('content-encoding');
  if (!response.body || !total || isEncoded) return response.blob();
  const parts = [];
  let size = 0;
  const reader = response.body.getReader();
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    parts.push(value);
    size += value.length;
    onProgress(Math.min(1, size / total));
  }
  return new Blob(parts);
}

// Whoever sends cookies may get another answer.
const keyOf = (url, withCredentials) => `${withCredentials ? 'with' : 'without'} credentials ${url}`;

async function request(url, withCredentials, download) {
  let response;
  try {
    response = await fetch(url, { credentials: withCredentials ? 'include' : 'same-origin', signal: download.abort.signal });
  } catch (error) {
    if (error.name === 'AbortError') throw error;
    throw new Error(`${url} could not be fetched: the server cannot be reached, or it does not let this page read the file`);
  }
  if (!response.ok) throw new Error(`${url} could not be fetched: the server answered ${response.status}`);
  const blob = await readBody(response, (share) => { for (const report of download.listeners) report(share); });
  keep(keyOf(url, withCredentials), blob);
  return blob;
}

// Elements that ask for the same address at the same time wait for one download. It is cancelled when no element waits for it.
const downloads = new Map(); // key -> {promise, listeners, abort}

function forget(key, download) {
  if (downloads.get(key) === download) downloads.delete(key);
}

export async function fetchFile(url, { withCredentials = false, signal, onProgress = () => {} } = {}) {
  signal?.throwIfAborted();
  const key = keyOf(url, withCredentials);
  const found = kept.get(key);
  if (found) {
    keep(key, found);
    onProgress(1);
    return found;
  }
  let download = downloads.get(key);
  if (!download) {
    download = { listeners: new Set(), abort: new AbortController() };
    downloads.set(key, download);
    const started = download;
    download.promise = request(url, withCredentials, download).finally(() => forget(key, started));
  }
  download.listeners.add(onProgress);
  const leave = () => {
    download.listeners.delete(onProgress);
    if (download.listeners.size) return;
    forget(key, download);
    download.abort.abort();
  };
  signal?.addEventListener('abort', leave, { once: true });
  try {
    return await download.promise;
  } finally {
    signal?.removeEventListener('abort', leave);
    onProgress(1);
  }
}

export const MODEL = /\.(glb|gltf|obj|stl|ply|json)$/i;
export const IMAGE = /\.(hdr|exr|ktx2|png|jpe?g|webp|dds|tga|bmp|pfm)$/i;

const FACES = [['px', 'nx', 'py', 'ny', 'pz', 'nz'], ['posx', 'negx', 'posy', 'negy', 'posz', 'negz'], ['right', 'left', 'top', 'bottom', 'front', 'back']];

// The name of six files that are the faces of a cube map, with {face} in place of a face's; '' for other files.
export function facesOf(files) {
  const paths = new Set(files.map(({ path }) => path));
  if (paths.size !== 6) return '';
  const patterns = FACES.flatMap((faces) => [...paths].filter((path) => IMAGE.test(path)).map((path) => [faces, path.replace(new RegExp(`${faces[0]}(?=\\.[^./]+$)`), '{face}')]));
  const [, pattern] = patterns.find(([faces, text]) => text.includes('{face}') && faces.every((face) => paths.has(text.replace('{face}', face)))) ?? [];
  return pattern ?? '';
}

// The words of a line, as readers of OBJ and MTL see them.
const words = (line) => line.trim().split(/\s+/);
const afterFirst = (line) => line.trim().slice(words(line)[0].length).trim();
const MAP = /^(map_\w+|bump|norm|disp|decal|refl)$/i;

function relatedToObj(text) {
  return text.split('\n').filter((line) => words(line)[0] === 'mtllib').map(afterFirst).filter(Boolean);
}

function relatedToMtl(text) {
  return text.split('\n').map(words).filter((parts) => parts.length > 1 && MAP.test(parts[0])).map((parts) => parts.at(-1));
}

// The relative addresses that a text model names; of binary ones nothing.
function relatedTo(path, text) {
  if (/\.gltf$/i.test(path)) {
    let json;
    try {
      json = JSON.parse(text);
    } catch {
      return []; // the reader says where it breaks off
    }
    const all = [...(Array.isArray(json?.buffers) ? json.buffers : []), ...(Array.isArray(json?.images) ? json.images : [])];
    return all.map((part) => part?.uri).filter((uri) => typeof uri === 'string' && !/^data:/i.test(uri));
  }
  if (/\.obj$/i.test(path)) return relatedToObj(text);
  if (/\.mtl$/i.test(path)) return relatedToMtl(text);
  return [];
}

const decode = (uri) => {
  try {
    return decodeURIComponent(uri);
  } catch {
    return uri;
  }
};

// How many folders above its own the addresses of a text reach.
const climb = (uris) => uris.reduce((most, uri) => Math.max(most, uri.match(/^(?:\.\.\/)*/)[0].length / 3), 0);

// Null: it is no address.
function resolve(uri, from) {
  try {
    return new URL(uri.replace(/\\/g, '/'), from);
  } catch {
    return null;
  }
}

// The address of a file of the page.
export function addressOf(url) {
  try {
    return new URL(url, document.baseURI);
  } catch {
    throw new Error(`"${url}" is no address of a file`);
  }
}

export const nameOf = (address) => decode(address.pathname.split('/').pop());

// Servers may give any name to a model: that of a text that begins as JSON counts as one of glTF.
async function isText(name, file) {
  if (/\.(gltf|obj)$/i.test(name)) return true;
  return !MODEL.test(name) && /^\uFEFF?\s*\{/.test(await file.slice(0, 64).text());
}

// A model and the files that it refers to, as [{path, file}]; the model is the first. One that cannot be fetched is left to the reader's
// message, which names the place in the model. Every address goes through mapURL.
export async function fetchModel(url, { mapURL = (address) => address, onProgress, ...options }) {
  const base = addressOf(mapURL(url));
  const file = await fetchFile(base.href, { ...options, onProgress: (share) => onProgress(0.9 * share) });
  const isPlain = base.protocol === 'data:' || base.protocol === 'blob:'; // no other file is beside it
  const name = (base.protocol !== 'data:' && nameOf(base)) || 'model';
  if (isPlain || !(await isText(name, file))) {
    onProgress(1);
    return [{ path: name, file }];
  }
  const first = relatedTo(MODEL.test(name) ? name : '.gltf', await file.text());
  const root = new URL('../'.repeat(climb(first)) || '.', base);
  const pathOf = (address) => decode(address.pathname.slice(root.pathname.length));
  const files = [{ path: pathOf(base) || name, file }];
  const seen = new Set([base.href]);
  const follow = (uris, from) => Promise.all(uris.map(async (uri) => {
    const address = resolve(uri, from);
    if (!address || seen.has(address.href) || !address.href.startsWith(root.href)) return;
    seen.add(address.href);
    try {
      const found = await fetchFile(addressOf(mapURL(address.href)).href, { ...options, onProgress: () => {} });
      files.push({ path: pathOf(address), file: found });
      if (/\.mtl$/i.test(address.pathname)) await follow(relatedTo(address.pathname, await found.text()), address);
    } catch (error) {
      if (error.name === 'AbortError') throw error;
    }
  }));
  await follow(first, base);
  onProgress(1);
  return files;
}
