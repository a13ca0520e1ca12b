// files.js - the bytes of models: fetched with progress, kept for elements that show the same, and found by what a model refers to.
const kept = new Map(); // url -> Blob, the oldest first
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
  for (const url of kept.keys()) {
    if (kept.size <= keptCount) return;
    kept.delete(url);
  }
}

function keep(url, blob) {
  kept.delete(url);
  kept.set(url, blob);
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
  keep(url, blob);
  return blob;
}

// Elements that ask for the same address at the same time wait for one download. It is cancelled when nobody waits any more.
const downloads = new Map(); // url -> {promise, listeners, abort}

function forget(url, download) {
  if (downloads.get(url) === download) downloads.delete(url);
}

export async function fetchFile(url, { withCredentials = false, signal, onProgress = () => {} } = {}) {
  const found = kept.get(url);
  if (found) {
    keep(url, found);
    onProgress(1);
    return found;
  }
  let download = downloads.get(url);
  if (!download) {
    download = { listeners: new Set(), abort: new AbortController() };
    downloads.set(url, download);
    const started = download;
    download.promise = request(url, withCredentials, download).finally(() => forget(url, started));
  }
  download.listeners.add(onProgress);
  const leave = () => {
    download.listeners.delete(onProgress);
    if (download.listeners.size) return;
    forget(url, download);
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
const TEXT = /\.(gltf|obj)$/i; // models that name other files
export const IMAGE = /\.(hdr|exr|ktx2|png|jpe?g|webp|dds|tga|bmp|pfm)$/i;

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
  const lines = text.split(/\r?\n/);
  if (/\.obj$/i.test(path)) return lines.flatMap((line) => line.match(/^\s*mtllib\s+(.+?)\s*$/)?.[1] ?? []);
  if (/\.mtl$/i.test(path)) return lines.flatMap((line) => line.match(/^\s*(?:map_\w+|bump|norm|disp|decal|refl)\s+(?:.*\s)?(\S+)\s*$/i)?.[1] ?? []);
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
const climb = (uris) => Math.max(0, ...uris.map((uri) => uri.match(/^(?:\.\.\/)*/)[0].length / 3));

// A model and the files that it refers to, as [{path, file}]; the model is the first. One that cannot be fetched is left to the reader's
// message, which names the place in the model.
export async function fetchModel(url, options) {
  const { onProgress } = options;
  const base = new URL(url, document.baseURI);
  const file = await fetchFile(base.href, { ...options, onProgress: (share) => onProgress(0.9 * share) });
  const name = decode(base.pathname.split('/').pop() || 'model');
  if (!/^https?:$|^file:$/.test(base.protocol) || !TEXT.test(name)) {
    onProgress(1);
    return [{ path: base.protocol === 'data:' ? 'model' : name, file }];
  }
  const first = relatedTo(name, await file.text());
  const root = new URL('../'.repeat(climb(first)) || '.', base);
  const pathOf = (address) => decode(address.pathname.slice(root.pathname.length));
  const files = [{ path: pathOf(base), file }];
  const seen = new Set([base.href]);
  const follow = (uris, from) => Promise.all(uris.map(async (uri) => {
    const address = new URL(uri.replace(/\\/g, '/'), from);
    if (seen.has(address.href) || !address.href.startsWith(root.href)) return;
    seen.add(address.href);
    try {
      const found = await fetchFile(address.href, { ...options, onProgress: () => {} });
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
