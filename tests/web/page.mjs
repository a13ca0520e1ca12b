// page.mjs - the viewer's page in headless Chromium as people use it: drop, pick, every control by mouse and keyboard, links, commands,
// accessibility. usage: page.mjs FACET DIST WORK
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import { serve_page } from '../clients/browser.mjs';
import { write_models } from './page_model.mjs';

const [facet, dist, work] = process.argv.slice(2);
const models = write_models(facet, work);
const axe = readFileSync(createRequire(new URL('../clients/', import.meta.url)).resolve('axe-core/axe.min.js'), 'utf8');
const FOLDER = '/a/folder/';
const served = await serve_page(`${FOLDER}index.html`, (url) => url.startsWith(`${FOLDER}models/`) ? path.join(work, url.slice(FOLDER.length + 7))
    : path.join(dist, url.slice(FOLDER.length)));
const { page, messages } = served;
// A small image on the left of the stage: it is drawn after every change.
await page.addInitScript(() => document.addEventListener('DOMContentLoaded', () => {
    const viewer = document.querySelector('facet-viewer');
    if (viewer) Object.assign(viewer.style, { width: '160px', height: '120px' });
}));
await page.reload();
messages.length = 0; // of the module whose loading that has stopped
const requests = [];
page.on('request', (request) => requests.push(request.url()));

// ---- what the tests share ----

const viewer_does = (use, argument) => page.evaluate(([text, value]) => {
    const viewer = document.querySelector('facet-viewer');
    const uses = {
        options: () => viewer.options,
        state: () => { const { isPlaying, time } = viewer.state; return { isPlaying, time, camera: viewer.getCameraOrbit().toString() }; },
        loaded: () => viewer.loaded && viewer.modelPath,
        reset: () => Promise.all(Object.keys(viewer.options).map((name) => viewer.setOption(name, name === 'background' ? 'transparent' : null))),
    };
    return uses[text](value);
}, [use, argument]);
const options = () => viewer_does('options');

// The image as a PNG, which is equal where the pixels are.
const image = (width = 80, height = 60) => page.evaluate(async ([w, h]) => {
    const blob = await document.querySelector('facet-viewer').screenshot({ width: w, height: h });
    return [...new Uint8Array(await blob.arrayBuffer())];
}, [width, height]).then((bytes) => Buffer.from(bytes).toString('base64'));

const settle = () => page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(resolve, 0)))));
const until = async (what, holds) => {
    for (let i = 0; i < 300; i++) {
        if (await holds()) return;
        await page.waitForTimeout(25);
    }
    assert.fail(`waited in vain for ${what}; options ${JSON.stringify(await options())}; messages: ${await sentences()}`);
};
const sentences = () => page.locator('#messages .message p').allTextContents();
const close_messages = async () => {
    const ends = page.locator('#messages [aria-label="Close this message"]');
    while (await ends.count()) await ends.first().click();
};
const shown = (name) => until(`${name} to be shown`, async () => ((await viewer_does('loaded')) || '').endsWith(name) && (await page.title()).includes(name));
const tab = async (name) => {
    if (!await page.locator(`#tab-${name}-panel`).isVisible()) await page.locator(`#tab-${name}`).click();
    await page.locator(`#tab-${name}-panel`).waitFor();
    for (const summary of (await page.locator(`#tab-${name}-panel details:not([open]) > summary`).all()).reverse()) await summary.click();
};

// Files and folders as they are dropped from the desktop.
const drop = async (...files) => {
    const client = await page.context().newCDPSession(page);
    const data = { items: [], files, dragOperationsMask: 1 };
    for (const type of ['dragEnter', 'dragOver', 'drop']) await client.send('Input.dispatchDragEvent', { type, x: 200, y: 200, data });
    await client.detach();
};

const steps = [];
const step = (name, run) => steps.push([name, run]);

// ---- opening ----

step('opens with the built-in scene', async () => {
    await until('the first image', () => viewer_does('loaded').then((path_) => path_ === ''));
    const client = await page.context().newCDPSession(page);
    const { data } = await client.send('Page.captureScreenshot', { clip: { x: 0, y: 60, width: 400, height: 300, scale: 1 } });
    assert.ok(Buffer.from(data, 'base64').length > 20000, 'the stage is blank');
    assert.match(await page.locator('#model-name').textContent(), /Built-in/);
});

