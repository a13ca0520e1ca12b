// viewer_pages.mjs - a page for each viewer of viewers.mjs: window.viewer has ready (a promise of the first image), turn(step), which turns
// the model and draws or asks for a frame, and memory() of WebAssembly, or window.failure says why not. /model.glb and /light.hdr are
// served, /dist/ is facet's page, /node_modules/ are the packages.
import { buildSync } from 'esbuild';
import { fileURLToPath } from 'node:url';
import path from 'node:path';

const here = path.dirname(fileURLToPath(import.meta.url));
const width = 640, height = 480;

// Remembers contexts, so that a frame can be waited for.
const common = `<!doctype html><link rel="icon" href="data:,"><style>body { margin: 0 } canvas, model-viewer { width: ${width}px; height: ${height}px; display: block }</style>
<script>
const contexts = new Set();
for (const kind of [HTMLCanvasElement, OffscreenCanvas]) {
    const original = kind.prototype.getContext;
    kind.prototype.getContext = function (...words) {
        const context = original.apply(this, words);
        if (context && context.readPixels) contexts.add(context);
        return context;
    };
}
window.finish = () => {
    for (const gl of contexts) {
        const bound = gl.getParameter(gl.FRAMEBUFFER_BINDING);
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
        gl.bindFramebuffer(gl.FRAMEBUFFER, bound);
    }
};
// Share of pixels that the model covers, %, of a viewer that draws at once.
window.coverage = () => {
    window.viewer.turn(0);
    const [gl] = contexts, pixels = new Uint8Array(4 * ${width} * ${height});
    gl.readPixels(0, 0, ${width}, ${height}, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    return pixels.filter((value, i) => i % 4 === 3 && value > 0).length / (${width} * ${height}) * 100;
};
window.next_frame = () => new Promise(requestAnimationFrame);
window.time_frames = async (count) => {
    const start = performance.now();
    for (let i = 1; i <= count; i++) {
        window.viewer.turn(i);
        await window.next_frame();
        await window.next_frame();
        window.finish();
    }
    return (performance.now() - start) / count;
};
window.addEventListener('unhandledrejection', (event) => { window.failure = String(event.reason.stack ?? event.reason); });
</script>`;

const module_page = (body, text) => `${common}${body}<script type="module">try { ${text} } catch (error) { window.failure = String(error.stack ?? error); }</script>`;
const canvas = `<canvas id="c" width="${width}" height="${height}"></canvas>`;

// three.js as small as a bundler makes it.
function three_bundle(outfile) {
    const source = `import * as THREE from 'three-r187';
        import { GLTFLoader } from 'three-r187/addons/loaders/GLTFLoader.js';
        import { RoomEnvironment } from 'three-r187/addons/environments/RoomEnvironment.js';
        const renderer = new THREE.WebGLRenderer({ canvas: document.getElementById('c'), antialias: true, alpha: true });
        renderer.toneMapping = THREE.NeutralToneMapping;
        const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera(30, ${width} / ${height}, 0.001, 100);
        const center = new THREE.Vector3();
        let distance = 1;
        const turn = (step) => {
            const angle = step * 0.1;
            camera.position.set(Math.sin(angle), 0.27, Math.cos(angle)).setLength(distance).add(center);
            camera.lookAt(center);
            renderer.render(scene, camera);
        };
        const load = async () => {
            scene.environment = new THREE.PMREMGenerator(renderer).fromScene(new RoomEnvironment(), 0.04).texture;
            const gltf = await new GLTFLoader().loadAsync('/model.glb');
            scene.add(gltf.scene);
            const sphere = new THREE.Box3().setFromObject(gltf.scene).getBoundingSphere(new THREE.Sphere());
            center.copy(sphere.center);
            distance = 0.96 * sphere.radius / Math.sin(15 * Math.PI / 180);
            turn(0);
        };
        window.viewer = { ready: load(), turn };`;
    buildSync({ stdin: { contents: source, resolveDir: here }, bundle: true, minify: true, format: 'esm', outfile,
        alias: { three: 'three-r187' }, absWorkingDir: here, logLevel: 'error' });
}

