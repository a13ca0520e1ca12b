// animation.js - animations and variants: which one, how often and how fast. The pose at a time is the module's.
export class Animation {
  #names = [];
  #ends = []; // s, by the index of the name
  #isPaused = true;
  #time = 0;
  #isBackward = false;
  #loops = 0;
  #options = { repetitions: Infinity, pingpong: false };
  timeScale = 1;

  constructor(context) {
    this.context = context;
  }

  attach() {}
  detach() {}

  get names() { return this.#names; }
  get isPaused() { return this.#isPaused; }
  get duration() { return this.#ends[this.#index()] ?? 0; }
  get currentTime() { return this.#time; }

  set currentTime(value) {
    if (!this.#names.length || !Number.isFinite(Number(value))) return;
    this.#select();
    this.#time = Math.min(Math.max(0, Number(value)), this.duration);
    this.#pose();
  }

  update(changed) {
    const { element, view } = this.context;
    if (changed.has('variant-name') && view.hasModel) this.#setVariant();
    if (changed.has('animation-name') && view.hasModel && this.#names.length) {
      this.#time = 0;
      this.#choose();
      this.#pose();
    }
    if (changed.has('autoplay') && element.autoplay && view.hasModel) this.play();
  }

  modelOpened() {
    const { element, view } = this.context;
    const state = view.state();
    this.#names = state.animations;
    this.#ends = state.animationTimes.map(([, end]) => end);
    this.#time = 0;
    this.#halt();
    if (element.variantName) this.#setVariant();
    if (element.animationName && this.#names.length) {
      this.#choose();
      this.#pose();
    }
    if (element.autoplay) this.play();
  }

  #setVariant() {
    const { element, view, emit } = this.context;
    try {
      view.setOption('variant', element.variantName && element.variantName !== 'default' ? element.variantName : null);
      emit('variant-applied');
    } catch (error) {
      console.warn(`<facet-viewer> ${error.message}`);
    }
  }

  // The animation that animation-name says, else the first.
  #index() { return Math.max(0, this.#names.indexOf(this.context.element.animationName)); }

  #choose() { this.context.view.setOption('animation', String(this.#index())); }

  // Where none is chosen; one that an option has chosen stays.
  #select() {
    if (this.context.view.options().animation === undefined) this.#choose();
  }

  #pose() {
    const { view } = this.context;
    view.use((module, viewer) => module.setTime(viewer, this.#time));
    view.touch();
  }

  play(options = {}) {
    if (!this.#names.length) return;
    this.#options = { repetitions: options.repetitions ?? Infinity, pingpong: Boolean(options.pingpong) };
    this.#select();
    if (this.#time >= this.duration) this.#time = 0;
    this.#isBackward = false;
    this.#loops = 0;
    this.#isPaused = false;
    this.context.view.isPlaying = true;
    this.context.view.touch();
    this.context.emit('play');
  }

  #halt() {
    this.#isPaused = true;
    this.context.view.isPlaying = false;
  }

  pause() {
    if (this.#isPaused) return;
    this.#halt();
    this.context.emit('pause');
  }

  // Before a frame.
  advance(seconds) {
    if (this.#isPaused || !(this.duration > 0)) return;
    const step = seconds * this.timeScale * (this.#isBackward ? -1 : 1);
    let time = this.#time + step;
    const { pingpong, repetitions } = this.#options;
    if (time >= this.duration || time < 0) {
      this.#loops += 1;
      if (this.#loops >= repetitions) {
        this.#time = time < 0 ? 0 : this.duration;
        this.#pose();
        this.#halt();
        this.context.emit('finished');
        return;
      }
      if (pingpong) {
        time = time < 0 ? -time : 2 * this.duration - time;
        this.#isBackward = !this.#isBackward;
      }
      time = ((time % this.duration) + this.duration) % this.duration;
      this.context.emit('loop', { count: this.#loops, name: this.#names[this.#index()] });
    }
    this.#time = time;
    this.#pose();
  }
}
