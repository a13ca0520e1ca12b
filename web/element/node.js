// node.js - facet in Node.js 18 and newer: tools.js with facet-command.wasm from the disk, and helpers for files. Rendering on the
// CPU comes with a path tracer that needs no Embree; until then only pages draw.
import { mkdir, readdir, readFile, writeFile } from 'node:fs/promises';
import { dirname, join } from 'node:path';
import { Codecs } from './codecs.js';
import { loadTools as load, FacetError } from './tools.js';

const fromDisk = (file) => readFile(new URL(file, import.meta.url));

let compiled = null;

export async function loadTools(options = {}) {
  const codecs = new Codecs({ read: fromDisk });
  if (options.wasm) return load({ codecs, ...options });
  compiled ??= fromDisk('./facet-command.wasm').then((bytes) => WebAssembly.compile(bytes));
  return load({ codecs, wasm: await compiled, ...options });
}

// All files in and below folder, by their paths in it: what a model of several files needs. only: a test of a path.
export async function readFolder(folder, only = () => true, path = '') {
  const files = {};
  for (const entry of await readdir(join(folder, path), { withFileTypes: true })) {
    const name = path ? `${path}/${entry.name}` : entry.name;
    if (entry.isDirectory()) Object.assign(files, await readFolder(folder, only, name));
    else if (entry.isFile() && only(name)) files[name] = await readFile(join(folder, name));
  }
  return files;
}

// Writes files below folder, as the tools return them; missing folders are made.
export async function writeFiles(folder, files) {
  for (const [path, bytes] of Object.entries(files)) {
    await mkdir(dirname(join(folder, path)), { recursive: true });
    await writeFile(join(folder, path), bytes);
  }
}

export { FacetError };
