// texels.mjs - the texels of float that KTX2 files hold, by Vulkan's names: what a file of each has to say of itself
// (Khronos Data Format Specification 1.3), and their numbers. Written from the specifications, not from facet's writer.

const exponent_of_half = (code) => (code >> 10) & 31;

export function half_to_float(code) {
    const digits = code & 1023, exponent = exponent_of_half(code), sign = code & 0x8000 ? -1 : 1;
    if (exponent === 31) return digits ? NaN : sign * Infinity;
    return sign * (exponent ? (1 + digits / 1024) * 2 ** (exponent - 15) : digits * 2 ** -24);
}

// Unsigned floats with an exponent of 5 bits and digit_bits behind it: 6 (11 bits in all) or 5 (10 bits).
export function small_to_float(code, digit_bits) {
    const one = 1 << digit_bits, digits = code & (one - 1), exponent = code >> digit_bits;
    if (exponent === 31) return digits ? NaN : Infinity;
    return exponent ? (1 + digits / one) * 2 ** (exponent - 15) : (digits / one) * 2 ** -14;
}

const ONE = 0x3f800000, MINUS_ONE = 0xbf800000;
const R = 0, G = 1, B = 2, A = 15, EXPONENT = 0x20, SIGNED = 0x40, FLOAT = 0x80;
// First bit, bits, channel with its qualifiers, lower, upper.
const plain = (channels, bits) => channels.map((channel, i) =>
    [bits * i, bits, channel | FLOAT | SIGNED, MINUS_ONE, ONE]);

const half_texels = (count) => (view, at) => {
    const texel = [0, 0, 0, 1];
    for (let c = 0; c < count; c++) texel[c] = half_to_float(view.getUint16(at + 2 * c, true));
    return texel;
};
const float_texels = (count) => (view, at) => {
    const texel = [0, 0, 0, 1];
    for (let c = 0; c < count; c++) texel[c] = view.getFloat32(at + 4 * c, true);
    return texel;
};

// size: bytes of a texel; type_size: bytes of what is swapped where bytes are the other way around; channels that it has;
// samples of its descriptor; decode(view, offset): RGBA.
export const formats = {
    rgba16f: { vk: 97, size: 8, type_size: 2, channels: 4, samples: plain([R, G, B, A], 16), decode: half_texels(4) },
    rg16f: { vk: 83, size: 4, type_size: 2, channels: 2, samples: plain([R, G], 16), decode: half_texels(2) },
    r16f: { vk: 76, size: 2, type_size: 2, channels: 1, samples: plain([R], 16), decode: half_texels(1) },
    rgba32f: { vk: 109, size: 16, type_size: 4, channels: 4, samples: plain([R, G, B, A], 32), decode: float_texels(4) },
    rg32f: { vk: 103, size: 8, type_size: 4, channels: 2, samples: plain([R, G], 32), decode: float_texels(2) },
    r32f: { vk: 100, size: 4, type_size: 4, channels: 1, samples: plain([R], 32), decode: float_texels(1) },
    b10g11r11: {
        vk: 122, size: 4, type_size: 4, channels: 3,
        samples: [[0, 11, R | FLOAT, 0, ONE], [11, 11, G | FLOAT, 0, ONE], [22, 10, B | FLOAT, 0, ONE]],
        decode: (view, at) => {
            const word = view.getUint32(at, true);
            return [small_to_float(word & 2047, 6), small_to_float((word >>> 11) & 2047, 6),
                small_to_float(word >>> 22, 5), 1];
        },
    },
    rgb9e5: {
        vk: 123, size: 4, type_size: 4, channels: 3,
        // 1 is 256 / 512 with an exponent of 16: 16 << 9 | 256 = 8448. An exponent's lower is its bias.
        samples: [0, 1, 2].flatMap((c) => [[9 * c, 9, c, 0, 8448], [27, 5, c | EXPONENT, 15, 31]]),
        decode: (view, at) => {
            const word = view.getUint32(at, true), scale = 2 ** ((word >>> 27) - 24);
            return [(word & 511) * scale, ((word >>> 9) & 511) * scale, ((word >>> 18) & 511) * scale, 1];
        },
    },
};
export const name_of_vk = new Map(Object.entries(formats).map(([name, f]) => [f.vk, name]));

const largest = { rgba16f: [65504, 65504, 65504], rg16f: [65504, 65504], r16f: [65504],
    rgba32f: [Infinity, Infinity, Infinity], rg32f: [Infinity, Infinity], r32f: [Infinity],
    b10g11r11: [65024, 65024, 64512], rgb9e5: [65408, 65408, 65408] };

// Half the distance of the numbers beside x, digit_bits behind the leading one: what rounding to the nearest may cost.
const rounding = (x, digit_bits) => 2 ** (Math.max(Math.floor(Math.log2(x)), -14) - digit_bits - 1);

// Whether stored (RGBA) is what format has nearest to texel, or its largest number; ties may go either way.
export function is_nearest(format, texel, stored) {
    const most = largest[format];
    if (format === 'rgb9e5') {
        // The exponent is that of the largest channel after rounding (EXT_texture_shared_exponent, "encoding").
        const clamped = texel.slice(0, 3).map((x, c) => Math.min(Math.max(x, 0), most[c]));
        const largest_channel = Math.max(...clamped);
        let exponent = Math.max(-16, largest_channel > 0 ? Math.floor(Math.log2(largest_channel)) : -16) + 16;
        if (Math.floor(largest_channel / 2 ** (exponent - 24) + 0.5) === 512) exponent++;
        const unit = 2 ** (exponent - 24);
        return clamped.every((x, c) => Math.abs(stored[c] - x) <= 0.5 * unit && stored[c] % unit === 0);
    }
    return most.every((limit, c) => {
        const x = Math.min(texel[c], limit);
        if (format.endsWith('32f')) return stored[c] === x;
        if (x === 0) return stored[c] === 0;
        const digits = format === 'b10g11r11' ? (c === 2 ? 5 : 6) : 10;
        return Math.abs(stored[c] - x) <= rounding(x, digits);
    });
}
