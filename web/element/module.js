// module.js - viewer.wasm for JavaScript: the functions of viewer.c with strings, bytes and JSON converted, and their errors thrown.
import { Codecs } from './codecs.js';
import createViewer from './viewer.js';
import { FacetError } from './error.js';

const EXIT_CODES = [0, 2, 3, 4, 5, 6, 7, 7, 8, 75, 70]; // of the command, by facet_result
const NO_MEMORY = 7; // facet_result
const TARGET = '!facet'; // the canvas' name for emscripten

// Values that scripts pass may be anything.
function textOf(value) {
  try {
    return String(value);
  } catch {
    throw new FacetError('a text is expected, not an object that has none');
  }
}

function jsonOf(value, what) {
  if (value === null || typeof value !== 'object') throw new FacetError(`${what}: an object is expected, not ${textOf(value)}`);
  try {
    return JSON.stringify(value);
  } catch (error) {
    throw new FacetError(`${what}: it cannot be written as JSON (${textOf(error.message).split('\n')[0]})`);
  }
}

function checkIndex(value, what) {
  if (!Number.isInteger(value) || value < 0 || value > 0x7fffffff) throw new FacetError(`${what}: a whole number from 0 is expected, not ${textOf(value)}`);
}

// What leaves the module in an unknown state: an abort, a trap, a stack that overflowed, or what is no error of JavaScript.
function hasStopped(error) {
  return !(error instanceof Error) || error instanceof WebAssembly.RuntimeError || error.name === 'ExitStatus' || /stack|recursion/i.test(error.message);
}

class Memory {
  constructor(wasm) {
    this.wasm = wasm;
  }

  allocate(size) {
    const at = this.wasm._malloc(Math.max(size, 1));
    if (!at) throw new FacetError(`there is no memory for ${size} bytes`, EXIT_CODES[NO_MEMORY]);
    return at;
  }

  // Calls use(address) with room for size bytes.
  room(size, use) {
    const at = this.allocate(size);
    try {
      return use(at);
    } finally {
      this.wasm._free(at);
    }
  }

  // Calls use(address) with a string of C; null is the address 0.
  text(text, use) {
    if (text === null || text === undefined) return use(0);
    const string = textOf(text);
    const size = 4 * string.length + 1;
    return this.room(size, (at) => {
      this.wasm.stringToUTF8(string, at, size);
      return use(at);
    });
  }

  copy(bytes) {
    const at = this.allocate(bytes.length);
    this.wasm.HEAPU8.set(bytes, at);
    return at;
  }

  read(at, size) {
    return this.wasm.HEAPU8.slice(at, at + size);
  }

  pointer(at) {
    return new DataView(this.wasm.HEAPU8.buffer).getUint32(at, true);
  }

  doubles(at, count) {
    const view = new DataView(this.wasm.HEAPU8.buffer);
    return Array.from({ length: count }, (_, i) => view.getFloat64(at + 8 * i, true));
  }

  setDoubles(at, values) {
    const view = new DataView(this.wasm.HEAPU8.buffer);
    values.forEach((value, i) => view.setFloat64(at + 8 * i, value, true));
  }
}

export class Module {
  #wasm;
  #memory;
  #isLost = false;

  // codecs: the decoders that its files may need
  constructor(wasm, codecs) {
    this.#wasm = wasm;
    this.codecs = codecs;
    this.#memory = new Memory(wasm);
  }

  // ---- calls ----

  // After an abort, mostly for want of memory, nothing in the module can be trusted: every later call throws, too. A value that cannot be
  // converted is no such matter.
  #call(use) {
    if (this.#isLost) throw new FacetError('facet has stopped; it has to be loaded again');
    try {
      return use();
    } catch (error) {
      if (error instanceof FacetError || !hasStopped(error)) throw error;
      this.#isLost = true;
      throw new FacetError(`facet has stopped (${error.message ?? error}); probably there was not enough memory`);
    }
  }

  #lastError(code) {
    return new FacetError(this.#wasm.UTF8ToString(this.#wasm._facet_web_error()), EXIT_CODES[code]);
  }

