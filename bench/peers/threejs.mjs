// threejs.mjs - draws a glTF model with three.js in headless Chromium and writes the PNG: what a server does today.
// usage: node threejs.mjs MODEL.glb LIGHT.hdr OUT.png [SIZE]     CHROMIUM names the browser (/usr/bin/chromium)
import { createServer } from 'node:http';
import { readFile, writeFile } from 'node:fs/promises';
import { fileURLToPath } from 'node:url';
import path from 'node:path';
import { chromium } from 'playwright-core';

const [model, light, out, size = '512'] = process.argv.slice(2);
if (!out) {
    console.error('usage: node threejs.mjs MODEL.glb LIGHT.hdr OUT.png [SIZE]');
    process.exit(2);
}
const here = path.dirname(fileURLToPath(import.meta.url));
const page_text = `<!doctype html><canvas id="c" width="${size}" height="${size}"></canvas>
<script type="importmap">{"imports":{"three":"/node_modules/three/build/three.module.js",
"three/addons/":"/node_modules/three/examples/jsm/"}}</script>
<script type="module">
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { RGBELoader } from 'three/addons/loaders/RGBELoader.js';
const canvas = document.getElementById('c');
const renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
renderer.toneMapping = THREE.NeutralToneMapping;
const scene = new THREE.Scene();
scene.background = new THREE.Color('white');
const [gltf, hdr] = await Promise.all([new GLTFLoader().loadAsync('/model'), new RGBELoader().loadAsync('/light')]);
hdr.mapping = THREE.EquirectangularReflectionMapping;
scene.environment = hdr;
scene.add(gltf.scene);
const box = new THREE.Box3().setFromObject(gltf.scene);
const sphere = box.getBoundingSphere(new THREE.Sphere());
const camera = new THREE.PerspectiveCamera(30, 1, 0.01 * sphere.radius, 100 * sphere.radius);
const distance = 1.05 * sphere.radius / Math.sin(15 * Math.PI / 180);
const polar = 75 * Math.PI / 180;
camera.position.set(0, distance * Math.cos(polar), distance * Math.sin(polar)).add(sphere.center);
camera.lookAt(sphere.center);
renderer.render(scene, camera);
window.picture = canvas.toDataURL('image/png');
</script>`;

const server = createServer(async (request, response) => {
    try {
        const url = decodeURIComponent(new URL(request.url, 'http://localhost').pathname);
        if (url === '/') {
            response.setHeader('content-type', 'text/html');
            return response.end(page_text);
        }
        const file = url === '/model' ? model : url === '/light' ? light : path.join(here, path.normalize(url));
        if (url.endsWith('.js')) response.setHeader('content-type', 'text/javascript');
        response.end(await readFile(file));
    } catch {
        response.statusCode = 404;
        response.end();
    }
});
await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
        '--disable-background-networking', '--disable-component-update', '--disable-sync', '--no-first-run'],
});
try {
    const page = await browser.newPage();
    page.on('pageerror', (error) => { console.error(String(error)); process.exitCode = 1; });
    await page.goto(`http://127.0.0.1:${server.address().port}/`);
    await page.waitForFunction('window.picture', null, { timeout: 120000 });
    const picture = await page.evaluate('window.picture');
    await writeFile(out, Buffer.from(picture.split(',')[1], 'base64'));
} finally {
    await browser.close();
    server.close();
}
