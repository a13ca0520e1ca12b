// spheres.mjs - a row of spheres as a .glb file, for viewers of glTF: radius 0.46, 1 apart along +X, the first at the origin.
import { writeFileSync } from 'node:fs';

// materials: of glTF, one for each sphere.
export function write_spheres(path, materials, columns = 64, rows = 32) {
    const positions = [], normals = [], indices = [];
    for (let y = 0; y <= rows; y++)
        for (let x = 0; x <= columns; x++) {
            const phi = 2 * Math.PI * x / columns, theta = Math.PI * y / rows;
            const n = [Math.cos(phi) * Math.sin(theta), Math.cos(theta), Math.sin(phi) * Math.sin(theta)];
            normals.push(...n);
            positions.push(...n.map((c) => 0.46 * c));
        }
    for (let y = 0; y < rows; y++)
        for (let x = 0; x < columns; x++) {
            const a = y * (columns + 1) + x, b = a + columns + 1;
            indices.push(a, a + 1, b, b, a + 1, b + 1);
        }
    const binary = Buffer.concat([new Float32Array(positions), new Float32Array(normals), new Uint16Array(indices)]
        .map((a) => Buffer.from(a.buffer)));
    const size = 4 * positions.length, count = positions.length / 3;
    const extensions = [...new Set(materials.flatMap((m) => Object.keys(m.extensions ?? {})))];
    const json = {
        asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: materials.map((_, i) => i) }],
        ...(extensions.length ? { extensionsUsed: extensions } : {}),
        nodes: materials.map((_, i) => ({ mesh: i, translation: [i, 0, 0] })),
        meshes: materials.map((_, i) => ({ primitives: [{ attributes: { POSITION: 0, NORMAL: 1 }, indices: 2, material: i }] })),
        materials,
        accessors: [
            { bufferView: 0, componentType: 5126, count, type: 'VEC3', min: [-0.46, -0.46, -0.46], max: [0.46, 0.46, 0.46] },
            { bufferView: 1, componentType: 5126, count, type: 'VEC3' },
            { bufferView: 2, componentType: 5123, count: indices.length, type: 'SCALAR' }],
        bufferViews: [{ buffer: 0, byteOffset: 0, byteLength: size, target: 34962 }, { buffer: 0, byteOffset: size, byteLength: size, target: 34962 },
            { buffer: 0, byteOffset: 2 * size, byteLength: 2 * indices.length, target: 34963 }],
        buffers: [{ byteLength: binary.length }],
    };
    const chunk = (bytes, type, fill) => {
        const padded = Buffer.concat([bytes, Buffer.alloc(-bytes.length & 3, fill)]), head = Buffer.alloc(8);
        head.writeUInt32LE(padded.length, 0);
        head.write(type, 4, 'latin1');
        return Buffer.concat([head, padded]);
    };
    const chunks = Buffer.concat([chunk(Buffer.from(JSON.stringify(json)), 'JSON', 0x20), chunk(binary, 'BIN\0', 0)]);
    const head = Buffer.alloc(12);
    head.write('glTF', 0, 'latin1');
    head.writeUInt32LE(2, 4);
    head.writeUInt32LE(12 + chunks.length, 8);
    writeFileSync(path, Buffer.concat([head, chunks]));
}
const metal = (roughness) => ({ pbrMetallicRoughness: { metallicFactor: 1, roughnessFactor: roughness } });
export const METALS = [0, 0.2, 0.4, 0.6, 0.8, 1].map(metal);
export const PLASTER = { pbrMetallicRoughness: { metallicFactor: 0, roughnessFactor: 1 } };
