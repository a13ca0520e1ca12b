// three.mjs - cube maps of facet bake in three.js, in headless Chromium. usage: node three.mjs FACET WORK
//
// - KTX2Loader reads every format of texels; a shader sees in each direction what the file holds there, on every face and
//   level, and no seam between faces.
// - A baked cube map taken as scene.environment as it is lights a scene as PMREMGenerator's does, and so does pmrem.ktx2 of
//   --layout three.
// - --sh has LightProbeGenerator's coefficients.
// - The lines for three.js in docs/bake.md do that.
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { open_page } from './browser.mjs';
import { read_ktx2 } from './ktx2.mjs';
import { colors_of, filament_roughness, mean_cosine, write_panorama } from './light.mjs';
import { Report, baker } from './report.mjs';
import { distance_to_colors, floats, largest_difference, relative_error } from './texture.mjs';

const [facet, work] = process.argv.slice(2);
const report = new Report(), bake = baker(facet), file = (name) => path.join(work, name);

// What is to be drawn: a sky with a warm lamp, a window and a dark floor, none of it narrower than a few texels of 256.
const lamp = (d, to, cosine, width) => 1 / (1 + Math.exp((cosine - d.reduce((sum, x, i) => sum + x * to[i], 0)) / width));
const room = (d) => {
    const floor = 0.3 + 0.25 * d[1], warm = 30 * lamp(d, [0.6, 0.64, 0.48], 0.97, 0.006), window = 6 * lamp(d, [-0.8, 0, 0.6], 0.8, 0.01);
    return [floor + warm + 0.7 * window, floor + 0.7 * warm + 0.9 * window, 0.9 * floor + 0.4 * warm + window];
};
write_panorama(file('colors.pfm'), 256, colors_of);
write_panorama(file('room.pfm'), 256, room);

const SIZE = 32, LEVELS = 4;
const cubes = ['rgba16f', 'rgba32f', 'rgb9e5', 'b10g11r11'].flatMap((format) => [0, 7].map((zstd) => {
    const name = `${format}-${zstd}.ktx2`;
    bake(file('colors.pfm'), '-o', file(name), '--size', SIZE, '--mips', LEVELS, '--format', format, '--zstd', zstd);
    return name;
}));
bake(file('room.pfm'), '-o', file('room.hdr'), '--lobe', 'none', '--size', 256, '--level', 0);
bake(file('room.hdr'), '-o', file('room.ktx2'), '--size', 256, '--mips', 6, '--mapping', 'filament');
bake(file('room.hdr'), '-o', file('three'), '--layout', 'three', '--size', 256);

