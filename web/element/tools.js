// tools.js - the command `facet` over files in memory, for pages, workers and Node.js: reads, inspects, converts, bakes, compares and
// plots. The work, its options, defaults and sentences are the command's own, compiled to WebAssembly (facet-command.wasm).
import createCommand from './facet-command.js';
import { Codecs } from './codecs.js';
import { FacetError } from './error.js';
import { editGltf, isGlb } from './gltf-file.js';

const READ_ONLY = 0o555; // of a folder
const FOLDER = '/work'; // where files lie in the module's file system
const KEPT_MEMORY = 256 << 20; // bytes; a module that has grown beyond is replaced, since its memory never shrinks
const DEEPEST_NAME = 64; // folders in the name of a file, whose cost grows with their square
const EXIT_NEGATIVE = 1; // the command's answer is "no": images differ, there were warnings with --strict

// ---- a module and its file system ----

// A stream of the command that keeps what is written.
class Sink {
  chunks = [];

  bytes() {
    const all = new Uint8Array(this.chunks.reduce((sum, chunk) => sum + chunk.length, 0));
    let at = 0;
    for (const chunk of this.chunks) {
      all.set(chunk, at);
      at += chunk.length;
    }
    return all;
  }
}

// Replaces a standard stream by operations on bytes: emscripten's own are lines of text.
function replaceStream(FS, number, name, operations) {
  const device = FS.makedev(64, number);
  FS.registerDevice(device, { open() {}, close() {}, ...operations });
  FS.mkdev(`/dev/${name}`, device);
  FS.close(FS.streams[number]);
  FS.open(`/dev/${name}`, number === 0 ? 'r' : 'w'); // takes the lowest free number
}

function connectStreams(module) {
  const streams = { input: new Uint8Array(0), read: 0, sinks: [null, new Sink(), new Sink()] };
  replaceStream(module.FS, 0, 'facet-stdin', {
    read(stream, buffer, offset, length) {
      const part = streams.input.subarray(streams.read, streams.read + length);
      buffer.set(part, offset);
      streams.read += part.length;
      return part.length;
    },
  });
  for (const number of [1, 2]) {
    replaceStream(module.FS, number, number === 1 ? 'facet-stdout' : 'facet-stderr', {
      write(stream, buffer, offset, length) {
        streams.sinks[number].chunks.push(buffer.slice(offset, offset + length));
        return length;
      },
    });
  }
  return streams;
}

// wasm: a compiled WebAssembly.Module.
async function createInstance(wasm, codecs) {
  const module = await new Promise((resolve, reject) => {
    createCommand({
      codecs,
      noExitRuntime: true,
      print() {},
      printErr() {},
      instantiateWasm(imports, receive) {
        WebAssembly.instantiate(wasm, imports).then((instance) => receive(instance, wasm), reject);
        return {};
      },
    }).then(resolve, reject);
  });
  const streams = connectStreams(module);
  closeFolders(module.FS, '/');
  module.FS.mkdir(FOLDER);
  module.FS.chmod('/', READ_ONLY);
  return { module, streams };
}

// What is written outside of FOLDER would stay from run to run: the command is refused, with its own sentence.
function closeFolders(FS, path) {
  for (const name of FS.readdir(path)) {
    const at = `${path === '/' ? '' : path}/${name}`;
    if (name === '.' || name === '..' || at === '/proc' || !FS.isDir(FS.lstat(at).mode)) continue; // nothing is created in /proc
    closeFolders(FS, at);
    FS.chmod(at, READ_ONLY);
  }
}

const isObject = (value) => value !== null && typeof value === 'object' && !Array.isArray(value);

function checkFiles(files) {
  if (!isObject(files)) throw new FacetError('files: an object was expected, with the contents of files by their paths');
}

