// side-by-side.js - <facet-viewer> and <model-viewer> with the same attributes and the same camera. model-viewer is never shipped: it is
// there where somebody has put its script beside this page.
import './facet-viewer/facet-viewer.js';

const byId = (id) => document.getElementById(id);
const elements = []; // facet-viewer, and model-viewer where it is there
let source = null; // the address that both show

function showError(text) {
  byId('failure').hidden = !text;
  byId('failure').textContent = text;
}

// "name" or name="value" a line.
function readAttributes() {
  return byId('attributes').value.split('\n').map((line) => line.trim()).filter(Boolean).map((line) => {
    const found = line.match(/^([a-z0-9-]+)(?:\s*=\s*(?:"([^"]*)"|'([^']*)'|(\S*)))?$/i);
    if (!found) throw new Error(`"${line}" is no attribute`);
    return [found[1], found[2] ?? found[3] ?? found[4] ?? ''];
  });
}

function apply() {
  showError('');
  try {
    const wanted = new Map(readAttributes());
    wanted.set('alt', 'The model that was picked');
    if (source) wanted.set('src', source);
    for (const element of elements) {
      for (const name of element.getAttributeNames()) if (!wanted.has(name) && name !== 'class' && name !== 'style') element.removeAttribute(name);
      for (const [name, value] of wanted) element.setAttribute(name, value);
    }
  } catch (error) {
    showError(error.message);
  }
}

const degrees = (radians) => `${((radians * 180) / Math.PI).toFixed(3)}°`;
const meters = (value) => `${Number(value.toPrecision(7))} m`;
const vector = ({ x, y, z }) => [x, y, z].map((value) => Number(value.toPrecision(6))).join(', ');
const ROWS = [
  ['Azimuth', (element) => degrees(element.getCameraOrbit().theta)],
  ['Polar angle', (element) => degrees(element.getCameraOrbit().phi)],
  ['Distance', (element) => meters(element.getCameraOrbit().radius)],
  ['Target', (element) => vector(element.getCameraTarget())],
  ['Field of view', (element) => `${element.getFieldOfView().toFixed(3)}°`],
  ['Size of the model', (element) => vector(element.getDimensions())],
];

function showValues() {
  byId('values').tBodies[0].replaceChildren(...ROWS.map(([name, read]) => {
    const row = document.createElement('tr');
    const head = document.createElement('th');
    head.scope = 'row';
    head.textContent = name;
    row.append(head);
    for (let i = 0; i < 2; i++) row.insertCell().textContent = elements[i]?.loaded ? read(elements[i]) : '–';
    return row;
  }));
}

// The other element goes where the user has moved this one.
function follow(element) {
  element.addEventListener('camera-change', ({ detail }) => {
    showValues();
    if (detail.source !== 'user-interaction') return;
    for (const other of elements) {
      if (other === element) continue;
      other.cameraOrbit = element.getCameraOrbit().toString();
      other.cameraTarget = element.getCameraTarget().toString();
      other.fieldOfView = `${element.getFieldOfView()}deg`;
      other.jumpCameraToGoal();
    }
  });
  element.addEventListener('load', showValues);
  element.addEventListener('error', ({ detail }) => showError(`${element.localName}: ${detail.message ?? detail.sourceError?.message ?? detail.type}`));
}

function add(tag, figure) {
  const element = document.createElement(tag);
  elements.push(element);
  follow(element);
  byId(figure).append(element);
}

async function addTheirs() {
  try {
    await import('./model-viewer.min.js');
    add('model-viewer', 'theirs');
  } catch {
    byId('absent').hidden = false;
  }
}

function show(file) {
  if (!file) return;
  if (source) URL.revokeObjectURL(source);
  source = URL.createObjectURL(file);
  apply();
}

byId('file').addEventListener('change', (event) => show(event.target.files[0]));
byId('settings').addEventListener('submit', (event) => {
  event.preventDefault();
  apply();
});
window.addEventListener('dragover', (event) => event.preventDefault());
window.addEventListener('drop', (event) => {
  event.preventDefault();
  show(event.dataTransfer.files[0]);
});

add('facet-viewer', 'ours');
showValues();
await addTheirs();
elements[0].openModel('').then(showValues, (error) => showError(error.message));
apply();