step('drops a model', async () => {
    const before = await image();
    await drop(models.glb);
    await shown('spheres.glb');
    assert.notEqual(await image(), before);
    assert.deepEqual(await sentences(), []);
});

step('drops a folder with several models and chooses one', async () => {
    await drop(models.parts);
    await until('the list', async () => await page.locator('#model-name select').count() === 1);
    const list = page.locator('#model-name select');
    assert.deepEqual(await list.locator('option').allTextContents(), ['parts/box.obj', 'parts/spheres.gltf']);
    const box = await image();
    await list.selectOption('parts/spheres.gltf');
    await until('the spheres', () => viewer_does('loaded').then((at) => at === 'parts/spheres.gltf'));
    assert.notEqual(await image(), box);
    assert.deepEqual(await sentences(), [], 'a model of several files is complete');
});

step('reads changed files again and keeps the view', async () => {
    await page.locator('#viewer [part=input]').press('ArrowLeft');
    const file = path.join(models.parts, 'spheres.gltf'), text = readFileSync(file, 'utf8');
    await settle();
    const before = await image();
    const { orbit } = await options();
    assert.ok(orbit, 'the arrow turned the camera');
    writeFileSync(file, text.replace('"roughnessFactor":0.8', '"roughnessFactor":0.1'));
    await page.getByRole('button', { name: 'Read the files again' }).click();
    await until('the new image', async () => await image() !== before);
    await until('the same view', async () => (await options()).orbit === orbit);
    writeFileSync(file, text);
});

step('picks files and a folder', async () => {
    await page.locator('#folder-input').setInputFiles(models.parts);
    await until('the folder', async () => await page.locator('#model-name select').count() === 1);
    await page.locator('#file-input').setInputFiles(models.glb);
    await shown('spheres.glb');
});

step('a dropped panorama becomes the light', async () => {
    const before = await image();
    await drop(models.light);
    await until('the light', async () => await image() !== before);
    await tab('look');
    const environment = page.getByLabel('Environment', { exact: true });
    assert.match(await environment.locator('option:checked').textContent(), /blue\.hdr/);
    await environment.selectOption('neutral');
    await until('the studio', async () => await image() === before);
});

step('play starts the first animation, and choosing one shows it', async () => {
    await drop(models.glb);
    await shown('spheres.glb');
    const list = page.locator('.motion select').first();
    for (const name of await list.locator('option').allTextContents()) assert.doesNotMatch(name, /object/, 'the names of animations');
    await page.getByRole('button', { name: 'Play' }).click();
    await until('time to pass', async () => (await viewer_does('state')).time > 0);
    await until('its name', async () => await list.inputValue() === '0');
    await page.getByRole('button', { name: 'Pause' }).click();
    await list.selectOption('');
    await until('the model at rest', async () => (await options()).animation === undefined);
    await list.selectOption('0');
    await until('the animation', async () => (await options()).animation === '0');
    await list.selectOption('');
});

step('texts of a view say what they cannot hold', async () => {
    await page.evaluate(() => { location.hash = '#file=spheres.glb&exposure=1&bloom=0.1&variant=0&material.1.roughnessFactor=0.2'; });
    await until('the edit', async () => (await options()).bloom === '0.1');
    await tab('share');
    const html = await page.getByLabel('HTML of this view').inputValue();
    assert.match(html, /src="spheres-edited\.glb"[^]*exposure="2"/);
    assert.doesNotMatch(html, /variant-name="0"/);
    assert.match(await page.getByLabel('facet command of this view').inputValue(), /spheres-edited\.glb/);
    assert.match(await page.locator('#tab-share-panel').textContent(), /save it as spheres-edited\.glb.*No attribute sets bloom/);
    await page.evaluate(() => { location.hash = '#file=spheres.glb'; });
});

step('materials follow the variant', async () => {
    await tab('material');
    const list = page.locator('#tab-material-panel select').first(), unused = page.getByText('Nothing that is shown has this material');
    await list.selectOption({ label: 'Painted' });
    assert.ok(!await unused.isVisible());
    await tab('scene');
    await page.getByLabel('Variant', { exact: true }).selectOption({ label: 'Golden' });
    await until('the material of the variant', async () => await list.locator('option:checked').textContent() === 'Gold');
    await tab('material');
    await list.selectOption({ label: 'Painted' });
    assert.ok(await unused.isVisible(), 'a material that is not drawn says so');
    await page.evaluate(() => { location.hash = '#file=spheres.glb&exposure=0'; });
});

