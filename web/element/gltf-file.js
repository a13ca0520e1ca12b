// gltf-file.js - glTF files as JSON and bytes: materials are changed in the JSON, and everything else stays as it is, whatever
// extensions it uses. What a material's members mean is the reader's business (src/io/gltf).
import { FacetError } from './error.js';

const MAGIC = 0x46546c67; // "glTF"
const JSON_CHUNK = 0x4e4f534a;
const BIN_CHUNK = 0x004e4942;

// ---- GLB ----

export const isGlb = (bytes) => bytes.length >= 12 && viewOf(bytes).getUint32(0, true) === MAGIC;

const viewOf = (bytes) => new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);

function parseJson(bytes, path) {
  try {
    const json = JSON.parse(new TextDecoder().decode(bytes));
    if (json && typeof json === 'object' && !Array.isArray(json)) return json;
  } catch (error) {
    throw new FacetError(`${path}: its JSON cannot be read: ${error.message}`);
  }
  throw new FacetError(`${path}: a JSON object was expected`);
}

// {json, chunks}: the other chunks in their order, as {type, bytes}.
function readGlb(bytes, path) {
  const view = viewOf(bytes);
  const chunks = [];
  for (let at = 12; at + 8 <= bytes.length;) {
    const length = view.getUint32(at, true);
    if (length > bytes.length - at - 8) throw new FacetError(`${path}: a chunk of ${length} bytes is past the end of the file`);
    chunks.push({ type: view.getUint32(at + 4, true), bytes: bytes.subarray(at + 8, at + 8 + length) });
    at += 8 + length;
  }
  if (view.getUint32(4, true) !== 2 || chunks[0]?.type !== JSON_CHUNK) {
    throw new FacetError(`${path}: a glTF file of version 2 was expected, with its JSON in the first chunk`);
  }
  return { json: parseJson(chunks[0].bytes, path), chunks: chunks.slice(1) };
}

const padded = (length) => (length + 3) & ~3;

function writeGlb({ json, chunks }) {
  const text = new TextEncoder().encode(JSON.stringify(json));
  const all = [{ type: JSON_CHUNK, bytes: text, fill: 0x20 }, ...chunks];
  const size = all.reduce((sum, { bytes }) => sum + 8 + padded(bytes.length), 12);
  const out = new Uint8Array(size);
  const view = viewOf(out);
  view.setUint32(0, MAGIC, true);
  view.setUint32(4, 2, true);
  view.setUint32(8, size, true);
  let at = 12;
  for (const { type, bytes, fill = 0 } of all) {
    const length = padded(bytes.length);
    view.setUint32(at, length, true);
    view.setUint32(at + 4, type, true);
    out.set(bytes, at + 8);
    out.fill(fill, at + 8 + bytes.length, at + 8 + length);
    at += 8 + length;
  }
  return out;
}

// ---- .gltf with its files ----

function decodeDataUri(uri, path) {
  const [head, body] = [uri.slice(0, uri.indexOf(',')), uri.slice(uri.indexOf(',') + 1)];
  if (!head.endsWith(';base64')) return new TextEncoder().encode(decodeURIComponent(body));
  try {
    return Uint8Array.from(atob(body), (letter) => letter.charCodeAt(0));
  } catch {
    throw new FacetError(`${path}: a data URI is no valid base64`);
  }
}