// Refuses what emscripten's file system cannot hold.
function checkName(path) {
  const parts = path.split('/');
  if (parts.includes('__proto__')) throw new FacetError(`${path.slice(0, 100)}: a file cannot have the name __proto__ here`);
  if (parts.length > DEEPEST_NAME) throw new FacetError(`${path.slice(0, 100)}..: a name with at most ${DEEPEST_NAME - 1} folders was expected`);
}

// A path of the caller as one below FOLDER.
function placeOf(path) {
  checkName(path);
  const parts = path.split('/').filter((part) => part && part !== '.');
  if (!parts.length || path.startsWith('/') || parts.includes('..')) {
    throw new FacetError(`${path || '""'}: the names of files are relative, without ".."`);
  }
  return `${FOLDER}/${parts.join('/')}`;
}

function removeTree(FS, path) {
  for (const name of FS.readdir(path)) {
    if (name === '.' || name === '..') continue;
    const at = `${path}/${name}`;
    if (FS.isDir(FS.lstat(at).mode)) {
      removeTree(FS, at);
      FS.rmdir(at);
    } else {
      FS.unlink(at);
    }
  }
}

const toBytes = (data) => {
  if (typeof data === 'string') return new TextEncoder().encode(data);
  if (ArrayBuffer.isView(data)) return new Uint8Array(data.buffer, data.byteOffset, data.byteLength);
  if (data instanceof ArrayBuffer) return new Uint8Array(data);
  throw new FacetError('the content of a file is a Uint8Array, another view of bytes, an ArrayBuffer or a string');
};

// Files are handed over without a copy: the command replaces files, and does not write into them.
function writeFiles(FS, files) {
  const written = new Map();
  checkFiles(files);
  for (const [path, data] of Object.entries(files)) {
    const place = placeOf(path);
    const bytes = toBytes(data);
    try {
      FS.mkdirTree(place.slice(0, place.lastIndexOf('/')));
      FS.writeFile(place, bytes, { canOwn: true });
    } catch {
      throw new FacetError(`${path}: files has this path, or a part of it, as a file and as a folder`);
    }
    written.set(place, bytes);
  }
  return written;
}

// Whether the command has left the file as it was handed over: it still lies in the bytes of the caller.
function isUntouched(FS, at, bytes) {
  if (!bytes) return false;
  const { contents, usedBytes } = FS.lookupPath(at).node;
  return bytes.length === 0 ? usedBytes === 0 : contents.buffer === bytes.buffer && contents.byteOffset === bytes.byteOffset;
}

// What was written, as [path relative to FOLDER, bytes].
function collectFiles(FS, written, path = FOLDER, found = []) {
  for (const name of FS.readdir(path)) {
    if (name === '.' || name === '..') continue;
    const at = `${path}/${name}`;
    if (FS.isDir(FS.stat(at).mode)) collectFiles(FS, written, at, found);
    else if (!isUntouched(FS, at, written.get(at))) found.push([at.slice(FOLDER.length + 1), FS.readFile(at)]);
  }
  return found;
}

// Calls main() with text arguments. Returns the exit code.
function callMain(module, args) {
  const texts = ['facet', ...args].map((text) => new TextEncoder().encode(text));
  const table = module._malloc(4 * (texts.length + 1) + texts.reduce((sum, text) => sum + text.length + 1, 0));
  let at = table + 4 * (texts.length + 1);
  texts.forEach((text, i) => {
    module.HEAPU32[(table >> 2) + i] = at;
    module.HEAPU8.set(text, at);
    module.HEAPU8[at + text.length] = 0;
    at += text.length + 1;
  });
  module.HEAPU32[(table >> 2) + texts.length] = 0;
  try {
    return module._main(texts.length, table);
  } finally {
    module._free(table);
  }
}

// ---- options ----

const kebab = (name) => name.replace(/[A-Z]/g, (letter) => `-${letter.toLowerCase()}`);

// A word of the command line, which may name a file.
function toText(value, what) {
  if (typeof value !== 'number' && typeof value !== 'string') throw new FacetError(`${what}: a string or a number was expected`);
  const text = String(value);
  checkName(text);
  return text;
}