  #check(use) {
    this.#call(() => {
      const code = use();
      if (code !== 0) throw this.#lastError(code);
    });
  }

  // A text that C has allocated.
  #take(use) {
    return this.#call(() => {
      const at = use();
      if (!at) throw this.#lastError(NO_MEMORY);
      const text = this.#wasm.UTF8ToString(at);
      this.#wasm._free(at);
      return text;
    });
  }

  // True after an abort: load another module; this one is of no use.
  get isLost() {
    return this.#isLost;
  }

  get memorySize() {
    return this.#wasm.HEAPU8.length;
  }

  // ---- the context ----

  // Once: all viewers draw into this canvas, HTML's or an OffscreenCanvas.
  start(canvas) {
    this.#wasm.specialHTMLTargets[TARGET] = canvas;
    this.#check(() => this.#memory.text(TARGET, (at) => this.#wasm._facet_web_start(at)));
  }

  // The browser has taken WebGL away, and given it back.
  lose() {
    this.#call(() => this.#wasm._facet_web_lose());
  }

  restore() {
    this.#check(() => this.#wasm._facet_web_restore());
  }

  // ---- files: bytes by path, for all viewers ----

  putFile(path, bytes) {
    this.#check(() => {
      const at = this.#memory.copy(bytes); // its owner is C
      return this.#memory.text(path, (text) => this.#wasm._facet_web_put_file(text, at, bytes.length));
    });
  }

  removeFiles() {
    this.#call(() => this.#wasm._facet_web_remove_files());
  }

  // Names of the modules with codecs that a model of the files needs.
  listNeeds(path) {
    return JSON.parse(this.#take(() => this.#memory.text(path, (at) => this.#wasm._facet_web_list_needs(at))));
  }

  // ---- viewers: numbers that create() gives ----

  create() {
    return this.#call(() => {
      const viewer = this.#wasm._facet_web_create();
      if (!viewer) throw this.#lastError(NO_MEMORY);
      return viewer;
    });
  }

  destroy(viewer) {
    this.#call(() => this.#wasm._facet_web_destroy(viewer));
  }

  // '': the built-in scene. If it throws, the last model stays.
  open(viewer, path) {
    this.#check(() => this.#memory.text(path, (at) => this.#wasm._facet_web_open(viewer, at)));
  }

  // value null: the default.
  setOption(viewer, name, value) {
    this.#check(() => this.#memory.text(name, (at) => this.#memory.text(value, (text) => this.#wasm._facet_web_set_option(viewer, at, text))));
  }

  getOptions(viewer) {
    return JSON.parse(this.#take(() => this.#wasm._facet_web_get_options(viewer)));
  }

  command(viewer, width, height) {
    return this.#take(() => this.#wasm._facet_web_command(viewer, width, height));
  }

  describe(viewer) {
    return JSON.parse(this.#take(() => this.#wasm._facet_web_describe(viewer)));
  }

  state(viewer) {
    return JSON.parse(this.#take(() => this.#wasm._facet_web_state(viewer)));
  }

  // name: 'masking', 'scattering', 'tone-mapping', 'variant', or '' for one image; position of the divider: 0 to 1.
  compare(viewer, name, position = 0.5) {
    this.#check(() => this.#memory.text(name, (at) => this.#wasm._facet_web_compare(viewer, at, position)));
  }

  // speed: 1 is that of the file; it stays where it is not given.
  play(viewer, plays, speed = NaN) {
    this.#call(() => this.#wasm._facet_web_play(viewer, plays, speed));
  }

  // ---- images ----

  // Into the lower left corner of the canvas. isDraft: faster, with one texture lookup for a pixel.
  draw(viewer, width, height, seconds = 0, isDraft = false) {
    this.#check(() => this.#wasm._facet_web_draw(viewer, width, height, seconds, isDraft));
  }

  // Whether the next frame is to be a draft: slow ones are, while something moves.
  drafts(viewer, isMoving) {
    return this.#call(() => this.#wasm._facet_web_drafts(viewer, isMoving) !== 0);
  }

  isMoving(viewer) {
    return this.#call(() => this.#wasm._facet_web_is_moving(viewer) !== 0);
  }

  // RGBA with straight alpha, rows from the top, of any size.
  readImage(viewer, width, height) {
    return this.#call(() => this.#memory.room(4, (out) => {
      const code = this.#wasm._facet_web_read_image(viewer, width, height, out);
      if (code !== 0) throw this.#lastError(code);
      const at = this.#memory.pointer(out);
      const bytes = this.#memory.read(at, 4 * width * height);
      this.#wasm._free(at);
      return new ImageData(new Uint8ClampedArray(bytes.buffer), width, height);
    }));
  }

  // x, y: pixels of the last frame. null: nothing is there.
  pick(viewer, x, y) {
    return this.#call(() => this.#memory.room(64, (out) => {
      const code = this.#wasm._facet_web_pick(viewer, x, y, out);
      if (code !== 0) throw this.#lastError(code);
      const found = this.#memory.doubles(out, 8);
      return found[0] ? { position: found.slice(1, 4), normal: found.slice(4, 7), material: found[7] } : null;
    }));
  }

  // Where a position is in the last frame.
  project(viewer, position) {
    return this.#call(() => this.#memory.room(56, (at) => {
      this.#memory.setDoubles(at, position);
      const code = this.#wasm._facet_web_project(viewer, at, at + 24);
      if (code !== 0) throw this.#lastError(code);
      const [x, y, depth, isInFront] = this.#memory.doubles(at + 24, 4);
      return { x, y, depth, isInFront: isInFront !== 0 };
    }));
  }

  // ---- materials ----

  // change: part of a glTF material; null takes a texture or an extension away.
  setMaterial(viewer, material, change) {
    checkIndex(material, 'the index of a material');
    const json = jsonOf(change, `material ${material}`);
    this.#check(() => this.#memory.text(json, (at) => this.#wasm._facet_web_set_material(viewer, material, at)));
  }

  // An image as it is in the file.
  getImage(viewer, image) {
    checkIndex(image, 'the index of an image');
    return this.#call(() => this.#memory.room(12, (out) => {
      const code = this.#wasm._facet_web_get_image(viewer, image, out, out + 4, out + 8);
      if (code !== 0) throw this.#lastError(code);
      const [at, size, type] = [0, 4, 8].map((offset) => this.#memory.pointer(out + offset));
      return { bytes: this.#memory.read(at, size), type: this.#wasm.UTF8ToString(type) };
    }));
  }

  // ---- events: true asks for a frame ----

  point(viewer, kind, button, modifiers, x, y) {
    return this.#call(() => this.#wasm._facet_web_point(viewer, kind, button, modifiers, x, y) !== 0);
  }

  key(viewer, key, modifiers) {
    return this.#call(() => this.#wasm._facet_web_key(viewer, key, modifiers) !== 0);
  }

  // ---- the camera: view_rig.h ----

  // A number by the name of view_rig_set_number().
  setMotion(viewer, name, value) {
    this.#check(() => this.#memory.text(name, (at) => this.#wasm._facet_web_set_motion(viewer, at, value)));
  }

  // A text of <model-viewer>'s attributes, by the attribute's name.
  setCamera(viewer, name, text) {
    this.#check(() => this.#memory.text(name, (at) => this.#memory.text(text, (value) => this.#wasm._facet_web_set_camera(viewer, at, value))));
  }

  // To what the texts say, for an image of that size.
  frame(viewer, width, height, keepsDirection) {
    this.#check(() => this.#wasm._facet_web_frame(viewer, width, height, keepsDirection));
  }

  // How the model is framed from now on: as facet render does, or as <model-viewer>.
  setFraming(viewer, isTight) {
    this.#call(() => this.#wasm._facet_web_set_framing(viewer, isTight));
  }

  // Texts of the attributes; the model is to be framed again.
  place(viewer, orientation, scale) {
    this.#check(() => this.#memory.text(orientation, (turn) => this.#memory.text(scale, (size) => this.#wasm._facet_web_place(viewer, turn, size))));
  }

  // dx, dy: pixels of an image of that height.
  turn(viewer, dx, dy, height) {
    this.#call(() => this.#wasm._facet_web_turn(viewer, dx, dy, height));
  }

  pan(viewer, dx, dy, height) {
    this.#call(() => this.#wasm._facet_web_pan(viewer, dx, dy, height));
  }

  // Positive: away.
  zoom(viewer, steps) {
    this.#call(() => this.#wasm._facet_web_zoom(viewer, steps));
  }

  // step: a view_step.
  step(viewer, step, pans, height) {
    this.#call(() => this.#wasm._facet_web_step(viewer, step, pans, height));
  }

  // The camera turns around a point that it shows in its middle.
  setPivot(viewer, point) {
    this.#call(() => this.#memory.room(24, (at) => {
      this.#memory.setDoubles(at, point);
      this.#wasm._facet_web_set_pivot(viewer, at);
    }));
  }

  // null: what camera-target says, from afar.
  setTarget(viewer, point) {
    this.#call(() => this.#memory.room(24, (at) => {
      if (point) this.#memory.setDoubles(at, point);
      this.#wasm._facet_web_set_target(viewer, point ? at : 0);
    }));
  }

  // The camera is where it was going.
  jump(viewer) {
    this.#call(() => this.#wasm._facet_web_jump(viewer));
  }

  // The time of the running animation, s.
  setTime(viewer, seconds) {
    this.#call(() => this.#wasm._facet_web_set_time(viewer, seconds));
  }

  // Angles in rad, fields of view in degrees, lengths in m; low, high: corners of the model.
  getCamera(viewer) {
    return this.#call(() => this.#memory.room(136, (out) => {
      this.#wasm._facet_web_get_camera(viewer, out);
      const all = this.#memory.doubles(out, 17);
      const [azimuth, polar, radius, fov, minFov, maxFov] = all;
      const side = this.#wasm.UTF8ToString(this.#wasm._facet_web_get_side(viewer));
      return { azimuth, polar, radius, fov, minFov, maxFov, target: all.slice(6, 9), turntable: all[9], aspect: all[10], low: all.slice(11, 14), high: all.slice(14), side };
    }));
  }

  // Where a point of a surface is in the last frame, in parts of its size, and whether it faces the camera.
  locate(viewer, position, normal) {
    return this.#call(() => this.#memory.room(80, (at) => {
      this.#memory.setDoubles(at, [...position, ...normal]);
      const code = this.#wasm._facet_web_locate(viewer, at, at + 24, at + 48);
      if (code !== 0) throw this.#lastError(code);
      const [x, y, depth, isFacing] = this.#memory.doubles(at + 48, 4);
      return { x, y, depth, isFacing: isFacing !== 0 };
    }));
  }

  // After a frame: by what to divide the size of the next.
  pace(viewer, isMoving, divisor, seconds) {
    return this.#call(() => this.#wasm._facet_web_pace(viewer, isMoving, divisor, seconds));
  }
}

