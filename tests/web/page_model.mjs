// page_model.mjs - a model that every control of the page changes: spheres of different materials with a texture, variants, an
// animation, a camera and a light; in one file and in three.
import { execFileSync } from 'node:child_process';
import { mkdirSync, writeFileSync } from 'node:fs';
import path from 'node:path';

const COLUMNS = 24, ROWS = 12;

// Positions that are normals, texture coordinates, indices of a sphere of radius 1.
function sphere() {
    const positions = [], places = [], indices = [];
    for (let row = 0; row <= ROWS; row++)
        for (let column = 0; column <= COLUMNS; column++) {
            const polar = Math.PI * row / ROWS, azimuth = 2 * Math.PI * column / COLUMNS;
            positions.push(Math.sin(polar) * Math.sin(azimuth), Math.cos(polar), Math.sin(polar) * Math.cos(azimuth));
            places.push(column / COLUMNS, row / ROWS);
        }
    for (let row = 0; row < ROWS; row++)
        for (let column = 0; column < COLUMNS; column++) {
            const a = row * (COLUMNS + 1) + column, b = a + COLUMNS + 1;
            indices.push(a, b, a + 1, a + 1, b, b + 1);
        }
    return { positions: Float32Array.from(positions), places: Float32Array.from(places), indices: Uint16Array.from(indices) };
}

const keys = { times: Float32Array.of(0, 1, 2), moves: Float32Array.of(-1.1, 0, 0, -1.1, 1, 0, -1.1, 0, 0) };

const materials = [
    { name: 'Painted', pbrMetallicRoughness: { baseColorTexture: { index: 0 }, metallicFactor: 0, roughnessFactor: 0.4 },
        extensions: { KHR_materials_clearcoat: { clearcoatFactor: 0.5, clearcoatRoughnessFactor: 0.1 } } },
    { name: 'Gold', pbrMetallicRoughness: { baseColorFactor: [1, 0.75, 0.3, 1], metallicFactor: 1, roughnessFactor: 0.8 } },
    { name: 'Veil', alphaMode: 'BLEND', doubleSided: true, pbrMetallicRoughness: { baseColorFactor: [0.2, 0.4, 1, 0.5], metallicFactor: 0, roughnessFactor: 0.2 } },
    { name: 'Lamp', pbrMetallicRoughness: { baseColorFactor: [0, 0, 0, 1], roughnessFactor: 1 }, emissiveFactor: [1, 0.9, 0.6],
        extensions: { KHR_materials_emissive_strength: { emissiveStrength: 8 } } },
];

