// make_models.mjs FOLDER - the models of the gallery: spheres and knots whose materials vary in one property each. Quantized
// (KHR_mesh_quantization), some ten kB a model. Made by this project; CC0.
import { mkdirSync, writeFileSync } from 'node:fs';
import path from 'node:path';

// ---- shapes: unit positions and normals, as 16-bit integers, and triangles ----

const minus = (a, b) => a.map((x, i) => x - b[i]);
const unit = (a) => a.map((x) => x / Math.hypot(...a));
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

// Triangles with their corners counter-clockwise as seen from where their normals point to.
function outward({ places, normals, indices }) {
  const turned = [];
  const get = (list, i) => list.slice(3 * i, 3 * i + 3);
  for (let i = 0; i < indices.length; i += 3) {
    const [a, b, c] = indices.slice(i, i + 3);
    const N = cross(minus(get(places, b), get(places, a)), minus(get(places, c), get(places, a)));
    const n = get(normals, a);
    turned.push(a, ...(N[0] * n[0] + N[1] * n[1] + N[2] * n[2] < 0 ? [c, b] : [b, c]));
  }
  return { places, normals, indices: turned };
}

function grid(columns, rows, at, isClosed) {
  const places = [], normals = [], indices = [];
  for (let row = 0; row <= rows; row++)
    for (let column = 0; column <= columns; column++) {
      const { place, normal } = at(column / columns, row / rows);
      places.push(...place);
      normals.push(...normal);
    }
  const number = (column, row) => row * (columns + 1) + column;
  for (let row = 0; row < rows; row++)
    for (let column = 0; column < columns; column++) {
      const [a, b, c, d] = [number(column, row), number(column + 1, row), number(column, row + 1), number(column + 1, row + 1)];
      if (isClosed || row > 0) indices.push(a, b, c);
      if (isClosed || row < rows - 1) indices.push(b, d, c);
    }
  return outward({ places, normals, indices });
}

const sphere = (columns, rows) => grid(columns, rows, (u, v) => {
  const [turn, fall] = [2 * Math.PI * u, Math.PI * v];
  const n = [Math.sin(fall) * Math.sin(turn), Math.cos(fall), Math.sin(fall) * Math.cos(turn)];
  return { place: n, normal: n };
}, false);

// A tube along a (2, 3) torus knot.
function knot(columns, rows) {
  const curve = (t) => {
    const r = 0.55 + 0.2 * Math.cos(3 * t);
    return [r * Math.cos(2 * t), r * Math.sin(2 * t), 0.28 * Math.sin(3 * t)];
  };
  return grid(columns, rows, (u, v) => {
    const t = 2 * Math.PI * v, p = curve(t);
    const ahead = unit(minus(curve(t + 1e-3), p)), side = unit(cross(ahead, [p[0], p[1], 0])), up = cross(side, ahead);
    const turn = -2 * Math.PI * u;
    const normal = side.map((x, i) => Math.cos(turn) * x + Math.sin(turn) * up[i]);
    return { place: p.map((x, i) => x + 0.13 * normal[i]), normal };
  }, true);
}

const square = () => ({ places: [-1, 0, -1, -1, 0, 1, 1, 0, 1, 1, 0, -1], normals: [0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0], indices: [0, 1, 2, 0, 2, 3] });

// ---- a model: shapes, materials, and nodes { shape, material, at, size } ----

const int16 = (values) => {
  const four = [];
  for (let i = 0; i < values.length; i += 3) four.push(...values.slice(i, i + 3).map((x) => Math.round(32767 * x)), 0);
  return Buffer.from(Int16Array.from(four).buffer);
};

function glb({ shapes, materials, nodes, title }) {
  const bins = [], bufferViews = [], accessors = [];
  const add = (bytes, accessor, stride, target) => {
    bufferViews.push({ buffer: 0, byteOffset: Buffer.concat(bins).length, byteLength: bytes.length, ...(stride ? { byteStride: stride } : {}), target });
    bins.push(bytes, Buffer.alloc((4 - (bytes.length % 4)) % 4));
    accessors.push({ bufferView: bufferViews.length - 1, ...accessor });
    return accessors.length - 1;
  };
  const arrays = shapes.map(({ places, normals, indices }) => {
    const count = places.length / 3, ends = (f) => [0, 1, 2].map((axis) => Math.round(32767 * f(...places.filter((_, i) => i % 3 === axis))));
    return {
      POSITION: add(int16(places), { componentType: 5122, normalized: true, count, type: 'VEC3', min: ends(Math.min), max: ends(Math.max) }, 8, 34962),
      NORMAL: add(int16(normals), { componentType: 5122, normalized: true, count, type: 'VEC3' }, 8, 34962),
      indices: add(Buffer.from(Uint16Array.from(indices).buffer), { componentType: 5123, count: indices.length, type: 'SCALAR' }, 0, 34963),
    };
  });
  const meshes = [], names = new Map();
  const meshOf = ({ shape, material }) => {
    const key = `${shape} ${material}`;
    if (!names.has(key)) {
      const { indices, ...attributes } = arrays[shape];
      names.set(key, meshes.push({ primitives: [{ attributes, indices, material }] }) - 1);
    }
    return names.get(key);
  };
  const used = new Set(materials.flatMap((material) => Object.keys(material.extensions ?? {})));
  const json = {
    asset: { version: '2.0', generator: 'facet web/gallery', copyright: 'CC0', extras: { title } },
    extensionsUsed: ['KHR_mesh_quantization', ...used], extensionsRequired: ['KHR_mesh_quantization'],
    scene: 0, scenes: [{ nodes: nodes.map((_, i) => i) }],
    nodes: nodes.map((node) => ({
      mesh: meshOf(node), translation: node.at, scale: Array(3).fill(node.size ?? 1), ...(node.rotation ? { rotation: node.rotation } : {}), name: materials[node.material].name,
    })),
    meshes, materials, accessors, bufferViews, buffers: [{ byteLength: Buffer.concat(bins).length }],
  };
  const text = Buffer.from(JSON.stringify(json)), padded = Buffer.concat([text, Buffer.alloc((4 - (text.length % 4)) % 4, 0x20)]), bin = Buffer.concat(bins);
  const head = Buffer.alloc(20), second = Buffer.alloc(8);
  head.write('glTF', 0, 'latin1');
  head.writeUInt32LE(2, 4);
  head.writeUInt32LE(28 + padded.length + bin.length, 8);
  head.writeUInt32LE(padded.length, 12);
  head.write('JSON', 16, 'latin1');
  second.writeUInt32LE(bin.length, 0);
  second.write('BIN\0', 4, 'latin1');
  return Buffer.concat([head, padded, second, bin]);
}

