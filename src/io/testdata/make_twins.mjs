// make_twins.mjs - writes sail.glb and the same model compressed without loss: sail_meshopt_ext.glb (version 0),
// sail_meshopt_khr.glb (version 1), sail_draco_sequential.glb and sail_draco_edgebreaker.glb. Needs npm packages:
//     npm install meshoptimizer@1.3.0 draco3dgltf@1.5.7 && node make_twins.mjs
import fs from 'fs';
import draco3d from 'draco3dgltf';
import { MeshoptEncoder } from 'meshoptimizer/encoder';

await MeshoptEncoder.ready;
const draco = await draco3d.createEncoderModule({});
const EDGE = 6; // quads along an edge
const COUNT = (EDGE + 1) ** 2;

// ---- the model: a bent sheet as triangles, as one strip, and once more as triangles ----

const attributes = {
    POSITION: { type: 'VEC3', array: new Float32Array(3 * COUNT) },
    NORMAL: { type: 'VEC3', array: new Float32Array(3 * COUNT) },
    TANGENT: { type: 'VEC4', array: new Float32Array(4 * COUNT) },
    TEXCOORD_0: { type: 'VEC2', array: new Uint16Array(2 * COUNT), normalized: true },
    TEXCOORD_1: { type: 'VEC2', array: new Float32Array(2 * COUNT) },
    COLOR_0: { type: 'VEC4', array: new Uint8Array(4 * COUNT), normalized: true },
    JOINTS_0: { type: 'VEC4', array: new Uint8Array(4 * COUNT) },
    WEIGHTS_0: { type: 'VEC4', array: new Uint16Array(4 * COUNT), normalized: true },
    _TEMPERATURE: { type: 'SCALAR', array: new Float32Array(COUNT) },
};
const target = { type: 'VEC3', isTarget: true, array: new Float32Array(3 * COUNT) };
for (let i = 0; i < COUNT; i++) {
    const u = (i % (EDGE + 1)) / EDGE;
    const v = Math.floor(i / (EDGE + 1)) / EDGE;
    const slope = -2 * (u - 0.5);
    const length = Math.hypot(slope, 1);
    attributes.POSITION.array.set([u, v, u - u * u], 3 * i);
    attributes.NORMAL.array.set([slope / length, 0, 1 / length], 3 * i);
    attributes.TANGENT.array.set([1 / length, 0, -slope / length, 1], 4 * i);
    attributes.TEXCOORD_0.array.set([u * 65535, v * 65535], 2 * i);
    attributes.TEXCOORD_1.array.set([2 * v, -u], 2 * i);
    attributes.COLOR_0.array.set([255 * u, 255 * v, 7 * (i % 9), 255], 4 * i);
    attributes.JOINTS_0.array.set([0, v > 0 ? 1 : 0, 0, 0], 4 * i);
    attributes.WEIGHTS_0.array.set([65535 - Math.round(v * 32767), Math.round(v * 32767), 0, 0], 4 * i);
    attributes._TEMPERATURE.array[i] = 20 + i / 8;
    target.array.set([0, v * v, -u], 3 * i);
}
const list = [];
const strip = [];
for (let y = 0; y < EDGE; y++)
    for (let x = 0; x < EDGE; x++) {
        const i = y * (EDGE + 1) + x;
        list.push(i, i + 1, i + EDGE + 1, i + 1, i + EDGE + 2, i + EDGE + 1);
    }
for (let x = 0; x <= EDGE; x++)
    strip.push(EDGE + 1 + x, x); // the lowest row of quads
const stripAsList = [];
for (let i = 0; i + 2 < strip.length; i++)
    stripAsList.push(strip[i], strip[i + 1 + (i % 2)], strip[i + 2 - (i % 2)]);

// ---- glTF ----

