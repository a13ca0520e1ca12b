// fidelity_pages.mjs - a page for each viewer that fidelity.mjs compares with. A page has window.draw(job), which loads a model, draws it
// on white with the job's camera, and returns the URL of a PNG with job.size x job.size pixels; window.ready says that the environment is loaded,
// window.failure why not. A job: url, eye, target (m), distance (m), azimuth and elevation (degrees) of the same camera, size, time (s, optional).
// /models/.., /light.hdr, /bundles/.. and /node_modules/.. are served. The vertical field of view is 30 degrees.
import { buildSync } from 'esbuild';
import { fileURLToPath } from 'node:url';
import path from 'node:path';

const here = path.dirname(fileURLToPath(import.meta.url));

const page_of = (body, text) => `<!doctype html><meta charset="utf-8"><link rel="icon" href="data:,">
<style>body { margin: 0 }</style>${body}<script type="module">try { ${text} window.ready = true; }
catch (error) { window.failure = String(error.stack ?? error); }</script>`;

// ---- Khronos' renderer ----

// The albedo of the sheen's lobe, which the package comes without: red, over N.V and sheenRoughness. From the
// renderer's own distribution (Estevez and Kulla 2017) and visibility, by the midpoint rule.
const sheen_table = `
const sheen_lambda = (x, alpha) => {
    const w = (1 - alpha) ** 2, at = (a, b) => a + (b - a) * w;
    const L = (x) => at(21.5473, 25.3245) / (1 + at(3.82987, 3.32435) * x ** at(0.19823, 0.16801)) +
        at(-1.97760, -1.27393) * x + at(-4.32054, -4.85967);
    return Math.exp(x < 0.5 ? L(x) : 2 * L(0.5) - L(1 - x));
};
const sheen_albedo = (NdotV, roughness) => {
    const alpha = roughness * roughness, n = 48, V = [Math.sqrt(1 - NdotV * NdotV), 0, NdotV];
    let sum = 0;
    for (let i = 0; i < n; i++)
        for (let k = 0; k < n; k++) {
            const z = (i + 0.5) / n, r = Math.sqrt(1 - z * z), phi = Math.PI * (k + 0.5) / n;
            const H = [V[0] + r * Math.cos(phi), r * Math.sin(phi), V[2] + z];
            const NdotH = H[2] / Math.hypot(...H);
            const D = (2 + 1 / alpha) * (1 - NdotH * NdotH) ** (0.5 / alpha) / (2 * Math.PI);
            const G = 1 / ((1 + sheen_lambda(NdotV, alpha) + sheen_lambda(z, alpha)) * 4 * NdotV * z);
            sum += D * Math.min(Math.max(G, 0), 1) * z;
        }
    return sum * 2 * Math.PI / (n * n);
};
const table = document.createElement('canvas');
table.width = table.height = 64;
const texels = new ImageData(64, 64);
for (let y = 0; y < 64; y++)
    for (let x = 0; x < 64; x++)
        texels.data.set([Math.round(255 * Math.min(1, sheen_albedo((x + 0.5) / 64, (y + 0.5) / 64))), 0, 0, 255], 4 * (64 * y + x));
table.getContext('2d').putImageData(texels, 0, 0);`;

// It rotates an environment by 90 degrees of its own, which its parameters take back, and encodes with a power of 1/2.2 in place of the
// sRGB function: its codes are encoded anew.
const khronos = `${sheen_table}
const { GltfView } = await import('/node_modules/@khronosgroup/gltf-viewer/dist/gltf-viewer.module.js');
const canvas = document.createElement('canvas');
const gl = canvas.getContext('webgl2', { alpha: false, antialias: true, preserveDrawingBuffer: true });
const view = new GltfView(gl), state = view.createState();
const libraries = '/node_modules/@khronosgroup/gltf-viewer/dist/libs/';
const loader = view.createResourceLoader(undefined, undefined, libraries);
state.environment = await loader.loadEnvironment('/light.hdr', { lut_sheen_E_file: table.toDataURL('image/png') });
const codes = Uint8ClampedArray.from(Array(256).keys(), (code) => {
    const v = (code / 255) ** 2.2;
    return Math.round(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055));
});
const sub = (a, b) => a.map((x, i) => x - b[i]);
const norm = (a) => { const l = Math.hypot(...a); return a.map((x) => x / l); };
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
window.draw = async ({ url, eye, target, distance, size, time }) => {
    canvas.width = canvas.height = size;
    state.gltf = await loader.loadGltf(url);
    state.sceneIndex = state.gltf.scene ?? 0;
    state.cameraNodeIndex = undefined;
    state.animationIndices = time === undefined ? [] : [0];
    if (time !== undefined) state.animationTimer.setFixedTime(time);
    const camera = state.userCamera, back = norm(sub(eye, target)), right = norm(cross([0, 1, 0], back)), up = cross(back, right);
    Object.assign(camera.perspective, { aspectRatio: 1, yfov: Math.PI / 6, znear: distance * 0.01, zfar: distance * 100 });
    camera.transform = new Float32Array([...right, 0, ...up, 0, ...back, 0, ...eye, 1]);
    Object.assign(state.renderingParameters, { renderEnvironmentMap: false, clearColor: [255, 255, 255, 255], environmentRotation: 0 });
    for (let i = 0; i < 3; i++) { view.renderFrame(state, size, size); await new Promise(requestAnimationFrame); }
    const copy = document.createElement('canvas');
    copy.width = copy.height = size;
    const context = copy.getContext('2d');
    context.drawImage(canvas, 0, 0);
    const image = context.getImageData(0, 0, size, size);
    image.data.forEach((code, i) => { if (i % 4 < 3) image.data[i] = codes[code]; });
    context.putImageData(image, 0, 0);
    return copy.toDataURL('image/png');
};`;

