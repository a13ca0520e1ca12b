// view.js - one viewer of the module: its model, its settings and its canvas. Remembers what it was told, so that a new module can be
// told again.
import { engine } from './engine.js';

const OF_MODEL = new Set(['animation', 'time', 'variant', 'camera', 'scene', 'orbit', 'target', 'fov']); // options that need the model

const LARGEST = 8192; // pixels along a side, which most graphics processors can draw
const MOST_STOPS = 3; // then a model is not loaded again

// b over a: objects member by member, all else as a whole.
function join(a, b) {
  const isObject = (value) => value !== null && typeof value === 'object' && !Array.isArray(value);
  if (!isObject(a) || !isObject(b)) return b;
  const both = new Map(Object.entries(a));
  for (const [name, value] of Object.entries(b)) both.set(name, join(both.get(name), value));
  return Object.fromEntries(both); // "__proto__" is a name as any other
}

export class View {
  #handle = 0;
  #host;
  #tree;
  #model = null; // {files, path} that is shown
  #options = new Map();
  #turns = new Map(); // how often an option was set
  #motion = new Map();
  #camera = new Map();
  #comparison = { name: '', position: 0.5 };
  #materials = [];
  #isTight = false; // framing
  #placement = null; // texts, unless the model stands as in its file
  #extraFiles = []; // that options name
  #lastTime = 0;
  #isTouched = false;
  #hasFailed = false; // the last frame
  #isAlive = false;
  #divisor = 1;
  #isSharp = true;
  #stops = 0; // of the module, by this model
  #size = { width: 1, height: 1 };
  #frameSize = null; // of the last frame
  isVisible = false;
  isRevealed = false;
  isPlaying = false;

  // host: {beforeFrame(seconds), onFrame(), onScale(scale, reason), onFail(error, type), onReplayed()}
  constructor(tree, host) {
    this.#tree = tree;
    this.#host = host;
  }

  // The element is in a page.
  revive() {
    this.#isAlive = true;
    engine.add(this);
  }

  destroy() {
    this.#isAlive = false;
    this.close();
    engine.remove(this);
  }

  // The model and all of its memory are released; settings stay.
  close() {
    const handle = this.#handle;
    this.forget();
    this.#model = null;
    if (handle && engine.module) engine.call((module) => module.destroy(handle));
    this.#tree.canvas.width = this.#tree.canvas.height = 0;
  }