step('what is missing, and models of other kinds', async () => {
    await drop(path.join(models.parts, 'spheres.gltf'));
    await until('a sentence about the folder', async () => (await sentences()).some((text) => /whole folder/.test(text)));
    const other = path.join(work, 'model.fbx');
    writeFileSync(other, 'Kaydara');
    await drop(other);
    await until('a sentence about .fbx', async () => (await sentences()).some((text) => /model\.fbx: facet reads glTF.*\.glb/.test(text)));
    await close_messages();
});

step('a link to a file waits for it', async () => {
    await page.evaluate(() => { location.hash = '#file=other.glb&variant=1'; });
    await until('the note', async () => (await sentences()).some((text) => /Drop that file/.test(text)));
    assert.equal((await sentences()).length, 1);
    await page.evaluate(() => { location.hash = '#model='; });
    await until('a sentence', async () => (await sentences()).some((text) => /names no model/.test(text)));
    assert.ok(!(await sentences()).some((text) => /Drop that file/.test(text)), 'the note of the link before stays');
    await close_messages();
});

// ---- the panels ----

// Every field of the tab "Look" changes the options by the keyboard, and the first one of each kind by the mouse.
const by_mouse = new Set();

async function change_by_mouse(field, kind) {
    if (kind === 'check') return field.locator('input').click();
    if (kind === 'choice') return field.locator('select').selectOption({ index: 1 });
    if (kind === 'color') return field.locator('input').fill('#336699');
    if (kind === 'line') return field.locator('input').fill('20,60,4').then(() => field.locator('input').press('Enter'));
    const { x, y, width, height } = await field.locator('input[type=range]').boundingBox();
    return page.mouse.click(x + 0.8 * width, y + height / 2);
}

async function change_by_key(field, kind) {
    const input = field.locator('input, select').first();
    await input.focus();
    if (kind === 'check') return page.keyboard.press('Space');
    if (kind === 'choice') return page.keyboard.press(await input.evaluate((select) => select.selectedIndex) ? 'ArrowUp' : 'ArrowDown');
    if (kind === 'color') return input.fill('#ffffff');
    if (kind === 'line') {
        await input.fill('0.1,0.5,0.7');
        return page.keyboard.press('Enter');
    }
    return page.keyboard.press('ArrowRight');
}

async function exercise(field) {
    const label = await field.locator('label, .label').first().textContent();
    const kind = (await field.getAttribute('class')).split(' ')[1];
    const ways = by_mouse.has(kind) ? [['keyboard', change_by_key]] : [['mouse', change_by_mouse], ['keyboard', change_by_key]];
    by_mouse.add(kind);
    await field.scrollIntoViewIfNeeded();
    for (const [how, change] of ways) {
        const before = JSON.stringify(await options());
        await change(field, kind);
        await until(`${label} by ${how} to change an option`, async () => JSON.stringify(await options()) !== before);
    }
    await viewer_does('reset');
    return label;
}

step('every control of the look, by mouse and keyboard', async () => {
    await tab('look');
    const fields = page.locator('#tab-look-panel .field:visible');
    const labels = [];
    for (const label of await fields.locator('label').allTextContents())
        labels.push(await exercise(page.locator('#tab-look-panel .field').filter({ has: page.getByText(label, { exact: true }) }).first()));
    for (const label of ['Environment', 'Rotation', 'Intensity', 'Exposure', 'Tone mapping', 'Background', 'Bloom', 'Shadow on the ground', 'Camera', 'Field of view', 'Show',
        'Compare', 'Energy', 'Specular lobe', 'Blending', 'Shading']) assert.ok(labels.includes(label), `there is no control "${label}"`);
    await until('the default view', async () => JSON.stringify(await options()) === '{"background":"transparent"}');
});

