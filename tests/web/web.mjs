// web.mjs - viewer.wasm through module.js in headless Chromium, against facet render --renderer gl: images, options, picking,
// materials, hostile files, memory, loss of the context. usage: web.mjs FACET DIST WORK [MODEL...]
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { copyFileSync, cpSync, readdirSync, readFileSync, statSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { deflateSync, gzipSync } from 'node:zlib';
import { serve_page } from '../clients/browser.mjs';

const [command_path, dist, work, ...models] = process.argv.slice(2);
const facet = path.resolve(command_path);
const width = 320, height = 240;

// What a page fetches for its first model, as a server sends it.
const CORE_LIMIT = 600_000; // bytes
const core = ['viewer.wasm', 'viewer.js'].map((name) => gzipSync(readFileSync(path.join(dist, 'facet-viewer', name)), { level: 9 }).length);
console.log(`size: viewer.wasm ${core[0]}, viewer.js ${core[1]} bytes with gzip`);
assert.ok(core[0] + core[1] <= CORE_LIMIT, `viewer.wasm and viewer.js have ${core[0] + core[1]} bytes with gzip, more than ${CORE_LIMIT}`);

// An image of straight RGBA, rows from the top.
function write_png(file, pixels) {
    const rows = [];
    for (let y = 0; y < height; y++) rows.push(Buffer.from([0]), pixels.subarray(4 * width * y, 4 * width * (y + 1)));
    const chunk = (type, data) => {
        const body = Buffer.concat([Buffer.from(type, 'latin1'), data]), size = Buffer.alloc(4), crc = Buffer.alloc(4);
        size.writeUInt32BE(data.length);
        crc.writeUInt32BE(crc32(body));
        return Buffer.concat([size, body, crc]);
    };
    const head = Buffer.from([0, 0, 0, 0, 0, 0, 0, 0, 8, 6, 0, 0, 0]);
    head.writeUInt32BE(width, 0);
    head.writeUInt32BE(height, 4);
    writeFileSync(file, Buffer.concat([Buffer.from('89504e470d0a1a0a', 'hex'), chunk('IHDR', head),
        chunk('IDAT', deflateSync(Buffer.concat(rows))), chunk('IEND', Buffer.alloc(0))]));
}

function crc32(bytes) {
    let crc = 0xffffffff;
    for (const byte of bytes) {
        crc ^= byte;
        for (let bit = 0; bit < 8; bit++) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
    }
    return ~crc >>> 0;
}

// An octahedron of tinted rough glass before an emissive square: transmission and volume draw into the levels of a texture, which
// WebGL checks more strictly than other drivers.
function glass_model() {
    const corners = [[1, 0, 0], [0, 1, 0], [0, 0, 1]], places = [];
    for (let octant = 0; octant < 8; octant++) {
        const sign = [octant & 1, octant & 2, octant & 4].map((bit) => (bit ? -1 : 1));
        const triangle = corners.map((corner) => corner.map((x, axis) => x * sign[axis]));
        places.push(...(sign[0] * sign[1] * sign[2] > 0 ? triangle : triangle.reverse()).flat());
    }
    places.push(...[[-1, -1], [1, -1], [1, 1], [-1, -1], [1, 1], [-1, 1]].flatMap(([x, y]) => [x, y, -2]));
    const bytes = Buffer.from(Float32Array.from(places).buffer);
    return JSON.stringify({
        asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }],
        meshes: [{ primitives: [{ attributes: { POSITION: 0 }, material: 0 }, { attributes: { POSITION: 1 }, material: 1 }] }],
        materials: [{
            pbrMetallicRoughness: { metallicFactor: 0, roughnessFactor: 0.3 },
            extensions: {
                KHR_materials_transmission: { transmissionFactor: 1 },
                KHR_materials_volume: { thicknessFactor: 1, attenuationDistance: 1, attenuationColor: [0.3, 0.8, 0.9] },
            },
        }, { pbrMetallicRoughness: { baseColorFactor: [0, 0, 0, 1] }, emissiveFactor: [1, 0.5, 0.1] }],
        extensionsUsed: ['KHR_materials_transmission', 'KHR_materials_volume'],
        accessors: [
            { bufferView: 0, componentType: 5126, count: 24, type: 'VEC3', min: [-1, -1, -1], max: [1, 1, 1] },
            { bufferView: 0, byteOffset: 288, componentType: 5126, count: 6, type: 'VEC3', min: [-1, -1, -2], max: [1, 1, -2] },
        ],
        bufferViews: [{ buffer: 0, byteLength: bytes.length }],
        buffers: [{ byteLength: bytes.length, uri: `data:application/octet-stream;base64,${bytes.toString('base64')}` }],
    });
}

