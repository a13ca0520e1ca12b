// export.mjs - pages of facet view --html in headless Chromium, from the disk and from a server, against facet render --renderer gl of the same
// options. usage: export.mjs FACET DIST WORK [MODEL...]   R: WORK/widgets.html, of facet_widget(), is opened where it is there
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { copyFileSync, existsSync, mkdirSync, readFileSync, readdirSync, statSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import { chromium } from '../clients/browser.mjs';

const [facet, dist, work, ...models] = process.argv.slice(2);
const width = 320, height = 240, size = `${width}x${height}`;
const at = (name) => path.join(work, name);
const run = (...words) => execFileSync(facet, words, { env: { ...process.env, FACET_WEB: dist }, encoding: 'utf8' });
const swiftshader = ['--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];
const launch = (...switches) => chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: ['--no-sandbox', '--force-color-profile=srgb', '--disable-background-networking', '--disable-component-update', '--disable-sync',
        '--no-first-run', ...switches],
});

// Opens an address; what it requested and said is in requests and messages.
async function open(browser, address, options = {}) {
    const page = await browser.newPage({ viewport: { width, height }, ...options }), requests = [], messages = [];
    page.on('request', (request) => { if (!/^(data|blob):/.test(request.url())) requests.push(request.url()); });
    page.on('pageerror', (error) => messages.push(String(error)));
    page.on('requestfailed', (request) => messages.push(`failed: ${request.url()}`));
    page.on('response', (response) => { if (response.status() >= 400) messages.push(`${response.status()}: ${response.url()}`); });
    page.on('console', (message) => { if (!/GPU stall/.test(message.text())) messages.push(message.text()); });
    await page.goto(address);
    return { page, requests, messages };
}

const drawn = (page) => page.waitForFunction(() => document.body.classList.contains('drawn') || !document.getElementById('note').hidden, null,
    { timeout: 60000 }).then(() => page.evaluate(() => document.getElementById('note').textContent)).then((note) => assert.equal(note, ''));

// The mean difference of two images, of 255.
const difference = (a, b) => 255 * JSON.parse(run('compare', '--json', a, b)).metrics.mae;

// What is on the screen differs from facet render of the words by less than 2 of 255 on average, and is not empty.
async function compare(page, name, ...words) {
    const ours = at(`${name}.png`), theirs = at(`${name}_gl.png`);
    writeFileSync(ours, await page.screenshot());
    run('render', ...words, '--renderer', 'gl', '-s', size, '-q', '-o', theirs);
    const mean = difference(ours, theirs);
    console.log(`${name}: mean difference ${mean.toFixed(3)} of 255`);
    assert.ok(difference(ours, at('white.png')) > 2, `${name}: the page is empty`);
    assert.ok(mean < 2, `${name}: differs from facet render --renderer gl`);
}

// Writes the page of the words, opens it from the disk, and compares.
async function check(browser, name, view, reference = view, look = async () => {}) {
    const file = at(`${name}.html`);
    run('view', ...view, '-s', size, '-q', '--html', file);
    const { page, requests, messages } = await open(browser, pathToFileURL(file).href);
    await drawn(page);
    if (reference) await compare(page, name, ...reference);
    await look(page);
    assert.deepEqual(requests, [pathToFileURL(file).href], `${name}: the page requests other files`);
    assert.deepEqual(messages, [], `${name}: the page says something`);
    await page.close();
    return statSync(file).size;
}

const shot = async (page) => (await page.screenshot()).toString('base64');

// A square with a texture in a folder, in a model of three files.
function write_textured(folder) {
    mkdirSync(path.join(folder, 'textures'), { recursive: true });
    writeFileSync(path.join(folder, 'textures/check 1.ppm'), Buffer.concat([Buffer.from('P6 2 2 255\n'), Buffer.from([255, 0, 0, 0, 255, 0, 0, 0, 255, 9, 9, 9])]));
    const bytes = Float32Array.from([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, -1, 0, 1, 1, 0, -1, 1, 0, 0, 1, 1, 1, 1, 0, 0, 1, 1, 0, 0, 0]);
    writeFileSync(path.join(folder, 'square.bin'), Buffer.from(bytes.buffer));
    run('render', '-s', '8', '-q', '-o', path.join(folder, 'textures/a.png'));
    writeFileSync(path.join(folder, 'square.gltf'), JSON.stringify({
        asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }],
        meshes: [{ primitives: [{ attributes: { POSITION: 0, TEXCOORD_0: 1 }, material: 0 }] }],
        materials: [{ pbrMetallicRoughness: { baseColorTexture: { index: 0 }, metallicFactor: 0 } }],
        textures: [{ source: 0 }], images: [{ uri: 'textures/a.png' }],
        accessors: [{ bufferView: 0, componentType: 5126, count: 6, type: 'VEC3', min: [-1, -1, 0], max: [1, 1, 0] },
            { bufferView: 0, byteOffset: 72, componentType: 5126, count: 6, type: 'VEC2' }],
        bufferViews: [{ buffer: 0, byteLength: 120 }], buffers: [{ byteLength: 120, uri: 'square.bin' }],
    }));
    return path.join(folder, 'square.gltf');
}

