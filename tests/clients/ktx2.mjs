// ktx2.mjs - a KTX 2.0 file read by the letter: every rule of the specification that a texture of floats can break, as
// `ktx validate` (KTX-Software) has them, which is not in Debian 12. Returns what is in the file and what is wrong with it.
import { decompress } from 'fzstd';
import { formats, name_of_vk } from './texels.mjs';

const IDENTIFIER = [0xab, 0x4b, 0x54, 0x58, 0x20, 0x32, 0x30, 0xbb, 0x0d, 0x0a, 0x1a, 0x0a];
const HEADER_SIZE = 80, LEVEL_RECORD = 24, NONE = 0, ZSTD = 2;
const align = (x, unit) => Math.ceil(x / unit) * unit;
const lcm4 = (size) => size % 4 === 0 ? size : size % 2 === 0 ? 2 * size : 4 * size;

// bytes: Uint8Array. Returns { problems: [sentence], format, width, height, faces, is_compressed, metadata: Map, levels: [{
// width, height, texels }] }; texels: Float32Array, RGBA of all faces.
export function read_ktx2(bytes) {
    const problems = [];
    const expect = (is_so, sentence) => { if (!is_so) problems.push(sentence); return is_so; };
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    if (!expect(bytes.length >= HEADER_SIZE && IDENTIFIER.every((x, i) => bytes[i] === x), 'no KTX 2.0 file'))
        return { problems };
    const u32 = (at) => view.getUint32(at, true), u64 = (at) => Number(view.getBigUint64(at, true));
    const [vk, type_size, width, height, depth, layers, faces, level_count, scheme, dfd_at, dfd_size, kvd_at, kvd_size] =
        Array.from({ length: 13 }, (_, i) => u32(12 + 4 * i));
    const sgd_at = u64(64), sgd_size = u64(72);
    const format = name_of_vk.get(vk), texel = formats[format];
    if (!expect(texel, `vkFormat ${vk} is not one of facet's`)) return { problems };
    expect(type_size === texel.type_size, `typeSize ${type_size}, not ${texel.type_size}`);
    expect(width > 0 && height > 0 && depth === 0, `size ${width} x ${height} x ${depth}`);
    expect(layers === 0, `layerCount ${layers}`);
    expect(faces === 1 || faces === 6, `faceCount ${faces}`);
    expect(faces === 1 || width === height, `a cube map of ${width} x ${height}`);
    expect(scheme === NONE || scheme === ZSTD, `supercompressionScheme ${scheme}`);
    if (!expect(level_count >= 1 && 2 ** (level_count - 1) <= Math.max(width, height), `levelCount ${level_count}`))
        return { problems };
    const index_end = HEADER_SIZE + LEVEL_RECORD * level_count;
    expect(dfd_at === index_end, `dfdByteOffset ${dfd_at}, not ${index_end}`);
    expect(kvd_size === 0 ? kvd_at === 0 : kvd_at === dfd_at + dfd_size, `kvdByteOffset ${kvd_at}`);
    expect(sgd_at === 0 && sgd_size === 0, `global data of a supercompression at ${sgd_at}, ${sgd_size} bytes`);
    if (!expect(dfd_at + dfd_size <= bytes.length && kvd_at + kvd_size <= bytes.length, 'the front is cut off'))
        return { problems };
    check_descriptor(view, dfd_at, dfd_size, texel, expect);
    const metadata = read_metadata(bytes, kvd_at, kvd_size, expect);
    expect(metadata.has('KTXwriter'), 'KTXwriter is missing');
    if (metadata.has('KTXorientation'))
        expect(metadata.get('KTXorientation') === 'rd', `KTXorientation ${metadata.get('KTXorientation')}, not rd`);

    const unit = scheme === NONE ? lcm4(texel.size) : 1, levels = [];
    let at = kvd_size ? kvd_at + kvd_size : dfd_at + dfd_size;
    for (let i = level_count - 1; i >= 0; i--) { // the smallest first
        const [offset, size, whole_size] = [0, 8, 16].map((k) => u64(HEADER_SIZE + LEVEL_RECORD * i + k));
        const w = Math.max(1, width >> i), h = Math.max(1, height >> i), expected = w * h * faces * texel.size;
        expect(offset === align(at, unit), `level ${i} is at ${offset}, not ${align(at, unit)}`);
        expect(bytes.subarray(at, offset).every((x) => x === 0), `padding before level ${i} is not 0`);
        expect(whole_size === expected, `level ${i} has an uncompressedByteLength of ${whole_size}, not ${expected}`);
        expect(scheme !== NONE || size === expected, `level ${i} has a byteLength of ${size}, not ${expected}`);
        if (!expect(offset + size <= bytes.length, `level ${i} is past the end of the file`)) return { problems };
        let texels = bytes.subarray(offset, offset + size);
        if (scheme === ZSTD) texels = inflate(texels, i, expect);
        if (!expect(texels.length === expected, `level ${i} holds ${texels.length} bytes, not ${expected}`))
            return { problems };
        levels[i] = { width: w, height: h, texels: decode(texels, texel) };
        at = offset + size;
    }
    expect(at === bytes.length, `the file ends at ${bytes.length}, not after level 0 at ${at}`);
    return { problems, format, width, height, faces, is_compressed: scheme === ZSTD, metadata, levels };
}

