// explorer.mjs FACET DIST [SCREENSHOTS] - the BRDF explorer in Chromium: its settings by keyboard, its numbers beside those of
// facet plot, values under the pointer, downloads, the link, accessibility, both color schemes, a narrow screen.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { createRequire } from 'node:module';
import path from 'node:path';

const [facet, dist, shots] = process.argv.slice(2);
const require = createRequire(new URL('../clients/package.json', import.meta.url));
const { chromium } = require('playwright-core');
const types = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.svg': 'image/svg+xml', '.wasm': 'application/wasm' };

const server = createServer(async (request, response) => {
    const name = path.normalize(decodeURIComponent(new URL(request.url, 'http://localhost').pathname));
    try {
        const bytes = await readFile(path.join(dist, name));
        response.setHeader('content-type', types[path.extname(name)] ?? 'application/octet-stream');
        response.end(bytes);
    } catch {
        response.statusCode = 404;
        response.end();
    }
});
await new Promise((resolve) => { server.listen(0, '127.0.0.1', resolve); });
const origin = `http://127.0.0.1:${server.address().port}`;
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'] });

const problems = [];

async function open(hash = '', options = {}) {
    const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, permissions: ['clipboard-read', 'clipboard-write'], ...options });
    const page = await context.newPage();
    page.on('pageerror', (error) => problems.push(String(error)));
    page.on('console', (message) => { if (['error', 'warning'].includes(message.type())) problems.push(message.text()); });
    page.on('response', (response) => { if (response.status() >= 400) problems.push(`${response.status()} ${response.url()}`); });
    page.on('request', (request) => { if (!request.url().startsWith(origin) && !request.url().startsWith('blob:')) problems.push(`a request to ${request.url()}`); });
    await page.goto(`${origin}/explorer.html${hash}`);
    await drawn(page);
    return page;
}

// Waits until the plot of the settings is there; with is, until its command contains that.
async function drawn(page, is = '') {
    await page.waitForFunction((text) => document.getElementById('chart').dataset.drawn?.includes(text) || !document.getElementById('error').hidden, is, { timeout: 60000 });
    assert.equal(await page.locator('#error').isVisible() ? await page.locator('#error').textContent() : '', '');
}

const command = (page) => page.locator('#chart').getAttribute('data-drawn');
const readout = (page) => page.locator('#readout').textContent();

// What the command of the page prints as CSV.
function csvOf(line) {
    const words = [...line.matchAll(/'([^']*)'|(\S+)/g)].map(([, quoted, plain]) => quoted ?? plain);
    return execFileSync(facet, [...words.slice(1, -2), '-o', '-', '--format', 'csv']).toString();
}

async function download(page, name) {
    const [file] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name, exact: true }).click()]);
    return { name: file.suggestedFilename(), bytes: await readFile(await file.path()) };
}

function assertSameNumbers(a, b) {
    const [x, y] = [a, b].map((text) => text.split('\n').filter((line) => /^-?\d/.test(line)).flatMap((line) => line.split(',').map(Number)));
    assert.ok(x.length > 100 && x.length === y.length, `${x.length} and ${y.length} numbers`);
    x.forEach((value, i) => assert.ok(Math.abs(value - y[i]) <= 1e-6 * Math.max(1e-3, Math.abs(y[i])), `${value} and ${y[i]}`));
}

// The part of the image's pixels that are not its background.
const inkOf = (page) => page.evaluate(() => {
    const image = document.getElementById('drawing');
    const canvas = Object.assign(document.createElement('canvas'), { width: image.naturalWidth, height: image.naturalHeight });
    const context = canvas.getContext('2d');
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4) count += Math.abs(data[i] - data[0]) + Math.abs(data[i + 1] - data[1]) > 24;
    return count / (canvas.width * canvas.height);
});

// Whether the background of the plot is dark.
function isDarkDrawing() {
    const context = Object.assign(document.createElement('canvas'), { width: 4, height: 4 }).getContext('2d');
    context.drawImage(document.getElementById('drawing'), 0, 0);
    return context.getImageData(1, 1, 1, 1).data[0] < 128;
}

// ---- tests ----

