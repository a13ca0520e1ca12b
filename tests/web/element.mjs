// element.mjs - <facet-viewer> in headless Chromium, under a strict content security policy. usage: element.mjs FACET DIST WORK [MODEL...]
import assert from 'node:assert/strict';
import { existsSync, readFileSync } from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { serve_page } from '../clients/browser.mjs';
import { box_model } from './element_models.mjs';

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
    if (url === '/site/google.js') return google;
    if (url.startsWith('/site/box')) return { text: box_model() };
    if (url === '/site/models/apart.gltf' || url === '/site/buffers/the box.bin') return { text: apart()[url.includes('.bin') ? 1 : 0] };
    if (url === '/site/blue.hdr') return { text: blue_sky() };
    if (url === '/site/broken.glb') return { text: 'glTF but no more' };
    if (url.startsWith('/site/poster')) return { text: '<svg xmlns="http://www.w3.org/2000/svg"/>' };
    if (url.startsWith('/models/')) return shown.find((file) => path.basename(file) === url.slice(8)) ?? 'none';
    return path.join(dist, url.replace('/site/', ''));
}

// The box as text and buffer in different folders.
function apart() {
    const gltf = JSON.parse(box_model()), bytes = Buffer.from(gltf.buffers[0].uri.split(',')[1], 'base64');
    gltf.buffers[0].uri = '../buffers/the%20box.bin';
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

// Helpers in the page: elements with a log of their events.
const prepare = () => page.evaluate(() => {
    window.make = (attributes = {}, size = [320, 240]) => {
        const viewer = document.createElement('facet-viewer');
        viewer.log = [];
        for (const type of ['load', 'error', 'progress', 'model-visibility', 'poster-dismissed', 'camera-change', 'environment-change', 'variant-applied',
            'play', 'pause', 'loop', 'finished', 'render-scale', 'facet-change', 'facet-message'])
            viewer.addEventListener(type, (event) => viewer.log.push([type, event.detail]));
        for (const [name, value] of Object.entries(attributes)) viewer.setAttribute(name, value);
        viewer.style.width = `${size[0]}px`;
        viewer.style.height = `${size[1]}px`;
        document.body.append(viewer);
        return viewer;
    };
    window.event = (viewer, type, act = () => {}) => new Promise((resolve, reject) => {
        const late = setTimeout(() => reject(new Error(`no event ${type} after ${JSON.stringify(viewer.log.slice(-4))}`)), 20000);
        viewer.addEventListener(type, (found) => { clearTimeout(late); resolve(found.detail); }, { once: true });
        act();
    });
    window.frames = async (n = 2) => { for (let i = 0; i < n; i++) await new Promise((resolve) => requestAnimationFrame(resolve)); };
    window.settled = async (viewer) => {
        for (let last = ''; ;) {
            await window.frames(4);
            const now = JSON.stringify([viewer.getCameraOrbit(), viewer.getCameraTarget(), viewer.getFieldOfView()]);
            if (now === last) return;
            last = now;
        }
    };
    // Of the image: its pixels as a text, how many are not transparent, and the mean color of those.
    window.image = async (viewer) => {
        const bitmap = await createImageBitmap(await viewer.toBlob());
        const canvas = new OffscreenCanvas(bitmap.width, bitmap.height), context = canvas.getContext('2d');
        context.drawImage(bitmap, 0, 0);
        const { data } = context.getImageData(0, 0, canvas.width, canvas.height), sum = [0, 0, 0];
        let covered = 0, hash = 0;
        for (let i = 0; i < data.length; i += 4) {
            hash = (hash * 31 + data[i] + 3 * data[i + 1] + 7 * data[i + 2] + 11 * data[i + 3]) | 0;
            if (data[i + 3] < 128) continue;
            covered++;
            for (let c = 0; c < 3; c++) sum[c] += data[i + c];
        }
        return { hash, covered: covered / (data.length / 4), color: sum.map((value) => value / covered), size: [canvas.width, canvas.height] };
    };
    window.clear = async () => { document.body.replaceChildren(); await new Promise((resolve) => setTimeout(resolve, 1100)); };
});
const open = async (name) => {
    await page.goto(new URL(name, page.url()).href);
    await page.evaluate(() => customElements.whenDefined('facet-viewer'));
    await prepare();
};

const tests = {
    async 'attributes and properties'() {
        const found = await page.evaluate(() => {
            const viewer = document.createElement('facet-viewer');
            const defaults = ['src', 'alt', 'poster', 'loading', 'reveal', 'cameraControls', 'cameraOrbit', 'cameraTarget', 'fieldOfView', 'minCameraOrbit', 'interpolationDecay',
                'touchAction', 'autoRotateDelay', 'exposure', 'toneMapping', 'shadowIntensity', 'shadowSoftness', 'animationCrossfadeDuration', 'orientation', 'scale',
                'interactionPromptThreshold', 'loaded', 'modelIsVisible', 'paused', 'duration', 'canActivateAR'].map((name) => viewer[name]);
            viewer.setAttribute('exposure', '1.5');
            viewer.setAttribute('camera-controls', '');
            viewer.setAttribute('touch-action', 'pan-y');
            viewer.setAttribute('loading', 'bogus');
            viewer.setAttribute('shadow-intensity', 'much');
            const parsed = [viewer.exposure, viewer.cameraControls, viewer.touchAction, viewer.loading, viewer.shadowIntensity];
            viewer.removeAttribute('camera-controls');
            viewer.cameraOrbit = '1deg 2deg 3m';
            viewer.cameraOrbit = null;
            return { defaults, parsed, after: [viewer.cameraControls, viewer.cameraOrbit], observed: viewer.constructor.observedAttributes.length };
        });
        equal(found.defaults, [null, null, null, 'auto', 'auto', false, '0deg 75deg 105%', 'auto auto auto', 'auto', 'auto', 50, 'none', 3000, 1, 'auto', 0, 1, 300, '0 0 0',
            '1 1 1', 3000, false, false, true, 0, false]);
        equal(found.parsed, [1.5, true, 'pan-y', 'auto', 0]);
        equal(found.after, [false, '0deg 75deg 105%']);
        check(found.observed > 45, 'attributes are missing');
    },

    async 'a model from src'() {
        const { log, image, empty, poster, methods } = await page.evaluate(async () => {
            const viewer = make({ src: 'box.gltf', alt: 'A box.', poster: 'poster.svg' });
            const empty = viewer.shadowRoot.querySelector('.poster').classList.contains('shown');
            await event(viewer, 'load');
            await frames();
            const poster = viewer.shadowRoot.querySelector('.poster').classList.contains('shown');
            return {
                log: viewer.log, empty, poster, image: await image(viewer),
                methods: { loaded: viewer.loaded, visible: viewer.modelIsVisible, size: { ...viewer.getDimensions() }, text: `${viewer.getBoundingBoxCenter()}`, path: viewer.modelPath,
                    url: viewer.toDataURL('image/jpeg').slice(0, 22), materials: viewer.describe().materials?.length },
            };
        });
        const types = log.map(([type]) => type), shares = log.filter(([type]) => type === 'progress').map(([, { totalProgress }]) => totalProgress);
        check(empty && !poster, 'the poster goes with the model');
        check(types.includes('poster-dismissed') && types.includes('model-visibility'), 'the model is revealed');
        check(shares.at(-1) === 1 && shares.every((share, i) => i === 0 || share >= shares[i - 1]), `progress goes back: ${shares}`);
        check(image.covered > 0.05 && image.covered < 0.9, `${image.covered} of the image is covered`);
        check(Math.max(...image.color) - Math.min(...image.color) < 12, `a gray box is ${image.color}`);
        equal(image.size, [320, 240]);
        check(methods.loaded && methods.visible, 'loaded, modelIsVisible');
        equal([methods.size.x, methods.size.y, methods.size.z], [1, 2, 3]);
        check(/^\S+m \S+m \S+m$/.test(methods.text), methods.text);
        equal(methods.path, 'box.gltf');
        equal(methods.url, 'data:image/jpeg;base64');
        equal(methods.materials, 3);
    },

    async 'a file that cannot be read'() {
        const { error, before, after } = await page.evaluate(async () => {
            await clear();
            const viewer = make({ src: 'box.gltf' });
            await event(viewer, 'load');
            const before = await image(viewer);
            const error = await event(viewer, 'error', () => { viewer.src = 'broken.glb'; });
            return { error: { type: error.type, message: error.message }, before, after: await image(viewer) };
        });
        equal(error.type, 'loadfailure');
        check(/broken\.glb/.test(error.message), error.message);
        equal(after.hash, before.hash, 'a broken file changed the image');
        const missing = await page.evaluate(async () => (await event(document.querySelector('facet-viewer'), 'error', () => { document.querySelector('facet-viewer').src = 'none/such.glb'; })).message);
        check(/such\.glb.*404/.test(missing), missing);
    },

    async 'the camera by attributes'() {
        const found = await page.evaluate(async () => {
            await clear();
            const viewer = make({ src: 'box.gltf', 'interpolation-decay': '50' });
            await event(viewer, 'load');
            const state = () => ({ ...viewer.getCameraOrbit(), fov: viewer.getFieldOfView(), target: `${viewer.getCameraTarget()}` });
            const start = state();
            viewer.cameraOrbit = '90deg 45deg 80%';
            const slow = (await frames(1), state());
            await settled(viewer);
            const after = state();
            viewer.cameraOrbit = '-450deg 10deg 1000m';
            viewer.jumpCameraToGoal();
            await viewer.updateComplete;
            await frames();
            const limited = state();
            viewer.minFieldOfView = '20deg';
            viewer.fieldOfView = '5deg';
            viewer.cameraTarget = '0m 0.5m auto';
            await viewer.updateComplete;
            await settled(viewer);
            const zoomed = state();
            const limits = [viewer.getMinimumFieldOfView(), viewer.getMaximumFieldOfView()];
            viewer.maxCameraOrbit = 'auto 60deg auto';
            viewer.cameraOrbit = 'auto 80deg auto';
            await viewer.updateComplete;
            await settled(viewer);
            return { start, slow, after, limited, zoomed, limits, low: state(), sources: viewer.log.filter(([type]) => type === 'camera-change').map(([, detail]) => detail.source) };
        });
        const radius = Math.hypot(0.5, 1, 1.5) / Math.sin(Math.PI / 12);
        near(found.start.theta, 0, 'theta');
        near(found.start.phi, 75 * Math.PI / 180, 'phi');
        near(found.start.radius, 1.05 * radius, 'radius');
        equal(found.start.target, '0m 1m 0m');
        check(found.slow.theta < 1.5, 'the camera jumped');
        near(found.after.theta, Math.PI / 2, 'theta');
        near(found.after.radius, 0.8 * radius, 'radius');
        near(found.limited.radius, 1.05 * radius, 'the largest radius');
        near(found.limited.theta, -2.5 * Math.PI, 'theta of several turns');
        near(found.zoomed.fov, 20, 'field of view');
        equal(found.zoomed.target, '0m 0.5m 0m');
        near(found.limits[0], 20, 'least field of view');
        near(found.low.phi, Math.PI / 3, 'largest polar angle');
        check(found.sources.length > 4 && found.sources.every((source) => source === 'none'), `${found.sources}`);
    },

    async 'mouse, wheel and keyboard'() {
        await page.evaluate(async () => {
            await clear();
            const viewer = make({ src: 'box.gltf', 'camera-controls': '', alt: 'A box' });
            await event(viewer, 'load');
            await settled(viewer);
        });
        const read = () => page.evaluate(async () => {
            const viewer = document.querySelector('facet-viewer');
            await settled(viewer);
            return { ...viewer.getCameraOrbit(), fov: viewer.getFieldOfView(), target: { ...viewer.getCameraTarget() }, source: viewer.log.filter(([type]) => type === 'camera-change').at(-1)?.[1].source };
        });
        const box = await page.locator('facet-viewer').boundingBox();
        const drag = async (dx, dy, button = 'left') => {
            await page.mouse.move(box.x + 20, box.y + 200);
            await page.mouse.down({ button });
            await page.mouse.move(box.x + 20 + dx, box.y + 200 + dy, { steps: 4 });
            await page.mouse.up({ button });
        };
        const start = await read();
        await page.keyboard.press('Tab');
        check(await page.evaluate(() => document.activeElement === document.querySelector('facet-viewer')), 'Tab does not reach the element');
        await drag(30, 0);
        const turned = await read();
        near(turned.theta, start.theta - 2 * Math.PI * 30 / 240, 'a drag');
        equal(turned.source, 'user-interaction');
        await drag(0, -24, 'right');
        const panned = await read();
        check(panned.target.y !== turned.target.y && Math.abs(panned.theta - turned.theta) < 1e-9, 'the right button did not pan');
        await page.mouse.wheel(0, -240);
        const zoomed = await read();
        check(zoomed.fov < panned.fov && zoomed.radius < panned.radius, 'the wheel did not zoom');
        await page.keyboard.press('ArrowLeft');
        const left = await read();
        near(left.theta, zoomed.theta + Math.PI / 8, 'an arrow');
        await page.keyboard.press('ArrowUp');
        check((await read()).phi > left.phi, 'an arrow up');
        await page.keyboard.press('PageUp');
        check((await read()).fov > left.fov, 'Page Up');
        const before = await read();
        await page.keyboard.press('Shift+ArrowRight');
        const moved = await read();
        check(Math.abs(moved.theta - before.theta) < 1e-9 && JSON.stringify(moved.target) !== JSON.stringify(before.target), 'Shift and an arrow did not pan');
        await page.keyboard.press('a');
        equal((await read()).theta, moved.theta);
        for (let i = 0; i < 4; i++) await page.keyboard.press('ArrowLeft');
        await read();
        const aria = await page.evaluate(async () => {
            await new Promise((resolve) => setTimeout(resolve, 400));
            const { shadowRoot } = document.querySelector('facet-viewer'), input = shadowRoot.querySelector('.input');
            const all = ['role', 'aria-roledescription', 'aria-label', 'aria-keyshortcuts', 'tabindex'].map((name) => input.getAttribute(name));
            return { all, status: shadowRoot.querySelector('[role=status]').textContent };
        });
        equal(aria.all.slice(0, 3), ['img', '3D model', 'A box. Use mouse, touch or arrow keys to move.']);
        check(/ArrowLeft/.test(aria.all[3]) && aria.all[4] === '0', 'keys are not announced');
        check(/^View from (lower |upper )?right$/.test(aria.status), `the view is not announced: "${aria.status}"`);
        await page.keyboard.press('Escape');
        check(await page.evaluate(() => document.activeElement !== document.querySelector('facet-viewer')), 'Escape does not leave');
        // attributes that take controls away
        await page.evaluate(async () => {
            const viewer = document.querySelector('facet-viewer');
            viewer.disableZoom = viewer.disablePan = true;
            await viewer.updateComplete;
        });
        const fixed = await read();
        await page.mouse.move(box.x + 20, box.y + 200);
        await page.mouse.wheel(0, 240);
        await drag(0, -24, 'right');
        const still = await read();
        equal([still.fov, still.target], [fixed.fov, fixed.target], 'disable-zoom, disable-pan');
    },

    async touch() {
        const client = await page.context().newCDPSession(page);
        const touch = async (type, points) => client.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
        await page.evaluate(async () => {
            await clear();
            const viewer = make({ src: 'box.gltf', 'camera-controls': '', 'touch-action': 'pan-y' });
            const space = document.createElement('div');
            space.style.height = '3000px';
            document.body.append(space);
            await event(viewer, 'load');
            await settled(viewer);
        });
        const read = () => page.evaluate(async () => {
            const viewer = document.querySelector('facet-viewer');
            await settled(viewer);
            return { ...viewer.getCameraOrbit(), fov: viewer.getFieldOfView(), target: { ...viewer.getCameraTarget() }, scroll: window.scrollY };
        });
        const { x, y } = await page.locator('facet-viewer').boundingBox();
        const start = await read();
        await touch('touchStart', [[x + 100, y + 120]]);
        for (let i = 1; i <= 5; i++) await touch('touchMove', [[x + 100 + 10 * i, y + 120]]);
        await touch('touchEnd', []);
        const turned = await read();
        check(turned.theta < start.theta - 0.5, 'a finger does not turn');
        equal(turned.scroll, 0);
        await touch('touchStart', [[x + 100, y + 120], [x + 140, y + 120]]);
        for (let i = 1; i <= 5; i++) await touch('touchMove', [[x + 100 - 8 * i, y + 120], [x + 140 + 8 * i, y + 120]]);
        await touch('touchEnd', []);
        const zoomed = await read();
        check(zoomed.fov < turned.fov - 0.5, `a pinch does not zoom: ${turned.fov} to ${zoomed.fov}`);
        await touch('touchStart', [[x + 100, y + 200]]);
        for (let i = 1; i <= 8; i++) await touch('touchMove', [[x + 100, y + 200 - 15 * i]]);
        await touch('touchEnd', []);
        const scrolled = await read();
        check(scrolled.scroll > 20, 'with pan-y the page does not scroll');
        check(Math.abs(scrolled.phi - zoomed.phi) < 1e-6, 'scrolling turned the camera');
        await client.detach();
    },

    async 'light, exposure and background'() {
        const found = await page.evaluate(async () => {
            await clear();
            const viewer = make({ src: 'box.gltf' });
            await event(viewer, 'load');
            const of = async (change) => { Object.assign(viewer, change); await viewer.updateComplete; await frames(); return image(viewer); };
            const plain = await of({});
            const bright = await of({ exposure: 2 });
            const tone = await of({ exposure: 1, toneMapping: 'aces' });
            const linear = await of({ toneMapping: 'auto' });
            await event(viewer, 'environment-change', () => { viewer.environmentImage = '#ff0000'; });
            const red = await of({});
            await event(viewer, 'environment-change', () => { viewer.skyboxImage = 'sun:45,135'; });
            const sky = await of({});
            await event(viewer, 'environment-change', () => { viewer.environmentImage = null; viewer.skyboxImage = null; });
            const again = await of({});
            const ground = await of({ shadowIntensity: 1 });
            const normal = await of({ shadowIntensity: 0, facetChannel: 'normal' });
            await event(viewer, 'environment-change', () => { viewer.facetChannel = null; viewer.environmentImage = 'blue.hdr'; });
            const blue = await of({});
            await event(viewer, 'load', async () => { viewer.src = null; await viewer.updateComplete; viewer.src = 'box.gltf'; });
            const still = await of({});
            return { plain, bright, tone, linear, red, sky, again, ground, normal, blue, still };
        });
        const light = ({ color }) => color[0] + color[1] + color[2];
        check(light(found.bright) > 1.2 * light(found.plain), 'exposure');
        check(found.tone.hash !== found.plain.hash && found.linear.hash === found.plain.hash, 'tone-mapping');
        check(found.red.color[0] > 3 * found.red.color[1], `a red environment gives ${found.red.color}`);
        equal(found.sky.covered, 1, 'a skybox is not seen');
        equal(found.again.hash, found.plain.hash, 'the light does not come back');
        check(found.ground.hash !== found.plain.hash, 'shadow-intensity');
        check(found.normal.hash !== found.plain.hash, 'facet-channel');
        check(found.blue.color[2] > 3 * found.blue.color[0], `a blue panorama gives ${found.blue.color}`);
        equal(found.still.hash, found.blue.hash, 'the light of a file is lost with the model');
    },

    async 'animations and variants'() {
        const found = await page.evaluate(async () => {
            await clear();
            const viewer = make({ src: 'box.gltf', 'camera-orbit': '90deg 90deg auto' });
            await event(viewer, 'load');
            await frames();
            const rest = await image(viewer);
            const lists = [viewer.availableAnimations, viewer.availableVariants, viewer.paused, viewer.duration];
            viewer.currentTime = 1;
            const high = await image(viewer);
            await event(viewer, 'finished', () => viewer.play({ repetitions: 2, pingpong: true }));
            const after = [viewer.paused, viewer.currentTime, viewer.log.filter(([type]) => type === 'loop').length, viewer.log.filter(([type]) => type === 'play').length];
            viewer.animationName = 'aside';
            viewer.timeScale = 2;
            await viewer.updateComplete;
            const other = viewer.duration;
            viewer.play();
            await event(viewer, 'loop');
            await event(viewer, 'pause', () => viewer.pause());
            const stopped = viewer.currentTime;
            await frames(5);
            const same = viewer.currentTime === stopped;
            viewer.currentTime = 0;
            await event(viewer, 'variant-applied', () => { viewer.variantName = 'red'; });
            const red = await image(viewer);
            await event(viewer, 'variant-applied', () => { viewer.variantName = null; });
            const gray = await image(viewer);
            return { rest, high, lists, after, other, same, red, gray };
        });
        equal(found.lists, [['rise', 'aside'], ['red', 'blue'], true, 1]);
        check(found.high.hash !== found.rest.hash, 'currentTime does not pose');
        equal(found.after, [true, 0, 1, 1], 'play({repetitions: 2, pingpong: true})');
        equal(found.other, 0.5);
        check(found.same, 'pause() does not stop');
        check(found.red.color[0] > 2 * found.red.color[1] && Math.abs(found.gray.color[0] - found.gray.color[1]) < 12, 'variant-name');
    },

    async 'hotspots and points'() {
        const found = await page.evaluate(async () => {
            await clear();
            const viewer = make({ src: 'box.gltf', 'camera-orbit': '0deg 90deg auto' });
            viewer.innerHTML = '<button slot="hotspot-front" data-position="0 1 1.5" data-normal="0 0 1" data-visibility-attribute="visible">front</button>' +
                '<button slot="hotspot-back" data-position="0m 1m -1.5m" data-normal="0m 0m -1m">back</button>';
            const seen = [];
            for (const button of viewer.children) button.addEventListener('hotspot-visibility', (e) => seen.push([button.slot, e.detail.visible]));
            await event(viewer, 'load');
            await frames(4);
            const box = viewer.getBoundingClientRect(), place = viewer.children[0].getBoundingClientRect();
            const middle = [place.x + place.width / 2 - box.x, place.y + place.height / 2 - box.y];
            const query = viewer.queryHotspot('hotspot-front'), hit = viewer.positionAndNormalFromPoint(box.x + 160, box.y + 120);
            const out = { seen, middle, visible: viewer.children[0].hasAttribute('data-visible'), query: JSON.parse(JSON.stringify(query)), hit: [`${hit.position}`, `${hit.normal}`],
                miss: viewer.positionAndNormalFromPoint(box.x + 2, box.y + 2), surface: viewer.surfaceFromPoint(box.x + 160, box.y + 120), pick: viewer.pick(160, 120) };
            viewer.updateHotspot({ name: 'hotspot-front', position: '0 2 0', normal: '0 1 0' });
            await frames(4);
            out.moved = viewer.children[0].getBoundingClientRect().y - place.y;
            out.hidden = !viewer.children[0].hasAttribute('data-visible');
            viewer.children[1].remove();
            await frames(2);
            out.none = [viewer.queryHotspot('hotspot-back'), viewer.shadowRoot.querySelectorAll('.hotspot').length];
            return out;
        });
        equal(found.seen, [['hotspot-front', true], ['hotspot-back', false], ['hotspot-front', false]]);
        near(found.middle[0], 160, 'x of a hotspot', 0.01);
        near(found.middle[1], 120, 'y of a hotspot', 0.01);
        check(found.visible && found.query.facingCamera, 'the front is visible');
        near(found.query.canvasPosition.x, 160, 'canvasPosition', 1e-3);
        check(/^\S+m 1\.?\d*m 1\.5\d*m$|^\S+m (0\.99|1)\S*m 1\.(5|49)\S*m$/.test(found.hit[0]), `hit at ${found.hit[0]}`);
        near(found.pick.normal[2], 1, 'normal', 1e-2);
        equal(found.pick.material, 0);
        equal(found.miss, null);
        equal(found.surface.split(' ').length, 6);
        check(found.moved < -20 && found.hidden, 'updateHotspot');
        equal(found.none, [null, 1]);
    },

    async 'images'() {
        const found = await page.evaluate(async () => {
            await clear();
            const viewer = make({ src: 'box.gltf' });
            await event(viewer, 'load');
            const size = async (blob) => { const bitmap = await createImageBitmap(blob); return [blob.type, bitmap.width, bitmap.height]; };
            return {
                shot: await size(await viewer.screenshot({ width: 200, height: 100 })), half: await size(await viewer.screenshot({ width: 160 })),
                jpeg: await size(await viewer.toBlob({ mimeType: 'image/jpeg', qualityArgument: 0.5 })), ideal: await size(await viewer.toBlob({ idealAspect: true })), aspect: viewer.getIdealAspect(),
            };
        });
        equal(found.shot, ['image/png', 200, 100]);
        equal(found.half, ['image/png', 160, 120]);
        equal(found.jpeg, ['image/jpeg', 320, 240]);
        near(found.ideal[1] / found.ideal[2], found.aspect, 'idealAspect', 0.02);
    },

    async 'files, options and commands'() {
        const found = await page.evaluate(async () => {
            await clear();
            const text = await (await fetch('box.gltf')).text(), gltf = JSON.parse(text);
            const bytes = Uint8Array.from(atob(gltf.buffers[0].uri.split(',')[1]), (c) => c.charCodeAt(0));
            gltf.buffers[0].uri = 'data/the%20box.bin';
            const viewer = make({}, [320, 240]);
            const list = await viewer.openFiles([{ path: 'a/box.gltf', file: new Blob([JSON.stringify(gltf)]) }, { path: 'a/data/the box.bin', file: new Blob([bytes]) },
                { path: 'b.gltf', file: new Blob([text]) }, { path: 'note.txt', file: new Blob(['x']) }]);
            await frames();
            const first = await image(viewer), path = viewer.modelPath;
            await viewer.openModel('b.gltf');
            const second = await image(viewer);
            await viewer.openModel('');
            const builtin = await image(viewer);
            const fail = async (act) => { try { await act(); return ''; } catch (error) { return error.message; } };
            const errors = [await fail(() => viewer.openModel('c.gltf')), await fail(() => viewer.openFiles([{ path: 'x.txt', file: new Blob(['x']) }])),
                await fail(() => viewer.setOption('tone-mapping', 'bogus')), await fail(() => viewer.setOption('no-such', '1'))];
            await viewer.setOption('tone-mapping', 'agx');
            await viewer.openModel('b.gltf');
            viewer.setMaterial(0, { pbrMetallicRoughness: { baseColorFactor: [0, 1, 0, 1] } });
            const green = await image(viewer);
            return { list, path, first, second, builtin, errors, green, options: viewer.options, command: viewer.command(640, 480), state: viewer.state, changes: viewer.log.filter(([type]) => type === 'facet-change').length };
        });
        equal(found.list, ['a/box.gltf', 'b.gltf']);
        equal(found.path, 'a/box.gltf');
        equal(found.first.hash, found.second.hash, 'a model of two files differs from that of one');
        check(found.builtin.hash !== found.first.hash && found.builtin.covered > 0.05, 'the built-in scene');
        check(/c\.gltf/.test(found.errors[0]) && /x\.txt/.test(found.errors[1]) && /bogus/.test(found.errors[2]) && /no-such/.test(found.errors[3]), `${found.errors}`);
        equal(found.options['tone-mapping'], 'agx');
        equal(found.path, 'a/box.gltf');
        check(/^facet render b\.gltf/.test(found.command) && /agx/.test(found.command) && /640x480/.test(found.command), found.command);
        check(Array.isArray(found.state.animations) && found.state.isPlaying === false, 'state');
        check(found.green.color[1] > 1.3 * found.green.color[0], `setMaterial gives ${found.green.color}`);
        check(found.changes >= 2, 'facet-change');
    },

    async 'addresses of blobs, and edited models as .glb'() {
        const found = await page.evaluate(async () => {
            await clear();
            const viewer = make({ src: URL.createObjectURL(await (await fetch('box.gltf')).blob()) });
            await event(viewer, 'load');
            const gray = await image(viewer);
            viewer.setMaterial(0, { pbrMetallicRoughness: { baseColorFactor: [1, 0, 0, 1] } });
            const red = await image(viewer), blob = await viewer.exportScene();
            await viewer.openFiles([{ path: 'saved.glb', file: blob }]);
            const saved = await image(viewer);
            await event(viewer, 'load', () => { viewer.src = 'models/apart.gltf'; });
            const parts = [(await image(viewer)).hash === gray.hash, viewer.modelPath, viewer.files.map(({ path }) => path)];
            return { gray, parts, red, type: blob.type, saved };
        });
        check(found.gray.covered > 0.05 && found.red.color[0] > 1.5 * found.red.color[1], `a blob is shown and edited: ${JSON.stringify(found)}`);
        equal(found.parts, [true, 'models/apart.gltf', ['models/apart.gltf', 'buffers/the box.bin']], 'a model of two folders');
        equal(found.type, 'model/gltf-binary');
        equal(found.saved.hash, found.red.hash, 'the saved model differs from the edited one');
    },

    async 'many elements share one context'() {
        requests.length = 0;
        const found = await page.evaluate(async () => {
            await clear();
            let contexts = 0;
            const { getContext } = HTMLCanvasElement.prototype;
            HTMLCanvasElement.prototype.getContext = function (type, ...rest) {
                if (/webgl/.test(type)) contexts++;
                return getContext.call(this, type, ...rest);
            };
            const viewers = [];
            for (let i = 0; i < 20; i++) {
                viewers.push(make({ src: 'box.gltf?many', 'camera-orbit': `${18 * i}deg 75deg auto` }, [60, 60]));
                viewers[i].style.display = 'inline-block';
            }
            const space = document.createElement('div');
            space.style.height = '3000px';
            document.body.append(space);
            const lazy = make({ src: 'box-lazy.gltf', loading: 'lazy', poster: 'poster.svg' }), auto = make({ src: 'box-auto.gltf' });
            const eager = make({ src: 'box-eager.gltf', loading: 'eager' }), manual = viewers[0].cloneNode();
            manual.reveal = 'manual';
            manual.src = 'box-manual.gltf';
            document.body.prepend(manual);
            await Promise.all([...viewers, eager].map((viewer) => viewer.loaded || event(viewer, 'load')));
            await frames(6);
            // what is on the screen, not a new image
            const drawn = viewers.map((viewer) => {
                const canvas = viewer.shadowRoot.querySelector('.image'), { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
                let hash = 0, covered = 0;
                for (let i = 0; i < data.length; i += 4) { hash = (hash * 31 + data[i] + 7 * data[i + 3]) | 0; covered += data[i + 3] > 128; }
                return [hash, covered / (data.length / 4)];
            });
            HTMLCanvasElement.prototype.getContext = getContext;
            const { length } = document.querySelectorAll('facet-viewer');
            const loaded = [lazy, auto, eager, manual].map((viewer) => viewer.loaded);
            manual.log = [];
            await event(manual, 'load', () => manual.dismissPoster());
            await event(lazy, 'load', () => lazy.scrollIntoView());
            return { contexts, length, loaded, drawn, late: [manual.loaded, lazy.loaded, manual.modelIsVisible] };
        });
        check(found.contexts <= 1, `${found.contexts} contexts for ${found.length} elements`);
        equal(found.loaded, [false, false, true, false], 'lazy, auto, eager, manual');
        equal(new Set(found.drawn.map(([hash]) => hash)).size > 5, true, 'the elements show the same');
        check(found.drawn.every(([, covered]) => covered > 0.05), 'an element is empty');
        check(found.late[0] && found.late[1], 'lazy and manual models come late');
        equal(requests.filter((url) => url === '/site/box.gltf').length, 1, 'equal addresses are fetched once');
    },

    async 'loss of the context'() {
        const found = await page.evaluate(async () => {
            await clear();
            const viewer = make({ src: 'box.gltf' });
            await event(viewer, 'load');
            await frames(6);
            const before = await image(viewer);
            const canvas = viewer.shadowRoot.querySelector('.stage > canvas:not(.image)');
            const loss = canvas.getContext('webgl2').getExtension('WEBGL_lose_context');
            await new Promise((resolve) => { canvas.addEventListener('webglcontextlost', () => setTimeout(resolve, 50), { once: true }); loss.loseContext(); });
            const during = await image(viewer), isShown = !viewer.shadowRoot.querySelector('.image').classList.contains('unused');
            await new Promise((resolve) => { canvas.addEventListener('webglcontextrestored', () => setTimeout(resolve, 50), { once: true }); loss.restoreContext(); });
            await frames(4);
            const after = await image(viewer);
            const error = event(viewer, 'error');
            loss.loseContext();
            const started = performance.now(), { type } = await error, waited = performance.now() - started;
            await new Promise((resolve) => { canvas.addEventListener('webglcontextrestored', () => setTimeout(resolve, 50), { once: true }); loss.restoreContext(); });
            await frames(4);
            return { before, during, isShown, after, type, waited, late: await image(viewer) };
        });
        check(found.isShown, 'the last image does not stay');
        check(Math.abs(found.during.covered - found.before.covered) < 0.01, 'the last image is gone');
        equal(found.after.hash, found.before.hash, 'the image after the loss differs');
        equal(found.type, 'webglcontextlost');
        check(found.waited > 4500, 'the error came early');
        equal(found.late.hash, found.before.hash);
    },

    async 'a module that stops is replaced'() {
        const found = await page.evaluate(async () => {
            await clear();
            const viewer = make({ src: 'box.gltf', exposure: '2', 'camera-orbit': '30deg 60deg auto' });
            await event(viewer, 'load');
            await frames(4);
            const before = await image(viewer);
            const { engine } = await import('./facet-viewer/engine.js');
            const old = engine.module;
            let message = '';
            await event(viewer, 'load', () => {
                try { engine.call((module) => module.destroy(0x7ffffff0)); } catch (error) { message = error.message; }
            });
            await frames(6);
            return { before, message, isNew: engine.module !== old, after: await image(viewer), orbit: { ...viewer.getCameraOrbit() } };
        });
        check(found.message.length > 10 && found.isNew, `"${found.message}"`);
        equal(found.after.hash, found.before.hash, 'the image of the new module differs');
        near(found.orbit.theta, Math.PI / 6, 'the orbit of the new module');
    },

    async 'reduced motion and the turntable'() {
        const run = () => page.evaluate(async () => {
            await clear();
            const viewer = make({ src: 'box.gltf', 'auto-rotate': '', 'auto-rotate-delay': '0', 'rotation-per-second': '90deg' });
            await event(viewer, 'load');
            await frames(12);
            const turned = viewer.turntableRotation, orbit = viewer.getCameraOrbit().theta;
            viewer.autoRotate = false;
            viewer.resetTurntableRotation();
            viewer.cameraOrbit = '90deg auto auto';
            await viewer.updateComplete;
            await frames(2);
            return { turned, orbit, theta: viewer.getCameraOrbit().theta, reset: viewer.turntableRotation };
        });
        const moving = await run();
        check(moving.turned > 0.01 && moving.orbit === 0 && moving.reset === 0, `the turntable is at ${moving.turned}`);
        check(moving.theta < 1.5, 'the camera jumps');
        await page.emulateMedia({ reducedMotion: 'reduce' });
        const reduced = await run();
        await page.emulateMedia({ reducedMotion: null });
        equal(reduced.turned, 0, 'the turntable turns for users who want less motion');
        near(reduced.theta, Math.PI / 2, 'the camera glides for users who want less motion');
    },

    async 'coarse while slow frames move, sharp at rest'() {
        const found = await page.evaluate(async () => {
            await clear();
            const { engine } = await import('./facet-viewer/engine.js');
            await engine.start();
            engine.module.pace = (_, isMoving) => (isMoving ? 4 : 1); // as after frames of 400 ms
            const viewer = make({ src: 'box.gltf', 'auto-rotate': '', 'auto-rotate-delay': '0' });
            const coarse = await event(viewer, 'render-scale');
            await frames(3);
            const canvas = viewer.shadowRoot.querySelector('.stage > canvas:not(.image)'), moving = [canvas.width, canvas.height];
            viewer.autoRotate = false;
            const sharp = await event(viewer, 'render-scale');
            await frames(3);
            const rest = [canvas.width, canvas.height];
            viewer.constructor.minimumRenderScale = 1;
            viewer.autoRotate = true;
            await frames(8);
            const full = [canvas.width, canvas.height];
            viewer.constructor.minimumRenderScale = 0.25;
            delete engine.module.pace;
            return { coarse, moving, sharp, rest, full };
        });
        equal([found.coarse.renderedDpr, found.moving], [0.25, [80, 60]]);
        equal([found.sharp.renderedDpr, found.rest], [1, [320, 240]]);
        equal(found.full, [320, 240], 'minimumRenderScale = 1');
    },

    async 'removal frees everything, and an idle page draws nothing'() {
        const found = await page.evaluate(async () => {
            await clear();
            const { engine } = await import('./facet-viewer/engine.js');
            const sizes = [];
            for (let i = 0; i < 6; i++) {
                const viewer = make({ src: 'box.gltf' });
                await event(viewer, 'load');
                await frames(2);
                await clear();
                sizes.push(engine.module.memorySize);
            }
            const left = engine.viewCount;
            const viewer = make({ src: 'box.gltf' });
            await event(viewer, 'load');
            await frames(10);
            let count = 0;
            viewer.addEventListener('before-render', () => count++);
            await frames(20);
            const idle = count;
            viewer.exposure = 1.5;
            await frames(4);
            const moved = document.createElement('div');
            document.body.append(moved);
            moved.append(viewer); // moving is no removal
            await new Promise((resolve) => setTimeout(resolve, 1200));
            return { sizes, left, idle, after: count, kept: viewer.loaded && (await image(viewer)).covered > 0.05 };
        });
        equal(found.left, 0, 'removed elements keep their views');
        equal(found.sizes[5], found.sizes[1], `memory grows: ${found.sizes}`);
        equal(found.idle, 0, 'an idle page draws');
        check(found.after > 0 && found.after < 5, `${found.after} frames for a change`);
        check(found.kept, 'an element that was moved lost its model');
    },
};

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