// A panorama: blue above, red below.
function write_light(file) {
    const rows = Buffer.alloc(4 * 8 * 4);
    for (let i = 0; i < 32; i++) rows.writeUInt32BE(i < 16 ? 0x20408081 : 0xc0202081, 4 * i);
    writeFileSync(file, Buffer.concat([Buffer.from('#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n'), rows]));
    return file;
}

run('render', '--orbit', '0,75,100000%', '-s', size, '-q', '-o', at('white.png'));
const square = write_textured(at('models')), light = write_light(at('light.hdr'));
const spin = new URL('../../docs/examples/gltf/spin.gltf', import.meta.url).pathname;

// ---- one file, from the disk ----

let browser = await launch(...swiftshader);
try {
    const bytes = await check(browser, 'builtin', []);
    console.log(`builtin.html: ${(bytes / 1e6).toFixed(2)} MB: the viewer and a preview`);
    assert.ok(bytes < 1.5e6, 'the viewer in a page is larger than 1.4 MB');
    // not the element's framing; the whole model stays framed in a window of another shape
    await check(browser, 'usual', [square, '--orbit', '0,75,105%'], undefined, async (page) => {
        await page.setViewportSize({ width: 150, height });
        await page.waitForTimeout(500);
        const tall = at('usual_tall.png');
        writeFileSync(tall, await page.screenshot());
        run('render', square, '--renderer', 'gl', '-s', `150x${height}`, '-q', '-o', at('usual_tall_gl.png'));
        assert.ok(difference(tall, at('usual_tall_gl.png')) < 2, 'the model is not framed again in another window');
    });
    for (const model of models) await check(browser, path.parse(model).name, [model]);
    await check(browser, 'options', [square, '--orbit', '20,60,120%', '--env', light, '--env-rotation', '90', '--background', 'env', '--exposure', '-0.5',
        '--tone-mapping', 'agx', '--ground', 'shadow']);
    await check(browser, 'sky', ['--env', 'sun:45,135', '--eye', '1,2,6', '--fov', '40', '--background', '#336699', '--channel', 'normal']);

    // a model of OpenGL 1, read for its own shading
    writeFileSync(at('models/old.mtl'), 'newmtl m\nKd .3 .5 .7\nKs 1 1 1\nNs 20\n');
    writeFileSync(at('models/old.obj'), 'mtllib old.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n');
    await check(browser, 'ogl1', [at('models/old.obj'), '--shading', 'ogl1']);
    await check(browser, 'method', [at('models/old.obj'), '--method', 'fit', '--fit-target', 'linear']);

    // light of a file that needs a decoder
    run('render', '-s', '64x32', '-q', '--background', 'env', '-o', at('light.exr'));
    await check(browser, 'exr', [square, '--env', at('light.exr')]);

    // an animation plays, or stands at its time
    await check(browser, 'moves', [spin, '--animation', '0'], null, async (page) => {
        const first = await shot(page);
        await page.waitForTimeout(400);
        assert.notEqual(await shot(page), first, 'the animation does not play');
    });
    await check(browser, 'stands', [spin, '--animation', '0', '--time', '0.3'], undefined, async (page) => {
        const first = await shot(page);
        await page.waitForTimeout(300);
        assert.equal(await shot(page), first, 'an animation at a time plays');
    });

    // pointer and keyboard turn the model; the bar shows all of it again
    await check(browser, 'controls', [square, '--controls', '--title', 'A </script><b> "title"', '--orbit', '20,60,120%'], null, async (page) => {
        assert.equal(await page.title(), 'A </script><b> "title"');
        assert.equal(await page.locator('#preview').getAttribute('alt'), 'A </script><b> "title"');
        const before = await shot(page);
        await page.mouse.move(100, 100);
        await page.mouse.down();
        await page.mouse.move(180, 110, { steps: 4 });
        await page.mouse.up();
        await page.waitForTimeout(600);
        assert.notEqual(await shot(page), before, 'a drag did not turn the model');
        await page.getByRole('button', { name: 'Reset view' }).click();
        await page.mouse.move(2, 2);
        await page.evaluate(() => document.activeElement.blur());
        for (let i = 0; i < 20 && await shot(page) !== before; i++) await page.waitForTimeout(200);
        assert.equal(await shot(page), before, 'Reset view did not bring the view back');
    });

    // in print the preview is seen
    const file = at('builtin.html');
    const { page } = await open(browser, pathToFileURL(file).href);
    await drawn(page);
    await page.emulateMedia({ media: 'print' });
    assert.ok(await page.locator('#preview').isVisible() && !await page.locator('facet-viewer').isVisible(), 'the preview is not printed');
    await page.close();

    // a name that is HTML, and a model that cannot be read
    const odd = at('a<b>&"c".gltf');
    copyFileSync(spin, odd);
    await check(browser, 'odd', [odd], null, async (view) => assert.equal(await view.title(), 'a<b>&"c"'));
} finally {
    await browser.close();
}

