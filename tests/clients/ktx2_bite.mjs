// ktx2_bite.mjs - files that break a rule of KTX 2.0 in one place each, for a reader that is to notice: bytes of a good file of
// a cube map with levels go in, [what is wrong, bytes] come out.
const word = (at, value) => (view) => view.setUint32(at, value, true);

export function broken_files(good) {
    const view = new DataView(good.buffer, good.byteOffset, good.byteLength), u32 = (at) => view.getUint32(at, true);
    const levels = u32(40), dfd = u32(48), kvd = u32(56), kvd_size = u32(60), last = 80 + 24 * (levels - 1);
    const first_texels = Number(view.getBigUint64(last, true)), value_end = kvd + 4 + u32(kvd);
    const changes = [
        ['identifier', word(0, 0)], ['another vkFormat', word(12, 98)], ['typeSize', word(16, 1)], ['no width', word(20, 0)],
        ['not square', word(24, u32(24) * 2)], ['depth', word(28, 1)], ['layers', word(32, 1)], ['faces', word(36, 5)],
        ['no level', word(40, 0)], ['too many levels', word(40, 20)], ['BasisLZ', word(44, 1)],
        ['place of the descriptor', word(48, dfd + 4)], ['size of the descriptor', word(52, u32(52) - 16)],
        ['place of the metadata', word(56, kvd + 4)], ['size of the metadata', word(60, kvd_size - 4)],
        ['global data', word(72, 8)], ['place of a level', word(last, first_texels + 16)], ['unaligned level', word(last, first_texels + 1)],
        ['size of a level', word(last + 8, u32(last + 8) - 8)], ['whole size of a level', word(last + 16, u32(last + 16) - 8)],
        ['total size in the descriptor', word(dfd, u32(dfd) + 16)], ['vendor', word(dfd + 4, 1)], ['version', word(dfd + 8, u32(dfd + 8) ^ 1)],
        ['model', word(dfd + 12, u32(dfd + 12) ^ 2)], ['transfer sRGB', word(dfd + 12, u32(dfd + 12) ^ 3 << 16)],
        ['block size', word(dfd + 16, 3)], ['bytesPlane', word(dfd + 20, 0)], ['channel of a sample', word(dfd + 28, u32(dfd + 28) ^ 1 << 24)],
        ['lower of a sample', word(dfd + 36, 1)], ['upper of a sample', word(dfd + 40, 0)],
        ['length of a key', word(kvd, kvd_size)], ['reserved key', (v) => v.setUint8(kvd + 7, 'x'.charCodeAt(0))],
        ['key that is no UTF-8', (v) => v.setUint8(kvd + 4, 0xff)], ['unsorted keys', (v) => v.setUint8(kvd + 4, 'a'.charCodeAt(0))],
        ['no NUL behind a value', (v) => v.setUint8(value_end - 1, 'x'.charCodeAt(0))],
    ].map(([what, change]) => {
        const bytes = good.slice();
        change(new DataView(bytes.buffer));
        return [what, bytes];
    });
    const padding = value_end % 4 ? [['padding of the metadata', value_end]] : [];
    for (const [what, at] of padding) {
        const bytes = good.slice();
        bytes[at] = 1;
        changes.push([what, bytes]);
    }
    changes.push(['cut off', good.slice(0, -1)], ['something behind the end', new Uint8Array([...good, 0])]);
    return changes;
}
