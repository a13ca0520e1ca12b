// hotspots.js - children of the element with slot="hotspot-..", which stay over a point of the model. Where the point is in the image, and
// whether it faces the camera, the module says.
const numbers = (text, count) => {
  const values = (text ?? '').trim().split(/\s+/).map((word) => Number.parseFloat(word));
  return values.length >= count && values.slice(0, count).every(Number.isFinite) ? values : null;
};
const vector = ([x, y, z]) => ({ x, y, z, toString() { return `${this.x}m ${this.y}m ${this.z}m`; } });

class Hotspot {
  position = [0, 0, 0];
  normal = [0, 1, 0];
  isFacing = null;
  place = null; // {x, y, depth} in the element

  constructor(name) {
    this.name = name;
    this.box = document.createElement('div');
    this.box.className = 'hotspot';
    const inner = document.createElement('div');
    this.slot = document.createElement('slot');
    this.slot.name = name;
    inner.append(this.slot);
    this.box.append(inner);
  }

  // A surface is what surfaceFromPoint() returns: position and normal.
  set({ position, normal, surface }) {
    const both = numbers(surface, 6);
    if (both) [this.position, this.normal] = [both.slice(0, 3), both.slice(3, 6)];
    this.position = numbers(position, 3)?.slice(0, 3) ?? this.position;
    this.normal = numbers(normal, 3)?.slice(0, 3) ?? this.normal;
  }
}

export class Hotspots {
  #hotspots = new Map();
  #observer;

  constructor(context) {
    this.context = context;
    this.#observer = new MutationObserver(() => this.#collect());
  }

  attach() {
    this.#observer.observe(this.context.element, { childList: true, subtree: true, attributes: true, attributeFilter: ['slot'] });
    this.#collect();
  }

  detach() { this.#observer.disconnect(); }
  update() {}

  #collect() {
    const { element, tree, view } = this.context;
    const found = new Set();
    for (const child of element.children) {
      if (!child.slot?.startsWith('hotspot')) continue;
      found.add(child.slot);
      if (this.#hotspots.has(child.slot)) continue;
      const hotspot = new Hotspot(child.slot);
      hotspot.set(child.dataset);
      this.#hotspots.set(child.slot, hotspot);
      tree.hotspots.append(hotspot.box);
    }
    for (const [name, { box }] of this.#hotspots) {
      if (found.has(name)) continue;
      box.remove();
      this.#hotspots.delete(name);
    }
    if (this.#hotspots.size) view.touch();
  }

  #locate(hotspot) {
    const { view, element } = this.context;
    const found = view.use((module, viewer) => module.locate(viewer, hotspot.position, hotspot.normal));
    hotspot.place = { x: found.x * element.clientWidth, y: found.y * element.clientHeight, depth: found.depth };
    return found.isFacing;
  }

  frameDrawn() {
    for (const hotspot of this.#hotspots.values()) {
      const isFacing = this.#locate(hotspot);
      hotspot.box.style.transform = `translate(${hotspot.place.x.toFixed(2)}px, ${hotspot.place.y.toFixed(2)}px)`;
      if (isFacing === hotspot.isFacing) continue;
      hotspot.isFacing = isFacing;
      hotspot.box.classList.toggle('behind', !isFacing);
      for (const node of hotspot.slot.assignedElements()) {
        if (node.dataset.visibilityAttribute) node.toggleAttribute(`data-${node.dataset.visibilityAttribute}`, isFacing);
        node.dispatchEvent(new CustomEvent('hotspot-visibility', { detail: { visible: isFacing } }));
      }
    }
  }

  updateHotspot(config) {
    const hotspot = this.#hotspots.get(config?.name);
    if (!hotspot) return;
    hotspot.set(config);
    this.context.view.touch();
  }

  queryHotspot(name) {
    const hotspot = this.#hotspots.get(name);
    if (!hotspot || !this.context.view.hasModel) return null;
    const facingCamera = this.#locate(hotspot);
    const { x, y, depth } = hotspot.place;
    if (!Number.isFinite(x) || !Number.isFinite(y)) return null;
    return { position: vector(hotspot.position), normal: vector(hotspot.normal), canvasPosition: vector([x, y, depth]), facingCamera };
  }
}
