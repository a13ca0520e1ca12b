// aria.js - what screen readers say: the name of the model, how to move it, and from where it is seen after it was moved. The attribute a11y
// translates: JSON of phrases by name ("upper-left", "interaction-prompt").
const PROMPT = 'Use mouse, touch or arrow keys to move.';
const QUIET_MS = 300; // after the last movement

export class Aria {
  #phrases = {};
  #timer = 0;
  #side = '';

  constructor(context) {
    this.context = context;
    this.#label();
  }

  attach() {}
  detach() { clearTimeout(this.#timer); }

  update(changed) {
    if (changed.has('a11y')) this.#phrases = this.#read(this.context.element.a11y);
    if (changed.has('a11y') || changed.has('alt') || changed.has('camera-controls')) this.#label();
  }

  #read(value) {
    if (!value) return {};
    if (typeof value === 'object') return { ...value };
    try {
      return { ...JSON.parse(value) };
    } catch (error) {
      console.warn(`<facet-viewer> a11y is no JSON: ${error.message}`);
      return {};
    }
  }

  #label() {
    const { element, tree } = this.context;
    const name = element.alt || '3D model';
    const prompt = this.#phrases['interaction-prompt'] ?? PROMPT;
    tree.input.setAttribute('aria-label', element.cameraControls ? `${name.replace(/\.$/, '')}. ${prompt}` : name);
    tree.promptText.textContent = prompt;
  }

  // The first view of a model is not announced.
  cameraMoved(side) {
    const isFirst = !this.#side;
    const isSame = side === this.#side;
    this.#side = side;
    if (isFirst || isSame) return;
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => {
      this.context.tree.status.textContent = this.#phrases[side] ?? `View from ${side.replace('-', ' ')}`;
    }, QUIET_MS);
  }
}
