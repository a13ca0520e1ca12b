// input.js - mouse, touch and keys as movements of the camera. One finger or the left button turns; two fingers, the right button or
// Shift, Control or Command pan; pinch, wheel and the page keys zoom. A tap makes the touched point the center.
const TAP_PIXELS = 2;
const TAP_MS = 300;
const STEPS = { ArrowLeft: 0, ArrowRight: 1, ArrowUp: 2, ArrowDown: 3, PageDown: 4, PageUp: 5 }; // view_step
const WHEEL_PIXELS = 30; // that are one step
const LINE_PIXELS = 18;
const PINCH_STEPS = 50; // of an image's height

export class Input {
  #pointers = new Map(); // id -> {x, y}
  #mode = null; // 'turn', 'pan', or 'two' fingers; null: the page scrolls
  #isDecided = false;
  #hasPanned = false;
  #start = null;
  #separation = 0;
  #promptTimer = 0;
  #hasInteracted = false;
  #isEnabled = false;

  constructor(context) {
    this.context = context;
    const { input } = context.tree;
    this.listeners = [
      ['pointerdown', this.#down], ['pointermove', this.#move], ['pointerup', this.#up], ['pointercancel', this.#up],
      ['wheel', this.#wheel, { passive: false }], ['keydown', this.#key], ['contextmenu', this.#menu],
      ['touchmove', this.#touchMove, { passive: false }],
    ];
    input.addEventListener('keydown', (event) => { if (event.key === 'Escape') input.blur(); });
  }

  attach() {}

  detach() {
    this.#pointers.clear();
    clearTimeout(this.#promptTimer);
  }

  update(changed) {
    const { element } = this.context;
    if (changed.has('camera-controls') || changed.has('touch-action') || changed.has('disable-zoom')) this.#enable(element.cameraControls);
    if (changed.has('camera-controls') || changed.has('interaction-prompt') || changed.has('interaction-prompt-threshold') || changed.has('src')) this.resetPrompt(true);
  }

  #enable(isEnabled) {
    const { tree, element } = this.context;
    const { touchAction, disableZoom } = element;
    tree.input.classList.toggle('controlled', isEnabled);
    tree.input.style.touchAction = !isEnabled ? '' : disableZoom && touchAction !== 'none' ? 'manipulation' : touchAction;
    if (isEnabled) tree.input.setAttribute('aria-keyshortcuts', 'ArrowLeft ArrowRight ArrowUp ArrowDown Shift+ArrowLeft Shift+ArrowRight Shift+ArrowUp Shift+ArrowDown PageUp PageDown');
    else tree.input.removeAttribute('aria-keyshortcuts');
    if (isEnabled === this.#isEnabled) return;
    this.#isEnabled = isEnabled;
    for (const [type, listener, options] of this.listeners) {
      if (isEnabled) tree.input.addEventListener(type, listener, options);
      else tree.input.removeEventListener(type, listener, options);
    }
  }

  // ---- what the module does ----

  #height() { return this.context.element.clientHeight || 1; }

  #act(use) {
    const { view, camera } = this.context;
    if (!view.hasModel) return;
    view.use(use);
    this.#hasInteracted = true;
    this.#hidePrompt();
    camera.userMoved();
  }

  #turn(dx, dy) { this.#act((module, viewer) => module.turn(viewer, dx, dy, this.#height())); }
  #pan(dx, dy) {
    this.#hasPanned = true;
    this.#act((module, viewer) => module.pan(viewer, dx, dy, this.#height()));
  }

  // Positive: away.
  zoom(steps) { this.#act((module, viewer) => module.zoom(viewer, steps)); }

  // ---- pointers ----

  #down = (event) => {
    if (this.#pointers.size > 1) return;
    const { tree } = this.context;
    if (!this.#pointers.size) {
      this.#start = { x: event.clientX, y: event.clientY, time: performance.now() };
      this.#isDecided = false;
      this.#hasPanned = false;
      this.#mode = null;
    }
    try {
      tree.input.setPointerCapture(event.pointerId);
    } catch {
      // a pointer that scripts made up cannot be captured
    }
    this.#pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (event.pointerType === 'touch') this.#beginTouch();
    else this.#mode = this.#pansWith(event) ? 'pan' : 'turn';
    tree.input.classList.add('held');
    tree.pan.classList.toggle('shown', this.#mode === 'pan' || (this.#mode === 'two' && !this.context.element.disablePan));
  };

  #pansWith(event) {
    return !this.context.element.disablePan && (event.button === 2 || event.ctrlKey || event.metaKey || event.shiftKey);
  }

  #beginTouch() {
    if (this.#pointers.size === 1) {
      this.#mode = 'turn';
      return;
    }
    const isScrolling = this.#isDecided && this.#mode === null;
    this.#mode = isScrolling || (this.context.element.disableZoom && this.context.element.disablePan) ? null : 'two';
    this.#isDecided = true;
    this.#separation = this.#distance();
  }

  #distance() {
    const [a, b] = [...this.#pointers.values()];
    return Math.hypot(a.x - b.x, a.y - b.y);
  }

  #move = (event) => {
    const pointer = this.#pointers.get(event.pointerId);
    if (!pointer) return;
    if (event.pointerType === 'mouse' && event.buttons === 0) {
      this.#up(event);
      return;
    }
    const share = 1 / this.#pointers.size;
    const dx = (event.clientX - pointer.x) * share;
    const dy = (event.clientY - pointer.y) * share;
    if (dx === 0 && dy === 0) return;
    pointer.x = event.clientX;
    pointer.y = event.clientY;
    if (event.pointerType === 'touch' && !this.#isDecided) this.#decide(dx, dy);
    if (this.#mode === 'turn') this.#turn(dx, dy);
    else if (this.#mode === 'pan') this.#pan(dx, dy);
    else if (this.#mode === 'two') this.#pinch(dx, dy);
  };

  // With touch-action pan-y a finger that begins up or down scrolls the page.
  #decide(dx, dy) {
    const { touchAction } = this.context.element;
    this.#isDecided = true;
    if ((touchAction === 'pan-y' && Math.abs(dy) > Math.abs(dx)) || (touchAction === 'pan-x' && Math.abs(dx) > Math.abs(dy))) this.#mode = null;
  }

  #touchMove = (event) => {
    if (this.#isDecided && this.#mode !== null && event.cancelable) event.preventDefault();
  };

  #pinch(dx, dy) {
    const { element } = this.context;
    const separation = this.#distance();
    if (!element.disableZoom) this.zoom(((this.#separation - separation) * PINCH_STEPS) / this.#height());
    this.#separation = separation;
    if (!element.disablePan) this.#pan(dx, dy);
  }

  #up = (event) => {
    if (!this.#pointers.delete(event.pointerId)) return;
    const { tree, element } = this.context;
    if (this.#hasPanned) this.#settlePan();
    this.#hasPanned = false;
    if (!this.#pointers.size) {
      if (event.type === 'pointerup' && !element.disablePan && !element.disableTap) this.#tap(event);
      this.#mode = null;
      tree.input.classList.remove('held');
    } else if (event.pointerType === 'touch') {
      this.#beginTouch();
    }
    tree.pan.classList.remove('shown');
  };

  // The camera goes on turning around what is now in the middle.
  #settlePan() {
    const { view } = this.context;
    const hit = view.pick(0.5, 0.5);
    if (hit) this.#act((module, viewer) => module.setPivot(viewer, hit.position));
  }

  #tap(event) {
    const { x, y, time } = this.#start;
    if (performance.now() > time + TAP_MS || Math.hypot(event.clientX - x, event.clientY - y) > TAP_PIXELS) return;
    const hit = this.context.pick(event.clientX, event.clientY);
    this.#act((module, viewer) => module.setTarget(viewer, hit?.position ?? null));
  }

  #menu = (event) => {
    if (!this.context.element.disablePan) event.preventDefault();
  };

  #wheel = (event) => {
    if (this.context.element.disableZoom) return;
    event.preventDefault();
    this.zoom((event.deltaY * (event.deltaMode === 1 ? LINE_PIXELS : 1)) / WHEEL_PIXELS);
  };

  #key = (event) => {
    const step = STEPS[event.key];
    const { element } = this.context;
    if (step === undefined || event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.key.startsWith('Page') && element.disableZoom) return;
    const pans = event.shiftKey && !element.disablePan;
    event.preventDefault();
    this.#act((module, viewer) => module.step(viewer, step, pans, this.#height()));
  };

  // ---- the prompt ----

  // Once the model is there, unless the user has found the controls.
  resetPrompt(keepsInteraction = false) {
    const { element, loading } = this.context;
    this.#hidePrompt();
    if (!keepsInteraction) this.#hasInteracted = false;
    if (element.interactionPrompt !== 'auto' || !element.cameraControls || this.#hasInteracted || !loading.isLoaded) return;
    this.#promptTimer = setTimeout(() => this.context.tree.prompt.classList.add('shown'), element.interactionPromptThreshold);
  }

  #hidePrompt() {
    clearTimeout(this.#promptTimer);
    this.context.tree.prompt.classList.remove('shown');
  }
}
