// node.js - facet in Node.js 18 and newer: tools.js with facet-command.wasm from the disk, and helpers for files. Rendering on the
// CPU comes with a path tracer that needs no Embree; until then only pages draw.
import { readFile } from 'node:fs/promises';
import { loadTools as load, FacetError } from './tools.js';

let compiled = null;

export async function loadTools(options = {}) {
  if (options.wasm) return load(options);
  compiled ??= readFile(new URL('./facet-command.wasm', import.meta.url)).then((bytes) => WebAssembly.compile(bytes));
  return load({ wasm: await compiled });
}

export { FacetError };
