// ocean.mjs - the ocean page and the gallery in headless Chromium; the sea beside facet ocean --renderer gl, by the command that the
// page gives. usage: ocean.mjs FACET DIST WORK
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { serve_page } from '../clients/browser.mjs';

const [facet, dist, work] = process.argv.slice(2);
const width = 160, height = 90;

const served = await serve_page('/a/folder/gallery.html', (url) => path.join(dist, url.replace('/a/folder/', '')));
const { page, messages } = served;
page.setDefaultTimeout(180000); // a loaded machine draws slowly
page.setDefaultNavigationTimeout(180000);
const address = page.url().replace('gallery.html', '');

// The page as people see it: the sea fills the stage, and its pixels are those of a picture.
async function check_page(viewport) {
    await page.setViewportSize(viewport);
    await page.goto('about:blank');
    await page.goto(`${address}ocean.html`);
    await page.evaluate(() => window.oceanPage.ready);
    await page.waitForFunction(() => window.oceanPage.ocean.samples >= 1 && window.oceanPage.frames.steps > 1); // a whole image, coarse
    const [stage, canvas] = await Promise.all(['#stage', '#view'].map((name) => page.locator(name).boundingBox()));
    assert.deepEqual(canvas, stage, 'the sea does not fill the stage');
    assert.ok(stage.width >= 0.5 * viewport.width && stage.height >= 0.3 * viewport.height, 'the stage is small');
    const colors = await page.evaluate((picture) => createImageBitmap(new Blob([Uint8Array.from(picture)])).then((bitmap) => {
        const drawing = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
        drawing.drawImage(bitmap, 0, 0);
        const pixels = new Uint32Array(drawing.getImageData(0, 0, bitmap.width, bitmap.height).data.buffer);
        return new Set(pixels).size;
    }), [...await page.screenshot({ clip: { x: stage.x, y: stage.y + stage.height / 2, width: stage.width / 2, height: 60 } })]);
    assert.ok(colors > 500, `the sea on the page has ${colors} colors`);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth), 'the page scrolls sideways');
    for (const link of await page.locator('.bar a, .bar button').all()) {
        const { x, width: wide } = await link.boundingBox();
        assert.ok(x >= 0 && x + wide <= viewport.width, `${await link.textContent()} is cut off at ${viewport.width} px`);
    }
}
await page.emulateMedia({ reducedMotion: 'reduce' });
for (const viewport of [{ width: 800, height: 240 }, { width: 390, height: 480 }]) await check_page(viewport);
assert.ok(await page.evaluate(() => document.querySelector('#progress progress').labels[0].id === 'progress-text'), 'the progress has no label');

// From here on the canvas has the size of the tests before the page's script runs.
await page.addInitScript(([w, h]) => document.addEventListener('readystatechange', () => {
    const canvas = document.getElementById('view');
    if (!canvas) return;
    canvas.style.width = `${w}px`;
    canvas.style.height = `${h}px`;
}), [width, height]);

// Opens the page; the sea rests.
async function open(hash) {
    await page.goto('about:blank');
    await page.goto(`${address}ocean.html${hash}`);
    await page.evaluate(() => window.oceanPage.ready);
    await sharp();
}

// The same by a new link in the page that is open.
async function show(hash) {
    await page.evaluate((link) => {
        document.body.dataset.sharp = '';
        location.hash = link;
    }, hash);
    await sharp();
}

const sharp = () => page.waitForFunction(([w]) => document.body.dataset.sharp === 'true' && document.getElementById('view').width === w, [width]);

// The pixels of the canvas, once all samples are drawn.
async function image() {
    await page.evaluate(() => { document.body.dataset.sharp = ''; window.oceanPage.frames.restart(); });
    await sharp();
    const url = await page.evaluate(() => document.getElementById('view').toDataURL());
    return Buffer.from(url.split(',')[1], 'base64');
}

const options = () => page.evaluate(() => window.oceanPage.ocean.options);
// The address follows changes after a moment.
const address_hash = (wanted = /./) => page.waitForFunction((text) => new RegExp(text).test(location.hash), wanted.source).then(() => page.evaluate(() => location.hash));
const error = () => page.evaluate(() => document.getElementById('error').textContent);