writeFileSync(path.join(work, 'glass.gltf'), glass_model());

// ---- the page: one module, one canvas, functions for the tests ----

const html = `<!doctype html><html lang="en"><meta charset="utf-8"><title>facet</title><link rel="icon" href="data:,">
<canvas id="view" width="${width}" height="${height}"></canvas><script type="module">
import { loadModule } from './facet-viewer/module.js';
const canvas = document.getElementById('view');
const toBytes = (base64) => Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
const toText = (bytes) => { let text = ''; for (let i = 0; i < bytes.length; i += 8192) text += String.fromCharCode(...bytes.subarray(i, i + 8192)); return text; };
window.start = async () => {
    const module = await loadModule();
    module.start(canvas);
    const web = window.web = { module, viewer: module.create(), canvas };
    web.open = (path, files, viewer = web.viewer) => {
        module.removeFiles();
        for (const [name, base64] of files) module.putFile(name, toBytes(base64));
        module.open(viewer, path);
    };
    // The canvas before the browser composites it: rows from the top, straight alpha.
    web.frame = (viewer = web.viewer) => {
        module.draw(viewer, canvas.width, canvas.height);
        const gl = canvas.getContext('webgl2'), rows = new Uint8Array(4 * canvas.width * canvas.height);
        gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, rows);
        const size = 4 * canvas.width, flipped = new Uint8Array(rows.length);
        for (let y = 0; y < canvas.height; y++) flipped.set(rows.subarray(y * size, (y + 1) * size), (canvas.height - 1 - y) * size);
        return toText(flipped.map((value, i) => i % 4 === 3 ? value : Math.min(255, Math.round(value * 255 / Math.max(1, flipped[i | 3])))));
    };
    web.image = (w, h, viewer = web.viewer) => toText(module.readImage(viewer, w, h).data);
    web.put = (name, base64) => module.putFile(name, toBytes(base64));
};
// The sentence that use() throws; '' if it throws none.
window.sentence = (use) => { try { use(); return ''; } catch (error) { return error.message; } };
</script></html>`;
const served = await serve_page('/a/folder/test.html', (url) => url === '/a/folder/test.html' ? { text: html } : path.join(dist, url.replace('/a/folder/', '')));
const { page, messages } = served;
const base64 = (bytes) => Buffer.from(bytes).toString('base64');
const frame = async () => Buffer.from(await page.evaluate(() => window.web.frame()), 'latin1');
const image = async () => Buffer.from(await page.evaluate(([w, h]) => window.web.image(w, h), [width, height]), 'latin1');
const set_options = (options) => page.evaluate((all) => {
    for (const [name, value] of Object.entries(all)) window.web.module.setOption(window.web.viewer, name, value);
}, options);

// A model with all of its folder, where its ending says that it has other files. Copies in WORK are those of copied commands.
function files_of(model) {
    const folder = path.dirname(model), name = path.basename(model);
    if (folder !== work) {
        if (/\.(gltf|obj)$/.test(model)) cpSync(folder, work, { recursive: true });
        else copyFileSync(model, path.join(work, name));
    }
    const names = folder !== work && /\.(gltf|obj)$/.test(model)
        ? readdirSync(folder, { recursive: true }).filter((one) => statSync(path.join(folder, one)).isFile()) : [name];
    return [name, names.map((one) => [one, base64(readFileSync(path.join(folder, one)))])];
}
const open = ([name, files]) => page.evaluate(([path, list]) => window.web.open(path, list), [name, files]);