// ---- the models ----

const row = (count, make) => Array.from({ length: count }, (_, i) => make(count > 1 ? i / (count - 1) : 0, i));
const line = (count, material = 0, apart = 2.15) => row(count, (_, i) => ({ shape: 0, material: material + i, at: [(i - (count - 1) / 2) * apart, 0, 0] }));
const pbr = (name, color, roughnessFactor, metallicFactor, extensions) => ({
  name, pbrMetallicRoughness: { baseColorFactor: [...color, 1], roughnessFactor, metallicFactor }, ...(extensions ? { extensions } : {}),
});
const percent = (x) => `${Math.round(100 * x)} %`;
const GOLD = [1, 0.766, 0.336], RED = [0.6, 0.03, 0.03];

const models = {
  roughness: {
    title: 'Roughness and metal', shapes: [sphere(40, 20)],
    materials: [...row(6, (x) => pbr(`Metal, roughness ${percent(x)}`, GOLD, x, 1)), ...row(6, (x) => pbr(`Plastic, roughness ${percent(x)}`, RED, x, 0))],
    nodes: [...line(6).map((node) => ({ ...node, at: [node.at[0], 1.1, 0] })), ...line(6, 6).map((node) => ({ ...node, at: [node.at[0], -1.1, 0] }))],
  },
  clearcoat: {
    title: 'Clear coat', shapes: [sphere(48, 24)],
    materials: row(4, (x) => pbr(`Paint, clear coat ${percent(x)}`, [0.02, 0.1, 0.42], 0.55, 0.85, { KHR_materials_clearcoat: { clearcoatFactor: x, clearcoatRoughnessFactor: 0.03 } })),
    nodes: line(4),
  },
  glass: {
    title: 'Glass', shapes: [knot(18, 120), square()],
    materials: [
      pbr('Green glass', [1, 1, 1], 0.04, 0, { KHR_materials_transmission: { transmissionFactor: 1 }, KHR_materials_ior: { ior: 1.5 }, KHR_materials_volume: { thicknessFactor: 0.35, attenuationDistance: 0.35, attenuationColor: [0.25, 0.75, 0.55] } }),
      pbr('Light tile', [0.85, 0.84, 0.8], 0.6, 0), pbr('Dark tile', [0.06, 0.08, 0.12], 0.6, 0)],
    nodes: [{ shape: 0, material: 0, at: [0, 0.2, 0.45], size: 1.6, rotation: [-0.17, 0, 0, 0.985] },
      ...row(36, (_, i) => ({ shape: 1, material: 1 + ((i + Math.floor(i / 6)) % 2), at: [((i % 6) - 2.5) * 0.8, -1.35, (Math.floor(i / 6) - 2.5) * 0.8], size: 0.4 }))],
  },
  sheen: {
    title: 'Sheen', shapes: [sphere(48, 24)],
    materials: row(4, (x) => pbr(`Velvet, sheen roughness ${percent(0.15 + 0.6 * x)}`, [0.1, 0.02, 0.06], 1, 0, { KHR_materials_sheen: { sheenColorFactor: [0.95, 0.35, 0.55], sheenRoughnessFactor: 0.15 + 0.6 * x } })),
    nodes: line(4),
  },
  iridescence: {
    title: 'Iridescence', shapes: [knot(18, 120)],
    materials: [pbr('Film of 420 nm', [0.75, 0.75, 0.78], 0.12, 1, { KHR_materials_iridescence: { iridescenceFactor: 1, iridescenceIor: 1.6, iridescenceThicknessMaximum: 420 } })],
    nodes: [{ shape: 0, material: 0, at: [0, 0, 0] }],
  },
};

const folder = process.argv[2];
mkdirSync(folder, { recursive: true });
for (const [name, model] of Object.entries(models)) writeFileSync(path.join(folder, `${name}.glb`), glb(model));
