// filament.mjs - what facet bake --layout filament writes, in Filament's web build (npm filament), in headless Chromium.
// usage: node filament.mjs FACET WORK
//
// White metal reflects the light as it was filtered, and nothing else: Filament compensates its energy. Every pixel of a sphere
// then reports direction and roughness of the lookup. The light's color is its direction's (light.mjs); plaster shows
// the harmonics.
import path from 'node:path';
import { open_page } from './browser.mjs';
import { SLOPE, colors_of, filament_roughness, mean_cosine, write_panorama } from './light.mjs';
import { Report, baker } from './report.mjs';
import { METALS, PLASTER, write_spheres } from './spheres.mjs';

const [facet, work] = process.argv.slice(2);
const report = new Report(), bake = baker(facet), file = (name) => path.join(work, name);

// The middle of an equirectangular picture is +Z and its left +X in Filament, as cmgen has it; facet's light has +X and -Z there.
const to_light = ([x, y, z]) => [z, y, -x];
const SIZE = 64, LEVELS = 4, INTENSITY = 0.5, PIXELS = 80;
write_panorama(file('colors.pfm'), 256, colors_of);
bake(file('colors.pfm'), '-o', file('colors'), '--layout', 'filament', '--size', SIZE, '--mips', LEVELS);
write_spheres(file('spheres.glb'), [...METALS, PLASTER], 128, 64);
write_spheres(file('metal.glb'), [METALS[1]], 128, 64);
write_spheres(file('plaster.glb'), [PLASTER], 128, 64);

// The slope of what Filament looks up for a roughness: between two levels, at (levels - 1) r (2 - r).
const level_slopes = Array.from({ length: LEVELS }, (_, i) => mean_cosine('ggx', filament_roughness(i, LEVELS)));
function slope_at(perceptual_roughness) {
    const lod = (LEVELS - 1) * perceptual_roughness * (2 - perceptual_roughness), low = Math.min(Math.floor(lod), LEVELS - 2);
    return level_slopes[low] + (lod - low) * (level_slopes[low + 1] - level_slopes[low]);
}
const encode = (x) => 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
const normalize = (v) => v.map((x) => x / Math.hypot(...v));

// What a pixel of a sphere shows whose normal is n, seen along to_eye: radiance.
function radiance_of({ pbrMetallicRoughness: material }, n, to_eye) {
    if (!material.metallicFactor) return colors_of(to_light(n), 2 / 3);
    // Filament's roughness is at least 0.045 (0.089 on mobile devices), as its square is kept in half floats there.
    const roughness = Math.max(material.roughnessFactor, 0.045), NdotV = n.reduce((sum, x, c) => sum + x * to_eye[c], 0);
    const R = n.map((x, c) => 2 * NdotV * x - to_eye[c]), alpha = roughness ** 2;
    // Rough surfaces look up somewhat towards the normal (getReflectedVector() of Filament).
    const looked_up = normalize(R.map((x, c) => x + (n[c] - x) * alpha * alpha));
    return colors_of(to_light(looked_up), slope_at(roughness));
}

const { page, close } = await open_page('filament.html', work);
const draw = (what) => page.evaluate((a) => window.draw(a), { ibl: 'colors/colors_ibl.ktx', has_harmonics: true, count: 1, size: PIXELS, yaw: 0,
    intensity: INTENSITY, ...what });
// Pixels beside radiance(x, y), or null: RGB bytes within a few codes, for levels in R11F_G11F_B10F, whose steps of blue are 3 %.
function compare(what, drawn, columns, radiance) {
    let worst = 0, where = '', sum = 0, count = 0;
    const width = Math.max(...columns) + 1, stride = drawn.pixels.length / 4 / (drawn.height);
    for (let y = 0; y < drawn.height; y++)
        for (const x of columns) {
            const wanted = radiance(x, y);
            if (!wanted) continue;
            wanted.forEach((value, c) => {
                const seen = drawn.pixels[4 * (y * stride + x) + c], error = Math.abs(seen - encode(INTENSITY * value));
                sum += error;
                count++;
                if (error > worst) [worst, where] = [error, `pixel ${x}, ${y} of ${width}, channel ${c}: ${seen} for ${encode(INTENSITY * value).toFixed(1)}`];
            });
        }
    console.log(`${what}: ${(sum / count).toFixed(2)} codes of 8 bits from what it should be, at most ${worst.toFixed(1)}`);
    report.expect(count > 3000 && sum / count < 0.8 && worst <= 4, `${what} is ${sum / count} codes from what it should be, at most ${worst} at ${where}`);
}
function compare_sphere(what, drawn, material, index, yaw) {
    const to_eye = [Math.sin(yaw), 0, Math.cos(yaw)], right = [Math.cos(yaw), 0, -Math.sin(yaw)];
    compare(what, drawn, Array.from({ length: PIXELS }, (_, x) => index * PIXELS + x), (x, y) => {
        const s = (x - index * PIXELS + 0.5 - PIXELS / 2) / (0.46 * PIXELS), t = (PIXELS / 2 - y - 0.5) / (0.46 * PIXELS);
        if (s * s + t * t > 0.85) return null; // its rim: reflections of a wide angle in a pixel
        const depth = Math.sqrt(1 - s * s - t * t), n = [0, 1, 2].map((c) => s * right[c] + depth * to_eye[c] + (c === 1 ? t : 0));
        return radiance_of(material, n, to_eye);
    });
}
try {
    const materials = [...METALS, PLASTER], row = await draw({ model: 'spheres.glb', count: materials.length });
    report.expect(row.levels === LEVELS && row.width === SIZE, `Filament has ${row.levels} levels of ${row.width} texels`);
    // Irradiance / pi is 1 + 2/3 0.75 (z, y, -x) in red, green and blue; constants: 1; of y: green; z: red; x: blue.
    const sh = Array.from({ length: 9 }, () => [0, 0, 0]);
    sh[0] = [1, 1, 1];
    sh[1][1] = sh[2][0] = 2 / 3 * SLOPE;
    sh[3][2] = -2 / 3 * SLOPE;
    sh.flat().forEach((x, i) => report.near(row.sh[i], x, 2e-3, `harmonic ${Math.floor(i / 3)}, channel ${i % 3}`));
    materials.forEach((material, i) => compare_sphere(`sphere ${i}`, row, material, i, 0));
    for (const [name, material, yaw, has_harmonics] of [['metal', METALS[1], 2, true], ['metal', METALS[1], 4, true], ['plaster', PLASTER, 4, true],
        ['plaster', PLASTER, 2, false]])
        compare_sphere(`${name} from ${yaw} rad, ${has_harmonics ? 'with' : 'without'} harmonics`,
            await draw({ model: `${name}.glb`, yaw, has_harmonics }), material, 0, yaw);
    for (const yaw of [0, 2.5]) {
        const half = PIXELS / 2, forward = [-Math.sin(yaw), 0, -Math.cos(yaw)], right = [Math.cos(yaw), 0, -Math.sin(yaw)];
        compare(`sky towards ${yaw} rad`, await draw({ sky: 'colors/colors_skybox.ktx', yaw }), Array.from({ length: PIXELS }, (_, x) => x), (x, y) =>
            colors_of(to_light(normalize(forward.map((f, c) => f + ((x + 0.5) / half - 1) * right[c] + (c === 1 ? 1 - (y + 0.5) / half : 0))))));
    }
} finally {
    await close();
}
report.end('Filament');
