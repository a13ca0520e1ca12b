// khronos.mjs - cube maps and tables of facet bake in the Khronos glTF Sample Renderer, in headless Chromium.
// usage: node khronos.mjs FACET WORK
//
// The renderer (@khronosgroup/gltf-viewer 1.1.0) filters a panorama by itself; it has a reader of KTX2 (libktx), whose textures
// can be put in the places of its own.
//
// - libktx loads every format of texels as WebGL textures with the file's texels.
// - Filtered by both, a light of the first band of harmonics is the same at every texel of every level and face.
// - Its table of reflectance is facet's.
// - Models look the same with facet's files in the places of its textures.
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { open_page } from './browser.mjs';
import { read_ktx2 } from './ktx2.mjs';
import { colors_of, linear_roughness, mean_cosine, write_panorama } from './light.mjs';
import { Report, baker } from './report.mjs';
import { METALS, PLASTER, write_spheres } from './spheres.mjs';
import { distance_to_colors, fit_colors, floats, largest_difference } from './texture.mjs';

const [facet, work] = process.argv.slice(2);
const report = new Report(), bake = baker(facet), file = (name) => path.join(work, name);

// The renderer's own sizes are 256 texels, down to 16, and tables of 1024; software rendering takes minutes for these.
const SIZE = 32, LEVELS = 4, LOWEST = 2, TABLE = 64;
write_panorama(file('colors.pfm'), 256, colors_of);
bake(file('colors.pfm'), '-o', file('colors.hdr'), '--lobe', 'none', '--size', 128, '--level', 0);
bake(file('colors.hdr'), '-o', file('khronos'), '--layout', 'khronos', '--size', SIZE, '--mips', LEVELS);
bake('--dfg', '-o', file('ggx.ktx2'), '--size', TABLE);
const cubes = ['rgba16f', 'rgba32f', 'rgb9e5', 'b10g11r11'].flatMap((format) => [0, 7].map((zstd) => {
    const name = `${format}-${zstd}.ktx2`;
    bake(file('colors.pfm'), '-o', file(name), '--size', SIZE, '--mips', LEVELS, '--format', format, '--zstd', zstd);
    return name;
}));
write_spheres(file('spheres.glb'), [...METALS, PLASTER]);

const { page, close } = await open_page('khronos.html', work);
const call = (name, ...args) => page.evaluate(([n, a]) => window[n](...a), [name, args]);
try {
    await call('start', SIZE, LOWEST, TABLE);
    for (const name of cubes) {
        if (!report.expect(await call('load', name, LEVELS), `libktx does not load ${name}`)) continue;
        const cube = read_ktx2(new Uint8Array(readFileSync(file(name))));
        for (let level = 0; level < LEVELS; level++) {
            const worst = largest_difference(floats(await call('read_file', name, level, SIZE >> level)), cube.levels[level].texels);
            report.expect(worst <= 1e-6, `${name}, level ${level}: a shader sees what is ${worst} from the file's texels`);
        }
    }

    const filtered = await call('filter', 'colors.hdr', 'khronos/lut_sheen_E.png');
    report.expect(filtered.levels === LEVELS && filtered.scale === 1, `the renderer has ${filtered.levels} levels, scaled by ${filtered.scale}`);
    const files = { ggx: 'khronos/ggx/specular.ktx2', charlie: 'khronos/charlie/sheen.ktx2', lambert: 'khronos/lambertian/diffuse.ktx2' };
    for (const [lobe, name] of Object.entries(files)) {
        const levels = lobe === 'lambert' ? 1 : LEVELS;
        report.expect(await call('load', name, levels), `libktx does not load ${name}`);
        for (let level = 0; level < levels; level++) {
            if (lobe === 'charlie' && level === 0) continue; // no width: the renderer has black there
            const size = SIZE >> level, k = mean_cosine(lobe, linear_roughness(level, levels));
            const theirs = floats(await call('read_own', lobe, level, size)), ours = floats(await call('read_file', name, level, size));
            const their_fit = fit_colors(theirs, size), { worst, where } = distance_to_colors(ours, size, k);
            console.log(`${lobe}, level ${level}: contrast ${k.toFixed(4)}; facet ${fit_colors(ours, size).k.toFixed(4)}, the ` +
                `renderer ${their_fit.k.toFixed(4)}, its texels within ${their_fit.worst.toFixed(4)} of that`);
            // Half floats keep 0.05 %, the light's RGBE file 0.4 % of up to 1.75.
            report.expect(worst <= 0.008, `${lobe}, level ${level}: facet is off by ${worst} at ${where}`);
            // The renderer looks samples up in levels of its cube map that are 1.83 too blurred: it takes a texel's solid
            // angle for 1 / (6 size^2), where it is 4 pi / (6 size^2). That costs some contrast of GGX, where its 1024 samples
            // look up blurs of some texels; of sheen little is right: of its 64 samples one or two are above the horizon at
            // roughness 1/3.
            const [least, most] = lobe === 'charlie' ? [0.5, 2] : [0.93, 1.005];
            report.expect(their_fit.k > least * k && their_fit.k < most * k,
                `${lobe}, level ${level}: the renderer has a contrast of ${their_fit.k}, not ${k}`);
            report.expect(their_fit.worst <= (lobe === 'charlie' ? 0.2 : 0.02),
                `${lobe}, level ${level}: the renderer's light has another shape: ${their_fit.worst} at ${their_fit.where}`);
        }
    }
    report.expect(await call('load', 'ggx.ktx2', 1, true), 'libktx does not load ggx.ktx2');
    const their_table = floats(await call('read_own', 'lut_ggx', 0, TABLE)), our_table = floats(await call('read_file', 'ggx.ktx2', 0, TABLE, true));
    const apart = their_table.map((x, i) => i % 4 < 2 ? Math.abs(x - our_table[i]) : 0).sort();
    const table_mean = apart.reduce((a, b) => a + b) / (2 * TABLE * TABLE);
    console.log(`table of GGX: ${table_mean.toFixed(5)} apart in the mean, at most ${apart[apart.length - 1].toFixed(4)}`);
    // 512 samples against quadrature; they are few where N.V is small.
    report.expect(table_mean < 0.002 && apart[apart.length - 1] < 0.02, `the tables of GGX are ${table_mean} apart, at most ${apart[apart.length - 1]}`);

    await call('replace', { ...files, lut_ggx: 'ggx.ktx2' }, LEVELS);
    const theirs = await call('draw', 'spheres.glb', false, 7, 64), ours = await call('draw', 'spheres.glb', true, 7, 64);
    const codes = theirs.map((x, i) => x === 255 && ours[i] === 255 ? -1 : Math.abs(x - ours[i])).filter((x) => x >= 0).sort((a, b) => b - a);
    const mean = codes.reduce((a, b) => a + b, 0) / codes.length;
    console.log(`spheres: ${mean.toFixed(3)} codes of 8 bits apart, at most ${codes[0]}`);
    report.expect(codes.length > 7 * 3 * 1500 && new Set(ours).size > 60, 'nothing is drawn');
    report.expect(mean < 1 && codes[0] <= 8, `spheres lit by facet's files are ${mean} codes from the renderer's own, at most ${codes[0]}`);
} finally {
    await close();
}
report.end('Khronos');
