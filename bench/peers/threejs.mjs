// threejs.mjs - draws a glTF model with three.js in headless Chromium and writes the PNG: what a server does today.
// usage: node threejs.mjs MODEL.glb LIGHT.hdr OUT.png [SIZE]     CHROMIUM names the browser (/usr/bin/chromium)
import { writeFile } from 'node:fs/promises';
import { open_page } from './browser.mjs';

const [model, light, out, size = '512'] = process.argv.slice(2);
if (!out) {
    console.error('usage: node threejs.mjs MODEL.glb LIGHT.hdr OUT.png [SIZE]');
    process.exit(2);
}
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
window.rendered = canvas.toDataURL('image/png');
</script>`;

const { page, close } = await open_page(page_text, (url) => ({ '/model': model, '/light': light })[url]);
try {
    await page.waitForFunction('window.rendered', null, { timeout: 120000 });
    const rendered = await page.evaluate('window.rendered');
    await writeFile(out, Buffer.from(rendered.split(',')[1], 'base64'));
} finally {
    await close();
}