async function testKeyboard() {
    const page = await open();
    assert.match(await command(page), /^facet plot slice roughness=0\.4 --angle 30 -o slice\.svg$/);
    assert.ok(await inkOf(page) > 0.01, 'there is a plot');
    assert.equal(JSON.parse(execFileSync(facet, ['plot', 'slice', 'roughness=0.4', '-o', '-', '--format', 'json'])).panels[0].y.range[0], 0, 'the axis of a BRDF begins at 0');
    await page.getByRole('slider', { name: 'Roughness' }).first().focus();
    const before = await page.locator('#drawing').getAttribute('src');
    for (let i = 0; i < 10; i++) await page.keyboard.press('ArrowLeft');
    await drawn(page, 'roughness=0.3 ');
    assert.notEqual(await page.locator('#drawing').getAttribute('src'), before);
    await page.getByRole('slider', { name: 'Metallic' }).focus();
    await page.keyboard.press('End');
    await page.getByRole('slider', { name: 'Eye from normal' }).focus();
    await page.keyboard.press('PageUp');
    await drawn(page, 'metallic=1 --angle 3');
    assertSameNumbers((await download(page, 'Save as CSV')).bytes.toString(), csvOf(await command(page)));
    await page.locator('#chart').focus();
    await page.keyboard.press('Home');
    await page.waitForFunction(() => document.getElementById('readout').textContent.startsWith('angle of the light -90 degrees'));
    await page.keyboard.press('ArrowRight');
    await page.waitForFunction(() => document.getElementById('readout').textContent.startsWith('angle of the light -89 degrees'));
    assert.equal(await page.locator('#cursor line').count(), 1);
    return page;
}

// The value under the pointer is the curve's, and lies on the drawn curve.
async function testPointer() {
    const page = await open('#plot=slice&roughness=0.5&angle=20');
    const box = await page.locator('#chart').boundingBox();
    await page.mouse.move(box.x + 0.35 * box.width, box.y + 0.5 * box.height);
    await page.waitForFunction(() => document.querySelectorAll('#cursor circle').length === 1);
    const [, at, value] = (await readout(page)).match(/light (-?[\d.]+) degrees .*: ([-\d.e]+)$/);
    const rows = csvOf(await command(page)).split('\n').filter((line) => /^-?\d/.test(line)).map((line) => line.split(',').map(Number));
    const i = rows.findIndex(([x]) => x >= Number(at));
    const [[x0, y0], [x1, y1]] = [rows[i - 1], rows[i]];
    const expected = y0 + ((y1 - y0) * (Number(at) - x0)) / (x1 - x0);
    assert.ok(Math.abs(Number(value) - expected) < 0.01 * expected, `${value} at ${at}; ${expected} expected`);
    const color = await page.evaluate(() => {
        const circle = document.querySelector('#cursor circle');
        const image = document.getElementById('drawing');
        const canvas = Object.assign(document.createElement('canvas'), { width: image.naturalWidth, height: image.naturalHeight });
        const context = canvas.getContext('2d');
        context.drawImage(image, 0, 0);
        const hex = [...context.getImageData(Number(circle.getAttribute('cx')) - 1, Number(circle.getAttribute('cy')) - 1, 3, 3).data];
        const wanted = circle.getAttribute('fill').match(/\w\w/g).map((code) => parseInt(code, 16));
        return Math.min(...[0, 1, 2, 3, 4, 5, 6, 7, 8].map((k) => Math.max(...wanted.map((code, c) => Math.abs(code - hex[4 * k + c])))));
    });
    assert.ok(color < 60, `the mark lies beside the curve: its color is off by ${color}`);
    await page.mouse.move(2, 2);
    await page.waitForFunction(() => !document.querySelector('#cursor circle'));
    return page;
}

async function testPlots() {
    const page = await open();
    for (const name of ['Polar lobe', 'Lobe in space', 'All directions', 'Albedo', 'D, V, F', 'Furnace', 'Fresnel', 'Fit error']) {
        const button = page.getByRole('button', { name, exact: true });
        await button.click();
        await drawn(page, `plot ${await button.getAttribute('data-kind')} `);
        assert.ok(await inkOf(page) > 0.01, name);
        await page.getByRole('button', { name: 'Table', exact: true }).click();
        await page.locator('#table[open]').waitFor();
        assert.ok(await page.locator('#table td').count() > 1, `${name} has a table`);
        if (shots) await page.screenshot({ path: `${shots}/${name.replaceAll(/\W/g, '')}-table.png` });
        await page.keyboard.press('Escape');
    }
    return page;
}

async function testMaterials() {
    const page = await open('#plot=slice&fit');
    assert.match(await readout(page), /^best fit: ogl1,diffuse=.* \(E 0\.\d+\)$/);
    await page.getByRole('button', { name: 'Keep for comparison' }).click();
    await page.getByRole('combobox', { name: 'Model' }).selectOption('ogl1');
    await drawn(page, "facet plot slice roughness=0.4 'ogl1,diffuse=#808080,specular=#ffffff,shininess=50' --angle 30 --fit");
    await page.getByRole('slider', { name: 'Shininess' }).focus();
    await page.keyboard.press('ArrowRight');
    await drawn(page, 'shininess=51');
    const link = page.url();
    await page.locator('#copy-command').click();
    await page.waitForFunction(() => document.getElementById('readout').textContent.startsWith('Copied: facet plot'));
    assert.equal(await page.evaluate(() => navigator.clipboard.readText()), await command(page));
    const other = await open(new URL(link).hash);
    assert.equal(await command(other), await command(page), 'the link holds all settings');
    await other.context().close();
    await page.getByRole('button', { name: 'Remove roughness=0.4' }).click();
    await page.waitForFunction(() => !document.getElementById('chart').dataset.drawn.includes('roughness=0.4'));
    const svg = await download(page, 'Save as SVG');
    assert.match(svg.bytes.toString(), /^<svg xmlns=/);
    const png = await download(page, 'Save as PNG');
    assert.deepEqual([png.name, png.bytes.toString('latin1', 1, 4)], ['slice.png', 'PNG']);
    return page;
}

