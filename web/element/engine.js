// engine.js - one module and one WebGL context for all elements of a page. Views draw in turn into the one canvas that has the context,
// and copy the image into canvases of their own; a view that is alone on the screen shows that canvas itself. The context may be
// lost and the module may run out of memory: views go on with a new one. Coarse images are always copied: the one canvas has straight
// alpha, and browsers that enlarge it mix the edges of the model with black.
import { loadModule } from './module.js';

const LOSS_PATIENCE_MS = 5000;

export class Engine {
  #module = null;
  #starting = null;
  #views = new Set();
  #shown = null; // the view that shows the shared canvas
  #isAsked = false;
  #isLost = false;
  #lossTimer = 0;
  #waiting = []; // for the context: {resolve, reject}
  #canvas = null;
  #last = Promise.resolve();
  base = undefined;
  minimumRenderScale = 0.25;

  // The module, once it is loaded and has its context.
  start() {
    this.#starting ??= this.#load().catch((error) => {
      this.#starting = null;
      throw error;
    });
    return this.#starting;
  }

  get module() { return this.#module; }
  get isLost() { return this.#isLost; }
  get viewCount() { return this.#views.size; }
  get canvas() { return this.#canvas; }

  async #load() {
    this.#canvas = document.createElement('canvas');
    this.#canvas.setAttribute('aria-hidden', 'true');
    this.#listenForLoss(this.#canvas);
    const module = await loadModule(this.base);
    module.start(this.#canvas);
    this.#module = module;
    return module;
  }

  add(view) { this.#views.add(view); }

  remove(view) {
    this.#views.delete(view);
    if (this.#shown === view) this.#show(null);
    this.requestFrame();
  }

  // ---- a module that broke: out of memory, or a fault ----

  // Calls use with the module. After an abort nothing in it can be trusted: it is dropped, and the views get a new one.
  call(use) {
    const module = this.#module;
    if (!module) throw new Error('facet has not started yet');
    try {
      return use(module);
    } catch (error) {
      if (module.isLost && module === this.#module) this.#renew();
      throw error;
    }
  }

  // Calls use when no other call uses the table of files.
  alone(use) {
    const done = this.#last.then(use);
    this.#last = done.catch(() => {});
    return done;
  }

  #renew() {
    const views = [...this.#views];
    this.#show(null);
    this.#module = null;
    this.#starting = null;
    clearTimeout(this.#lossTimer);
    this.#isLost = false;
    for (const view of views) view.forget();
    this.#canvas.width = this.#canvas.height = 1;
    this.start().then(() => {
      for (const view of views) view.replay();
      this.requestFrame();
    }, (error) => { for (const view of views) view.fail(error, 'loadfailure'); });
  }

  // ---- the loss of the context ----

  // Also between the loss and the event that tells of it.
  get isContextLost() { return this.#isLost || Boolean(this.#canvas?.getContext('webgl2')?.isContextLost()); }

  // Done when the context is back.
  restored() { return new Promise((resolve, reject) => this.#waiting.push({ resolve, reject })); }

  #endWaiting(end) {
    for (const waiting of this.#waiting.splice(0)) end(waiting);
  }

  #listenForLoss(canvas) {
    canvas.addEventListener('webglcontextlost', (event) => {
      if (canvas !== this.#canvas || !this.#module) return;
      event.preventDefault();
      this.#isLost = true;
      this.#show(null); // the views' own canvases have their last images
      this.call((module) => module.lose());
      this.#lossTimer = setTimeout(() => {
        const error = new Error('the browser took the graphics context away and did not give it back');
        for (const view of this.#views) view.fail(error, 'webglcontextlost');
        this.#endWaiting(({ reject }) => reject(error));
      }, LOSS_PATIENCE_MS);
    });
    canvas.addEventListener('webglcontextrestored', () => {
      if (canvas !== this.#canvas || !this.#module) return;
      clearTimeout(this.#lossTimer);
      this.#isLost = false;
      try {
        this.call((module) => module.restore());
      } catch (error) {
        for (const view of this.#views) view.fail(error, 'webglcontextlost');
        this.#endWaiting(({ reject }) => reject(error));
        return;
      }
      for (const view of this.#views) view.touch();
      this.#endWaiting(({ resolve }) => resolve());
    });
  }

  // ---- frames ----

  requestFrame() {
    if (this.#isAsked) return;
    this.#isAsked = true;
    requestAnimationFrame((time) => {
      this.#isAsked = false;
      this.#frame(time);
    });
  }

  #frame(time) {
    if (this.#isLost || !this.#module) return;
    const views = [...this.#views].filter((view) => view.isDrawn);
    this.#show(views.length === 1 && !views[0].isCoarse ? views[0] : null);
    const due = views.filter((view) => view.needsFrame);
    if (due.length) this.#fit(due);
    for (const view of due) {
      if (!this.#module) return; // renewed meanwhile
      view.drawFrame(time, this.#shown === view);
    }
    if (views.some((view) => view.needsFrame)) this.requestFrame();
  }

  // A canvas in the page has exactly the size of its view; a hidden one grows to the largest.
  #fit(due) {
    const { width, height } = this.#canvas;
    let [w, h] = this.#shown ? [0, 0] : [width, height];
    for (const view of due) {
      const size = view.pixelSize();
      w = Math.max(w, size.width);
      h = Math.max(h, size.height);
    }
    if (w !== width) this.#canvas.width = w;
    if (h !== height) this.#canvas.height = h;
  }

  // The shared canvas moves into the stage of a view, or out of the page.
  #show(view) {
    if (this.#shown === view) return;
    const before = this.#shown;
    this.#shown = view;
    if (before) {
      before.showOwnCanvas(true);
      before.touch();
    }
    this.#canvas?.remove();
    if (view) {
      view.placeCanvas(this.#canvas);
      view.touch();
    }
  }
}

export const engine = new Engine();
