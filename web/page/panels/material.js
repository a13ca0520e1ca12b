// material.js - the material inspector: every parameter of glTF and its extensions, with its textures; what is changed here is drawn
// at once, can be reset, and is saved with the model.
import { button, check, choice, element, range, section, shortNumber } from '../fields.js';
import { toLinear, toScreen } from './colors.js';
import { GROUPS, canBeAdded, nameOfRow, valueIn } from './material_rows.js';
import { textureList } from './textures.js';

const ALPHA_MODES = [['OPAQUE', 'Opaque'], ['MASK', 'Cut out'], ['BLEND', 'Blended']];
const CUTOFF = { key: 'alphaCutoff', label: 'Cutoff', fact: 'alpha_cutoff', min: 0, max: 1, step: 0.01, limits: [0, Infinity], usual: 0.5 };
const ROOT = { object: '', rows: [CUTOFF] };

// A color field with a number for each linear channel.
function colorRow(row, value, change) {
  const now = [...value];
  const picker = element('input', { type: 'color', 'aria-label': row.label });
  const numbers = now.map((_, i) => element('input', { type: 'number', step: 0.05, min: 0, max: Number.isFinite(row.limits[1]) && row.limits[1],
    'aria-label': `${row.label}, ${['red', 'green', 'blue', 'alpha'][i]}` }));
  const show = () => {
    picker.value = toScreen(now);
    numbers.forEach((input, i) => { if (document.activeElement !== input) input.value = shortNumber(now[i], 4); });
  };
  picker.addEventListener('input', () => {
    toLinear(picker.value).forEach((x, i) => { now[i] = x; });
    show();
    change([...now]);
  });
  numbers.forEach((input, i) => input.addEventListener('input', () => {
    const x = input.valueAsNumber;
    const isGood = x >= 0 && x <= row.limits[1];
    input.toggleAttribute('aria-invalid', !isGood);
    if (!isGood) return;
    now[i] = x;
    show();
    change([...now]);
  }));
  show();
  const root = element('div', { class: 'field color-row', role: 'group', 'aria-label': row.label }, element('span', { class: 'label' }, row.label), picker,
    element('div', { class: 'numbers' }, ...numbers));
  return { root, set value(next) { next.forEach((x, i) => { now[i] = x; }); show(); } };
}

// Equal names get the number of the material.
function namesOf(materials) {
  const names = materials.map(({ name }, i) => name || `Material ${i}`);
  return names.map((name, i) => (names.indexOf(name) === names.lastIndexOf(name) ? name : `${name} (${i})`));
}

