// views.mjs - views of the viewer's page with many settings at once: a link shows the same pixels again, the copied command renders the same
// image; and materials edited in the page are those of the saved file. usage: views.mjs FACET DIST WORK
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { serve_page } from '../clients/browser.mjs';
import { write_models } from './page_model.mjs';
import { GROUPS, materialPart } from '../../web/page/panels/material_rows.js';

const [facet, dist, work] = process.argv.slice(2);
write_models(facet, work);
const served = await serve_page('/index.html', (url) => (url.startsWith('/models/') ? path.join(work, url.slice(7)) : path.join(dist, url)));
const { page, messages } = served;
await page.setViewportSize({ width: 800, height: 440 });
await page.emulateMedia({ reducedMotion: 'reduce' });
// A small image, which is drawn after every change.
await page.addInitScript(() => document.addEventListener('DOMContentLoaded', () => {
    const viewer = document.querySelector('facet-viewer');
    if (viewer) Object.assign(viewer.style, { width: '160px', height: '120px' });
}));
const address = page.url();

const MODEL = 'model=models/spheres.glb';
const VIEWS = {
    'sky and animation': `${MODEL}&env=sun:30,60&env-rotation=75&env-intensity=1.5&exposure=0.7&tone-mapping=agx&background=env&background-blur=0.3&variant=Golden`
        + '&animation=0&time=0.4&orbit=40deg,60deg,120%&fov=40&ground=shadow&bloom=0.05',
    'sun and shadows': `${MODEL}&env=gradient:%23204080,%23a0c0ff,%23302010&sun=30,50,5&shadows=&exposure=-0.5&tone-mapping=aces&background=%23336699&orbit=-30deg,70deg,9&target=0,0.4,0`
        + '&transparency=peeled&energy=gltf&brdf=schlick-ggx',
    'parallel and upright': `${MODEL}&env=constant:%23c0c8d0&tone-mapping=reinhard&ortho=&orbit=70,40,105%25&lights=none&background=black&specular-aa=`,
    "the file's camera": `${MODEL}&camera=Hero&variant=Golden&animation=0&time=1.25&tone-mapping=none&exposure=auto&background=env`,
    'a moved model of the scene': 'env=preetham:20,200&orbit=200deg,70deg,90%25&channel=normal&background=white',
};

const shot = (width, height) => page.evaluate(async ([w, h]) => {
    const blob = await document.querySelector('facet-viewer').screenshot({ width: w, height: h });
    return [...new Uint8Array(await blob.arrayBuffer())];
}, [width, height]).then((bytes) => Buffer.from(bytes));
const options = () => page.evaluate(() => document.querySelector('facet-viewer').options);

// Waits until the options of the page do not change any more; an error in the page fails.
async function open(link, name) {
    await page.goto('about:blank');
    await page.goto(link);
    const wanted = new URL(link).hash.slice(1).split('&').map((pair) => pair.split('=')[0]).filter((option) => option !== 'model');
    const missing = () => page.evaluate((all) => {
        const viewer = document.querySelector('facet-viewer');
        return viewer?.loaded ? all.filter((option) => !(option in viewer.options)) : all;
    }, wanted);
    for (let i = 0; i < 200 && (await missing()).length && !await page.locator('#messages .message').count(); i++) await page.waitForTimeout(50);
    assert.deepEqual(await missing(), [], `${name}: options of the link are not set`);
    await page.waitForTimeout(300);
    assert.deepEqual(await page.locator('#messages .message p').allTextContents(), [], `${name}: the page says something`);
    return options();
}

// The line as the page shows it, with the models of this test, as an image.
function render(command, name) {
    const folder = path.join(work, name.replaceAll(/\W/g, '-'));
    mkdirSync(folder, { recursive: true });
    const text = command.replaceAll(/(\S*\/)?spheres\.glb/g, '../spheres.glb');
    execFileSync('sh', ['-c', `facet() { "$FACET" "$@" -q -o out.png; }\n${text}`], { cwd: folder, env: { ...process.env, FACET: path.resolve(facet) } });
    return path.join(folder, 'out.png');
}

async function checkView(name, view) {
    const set = await open(`${address}#${view}`, name);
    const pixels = await shot(320, 240), command = await page.evaluate(() => document.querySelector('facet-viewer').command(320, 240));
    const file = path.join(work, 'page.png');
    writeFileSync(file, pixels);
    const { metrics } = JSON.parse(execFileSync(facet, ['compare', '--json', file, render(command, name)]));
    console.log(`${name}: the copied command differs by ${(255 * metrics.mae).toFixed(3)} of 255`);
    assert.ok(metrics.mae < 2 / 255, `${name}: ${command}`);
    await page.locator('#tab-share').click();
    const link = await page.getByRole('textbox', { name: 'Link to this view' }).inputValue();
    assert.deepEqual(await open(link, name), set, `${name}: the link has other options`);
    assert.ok((await shot(320, 240)).equals(pixels), `${name}: the link shows another image`);
}

// All parameters of all materials get other values; what the page then has is what the saved file has.
async function checkEdits() {
    await open(`${address}#${MODEL}`, 'edits');
    const before = await page.evaluate(() => document.querySelector('facet-viewer').materials);
    let count = 0;
    for (const index of before.keys())
        for (const group of GROUPS.filter(({ object }) => object !== 'KHR_materials_pbrSpecularGlossiness'))
            for (const [i, row] of group.rows.entries()) {
                if (row.needs || (row.isColor && row.usual?.length === 4)) continue;
                const number = Number((row.min + (row.max - row.min) * (0.2 + 0.13 * ((index + i) % 5))).toFixed(4));
                const value = row.isColor ? [0.1 * (i + 1), 0.35, 0.6].map((x) => Math.min(x, 1)) : number;
                await page.evaluate(([at, part]) => document.querySelector('facet-viewer').setMaterial(at, part), [index, materialPart(group, row, value)]);
                count++;
            }
    for (const [index, part] of [[0, { alphaMode: 'MASK', alphaCutoff: 0.25, doubleSided: true }], [1, { alphaMode: 'BLEND' }], [2, { alphaMode: 'OPAQUE', doubleSided: false }]])
        await page.evaluate(([at, change]) => document.querySelector('facet-viewer').setMaterial(at, change), [index, part]);
    const edited = await page.evaluate(() => document.querySelector('facet-viewer').materials);
    const bytes = await page.evaluate(async () => [...new Uint8Array(await (await document.querySelector('facet-viewer').exportScene()).arrayBuffer())]);
    const file = path.join(work, 'saved.glb');
    writeFileSync(file, Buffer.from(bytes));
    const { materials } = JSON.parse(execFileSync(facet, ['inspect', '--json', file]));
    assert.ok(count > 80, `${count} parameters`);
    assert.notDeepEqual(edited, before);
    assert.deepEqual(materials, edited, 'the saved file has other materials than the page');
    console.log(`${count} edited parameters are those of the saved file`);
}

try {
    for (const [name, view] of Object.entries(VIEWS)) await checkView(name, view);
    await checkEdits();
    assert.deepEqual(messages.filter((text) => !/GPU stall/.test(text)), [], 'the console says something');
} finally {
    await served.close();
}