// ---- three.js ----

function three_bundle(outfile) {
    const libraries = '/node_modules/three-r187/examples/jsm/libs/';
    const contents = `import * as THREE from 'three-r187';
        import { GLTFLoader } from 'three-r187/addons/loaders/GLTFLoader.js';
        import { DRACOLoader } from 'three-r187/addons/loaders/DRACOLoader.js';
        import { KTX2Loader } from 'three-r187/addons/loaders/KTX2Loader.js';
        import { HDRLoader } from 'three-r187/addons/loaders/HDRLoader.js';
        import { MeshoptDecoder } from 'three-r187/addons/libs/meshopt_decoder.module.js';
        const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
        renderer.toneMapping = THREE.NeutralToneMapping;
        const loader = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder)
            .setDRACOLoader(new DRACOLoader().setDecoderPath('${libraries}draco/gltf/'))
            .setKTX2Loader(new KTX2Loader().setTranscoderPath('${libraries}basis/').detectSupport(renderer));
        const light = await new HDRLoader().loadAsync('/light.hdr');
        light.mapping = THREE.EquirectangularReflectionMapping;
        const environment = new THREE.PMREMGenerator(renderer).fromEquirectangular(light).texture;
        window.draw = async ({ url, eye, target, distance, size, time }) => {
            const gltf = await loader.loadAsync(url), scene = new THREE.Scene();
            scene.background = new THREE.Color('white');
            scene.environment = environment;
            scene.add(gltf.scene);
            if (time !== undefined && gltf.animations.length) {
                const mixer = new THREE.AnimationMixer(gltf.scene);
                mixer.clipAction(gltf.animations[0]).play();
                mixer.setTime(time);
            }
            const camera = new THREE.PerspectiveCamera(30, 1, distance / 100, distance * 100);
            camera.position.set(...eye);
            camera.lookAt(...target);
            renderer.setSize(size, size);
            for (let i = 0; i < 2; i++) renderer.render(scene, camera);
            const text = renderer.domElement.toDataURL('image/png');
            gltf.scene.traverse((node) => {
                node.geometry?.dispose();
                for (const material of [node.material ?? []].flat()) {
                    for (const value of Object.values(material)) if (value?.isTexture) value.dispose();
                    material.dispose();
                }
            });
            return text;
        };
        window.ready = true;`;
    buildSync({ stdin: { contents, resolveDir: here }, bundle: true, minify: true, format: 'esm', outfile,
        alias: { three: 'three-r187' }, absWorkingDir: here, logLevel: 'error' });
}

// The file behind a URL below /bundles/, in a folder.
export function make_bundles(folder) {
    three_bundle(path.join(folder, 'three.js'));
    return (url) => path.join(folder, path.basename(url));
}

// ---- model-viewer ----

const model_viewer = `
const { ModelViewerElement } = await import('/node_modules/@google/model-viewer/dist/model-viewer.min.js');
const libraries = '/node_modules/three-r187/examples/jsm/libs/';
Object.assign(ModelViewerElement, { minimumRenderScale: 1, dracoDecoderLocation: libraries + 'draco/gltf/',
    ktx2TranscoderLocation: libraries + 'basis/' });
const element = document.querySelector('model-viewer');
const frame = () => new Promise(requestAnimationFrame);
window.draw = async ({ url, target, distance, azimuth, elevation, size, time }) => {
    element.style.width = element.style.height = size + 'px';
    element.maxCameraOrbit = 'auto 180deg ' + 2 * distance + 'm'; // its clipping planes follow from it
    element.cameraTarget = target.map((x) => x + 'm').join(' ');
    element.cameraOrbit = azimuth + 'deg ' + (90 - elevation) + 'deg ' + distance + 'm';
    const loaded = new Promise((resolve, reject) => {
        element.addEventListener('load', resolve, { once: true });
        element.addEventListener('error', (event) => reject(new Error(event.detail?.sourceError?.message ?? event.detail?.type)), { once: true });
    });
    element.src = url;
    await loaded;
    if (time !== undefined && element.availableAnimations.length) {
        element.animationName = element.availableAnimations[0];
        await frame();
        element.pause();
        element.currentTime = time;
    }
    element.jumpCameraToGoal();
    for (let i = 0; i < 4; i++) await frame();
    const image = new Image();
    image.src = element.toDataURL('image/png');
    await image.decode();
    const copy = document.createElement('canvas');
    copy.width = copy.height = size;
    const context = copy.getContext('2d');
    context.fillStyle = 'white';
    context.fillRect(0, 0, size, size);
    context.drawImage(image, 0, 0, size, size);
    return copy.toDataURL('image/png');
};`;

export const pages = {
    'khronos': page_of(`<script src="/node_modules/@khronosgroup/gltf-viewer/dist/libs/libktx.js"></script>
        <script src="/node_modules/three-r187/examples/jsm/libs/draco/gltf/draco_decoder.js"></script>`, khronos), // it comes without Draco
    'model-viewer': page_of(`<model-viewer environment-image="/light.hdr" tone-mapping="neutral" exposure="1" shadow-intensity="0" loading="eager"
        interaction-prompt="none" field-of-view="30deg" min-field-of-view="1deg" min-camera-orbit="auto 0deg 0m"></model-viewer>`, model_viewer),
    'three': page_of('', "await import('/bundles/three.js');"),
};
