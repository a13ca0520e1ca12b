// element.mjs - <facet-viewer> in headless Chromium, under a strict content security policy. usage: element.mjs FACET DIST WORK [MODEL...]
import assert from 'node:assert/strict';
import { existsSync, readFileSync } from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { serve_page } from '../clients/browser.mjs';
import { cases as camera_cases } from './element_camera.mjs';
import { cases as hostile_cases } from './element_hostile.mjs';
import { cases as life_cases } from './element_life.mjs';
import { cases as model_cases } from './element_model.mjs';
import { box_model } from './element_models.mjs';
import { prepare } from './element_page.mjs';

const [, dist, , ...models] = process.argv.slice(2);
const here = path.dirname(fileURLToPath(import.meta.url));
const google = path.join(here, 'node_modules/@google/model-viewer/dist/model-viewer.min.js');
const policy = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; img-src 'self' blob: data:; connect-src 'self' blob:";
const requests = [];
const shown = models.filter((file) => /WaterBottle|Fox|Suzanne/.test(file));

const page_of = (scripts, csp = policy) => `<!doctype html><html lang="en"><meta charset="utf-8"><meta http-equiv="Content-Security-Policy" content="${csp}">
<link rel="icon" href="data:,"><title>test</title>${scripts.map((src) => `<script type="module" src="${src}"></script>`).join('')}<body></body></html>`;

function contents(url) {
    requests.push(url);
    if (url === '/site/test.html') return { text: page_of(['facet-viewer/facet-viewer.js']) };
    if (url === '/site/both.html') return { text: page_of(['facet-viewer/facet-viewer.js', 'google.js'], "script-src 'self' 'unsafe-eval' 'wasm-unsafe-eval' blob:") };
    if (url === '/site/trusted.html') return { text: page_of(['facet-viewer/facet-viewer.js'], `${policy}; require-trusted-types-for 'script'; trusted-types 'none'`) };
    if (url === '/site/strict.html') return { text: page_of(['facet-viewer/facet-viewer.js'], policy.replace(" 'wasm-unsafe-eval'", '')) };
    if (url === '/site/google.js') return google;
    if (url === '/site/api/model' || url === '/site/api/the box.bin') return { text: apart('the%20box.bin')[url.includes('.bin') ? 1 : 0] };
    if (url.startsWith('/site/box')) return { text: box_model() };
    if (url === '/site/models/apart.gltf' || url === '/site/buffers/the box.bin') return { text: apart()[url.includes('.bin') ? 1 : 0] };
    if (url === '/site/blue.hdr') return { text: blue_sky() };
    if (url === '/site/broken.glb') return { text: 'glTF but no more' };
    if (url.startsWith('/site/poster')) return { text: '<svg xmlns="http://www.w3.org/2000/svg"/>' };
    if (url.startsWith('/models/')) return shown.find((file) => path.basename(file) === url.slice(8)) ?? 'none';
    return path.join(dist, url.replace('/site/', ''));
}

// The box as a text and the buffer that it names.
function apart(uri = '../buffers/the%20box.bin') {
    const gltf = JSON.parse(box_model()), bytes = Buffer.from(gltf.buffers[0].uri.split(',')[1], 'base64');
    gltf.buffers[0].uri = uri;
    return [JSON.stringify(gltf), bytes];
}

// A panorama that is blue everywhere.
function blue_sky() {
    const texels = Buffer.alloc(4 * 32);
    for (let i = 0; i < texels.length; i += 4) texels.writeUInt32BE(0x00008081, i);
    return Buffer.concat([Buffer.from('#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n'), texels]);
}

const served = await serve_page('/site/test.html', contents);
const { page, messages } = served;
let count = 0;
const check = (is, text) => { count++; assert.ok(is, text); };
const equal = (is, expected, text) => { count++; assert.deepEqual(is, expected, text); };
const near = (is, expected, text, tolerance = 1e-5) => {
    count++;
    assert.ok(Math.abs(is - expected) <= tolerance * Math.max(1, Math.abs(expected)), `${text}: ${is}, expected ${expected}`);
};

