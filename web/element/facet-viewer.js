// facet-viewer.js - <facet-viewer>: a glTF, OBJ, STL or PLY model in a page, drawn by facet. Attributes, properties, methods, events and slots
// are those of <model-viewer> 4.4; docs/web.md lists them, and what differs.
import { ATTRIBUTES, defineProperties, propertyOf } from './attributes.js';
import { Animation } from './animation.js';
import { Aria } from './aria.js';
import { Camera } from './camera.js';
import { engine } from './engine.js';
import { facesOf, fileCache, IMAGE, MODEL } from './files.js';
import { Hotspots } from './hotspots.js';
import { Images } from './images.js';
import { Input } from './input.js';
import { Light } from './light.js';
import { Loading } from './loading.js';
import { makeTree } from './template.js';
import { View } from './view.js';

const REMOVAL_MS = 1000; // a moved element keeps its model
const allValues = new WeakMap();
const valuesOf = (element) => {
  if (!allValues.has(element)) allValues.set(element, new Map());
  return allValues.get(element);
};
const vector = ([x, y, z]) => ({ x, y, z, toString() { return `${this.x}m ${this.y}m ${this.z}m`; } });
let mapURL = (url) => url;

export class FacetViewer extends HTMLElement {
  #tree = makeTree(this);
  #context;
  #parts;
  #changed = new Set(Object.keys(ATTRIBUTES));
  #update = null;
  #resize = new ResizeObserver((entries) => this.#fit(entries[entries.length - 1]));
  #removal = 0;
  #message = '';

  static get observedAttributes() { return Object.keys(ATTRIBUTES); }
  static get modelCacheSize() { return fileCache.size; }
  static set modelCacheSize(value) { fileCache.size = value; }
  static get minimumRenderScale() { return engine.minimumRenderScale; }
  static set minimumRenderScale(value) { engine.minimumRenderScale = value > 0 ? Math.min(1, value) : 0.25; }
  // Every address goes through callback before it is fetched.
  static mapURLs(callback) { mapURL = callback; }

