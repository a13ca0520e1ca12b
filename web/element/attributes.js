// attributes.js - the attributes of <facet-viewer> and their properties: names, kinds and defaults are those of <model-viewer> 4.4.
// parse() gets what an attribute says, or null without it; take(), what a script sets, which may be anything.
const text = (fallback = null) => ({ fallback, parse: (value) => value ?? fallback, take: (value) => (value === null || value === undefined ? fallback : String(value)) });
const flag = { fallback: false, parse: (value) => value !== null, take: Boolean };
const number = (fallback) => ({
  fallback,
  parse: (value) => (value === null || value.trim() === '' || !Number.isFinite(Number(value)) ? fallback : Number(value)),
  take: (value) => (value === null || typeof value === 'symbol' || !Number.isFinite(Number(value)) ? fallback : Number(value)),
});
// One of some words; any other is the first one.
const choice = (...words) => {
  const find = (value) => (words.includes(value) ? value : words[0]);
  return { fallback: words[0], parse: find, take: find };
};

export const ATTRIBUTES = {
  // what is shown
  src: text(),
  alt: text(),
  poster: text(),
  loading: choice('auto', 'lazy', 'eager'),
  reveal: choice('auto', 'manual'),
  'with-credentials': flag,
  'generate-schema': flag,
  // the camera
  'camera-controls': flag,
  'camera-orbit': text('0deg 75deg 105%'),
  'camera-target': text('auto auto auto'),
  'field-of-view': text('auto'),
  'min-camera-orbit': text('auto'),
  'max-camera-orbit': text('auto'),
  'min-field-of-view': text('auto'),
  'max-field-of-view': text('auto'),
  'orbit-sensitivity': number(1),
  'zoom-sensitivity': number(1),
  'pan-sensitivity': number(1),
  'interpolation-decay': number(50),
  'touch-action': choice('none', 'pan-x', 'pan-y'),
  'disable-zoom': flag,
  'disable-pan': flag,
  'disable-tap': flag,
  'interaction-prompt': choice('auto', 'none'),
  'interaction-prompt-style': choice('wiggle', 'basic'),
  'interaction-prompt-threshold': number(3000),
  'auto-rotate': flag,
  'auto-rotate-delay': number(3000),
  'rotation-per-second': text('auto'),
  a11y: { ...text(), take: (value) => value ?? null }, // JSON, or an object of a script
  // light
  'environment-image': text(),
  'skybox-image': text(),
  'skybox-height': text('0'),
  exposure: number(1),
  'tone-mapping': text('auto'),
  'shadow-intensity': number(0),
  'shadow-softness': number(1),
  // the model
  autoplay: flag,
  'animation-name': text(),
  'animation-crossfade-duration': number(300),
  'variant-name': text(),
  orientation: text('0 0 0'),
  scale: text('1 1 1'),
  // facet's own
  'facet-framing': choice('sphere', 'tight'),
  'facet-channel': text(),
  'facet-brdf': text(),
  'facet-transparency': text(),
  // augmented reality needs devices that facet does not reach: accepted, without effect
  ar: flag,
  'ar-modes': text('webxr scene-viewer quick-look'),
  'ar-scale': text('auto'),
  'ar-placement': text('floor'),
  'ios-src': text(),
  'xr-environment': flag,
  'ar-usdz-max-texture-size': text('auto'),
};

export const propertyOf = (attribute) => attribute.replace(/-(.)/g, (_, letter) => letter.toUpperCase());

const attributeOf = new Map(Object.keys(ATTRIBUTES).map((name) => [propertyOf(name), name]));

// Gives prototype a property for each attribute. Setting one calls changed(attribute) of the element, even if the value is the same:
// camera-orbit is a command as much as a value.
export function defineProperties(prototype, values) {
  for (const [property, attribute] of attributeOf) {
    Object.defineProperty(prototype, property, {
      configurable: true,
      enumerable: true,
      get() {
        const own = values(this);
        return own.has(attribute) ? own.get(attribute) : ATTRIBUTES[attribute].fallback;
      },
      set(value) {
        values(this).set(attribute, ATTRIBUTES[attribute].take(value));
        this.attributeChanged(attribute);
      },
    });
  }
}
