// scene.js - the scene as a tree (nodes, meshes, materials, lights, cameras) and the properties of what is selected.
import { element, facts, section, shortNumber } from '../fields.js';
import { createTree } from './tree.js';

const MANY = 40; // nodes of a level up to which it is open at first
const MAX_TEXT = 4000; // characters of extras

const nameOf = (object, kind, index) => object.name || `${kind} ${index}`;
const numbers = (list) => (list ? list.map((x) => shortNumber(x, 4)).join(', ') : null);
const degrees = (rad) => (rad === undefined ? null : `${shortNumber((rad * 180) / Math.PI, 4)}°`);
const meters = (length) => (length === null || length === undefined ? null : `${shortNumber(length, 4)} m`);
const isOrNot = (value) => (value === undefined ? null : value ? 'yes' : 'no');

// ---- the tree ----

const materialItem = (scene, index) => ({ kind: 'material', type: 'material', index, name: nameOf(scene.materials[index], 'Material', index) });

function meshItem(scene, index) {
  const mesh = scene.meshes[index];
  const used = [...new Set(mesh.primitives.map(({ material }) => material).filter((material) => material !== null))];
  return { kind: 'mesh', type: 'mesh', index, name: nameOf(mesh, 'Mesh', index), isOpen: true,
    children: used.length ? () => used.map((material) => materialItem(scene, material)) : undefined };
}

function nodeItem(scene, index, depth) {
  const node = scene.nodes[index];
  const parts = [];
  if (node.mesh !== null) parts.push(() => meshItem(scene, node.mesh));
  if (node.light !== null) parts.push(() => leaf(scene, 'light', 'lights', node.light));
  if (node.camera !== null) parts.push(() => leaf(scene, 'camera', 'cameras', node.camera));
  const hasChildren = parts.length + node.children.length > 0;
  return { kind: node.visible ? 'node' : 'hidden node', type: 'node', index, name: nameOf(node, 'Node', index),
    isOpen: depth < 3 && node.children.length > 0 && node.children.length <= MANY,
    children: hasChildren ? () => [...parts.map((make) => make()), ...node.children.map((child) => nodeItem(scene, child, depth + 1))] : undefined };
}

const leaf = (scene, type, list, index) => ({ kind: type, type, index, name: nameOf(scene[list][index], type[0].toUpperCase() + type.slice(1), index) });

function roots(scene) {
  const scenes = scene.scenes.map((item, i) => ({ kind: 'scene', type: 'scene', index: i, name: nameOf(item, 'Scene', i),
    isOpen: item.nodes.length <= MANY, children: item.nodes.length ? () => item.nodes.map((node) => nodeItem(scene, node, 0)) : undefined }));
  const group = (name, list, make) => (list.length ? [{ kind: String(list.length), name, children: () => list.map((_, i) => make(i)) }] : []);
  return [...scenes,
    ...group('Materials', scene.materials, (i) => materialItem(scene, i)),
    ...group('Lights', scene.lights, (i) => leaf(scene, 'light', 'lights', i)),
    ...group('Cameras', scene.cameras, (i) => leaf(scene, 'camera', 'cameras', i)),
    ...group('Animations', scene.animations, (i) => leaf(scene, 'animation', 'animations', i)),
    ...group('Images', scene.images, (i) => leaf(scene, 'image', 'images', i))];
}

// ---- properties ----

const boxOf = (bounds) => (bounds ? [['Smallest', numbers(bounds.min)], ['Largest', numbers(bounds.max)]] : []);