const carried = new Map();

// The bytes of a .wasm file that the page has inside (facet view --html): no file is fetched then.
export function carry(name, bytes) {
  carried.set(name, bytes);
}

async function readCarried(name) {
  if (!carried.has(name)) throw new Error('the page does not have it');
  return carried.get(name);
}

// What kept viewer.wasm from starting, in place of emscripten's words.
function failureOf(error, address) {
  const text = textOf(error?.message ?? error);
  const why = /content security policy/i.test(text) ? 'the content security policy of the page lacks \'wasm-unsafe-eval\' in script-src'
    : /fetch/i.test(text) ? 'it cannot be fetched; it belongs beside the scripts of facet'
    : /magic word/i.test(text) ? 'the server has another file there, perhaps a web page; it belongs beside the scripts of facet'
    : text.replace(/^Aborted\((.*?)\)*\.? Build with .*$/s, '$1');
  return new FacetError(`${address} does not start: ${why}`);
}

// base: the folder of viewer.wasm; that of this file where it is not given.
export async function loadModule(base) {
  const codecs = new Codecs(carried.size ? { read: readCarried } : {});
  const options = { codecs };
  if (base) options.locateFile = (name) => new URL(name, base).href;
  if (carried.has('viewer.wasm')) options.wasmBinary = carried.get('viewer.wasm');
  let wasm;
  try {
    wasm = await createViewer(options);
  } catch (error) {
    throw failureOf(error, carried.has('viewer.wasm') ? 'viewer.wasm' : new URL('viewer.wasm', base ?? import.meta.url).href);
  }
  return new Module(wasm, codecs);
}

export { FacetError };
