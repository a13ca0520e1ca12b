// viewers.mjs - facet's viewer beside other viewers for web pages: bytes, time to the first image, time of a frame, memory. All draw the
// same model, in the same browser (headless Chromium with SwiftShader), at the same size, by turns.
// usage: node viewers.mjs [--runs N] [--frames N] [--only NAME,..] DIST MODEL.glb LIGHT.hdr
// DIST: build/web/dist. LIGHT.hdr: for gltf-viewer, which comes without a light; the others use their own. CHROMIUM names the browser.
//
// CPU time is that of all processes of the browser: the clock says little on a shared machine, and hides what GPU process and page do at
// once. Draw calls return before their work is done, so every frame ends with reading a pixel of each WebGL context. A frame is a turn
// of the camera and two animation frames, because model-viewer draws in the one after a change; model-viewer may not lower its resolution.
// Bytes are those of all files that a viewer fetched but the model and the light. Medians of the runs.
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, readdirSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { fileURLToPath } from 'node:url';
import path from 'node:path';
import { brotliCompressSync, gzipSync } from 'node:zlib';
import { serve_page } from '../../tests/clients/browser.mjs';
import { make_bundles, pages } from './viewer_pages.mjs';

const here = path.dirname(fileURLToPath(import.meta.url));
const words = process.argv.slice(2), option = (name, otherwise) => words[0] === name ? words.splice(0, 2)[1] : otherwise;
const runs = Number(option('--runs', 5)), frames = Number(option('--frames', 12)), only = option('--only', '').split(',').filter(Boolean);
const [dist, model, light] = words;
if (!light) {
    console.error('usage: node viewers.mjs [--runs N] [--frames N] [--only NAME,..] DIST MODEL.glb LIGHT.hdr');
    process.exit(2);
}

// ---- what the browser's processes took ----

function browser_processes() {
    const parents = new Map();
    for (const name of readdirSync('/proc')) {
        if (!/^\d+$/.test(name)) continue;
        try {
            const stat = readFileSync(`/proc/${name}/stat`, 'latin1'), fields = stat.slice(stat.lastIndexOf(')') + 2).split(' ');
            parents.set(Number(name), { parent: Number(fields[1]), ticks: Number(fields[11]) + Number(fields[12]) });
        } catch { /* it has ended */ }
    }
    const is_ours = (pid) => pid === process.pid || (parents.has(pid) && is_ours(parents.get(pid).parent));
    return [...parents].filter(([pid]) => pid !== process.pid && is_ours(pid)).map(([pid, { ticks }]) => ({ pid, ticks }));
}

const ticks_per_s = Number(execFileSync('getconf', ['CLK_TCK']));
const cpu_s = () => browser_processes().reduce((sum, { ticks }) => sum + ticks, 0) / ticks_per_s;

function memory_mb() {
    let kb = 0;
    for (const { pid } of browser_processes())
        try {
            kb += Number(/^Pss: +(\d+)/m.exec(readFileSync(`/proc/${pid}/smaps_rollup`, 'latin1'))[1]);
        } catch { /* it has ended */ }
    return kb / 1024;
}

// ---- one run ----

async function run(viewer) {
    const served = new Map();
    const file_of = (url) => {
        if (url === '/') return { text: pages[viewer] };
        if (url === '/model.glb') return model;
        if (url === '/light.hdr') return light;
        const file = url.startsWith('/dist/') ? path.join(dist, url.slice(6)) : url.startsWith('/bundles/') ? bundle_of(url) : path.join(here, url);
        served.set(url, file);
        return file;
    };
    const { page, close } = await serve_page('/blank', (url) => url === '/blank' ? { text: '<!doctype html>' } : file_of(url));
    try {
        const before = cpu_s(), start = Date.now(), address = page.url().replace('/blank', '/');
        await page.goto(address);
        await page.waitForFunction('window.viewer || window.failure', null, { timeout: 60000 });
        const result = {};
        const failure = await page.evaluate('window.failure || window.viewer.ready.then(() => window.finish()).then(() => "", String)');
        if (failure) throw new Error(failure);
        Object.assign(result, { first_cpu_s: cpu_s() - before, first_s: (Date.now() - start) / 1000 });
        const warmed = cpu_s();
        result.frame_ms = await page.evaluate((count) => window.time_frames(count), frames);
        result.frame_cpu_ms = (cpu_s() - warmed) / frames * 1000;
        const client = await page.context().newCDPSession(page);
        await client.send('HeapProfiler.collectGarbage');
        result.heap_mb = (await client.send('Runtime.getHeapUsage')).usedSize / 2 ** 20;
        result.wasm_mb = await page.evaluate('window.viewer.memory ? window.viewer.memory() / 1048576 : 0');
        result.memory_mb = memory_mb();
        const files = [...served.values()].filter((file) => !file.endsWith('favicon.ico')).map((file) => readFileSync(file));
        const sum = (size) => files.reduce((total, bytes) => total + size(bytes), 0) / 1000;
        if (!sizes.has(viewer))
            sizes.set(viewer, [sum((b) => b.length), sum((b) => gzipSync(b, { level: 9 }).length), sum((b) => brotliCompressSync(b).length)]);
        return result;
    } finally {
        await close();
    }
}

// ---- all ----

const work = mkdtempSync(path.join(tmpdir(), 'viewers-')), bundle_of = make_bundles(work);
const sizes = new Map(), results = new Map(Object.keys(pages).filter((name) => !only.length || only.includes(name)).map((name) => [name, []]));
for (let i = 0; i < runs; i++)
    for (const [viewer, list] of results)
        try {
            list.push(await run(viewer));
            console.error(`${viewer}: ${JSON.stringify(list.at(-1))}`);
        } catch (error) {
            console.error(`${viewer}: ${error.message}`);
            process.exitCode = 1;
        }
rmSync(work, { recursive: true });
const median = (list) => list.sort((a, b) => a - b)[list.length >> 1];
console.log('| | kB | gzip | brotli | first image, CPU s | clock s | frame, CPU ms | clock ms | JS heap MB | wasm MB | all processes MB |');
console.log('| --- |' + ' ---: |'.repeat(10));
for (const [viewer, list] of results) {
    if (!list.length) continue;
    const cell = (name, digits) => median(list.map((result) => result[name])).toFixed(digits);
    console.log(`| ${viewer} | ${sizes.get(viewer).map((size) => size.toFixed(0)).join(' | ')} | ${cell('first_cpu_s', 1)} | ${cell('first_s', 1)} | ` +
        `${cell('frame_cpu_ms', 0)} | ${cell('frame_ms', 0)} | ${cell('heap_mb', 1)} | ${cell('wasm_mb', 0)} | ${cell('memory_mb', 0)} |`);
}
