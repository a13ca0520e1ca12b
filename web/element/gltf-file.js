// gltf-file.js - glTF files as JSON and bytes: materials are changed in the JSON, and everything else stays as it is, whatever
// extensions it uses. What a material's members mean is the reader's business (src/io/gltf).
import { FacetError } from './error.js';

const MAGIC = 0x46546c67; // "glTF"
const JSON_CHUNK = 0x4e4f534a;
const BIN_CHUNK = 0x004e4942;
const DEEPEST_EDIT = 32; // glTF's materials need six

const isObject = (value) => value !== null && typeof value === 'object' && !Array.isArray(value);

// ---- checks of the parts that are read here; the rest is the reader's business ----

// The objects of json[name]; none where it is missing.
function listOf(json, name, path) {
  const list = Object.hasOwn(json, name) ? json[name] : [];
  if (!Array.isArray(list)) throw new FacetError(`${path}: ${name}: an array was expected`);
  const odd = list.findIndex((item) => !isObject(item));
  if (odd >= 0) throw new FacetError(`${path}: ${name}[${odd}]: an object was expected`);
  return list;
}

// A count or an offset of bytes.
function sizeOf(value, where) {
  if (!Number.isSafeInteger(value) || value < 0) throw new FacetError(`${where}: an integer of at least 0 was expected`);
  return value;
}

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

function toJson(json, path) {
  try {
    return JSON.stringify(json);
  } catch (error) { // nested too deeply, or too long for a string
    throw new FacetError(`${path}: its JSON cannot be written: ${error.message}`);
  }
}

function writeGlb({ json, chunks }, path) {
  const text = new TextEncoder().encode(toJson(json, path));
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
  try {
    if (!head.endsWith(';base64')) return new TextEncoder().encode(decodeURIComponent(body));
    return Uint8Array.from(atob(body), (letter) => letter.charCodeAt(0));
  } catch {
    throw new FacetError(`${path}: a data URI cannot be decoded`);
  }
}

// The bytes that a uri of the file at path names; null: not among files.
function resolveUri(files, path, uri, where) {
  if (typeof uri !== 'string') throw new FacetError(`${path}: ${where}: uri: a string was expected`);
  if (uri.startsWith('data:')) return decodeDataUri(uri, path);
  let name = uri;
  try {
    name = decodeURIComponent(uri);
  } catch { /* a name with a percent sign */ }
  const base = path.slice(0, path.lastIndexOf('/') + 1);
  const wanted = `${base}${name}`.replace(/(^|\/)\.\//g, '$1');
  if (Object.hasOwn(files, wanted)) return files[wanted];
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
  for (const [i, buffer] of listOf(json, 'buffers', path).entries()) {
    const where = `${path}: buffer ${i}`;
    if (buffer.uri === undefined) {
      places.push({ buffer: 1 + rest.length, offset: 0 });
      rest.push(buffer);
      continue;
    }
    const bytes = resolveUri(files, path, buffer.uri, `buffer ${i}`);
    if (!bytes) throw new FacetError(`${where}: there is no file ${buffer.uri.slice(0, 200)}`);
    const length = sizeOf(buffer.byteLength, `${where}: byteLength`);
    if (length > bytes.length) throw new FacetError(`${where}: ${length} bytes were expected, its file has ${bytes.length}`);
    places.push({ buffer: 0, offset: packing.add(bytes.subarray(0, length)) });
  }
  const move = (view, where) => {
    const place = places[sizeOf(view.buffer, `${where}: buffer`)];
    if (!place) throw new FacetError(`${where}: there is no buffer ${view.buffer}`);
    view.buffer = place.buffer;
    const offset = view.byteOffset === undefined ? 0 : sizeOf(view.byteOffset, `${where}: byteOffset`);
    if (place.offset || offset) view.byteOffset = offset + place.offset;
  };
  for (const [i, view] of listOf(json, 'bufferViews', path).entries()) {
    const where = `${path}: bufferView ${i}`;
    move(view, where);
    for (const extension of Object.values(view.extensions ?? {})) if (isObject(extension) && extension.buffer !== undefined) move(extension, where);
  }
  return rest;
}

// Images of files become views of the buffer; an image whose file is missing keeps its name.
function packImages(json, packing, files, path) {
  for (const [i, image] of listOf(json, 'images', path).entries()) {
    const bytes = image.uri === undefined ? null : resolveUri(files, path, image.uri, `image ${i}`);
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

// Sets an own member, also one of the name "__proto__", which an assignment would take for the prototype.
const setMember = (object, name, value) =>
  Object.defineProperty(object, name, { value, enumerable: true, configurable: true, writable: true });

// A copy of the caller's value, which JSON can hold.
function copyJson(value, where, depth = 0) {
  if (value === null || typeof value === 'string' || typeof value === 'boolean' || Number.isFinite(value)) return value;
  if (typeof value !== 'object') throw new FacetError(`${where}: ${typeof value} ${String(value)} has no place in JSON`);
  if (depth >= DEEPEST_EDIT) throw new FacetError(`${where.slice(0, 100)}..: nested more than ${DEEPEST_EDIT} times`);
  if (Array.isArray(value)) return value.map((item, i) => copyJson(item, `${where}[${i}]`, depth + 1));
  const copy = {};
  for (const [name, member] of Object.entries(value)) {
    if (member !== undefined) setMember(copy, name, copyJson(member, `${where}.${name}`, depth + 1));
  }
  return copy;
}

// Named members replace values, null removes one (RFC 7396).
function merge(target, edit) {
  const merged = isObject(target) ? target : {};
  for (const [name, value] of Object.entries(edit)) {
    if (value === null) delete merged[name];
    else setMember(merged, name, isObject(value) ? merge(Object.hasOwn(merged, name) ? merged[name] : {}, value) : value);
  }
  return merged;
}

function editMaterials(json, edits, path) {
  if (!isObject(edits)) throw new FacetError(`${path}: edits: an object was expected, with parts of materials by their index`);
  const materials = listOf(json, 'materials', path);
  const before = json.extensionsUsed ?? [];
  if (!Array.isArray(before)) throw new FacetError(`${path}: extensionsUsed: an array was expected`);
  const used = new Set(before);
  for (const [index, edit] of Object.entries(edits)) {
    if (!/^(0|[1-9]\d*)$/.test(index) || Number(index) >= materials.length) {
      throw new FacetError(`${path}: there is no material ${index || '""'}; it has ${materials.length}, counted from 0`);
    }
    if (!isObject(edit)) throw new FacetError(`${path}: material ${index}: a part of a glTF material was expected, an object`);
    materials[index] = merge(materials[index], copyJson(edit, `${path}: material ${index}`));
    for (const name of Object.keys(materials[index].extensions ?? {})) used.add(name);
  }
  if (used.size) json.extensionsUsed = [...used];
}

// The glTF file at path in files (path: Uint8Array) with edits ({material index: part of a glTF material}), as .glb.
export function editGltf(files, path, edits) {
  const bytes = files[path];
  const model = isGlb(bytes) ? readGlb(bytes, path) : packGltf(bytes, files, path);
  editMaterials(model.json, edits, path);
  return writeGlb(model, path);
}