// Runs the page's command, with more options, and compares.
async function compare(name, ours, ...more) {
    const command = await page.evaluate(([w, h]) => window.oceanPage.ocean.command(w, h), [width, height]);
    const words = command.split(' ').map((word) => word.replaceAll('\'', ''));
    assert.deepEqual(words.slice(0, 2), ['facet', 'ocean']);
    const ours_file = path.join(work, `${name}_web.png`), theirs = path.join(work, `${name}_gl.png`);
    writeFileSync(ours_file, ours);
    execFileSync(facet, [...words.slice(1).filter((word) => !more.length || word !== '--before-after'), ...more, '-q', '-o', theirs]);
    const { metrics } = JSON.parse(execFileSync(facet, ['compare', '--json', ours_file, theirs]));
    console.log(`${name}: mean difference ${(255 * metrics.mae).toFixed(3)} of 255, flip ${metrics.flip.toFixed(4)}`);
    assert.ok(metrics.mae < 2 / 255, `${name}: differs from ${command}`);
}

try {
    await page.setViewportSize({ width: 1000, height: 500 });
    await page.emulateMedia({ reducedMotion: 'reduce' });

    // Without WebGL 2 everything below would be blank: fail, whatever the reason.
    const cleared = await page.evaluate(() => {
        const gl = document.createElement('canvas').getContext('webgl2');
        gl?.clearColor(0.2, 0.4, 0.6, 1);
        gl?.clear(gl.COLOR_BUFFER_BIT);
        const rgba = new Uint8Array(4);
        gl?.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, rgba);
        return [...rgba];
    }).catch(() => null);
    assert.deepEqual(cleared, [51, 102, 153, 255], 'the browser draws nothing by WebGL 2');

    // Skies, depths, eyes above and below, styles: as the command draws them.
    const seas = {
        breeze: '#wind=7,40&sun=22,0',
        sunset: '#sun=3,10&heading=12&time=20&turbidity=3',
        gale: '#preset=gale&sun=40,60&exposure=0.5',
        lagoon: '#preset=lagoon&sun=60,0&height-of-eye=8&fov=50',
        below: '#preset=lagoon&sun=50,0&height-of-eye=-1.2',
        legacy: '#before=A&sun=22,0',
    };
    const drawn = {};
    await open('#wind=1&samples=1');
    for (const [name, hash] of Object.entries(seas)) {
        await show(`${hash}&samples=2`);
        assert.equal(await error(), '', name);
        drawn[name] = await image();
        await compare(name, drawn[name]);
    }
    assert.equal(new Set(Object.values(drawn).map(String)).size, 6, 'seas look the same');

    // The first image: at rest where motion is to be reduced, divided; each side as the command draws it.
    await open('');
    assert.equal(await page.evaluate(() => window.oceanPage.isPlaying), false, 'plays although motion is to be reduced');
    assert.ok(!(await page.locator('#divider').isHidden()));
    await page.locator('#divider').focus();
    await page.keyboard.press('Home');
    await compare('now', await image(), '--stage', '5');
    await page.keyboard.press('End');
    await compare('before', await image(), '--before', 'B');
    for (let i = 0; i < 7; i++) await page.keyboard.press('PageDown');
    await page.evaluate(() => window.oceanPage.set({ samples: '1' })); // enough to see what changes an image

    // The border: by the keyboard and by the pointer.
    const at = () => page.locator('#divider').getAttribute('aria-valuenow').then(Number);
    const first = await image();
    await page.locator('#divider').focus();
    await page.keyboard.press('Shift+ArrowRight');
    assert.equal(await at(), 40);
    assert.notDeepEqual(await image(), first, 'the border did not move the image');
    const stage = await page.locator('#stage').boundingBox();
    await page.mouse.move(stage.x + 0.4 * stage.width, stage.y + 200);
    await page.mouse.down();
    await page.mouse.move(stage.x + 0.7 * stage.width, stage.y + 210, { steps: 2 });
    await page.mouse.up();
    assert.equal(await at(), 70, 'the border did not follow the pointer');
    await address_hash(/before-after&.*divider=0\.7/);
    await page.getByLabel('Compare with the legacy look').uncheck();
    assert.ok(await page.locator('#divider').isHidden());

    // Fields: by the keyboard, by the pointer, by a number, by a choice.
    await page.getByLabel('Wind speed', { exact: true }).focus();
    await page.keyboard.press('ArrowRight');
    assert.equal((await options()).wind, '8.5,90');
    const windy = await image();
    const slider = page.getByLabel('Sun elevation', { exact: true });
    await slider.scrollIntoViewIfNeeded();
    const track = await slider.boundingBox();
    await page.mouse.click(track.x + track.width / 2, track.y + track.height / 2);
    assert.match((await options()).sun, /^(39|40|41)/);
    assert.notDeepEqual(await image(), windy, 'the sun did not change the image');
    await page.getByLabel('Chlorophyll, milligrams per cubic meter').fill('5');
    await page.keyboard.press('Enter');
    assert.equal((await options()).chl, '5');
    await page.getByLabel('Water type').selectOption('3C');
    assert.deepEqual([(await options()).water, (await options()).chl], ['3C', undefined]);
    await page.getByRole('button', { name: 'Lagoon' }).click();
    assert.deepEqual([(await options()).preset, (await options()).water, (await options()).wind], ['lagoon', undefined, undefined]);
    assert.equal(await page.getByRole('button', { name: 'Lagoon' }).getAttribute('aria-pressed'), 'true');

    // The camera: by the pointer, the wheel and keys.
    const heading = () => page.evaluate(() => { const { azimuth, elevation, height: eye, fov } = window.oceanPage.ocean.state; return [azimuth, elevation, eye, fov]; });
    const before = await heading();
    const box = await page.locator('#view').boundingBox();
    await page.mouse.move(box.x + 80, box.y + 60);
    await page.mouse.down();
    await page.mouse.move(box.x + 60, box.y + 40, { steps: 2 });
    await page.mouse.up();
    await page.mouse.wheel(0, -100);
    await page.locator('#view').focus();
    await page.keyboard.press('PageUp');
    const after = await heading();
    before.forEach((value, i) => assert.ok(Math.abs(value - after[i]) > 0.05, `the camera's value ${i} stays ${value}`));
    assert.equal(await error(), '');

    // At rest nothing is drawn, nor in a hidden tab; a change is answered by a coarse image first, one step at a time.
    const steps = () => page.evaluate(() => window.oceanPage.frames.steps);
    await sharp();
    const rested = await page.evaluate(async () => {
        const { frames } = window.oceanPage, count = frames.steps;
        let asked = 0;
        const request = window.requestAnimationFrame;
        window.requestAnimationFrame = (f) => { asked++; return request.call(window, f); };
        await new Promise((resolve) => setTimeout(resolve, 500));
        window.requestAnimationFrame = request;
        return [frames.steps - count, asked];
    });
    assert.deepEqual(rested, [0, 0], 'a sea at rest is drawn');
    const hide = (is) => page.evaluate((hidden) => {
        Object.defineProperty(document, 'hidden', { value: hidden, configurable: true });
        document.dispatchEvent(new Event('visibilitychange'));
    }, is);
    await hide(true);
    const still = await steps();
    await page.evaluate(() => { document.body.dataset.sharp = ''; window.oceanPage.set({ wind: '9,0' }); });
    await page.waitForTimeout(300);
    assert.equal(await steps(), still, 'a hidden sea is drawn');
    await hide(false);
    await sharp();
    const queue = await page.evaluate(async () => {
        const gl = document.getElementById('view').getContext('webgl2'), sizes = [];
        const fences = new Set(), { fenceSync, deleteSync } = gl;
        let most = 0;
        gl.fenceSync = function (...all) { const made = fenceSync.apply(gl, all); fences.add(made); most = Math.max(most, fences.size); sizes.push(gl.drawingBufferWidth); return made; };
        gl.deleteSync = function (made) { fences.delete(made); deleteSync.call(gl, made); };
        document.body.dataset.sharp = '';
        window.oceanPage.set({ wind: '10,0' });
        while (document.body.dataset.sharp !== 'true') await new Promise((resolve) => setTimeout(resolve, 20));
        delete gl.fenceSync;
        delete gl.deleteSync;
        return { most, sizes };
    });
    assert.equal(queue.most, 1, 'steps are queued');
    assert.ok(queue.sizes.every((size, i) => i === 0 || size >= queue.sizes[i - 1] || size < 160) && queue.sizes.at(-1) === width, `sizes ${queue.sizes}`);
    await page.evaluate(() => window.oceanPage.set({ wind: '8.5,90' }));

    // The link gives the same image.
    await page.waitForTimeout(400); // the address follows
    const link = await address_hash(), shown = await image();
    await open(link);
    assert.deepEqual(await image(), shown, `the image of the link differs: ${link}`);

    // What cannot be set gets the command's sentence, and the page goes on.
    await show('#wind=99&chl=1&samples=1');
    assert.match(await error(), /--wind: "99".*0 to 40 m\/s/);
    assert.deepEqual(await options(), { chl: '1', samples: '1' });

    // A lost context comes back with the same image.
    const whole = await image();
    await page.evaluate(() => new Promise((resolve) => {
        const canvas = document.getElementById('view'), loss = canvas.getContext('webgl2').getExtension('WEBGL_lose_context');
        canvas.addEventListener('webglcontextlost', () => setTimeout(() => loss.restoreContext(), 0), { once: true });
        canvas.addEventListener('webglcontextrestored', () => setTimeout(resolve, 0), { once: true });
        loss.loseContext();
    }));
    assert.deepEqual(await image(), whole, 'the image after the loss of the context differs');

    // Space plays and pauses.
    await page.locator('#view').focus();
    await page.keyboard.press('Space');
    await page.waitForFunction(() => window.oceanPage.ocean.state.time > 0.2);
    await page.keyboard.press('Space');
    assert.equal(await page.evaluate(() => window.oceanPage.isPlaying), false);
    await sharp();
    const time = await page.evaluate(() => window.oceanPage.ocean.state.time);
    await address_hash(new RegExp(`time=${String(time).replace('.', '\\.')}`));
    assert.notDeepEqual(await image(), whole, 'the sea did not move');
    await compare('later', await image());

    // A saved image has the pixels of the command.
    const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Save image' }).click()]);
    await compare('saved', readFileSync(await download.path()));

    const said = messages.filter((text) => !/GPU stall|WebGL: CONTEXT_LOST/.test(text));
    assert.deepEqual(said, [], 'the page said something in the console');

    // The gallery: its pictures are there, and what its cards open; seas take all of their options.
    await page.goto(`${address}gallery.html`);
    const cards = await page.evaluate(() => [...document.querySelectorAll('a.card')].map((card) => ({ href: card.getAttribute('href'), picture: card.querySelector('img').getAttribute('src') })));
    assert.ok(cards.length > 12);
    for (const { href, picture } of cards) {
        const [file, hash = ''] = href.split('#'), model = new URLSearchParams(hash).get('model');
        for (const name of [file, picture, model].filter(Boolean)) assert.ok(existsSync(path.join(dist, name)), `${href}: there is no ${name}`);
        if (model) execFileSync(facet, ['inspect', '-q', path.join(dist, model)], { stdio: 'pipe' });
    }
    await open('#wind=1&samples=1');
    for (const { href } of cards.filter((card) => card.href.startsWith('ocean.html'))) {
        await page.evaluate((hash) => { location.hash = hash; }, href.split('#')[1]);
        await page.waitForFunction(([name]) => window.oceanPage.ocean.options[name] !== undefined, [href.split('#')[1].split('=')[0]]);
        assert.equal(await error(), '', href);
    }
    console.log('ocean: as facet ocean --renderer gl');
} finally {
    await served.close();
}