step('a control changes the image, and back', async () => {
    await tab('look');
    const plain = await image();
    const tone = page.getByLabel('Tone mapping', { exact: true });
    await tone.selectOption('agx');
    await until('AgX', async () => await image() !== plain);
    await tone.selectOption('neutral');
    await until('the neutral image', async () => await image() === plain);
    const camera = page.getByLabel('Camera', { exact: true });
    await camera.selectOption({ label: 'Hero' });
    await until('the camera of the file', async () => await image() !== plain);
    await camera.selectOption('');
    await until('the free camera', async () => await image() === plain);
    assert.deepEqual(await sentences(), []);
});

step('the divider moves by pointer and by key', async () => {
    await tab('look');
    const { x: left, y: top, width: across, height: down } = await page.locator('#viewer').boundingBox();
    const canvas = async () => (await page.screenshot({ clip: { x: left, y: top + 30, width: across, height: down - 30 } })).toString('base64');
    const plain = await canvas();
    await page.getByLabel('Compare', { exact: true }).selectOption('tone-mapping');
    const handle = page.locator('#divider');
    await handle.waitFor();
    await until('two sides', async () => await canvas() !== plain);
    await handle.press('Home');
    await until('the border at the left', async () => (await options()).divider === '0');
    const { x, y, width } = await handle.boundingBox();
    await page.mouse.move(x + width - 2, y + 200);
    await page.mouse.down();
    await page.mouse.move(x + width + 300, y + 200, { steps: 3 });
    await page.mouse.up();
    await until('the border under the pointer', async () => Number((await options()).divider) > 0.4);
    assert.ok(Number(await handle.getAttribute('aria-valuenow')) > 40);
    await page.keyboard.press('0');
    await until('one side', async () => await canvas() === plain);
});

step('the pointer and the keys move the camera', async () => {
    const moved = async (what, act) => {
        const { camera } = await viewer_does('state');
        await act();
        await until(`${what} to move the camera`, async () => (await viewer_does('state')).camera !== camera);
    };
    await moved('a drag', async () => {
        await page.mouse.move(60, 100);
        await page.mouse.down();
        await page.mouse.move(100, 110, { steps: 3 });
        await page.mouse.up();
    });
    await moved('the wheel', () => page.mouse.wheel(0, -200));
    await moved('an arrow', () => page.locator('#viewer [part=input]').press('ArrowLeft'));
    await page.getByRole('button', { name: 'Show the whole model' }).click();
    await until('the whole model', async () => JSON.stringify(await options()) === '{"background":"transparent"}');
});

