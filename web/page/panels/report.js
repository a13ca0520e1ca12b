// report.js - what is known about the file: its list of models, counts, sizes, extensions, the reader's warnings and notes.
import { choice, element, facts, section } from '../fields.js';
import { copyButton } from '../messages.js';

const UNITS = ['bytes', 'kB', 'MB', 'GB'];

export function bytesText(bytes) {
  let value = bytes;
  let unit = 0;
  for (; value >= 1000 && unit < UNITS.length - 1; unit++) value /= 1000;
  return `${unit ? value.toPrecision(3) : value} ${UNITS[unit]}`;
}

const count = (number) => number?.toLocaleString('en');
const sizeOf = (bounds) => bounds && bounds.max.map((x, i) => Number((x - bounds.min[i]).toPrecision(3))).join(' × ');

export function reportPanel(app) {
  const variant = choice({ label: 'Variant', options: [], change: (name) => app.set('variant', name || null) });
  const which = choice({ label: 'Scene', options: [], change: (name) => app.set('scene', name || null) });
  const model = element('div');
  const frame = element('div');
  const warnings = element('ul', { class: 'warnings' });
  const notes = element('ul', { class: 'warnings notes' });
  let lines = [];
  const copy = copyButton('Copy all', () => lines.join('\n'), app.messages);
  const about = section('Model', true, variant.root, which.root, model);
  const numbers = section('Statistics', false, frame);
  const reader = section('Warnings and notes', false, warnings, notes, element('div', { class: 'buttons' }, copy));
  const root = element('div', {}, about.root, numbers.root, reader.root);
  let shown = '';
  return {
    root,
    last: element('div', {}, numbers.root, reader.root),
    first: about.root,
    update(options, state) {
      variant.value = app.indexOf(state.variants, options.variant);
      which.value = app.indexOf(app.description?.scenes.map(({ name }) => name), options.scene);
      const stats = state.stats ?? {};
      const text = JSON.stringify(stats);
      if (text === shown) return;
      shown = text;
      frame.replaceChildren(facts(statistics(app.description, stats, app.fileSize)));
    },
    model(description, state) {
      shown = '';
      variant.options = [['', 'As in the file'], ...description.variants.map((name, i) => [String(i), name || `Variant ${i}`])];
      variant.root.hidden = !description.variants.length;
      const names = description.scenes.map(({ name }) => name);
      which.options = [['', 'As in the file'], ...names.map((name, i) => [String(i), name || `Scene ${i}`])];
      which.root.hidden = names.length < 2;
      model.replaceChildren(facts([['Size', description.bounds ? `${sizeOf(description.bounds)} m` : 'empty'], ['Triangles', count(description.counts.drawn_triangles)],
        ['Made with', description.asset.generator], ['Copyright', description.asset.copyright],
        ['Extensions', description.extensions.map(({ name, state: how }) => (how === 'supported' ? name : `${name} (${how})`)).join(', ')]]));
      lines = [...description.warnings, ...description.notes];
      warnings.replaceChildren(...description.warnings.map((text) => element('li', {}, text)));
      notes.replaceChildren(...description.notes.map((text) => element('li', {}, text)));
      if (!lines.length) notes.append(element('li', { class: 'quiet' }, 'None: the file keeps to its format.'));
      copy.hidden = !lines.length;
      reader.count = lines.length ? String(lines.length) : 'none';
      reader.root.open = description.warnings.length > 0;
    },
  };
}

function statistics(description, stats, fileSize) {
  const counts = description?.counts;
  if (!counts) return [];
  return [['File', fileSize ? bytesText(fileSize) : null], ['Nodes', count(counts.nodes)], ['Meshes', count(counts.meshes)], ['Primitives', count(counts.primitives)],
    ['Vertices', count(counts.vertices)], ['Triangles in the file', count(counts.triangles)], ['Materials', count(counts.materials)],
    ['Textures', count(counts.textures)], ['Geometry', bytesText(description.memory.geometry_bytes)], ['Images as stored', bytesText(description.memory.image_file_bytes)],
    ['Images as texels', bytesText(description.memory.image_texel_bytes)], ['Skins', counts.skins || null], ['Animations', counts.animations || null],
    ['Triangles drawn', count(stats.triangles)], ['Draw calls', count(stats.draws)], ['Time of a frame', stats.seconds ? `${(1000 * stats.seconds).toFixed(1)} ms` : null]];
}