  constructor() {
    super();
    const context = {
      element: this,
      tree: this.#tree,
      emit: (type, detail) => this.#emit(type, detail),
      fail: (error, type) => this.#fail(error, type),
      want: () => context.light.want(),
      pick: (x, y) => this.#pick(x, y),
      modelOpened: () => this.#modelOpened(),
      cameraMoved: (side) => context.aria.cameraMoved(side),
    };
    context.view = new View(this.#tree, {
      beforeFrame: (seconds) => context.animation.advance(seconds),
      onFrame: () => this.#frameDrawn(),
      onScale: (scale, reason) => this.#scaled(scale, reason),
      onFail: (error, type) => this.#fail(error, type),
      onReplayed: () => this.#emit('load', { url: this.src }),
    });
    context.aria = new Aria(context);
    context.loading = new Loading(context);
    context.camera = new Camera(context);
    context.input = new Input(context);
    context.light = new Light(context);
    context.animation = new Animation(context);
    context.hotspots = new Hotspots(context);
    context.images = new Images(context);
    this.#context = context;
    this.#parts = [context.aria, context.light, context.camera, context.input, context.animation, context.hotspots, context.loading];
  }

  // ---- life ----

  connectedCallback() {
    clearTimeout(this.#removal);
    this.#upgrade();
    this.#context.view.revive();
    try {
      this.#resize.observe(this, { box: ['device-pixel-content-box'] });
    } catch {
      this.#resize.observe(this); // Safari
    }
    for (const part of this.#parts) part.attach();
    this.requestUpdate();
  }

  disconnectedCallback() {
    this.#resize.disconnect();
    for (const part of this.#parts) part.detach();
    this.#removal = setTimeout(() => {
      this.#context.loading.drop();
      this.#context.view.destroy();
    }, REMOVAL_MS);
  }

  // Properties that scripts set before the element was defined.
  #upgrade() {
    for (const name of Object.keys(ATTRIBUTES)) {
      const property = propertyOf(name);
      if (!Object.hasOwn(this, property)) continue;
      const value = this[property];
      delete this[property];
      this[property] = value;
    }
  }

  attributeChangedCallback(name, _, value) {
    valuesOf(this).set(name, ATTRIBUTES[name].parse(value));
    this.attributeChanged(name);
  }

  attributeChanged(name) {
    this.#changed.add(name);
    this.requestUpdate();
  }

  attributeValue(attribute) { return this[propertyOf(attribute)]; }

  // Changes are applied together, after the script that made them.
  requestUpdate() {
    this.#update ??= Promise.resolve().then(() => this.#apply());
  }

  #apply() {
    this.#update = null;
    if (!this.isConnected) return;
    const changed = this.#changed;
    this.#changed = new Set();
    for (const part of this.#parts) {
      try {
        part.update(changed);
      } catch (error) { // the other parts have their values all the same
        console.warn(`<facet-viewer> ${error.message}`);
      }
    }
  }

  get updateComplete() { return (this.#update ?? Promise.resolve()).then(() => true); }

  #emit(type, detail) { this.dispatchEvent(new CustomEvent(type, { detail })); }

  #fail(error, type) {
    this.#emit('error', { type, message: error.message, sourceError: error });
  }

  #say() {
    const { message } = this.#context.view.state();
    if (message && message !== this.#message) this.#emit('facet-message', { text: message });
    this.#message = message;
  }

  // ---- size and frames ----

  #fit(entry) {
    const scale = window.devicePixelRatio || 1;
    const exact = entry.devicePixelContentBoxSize?.[0];
    const width = exact ? exact.inlineSize : Math.round(entry.contentRect.width * scale);
    const height = exact ? exact.blockSize : Math.round(entry.contentRect.height * scale);
    if (width > 0 && height > 0) this.#context.view.setSize(width, height);
  }

  #frameDrawn() {
    this.#context.camera.frameDrawn();
    this.#context.hotspots.frameDrawn();
    this.#emit('before-render');
  }

  #scaled(scale, reason) {
    const { width, height } = this.#context.view.pixelSize();
    const reportedDpr = window.devicePixelRatio || 1;
    this.#emit('render-scale', {
      reportedDpr, renderedDpr: reportedDpr * scale, minimumDpr: reportedDpr * engine.minimumRenderScale, pixelWidth: width, pixelHeight: height, reason,
    });
  }

  async #modelOpened() {
    const { camera, animation, input, view } = this.#context;
    camera.modelOpened();
    animation.modelOpened();
    queueMicrotask(() => input.resetPrompt(true));
    view.touch();
    this.#say();
  }

  // ---- the model ----

  get loaded() { return this.#context.loading.isLoaded; }
  get modelIsVisible() { return this.#context.loading.isVisible; }
  mapURL(url) { return mapURL(url); }
  dismissPoster() { this.#context.loading.dismissPoster(); }
  showPoster() { this.#context.loading.showPoster(); }

  // files: [{path, file: Blob}]. The first model is shown, or an image becomes the light. Returns the paths of all models.
  async openFiles(files) {
    const models = files.map(({ path }) => path).filter((path) => MODEL.test(path)).sort((a, b) => a.localeCompare(b));
    if (models.length) {
      await this.#open(files, models[0]);
    } else if (files.length === 1 && IMAGE.test(files[0].path)) {
      await this.#context.view.setOptionFile('env', files[0]);
      this.#emit('environment-change');
    } else {
      const [first] = files, faces = facesOf(files);
      if (faces) throw new Error(`${first.path}: facet reads a cube map of six files on the command line only: facet bake "faces:${faces}" -o light.ktx2 makes one file of them, which can be opened here`);
      throw new Error(files.length === 1 ? `${first.path} is neither a model (.glb, .gltf, .obj, .stl, .ply) nor an image`
        : `none of the ${files.length} files is a model (.glb, .gltf, .obj, .stl, .ply)`);
    }
    return models;
  }

  // path: one of files, or "" for the built-in scene.
  async openModel(path) {
    const { files } = this.#context.view;
    if (path && !files.some((entry) => entry.path === path)) throw new Error(`${path} is not among the files that were opened`);
    await this.#open(files, path);
  }

  async #open(files, path) {
    this.#apply(); // src, if it was set before
    const turn = this.#context.loading.take();
    await engine.start();
    this.#context.light.want();
    await this.#context.loading.show(files, path, path, turn);
  }

  get files() { return this.#context.view.files; }
  get modelPath() { return this.#context.view.path; }
  get originalGltfJson() { return null; }
  get canActivateAR() { return false; }
  async activateAR() { /* there is no device that could */ }

  // ---- settings, as options of facet render ----

  // text null: the default. Where the value is a file, wait for what is returned.
  async setOption(name, text) {
    await engine.start();
    await this.#context.view.setOption(name, text);
    this.#emit('facet-change');
    this.#say();
  }

  get options() { return this.#context.view.options(); }
  command(width = this.#context.view.size.width, height = this.#context.view.size.height) {
    return this.#context.view.query((module, viewer) => module.command(viewer, width, height), '');
  }

  describe() { return this.#context.view.query((module, viewer) => module.describe(viewer), {}); }

  get state() {
    const { view, animation } = this.#context;
    const state = view.state();
    return { ...state, isPlaying: !animation.isPaused, time: animation.currentTime, speed: animation.timeScale };
  }

  get renderInfo() { return this.state.stats ?? {}; }

  setMaterial(index, values) {
    this.#context.view.setMaterial(index, values);
    this.#emit('facet-change');
  }

  get materials() { return this.describe().materials ?? []; }
  // As it is in the file.
  async imageBlob(index) {
    const image = this.#context.view.query((module, viewer) => module.getImage(viewer, index), null);
    return image && new Blob([image.bytes], { type: image.type });
  }

  // ---- the camera ----

  getCameraOrbit() { return this.#context.camera.getCameraOrbit(); }
  getCameraTarget() { return this.#context.camera.getCameraTarget(); }
  getFieldOfView() { return this.#context.camera.getFieldOfView(); }
  getMinimumFieldOfView() { return this.#context.camera.getMinimumFieldOfView(); }
  getMaximumFieldOfView() { return this.#context.camera.getMaximumFieldOfView(); }
  getIdealAspect() { return this.#context.camera.getIdealAspect(); }
  getDimensions() { return this.#context.camera.getDimensions(); }
  getBoundingBoxCenter() { return this.#context.camera.getBoundingBoxCenter(); }
  // After the changes that were made before.
  jumpCameraToGoal() { this.updateComplete.then(() => this.#context.camera.jumpCameraToGoal()); }
  updateFraming() { return this.updateComplete.then(() => this.#context.camera.updateFraming()); }
  get turntableRotation() { return this.#context.camera.turntableRotation; }
  resetTurntableRotation(theta = 0) { this.#context.camera.resetTurntableRotation(theta); }
  resetInteractionPrompt() { this.#context.input.resetPrompt(); }
  zoom(keyPresses) { this.#context.input.zoom(-keyPresses); }
  get inputSensitivity() { return this.#context.camera.inputSensitivity; }
  set inputSensitivity(value) {
    this.#context.camera.inputSensitivity = value;
    this.#context.view.setMotion('input-sensitivity', Number(value));
  }

  // ---- points of the model ----

  // clientX, clientY: pixels of the window, as in events. Null: the background.
  #pick(clientX, clientY) {
    const box = this.getBoundingClientRect();
    return this.#context.view.pick((clientX - box.x) / box.width, (clientY - box.y) / box.height);
  }

  // x, y: pixels of the element. {position, normal, material}, or null.
  pick(x, y) {
    const box = this.getBoundingClientRect();
    return this.#pick(x + box.x, y + box.y);
  }

  positionAndNormalFromPoint(clientX, clientY) {
    const hit = this.#pick(clientX, clientY);
    return hit && { position: vector(hit.position), normal: vector(hit.normal), uv: null };
  }

  surfaceFromPoint(clientX, clientY) {
    const hit = this.#pick(clientX, clientY);
    return hit && [...hit.position, ...hit.normal].join(' ');
  }

  updateHotspot(config) { this.#context.hotspots.updateHotspot(config); }
  queryHotspot(name) { return this.#context.hotspots.queryHotspot(name); }

  // ---- animations and variants ----

  get availableAnimations() { return [...this.#context.animation.names]; }
  get availableVariants() { return this.#context.view.state().variants ?? []; }
  get paused() { return this.#context.animation.isPaused; }
  get duration() { return this.#context.animation.duration; }
  get currentTime() { return this.#context.animation.currentTime; }
  set currentTime(value) {
    this.#context.animation.currentTime = value;
    this.#emit('facet-change');
  }

  get timeScale() { return this.#context.animation.timeScale; }
  set timeScale(value) { this.#context.animation.timeScale = Number.isFinite(Number(value)) ? Number(value) : 1; }
  play(options) { this.#context.animation.play(options); }
  pause() { this.#context.animation.pause(); }

  // ---- images and files ----

  toDataURL(type, encoderOptions) { return this.#context.images.toDataURL(type, encoderOptions); }
  toBlob(options) { return this.#context.images.toBlob(options); }
  screenshot(options) { return this.#context.images.screenshot(options); }

  // The model with its edited materials, as .glb.
  async exportScene() {
    const { view } = this.#context;
    if (!view.hasModel || !view.path) throw new Error('there is no model to export');
    let tools;
    try {
      tools = await (await import('./tools.js')).loadTools();
    } catch {
      throw new Error('this copy of facet has no tools.js, which writes models');
    }
    const files = Object.fromEntries(await Promise.all(view.files.map(async ({ path, file }) => [path, new Uint8Array(await file.arrayBuffer())])));
    const bytes = await tools.save(files, view.path, view.edits);
    return new Blob([bytes], { type: 'model/gltf-binary' });
  }
}

defineProperties(FacetViewer.prototype, valuesOf);
if (!customElements.get('facet-viewer')) customElements.define('facet-viewer', FacetViewer);
