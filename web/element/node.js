// node.js - facet in Node.js 18 and newer: tools.js with facet-command.wasm from the disk, and helpers for files. Rendering on the
// CPU comes with a path tracer that needs no Embree; until then only pages draw.
import { readFile } from 'node:fs/promises';
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

export { FacetError };