// {maxTexture: 512, 'no-tangents': true, angle: [0, 30]} as --max-texture=512 --no-tangents --angle=0,30.
function optionsToArgs(options) {
  if (!isObject(options)) throw new FacetError('options: an object was expected, with values by the long names of options');
  const args = [];
  for (const [name, value] of Object.entries(options)) {
    if (value === undefined || value === null || value === false) continue;
    const text = Array.isArray(value) ? value.join(',') : value;
    args.push(value === true ? `--${kebab(name)}` : `--${kebab(name)}=${toText(text, name)}`);
  }
  return args;
}

// The command's sentence, without the warnings before it.
function sentenceOf(result) {
  const lines = result.stderr.trim().split('\n');
  return lines[lines.length - 1].replace(/^facet: /, '') || `facet ended with exit code ${result.code}`;
}

function check(result, isNegativeAllowed = false) {
  if (result.code === 0 || (isNegativeAllowed && result.code === EXIT_NEGATIVE)) return result;
  throw new FacetError(sentenceOf(result), result.code);
}

const warningsOf = (result) => result.stderr.split('\n').filter((line) => line);

// ---- the tools ----

class Tools {
  #wasm;
  #codecs;
  #instance = null; // kept from run to run
  #queue = Promise.resolve();

  constructor(wasm, codecs) {
    this.#wasm = wasm;
    this.#codecs = codecs;
  }

  // Runs the command with words as of a shell: run(['convert', 'a.obj', '-o', 'b.glb'], {'a.obj': bytes}). files are all that it
  // can read; stdin is what "-" reads. Never throws because of its exit code.
  run(args, files = {}, { stdin } = {}) {
    const result = this.#queue.then(() => this.#runWithCodecs(args, files, stdin));
    this.#queue = result.catch(() => {});
    return result;
  }