class Model {
    chunks = [];
    size = 0;
    json = {
        asset: { version: '2.0', generator: 'make_twins.mjs of facet' },
        scene: 0,
        scenes: [{ nodes: [0, 2, 3] }],
        nodes: [{ mesh: 0, skin: 0 }, { translation: [0, 1, 0] }, { children: [1] }, { mesh: 1, skin: 0 }],
        skins: [{ joints: [2, 1] }],
        accessors: [],
        bufferViews: [],
        buffers: [],
    };
    // Returns where the bytes are.
    add(bytes) {
        const at = this.size;
        const padded = new Uint8Array((bytes.byteLength + 3) & ~3);
        padded.set(new Uint8Array(bytes.buffer, bytes.byteOffset, bytes.byteLength));
        this.chunks.push(padded);
        this.size += padded.length;
        return { buffer: 0, byteOffset: at, byteLength: bytes.byteLength };
    }
    accessor(a, view) {
        const count = a.array.length / { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 }[a.type];
        const component = { Float32Array: 5126, Uint32Array: 5125, Uint16Array: 5123, Uint8Array: 5121 }[a.array.constructor.name];
        const json = { componentType: component, count, type: a.type };
        if (a.normalized) json.normalized = true;
        if (a === attributes.POSITION || a.isTarget) {
            const of = (pick) => [0, 1, 2].map((k) => pick(...a.array.filter((_, i) => i % 3 === k)));
            json.min = of(Math.min);
            json.max = of(Math.max);
        }
        if (view !== undefined) json.bufferView = view;
        return this.json.accessors.push(json) - 1;
    }
    view(json) {
        return this.json.bufferViews.push(json) - 1;
    }
    // stripMorph, stripNamed: of the strip, where they are others; extensions: of triangles and strip, where there are any.
    meshes(named, indices, stripIndices, morph, stripMorph = morph, stripNamed = named, extensions = []) {
        const primitive = (indices, mode, extension) => ({
            attributes: mode === 5 ? stripNamed : named,
            indices,
            mode,
            ...(morph !== undefined && { targets: [{ POSITION: mode === 5 ? stripMorph : morph }] }),
            ...(extension && { extensions: extension }),
        });
        this.json.meshes = [
            { primitives: [primitive(indices, 4, extensions[0]), primitive(stripIndices, 5, extensions[1])] },
            { primitives: [primitive(indices, 4, extensions[0])] },
        ];
    }
    write(name) {
        this.json.buffers.unshift({ byteLength: this.size });
        let text = JSON.stringify(this.json);
        text += ' '.repeat(-Buffer.byteLength(text) & 3);
        const words = (...values) => Buffer.from(new Uint32Array(values).buffer);
        const parts = [words(text.length, 0x4e4f534a), Buffer.from(text), words(this.size, 0x4e4942), ...this.chunks];
        const total = parts.reduce((sum, part) => sum + part.length, 12);
        fs.writeFileSync(new URL(name, import.meta.url), Buffer.concat([words(0x46546c67, 2, total), ...parts]));
    }
}

const indexArrays = [new Uint16Array(list), new Uint16Array(strip)];

function writeWithViews(name, makeView, extension) {
    const model = new Model();
    const of = (a, mode) => model.accessor(a, model.view(makeView(model, a, mode)));
    const named = Object.fromEntries(Object.entries(attributes).map(([key, a]) => [key, of(a, 'ATTRIBUTES')]));
    const indices = of({ type: 'SCALAR', array: indexArrays[0] }, 'TRIANGLES');
    const stripIndices = of({ type: 'SCALAR', array: indexArrays[1] }, 'INDICES');
    model.meshes(named, indices, stripIndices, of(target, 'ATTRIBUTES'));
    if (extension) {
        model.json.extensionsUsed = model.json.extensionsRequired = [extension];
        model.json.buffers.push({ byteLength: model.fallback, extensions: { [extension]: { fallback: true } } });
    }
    model.write(name);
}

writeWithViews('sail.glb', (model, a, mode) => ({ ...model.add(a.array), target: mode === 'ATTRIBUTES' ? 34962 : 34963 }));

