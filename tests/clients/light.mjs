// light.mjs - a light whose filtered cube maps are known in closed form, so that the color of a texel encodes where it
// belongs: radiance 1 + 0.75 (x, y, z) of the direction, in red, green and blue. It has nothing beyond the first band of
// spherical harmonics; a lobe around an axis therefore leaves 1 + 0.75 k (x, y, z), k being the lobe's mean cosine.
import { writeFileSync } from 'node:fs';

export const SLOPE = 0.75;
export const FACES = ['px', 'nx', 'py', 'ny', 'pz', 'nz'];

// Where a point of a face is seen: s to the right and t down, in [-1, 1] (OpenGL ES 3.0, table 3.21, turned around).
export function direction_of(face, s, t) {
    const d = [[1, -t, -s], [-1, -t, s], [s, 1, t], [s, -1, -t], [s, -t, 1], [-s, -t, -1]][face];
    const length = Math.hypot(...d);
    return d.map((x) => x / length);
}
export const texel_direction = (face, x, y, size) =>
    direction_of(face, 2 * (x + 0.5) / size - 1, 2 * (y + 0.5) / size - 1);

// An equirectangular PFM file: u = 0.5 + atan2(z, x) / 2 pi from the left, v = acos(y) / pi from the top.
export function write_panorama(path, height, radiance) {
    const width = 2 * height, head = Buffer.from(`PF\n${width} ${height}\n-1.0\n`);
    const texels = new Float32Array(3 * width * height);
    for (let y = 0; y < height; y++)
        for (let x = 0; x < width; x++) {
            const phi = 2 * Math.PI * ((x + 0.5) / width - 0.5), theta = Math.PI * (y + 0.5) / height;
            const d = [Math.cos(phi) * Math.sin(theta), Math.cos(theta), Math.sin(phi) * Math.sin(theta)];
            texels.set(radiance(d), 3 * ((height - 1 - y) * width + x)); // rows from the bottom
        }
    writeFileSync(path, Buffer.concat([head, Buffer.from(texels.buffer)]));
}
export const colors_of = (d, k = 1) => d.map((x) => 1 + SLOPE * k * x);

export const linear_roughness = (level, count) => count > 1 ? level / (count - 1) : 0;
export const filament_roughness = (level, count) => count > 1 ? 1 - Math.sqrt(1 - level / (count - 1)) : 0;

// The mean cosine of a lobe's light around N = V = R, weighted with N.L (Karis 2013), by the midpoint rule over the angle of
// the half vector. lobe: ggx, charlie, lambert or none.
export function mean_cosine(lobe, perceptual_roughness) {
    if (lobe === 'none' || (lobe === 'ggx' && perceptual_roughness === 0)) return 1;
    if (lobe === 'lambert') return 2 / 3;
    const alpha = perceptual_roughness ** 2, n = 200000;
    const D = lobe === 'ggx' ? (c) => 1 / (c * c * (alpha * alpha - 1) + 1) ** 2
        : (c) => (1 - c * c) ** (0.5 / alpha);
    let sum = 0, weight = 0;
    for (let i = 0; i < n; i++) {
        const theta = Math.PI / 4 * ((i + 0.5) / n) ** 2, c = Math.cos(theta), NdotL = Math.cos(2 * theta);
        const w = D(c) * c * Math.sin(theta) * NdotL * ((i + 0.5) / n);
        sum += w * NdotL;
        weight += w;
    }
    return sum / weight;
}
