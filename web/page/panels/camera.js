// camera.js - where the model is seen from: its own cameras, directions, field of view, projection.
import { button, check, choice, element, line, range, section } from '../fields.js';

// azimuth and polar angle, in degrees
const DIRECTIONS = [['Front', '0,90'], ['Back', '180,90'], ['Left', '-90,90'], ['Right', '90,90'], ['Top', '0,0'], ['Bottom', '0,180'], ['Angle', '45,55']];

export function cameraPanel(app) {
  const camera = choice({ label: 'Camera', options: [['', 'Free']], change: (name) => app.set('camera', name || null) });
  const look = (angles) => app.setAll({ camera: null, target: null, orbit: `${angles},105%` });
  const directions = element('div', { class: 'buttons', role: 'group', 'aria-label': 'View from' },
    button('Whole model', () => app.setAll({ camera: null, target: null, orbit: null })),
    ...DIRECTIONS.map(([name, angles]) => button(name, () => look(angles))));
  const orbit = line({ label: 'Orbit', change: (text) => app.set('orbit', text || null) });
  const target = line({ label: 'Target', placeholder: 'center of the model', change: (text) => app.set('target', text || null) });
  const fov = range({ label: 'Field of view', min: 5, max: 120, step: 1, limits: [0.1, 179], value: 30, unit: 'degrees',
    change: (value) => app.set('fov', value === 30 ? null : String(value)) });
  const isParallel = check({ label: 'Parallel projection', change: (is) => app.setFlag('ortho', is) });
  const up = choice({ label: 'Upward axis', options: [['y', 'Y, as in glTF'], ['z', 'Z, as in CAD']], change: (axis) => app.set('up', axis === 'y' ? null : axis) });
  const part = section('Camera', false, camera.root, directions, orbit.root, target.root, fov.root, isParallel.root, up.root,
    element('p', { class: 'hint' }, 'Orbit: azimuth, polar angle, distance. Target: x, y, z in meters.'));
  return {
    root: part.root,
    update(options, state) {
      camera.value = app.indexOf(state.cameras, options.camera);
      orbit.value = options.orbit ?? '0,75,105%';
      target.value = options.target ?? '';
      fov.value = Number.parseFloat(options.fov ?? '30');
      isParallel.value = 'ortho' in options;
      up.value = options.up ?? 'y';
    },
    model(description, state) {
      const names = state.cameras ?? [];
      camera.options = [['', 'Free'], ...names.map((name, i) => [String(i), name || `Camera ${i}`])];
      camera.root.hidden = !names.length;
    },
  };
}
