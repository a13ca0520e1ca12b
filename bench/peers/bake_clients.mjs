// bake_clients.mjs - environments filtered by three.js and by Khronos' renderer, in headless Chromium, beside facet's: how far
// the levels are apart; and spheres in the light of each, as one image.
// usage: node bake_clients.mjs FACET OUT LIGHT.hdr ..     FACET: the command; OUT: a folder for the files and NAME.jpg
//
// Uses the pages and packages of tests/clients (npm ci there). Software rendering filters Khronos' cube maps in minutes.
import path from 'node:path';
import { copyFileSync, mkdirSync, writeFileSync } from 'node:fs';
import { open_page } from '../../tests/clients/browser.mjs';
import { filament_roughness, linear_roughness } from '../../tests/clients/light.mjs';
import { baker } from '../../tests/clients/report.mjs';
import { METALS, PLASTER, write_spheres } from '../../tests/clients/spheres.mjs';
import { floats, png_of, relative_error } from '../../tests/clients/texture.mjs';

const [facet, out, ...lights] = process.argv.slice(2);
if (!lights.length) {
    console.error('usage: node bake_clients.mjs FACET OUT LIGHT.hdr ..');
    process.exit(2);
}
const bake = baker(facet), file = (name) => path.join(out, name);
const SIZE = 256, COUNT = METALS.length + 1, PIXELS = 128;
mkdirSync(out, { recursive: true });
write_spheres(file('spheres.glb'), [...METALS, PLASTER], 128, 64);

function print_row(what, level, roughness, theirs, ours) {
    const { rms, mean } = relative_error(theirs, ours);
    console.log(`| ${what} | ${level} | ${roughness.toFixed(3)} | ${(100 * rms).toFixed(1)} % | ${(100 * mean - 100).toFixed(1)} % |`);
}

async function with_three(name) {
    const { page, close } = await open_page('three.html', out);
    const call = (f, ...args) => page.evaluate(([n, a]) => window[n](...a), [f, args]);
    try {
        await call('load_panorama', `${name}.hdr`);
        await call('load', `${name}-three.ktx2`);
        for (let level = 0; level < 6; level++) {
            const size = SIZE >> level;
            print_row('three.js', level, filament_roughness(level, 6), floats(await call('sample', 'pmrem', level, size)),
                floats(await call('sample', `${name}-three.ktx2`, level, size)));
        }
        await call('load_environment', `${name}-three.ktx2`, false);
        return [await call('draw', { is_facet: false }, COUNT, PIXELS), await call('draw', { is_facet: true }, COUNT, PIXELS)];
    } finally {
        await close();
    }
}

async function with_khronos(name) {
    const { page, close } = await open_page('khronos.html', out);
    const call = (f, ...args) => page.evaluate(([n, a]) => window[n](...a), [f, args]);
    try {
        await call('start', SIZE, 4, 256);
        const files = { ggx: `${name}/ggx/specular.ktx2`, charlie: `${name}/charlie/sheen.ktx2`, lambert: `${name}-lambert.ktx2` };
        await call('filter', `${name}.hdr`, `${name}/lut_sheen_E.png`);
        for (const [lobe, cube] of Object.entries(files)) {
            const levels = lobe === 'lambert' ? 1 : 5;
            await call('load', cube, levels);
            for (let level = lobe === 'charlie' ? 1 : 0; level < levels; level++) {
                const size = SIZE >> level;
                print_row(`Khronos, ${lobe}`, level, lobe === 'lambert' ? 1 : linear_roughness(level, levels),
                    floats(await call('read_own', lobe, level, size)), floats(await call('read_file', cube, level, size)));
            }
        }
        await call('replace', files, 5);
        return [await call('picture', 'spheres.glb', false, COUNT, PIXELS), await call('picture', 'spheres.glb', true, COUNT, PIXELS)];
    } finally {
        await close();
    }
}

async function with_filament(name) {
    const { page, close } = await open_page('filament.html', out);
    try {
        const { url } = await page.evaluate((a) => window.draw(a), { model: 'spheres.glb', ibl: `${name}-filament/${name}-filament_ibl.ktx`,
            has_harmonics: true, count: COUNT, size: PIXELS, yaw: 0, intensity: 0.8, tone_mapping: 'ACES', turn: Math.PI / 2, clear: 1 });
        return [url];
    } finally {
        await close();
    }
}

// Pictures under one another.
async function stack(pictures, to) {
    const { page, close } = await open_page('stack.html', out);
    try {
        writeFileSync(to, png_of(await page.evaluate((urls) => window.stack(urls), pictures)));
    } finally {
        await close();
    }
}

for (const light of lights) {
    const name = path.basename(light, path.extname(light));
    copyFileSync(light, file(`${name}.hdr`));
    bake(light, '-o', file(`${name}-three.ktx2`), '--size', SIZE, '--mips', 6, '--mapping', 'filament', '--format', 'rgba32f');
    bake(light, '-o', file(name), '--layout', 'khronos', '--size', SIZE, '--mips', 5, '--format', 'rgba32f');
    bake(light, '-o', file(`${name}-lambert.ktx2`), '--lobe', 'lambert', '--size', SIZE, '--format', 'rgba32f');
    bake(light, '-o', file(`${name}-filament`), '--layout', 'filament', '--size', SIZE);
    console.log(`\n${name}\n\n| filtered by | level | roughness | from facet (RMS) | mean |\n| --- | --- | --- | --- | --- |`);
    await stack([...await with_three(name), ...await with_khronos(name), ...await with_filament(name)], file(`${name}.jpg`));
}