// One block, the basic one, whose samples are those of the format; a plane has as many bytes as a texel, compressed or not.
function check_descriptor(view, at, size, texel, expect) {
    const word = (i) => view.getUint32(at + 4 * i, true), samples = texel.samples;
    const expected = 28 + 16 * samples.length;
    if (!expect(size === expected && word(0) === expected, `a descriptor of ${size} and ${word(0)} bytes, not ${expected}`))
        return;
    expect(word(1) === 0, `the descriptor's vendor and type are ${word(1)}, not those of Khronos' basic block`);
    expect(word(2) === (2 | (expected - 4) << 16), `the descriptor's version and size are 0x${word(2).toString(16)}`);
    expect(word(3) === (1 | 1 << 8 | 1 << 16), `model, primaries, transfer, flags are 0x${word(3).toString(16)}, ` +
        'not RGBSDA, BT.709, linear, straight alpha');
    expect(word(4) === 0, 'the texel block is not 1 x 1 x 1 x 1');
    expect(word(5) === texel.size && word(6) === 0, `bytesPlane are ${word(5)}, ${word(6)}, not ${texel.size}, 0`);
    samples.forEach(([first, bits, channel, lower, upper], i) => {
        const want = [(first | (bits - 1) << 16 | channel << 24) >>> 0, 0, lower, upper];
        want.forEach((x, k) => expect(word(7 + 4 * i + k) === x,
            `sample ${i}, word ${k} of the descriptor is 0x${word(7 + 4 * i + k).toString(16)}, not 0x${x.toString(16)}`));
    });
}

// Keys with values that end in NUL; sorted, each key once, padding to 4 bytes 0.
function read_metadata(bytes, at, size, expect) {
    const metadata = new Map(), end = at + size, utf8 = new TextDecoder('utf-8', { fatal: true, ignoreBOM: true });
    let last = '';
    while (at < end) {
        if (!expect(end - at >= 6, `${end - at} bytes are left of the metadata`)) break;
        const length = new DataView(bytes.buffer, bytes.byteOffset + at).getUint32(0, true), next = align(at + 4 + length, 4);
        if (!expect(length >= 2 && at + 4 + length <= end, `metadata of ${length} bytes at ${at}`)) break;
        const entry = bytes.subarray(at + 4, at + 4 + length), nul = entry.indexOf(0);
        if (!expect(nul > 0, `a key at ${at} is empty or has no end`)) break;
        try {
            const key = utf8.decode(entry.subarray(0, nul)), value = entry.subarray(nul + 1);
            expect(!key.startsWith('\ufeff'), `the key ${key} begins with a byte order mark`);
            expect(!/^ktx/i.test(key) || ['KTXorientation', 'KTXwriter', 'KTXwriterScParams', 'KTXswizzle'].includes(key),
                `the key ${key} is reserved`);
            expect(key > last, `the key ${key} stands behind ${last}`);
            expect(value.length > 0 && value[value.length - 1] === 0, `the value of ${key} does not end in NUL`);
            metadata.set(last = key, utf8.decode(value.subarray(0, -1)));
        } catch {
            expect(false, `metadata at ${at} is not UTF-8`);
        }
        expect(next <= end && bytes.subarray(at + 4 + length, next).every((x) => x === 0),
            `padding behind the metadata at ${at} is not 0 or not there`);
        at = next;
    }
    expect(at === end, 'the metadata does not end where it should');
    return metadata;
}

function inflate(bytes, level, expect) {
    try {
        return decompress(bytes);
    } catch (error) {
        expect(false, `level ${level} is not inflated: ${error.message ?? error}`);
        return new Uint8Array(0);
    }
}

function decode(bytes, texel) {
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength), count = bytes.length / texel.size;
    const out = new Float32Array(4 * count);
    for (let i = 0; i < count; i++) out.set(texel.decode(view, i * texel.size), 4 * i);
    return out;
}