// ---- without WebGL ----

browser = await launch('--disable-gpu', '--disable-3d-apis');
try {
    const { page, messages } = await open(browser, pathToFileURL(at('builtin.html')).href);
    await page.waitForFunction(() => !document.getElementById('note').hidden);
    assert.match(await page.locator('#note').textContent(), /no 3D graphics.*preview/);
    await page.evaluate(() => { document.getElementById('note').hidden = true; });
    run('render', '-s', size, '-q', '-o', at('preview.png'));
    writeFileSync(at('without.png'), await page.screenshot());
    assert.ok(difference(at('without.png'), at('preview.png')) < 1, 'without WebGL the preview is not shown');
    assert.deepEqual(messages, []);
} finally {
    await browser.close();
}

// ---- a folder ----

run('view', square, spin, '-s', size, '-q', '--env', light, '--title', 'Two models', '--html', `${at('pages')}/`);
const types = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm', '.png': 'image/png' };
const server = createServer((request, response) => {
    const name = path.normalize(decodeURIComponent(new URL(request.url, 'http://localhost').pathname)).replace(/^\/some\/where\//, '');
    const found = at(`pages/${name || 'index.html'}`);
    if (!existsSync(found)) response.statusCode = 404;
    else response.setHeader('content-type', types[path.extname(found)] ?? 'application/octet-stream');
    response.end(existsSync(found) ? readFileSync(found) : '');
});
await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
browser = await launch(...swiftshader);
try {
    const root = `http://127.0.0.1:${server.address().port}/some/where/`;
    const { page, requests, messages } = await open(browser, root);
    assert.equal(await page.locator('h1').textContent(), 'Two models');
    assert.equal(await page.locator('li').count(), 2);
    // previews are loaded as they come into view
    await page.waitForFunction(() => [...document.images].every((image) => image.complete && image.naturalWidth > 0), null, { timeout: 10000 });
    await page.getByRole('link', { name: 'square' }).click();
    await drawn(page);
    await page.evaluate(() => document.querySelector('nav').remove());
    await compare(page, 'folder', square, '--env', light);
    assert.deepEqual(requests.filter((url) => !url.startsWith(root)), [], 'the folder requests other files');
    assert.deepEqual(messages, [], 'the folder says something');
    await page.close();

    const disk = await open(browser, pathToFileURL(at('pages/square.html')).href);
    assert.match(await disk.page.locator('#note').textContent(), /web server.*--html page\.html/);
    const [preview, note] = await Promise.all(['#preview', '#note'].map((name) => disk.page.locator(name).boundingBox()));
    assert.ok(preview.y + preview.height <= note.y && preview.height > 50, 'the note covers the preview');
    assert.deepEqual(disk.messages, [], 'the page from the disk says something');
    await disk.page.close();

    // ---- widgets of R: the second one is created at 0 x 0 and shown later ----

    if (existsSync(at('widgets.html'))) {
        const { page: widgets, messages: said } = await open(browser, pathToFileURL(at('widgets.html')).href, { viewport: { width: 700, height: 1100 } });
        const isDrawn = (index) => widgets.waitForFunction((i) => document.querySelectorAll('.facet')[i].querySelector('img')?.style.visibility === 'hidden',
            index, { timeout: 60000 });
        await isDrawn(0);
        await widgets.evaluate(() => document.getElementById('later').removeAttribute('style'));
        await isDrawn(1);
        await widgets.waitForTimeout(500);
        writeFileSync(at('widget.png'), await widgets.locator('.facet').nth(1).screenshot());
        const mean = difference(at('widget.png'), at('widget_gl.png'));
        console.log(`widgets of R: mean difference ${mean.toFixed(3)} of 255`);
        assert.ok(mean < 2, 'a widget differs from facet_picture() by OpenGL');
        assert.equal(readdirSync(at('lib')).filter((name) => name.startsWith('facet-viewer')).length, 1, 'the viewer is there twice');
        assert.deepEqual(said, [], 'the widgets say something');
    }
    console.log('export: as facet render --renderer gl');
} finally {
    await browser.close();
    server.close();
}