// The bytes that a uri of the file at path names; null: not among files.
function resolveUri(files, path, uri) {
  if (uri.startsWith('data:')) return decodeDataUri(uri, path);
  let name = uri;
  try {
    name = decodeURIComponent(uri);
  } catch { /* a name with a percent sign */ }
  const base = path.slice(0, path.lastIndexOf('/') + 1);
  const wanted = `${base}${name}`.replace(/(^|\/)\.\//g, '$1');
  if (files[wanted]) return files[wanted];
  const near = Object.keys(files).find((known) => known.toLowerCase() === wanted.toLowerCase());
  return near ? files[near] : null;
}

const IMAGE_TYPES = [
  ['image/png', [0x89, 0x50, 0x4e, 0x47]], ['image/jpeg', [0xff, 0xd8, 0xff]], ['image/ktx2', [0xab, 0x4b, 0x54, 0x58]],
  ['image/webp', [0x52, 0x49, 0x46, 0x46]], ['image/avif', [0, 0, 0]],
];
const typeOfImage = (bytes) => IMAGE_TYPES.find(([, start]) => start.every((byte, i) => bytes[i] === byte))?.[0];

// Parts of one buffer, each at a multiple of 4.
class Packing {
  parts = [];
  length = 0;

  add(bytes) {
    const at = this.length;
    this.parts.push([at, bytes]);
    this.length = at + padded(bytes.length);
    return at;
  }

  bytes() {
    const all = new Uint8Array(this.length);
    for (const [at, bytes] of this.parts) all.set(bytes, at);
    return all;
  }
}

// All buffers in one. Those without bytes, which extensions decode into, stay behind it.
function packBuffers(json, packing, files, path) {
  const places = [];
  const rest = [];
  for (const [i, buffer] of (json.buffers ?? []).entries()) {
    if (buffer.uri === undefined) {
      places.push({ buffer: 1 + rest.length, offset: 0 });
      rest.push(buffer);
      continue;
    }
    const bytes = resolveUri(files, path, buffer.uri);
    if (!bytes) throw new FacetError(`${path}: buffer ${i}: there is no file ${buffer.uri.slice(0, 200)}`);
    places.push({ buffer: 0, offset: packing.add(bytes.subarray(0, buffer.byteLength)) });
  }
  const move = (view) => {
    const place = places[view.buffer];
    if (!place) throw new FacetError(`${path}: there is no buffer ${view.buffer}`);
    view.buffer = place.buffer;
    if (place.offset || view.byteOffset) view.byteOffset = (view.byteOffset ?? 0) + place.offset;
  };
  for (const view of json.bufferViews ?? []) {
    move(view);
    for (const extension of Object.values(view.extensions ?? {})) if (extension.buffer !== undefined) move(extension);
  }
  return rest;
}

// Images of files become views of the buffer; an image whose file is missing keeps its name.
function packImages(json, packing, files, path) {
  for (const image of json.images ?? []) {
    const bytes = image.uri === undefined ? null : resolveUri(files, path, image.uri);
    if (!bytes) continue;
    json.bufferViews ??= [];
    const type = typeOfImage(bytes);
    if (type) image.mimeType = type;
    delete image.uri;
    image.bufferView = json.bufferViews.push({ buffer: 0, byteOffset: packing.add(bytes), byteLength: bytes.length }) - 1;
  }
}

// A .gltf with its files, as readGlb() returns it.
function packGltf(bytes, files, path) {
  const json = parseJson(bytes, path);
  const packing = new Packing();
  const rest = packBuffers(json, packing, files, path);
  packImages(json, packing, files, path);
  if (!packing.length && !rest.length) return { json, chunks: [] };
  json.buffers = [{ byteLength: packing.length || 4 }, ...rest];
  return { json, chunks: [{ type: BIN_CHUNK, bytes: packing.length ? packing.bytes() : new Uint8Array(4) }] };
}

// ---- materials ----

const isObject = (value) => value !== null && typeof value === 'object' && !Array.isArray(value);

// Named members replace values, null removes one (RFC 7396).
function merge(target, edit) {
  const merged = isObject(target) ? target : {};
  for (const [name, value] of Object.entries(edit)) {
    if (value === null) delete merged[name];
    else merged[name] = isObject(value) ? merge(merged[name], value) : value;
  }
  return merged;
}

function editMaterials(json, edits, path) {
  const count = json.materials?.length ?? 0;
  const used = new Set(json.extensionsUsed);
  for (const [index, edit] of Object.entries(edits)) {
    if (!(Number(index) < count)) throw new FacetError(`${path}: there is no material ${index}; it has ${count}, counted from 0`);
    if (!isObject(edit)) throw new FacetError(`${path}: material ${index}: a part of a glTF material was expected, an object`);
    json.materials[index] = merge(json.materials[index], edit);
    for (const name of Object.keys(json.materials[index].extensions ?? {})) used.add(name);
  }
  if (used.size) json.extensionsUsed = [...used];
}

// The glTF file at path in files (path: Uint8Array) with edits ({material index: part of a glTF material}), as .glb.
export function editGltf(files, path, edits) {
  const bytes = files[path];
  const model = isGlb(bytes) ? readGlb(bytes, path) : packGltf(bytes, files, path);
  editMaterials(model.json, edits, path);
  return writeGlb(model);
}