// The sphere has the material of the plot, and follows its sliders.
async function testSphere() {
    const page = await open('#plot=slice&roughness=0.3&color=%23c08020');
    await page.getByText('Sphere', { exact: true }).click();
    await page.waitForFunction(() => document.querySelector('facet-viewer')?.loaded || document.querySelector('.sphere').textContent.includes('cannot'), null, { timeout: 60000 });
    const material = () => page.evaluate(() => document.querySelector('facet-viewer').materials[0]);
    const picture = () => page.evaluate(async () => {
        const bytes = new Uint8Array(await (await document.querySelector('facet-viewer').screenshot({ width: 64, height: 64 })).arrayBuffer());
        return [...bytes].join();
    });
    const plastic = await picture();
    assert.equal((await material()).roughness, 0.3);
    await page.getByRole('slider', { name: 'Metallic' }).focus();
    await page.keyboard.press('End');
    await drawn(page, 'metallic=1');
    const { metallic, base_color: [r, g, b] } = await material();
    assert.equal(metallic, 1);
    const legend = csvOf(await command(page)).match(/metal \(([\d.]+), ([\d.]+), ([\d.]+)\)/).slice(1).map(Number);
    [r, g, b].forEach((value, i) => assert.ok(Math.abs(value - legend[i]) < 0.001, `${value} and ${legend[i]}`));
    assert.notEqual(await picture(), plastic, 'another picture');
    return page;
}

// From a change of a slider to the new plot in the page.
async function testSpeed() {
    const page = await open();
    const times = await page.evaluate(async () => {
        const slider = [...document.querySelectorAll('.field')].find((field) => field.textContent === 'Roughness').querySelector('input');
        const found = [];
        for (let i = 0; i < 12; i++) {
            const start = performance.now();
            slider.value = 0.2 + 0.01 * i;
            slider.dispatchEvent(new Event('input'));
            const wanted = `roughness=${slider.value}`;
            while (!document.getElementById('chart').dataset.drawn.includes(`${wanted} `) && performance.now() - start < 5000) await new Promise((resolve) => { requestAnimationFrame(resolve); });
            found.push(performance.now() - start);
        }
        return found.sort((a, b) => a - b);
    });
    console.log(`explorer: ${times[6].toFixed(0)} ms from slider to plot (median of 12)`);
    assert.ok(times[6] < 2000);
    return page;
}

async function testAccess() {
    const axe = await readFile(require.resolve('axe-core/axe.min.js'), 'utf8');
    for (const options of [{}, { colorScheme: 'dark' }, { viewport: { width: 390, height: 844 } }, { viewport: { width: 390, height: 844 }, colorScheme: 'dark' }]) {
        const page = await open('#plot=brdf&roughness=0.3&clearcoat=0.5', { bypassCSP: true, ...options });
        const name = `${options.viewport ? 'narrow' : 'wide'}-${options.colorScheme ?? 'light'}`;
        if (shots) await page.screenshot({ path: `${shots}/${name}.png` });
        await page.addScriptTag({ content: axe });
        const { violations } = await page.evaluate(() => window.axe.run());
        assert.deepEqual(violations.map(({ id, nodes }) => `${name}: ${id}: ${nodes.map(({ html }) => html).join(' ')}`), []);
        assert.equal(await page.evaluate(isDarkDrawing), options.colorScheme === 'dark', `${name}: the plot has the colors of the page`);
        assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `${name}: it does not scroll sideways`);
        await page.context().close();
    }
}

try {
    for (const test of [testKeyboard, testPointer, testPlots, testMaterials, testSphere, testSpeed, testAccess]) {
        const page = await test();
        if (page && shots) await page.screenshot({ path: `${shots}/${test.name}.png` });
        await page?.context().close();
        assert.deepEqual(problems, [], 'no errors and warnings of the browser');
        console.log(`explorer: ${test.name.replace(/^test/, '').toLowerCase()} passed`);
    }
} finally {
    await browser.close();
    server.close();
}