step('two fingers move nearer and sideways, one turns', async () => {
    const client = await page.context().newCDPSession(page);
    const touch = async (points) => client.send('Input.dispatchTouchEvent', { type: points.length ? 'touchMove' : 'touchEnd', touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
    const gesture = async (at) => {
        const points = at(0).map(([x, y], id) => ({ x, y, id }));
        for (let count = 1; count <= points.length; count++) await client.send('Input.dispatchTouchEvent', { type: 'touchStart', touchPoints: points.slice(0, count) });
        for (let i = 1; i <= 4; i++) await touch(at(i));
        await touch([]);
        await settle();
        return page.evaluate(() => {
            const viewer = document.querySelector('facet-viewer'), { theta, phi, radius } = viewer.getCameraOrbit(), { x } = viewer.getCameraTarget();
            return { theta, phi, radius, x, scale: visualViewport.scale };
        });
    };
    const rest = await gesture(() => [[10, 110]]);
    const near = await gesture((i) => [[60 - 5 * i, 100], [90 + 5 * i, 100]]);
    assert.ok(near.radius < 0.9 * rest.radius && near.theta === rest.theta && near.scale === 1, `spread fingers: ${JSON.stringify([rest, near])}`);
    const aside = await gesture((i) => [[50 + 6 * i, 100], [80 + 6 * i, 100]]);
    assert.ok(Math.abs(aside.x - near.x) > 1e-3 && aside.theta === rest.theta, `fingers side by side: ${JSON.stringify([near, aside])}`);
    const turned = await gesture((i) => [[50 + 6 * i, 100]]);
    assert.ok(Math.abs(turned.theta - aside.theta) > 0.05, `one finger: ${JSON.stringify([aside, turned])}`);
    await page.getByRole('button', { name: 'Show the whole model' }).click();
    await until('the whole model', async () => JSON.stringify(await options()) === '{"background":"transparent"}');
});

step('a page from the disk says what it needs', async () => {
    const other = await page.context().browser().newPage();
    for (const name of ['index', 'explorer', 'side-by-side']) {
        await other.goto(pathToFileURL(path.join(dist, `${name}.html`)).href);
        await other.getByText('This page needs a web server').waitFor();
    }
    await other.close();
});

step('animation: play, pause, time line, speed', async () => {
    const rest = await image();
    const line = page.getByRole('slider', { name: 'Time' });
    await line.fill('1');
    await until('the pose', async () => await image() !== rest);
    assert.match(await page.locator('.motion output').textContent(), /^1\.00 s \/ 2\.00 s$/);
    await page.getByRole('button', { name: 'Play' }).click();
    const { time } = await viewer_does('state');
    await until('time to pass', async () => (await viewer_does('state')).time !== time);
    await page.locator('body').press('Space');
    await until('a pause', async () => !(await viewer_does('state')).isPlaying);
    await page.getByLabel('Speed', { exact: true }).selectOption('2');
    await line.focus();
    const at = (await viewer_does('state')).time;
    await page.keyboard.press('ArrowRight');
    await until('a step', async () => (await viewer_does('state')).time !== at);
    await line.fill('0');
});

step('variants, the tree and its keys', async () => {
    await tab('scene');
    const plain = await image();
    await page.getByLabel('Variant', { exact: true }).selectOption({ index: 1 });
    await until('the variant', async () => await image() !== plain);
    await page.getByLabel('Variant', { exact: true }).selectOption({ index: 0 });
    const focused = () => page.evaluate(() => document.activeElement.textContent);
    await page.locator('[role=tree] [tabindex="0"]').focus();
    await page.keyboard.press('ArrowDown');
    assert.equal(await focused(), 'Ball, node');
    await page.keyboard.press('ArrowRight');
    await page.keyboard.press('ArrowRight');
    assert.equal(await focused(), 'Painted, mesh');
    await page.keyboard.press('ArrowLeft');
    await page.keyboard.press('ArrowLeft');
    await page.keyboard.press('ArrowLeft');
    assert.equal(await focused(), 'Ball, node');
    await page.keyboard.press('s');
    assert.equal(await focused(), 'Screen, node');
    await page.keyboard.press('Enter');
    assert.match(await page.locator('.properties').textContent(), /Screen \(node\).*Scale0\.8, 0\.8, 0\.8/);
    await page.keyboard.press('End');
    assert.equal(await focused(), 'Images, 1');
    assert.match(await page.locator('#tab-scene-panel').textContent(), /Triangles drawn[\d,]+/);
});

// ---- materials ----

step('a click selects the material, edits change the image and the saved file', async () => {
    const { x, y, width, height } = await page.locator('#viewer').boundingBox();
    await page.mouse.click(x + 0.68 * width, y + 0.55 * height);
    const chosen = page.locator('#tab-material-panel select').first().locator('option:checked');
    await until('the gold', async () => await page.locator('#tab-material-panel').isVisible() && await chosen.textContent() === 'Gold');
    const plain = await image();
    const number = page.locator('[data-parameter=roughnessFactor] input[type=number]');
    await number.fill('0.15');
    await number.press('Enter');
    await until('the roughness', async () => await image() !== plain);
    const smooth = await image();
    await page.locator('[data-parameter=baseColorFactor] input[type=color]').fill('#00ff00');
    await until('the color', async () => await image() !== smooth);
    const [download] = await Promise.all([page.waitForEvent('download', { timeout: 60000 }), page.getByRole('button', { name: 'Save edited .glb' }).click()]);
    const file = path.join(work, 'edited.glb');
    await download.saveAs(file);
    const { materials } = JSON.parse(execFileSync(facet, ['inspect', '--json', file]));
    assert.ok(Math.abs(materials[1].roughness - 0.15) < 1e-6);
    assert.deepEqual(materials[1].base_color, [0, 1, 0, 1]);
    await page.getByRole('button', { name: 'Reset', exact: true }).click();
    await until('the material of the file', async () => await image() === plain);
    await page.getByLabel('Add a layer').selectOption('KHR_materials_iridescence');
    await until('the new layer', async () => await image() !== plain);
    await page.getByRole('button', { name: 'Reset', exact: true }).click();
    await until('no layer', async () => await image() === plain);
});

step('textures show their image, sampler and place', async () => {
    await tab('material');
    await page.locator('#tab-material-panel select').first().selectOption({ label: 'Painted' });
    const texture = page.locator('#tab-material-panel .texture').first();
    assert.match(await texture.textContent(), /Base color texture.*16 × 16.*png.*set 0.*clamped, mirrored/);
    await until('the thumbnail', () => texture.locator('img').evaluate((picture) => picture.naturalWidth === 16));
});

// ---- taking the view elsewhere ----

const link_of = async () => {
    await tab('share');
    await settle();
    return page.getByRole('textbox', { name: 'Link to this view' }).inputValue();
};

step('a link gives the same view again', async () => {
    await page.goto('about:blank');
    await page.goto(`${page_address}#model=models/spheres.glb&orbit=30deg,75deg,105%&exposure=0.5&tone=agx&env=sun:45,135&material.1.roughnessFactor=0.2`);
    await shown('spheres.glb');
    await until('the view', async () => (await options()).exposure === '0.5' && (await options())['tone-mapping'] === 'agx');
    await page.locator('#viewer [part=input]').press('ArrowUp');
    await page.locator('#viewer [part=input]').press('Shift+ArrowRight');
    await page.evaluate(() => document.querySelector('facet-viewer').jumpCameraToGoal());
    await settle();
    const link = await link_of();
    assert.match(link, /#model=models\/spheres\.glb&.*env=sun:45,135.*material\.1\.roughnessFactor=0\.2/);
    const before = await image(200, 150);
    await page.goto('about:blank');
    await page.goto(link);
    await until('the same pixels', async () => await viewer_does('loaded').catch(() => '') === 'spheres.glb' && await image(200, 150) === before);
});

step('the copied command renders the same image', async () => {
    await tab('share');
    await page.evaluate(() => { location.hash = '#model=models/spheres.glb&orbit=30deg,75deg,105%25&exposure=0.5&env=sun:45,135&background=env'; });
    await until('the view', async () => (await options()).background === 'env');
    await page.getByLabel('Size', { exact: true }).selectOption('other');
    await page.getByLabel('Pixels').fill('320x240');
    await page.getByLabel('Pixels').press('Enter');
    const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Save PNG' }).click()]);
    assert.equal(download.suggestedFilename(), 'spheres-320x240.png');
    await download.saveAs(path.join(work, 'page.png'));
    const command = await page.getByLabel('facet command of this view').inputValue();
    assert.match(command, /^facet render .*320x240/);
    const elsewhere = path.join(work, 'command');
    mkdirSync(elsewhere, { recursive: true });
    execFileSync('sh', ['-c', `facet() { "$FACET" "$@" -q -o out.png; }\n${command.replaceAll(/(\S*\/)?spheres\.glb/g, '../spheres.glb')}`],
        { cwd: elsewhere, env: { ...process.env, FACET: path.resolve(facet) } });
    const { metrics } = JSON.parse(execFileSync(facet, ['compare', '--json', path.join(work, 'page.png'), path.join(elsewhere, 'out.png')]));
    console.log(`the copied command differs by ${(255 * metrics.mae).toFixed(3)} of 255`);
    assert.ok(metrics.mae < 2 / 255);
    assert.match(await page.getByLabel('HTML of this view').inputValue(), /<facet-viewer\n {2}src="models\/spheres\.glb"[^]*environment-image="sun:45,135"/);
});

step('bad links and models of other servers get a sentence', async () => {
    for (const [hash, sentence] of [['#exposure=bright', /exposure.*bright/], ['#model=https://example.com/a.glb', /not on this server/], ['#tone-maping=agx', /tone-maping/],
        ['#orbit', /"orbit" cannot be read/], ['#model=models/none.glb', /none\.glb/], ['#file=other.glb', /Drop that file/]]) {
        await close_messages();
        await page.evaluate((text) => { location.hash = text; }, hash);
        await until(`a sentence about ${hash}`, async () => (await sentences()).some((text) => sentence.test(text)));
    }
    await close_messages();
    // what the browser says of models/none.glb
    messages.splice(0, messages.length, ...messages.filter((text) => !/status of 404/.test(text)));
});

step('a model that cannot be read: its sentence, and the page lives on', async () => {
    await drop(models.broken);
    await until('the sentence', async () => (await sentences()).some((text) => /broken\.glb/.test(text)));
    assert.equal(await page.locator('#messages [role=alert]').count(), 1);
    await drop(path.join(models.parts, 'data', 'spheres.bin'));
    await until('a sentence about the kind of file', async () => (await sentences()).some((text) => /spheres\.bin/.test(text)));
    await drop(models.glb);
    await shown('spheres.glb');
    await close_messages();
    assert.deepEqual(await sentences(), []);
});

// ---- for everyone ----

async function check_axe(name) {
    await page.evaluate(axe);
    const violations = await page.evaluate(async () => (await window.axe.run(document, { resultTypes: ['violations'] })).violations
        .map(({ id, nodes }) => `${id}: ${nodes.map((node) => `${node.html.slice(0, 120)} ${node.failureSummary}`).join('\n  ')}`));
    assert.deepEqual(violations, [], `accessibility, ${name}`);
}

step('accessibility in light and dark', async () => {
    for (const scheme of ['light', 'dark']) {
        await page.emulateMedia({ colorScheme: scheme });
        for (const name of ['look', 'scene', 'material', 'share']) {
            await tab(name);
            await settle();
            await check_axe(`${scheme}, ${name}`);
        }
    }
    await page.locator('body').press('h');
    await check_axe('help');
    await page.keyboard.press('Escape');
    await page.emulateMedia({ colorScheme: null });
});

step('tabs by keyboard', async () => {
    await page.locator('#tab-look').click();
    await page.keyboard.press('ArrowRight');
    assert.equal(await page.locator('[role=tab][aria-selected=true]').textContent(), 'Scene');
    await page.keyboard.press('End');
    assert.ok(await page.locator('#tab-share-panel').isVisible());
});

step('narrow screens', async () => {
    await page.setViewportSize({ width: 390, height: 844 });
    await settle();
    for (const name of ['scene', 'material', 'share', 'look']) {
        await tab(name);
        const wide = await page.evaluate(() => [document.documentElement, ...document.querySelectorAll('.panel-body, .stage')]
            .filter((part) => part.scrollWidth > part.clientWidth + 1).map((part) => part.className || part.tagName));
        assert.deepEqual(wide, [], `${name} scrolls sideways`);
    }
    const exposure = page.locator('input[type=number][aria-label="Exposure, stops"]');
    await exposure.fill('1');
    await exposure.press('Enter');
    await until('the exposure', async () => (await options()).exposure === '1');
    await page.locator('#tab-look').click();
    assert.ok(!await page.locator('#tab-look-panel').isVisible(), 'the sheet closes');
    const { height } = await page.locator('#stage').boundingBox();
    assert.ok(height > 600, 'the model has the screen');
    await check_axe('narrow');
});

// ---- run ----

const browser = await page.context().browser().newBrowserCDPSession();
const cpu_seconds = async () => (await browser.send('SystemInfo.getProcessInfo')).processInfo.reduce((sum, { cpuTime }) => sum + cpuTime, 0);

const page_address = page.url();
try {
    await page.setViewportSize({ width: 800, height: 440 });
    await page.emulateMedia({ reducedMotion: 'reduce' });
    for (const [name, run] of steps) {
        if (process.env.PAGE_TEST && !/^(opens|drops a model)/.test(name) && !name.includes(process.env.PAGE_TEST)) continue;
        const start = performance.now(), start_cpu = await cpu_seconds();
        try {
            await run();
        } catch (error) {
            await page.screenshot({ path: path.join(work, 'failed.png') });
            error.message = `${name}: ${error.message}`;
            throw error;
        }
        console.log(`${name}: ${((performance.now() - start) / 1000).toFixed(1)} s, ${(await cpu_seconds() - start_cpu).toFixed(1)} s of CPU`);
    }
    assert.deepEqual(requests.filter((url) => !url.startsWith(new URL('.', page_address).href) && !/^(blob|data):/.test(url)), [], 'the page asks for files elsewhere');
    assert.deepEqual(messages.filter((text) => !/GPU stall/.test(text)), [], 'the console says something');
} finally {
    await served.close();
}