function gltf(sphere_data, bin, image) {
    const { positions, places, indices } = sphere_data;
    const arrays = [positions, places, indices, keys.times, keys.moves];
    let offset = 0;
    const bufferViews = arrays.map(({ byteLength }) => {
        const view = { buffer: 0, byteOffset: offset, byteLength };
        offset += Math.ceil(byteLength / 4) * 4;
        return view;
    });
    const mesh = (material, variant) => ({ name: materials[material].name, primitives: [{ attributes: { POSITION: 0, NORMAL: 0, TEXCOORD_0: 1 }, indices: 2, material,
        ...(variant === undefined ? {} : { extensions: { KHR_materials_variants: { mappings: [{ material: variant, variants: [0] }] } } }) }] });
    return {
        asset: { version: '2.0', generator: 'tests/web' }, scene: 0, scenes: [{ name: 'Spheres', nodes: [0, 1, 2, 3, 4, 5] }],
        nodes: [{ name: 'Ball', mesh: 0, translation: [-1.1, 0, 0] }, { name: 'Metal', mesh: 1, translation: [1.1, 0, 0] },
            { name: 'Screen', mesh: 2, translation: [0, 0.3, 1.1], scale: [0.8, 0.8, 0.8] }, { name: 'Bulb', mesh: 3, translation: [0, 1.5, -0.5], scale: [0.3, 0.3, 0.3] },
            { name: 'Eye', camera: 0, translation: [0.5, 1, 6] }, { name: 'Sun', rotation: [-0.5, 0.2, 0, 0.842615], extensions: { KHR_lights_punctual: { light: 0 } } }],
        meshes: [mesh(0, 1), mesh(1), mesh(2), mesh(3)], materials, cameras: [{ name: 'Hero', type: 'perspective', perspective: { yfov: 0.6, znear: 0.1 } }],
        textures: [{ source: 0, sampler: 0 }], samplers: [{ wrapS: 33071, wrapT: 33648 }], images: [{ uri: image, name: 'Spheres' }],
        animations: [{ name: 'Jump', samplers: [{ input: 3, output: 4 }], channels: [{ sampler: 0, target: { node: 0, path: 'translation' } }] }],
        extensionsUsed: ['KHR_materials_clearcoat', 'KHR_materials_emissive_strength', 'KHR_materials_variants', 'KHR_lights_punctual'],
        extensions: { KHR_materials_variants: { variants: [{ name: 'Golden' }] },
            KHR_lights_punctual: { lights: [{ name: 'Evening', type: 'directional', intensity: 2, color: [1, 0.6, 0.3] }] } },
        accessors: [{ bufferView: 0, componentType: 5126, count: positions.length / 3, type: 'VEC3', min: [-1, -1, -1], max: [1, 1, 1] },
            { bufferView: 1, componentType: 5126, count: places.length / 2, type: 'VEC2' }, { bufferView: 2, componentType: 5123, count: indices.length, type: 'SCALAR' },
            { bufferView: 3, componentType: 5126, count: 3, type: 'SCALAR', min: [0], max: [2] }, { bufferView: 4, componentType: 5126, count: 3, type: 'VEC3' }],
        bufferViews, buffers: [{ byteLength: offset, uri: bin }],
    };
}

function bytes_of({ positions, places, indices }) {
    return Buffer.concat([positions, places, indices, keys.times, keys.moves].map((array) => {
        const bytes = Buffer.from(array.buffer);
        return Buffer.concat([bytes, Buffer.alloc((4 - bytes.length % 4) % 4)]);
    }));
}

// Writes folder/spheres.glb, and folder/parts/ with spheres.gltf, data/spheres.bin, data/a texture.png and box.obj with box.mtl.
export function write_models(facet, folder) {
    const parts = path.join(folder, 'parts'), data = path.join(parts, 'data');
    mkdirSync(data, { recursive: true });
    execFileSync(facet, ['render', '-s', '16', '-q', '-o', path.join(data, 'a texture.png')]);
    const shape = sphere();
    writeFileSync(path.join(data, 'spheres.bin'), bytes_of(shape));
    writeFileSync(path.join(parts, 'spheres.gltf'), JSON.stringify(gltf(shape, 'data/spheres.bin', 'data/a%20texture.png')));
    writeFileSync(path.join(parts, 'box.obj'), `mtllib box.mtl\nusemtl red\n${[0, 1, 2, 3, 4, 5, 6, 7].map((i) => `v ${i & 1} ${(i >> 1) & 1} ${i >> 2}`).join('\n')}
f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n`);
    writeFileSync(path.join(parts, 'box.mtl'), 'newmtl red\nKd 0.8 0.1 0.1\nKs 0.2 0.2 0.2\nNs 40\n');
    const glb = path.join(folder, 'spheres.glb');
    execFileSync(facet, ['convert', '-q', path.join(parts, 'spheres.gltf'), glb]);
    writeFileSync(path.join(folder, 'broken.glb'), 'glTF but no more');
    writeFileSync(path.join(folder, 'blue.hdr'), blue_panorama());
    return { glb, parts, broken: path.join(folder, 'broken.glb'), light: path.join(folder, 'blue.hdr') };
}

// 8 x 4 texels that are blue everywhere.
function blue_panorama() {
    const texels = Buffer.alloc(4 * 32);
    for (let i = 0; i < texels.length; i += 4) texels.writeUInt32BE(0x00008081, i);
    return Buffer.concat([Buffer.from('#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n'), texels]);
}