const open = async (name) => {
    await page.goto(new URL(name, page.url()).href);
    await page.evaluate(() => customElements.whenDefined('facet-viewer'));
    await prepare(page);
};

const tools = { page, check, equal, near, requests, open };
const tests = { ...camera_cases(tools), ...model_cases(tools), ...life_cases(tools), ...hostile_cases(tools) };

try {
    await open('/site/test.html');
    check(await page.evaluate(() => {
        const gl = document.createElement('canvas').getContext('webgl2');
        gl?.clearColor(0.2, 0.4, 0.6, 1);
        gl?.clear(gl.COLOR_BUFFER_BIT);
        const rgba = new Uint8Array(4);
        gl?.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, rgba);
        return rgba[0] === 51;
    }), 'the browser draws nothing by WebGL 2');
    const only = process.env.ELEMENT_TEST;
    for (const [name, test] of Object.entries(tests)) {
        if (only && !name.includes(only)) continue;
        const start = Date.now();
        await test();
        console.log(`element: ${name} (${((Date.now() - start) / 1000).toFixed(1)} s)`);
    }
    const said = messages.filter((text) => !/GPU stall|WebGL: CONTEXT_LOST|status of 404|facet-viewer> tone/.test(text));
    equal(said, [], 'the page said something in the console');
    const elsewhere = await page.evaluate(() => performance.getEntriesByType('resource').map((entry) => entry.name).filter((name) => !name.startsWith(`${location.origin}/site/`)));
    equal(elsewhere, [], 'the element asks for files outside of its folder');

    // Beside the real <model-viewer>.
    if (!only || only === 'model-viewer') {
        if (!existsSync(google)) console.log('element: npm ci was not run in tests/web: not compared with model-viewer');
        else await compare_with_model_viewer();
    }
    console.log(`element: ${count} checks`);
} finally {
    await served.close();
}

async function compare_with_model_viewer() {
    await open('/site/both.html');
    for (const [name, attributes] of [['/site/box.gltf', {}], ['/site/box.gltf', { 'camera-orbit': '40deg 60deg 80%', 'camera-target': '0.2m auto 0m' }],
        ['/site/box.gltf', { orientation: '20deg 90deg -40deg', scale: '1 0.5 2' }],
        ...shown.map((file) => [`/models/${path.basename(file)}`, {}])]) {
        if (/\.gltf$/.test(name) && name.startsWith('/models/')) continue;
        const [ours, theirs] = await page.evaluate(async ([src, more]) => {
            const read = async (tag) => {
                await customElements.whenDefined(tag);
                const element = document.createElement(tag);
                for (const [key, value] of Object.entries({ src, ...more })) element.setAttribute(key, value);
                element.style.width = '200px';
                element.style.height = '260px';
                await new Promise((resolve, reject) => {
                    element.addEventListener('load', resolve, { once: true });
                    element.addEventListener('error', (e) => reject(new Error(`${tag}: ${e.detail?.message ?? e.detail?.sourceError}`)), { once: true });
                    document.body.append(element);
                });
                element.jumpCameraToGoal();
                await element.updateComplete;
                for (let i = 0; i < 5; i++) await new Promise((resolve) => requestAnimationFrame(resolve));
                const orbit = element.getCameraOrbit(), target = element.getCameraTarget(), size = element.getDimensions(), middle = element.getBoundingBoxCenter();
                const all = [orbit.theta, orbit.phi, orbit.radius, target.x, target.y, target.z, element.getFieldOfView(), element.getMinimumFieldOfView(), element.getMaximumFieldOfView(),
                    size.x, size.y, size.z, middle.x, middle.y, middle.z, element.getIdealAspect()];
                element.remove();
                return all;
            };
            return [await read('facet-viewer'), await read('model-viewer')];
        }, [name, attributes]);
        const names = ['theta', 'phi', 'radius', 'target x', 'y', 'z', 'fov', 'min fov', 'max fov', 'size x', 'y', 'z', 'middle x', 'y', 'z', 'ideal aspect'];
        names.forEach((label, i) => near(ours[i], theirs[i], `${name}: ${label}`, 2e-5));
        console.log(`element: ${name} as in model-viewer`);
    }
}
