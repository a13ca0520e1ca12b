// show.js - a view that facet view --html wrote, shown by <facet-viewer>: a model's files, and options by their names on the command line.
import '../facet-viewer/facet-viewer.js';

const CAMERA = ['up', 'ortho', 'framing', 'fov', 'target', 'orbit', 'eye', 'camera'];

// The value of an option as a text of the command line; of a flag it is empty.
const textOf = (value) => (value === true ? '' : value);

async function setOptions(viewer, options, wants) {
  for (const [name, value] of Object.entries(options)) if (wants(name)) await viewer.setOption(name, textOf(value));
}

// Options of the camera; those that are not given have their defaults again. facet-framing shows the whole model as facet render does.
async function setCamera(viewer, options) {
  const given = CAMERA.filter((name) => name in options);
  for (const name of CAMERA) if (!given.includes(name)) await viewer.setOption(name, null);
  for (const name of given) await viewer.setOption(name, textOf(options[name]));
}

// Shows the view in the element. files: [{path, file: Blob}].
export async function showView(viewer, view, files) {
  const { animation, time, ...options } = { background: 'white', ...view.options };
  viewer.alt = view.title;
  viewer.loading = 'eager';
  viewer.reveal = 'manual';
  viewer.cameraControls = true;
  viewer.facetFraming = 'tight';
  if (options.fov) Object.assign(viewer, { minFieldOfView: '0.1deg', maxFieldOfView: '179deg' });
  await setOptions(viewer, options, (name) => name === 'shading'); // decides how the model is read
  if (files.length) await viewer.openFiles(files, view.model);
  else await viewer.openModel('');
  await setOptions(viewer, options, (name) => name !== 'shading' && !CAMERA.includes(name));
  await setCamera(viewer, options);
  if (animation && animation !== 'none') await viewer.setOption('animation', animation);
  if (time) viewer.currentTime = Number(time);
  else if (animation && animation !== 'none') viewer.play();
  const drawn = new Promise((resolve) => viewer.addEventListener('before-render', resolve, { once: true }));
  viewer.dismissPoster();
  await drawn;
}

// ---- a page ----

export const WITHOUT_WEBGL = 'This browser draws no 3D graphics (WebGL 2), so this is a preview of the model, which cannot be turned.';
export const hasWebGL = () => document.createElement('canvas').getContext('webgl2') !== null;

const byId = (id) => document.getElementById(id);

export function note(text) {
  byId('note').hidden = !text;
  byId('note').textContent = text;
}

function button(text, act) {
  const made = document.createElement('button');
  made.type = 'button';
  made.textContent = text;
  made.addEventListener('click', act);
  return made;
}

function addControls(viewer, view) {
  const bar = document.createElement('div');
  bar.className = 'controls';
  bar.setAttribute('role', 'toolbar');
  bar.setAttribute('aria-label', 'View');
  if (viewer.availableAnimations.length) {
    const play = button('', () => (viewer.paused ? viewer.play() : viewer.pause()));
    const label = () => { play.textContent = viewer.paused ? 'Play' : 'Pause'; };
    for (const type of ['play', 'pause', 'finished']) viewer.addEventListener(type, label);
    label();
    bar.append(play);
  }
  bar.append(button('Reset view', () => setCamera(viewer, view.options)));
  if (document.fullscreenEnabled)
    bar.append(button('Full screen', () => (document.fullscreenElement ? document.exitFullscreen() : document.documentElement.requestFullscreen())));
  document.body.append(bar);
}

// The color around the preview: that of the image.
function paintPage({ background = 'white' }) {
  if (background !== 'transparent' && background !== 'env') document.body.style.background = background;
}

// Shows the view of the page. read: returns its files.
export async function showPage(read) {
  const view = JSON.parse(byId('view').textContent);
  paintPage(view.options);
  document.body.classList.toggle('controlled', view.controls); // room for the bar
  if (!hasWebGL()) {
    note(WITHOUT_WEBGL);
    return;
  }
  const viewer = document.createElement('facet-viewer');
  byId('stage').append(viewer);
  viewer.addEventListener('error', ({ detail }) => note(detail.message));
  try {
    await showView(viewer, view, await read(view));
    document.body.classList.add('drawn');
    if (view.controls) addControls(viewer, view);
  } catch (error) {
    note(`${error.message}. This is a preview of the model.`);
    viewer.remove();
  }
}