const PROPERTIES = {
  scene: (scene, { index }) => [['Root nodes', scene.scenes[index].nodes.length], ...boxOf(scene.scenes[index].bounds)],
  node: (scene, { index }) => {
    const node = scene.nodes[index];
    return [['Visible', isOrNot(node.visible)], ['Translation', numbers(node.translation)], ['Rotation', numbers(node.rotation)], ['Scale', numbers(node.scale)],
      ['Matrix', numbers(node.matrix)], ['Mesh', node.mesh === null ? null : nameOf(scene.meshes[node.mesh], 'Mesh', node.mesh)],
      ['Skin', node.skin === null ? null : nameOf(scene.skins[node.skin], 'Skin', node.skin)], ['Instances', node.instances], ['Children', node.children.length || null]];
  },
  mesh: (scene, { index }) => scene.meshes[index].primitives.flatMap((primitive, i, all) => [
    ...(all.length > 1 ? [['Primitive', i]] : []), ['Kind', primitive.mode], ['Vertices', primitive.vertices.toLocaleString()], ['Indices', primitive.indices.toLocaleString()],
    ['Material', primitive.material === null ? 'default' : nameOf(scene.materials[primitive.material], 'Material', primitive.material)],
    ['Attributes', primitive.attributes.join(', ')], ['Morph targets', primitive.morph_targets || null], ['Flat normals', primitive.flat_normals ? 'yes' : null],
    ...boxOf(primitive.bounds)]),
  light: (scene, { index }) => {
    const light = scene.lights[index];
    return [['Type', light.type], ['Color', numbers(light.color)], ['Intensity', `${shortNumber(light.intensity, 4)} ${light.type === 'directional' ? 'lx' : 'cd'}`],
      ['Range', meters(light.range)], ['Inner cone', degrees(light.inner_cone_rad)], ['Outer cone', degrees(light.outer_cone_rad)]];
  },
  camera: (scene, { index }) => {
    const camera = scene.cameras[index];
    return [['Type', camera.type], ['Field of view', degrees(camera.fov_y_rad)], ['Height', meters(camera.ortho_height)], ['Aspect', camera.aspect && shortNumber(camera.aspect, 4)],
      ['Near', meters(camera.near)], ['Far', camera.far === null ? 'infinite' : meters(camera.far)]];
  },
  animation: (scene, { index }) => {
    const animation = scene.animations[index];
    return [['From', `${shortNumber(animation.begin, 4)} s`], ['To', `${shortNumber(animation.end, 4)} s`], ['Channels', animation.channels.length],
      ['Moves', [...new Set(animation.channels.map(({ path }) => path))].join(', ')]];
  },
  image: (scene, { index }) => {
    const image = scene.images[index];
    return [['Size', `${image.width} × ${image.height}`], ['Type', image.mime_type], ['Bytes', image.bytes.toLocaleString()], ['Readable', isOrNot(image.readable)]];
  },
};
const LISTS = { scene: 'scenes', node: 'nodes', mesh: 'meshes', light: 'lights', camera: 'cameras', animation: 'animations', image: 'images' };

const json = (value) => element('pre', { class: 'json', tabindex: 0 }, JSON.stringify(value, null, 1).slice(0, MAX_TEXT));

function propertiesOf(scene, item) {
  const own = scene[LISTS[item.type]][item.index];
  return [element('h3', {}, `${item.name} (${item.kind})`), facts(PROPERTIES[item.type](scene, item)),
    ...(own.extras ? [element('h3', {}, 'Extras'), json(own.extras)] : []), ...(own.metadata ? [element('h3', {}, 'Metadata'), json(own.metadata)] : [])];
}

export function scenePanel(app) {
  let scene = null;
  const properties = element('div', { class: 'properties', 'aria-live': 'polite' });
  const tree = createTree('Scene', (item) => {
    if (item.type === 'material') app.showMaterial(item.index);
    properties.replaceChildren(...(PROPERTIES[item.type] ? propertiesOf(scene, item) : []));
  });
  const part = section('Scene', true, tree.root, properties);
  return {
    root: part.root,
    update() {},
    model(description) {
      scene = description;
      properties.replaceChildren();
      tree.fill(roots(scene));
      part.count = `${scene.counts.nodes} ${scene.counts.nodes === 1 ? 'node' : 'nodes'}`;
    },
  };
}
