// template.js - the inside of <facet-viewer>: canvases, poster, progress bar, prompt, slots. Styles are a constructed sheet, which a strict
// content security policy allows.
const css = `
:host { display: block; position: relative; contain: strict; width: 300px; height: 150px; }
:host([hidden]) { display: none; }
.stage, .stage canvas, .cover { position: absolute; inset: 0; width: 100%; height: 100%; }
.stage canvas { display: block; pointer-events: none; }
.stage canvas.unused { visibility: hidden; }
.input { visibility: hidden; outline-offset: -3px; }
.input.shown { visibility: visible; }
.input.controlled { cursor: grab; }
.input.controlled.held { cursor: grabbing; }
.input:focus-visible { outline: 2px solid Highlight; box-shadow: inset 0 0 0 1px HighlightText; }
.poster { background-color: var(--poster-color, transparent); }
.poster:not(.shown) { display: none; }
.poster .image { position: absolute; inset: 0; width: 100%; height: 100%; border: 0; padding: 0; margin: 0; object-fit: contain; display: block;
  background: transparent; }
.poster .image[hidden] { display: none; }
.layer { pointer-events: none; }
.layer > ::slotted(*), .layer > slot > * { pointer-events: auto; }
.bar { height: var(--progress-bar-height, 5px); background-color: var(--progress-bar-color, rgba(0, 0, 0, 0.4)); transform: scaleX(0);
  transform-origin: 0 0; transition: transform 0.09s; pointer-events: none; }
.bar.done { opacity: 0; transition: opacity 0.3s 1s; }
.prompt { display: var(--interaction-prompt-display, flex); align-items: end; justify-content: center; opacity: 0; transition: opacity 0.3s;
  pointer-events: none; }
.prompt.shown { opacity: 1; }
.prompt p { margin: 0 0 12px; padding: 6px 12px; border-radius: 16px; font: 13px/1.4 system-ui, sans-serif; color: #fff;
  background: rgba(0, 0, 0, 0.65); }
.hotspots { pointer-events: none; overflow: hidden; }
.hotspot { position: absolute; left: 0; top: 0; }
.hotspot ::slotted(*) { pointer-events: auto; opacity: var(--max-hotspot-opacity, 1); transition: opacity 0.3s; }
.hotspot.behind:not(:focus-within) ::slotted(*) { opacity: var(--min-hotspot-opacity, 0.25); pointer-events: none; }
.hotspot > div { transform: translate(-50%, -50%); }
.pan { position: absolute; left: 50%; top: 50%; transform: translate(-50%, -50%); opacity: 0; transition: opacity 0.3s; pointer-events: none; }
.pan.shown { opacity: 1; }
.pan .dot { width: 6px; height: 6px; border-radius: 6px; border: 1px solid #fff; box-shadow: 0 0 2px 1px rgba(0, 0, 0, 0.8); }
.unseen { position: absolute; width: 1px; height: 1px; margin: -1px; overflow: hidden; clip-path: inset(50%); white-space: nowrap; }
@media (prefers-reduced-motion: reduce) { .bar, .bar.done, .prompt, .hotspot ::slotted(*) { transition: none; } }
`;

const tag = (name, attributes, ...children) => {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
};
const cover = (name, ...children) => tag('div', { class: `${name} cover` }, ...children);
const slot = (name, ...children) => tag('slot', { name }, ...children);

// Made node by node: pages that require trusted types refuse markup in a text.
const makeNodes = () => [
  tag('div', { class: 'input cover', part: 'input', role: 'img', tabindex: '0', 'aria-label': '3D model', 'aria-roledescription': '3D model' },
    tag('div', { class: 'stage' }, slot('canvas', tag('canvas', { class: 'image' })))),
  cover('poster shown', slot('poster', tag('img', { class: 'image', alt: '', hidden: '' }))),
  cover('hotspots'),
  tag('div', { class: 'pan' }, slot('pan-target', tag('div', { class: 'dot' }))),
  tag('div', { class: 'prompt cover', 'aria-hidden': 'true' }, slot('interaction-prompt', tag('p', { part: 'default-interaction-prompt' }))),
  cover('layer', tag('slot', {})),
  cover('layer', slot('progress-bar', tag('div', { class: 'bar done', part: 'default-progress-bar', 'aria-hidden': 'true' }))),
  tag('div', { class: 'unseen' }, tag('span', { role: 'status' })),
];

const sheet = new CSSStyleSheet();
sheet.replaceSync(css);

// The parts of the element's shadow tree by name.
export function makeTree(element) {
  const root = element.attachShadow({ mode: 'open', delegatesFocus: true });
  root.adoptedStyleSheets = [sheet];
  root.append(...makeNodes());
  const find = (selector) => root.querySelector(selector);
  return {
    root,
    input: find('.input'),
    stage: find('.stage'),
    canvas: find('canvas'),
    poster: find('.poster'),
    posterImage: find('.poster .image'),
    hotspots: find('.hotspots'),
    pan: find('.pan'),
    prompt: find('.prompt'),
    promptText: find('.prompt p'),
    bar: find('.bar'),
    status: find('[role=status]'),
  };
}
