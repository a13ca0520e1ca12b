// codecs.js - decoders that are fetched when a file needs them. Each is a WebAssembly module of its own with a memory of its own
// (codecs.cmake), which the viewer's C calls (module/codec_client.c). An instance that fails is dropped; the next file has a new
// one. AVIF is decoded by the browser. Works without a document, too.

const LARGE_MEMORY = 64 * 2 ** 20; // bytes; instances with more are not kept
const PICTURES = 512 * 2 ** 20; // bytes of decoded AVIF images that are kept, the newest

/** Reads a file beside this one. report(loaded, total): bytes; total is 0 if unknown. */
async function fetchBytes(file, report) {
  const response = await fetch(new URL(file, import.meta.url));
  if (!response.ok) throw new Error(`the server answers ${response.status}`);
  const total = Number(response.headers.get('content-length')) || 0;
  const parts = [];
  let loaded = 0;
  for (const reader = response.body.getReader(); ; ) {
    const { done, value } = await reader.read();
    if (done) break;
    parts.push(value);
    loaded += value.length;
    report(loaded, total);
  }
  return new Blob(parts).arrayBuffer();
}

function isSame(a, b) {
  if (a.length !== b.length) return false;
  for (let i = 0; i < a.length; i++) if (a[i] !== b[i]) return false;
  return true;
}

function readText(memory, address) {
  const bytes = new Uint8Array(memory.buffer);
  return new TextDecoder().decode(bytes.slice(address, bytes.indexOf(0, address)));
}

// The functions that a module imports; of WASI nothing but an empty environment is there.
function importsOf(module, getMemory) {
  const known = {
    codec_throw: (message) => {
      throw new Error(readText(getMemory(), message));
    },
    emscripten_notify_memory_growth: () => {},
    environ_sizes_get: (count, size) => {
      const view = new DataView(getMemory().buffer);
      view.setUint32(count, 0, true);
      view.setUint32(size, 0, true);
      return 0;
    },
    environ_get: () => 0,
  };
  const imports = {};
  for (const { module: space, name } of WebAssembly.Module.imports(module)) {
    imports[space] ??= {};
    imports[space][name] = known[name] ?? (() => {
      throw new Error(`the decoder stopped in ${name}`);
    });
  }
  return imports;
}

function instantiate(module) {
  const instance = new WebAssembly.Instance(module, importsOf(module, () => instance.exports.memory));
  instance.exports._initialize();
  return instance.exports;
}

// ---- AVIF ----

function readTexels(bitmap) {
  const { width, height } = bitmap;
  const gl = new OffscreenCanvas(1, 1).getContext('webgl2');
  if (!gl) throw new Error('there is no WebGL 2 to read it with');
  if (Math.max(width, height) > gl.getParameter(gl.MAX_TEXTURE_SIZE)) throw new Error(`${width} x ${height} texels are too many for this browser`);
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, bitmap);
  gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, gl.getParameter(gl.TEXTURE_BINDING_2D), 0);
  const texels = new Uint8Array(width * height * 4);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, texels);
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return texels;
}

/** The texels of an image as the file has them: 8 bits, straight alpha, no conversion of colors. */
async function decodePicture(bytes) {
  if (typeof createImageBitmap === 'undefined') throw new Error('only a browser decodes it');
  const options = { colorSpaceConversion: 'none', premultiplyAlpha: 'none' };
  const bitmap = await createImageBitmap(new Blob([bytes], { type: 'image/avif' }), options).catch(() => {
    throw new Error('this browser does not read the image');
  });
  const { width, height } = bitmap;
  try {
    return { width, height, texels: readTexels(bitmap) };
  } finally {
    bitmap.close();
  }
}

/** The decoders of one viewer module: createFacet({ codecs: new Codecs() }). */
export class Codecs {
  #modules = new Map(); // name -> WebAssembly.Module
  #failures = new Map(); // name -> why there is none
  #loads = new Map(); // name -> promise
  #current = new Map(); // name -> the instance that new calls use
  #instances = new Map(); // number -> instance
  #lastNumber = 0;
  #pictures = []; // { bytes, width, height, texels } or { bytes, failure }
  #missing = new Set();
  #fetchBytes;

  /** read(file, report) -> bytes of codec_NAME.wasm; without it they are fetched beside this file. */
  constructor({ read = fetchBytes } = {}) {
    this.#fetchBytes = read;
  }