  get hasModel() { return this.#handle !== 0 && this.#model !== null && engine.module !== null; }
  get files() { return this.#model?.files ?? []; }
  get path() { return this.#model?.path ?? null; }
  // All changes of materials, by their index.
  get edits() { return this.#materials.reduce((all, [index, values]) => join(all, { [index]: values }), {}); }
  get isLost() { return engine.isLost; }
  get isDrawn() { return this.isVisible && this.isRevealed && this.hasModel; }
  get isMoving() { return this.hasModel && (this.isPlaying || this.use((module, viewer) => module.isMoving(viewer))); }
  get isCoarse() { return this.#divisor > 1; }
  // After a failure nothing is drawn until something is set.
  get needsFrame() { return this.isDrawn && (this.#isTouched || (!this.#hasFailed && (!this.#isSharp || this.isMoving))); }

  // Calls use(module, viewer). The first time the viewer is told what was set before.
  use(use) {
    const { module: before } = engine;
    try {
      return engine.call((module) => {
        if (!this.#handle) {
          this.#handle = module.create();
          this.#tell(module);
        }
        return use(module, this.#handle);
      });
    } catch (error) {
      if (before?.isLost) this.#stops++;
      throw error;
    }
  }

  query(use, fallback) { return this.hasModel ? this.use(use) : fallback; }
  state() { return this.query((module, viewer) => module.state(viewer), {}); }

  // Draw again.
  touch() {
    this.#isTouched = true;
    engine.requestFrame();
  }

  fail(error, type) { this.#host.onFail(error, type); }

  // ---- what is shown ----

  // isCurrent: whether it is still to be shown when its turn comes.
  async open(files, path, isCurrent = () => true) {
    this.#stops = 0;
    await this.#open(files, path, isCurrent);
  }

  async #open(files, path, isCurrent) {
    await engine.start();
    const isNew = !this.#handle;
    await this.#withContext(files, () => {
      if (!isCurrent()) throw new DOMException('another model was asked for meanwhile', 'AbortError');
      this.use((module, viewer) => module.open(viewer, path));
    });
    if (!this.#isAlive) {
      this.close();
      throw new DOMException('the element is not in the page', 'AbortError');
    }
    this.#model = { files, path };
    this.#placeAgain();
    this.#materials = [];
    for (const name of OF_MODEL) this.#options.delete(name);
    if (isNew) await this.#tellFiles();
    if (isNew && this.#comparison.name) this.setOption('compare', this.#comparison.name);
    this.touch();
  }

  // As #withFiles(), once more if the browser takes the graphics context away meanwhile.
  async #withContext(files, use) {
    try {
      await this.#withFiles(files, use);
    } catch (error) {
      if (error.name === 'AbortError' || !engine.isContextLost) throw error;
      await engine.restored();
      await this.#withFiles(files, use);
    }
  }

  // Settings of a new viewer whose values are files.
  async #tellFiles() {
    for (const [name, text] of this.#options) {
      const entry = this.#extraFiles.find(({ path }) => path === text);
      if (entry) await this.setOptionFile(name, entry);
    }
  }

  // The files are there for C while use runs, once more with the decoders that it found missing.
  async #withFiles(files, use) {
    await engine.alone(async () => {
      const contents = await Promise.all(files.map(({ file }) => file.arrayBuffer()));
      const { codecs } = await engine.start();
      try {
        this.use((module) => files.forEach(({ path }, i) => module.putFile(path, new Uint8Array(contents[i]))));
        codecs.takeMissing();
        let failure = null;
        try {
          use();
        } catch (error) {
          failure = error;
        }
        const missing = codecs.takeMissing();
        if (missing.length) {
          await codecs.load(missing);
          use();
        } else if (failure) {
          throw failure;
        }
      } finally {
        engine.module?.removeFiles();
      }
    });
  }

  // The value may be the path of a file of the model, or one that was set before: then wait for what is returned.
  setOption(name, text) {
    if (name === 'compare' || name === 'divider') return this.#setComparison(name, text);
    this.#nextTurn(name);
    if (name === 'shading' && this.path) return this.#setShading(text);
    const entry = text !== null && [...this.files, ...this.#extraFiles].find(({ path }) => path === text);
    if (entry) return this.setOptionFile(name, entry);
    if (engine.module) this.use((module, viewer) => module.setOption(viewer, name, text));
    this.#options.set(name, text);
    this.touch();
    return undefined;
  }

  // The model is read again, and its materials are edited again; glTF's shading gets the tone mapping again, which OpenGL 1 has not.
  async #setShading(text) {
    const tone = text === 'ogl1' ? null : this.#options.get('tone-mapping') ?? null;
    await this.#withFiles(this.files, () => this.use((module, viewer) => {
      module.setOption(viewer, 'shading', text);
      if (tone !== null) module.setOption(viewer, 'tone-mapping', tone);
      for (const [index, values] of this.#materials) module.setMaterial(viewer, index, values);
    }));
    this.#options.set('shading', text);
    this.touch();
  }

  // Two images side by side are no option of the command, but are set as one: what is compared, and where the divider is.
  #setComparison(name, text) {
    const next = { ...this.#comparison };
    if (name === 'compare') next.name = text ?? '';
    else next.position = text === null ? 0.5 : Number(text);
    if (!(next.position >= 0 && next.position <= 1)) throw new Error(`divider: "${text}" is no number from 0 to 1`);
    if (engine.module) this.use((module, viewer) => module.compare(viewer, next.name, next.position));
    this.#comparison = next;
    this.touch();
  }

  options() {
    const { name, position } = this.#comparison;
    const own = name ? { compare: name, divider: String(position) } : {};
    return { ...this.query((module, viewer) => module.getOptions(viewer), {}), ...own };
  }

  #nextTurn(name) {
    const turn = (this.#turns.get(name) ?? 0) + 1;
    this.#turns.set(name, turn);
    return turn;
  }

  // Without effect where the option is set again before the file is read.
  async setOptionFile(name, entry) {
    const turn = this.#nextTurn(name);
    await engine.start();
    await this.#withFiles([entry], () => {
      if (turn !== this.#turns.get(name)) return;
      this.use((module, viewer) => module.setOption(viewer, name, entry.path));
      this.#options.set(name, entry.path);
      this.#extraFiles = [...this.#extraFiles.filter(({ path }) => path !== entry.path), entry];
    });
    this.touch();
  }

  hasOption(name) { return (this.#options.get(name) ?? null) !== null; }

  setMotion(name, value) {
    this.#motion.set(name, value);
    if (this.#handle && engine.module) this.use((module, viewer) => module.setMotion(viewer, name, value));
    this.touch();
  }

  setCamera(name, text) {
    this.use((module, viewer) => module.setCamera(viewer, name, text));
    this.#camera.set(name, text);
    this.touch();
  }

  #placeAgain() {
    if (!this.#placement) return;
    try {
      this.use((module, viewer) => module.place(viewer, ...this.#placement));
    } catch (error) {
      if (!this.hasModel) throw error;
      console.warn(`<facet-viewer> ${error.message}`); // the model stands as in its file
    }
  }

  // As facet render frames a model, or as <model-viewer> does.
  setFraming(isTight) {
    if (isTight === this.#isTight) return;
    this.#isTight = isTight;
    if (!this.#handle || !engine.module) return;
    this.use((module, viewer) => module.setFraming(viewer, isTight));
    if (this.hasModel) this.frame(false);
  }

  // Texts of the attributes orientation and scale.
  place(orientation, scale) {
    const isAsInFile = orientation === '0 0 0' && scale === '1 1 1';
    if (isAsInFile && !this.#placement) return;
    if (this.hasModel) {
      this.use((module, viewer) => module.place(viewer, orientation, scale));
      this.frame(true);
    }
    this.#placement = isAsInFile ? null : [orientation, scale];
  }

  // To what the attributes of the camera say.
  frame(keepsDirection) {
    this.use((module, viewer) => module.frame(viewer, this.#size.width, this.#size.height, keepsDirection));
    this.touch();
  }

  setMaterial(index, values) {
    this.use((module, viewer) => module.setMaterial(viewer, index, values));
    this.#materials.push([index, JSON.parse(JSON.stringify(values))]); // which the caller may change
    this.touch();
  }

  // The module is gone.
  forget() {
    this.#handle = 0;
    this.#frameSize = null;
  }

  // Settings of a new viewer; those whose values are files follow in open().
  #tell(module) {
    module.setFraming(this.#handle, this.#isTight);
    for (const [name, value] of this.#motion) module.setMotion(this.#handle, name, value);
    for (const [name, text] of this.#camera) module.setCamera(this.#handle, name, text);
    for (const [name, text] of this.#options) {
      if (this.#extraFiles.some(({ path }) => path === text) || OF_MODEL.has(name)) continue;
      try {
        module.setOption(this.#handle, name, text);
      } catch (error) {
        if (module.isLost) throw error;
        this.#options.delete(name);
        console.warn(`<facet-viewer> ${error.message}`);
      }
    }
  }

  // Tells a new module what the old one was told.
  async replay() {
    const model = this.#model;
    const materials = this.#materials;
    const options = [...this.#options];
    if (!model) return;
    this.#model = null;
    try {
      if (this.#stops >= MOST_STOPS) throw new Error(`${model.path || 'the built-in scene'}: drawing it has stopped facet ${this.#stops} times; it is not loaded again`);
      await this.#open(model.files, model.path, () => true);
      this.frame(true);
      for (const [name, text] of options)
        if (OF_MODEL.has(name)) await this.setOption(name, text);
      for (const [index, values] of materials) this.setMaterial(index, values);
      this.#host.onReplayed();
    } catch (error) {
      this.fail(error, 'loadfailure');
    }
  }

  // ---- the image ----

  setSize(width, height) {
    const scale = Math.min(1, LARGEST / width, LARGEST / height);
    this.#size = { width: Math.max(1, Math.round(scale * width)), height: Math.max(1, Math.round(scale * height)) };
    this.touch();
  }

  // Of the canvas, in pixels of the screen.
  get size() { return this.#size; }

  pixelSize() {
    return { width: Math.max(1, Math.round(this.#size.width / this.#divisor)), height: Math.max(1, Math.round(this.#size.height / this.#divisor)) };
  }

  // What is at a point of the last frame, in parts of its width and height: {position, normal, material}, or null.
  pick(x, y) {
    if (!this.hasModel || this.isLost || !this.#frameSize || !(x >= 0 && x < 1 && y >= 0 && y < 1)) return null;
    const { width, height } = this.#frameSize;
    return this.use((module, viewer) => module.pick(viewer, x * width, y * height));
  }

  placeCanvas(canvas) {
    this.#tree.stage.append(canvas);
    this.showOwnCanvas(false);
  }

  showOwnCanvas(isShown) { this.#tree.canvas.classList.toggle('unused', !isShown); }

  // isDirect: the shared canvas is the one in the page.
  drawFrame(time, isDirect) {
    const seconds = this.#lastTime ? Math.min((time - this.#lastTime) / 1000, 0.5) : 0;
    this.#hasFailed = false;
    try {
      this.#host.beforeFrame(seconds);
      this.#isTouched = false;
      const { width, height } = this.pixelSize();
      const isDraft = this.use((module, viewer) => module.drafts(viewer, this.isMoving));
      this.use((module, viewer) => module.draw(viewer, width, height, seconds, isDraft));
      this.#frameSize = { width, height };
      const isMoving = this.isMoving;
      if (!isDirect || !isMoving) this.#copy(width, height);
      this.#lastTime = isMoving ? time : 0;
      this.#pace(isMoving, isDraft, seconds);
      this.#host.onFrame();
    } catch (error) {
      this.#lastTime = 0;
      this.#isTouched = false;
      this.#hasFailed = true;
      if (engine.module && engine.isContextLost) return; // drawn again when it is back
      this.fail(error, 'loadfailure');
    }
  }

  // At rest a view keeps its image, for the time after a loss of the context.
  #copy(width, height) {
    const { canvas } = this.#tree;
    if (canvas.width !== width) canvas.width = width;
    if (canvas.height !== height) canvas.height = height;
    const context = canvas.getContext('2d');
    context.globalCompositeOperation = 'copy';
    context.drawImage(engine.canvas, 0, engine.canvas.height - height, width, height, 0, 0, width, height);
  }

  // Coarser while slow frames move, sharp at rest.
  #pace(isMoving, isDraft, seconds) {
    const divisor = this.use((module, viewer) => module.pace(viewer, isMoving, this.#divisor, seconds));
    const allowed = Math.min(divisor, 1 / engine.minimumRenderScale);
    this.#isSharp = !isDraft && (isMoving || allowed === this.#divisor);
    if (allowed === this.#divisor) return;
    this.#divisor = allowed;
    this.#host.onScale(1 / allowed, isMoving ? 'GPU throttling' : 'GPU idle');
  }
}
