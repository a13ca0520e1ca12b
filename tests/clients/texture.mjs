// texture.mjs - what pages say of a texture's texels, compared: with a file, with a closed form, with one another.
import { FACES, colors_of, texel_direction } from './light.mjs';

// Floats that a page sent.
export function floats(text) {
    const bytes = Buffer.from(text, 'base64');
    return new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
}

// The largest |a - b| of R, G, B over RGBA texels.
export function largest_difference(a, b) {
    let worst = a.length === b.length ? 0 : Infinity;
    for (let i = 0; i < a.length; i++) if (i % 4 < 3 && !(Math.abs(a[i] - b[i]) <= worst)) worst = Math.abs(a[i] - b[i]);
    return worst;
}

// Root of the mean of (a - b)^2, relative to that of b; and (mean of a) / (mean of b).
export function relative_error(a, b) {
    let error = 0, square = 0, sum_a = 0, sum_b = 0;
    for (let i = 0; i < a.length; i++) {
        if (i % 4 === 3) continue;
        error += (a[i] - b[i]) ** 2;
        square += b[i] ** 2;
        sum_a += a[i];
        sum_b += b[i];
    }
    return { rms: Math.sqrt(error / square), mean: sum_a / sum_b };
}

// How far six faces of size x size are from the light of light.mjs with its slope scaled by k, and where that is. turn: from a
// direction of the texture to that of the light.
export function distance_to_colors(texels, size, k, turn = (d) => d) {
    let worst = 0, where = '';
    for (let face = 0; face < 6; face++)
        for (let y = 0; y < size; y++)
            for (let x = 0; x < size; x++) {
                const wanted = colors_of(turn(texel_direction(face, x, y, size)), k), i = 4 * ((face * size + y) * size + x);
                for (let c = 0; c < 3; c++) {
                    const error = Math.abs(texels[i + c] - wanted[c]);
                    if (!(error <= worst)) [worst, where] = [error, `${FACES[face]} ${x}, ${y}: ${texels[i + c]} for ${wanted[c]}`];
                }
            }
    return { worst, where };
}

// The k for which six faces of size x size are nearest to that light with its slope scaled by k, by least squares, and how far
// the texels are from it: texels that lie elsewhere, or lean to one side, are far.
export function fit_colors(texels, size, turn = (d) => d) {
    let product = 0, square = 0;
    for (let face = 0; face < 6; face++)
        for (let y = 0; y < size; y++)
            for (let x = 0; x < size; x++) {
                const slope = colors_of(turn(texel_direction(face, x, y, size))), i = 4 * ((face * size + y) * size + x);
                slope.forEach((value, c) => {
                    product += (texels[i + c] - 1) * (value - 1);
                    square += (value - 1) ** 2;
                });
            }
    const k = product / square;
    return { k, ...distance_to_colors(texels, size, k, turn) };
}

// The bytes of a data URL.
export const png_of = (url) => Buffer.from(url.split(',')[1], 'base64');
