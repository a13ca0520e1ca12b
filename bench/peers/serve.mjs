// serve.mjs - warm thumbnails by facet serve beside those of a warm page in headless Chromium (SwiftShader): time of an image when one is
// asked for at a time (median, 95th percentile), images per second when several are, CPU time, memory.
// usage: node serve.mjs [--count N] FACET MODEL.glb..
// Each image is loaded anew, framed, rendered with 256 x 256 pixels and compressed as PNG. facet is asked over HTTP, once for each image;
// the browser's page stays open, keeps its renderer and prepared light, and is asked by playwright. CHROMIUM names the browser.
import { buildSync } from 'esbuild';
import { execFileSync, spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, readdirSync, rmSync } from 'node:fs';
import http from 'node:http';
import { tmpdir } from 'node:os';
import { fileURLToPath } from 'node:url';
import path from 'node:path';
import { serve_page } from '../../tests/clients/browser.mjs';

const here = path.dirname(fileURLToPath(import.meta.url));
const words = process.argv.slice(2), option = (name, otherwise) => words[0] === name ? words.splice(0, 2)[1] : otherwise;
const count = Number(option('--count', 60));
const [facet, ...models] = words;
if (!models.length) {
    console.error('usage: node serve.mjs [--count N] FACET MODEL.glb..');
    process.exit(2);
}

// ---- CPU time and memory of a process and its children ----

const ticks_per_s = Number(execFileSync('getconf', ['CLK_TCK']));

function processes_below(root) {
    const all = new Map();
    for (const name of readdirSync('/proc'))
        try {
            const stat = readFileSync(`/proc/${name}/stat`, 'latin1'), fields = stat.slice(stat.lastIndexOf(')') + 2).split(' ');
            all.set(Number(name), { parent: Number(fields[1]), ticks: fields.slice(11, 15).reduce((sum, field) => sum + Number(field), 0) });
        } catch { /* no process, or it has ended */ }
    const is_below = (pid) => pid === root || (all.has(pid) && is_below(all.get(pid).parent));
    return [...all].filter(([pid]) => is_below(pid)).map(([pid, { ticks }]) => ({ pid, ticks }));
}

const cpu_s = (root, except) => processes_below(root).reduce((sum, { pid, ticks }) => pid === except ? sum : sum + ticks, 0) / ticks_per_s;

// Memory of the processes, shared pages divided among those that share them, MB.
const memory_mb = (root, except) => processes_below(root).reduce((sum, { pid }) => {
    try {
        return pid === except ? sum : sum + Number(/^Pss: +(\d+)/m.exec(readFileSync(`/proc/${pid}/smaps_rollup`, 'latin1'))[1]) / 1024;
    } catch {
        return sum;
    }
}, 0);

// ---- servers: image(model) gives a PNG ----

async function start_facet() {
    const root = path.parse(models[0]).root, child = spawn(facet, ['serve', '--http', '0', '--root', root], { stdio: ['ignore', 'ignore', 'pipe'] });
    const url = await new Promise((resolve, reject) => {
        let log = '';
        child.on('exit', () => reject(new Error(log)));
        child.stderr.on('data', (text) => { log += text; const found = /http:\S+/.exec(log); if (found) resolve(found[0]); });
    });
    const agent = new http.Agent({ keepAlive: true });
    const image = (model) => new Promise((resolve, reject) => {
        http.get(`${url}render?size=256&background=transparent&model=${encodeURIComponent(model)}`, { agent }, (response) => {
            const parts = [];
            response.on('data', (part) => parts.push(part));
            response.on('end', () => response.statusCode === 200 ? resolve(Buffer.concat(parts)) : reject(new Error(String(Buffer.concat(parts)))));
        }).on('error', reject);
    });
    return { image, pid: child.pid, close: () => { agent.destroy(); child.removeAllListeners('exit'); child.kill(); } };
}