// The mean difference of two images, of 255, is below most; at least a twentieth of the first is covered.
function compare(name, pixels, theirs, most = 2) {
    const ours = path.join(work, `${name}_web.png`);
    let seen = 0;
    for (let i = 3; i < pixels.length; i += 4) seen += pixels[i] > 0;
    write_png(ours, pixels);
    const { metrics } = JSON.parse(execFileSync(facet, ['compare', '--json', ours, theirs]));
    console.log(`${name}: mean difference ${(255 * metrics.mae).toFixed(3)} of 255, flip ${metrics.flip.toFixed(4)}, ` +
        `${(100 * seen / (width * height)).toFixed(0)} % covered`);
    assert.ok(seen > width * height / 20, `${name}: the image is empty`);
    assert.ok(metrics.mae < most / 255, `${name}: differs from facet render --renderer gl`);
}

try {
    // Without WebGL 2 everything below would be blank: fail, whatever the reason.
    const cleared = await page.evaluate(() => {
        const gl = document.createElement('canvas').getContext('webgl2');
        if (!gl) return null;
        gl.clearColor(0.2, 0.4, 0.6, 1);
        gl.clear(gl.COLOR_BUFFER_BIT);
        const rgba = new Uint8Array(4);
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, rgba);
        return [...rgba];
    });
    assert.deepEqual(cleared, [51, 102, 153, 255], 'the browser draws nothing by WebGL 2');
    await page.evaluate(() => window.start());

    // ---- models as facet render shows them ----

    await set_options({ background: 'transparent' });
    await open(['', []]);
    for (const model of ['', ...models, path.join(work, 'glass.gltf')]) {
        const name = model ? path.parse(model).name : 'builtin', theirs = path.join(work, `${name}_gl.png`);
        if (model) await open(files_of(model));
        execFileSync(facet, ['render', ...(model ? [model] : []), '--renderer', 'gl', '--background', 'transparent',
            '-s', `${width}x${height}`, '-q', '-o', theirs]);
        compare(name, await frame(), theirs);
    }

    // ---- options: the image of the copied command, and the same image after a round trip ----

    const glass = files_of(path.join(work, 'glass.gltf'));
    const with_lights = models.filter((model) => model.includes('04_lights')).map(files_of)[0] ?? glass;
    const cases = [
        ['ground', ['', []], { ground: 'shadow', background: 'transparent', orbit: '30,60,90%' }],
        ['light', ['', []], { env: 'sun:30,60', 'env-rotation': '45', 'env-intensity': '0.7', background: 'env', 'background-blur': '0.3' }],
        ['color', glass, { exposure: '0.5', 'tone-mapping': 'agx', background: '#336699', energy: 'gltf', fov: '50', 'specular-aa': '' }],
        ['shadows', with_lights, { shadows: 'true', bloom: '0.1' }],
        ['normal', glass, { channel: 'normal', ortho: '' }],
        ['clearcoat', ['', []], { channel: 'clearcoat', brdf: 'schlick-ggx' }],
        ['peeled', glass, { transparency: 'peeled', target: '0.1,0,-0.2', orbit: '-100deg 80deg 5m' }],
        ['ogl1', ['', []], { shading: 'ogl1' }],
    ];
    for (const [name, model, options] of cases) {
        await page.evaluate(() => {
            const { web } = window;
            web.module.destroy(web.viewer);
            web.viewer = web.module.create();
        });
        await open(model);
        await set_options(options);
        const drawn = await frame(), read = await image();
        const { command, kept } = await page.evaluate(([w, h]) => {
            const { module, viewer } = window.web;
            return { command: module.command(viewer, w, h), kept: module.getOptions(viewer) };
        }, [width, height]);
        const theirs = command.match(/-o ([^ ]+)/)[1];
        execFileSync('sh', ['-c', command.replace(/^facet/, '"$0"'), facet], { cwd: work, stdio: ['ignore', 'ignore', 'pipe'] });
        copyFileSync(path.join(work, theirs), path.join(work, `${name}_command.png`));
        compare(name, drawn, path.join(work, `${name}_command.png`));
        compare(`${name}, read`, read, path.join(work, `${name}_command.png`));
        for (const option of Object.keys(options))
            assert.ok(option in kept, `${name}: --${option} is missing in ${JSON.stringify(kept)}`);
        const again = Buffer.from(await page.evaluate(([path, all]) => {
            const { web } = window, other = web.module.create();
            web.module.open(other, path);
            for (const [option, value] of Object.entries(all)) web.module.setOption(other, option, value);
            const text = web.frame(other);
            web.module.destroy(other);
            return text;
        }, [model[0], kept]), 'latin1');
        assert.ok(again.equals(drawn), `${name}: ${JSON.stringify(kept)} is another image`);
    }

    // Sentences are the command's, and a refused option changes nothing.
    const refused = await page.evaluate(() => {
        const { module, viewer } = window.web;
        module.setOption(viewer, 'shading', null);
        const before = JSON.stringify(module.getOptions(viewer));
        const said = [['tone-mapping', 'agxx'], ['tone-maping', 'agx'], ['orbit', 'x'], ['animation', 'Run'], ['output', 'a.png'], ['env', 'no.hdr'],
            ['bloom', '2']].map(([name, value]) => window.sentence(() => module.setOption(viewer, name, value)));
        return { said, isSame: JSON.stringify(module.getOptions(viewer)) === before };
    });
    [/--tone-mapping: "agxx" is none of .*did you mean agx/, /unknown option --tone-maping; did you mean --tone-mapping/, /--orbit: "x" is not AZIMUTH/,
        /no animation/, /--output: it is an option of the command/, /no\.hdr: there is no such file/, /--bloom: "2" is not a number from 0 to 1/]
        .forEach((wanted, i) => assert.match(refused.said[i], wanted));
    assert.ok(refused.isSame, 'a refused option changed the options');
    const metered = await page.evaluate(() => {
        const { module, viewer } = window.web;
        module.open(viewer, '');
        module.setOption(viewer, 'exposure', 'auto');
        return Number(module.getOptions(viewer).exposure);
    });
    assert.ok(metered > -3 && metered < 3 && metered !== 0, `the meter says ${metered} stops`);
    await page.evaluate(() => window.web.module.setOption(window.web.viewer, 'exposure', null));

    // ---- two viewers share a context; a divider shows two images ----

    await open(glass);
    const whole = await frame();
    const beside = await page.evaluate(() => {
        const { web } = window, other = web.module.create();
        web.module.open(other, '');
        const text = web.frame(other);
        web.module.destroy(other);
        return text;
    });
    assert.ok(!Buffer.from(beside, 'latin1').equals(whole));
    assert.ok((await frame()).equals(whole), 'another viewer changed this one');
    const divided = Buffer.from(await page.evaluate(() => {
        const { web } = window;
        web.module.compare(web.viewer, 'tone-mapping', 0.5);
        const text = web.frame();
        web.module.compare(web.viewer, '');
        return text;
    }), 'latin1');
    const half = (pixels, from, to) => Buffer.concat(Array.from({ length: height }, (_, y) => pixels.subarray(4 * (width * y + from), 4 * (width * y + to))));
    assert.ok(half(divided, width / 2, width).equals(half(whole, width / 2, width)), 'the right side is not the image');
    assert.ok(!half(divided, 0, width / 2).equals(half(whole, 0, width / 2)), 'the left side is not another image');

    // ---- what is at a pixel, and where a position is ----

    const [hit, miss, place] = await page.evaluate(([w, h]) => {
        const { module, viewer } = window.web;
        const found = module.pick(viewer, w / 2, h / 2);
        return [found, module.pick(viewer, 1, 1), module.project(viewer, found.position)];
    }, [width, height]);
    assert.equal(miss, null);
    assert.equal(hit.material, 0);
    assert.ok(Math.abs(hit.position.reduce((sum, x) => sum + Math.abs(x), 0) - 1) < 1e-3, `${hit.position} is not on the octahedron`);
    assert.ok(Math.abs(Math.hypot(...hit.normal) - 1) < 0.01);
    assert.ok(Math.hypot(place.x - width / 2 - 0.5, place.y - height / 2 - 0.5) < 0.01 && place.isInFront, JSON.stringify(place));

    // ---- materials: a change is the same as a model that has it ----

    const change = { pbrMetallicRoughness: { baseColorFactor: [1, 0.2, 0.1, 1] }, extensions: { KHR_materials_transmission: null } };
    const gltf = JSON.parse(glass_model()), edited = structuredClone(gltf);
    edited.materials[0].pbrMetallicRoughness.baseColorFactor = [1, 0.2, 0.1, 1];
    delete edited.materials[0].extensions.KHR_materials_transmission;
    await page.evaluate((part) => window.web.module.setMaterial(window.web.viewer, 0, part), change);
    const changed = await frame();
    assert.ok(!changed.equals(whole), 'the change of a material changed nothing');
    assert.match(await page.evaluate(() => window.sentence(() => window.web.module.setMaterial(window.web.viewer, 0, { alphaMode: 3 }))), /materials\[0\].*alphaMode/);
    assert.match(await page.evaluate(() => window.sentence(() => window.web.module.setMaterial(window.web.viewer, 7, {}))), /no material 7/);
    await open(['edited.gltf', [['edited.gltf', base64(JSON.stringify(edited))]]]);
    const of_file = await frame(); // to within rounding: these are images of two scenes
    assert.ok(changed.every((value, i) => Math.abs(value - of_file[i]) <= 1), 'a changed material differs from that of a file');

    // ---- files: several, alike names, hostile ones ----

    const bin = Buffer.from(gltf.buffers[0].uri.split(',')[1], 'base64');
    gltf.buffers[0].uri = 'data/glass%201.bin';
    const split = base64(JSON.stringify(gltf));
    await open(['in/glass.gltf', [['in/glass.gltf', split], ['in/data/glass 1.bin', base64(bin)]]]);
    assert.ok((await frame()).equals(whole), 'a model of two files differs from that of one');
    await open(['in/glass.gltf', [['in/glass.gltf', split], ['in/Data/Glass 1.BIN', base64(bin)]]]);
    assert.ok((await frame()).equals(whole));
    assert.match(await page.evaluate(() => window.web.module.state(window.web.viewer).message), /"Data\/Glass 1.BIN" is read instead/);
    const hostile = [['broken.glb', 'glTF but no more', /broken\.glb/], ['empty.glb', '', /empty\.glb/], ['missing.gltf', Buffer.from(split, 'base64'), /glass 1\.bin|glass%201\.bin/],
        ['deep.gltf', '['.repeat(100000), /deep\.gltf/]];
    for (const [name, bytes, wanted] of hostile) {
        assert.match(await page.evaluate(([path, list]) => window.sentence(() => window.web.open(path, list)), [name, [[name, base64(bytes)]]]), wanted);
        assert.ok((await frame()).equals(whole), `${name} changed the image`);
    }

    // Light from a file: a panorama that is blue everywhere, then the studio again.
    const blue = Buffer.concat([Buffer.from('#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n'), Buffer.alloc(4 * 32)]);
    for (let i = blue.length - 4 * 32; i < blue.length; i += 4) blue.writeUInt32BE(0x00008081, i);
    await page.evaluate((bytes) => window.web.put('lights/blue.hdr', bytes), base64(blue));
    await set_options({ env: 'lights/Blue.HDR' });
    assert.ok(!(await frame()).equals(whole), 'the light of a file changed nothing');
    await set_options({ env: null });
    assert.ok((await frame()).equals(whole));

    // ---- pointer and keys ----

    const act = (use) => page.evaluate(use);
    await act(() => [[1, 0, 0, 100, 100], [3, 0, 0, 160, 110], [2, 0, 0, 160, 110]].forEach((event) => window.web.module.point(window.web.viewer, ...event)));
    const dragged = await frame();
    assert.ok(!dragged.equals(whole), 'a drag did not turn the camera');
    assert.equal(await act(() => window.web.module.point(window.web.viewer, 4, 0, 0, 0, -1)), true);
    const zoomed = await frame();
    assert.ok(!zoomed.equals(dragged), 'the wheel did not move the camera');
    assert.equal(await act(() => window.web.module.key(window.web.viewer, 256, 0)), true);
    assert.ok(!(await frame()).equals(zoomed), 'an arrow key did not turn the camera');
    assert.equal(await act(() => window.web.module.key(window.web.viewer, 'R'.charCodeAt(0), 0)), false, 'R is path tracing, in a window');
    await act(() => window.web.module.setOption(window.web.viewer, 'orbit', null));
    assert.ok((await frame()).equals(whole), 'the default orbit is another image');

    // ---- 100 loads take no more memory, of WebAssembly and of WebGL ----

    const [early, late] = await page.evaluate((files) => {
        const { web } = window, gl = web.canvas.getContext('webgl2'), sizes = [];
        let alive = 0;
        for (const kind of ['Texture', 'Buffer', 'Framebuffer', 'Renderbuffer', 'Program', 'Shader', 'VertexArray', 'Sampler', 'Query']) {
            const create = gl[`create${kind}`], remove = gl[`delete${kind}`];
            gl[`create${kind}`] = function (...all) { alive++; return create.apply(this, all); };
            gl[`delete${kind}`] = function (object) { if (object) alive--; return remove.call(this, object); };
        }
        for (let i = 0; i < 100; i++) {
            web.open(files[0], files[1]);
            if (i % 10 === 2 || i === 99) web.frame();
            if (i === 12 || i === 92) sizes.push([web.module.memorySize, alive]);
        }
        return sizes;
    }, glass);
    assert.deepEqual(late, early, 'memory or objects of WebGL grow from model to model');
    assert.ok((await frame()).equals(whole));

    // ---- a lost context comes back with the same image; a stopped module says so ----

    await page.evaluate(() => new Promise((resolve) => {
        const { canvas, module } = window.web;
        const loss = canvas.getContext('webgl2').getExtension('WEBGL_lose_context');
        canvas.addEventListener('webglcontextlost', (event) => {
            event.preventDefault();
            module.lose();
            setTimeout(() => loss.restoreContext(), 0);
        }, { once: true });
        canvas.addEventListener('webglcontextrestored', () => { module.restore(); resolve(); }, { once: true });
        loss.loseContext();
    }));
    assert.ok((await frame()).equals(whole), 'the image after the loss of the context differs');
    const stopped = await page.evaluate(() => {
        const { module, viewer } = window.web;
        const first = window.sentence(() => module.state(0xfffffff0));
        return [first, window.sentence(() => module.state(viewer)), module.isLost];
    });
    assert.match(stopped[0], /facet has stopped/);
    assert.match(stopped[1], /has to be loaded again/);
    assert.equal(stopped[2], true);

    const elsewhere = await page.evaluate(() => performance.getEntriesByType('resource').map((entry) => entry.name)
        .filter((name) => !name.startsWith(`${location.origin}/a/folder/`) && !name.startsWith('data:')));
    assert.deepEqual(elsewhere, [], 'the module asks for files outside of its folder');
    const said = messages.filter((text) => !/GPU stall|WebGL: CONTEXT_LOST/.test(text));
    assert.deepEqual(said, [], 'the page said something in the console');
    console.log('web: as facet render --renderer gl');
} finally {
    await served.close();
}
