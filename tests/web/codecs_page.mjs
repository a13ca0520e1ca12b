// codecs_page.mjs - decoders as modules (web/element/codecs.js) in headless Chromium, against facet render --renderer gl.
// usage: codecs_page.mjs FACET DIST WORK DATA
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { serve_page } from '../clients/browser.mjs';

const [facet, dist, work, data] = process.argv.slice(2);
const top = path.join(path.dirname(fileURLToPath(import.meta.url)), '../..');
const size = 192;

// ---- models: a square with a texture ----

const positions = Buffer.from(Float32Array.from([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0, 0, 1, 1, 1, 1, 0, 0, 0]).buffer);
const indices = Buffer.from(Uint16Array.from([0, 1, 2, 0, 2, 3]).buffer);

function square(texture, extension, alphaMode = 'BLEND') {
    const bytes = Buffer.concat([positions, indices]);
    return Buffer.from(JSON.stringify({
        asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }],
        meshes: [{ primitives: [{ attributes: { POSITION: 0, TEXCOORD_0: 1 }, indices: 2, material: 0 }] }],
        materials: [{ alphaMode, pbrMetallicRoughness: { metallicFactor: 0, baseColorTexture: { index: 0 } } }],
        textures: [{ extensions: { [extension]: { source: 0 } } }], images: [{ uri: texture }], extensionsUsed: [extension],
        accessors: [
            { bufferView: 0, componentType: 5126, count: 4, type: 'VEC3', min: [-1, -1, 0], max: [1, 1, 0] },
            { bufferView: 0, byteOffset: 48, componentType: 5126, count: 4, type: 'VEC2' },
            { bufferView: 0, byteOffset: 80, componentType: 5123, count: 6, type: 'SCALAR' },
        ],
        bufferViews: [{ buffer: 0, byteLength: bytes.length }],
        buffers: [{ byteLength: bytes.length, uri: `data:application/octet-stream;base64,${bytes.toString('base64')}` }],
    }));
}

const obj = 'mtllib a.mtl\nusemtl a\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n';
const testdata = (name) => readFileSync(path.join(top, 'src/io/testdata', name));
execFileSync(facet, ['render', '-s', '96', '-n', '1', '-q', '-o', path.join(work, 'view.webp')]);
execFileSync(facet, ['render', '-s', '64x32', '-n', '1', '-q', '-o', path.join(work, 'env.exr')]);
const webp = readFileSync(path.join(work, 'view.webp'));
const avif = (name) => readFileSync(path.join(top, 'src/image/testdata', name));

// ---- the page: facet-viewer/module.js and a canvas ----

const missing = new Set(); // files that the server does not have
const html = `<!doctype html><title>codecs</title><link rel="icon" href="data:,"><script type="module">
import { loadModule } from './facet-viewer/module.js';
const start = async () => {
    const canvas = document.createElement('canvas');
    const module = await loadModule();
    module.start(canvas);
    return { canvas, module, viewer: module.create() };
};
window.ready = start().then((all) => { window.all = all; });
window.failure = window.ready.then(() => null, (error) => error.message);
</script>`;
const served = await serve_page('/a/folder/codecs.html', (url) => {
    if (url === '/a/folder/codecs.html') return { text: html };
    if (missing.has(path.basename(url))) throw new Error('missing');
    return path.join(dist, url.replace('/a/folder/', ''));
});
const { page, messages } = served;

const encode = (files) => Object.entries(files).map(([name, bytes]) => [name, Buffer.from(bytes).toString('base64')]);
const put = (files) => page.evaluate((list) => {
    const { module } = window.all;
    module.removeFiles();
    for (const [name, text] of list) module.putFile(name, Uint8Array.from(atob(text), (c) => c.charCodeAt(0)));
}, encode(files));