export function materialPanel(app) {
  let scene = null;
  let shown = 0; // material
  let variant = null; // null: the file's own materials
  const material = choice({ label: 'Material', options: [], change: (index) => show(Number(index)) });
  const unused = element('p', { class: 'hint', role: 'status' });
  const reset = button('Reset', () => app.resetMaterial(shown));
  const saveAs = button('Save edited .glb', () => app.saveModel());
  const fields = element('div', { class: 'material' });
  const empty = element('p', { class: 'hint' }, 'The model has no materials; it is drawn with the default one.');
  const top = element('div', { class: 'section' }, material.root, unused, element('p', { class: 'hint' }, 'Click the model to choose the material there.'),
    element('div', { class: 'buttons' }, reset, saveAs));
  const root = element('div', {}, top, empty, fields);

  const valueOf = (group, row) => app.editOf(shown, nameOfRow(group, row)) ?? valueIn(scene.materials[shown], group, row);
  const isEdited = (name) => app.editOf(shown, name) !== undefined;

  function rowField(group, row, value) {
    const name = nameOfRow(group, row);
    const change = (next) => {
      field.root.classList.add('is-changed');
      app.editMaterial(shown, name, next);
      reset.disabled = false;
    };
    const field = row.isColor ? colorRow(row, value, change)
      : range({ label: row.label, min: row.min, max: Math.max(row.max, value ?? 0), step: row.step, limits: row.limits, value, change });
    field.root.dataset.parameter = name;
    field.root.classList.toggle('is-changed', isEdited(name));
    return field.root;
  }

  const hasTexture = (group, key) => Boolean((group.isExtension ? scene.materials[shown].extensions[group.object] : scene.materials[shown])?.[key]);

  function groupSection(group) {
    const own = scene.materials[shown];
    const isThere = group.isExtension ? Boolean(own.extensions[group.object]) || group.rows.some((row) => isEdited(nameOfRow(group, row))) : true;
    if (!isThere || (group.object === 'pbrMetallicRoughness' && own.extensions.KHR_materials_pbrSpecularGlossiness)) return null;
    const rows = group.rows.filter((row) => !row.needs || hasTexture(group, row.needs)).map((row) => rowField(group, row, valueOf(group, row) ?? row.usual));
    return section(group.title, true, ...rows, ...textureList(app, scene, group.isExtension ? own.extensions[group.object] ?? {} : own, group.textures)).root;
  }

  // How the surface covers what is behind it, and which sides are drawn.
  function coverSection() {
    const own = scene.materials[shown];
    const get = (name, usual) => app.editOf(shown, name) ?? usual;
    const cutoff = rowField(ROOT, CUTOFF, get('alphaCutoff', own.alpha_cutoff));
    const edit = (name, value) => { app.editMaterial(shown, name, value); reset.disabled = false; };
    const mode = choice({ label: 'Alpha', options: ALPHA_MODES, value: get('alphaMode', own.alpha_mode), change: (name) => {
      cutoff.hidden = name !== 'MASK';
      edit('alphaMode', name);
    } });
    cutoff.hidden = mode.value !== 'MASK';
    const sides = check({ label: 'Both sides', value: get('doubleSided', own.double_sided), change: (is) => edit('doubleSided', is) });
    mode.root.dataset.parameter = 'alphaMode';
    sides.root.dataset.parameter = 'doubleSided';
    return section('Coverage', true, mode.root, cutoff, sides.root, ...(own.unlit ? [element('p', { class: 'hint' }, 'Unlit: the base color is shown without any light.')] : [])).root;
  }

  function addField() {
    const missing = GROUPS.filter((group) => canBeAdded(group) && !scene.materials[shown].extensions[group.object]
      && !group.rows.some((row) => isEdited(nameOfRow(group, row))));
    const add = choice({ label: 'Add a layer', options: [['', 'Choose…'], ...missing.map(({ object, title }) => [object, title])], change: (object) => {
      const group = GROUPS.find((other) => other.object === object);
      for (const row of group.rows.filter(({ needs }) => !needs)) {
        const value = row.first ?? row.usual;
        if (value !== null) app.editMaterial(shown, nameOfRow(group, row), value);
      }
      show(shown);
      fields.querySelector(`[data-parameter="${nameOfRow(group, group.rows[0])}"] :is(input, select)`)?.focus();
    } });
    return element('div', { class: 'section add' }, add.root);
  }

  const primitives = () => scene.meshes.flatMap((mesh) => mesh.primitives);
  const materialOf = ({ material: own, variant_materials: others }) => (variant === null ? own : others?.[variant] ?? own);
  const isDrawn = (index) => primitives().some((primitive) => materialOf(primitive) === index);

  // Another variant: the material that the same part of the model has now.
  function followVariant(next) {
    if (!scene || next === variant) return;
    const part = primitives().find((primitive) => materialOf(primitive) === shown);
    variant = next;
    show(part && !isDrawn(shown) ? materialOf(part) ?? shown : shown);
  }

  function show(index) {
    shown = Math.min(Math.max(0, index), scene.materials.length - 1);
    const has = scene.materials.length > 0;
    top.hidden = !has;
    empty.hidden = has;
    if (!has) {
      fields.replaceChildren();
      return;
    }
    material.value = String(shown);
    unused.textContent = isDrawn(shown) ? '' : 'Nothing that is shown has this material: edits do not change the image.';
    unused.hidden = isDrawn(shown);
    reset.disabled = !app.hasEdits(shown);
    fields.replaceChildren(...GROUPS.map(groupSection).filter(Boolean), coverSection(), addField());
  }

  return {
    root,
    show,
    refresh: () => show(shown),
    update(_, state) { followVariant(state.variant ?? null); },
    model(description, state) {
      scene = description;
      variant = state.variant ?? null;
      material.options = namesOf(scene.materials).map((name, i) => [String(i), name]);
      show(Math.max(0, scene.materials.findIndex((_, i) => isDrawn(i))));
    },
  };
}
