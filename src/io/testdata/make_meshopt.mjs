// make_meshopt.mjs - writes meshopt.bin beside it, with the encoder and decoder of the npm package meshoptimizer 1.3:
//     npm install meshoptimizer@1.3.0 && node make_meshopt.mjs
// A record: mode, filter, count, stride, size of the stream, size of what follows it (each 32 bits, little-endian), the
// stream, then what it decodes to. Attributes without filter have none of that: meshopt_test.c computes them again.
import fs from 'fs';
import { MeshoptDecoder as decoder } from 'meshoptimizer/decoder';
import { MeshoptEncoder as encoder } from 'meshoptimizer/encoder';

await encoder.ready;
await decoder.ready;
const modes = ['ATTRIBUTES', 'TRIANGLES', 'INDICES'];
const filters = ['NONE', 'OCTAHEDRAL', 'QUATERNION', 'EXPONENTIAL', 'COLOR'];
const file = fs.openSync(new URL('meshopt.bin', import.meta.url), 'w');

let state = 1;
const random = () => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0) / 2 ** 32;

function put(mode, filter, count, stride, stream) {
    const decoded = new Uint8Array(mode || filter ? count * stride : 0);
    if (decoded.length)
        decoder.decodeGltfBuffer(decoded, count, stride, stream, modes[mode], filters[filter]);
    fs.writeSync(file, new Uint8Array(new Uint32Array([mode, filter, count, stride, stream.length, decoded.length]).buffer));
    fs.writeSync(file, stream);
    fs.writeSync(file, decoded);
}

// attribute_word() of meshopt_test.c
function word(i, channel) {
    const noise = Math.imul((Math.imul(i, 64) + channel + 1) >>> 0, 2654435761) >>> 0;
    switch (channel % 6) {
    case 0: return (Math.imul(i, 257 * (channel + 1)) + (noise >>> 30)) >>> 0; // bytes of a ramp
    case 1: return ((i * 37 & 0xffff) | (65535 - i * 91 & 0xffff) << 16) >>> 0; // two ramps of 16 bits
    case 2: return (0x3f800000 + (noise >>> 20)) >>> 0; // floats above 1
    case 3: return noise; // does not compress
    case 4: return 0;
    default: return noise >>> 24 < 9 ? noise : 0x01020304; // rare exceptions
    }
}

for (const stride of [4, 8, 12, 16, 20, 24, 28, 32, 48, 64, 100, 128, 200, 252, 256])
    for (const version of [0, 1])
        for (const count of [1, 17, stride <= 32 ? 300 : 3 * Math.floor(8192 / stride / 16) * 16 + 5].slice(stride > 32 ? 2 : 0)) {
            const data = new DataView(new ArrayBuffer(count * stride));
            for (let i = 0; i < count; i++)
                for (let c = 0; c < stride / 4; c++)
                    data.setUint32(i * stride + 4 * c, word(i, c), true);
            const level = version ? (stride / 4) % 4 : 2;
            if (count * stride < 12000)
                put(0, 0, count, stride, encoder.encodeVertexBufferLevel(new Uint8Array(data.buffer), count, stride, level, version));
        }

const unit = (n) => {
    const v = Array.from({ length: n }, () => 2 * random() - 1);
    const length = Math.hypot(...v);
    return v.map((x) => x / length);
};
const attributes = (bytes, count, stride, version) => encoder.encodeVertexBufferLevel(bytes, count, stride, 2, version);
const count = 40;
for (const stride of [4, 8])
    for (let bits = 2; bits <= 2 * stride; bits += stride / 4) {
        const vectors = new Float32Array(4 * count);
        for (let i = 0; i < count; i++)
            vectors.set([...(i < 6 ? [0, 1, 2].map((k) => (k === i >> 1 ? (i & 1 ? -1 : 1) : 0)) : unit(3)), random()], 4 * i);
        put(0, 1, count, stride, attributes(encoder.encodeFilterOct(vectors, count, stride, bits), count, stride, bits >> 1 & 1));
        const colors = new Float32Array(4 * count);
        for (let i = 0; i < 4 * count; i++)
            colors[i] = i < 16 ? (i * 7 >> 2) & 1 : random();
        put(0, 4, count, stride, attributes(encoder.encodeFilterColor(colors, count, stride, bits), count, stride, 1));
    }
for (let bits = 4; bits <= 16; bits += 3) {
    const rotations = new Float32Array(4 * count);
    for (let i = 0; i < count; i++)
        rotations.set(i < 4 ? [0, 1, 2, 3].map((k) => (k === i ? 1 : 0)) : unit(4), 4 * i);
    put(0, 2, count, 8, attributes(encoder.encodeFilterQuat(rotations, count, 8, bits), count, 8, bits & 1));
}
for (const mode of ['Separate', 'SharedVector', 'SharedComponent', 'Clamped'])
    for (const bits of [1, 15, 24]) {
        const floats = new Float32Array(3 * count);
        for (let i = 0; i < 3 * count; i++)
            floats[i] = i < 3 ? 0 : (2 * random() - 1) * 10 ** (20 * random() - 10);
        put(0, 3, count, 12, attributes(encoder.encodeFilterExp(floats, count, 12, bits, mode), count, 12, bits & 1));
    }

const lists = [[], [], Array.from({ length: 90 }, (_, i) => i), Array.from({ length: 150 }, () => Math.floor(900 * random()))];
for (let y = 0; y < 9; y++)
    for (let x = 0; x < 9; x++) {
        const i = 10 * y + x;
        lists[0].push(i, i + 1, i + 10, i + 1, i + 11, i + 10);
    }
lists[1] = lists[0].concat(lists[0], lists[2]);
const [order] = encoder.reorderMesh(new Uint32Array(lists[0]), true, false);
lists.push(lists[0].map((i) => order[i]));
for (const list of lists)
    for (const stride of [2, 4]) {
        const bytes = new Uint8Array(new Uint32Array(list).buffer);
        put(1, 0, list.length, stride, encoder.encodeIndexBuffer(bytes, list.length, 4));
        put(2, 0, list.length, stride, encoder.encodeIndexSequence(bytes, list.length, 4));
    }
const far = new Uint32Array([0, 4000000000, 5, 4000000000, 0, 17]);
put(2, 0, 6, 4, encoder.encodeIndexSequence(new Uint8Array(far.buffer), 6, 4));