  /** Loads decoders by name ("draco", "webp", "avif", "exr", "zstd"). A failure is no error here: the file that needs the decoder has the
   *  sentence. report(fraction): progress. */
  async load(names, report = () => {}) {
    const fractions = new Map(names.map((name) => [name, 0]));
    const add = (name, fraction) => {
      fractions.set(name, fraction);
      report([...fractions.values()].reduce((a, b) => a + b, 0) / names.length);
    };
    await Promise.all(names.map((name) => (name === 'avif' ? this.#decodePictures() : this.#load(name, (x) => add(name, x))).then(() => add(name, 1))));
    for (const name of names) this.#missing.delete(name);
  }

  /** Names of decoders that files wanted since the last call and that were not there: load them and open the file again. */
  takeMissing() {
    const names = [...this.#missing];
    this.#missing.clear();
    return names;
  }

  /** Names of the decoders that are there. */
  get names() {
    return [...this.#modules.keys()];
  }

  #load(name, report) {
    if (this.#modules.has(name)) return Promise.resolve();
    if (!this.#loads.has(name)) this.#loads.set(name, this.#fetch(name, report).finally(() => this.#loads.delete(name)));
    return this.#loads.get(name);
  }

  async #fetch(name, report) {
    const file = `codec_${name}.wasm`;
    try {
      const bytes = await this.#fetchBytes(file, (loaded, total) => report(total ? Math.min(1, loaded / total) : 0));
      this.#modules.set(name, await WebAssembly.compile(bytes));
      this.#failures.delete(name);
    } catch (error) {
      this.#failures.set(name, `${file} could not be loaded: ${error.message}`);
    }
  }

  async #decodePictures() {
    for (const picture of this.#pictures)
      if (!picture.texels && !picture.failure)
        Object.assign(picture, await decodePicture(picture.bytes).catch((error) => ({ failure: error.message })));
    let kept = 0;
    const newest = [...this.#pictures].reverse().filter(({ texels }) => (kept += texels?.length ?? 0) <= PICTURES);
    this.#pictures = newest.reverse();
  }

  // ---- called by C ----

  open(name) {
    let instance = this.#current.get(name);
    if (!instance) {
      const module = this.#modules.get(name);
      if (!module) {
        this.#missing.add(name);
        return 0;
      }
      try {
        instance = { name, number: ++this.#lastNumber, users: 0, failure: null, exports: instantiate(module) };
      } catch (error) {
        this.#failures.set(name, `the decoder does not start: ${error.message}`);
        return 0;
      }
      this.#current.set(name, instance);
      this.#instances.set(instance.number, instance);
    }
    instance.users++;
    return instance.number;
  }

  close(number) {
    const instance = this.#instances.get(number);
    if (--instance.users > 0) return;
    const isCurrent = this.#current.get(instance.name) === instance;
    if (isCurrent && instance.exports.memory.buffer.byteLength <= LARGE_MEMORY) return;
    if (isCurrent) this.#current.delete(instance.name);
    this.#instances.delete(number);
  }

  memoryOf(number) {
    return new Uint8Array(this.#instances.get(number).exports.memory.buffer);
  }

  // The result as 32 unsigned bits; null: the instance has failed.
  call(number, name, values) {
    const instance = this.#instances.get(number);
    if (instance.failure) return null;
    try {
      return instance.exports[name](...values) >>> 0;
    } catch (error) {
      const isTrap = error instanceof WebAssembly.RuntimeError;
      instance.failure = isTrap ? `the decoder stopped (${error.message})` : error.message;
      if (this.#current.get(instance.name) === instance) this.#current.delete(instance.name);
      return null;
    }
  }

  explain(name, number) {
    if (number) return this.#instances.get(number).failure ?? 'the decoder failed';
    return this.#failures.get(name) ?? 'its decoder was not loaded';
  }

  findPicture(bytes) {
    const found = this.#pictures.find((picture) => isSame(picture.bytes, bytes));
    return found?.texels ? found : null;
  }

  offerPicture(bytes) {
    const found = this.#pictures.find((picture) => isSame(picture.bytes, bytes));
    if (found?.failure) this.#failures.set('avif', found.failure);
    if (found) return;
    this.#pictures.push({ bytes });
    this.#failures.delete('avif');
    this.#missing.add('avif');
  }
}