const { page, close, messages } = await open_page('three.html', work);
const call = (name, ...args) => page.evaluate(([n, a]) => window[n](...a), [name, args]);
try {
    for (const name of cubes) {
        const loaded = await call('load', name), cube = read_ktx2(new Uint8Array(readFileSync(file(name))));
        report.expect(loaded.levels === LEVELS, `${name}: three.js has ${loaded.levels} levels`);
        for (let level = 0; level < LEVELS; level++) {
            const size = SIZE >> level, seen = floats(await call('sample', name, level, size));
            // Filtering hardware may weigh with 8 bits; at the middle of a texel the others weigh nothing.
            const worst = largest_difference(seen, cube.levels[level].texels);
            report.expect(worst <= 1e-6, `${name}, level ${level}: a shader sees what is ${worst} from the file's texels`);
        }
    }
    // Between the texels, out to the edges and beyond the last middles, the light stays smooth: 32-bit texels of size 8.
    const k = mean_cosine('ggx', 2 / 3), dense = floats(await call('sample', 'rgba32f-0.ktx2', 2, 64));
    const { worst, where } = distance_to_colors(dense, 64, k);
    report.expect(worst < 0.02, `a seam: ${worst} at ${where}`);

    const own = await call('load_panorama', 'room.hdr');
    report.expect(own.levels === 6 && own.size === 256, `three.js' PMREM has ${own.levels} levels of ${own.size} texels`);
    await call('load', 'room.ktx2');
    await call('load', 'three/pmrem.ktx2');
    for (let level = 0; level < 6; level++) {
        report.near(await call('roughness_of', level, 6), filament_roughness(level, 6), 1e-9, `three.js' roughness of level ${level}`);
        const size = 256 >> level, theirs = floats(await call('sample', 'pmrem', level, size));
        const ours = floats(await call('sample', 'room.ktx2', level, size));
        const mirrored = floats(await call('sample', 'three/pmrem.ktx2', level, size, 1, -1));
        const { rms, mean } = relative_error(theirs, ours);
        console.log(`level ${level}: three.js is ${(100 * rms).toFixed(2)} % (RMS) from facet, ${(100 * mean - 100).toFixed(2)} % brighter`);
        // Level 0 is a picture that was looked up twice; the others are three.js' 256 samples, on a half texel's blur.
        report.expect(rms < 0.02 && Math.abs(mean - 1) < 0.01, `level ${level}: three.js is ${rms} (RMS) from facet, mean ${mean}`);
        report.expect(largest_difference(mirrored, ours) <= 1e-6, `level ${level} of pmrem.ktx2, looked up with x negated, is not room.ktx2's`);
    }

    const probe = await call('generate_probe', 128);
    const sh = JSON.parse(readFileSync(file('three/sh.json'))).forms.find(({ form }) => form === 'radiance').coefficients;
    const scale = Math.max(...probe.flat().map(Math.abs));
    const hdr_step = 256 / 255; // three.js divides the mantissas of .hdr by 255, facet, as most programs, by 256
    probe.forEach((rgb, i) => rgb.forEach((x, c) => report.near(sh[i][c], x / hdr_step, 2e-3 * scale,
        `harmonic ${i}, channel ${c}, by LightProbeGenerator`)));

    await call('load_environment', 'room.ktx2', false);
    const pictures = [{ is_facet: false }, { is_facet: true }, { probe: sh }, { probe }];
    const [theirs, ours, our_probe, their_probe] = await call('draw_all', pictures, 7, 64);
    // Differences of bytes, the largest first, but for where both are white: beside the spheres.
    const codes = (a, b) => a.map((x, i) => x === 255 && b[i] === 255 ? -1 : Math.abs(x - b[i])).filter((x) => x >= 0)
        .sort((p, q) => q - p);
    const spheres = codes(theirs, ours), probes = codes(our_probe, their_probe);
    const mean = (d) => d.reduce((p, q) => p + q, 0) / d.length;
    console.log(`spheres: ${mean(spheres).toFixed(3)} codes of 8 bits apart, at most ${spheres[0]}; of the probe ${mean(probes).toFixed(3)}, ${probes[0]}`);
    report.expect(new Set(ours).size > 100, 'the spheres have no colors');
    report.expect(mean(spheres) < 1, `spheres lit by facet's cube map are ${mean(spheres)} codes from three.js' own`);
    report.expect(probes[0] <= 2, `spheres lit by facet's harmonics are ${probes[0]} codes from three.js' own`);
    await call('load_environment', 'three/pmrem.ktx2', true);
    const [from_layout] = await call('draw_all', [{ is_facet: true }], 7, 64);
    report.expect(codes(from_layout, ours)[0] === 0, 'pmrem.ktx2 lights another way than room.ktx2');
    // What docs/bake.md tells users to write does the same.
    const lines = readFileSync(new URL('../../docs/bake.md', import.meta.url), 'utf8').split('\n');
    const first = lines.findIndex((line) => /^    .*KTX2Loader/.test(line)), end = lines.findIndex((line, i) => i > first && /^\S/.test(line));
    if (report.expect(first > 0, 'docs/bake.md has no lines for three.js')) {
        const probes_of_docs = await call('run_documentation', lines.slice(first, end).join('\n'), 'three');
        report.expect(Array.isArray(probes_of_docs), `docs/bake.md's lines for three.js: ${probes_of_docs}`);
        const [from_docs] = await call('draw_all', [{ is_facet: true }], 7, 64);
        report.expect(codes(from_docs, ours)[0] === 0, "docs/bake.md's lines light another way");
        report.expect(probes_of_docs[0]?.every?.((rgb, i) => rgb.every((x, c) => Math.abs(x - sh[i][c]) < 1e-5)),
            "docs/bake.md's probe is another one");
    }
    const loud = messages.filter((text) => !text.includes('404') && !text.includes('GPU stall'));
    report.expect(loud.length === 0, `the browser said: ${loud.join('; ')}`);
} finally {
    await close();
}
report.end('three.js');