// Opens a model as the element does; null or its sentence.
const open = (name) => page.evaluate(async (path) => {
    const { module, viewer } = window.all;
    await module.codecs.load(module.listNeeds(path));
    for (let again = true; again; ) {
        let failure = null;
        try {
            module.open(viewer, path);
        } catch (error) {
            failure = error.message;
        }
        const missing = module.codecs.takeMissing();
        again = missing.length > 0 && !window.tried;
        window.tried = again;
        if (!again) return failure;
        await module.codecs.load(missing);
    }
    return null;
}, name);

const set_option = (name, value) => page.evaluate(([n, v]) => window.all.module.setOption(window.all.viewer, n, v), [name, value]);

async function read() {
    const text = await page.evaluate((size) => {
        const { data } = window.all.module.readImage(window.all.viewer, size, size);
        let all = '';
        for (let i = 0; i < data.length; i += 8192) all += String.fromCharCode(...data.subarray(i, i + 8192));
        return btoa(all);
    }, size);
    return Buffer.from(text, 'base64');
}

function write_tga(file, rgba) {
    const head = Buffer.alloc(18), texels = Buffer.from(rgba);
    head[2] = 2;
    head.writeUInt16LE(size, 12);
    head.writeUInt16LE(size, 14);
    head[16] = 32;
    head[17] = 0x28; // rows from the top, 8 bits of alpha
    for (let i = 0; i < texels.length; i += 4) [texels[i], texels[i + 2]] = [texels[i + 2], texels[i]];
    writeFileSync(file, Buffer.concat([head, texels]));
}

// The same image on the desktop: something is seen, and the mean difference is below 2 of 255.
async function compare(name, args) {
    const pixels = await read();
    const [ours, theirs] = ['web.tga', 'gl.png'].map((file) => path.join(work, file));
    write_tga(ours, pixels);
    execFileSync(facet, ['render', ...args, '--renderer', 'gl', '--background', 'transparent', '-s', `${size}`, '-q', '-o', theirs], { cwd: work });
    const { mae } = JSON.parse(execFileSync(facet, ['compare', '--json', ours, theirs])).metrics;
    let seen = 0;
    for (let i = 3; i < pixels.length; i += 4) seen += pixels[i] > 0;
    console.log(`${name}: mean difference ${(255 * mae).toFixed(3)} of 255`);
    assert.ok(seen > size * size / 20, `${name}: the image is empty`);
    assert.ok(mae < 2 / 255, `${name}: differs from facet render --renderer gl`);
    return pixels;
}

async function show(name, files, model) {
    for (const [file, bytes] of Object.entries(files)) writeFileSync(path.join(work, file), bytes);
    await put(files);
    assert.equal(await open(model), null, name);
    return compare(name, [model]);
}

const fetched = () => page.evaluate(() => performance.getEntriesByType('resource').map((entry) => entry.name.split('/').pop())
    .filter((name) => name.startsWith('codec_')));