  // A command that lacked decoders runs again when they are loaded; what cannot be loaded is in its sentence.
  async #runWithCodecs(args, files, stdin) {
    if (!Array.isArray(args)) throw new FacetError('args: an array of words was expected, as ["inspect", "a.glb"]');
    const words = args.map((word, i) => toText(word, `args[${i}]`));
    for (let tried = []; ; ) {
      const result = await this.#run(words, files, stdin);
      const missing = this.#codecs.takeMissing().filter((name) => !tried.includes(name));
      if (!missing.length) return result;
      await this.#codecs.load(missing);
      tried = tried.concat(missing);
    }
  }

  async #run(args, files, stdin) {
    this.#instance ??= await createInstance(this.#wasm, this.#codecs);
    const { module, streams } = this.#instance;
    const { FS } = module;
    streams.input = stdin === undefined ? new Uint8Array(0) : toBytes(stdin);
    streams.read = 0;
    streams.sinks[1].chunks = [];
    streams.sinks[2].chunks = [];
    let isSound = false;
    FS.chdir(FOLDER);
    try {
      const written = writeFiles(FS, files);
      const code = this.#call(module, args);
      isSound = true;
      const [out, err] = [streams.sinks[1].bytes(), streams.sinks[2].bytes()];
      const text = (bytes) => new TextDecoder().decode(bytes);
      const result = { code, stdoutBytes: out, stderr: text(err), files: Object.fromEntries(collectFiles(FS, written)) };
      Object.defineProperty(result, 'stdout', { enumerable: true, get: () => text(out) });
      removeTree(FS, FOLDER);
      return result;
    } finally {
      if (!isSound || module.HEAPU8.length > KEPT_MEMORY) this.#instance = null;
    }
  }

  #call(module, args) {
    try {
      return callMain(module, args);
    } catch (error) {
      if (error.name === 'ExitStatus') return error.status;
      throw new FacetError(`facet ${args[0]}: WebAssembly stopped (${error.message}); probably there was not enough memory`);
    }
  }

  async version() {
    return (await this.run(['version'])).stdout.trim().replace('facet ', '');
  }

  // `facet inspect --json`: what is in the model at path, with the warnings of reading.
  async inspect(files, path, options = {}) {
    const result = check(await this.run(['inspect', path, '--json', ...optionsToArgs(options)], files), true);
    return JSON.parse(result.stdout);
  }

  // `facet convert path -o options.output`: the new files, and the command's warnings. A report named by options is among the files.
  async convert(files, path, options = {}) {
    const result = check(await this.run(['convert', path, ...optionsToArgs(options)], files), true);
    return { files: result.files, warnings: warningsOf(result) };
  }

  // `facet bake path`: the filtered cube map or what options name (`output`, `dfg`, `sh`, `layout`). path null: without an environment, as for --dfg.
  async bake(files, path, options = {}) {
    const result = check(await this.run(['bake', ...(path ? [path] : []), ...optionsToArgs(options)], files), true);
    return { files: result.files, warnings: warningsOf(result) };
  }

  // `facet compare a b --json`: the metrics of two images.
  async compare(files, a, b, options = {}) {
    const result = check(await this.run(['compare', a, b, '--json', ...optionsToArgs(options)], files), true);
    return { ...JSON.parse(result.stdout), files: result.files };
  }

  // `facet plot kind` with materials ("roughness=0.3,metallic=1"): {svg, fits}, the drawing and the fits of the other model.
  async plot(kind, materials = [], options = {}, files = {}) {
    const args = ['plot', kind, ...materials, '--output=plot.svg', '--json', ...optionsToArgs(options)];
    const result = check(await this.run(args, files));
    return { svg: new TextDecoder().decode(result.files['plot.svg']), fits: JSON.parse(result.stdout).fits };
  }

  // The numbers of the same plot: panels with their curves, and where they are in the drawing (`facet plot --format json`).
  async plotData(kind, materials = [], options = {}, files = {}) {
    const args = ['plot', kind, ...materials, '--output=-', '--format=json', ...optionsToArgs(options)];
    return JSON.parse(check(await this.run(args, files)).stdout);
  }

  // The model at path as .glb, with edits of materials ({index: part of a glTF material}, whose members replace values). Of a glTF
  // file everything else stays as it is; other formats are converted first. The reader checks the result.
  async save(files, path, edits = {}) {
    checkFiles(files);
    let all = Object.fromEntries(Object.entries(files).map(([name, data]) => [name, toBytes(data)]));
    let name = path;
    if (!Object.hasOwn(all, path)) throw new FacetError(`${String(path)}: there is no such file`);
    if (!/\.gltf$/i.test(path) && !isGlb(all[path])) {
      name = `${path.replace(/^.*\//, '').replace(/\.[^.]*$/, '')}.glb`;
      all = (await this.convert(all, path, { output: name })).files;
    }
    const bytes = editGltf(all, name, edits);
    const saved = name.replace(/\.[^.]*$/, '.glb');
    check(await this.run(['inspect', saved, '--quiet'], { [saved]: bytes }), true);
    return bytes;
  }
}

let compiled = null; // of the wasm beside this file

async function compileDefault() {
  const response = await fetch(new URL('./facet-command.wasm', import.meta.url));
  if (!response.ok) throw new FacetError(`facet-command.wasm: the server answered ${response.status}`);
  return WebAssembly.compile(await response.arrayBuffer());
}

// wasm: bytes or a compiled module in place of facet-command.wasm beside this file. codecs: where decoders come from (codecs.js).
// Each Tools runs one command at a time.
export async function loadTools({ wasm, codecs = new Codecs() } = {}) {
  if (wasm instanceof WebAssembly.Module) return new Tools(wasm, codecs);
  if (wasm) return new Tools(await WebAssembly.compile(wasm), codecs);
  compiled ??= compileDefault();
  compiled.catch(() => { compiled = null; });
  return new Tools(await compiled, codecs);
}

export { FacetError };
