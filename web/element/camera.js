// camera.js - the camera's attributes and queries. What they mean is computed by the module (view_rig.h).
const ATTRIBUTES = ['field-of-view', 'min-field-of-view', 'max-field-of-view', 'camera-target', 'min-camera-orbit', 'max-camera-orbit', 'camera-orbit'];
const NUMBERS = {
  'orbit-sensitivity': 1, 'zoom-sensitivity': 1, 'pan-sensitivity': 1, 'interpolation-decay': 0.001, 'auto-rotate-delay': 0.001,
};
const MOTION = { 'interpolation-decay': 'decay' };

const point = (x, y, z) => ({ x, y, z, toString() { return `${this.x}m ${this.y}m ${this.z}m`; } });

export class Camera {
  #reduced = matchMedia('(prefers-reduced-motion: reduce)');
  #last = '';
  #waiting = new Set(ATTRIBUTES);
  source = 'none';
  inputSensitivity = 1;

  constructor(context) {
    this.context = context;
  }

  attach() {
    this.#reduced.addEventListener('change', this.#reduce);
    window.addEventListener('scroll', this.#scroll, { passive: true });
    this.#reduce();
  }

  detach() {
    this.#reduced.removeEventListener('change', this.#reduce);
    window.removeEventListener('scroll', this.#scroll);
  }

  #reduce = () => this.context.view.setMotion('reduced', this.#reduced.matches ? 1 : 0);

  // Values of attributes may follow the page: env(window-scroll-y).
  #scroll = () => {
    const { element, view } = this.context;
    const following = ATTRIBUTES.filter((name) => element.attributeValue(name)?.includes('env('));
    if (!following.length || !view.hasModel) return;
    this.#setScroll();
    for (const name of following) this.#apply(name);
  };

  #setScroll() {
    const range = document.documentElement.scrollHeight - window.innerHeight;
    this.context.view.setMotion('scroll', range > 0 ? Math.min(1, Math.max(0, window.scrollY / range)) : 0);
  }

  update(changed) {
    const { element, view } = this.context;
    for (const [name, factor] of Object.entries(NUMBERS))
      if (changed.has(name)) view.setMotion(MOTION[name] ?? name, Math.max(0, element.attributeValue(name) * factor));
    if (changed.has('auto-rotate')) view.setMotion('auto-rotate', element.autoRotate ? 1 : 0);
    if (changed.has('facet-framing')) view.setFraming(element.facetFraming === 'tight');
    if (changed.has('orientation') || changed.has('scale')) this.#place();
    for (const name of [...ATTRIBUTES, 'rotation-per-second']) {
      if (!changed.has(name)) continue;
      if (view.hasModel) this.#apply(name);
      else this.#waiting.add(name);
    }
  }

  #place() {
    const { element, view } = this.context;
    try {
      view.place(element.orientation, element.scale);
    } catch (error) {
      console.warn(`<facet-viewer> ${error.message}`);
    }
  }

  #apply(name) {
    const { element, view } = this.context;
    this.source = 'none';
    try {
      view.setCamera(name, element.attributeValue(name));
    } catch (error) {
      console.warn(`<facet-viewer> ${error.message}`);
    }
  }

  // Before the first image of a model: percentages and auto refer to it.
  modelOpened() {
    this.#setScroll();
    for (const name of this.#waiting) this.#apply(name);
    this.#waiting.clear();
    this.context.view.frame(true);
    this.#last = '';
  }

  frameDrawn() {
    const camera = this.read();
    const now = [camera.azimuth, camera.polar, camera.radius, camera.fov, ...camera.target].join();
    if (now === this.#last) return;
    this.#last = now;
    this.context.emit('camera-change', { source: this.source });
    this.context.cameraMoved(camera.side);
  }

  userMoved() {
    this.source = 'user-interaction';
    this.context.view.touch();
  }

  read() {
    const { view } = this.context;
    if (!view.hasModel) return { azimuth: 0, polar: 0, radius: 0, fov: 0, target: [0, 0, 0], side: '', turntable: 0, minFov: 0, maxFov: 0, aspect: 0, low: [0, 0, 0], high: [0, 0, 0] };
    return view.use((module, viewer) => module.getCamera(viewer));
  }

  getCameraOrbit() {
    const { azimuth, polar, radius } = this.read();
    return { theta: azimuth, phi: polar, radius, toString() { return `${this.theta}rad ${this.phi}rad ${this.radius}m`; } };
  }

  getCameraTarget() { return point(...this.read().target); }
  getFieldOfView() { return this.read().fov; }
  getMinimumFieldOfView() { return this.read().minFov; }
  getMaximumFieldOfView() { return this.read().maxFov; }
  getIdealAspect() { return this.read().aspect; }
  get turntableRotation() { return this.read().turntable; }

  getDimensions() {
    const { low, high } = this.read();
    return point(...high.map((value, i) => value - low[i]));
  }

  getBoundingBoxCenter() {
    const { low, high } = this.read();
    return point(...high.map((value, i) => 0.5 * (value + low[i])));
  }

  jumpCameraToGoal() {
    const { view } = this.context;
    if (!view.hasModel) return;
    view.use((module, viewer) => module.jump(viewer));
    view.touch();
  }

  async updateFraming() {
    if (!this.context.view.hasModel) return;
    this.context.view.frame(true);
  }

  resetTurntableRotation(theta = 0) { this.context.view.setMotion('turntable', theta); }
}
