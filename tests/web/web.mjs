// web.mjs - module.js in headless Chromium, against facet render --renderer gl. usage: web.mjs FACET DIST WORK [MODEL...]
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readdirSync, readFileSync, statSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { deflateSync } from 'node:zlib';
import { serve_page } from '../clients/browser.mjs';

const [facet, dist, work, ...models] = process.argv.slice(2);
const width = 320, height = 240;

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

const glass = path.join(work, 'glass.gltf');
writeFileSync(glass, glass_model());

const served = await serve_page('/a/folder/module_page.html', (url) =>
    path.join(url.includes('/module_page.') ? path.dirname(fileURLToPath(import.meta.url)) : dist, url.replace('/a/folder/', '')));
const { page, messages } = served;
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

    await page.evaluate(() => window.facetPage.ready);
    await page.evaluate(([w, h]) => {
        const { canvas } = window.facetPage;
        canvas.style.width = `${w}px`;
        canvas.style.height = `${h}px`;
    }, [width, height]);

    // Draws, and reads the pixels before the browser composites them.
    const read = () => page.evaluate(() => {
        const { canvas } = window.facetPage;
        if (!window.facetPage.draw()) return document.getElementById('error').textContent;
        const gl = canvas.getContext('webgl2');
        const rows = new Uint8Array(4 * canvas.width * canvas.height);
        gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, rows);
        let text = '';
        for (let y = canvas.height - 1; y >= 0; y--)
            text += String.fromCharCode(...rows.subarray(4 * canvas.width * y, 4 * canvas.width * (y + 1)));
        return { width: canvas.width, height: canvas.height, text };
    });
    const image = async () => {
        const got = await read();
        assert.equal(typeof got, 'object', `not drawn: ${got}`);
        assert.deepEqual([got.width, got.height], [width, height]);
        return Buffer.from(got.text, 'latin1');
    };
    const error = () => page.evaluate(() => document.getElementById('error').textContent);
    // With all of its folder, where the model says by its ending that it has other files.
    const load_folder = (model) => {
        const folder = path.dirname(model);
        const files = readdirSync(folder, { recursive: true }).filter((name) => statSync(path.join(folder, name)).isFile());
        return page.evaluate((list) => window.facetPage.loadFiles(list.map(([name, text]) => ({
            path: name, file: new File([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], name.split('/').pop()),
        }))), files.map((name) => [name, readFileSync(path.join(folder, name)).toString('base64')]));
    };
    const load = (file) => file !== glass && /\.(gltf|obj)$/.test(file) ? load_folder(file) : page.evaluate(([base64, name]) => {
        const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
        return window.facetPage.load(bytes, name);
    }, [readFileSync(file).toString('base64'), path.basename(file)]);

    // The same view on the desktop: at least a twentieth of the image shows something, and the mean difference of the
    // premultiplied channels is below 2 of 255.
    const compare = async (name, model) => {
        const pixels = await image();
        const ours = path.join(work, `${name}_web.png`), theirs = path.join(work, `${name}_gl.tga`);
        write_png(ours, pixels);
        execFileSync(facet, ['render', ...(model ? [model] : []), '--renderer', 'gl', '--background', 'transparent', '-s', `${width}x${height}`, '-q', '-o',
            path.join(work, `${name}_gl.png`)]);
        const json = JSON.parse(execFileSync(facet, ['compare', '--json', ours, path.join(work, `${name}_gl.png`)]));
        let seen = 0;
        for (let i = 3; i < pixels.length; i += 4) seen += pixels[i] > 0;
        console.log(`${name}: mean difference ${(255 * json.metrics.mae).toFixed(3)} of 255, flip ${json.metrics.flip.toFixed(4)}, ` +
            `${(100 * seen / (width * height)).toFixed(0)} % covered`);
        assert.ok(seen > width * height / 20, `${name}: the image is empty`);
        assert.ok(json.metrics.mae < 2 / 255, `${name}: differs from facet render --renderer gl`);
    };
    await compare('builtin');
    for (const model of [...models, glass]) {
        assert.ok(await load(model), `${model}: ${await error()}`);
        await compare(path.parse(model).name, model);
    }

    // A model that cannot be read: its sentence, and the last image stays.
    const before = await image();
    assert.equal(await page.evaluate(() => window.facetPage.load(new TextEncoder().encode('glTF but no more'), 'broken.glb')), false);
    assert.match(await error(), /broken\.glb/);
    assert.ok(await page.evaluate(() => !document.getElementById('error').hidden));
    assert.deepEqual(await image(), before, 'a broken model changed the image');

    // Light from a file: a panorama that is blue everywhere, then the studio again.
    const blue = Buffer.concat([Buffer.from('#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n'), Buffer.alloc(4 * 32)]);
    for (let i = blue.length - 4 * 32; i < blue.length; i += 4) blue.writeUInt32BE(0x00008081, i);
    assert.ok(await page.evaluate((text) => window.facetPage.loadLight(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)), 'blue.hdr'),
        blue.toString('base64')), await error());
    assert.notDeepEqual(await image(), before, 'the light of a file changed nothing');
    assert.ok(await page.evaluate(() => window.facetPage.loadLight(null, 'studio')));
    assert.deepEqual(await image(), before);

    // Loading again and again takes no more memory.
    const [early, late] = await page.evaluate((text) => {
        const bytes = new TextEncoder().encode(text), sizes = [];
        for (let i = 0; i < 12; i++) {
            window.facetPage.load(bytes, 'glass.gltf');
            sizes.push(window.facetPage.memory());
        }
        return [sizes[3], sizes[11]];
    }, glass_model());
    assert.equal(late, early, 'memory grows from model to model');
    assert.deepEqual(await image(), before);

    // The pointer and the keyboard turn the camera.
    const box = await page.locator('#view').boundingBox();
    await page.mouse.move(box.x + 100, box.y + 100);
    await page.mouse.down();
    await page.mouse.move(box.x + 160, box.y + 110, { steps: 3 });
    await page.mouse.up();
    const dragged = await image();
    assert.notDeepEqual(dragged, before, 'a drag did not turn the camera');
    await page.mouse.wheel(0, 240);
    const zoomed = await image();
    assert.notDeepEqual(zoomed, dragged, 'the wheel did not move the camera');
    await page.locator('#view').focus();
    await page.keyboard.press('ArrowLeft');
    const turned = await image();
    assert.notDeepEqual(turned, zoomed, 'an arrow key did not turn the camera');
    await page.keyboard.press('r'); // path tracing, in a window
    assert.deepEqual(await image(), turned, 'a key for windows changed the image');
    await page.keyboard.press('Home');
    assert.notDeepEqual(await image(), turned, 'Home did not show the whole model');

    // Controls.
    const plain = await image();
    await page.locator('#exposure').fill('2');
    assert.notDeepEqual(await image(), plain, 'the exposure did not change the image');
    await page.locator('#exposure').fill('0');
    assert.deepEqual(await image(), plain);

    // A lost context comes back with the same image.
    const whole = await image();
    await page.evaluate(() => new Promise((resolve) => {
        const { canvas } = window.facetPage;
        const loss = canvas.getContext('webgl2').getExtension('WEBGL_lose_context');
        canvas.addEventListener('webglcontextlost', () => setTimeout(() => loss.restoreContext(), 0), { once: true });
        canvas.addEventListener('webglcontextrestored', () => setTimeout(resolve, 0), { once: true });
        loss.loseContext();
    }));
    assert.deepEqual(await image(), whole, 'the image after the loss of the context differs');

    // A model of two files, picked and dropped, is the same as that of one.
    const gltf = JSON.parse(glass_model());
    const bin = Buffer.from(gltf.buffers[0].uri.split(',')[1], 'base64');
    gltf.buffers[0].uri = 'data/glass%201.bin';
    const dropped = [['glass.gltf', Buffer.from(JSON.stringify(gltf))], ['data/glass 1.bin', bin]];
    await page.evaluate(() => window.facetPage.load(null, 'built-in scene'));
    assert.ok(!(await image()).equals(before));
    assert.ok(await page.evaluate((files) => window.facetPage.loadFiles(files.map(([path, text]) => ({
        path, file: new File([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], path.split('/').pop()),
    }))), dropped.map(([name, bytes]) => [name, bytes.toString('base64')])), await error());
    assert.ok((await image()).equals(before), 'a model of two files differs from that of one');
    assert.equal(await page.evaluate((text) => window.facetPage.loadFiles([{ path: 'a.gltf', file: new File([text], 'a.gltf') },
        { path: 'b.txt', file: new File(['b'], 'b.txt') }]), dropped[0][1].toString()), false);
    assert.match(await error(), /glass 1\.bin|glass%201\.bin/, 'a missing file is named');

    // By the page's own input.
    await page.locator('#file').setInputFiles({ name: 'empty.glb', mimeType: 'model/gltf-binary', buffer: Buffer.alloc(0) });
    await page.waitForFunction(() => document.getElementById('error').textContent.includes('empty.glb'));

    const elsewhere = await page.evaluate(() => performance.getEntriesByType('resource').map((entry) => entry.name)
        .filter((name) => !name.startsWith(`${location.origin}/a/folder/`)));
    assert.deepEqual(elsewhere, [], 'the page asks for files outside of its folder');
    const said = messages.filter((text) => !/GPU stall|WebGL: CONTEXT_LOST/.test(text));
    assert.deepEqual(said, [], 'the page said something in the console');
    console.log('web: as facet render --renderer gl');
} finally {
    await served.close();
}