try {
    assert.equal(await page.evaluate(() => window.failure), null, messages.join('\n'));
    await set_option('background', 'transparent');
    await show('plain', { 'sail.glb': testdata('sail.glb') }, 'sail.glb');
    assert.deepEqual(await fetched(), [], 'a decoder was fetched for a model that needs none');

    await show('Draco', { 'draco.glb': testdata('sail_draco_edgebreaker.glb') }, 'draco.glb');
    assert.deepEqual(await fetched(), ['codec_draco.wasm']);
    const box = path.join(data, 'models/extensions/Box_Draco.glb');
    if (existsSync(box)) await show('Box_Draco', { 'box.glb': readFileSync(box) }, 'box.glb');

    const white = await show('white', { 'white.gltf': square('data:image/png;base64,AAAA', 'EXT_texture_webp') }, 'white.gltf');
    for (const name of ['rgba_lossless.avif', 'rgb10_lossless.avif']) // alpha is the browser's: it reads that of this file as limited range
        await show(name, { 'avif.gltf': square('a.avif', 'EXT_texture_avif', 'OPAQUE'), 'a.avif': avif(name) }, 'avif.gltf');
    const textured = await show('WebP', { 'webp.gltf': square('a.webp', 'EXT_texture_webp'), 'a.webp': webp }, 'webp.gltf');
    assert.ok(!textured.equals(white), 'the texture is white');
    assert.deepEqual(await fetched(), ['codec_draco.wasm', 'codec_webp.wasm']);

    // A lost context: the textures are decoded again.
    await page.evaluate(() => new Promise((resolve) => {
        const { canvas, module } = window.all;
        const loss = canvas.getContext('webgl2').getExtension('WEBGL_lose_context');
        canvas.addEventListener('webglcontextlost', (event) => {
            event.preventDefault();
            module.lose();
            setTimeout(() => loss.restoreContext(), 0);
        }, { once: true });
        canvas.addEventListener('webglcontextrestored', () => {
            module.restore();
            setTimeout(resolve, 0);
        }, { once: true });
        loss.loseContext();
    }));
    assert.ok((await read()).equals(textured), 'the texture is lost with the context');

    // A texture that only reading finds.
    await show('OBJ with WebP', { 'a.obj': Buffer.from(obj), 'a.mtl': Buffer.from('newmtl a\nmap_Kd a.webp\n'), 'a.webp': webp }, 'a.obj');

    // Light: OpenEXR.
    const environments = ['env.exr', ...['studio_512_dwab.exr'].filter((name) => existsSync(path.join(data, 'env/exr', name)))];
    for (const name of environments) {
        const file = name === 'env.exr' ? path.join(work, name) : path.join(data, 'env/exr', name);
        await put({ [name]: readFileSync(file) });
        await page.evaluate((path) => window.all.module.codecs.load(window.all.module.listNeeds(path)), name);
        assert.equal(await open(''), null);
        await set_option('env', name);
        await compare(`light of ${name}`, ['--env', file]);
        await set_option('env', null);
    }
    assert.deepEqual(await fetched(), ['codec_draco.wasm', 'codec_webp.wasm', 'codec_exr.wasm']);

    // A damaged texture is white, a damaged mesh has its sentence, and the page goes on.
    const damaged = testdata('sail_draco_edgebreaker.glb'), stream = 28 + damaged.readUInt32LE(12);
    damaged.fill(0xff, stream + 11, stream + 60);
    await put({ 'webp.gltf': square('a.webp', 'EXT_texture_webp'), 'a.webp': webp.subarray(0, 100), 'b.glb': damaged });
    assert.equal(await open('webp.gltf'), null);
    assert.ok((await read()).equals(white), 'a damaged texture is not white');
    assert.match(await open('b.glb') ?? '', /b\.glb: .*KHR_draco_mesh_compression/);
    assert.ok((await read()).equals(white), 'a damaged model replaced the last one');

    // Without the decoder's file: its sentence.
    for (const name of ['codec_draco.wasm', 'codec_webp.wasm']) missing.add(name);
    await page.reload();
    assert.equal(await page.evaluate(() => window.failure), null, messages.join('\n'));
    await set_option('background', 'transparent');
    await put({ 'draco.glb': testdata('sail_draco_edgebreaker.glb'), 'webp.gltf': square('a.webp', 'EXT_texture_webp'), 'a.webp': webp });
    assert.match(await open('draco.glb') ?? '', /draco\.glb: .*codec_draco\.wasm could not be loaded: the server answers 404/);
    assert.equal(await open('webp.gltf'), null);
    const described = await page.evaluate(() => JSON.stringify(window.all.module.describe(window.all.viewer)));
    assert.match(described, /codec_webp\.wasm could not be loaded/, 'the missing decoder is no warning');
    missing.clear();
    assert.equal(await open('draco.glb'), null, 'a decoder that is there again is not loaded');

    const said = messages.filter((text) => !/GPU stall|WebGL: CONTEXT_LOST|status of 404/.test(text));
    assert.deepEqual(said, [], 'the page said something in the console');
    console.log('codecs: as facet render --renderer gl');
} finally {
    await served.close();
}
