// widget.in.js - widget.js, the binding for R's htmlwidgets (docs/examples/r/facet_page.R): a classic script with the viewer inside, once for all widgets
// of a document.
import { carry } from '../facet-viewer/module.js';
import { unpack } from './carried.js';
import { hasWebGL, showView, WITHOUT_WEBGL } from './show.js';
import wasm from './viewer.wasm.gz';

let carrying = null;

function carryViewer() {
  carrying ??= unpack(wasm).then((blob) => blob.arrayBuffer()).then((bytes) => carry('viewer.wasm', bytes));
  return carrying;
}

function place(node, parent) {
  Object.assign(node.style, { position: 'absolute', inset: '0', width: '100%', height: '100%' });
  parent.append(node);
  return node;
}

function say(element, text) {
  const note = document.createElement('p');
  note.setAttribute('role', 'status');
  note.textContent = text;
  Object.assign(note.style, { position: 'absolute', left: '1rem', right: '1rem', bottom: '1rem', margin: '0', padding: '.4rem .8rem',
    font: '14px/1.4 system-ui, sans-serif', color: '#1b1f26', background: '#ffffffe6', borderRadius: '.4rem' });
  element.append(note);
}

async function show(element, { view, files, preview }) {
  element.replaceChildren();
  element.style.position = 'relative';
  const image = place(document.createElement('img'), element);
  image.style.objectFit = 'contain';
  image.alt = view.title;
  image.src = preview;
  if (!hasWebGL()) {
    say(element, WITHOUT_WEBGL);
    return;
  }
  const viewer = place(document.createElement('facet-viewer'), element);
  try {
    await carryViewer();
    await showView(viewer, view, await Promise.all(files.map(async ({ path, data }) => ({ path, file: await unpack(data) }))));
    image.style.visibility = 'hidden';
  } catch (error) {
    viewer.remove();
    say(element, `${error.message}. This is a preview of the scene.`);
  }
}

window.HTMLWidgets?.widget({
  name: 'facet',
  type: 'output',
  // The viewer follows the size of the element by itself, also from 0 x 0.
  factory: (element) => ({ renderValue: (value) => show(element, value), resize() {} }),
});