const three_source = `import * as THREE from 'three-r187';
    import { GLTFLoader } from 'three-r187/addons/loaders/GLTFLoader.js';
    import { RoomEnvironment } from 'three-r187/addons/environments/RoomEnvironment.js';
    const renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
    renderer.setSize(256, 256);
    renderer.toneMapping = THREE.NeutralToneMapping;
    const environment = new THREE.PMREMGenerator(renderer).fromScene(new RoomEnvironment(), 0.04).texture;
    const camera = new THREE.PerspectiveCamera(30, 1, 0.001, 1000);
    const release = (material) => { for (const value of Object.values(material)) value?.isTexture && value.dispose(); material.dispose(); };
    window.image = async (url) => {
        const gltf = await new GLTFLoader().loadAsync(url), scene = new THREE.Scene();
        scene.environment = environment;
        scene.add(gltf.scene);
        const sphere = new THREE.Box3().setFromObject(gltf.scene).getBoundingSphere(new THREE.Sphere());
        const distance = sphere.radius / Math.sin(15 * Math.PI / 180);
        camera.near = distance / 100;
        camera.far = distance * 100;
        camera.updateProjectionMatrix();
        camera.position.set(0, 0.27, 1).setLength(distance).add(sphere.center);
        camera.lookAt(sphere.center);
        renderer.render(scene, camera);
        const text = renderer.domElement.toDataURL('image/png');
        gltf.scene.traverse((node) => { node.geometry?.dispose(); if (node.material) [node.material].flat().forEach(release); });
        return text;
    };
    window.ready = true;`;

const model_viewer_source = `
    await import('/node_modules/@google/model-viewer/dist/model-viewer.min.js');
    const element = document.querySelector('model-viewer');
    customElements.get('model-viewer').minimumRenderScale = 1;
    const frame = () => new Promise(requestAnimationFrame);
    let number = 0;
    window.image = async (url) => {
        const loaded = new Promise((resolve, reject) => {
            element.addEventListener('load', resolve, { once: true });
            element.addEventListener('error', (event) => reject(new Error(JSON.stringify(event.detail))), { once: true });
        });
        element.src = url + '?' + ++number;
        await loaded;
        element.jumpCameraToGoal();
        await frame();
        await frame();
        return element.toDataURL('image/png');
    };
    window.ready = true;`;

async function start_browser(kind, folder) {
    const page_of = (body, source) => `<!doctype html><link rel="icon" href="data:,">${body}<script type="module">${source}</script>`;
    const text = kind === 'model-viewer'
        ? page_of('<model-viewer style="width:256px;height:256px" loading="eager" interaction-prompt="none"></model-viewer>', model_viewer_source)
        : page_of('', "await import('/bundle.js');");
    const file_of = (url) => url === '/' ? { text } : url === '/bundle.js' ? path.join(folder, 'bundle.js')
        : url.startsWith('/models/') ? url.slice('/models'.length) : path.join(here, url);
    const { page, close } = await serve_page('/', file_of, (error) => { console.error(String(error)); process.exitCode = 1; });
    await page.waitForFunction('window.ready', null, { timeout: 60000 });
    const image = async (model) => Buffer.from((await page.evaluate((url) => window.image(url), `/models${model}`)).split(',')[1], 'base64');
    return { image, close, pid: process.pid, except: process.pid };
}

// ---- measuring ----

async function measure(name, start, width) {
    const server = await start();
    try {
        for (const model of models) // warm, and that it works: an image of one color is small
            if ((await server.image(model)).length < 600) throw new Error(`${model}: the image is empty`);
        const before = cpu_s(server.pid, server.except), times = [];
        for (let i = 0; i < count; i++) {
            const begun = performance.now();
            await server.image(models[i % models.length]);
            times.push(performance.now() - begun);
        }
        const cpu_ms = (cpu_s(server.pid, server.except) - before) / count * 1e3;
        const begun = performance.now();
        let next = 0;
        await Promise.all(Array.from({ length: width }, async () => { while (next < count) await server.image(models[next++ % models.length]); }));
        const rate = count / (performance.now() - begun) * 1e3;
        times.sort((a, b) => a - b);
        const at = (share) => times[Math.min(times.length - 1, Math.floor(share * times.length))].toFixed(0);
        console.log(`| ${name} | ${at(0.5)} | ${at(0.95)} | ${rate.toFixed(1)} | ${cpu_ms.toFixed(0)} | ${memory_mb(server.pid, server.except).toFixed(0)} |`);
    } finally {
        await server.close();
    }
}

const folder = mkdtempSync(path.join(tmpdir(), 'serve-'));
buildSync({ stdin: { contents: three_source, resolveDir: here }, bundle: true, minify: true, format: 'esm', outfile: path.join(folder, 'bundle.js'),
    alias: { three: 'three-r187' }, absWorkingDir: here, logLevel: 'error' });
for (let i = 0; i < models.length; i++) models[i] = path.resolve(models[i]);
console.log('| | median, ms | 95 %, ms | images/s | CPU, ms | memory, MB |\n| --- | ---: | ---: | ---: | ---: | ---: |');
await measure('**facet serve**', start_facet, 4);
await measure('three.js r187', () => start_browser('three', folder), 1);
await measure('model-viewer 4.4.0', () => start_browser('model-viewer', folder), 1);
rmSync(folder, { recursive: true });