function compressed(extension, version) {
    return (model, a, mode) => {
        const bytes = new Uint8Array(a.array.buffer);
        const count = mode === 'ATTRIBUTES' ? a.array.length / { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 }[a.type] : a.array.length;
        const stride = bytes.length / count;
        const stream = mode === 'ATTRIBUTES' ? MeshoptEncoder.encodeVertexBufferLevel(bytes, count, stride, 3, version)
            : MeshoptEncoder.encodeGltfBuffer(bytes, count, stride, mode);
        const at = model.fallback ?? 0;
        model.fallback = at + ((bytes.length + 3) & ~3);
        return {
            buffer: 1,
            byteOffset: at,
            byteLength: bytes.length,
            extensions: { [extension]: { ...model.add(stream), byteStride: stride, count, mode } },
        };
    };
}
writeWithViews('sail_meshopt_ext.glb', compressed('EXT_meshopt_compression', 0), 'EXT_meshopt_compression');
writeWithViews('sail_meshopt_khr.glb', compressed('KHR_meshopt_compression', 1), 'KHR_meshopt_compression');

// ---- Draco ----

// With the vertices up to the last that triangles use.
function encodeDraco(method, triangles) {
    const count = Math.max(...triangles) + 1;
    const encoder = new draco.Encoder();
    const builder = new draco.MeshBuilder();
    const mesh = new draco.Mesh();
    const ids = {};
    builder.AddFacesToMesh(mesh, triangles.length / 3, new Uint32Array(triangles));
    for (const [key, a] of Object.entries(attributes)) {
        const kind = draco[{ POSITION: 'POSITION', NORMAL: 'NORMAL', COLOR_0: 'COLOR', TEXCOORD_0: 'TEX_COORD', TEXCOORD_1: 'TEX_COORD' }[key] ?? 'GENERIC'];
        const add = { Float32Array: 'AddFloatAttributeToMesh', Uint16Array: 'AddUInt16Attribute', Uint8Array: 'AddUInt8Attribute' }[a.array.constructor.name];
        const components = a.array.length / COUNT;
        ids[key] = builder[add](mesh, kind, count, components, a.array.slice(0, count * components));
    }
    encoder.SetEncodingMethod(draco[method]);
    encoder.SetSpeedOptions(3, 3); // no quantisation: floats stay as they are
    const out = new draco.DracoInt8Array();
    const size = encoder.EncodeMeshToDracoBuffer(mesh, out);
    const bytes = Uint8Array.from({ length: size }, (_, i) => out.GetValue(i));
    return { bytes, ids, count };
}

for (const [method, name] of [['MESH_SEQUENTIAL_ENCODING', 'sail_draco_sequential.glb'], ['MESH_EDGEBREAKER_ENCODING', 'sail_draco_edgebreaker.glb']]) {
    const model = new Model();
    const parts = [list, stripAsList].map((triangles, part) => {
        const { bytes, ids, count } = encodeDraco(method, triangles);
        const named = Object.fromEntries(Object.entries(attributes).map(([key, a]) => [key, model.accessor(a)]));
        Object.values(named).forEach((accessor) => (model.json.accessors[accessor].count = count));
        return {
            named,
            indices: model.accessor({ type: 'SCALAR', array: indexArrays[part] }),
            extension: { KHR_draco_mesh_compression: { bufferView: model.view(model.add(bytes)), attributes: ids } },
        };
    });
    // Edgebreaker changes the order of vertices: morph targets, which are not in the bitstream, would have to follow
    const morphs = [];
    if (method === 'MESH_SEQUENTIAL_ENCODING')
        for (const part of parts) {
            const array = target.array.slice(0, 3 * model.json.accessors[part.named.POSITION].count);
            morphs.push(model.accessor({ type: 'VEC3', isTarget: true, array }, model.view(model.add(array))));
        }
    model.meshes(parts[0].named, parts[0].indices, parts[1].indices, ...(morphs.length ? morphs : [undefined, undefined]),
        parts[1].named, parts.map((part) => part.extension));
    model.json.extensionsUsed = model.json.extensionsRequired = ['KHR_draco_mesh_compression'];
    model.write(name);
}
