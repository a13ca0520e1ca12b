// edits.js - what was changed of the model's materials, by the parameters' glTF names, so that links hold it and it can be undone.
import { findRow, materialPart, valueIn } from './panels/material_rows.js';

const INFINITE = 1e30; // JSON has no infinity; as a distance this is one

// Members of the material itself that are no numbers.
const WORDS = { alphaMode: 'alpha_mode', doubleSided: 'double_sided', alphaCutoff: 'alpha_cutoff' };

export function createEdits(viewer) {
  const edits = new Map(); // material -> Map of name and value
  let scene = null;

  const partOf = (name, value) => {
    if (Object.hasOwn(WORDS, name)) return { [name]: value };
    const found = findRow(name);
    if (!found) throw new Error(`There is no parameter "${name}" of a material.`);
    return materialPart(found.group, found.row, value);
  };

  const originalOf = (material, name) => {
    if (Object.hasOwn(WORDS, name)) return material[WORDS[name]];
    const { group, row } = findRow(name);
    return valueIn(material, group, row) ?? row.usual ?? INFINITE;
  };

  return {
    // Of another model.
    begin(description) {
      scene = description;
      edits.clear();
    },
    set(index, name, value) {
      if (!scene?.materials[index]) throw new Error(`There is no material ${index}: the model has ${scene?.materials.length ?? 0}.`);
      viewer.setMaterial(index, partOf(name, value));
      if (!edits.has(index)) edits.set(index, new Map());
      edits.get(index).set(name, value);
    },
    get: (index, name) => edits.get(index)?.get(name),
    has: (index) => (edits.get(index)?.size ?? 0) > 0,
    reset(index) {
      for (const name of edits.get(index)?.keys() ?? []) viewer.setMaterial(index, partOf(name, originalOf(scene.materials[index], name)));
      edits.delete(index);
    },
    resetAll() { [...edits.keys()].forEach((index) => this.reset(index)); },
    get any() { return edits.size > 0; },
    list: () => [...edits].flatMap(([index, values]) => [...values].map(([name, value]) => [index, name, value])),
  };
}