// The file behind a URL below /bundles/, in a folder.
export function make_bundles(folder) {
    three_bundle(path.join(folder, 'three.js'));
    return (url) => path.join(folder, path.basename(url));
}

// isDraft: as frames of a motion, else as the image at rest.
const facet = (isDraft) => `
const { loadModule } = await import('/dist/facet-viewer/module.js');
const c = document.getElementById('c');
const load = async () => {
    const [facet, bytes] = await Promise.all([loadModule(), fetch('/model.glb').then((response) => response.arrayBuffer())]);
    facet.start(c);
    const viewer = facet.create();
    facet.putFile('model.glb', new Uint8Array(bytes));
    facet.open(viewer, 'model.glb');
    window.viewer.memory = () => facet.memorySize;
    window.viewer.turn = (step) => {
        if (step) facet.turn(viewer, 10, 0, c.height);
        facet.jump(viewer);
        facet.draw(viewer, c.width, c.height, 0, step && ${isDraft});
    };
    window.viewer.turn(0);
};
window.viewer = {};
window.viewer.ready = load();`;

const model_viewer = `
const { ModelViewerElement } = await import('/node_modules/@google/model-viewer/dist/model-viewer.min.js');
ModelViewerElement.minimumRenderScale = 1;
const element = document.querySelector('model-viewer');
const ready = new Promise((resolve, reject) => {
    element.addEventListener('load', () => window.next_frame().then(window.next_frame).then(resolve), { once: true });
    element.addEventListener('error', (event) => reject(new Error(JSON.stringify(event.detail))), { once: true });
});
element.src = '/model.glb';
window.viewer = { ready, turn: (step) => {
    element.cameraOrbit = (step * 6) + 'deg 75deg 105%';
    element.jumpCameraToGoal();
} };`;

// Its package has no table of the sheen's albedo; a white texel stands in for it, which only sheen reads.
const khronos = `
const { GltfView } = await import('/node_modules/@khronosgroup/gltf-viewer/dist/gltf-viewer.module.js');
const c = document.getElementById('c');
const view = new GltfView(c.getContext('webgl2', { alpha: true, antialias: true }));
const state = view.createState();
const loader = view.createResourceLoader(undefined, undefined, '/node_modules/@khronosgroup/gltf-viewer/dist/libs/');
const white = document.createElement('canvas');
white.width = white.height = 1;
white.getContext('2d').fillRect(0, 0, 1, 1);
const turn = (step) => {
    if (step) state.userCamera.orbit(10, 0);
    view.renderFrame(state, c.width, c.height);
};
const load = async () => {
    state.environment = await loader.loadEnvironment('/light.hdr', { lut_sheen_E_file: white.toDataURL() });
    state.gltf = await loader.loadGltf('/model.glb');
    state.sceneIndex = state.gltf.scene ?? 0;
    state.renderingParameters.renderEnvironmentMap = false;
    state.userCamera.perspective.aspectRatio = c.width / c.height;
    state.userCamera.fitViewToScene(state.gltf, state.sceneIndex);
    turn(0);
};
window.viewer = { ready: load(), turn };`;

export const pages = {
    'facet': module_page(canvas, facet(true)),
    'facet at rest': module_page(canvas, facet(false)),
    'model-viewer 4.4.0': module_page('<model-viewer camera-controls></model-viewer>', model_viewer),
    'three r187': module_page(canvas, "await import('/bundles/three.js');"),
    'gltf-viewer 1.1.0': module_page(`${canvas}<script src="/node_modules/@khronosgroup/gltf-viewer/dist/libs/libktx.js"></script>
        <script>window.DracoDecoderModule = async () => ({});</script>`, khronos),
};
