// khronos.mjs - draws models with the Khronos glTF Sample Renderer in headless Chromium and with facet, with the same
// light, camera and tone mapping, and prints how far the images are apart.
// usage: node khronos.mjs [--renderer gl] [--frames N] FACET MODELS LIGHT.hdr OUT [NAME ..]     FACET: the command; MODELS: the folder that
// holds core, materials, ..; OUT: a folder for NAME-khronos.png and NAME-facet.png; NAME: only these. CHROMIUM names the
// browser. FLIP is that of the files as they are, at 67 pixels a degree. --frames: the median time of a frame of Khronos' renderer, too,
// over N frames of which each is waited for.
//
// The renderer turns an environment by 90 degrees of its own and encodes with a power of 1/2.2 in place of the sRGB
// function; facet gets the rotation (--env-rotation -90), and its codes are re-encoded before they are compared. Glass
// shows the environment in both, what is beside the model is white in both.
import { execFileSync } from 'node:child_process';
import { readFile, writeFile } from 'node:fs/promises';
import path from 'node:path';
import { open_page } from './browser.mjs';

const words = process.argv.slice(2), option = (name, otherwise) => words[0] === name ? words.splice(0, 2)[1] : otherwise;
const renderer = option('--renderer', 'preview'), frames = Number(option('--frames', 0));
const [facet, models, light, out, ...only] = words;
if (!out) {
    console.error('usage: node khronos.mjs [--renderer gl] [--frames N] FACET MODELS LIGHT.hdr OUT [NAME ..]');
    process.exit(2);
}
const size = 512;
// Model, eye, target (m), and of models that move the time (s) of their first animation. Vertical field of view: 30
// degrees. Without eye the whole model is seen from its front.
const jobs = [
    ['core/WaterBottle', [0.2, 0.2, 0.6], [0, 0, 0]],
    ['core/Avocado', [0, 0.05, 0.15], [0, 0.03, 0]],
    ['core/NormalTangentTest', [0, 0, 8], [0, 0, 0]],
    ['core/AlphaBlendModeTest', [0, 3, 12], [0, 1.5, 0]],
    ['core/NegativeScaleTest', [0, 0, 20], [0, 0, 0]],
    ['core/VertexColorTest', [0, 0, 8], [0, 0, 0]],
    ['core/TextureSettingsTest', [0, 0, 25], [0, 0, 0]],
    ['materials/SpecularTest', [0, 0, 2], [0, 0, 0]],
    ['materials/CompareMetallic', [0, 0.3, 2], [0, 0.1, 0]],
    ['materials/CompareRoughness', [0, 0.3, 2], [0, 0.1, 0]],
    ['lights/PointLightIntensityTest', [0, 2, 12], [0, 1, 0]],
    ['lights/LightsPunctualLamp', [0.3, 0.3, 1.2], [0, 0.2, 0]],
    ['materials/CompareClearcoat'], ['materials/ClearCoatTest'], ['materials/CompareSheen'],
    ['materials/SheenTestGrid'], ['materials/SheenChair'], ['materials/CompareAnisotropy'],
    ['materials/AnisotropyStrengthTest'], ['materials/CompareIridescence'],
    ['materials/IridescenceMetallicSpheres'], ['materials/CompareSpecular'], ['materials/CompareEmissiveStrength'],
    ['materials/CompareTransmission'], ['materials/CompareVolume'], ['materials/CompareIor'],
    ['materials/CompareDispersion'], ['materials/TransmissionRoughnessTest'], ['materials/AttenuationTest'],
    ['materials/DiffuseTransmissionTest'], ['materials/SunglassesKhronos'], ['materials/ToyCar'],
    ['materials/TextureTransformTest'], ['materials/UnlitTest'], ['specgloss/Avocado-specgloss'],
    ['animation/Fox', [150, 90, 250], [0, 35, -10], 0.5], ['animation/SimpleSkin', [0, 1, 6], [0, 1, 0], 1.2],
    ['animation/MorphStressTest', [0, 2, 9], [0, 0.6, 0], 0.8],
    ['animation/AnimatedColorsCube', undefined, undefined, 1],
].map(([model, eye, target, time]) => ({ model: path.join(models, model + '.glb'), name: path.basename(model), time,
    ...(eye ? { eye, target } : from_the_front(path.join(models, model + '.glb'))) }))
    .filter(({ name }) => only.length === 0 || only.includes(name));

function from_the_front(model) {
    const { min, max } = JSON.parse(execFileSync(facet, ['inspect', '--json', model])).bounds;
    const target = min.map((x, i) => (x + max[i]) / 2);
    const reach = Math.max(max[0] - min[0], max[1] - min[1]) / 2;
    return { target, eye: [target[0], target[1], max[2] + 1.05 * reach / Math.tan(15 * Math.PI / 180)] };
}

const page_text = `<!doctype html><canvas id="c" width="${size}" height="${size}"></canvas>
<script src="/node_modules/@khronosgroup/gltf-viewer/dist/libs/libktx.js"></script><script>window.DracoDecoderModule=async()=>({})</script><script type="module">
try {
const { GltfView } = await import('/node_modules/@khronosgroup/gltf-viewer/dist/gltf-viewer.module.js');
const canvas = document.getElementById('c');
const gl = canvas.getContext('webgl2', { alpha: false, antialias: true, preserveDrawingBuffer: true });
const view = new GltfView(gl);
const state = view.createState();
const loader = view.createResourceLoader(undefined, undefined, "/node_modules/@khronosgroup/gltf-viewer/dist/libs/");
// The albedo of the sheen's lobe, which the package comes without: red, over N.V and sheenRoughness. From the
// renderer's own distribution (Estevez and Kulla 2017) and visibility, by the midpoint rule.
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
const pixels = new ImageData(64, 64);
for (let y = 0; y < 64; y++)
    for (let x = 0; x < 64; x++)
        pixels.data.set([Math.round(255 * Math.min(1, sheen_albedo((x + 0.5) / 64, (y + 0.5) / 64))), 0, 0, 255],
            4 * (64 * y + x));
table.getContext('2d').putImageData(pixels, 0, 0);
const lut = table.toDataURL('image/png');
state.environment = await loader.loadEnvironment('/light.hdr', { lut_sheen_E_file: lut });
window.draw = async (job, eye, target, z, time) => {
state.gltf = await loader.loadGltf('/model' + job + '.glb');
state.sceneIndex = state.gltf.scene === undefined ? 0 : state.gltf.scene;
state.cameraIndex = undefined;
state.animationIndices = time === undefined ? [] : [0];
if (time !== undefined) state.animationTimer.setFixedTime(time);
const camera = state.userCamera;
camera.perspective.aspectRatio = 1;
camera.perspective.yfov = 30 * Math.PI / 180;
camera.perspective.znear = z * 0.01;
camera.perspective.zfar = z * 100;
const sub = (a, b) => a.map((x, i) => x - b[i]);
const norm = (a) => { const l = Math.hypot(...a); return a.map((x) => x / l); };
const cross = (a, b) => [a[1]*b[2]-a[2]*b[1], a[2]*b[0]-a[0]*b[2], a[0]*b[1]-a[1]*b[0]];
const back = norm(sub(eye, target)), right = norm(cross([0,1,0], back)), up = cross(back, right);
camera.transform = new Float32Array([...right, 0, ...up, 0, ...back, 0, ...eye, 1]);
const p = state.renderingParameters;
p.renderEnvironmentMap = false;
p.clearColor = [255, 255, 255, 255];
for (let i = 0; i < 4; i++) { view.renderFrame(state, canvas.width, canvas.height); await new Promise(requestAnimationFrame); }
return canvas.toDataURL('image/png');
};
// Median time of a frame, ms. Reading a pixel waits for what was drawn.
window.time_frames = (count) => {
    const times = [], pixel = new Uint8Array(4);
    for (let i = 0; i <= count; i++) {
        const start = performance.now();
        view.renderFrame(state, canvas.width, canvas.height);
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
        if (i > 0) times.push(performance.now() - start);
    }
    return times.sort((a, b) => a - b)[count >> 1];
};
// Mean, median and 95th percentile of the largest channel's difference, in codes of 8 bits, over pixels that either image
// has something on.
window.compare = async (a, b) => {
    const read = async (url) => {
        const image = new Image();
        image.src = url;
        await image.decode();
        const copy = document.createElement('canvas');
        copy.width = copy.height = ${size};
        const context = copy.getContext('2d');
        context.drawImage(image, 0, 0);
        return context.getImageData(0, 0, ${size}, ${size}).data;
    };
    const [x, y] = [await read(a), await read(b)];
    const encoded = [...Array(256).keys()].map((code) => {
        const v = code / 255;
        return 255 * (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4) ** (1 / 2.2);
    });
    const differences = [];
    for (let i = 0; i < x.length; i += 4) {
        const white = (p) => p[i] > 252 && p[i + 1] > 252 && p[i + 2] > 252;
        if (white(x) && white(y)) continue;
        differences.push(Math.max(...[0, 1, 2].map((k) => Math.abs(x[i + k] - encoded[y[i + k]]))));
    }
    differences.sort((p, q) => p - q);
    const sum = differences.reduce((p, q) => p + q, 0);
    return [sum / differences.length, differences[Math.floor(0.5 * differences.length)],
        differences[Math.floor(0.95 * differences.length)]];
};
window.ready = true;
} catch (e) { window.failure = String(e.stack ?? e); }
</script>`;
const { page, close } = await open_page(page_text, (url) =>
    url.startsWith('/model') ? jobs[parseInt(url.slice(6))].model : url === '/light.hdr' ? light : undefined);
try {
    await page.waitForFunction('window.ready || window.failure', null, { timeout: 300000 });
    const failure = await page.evaluate('window.failure');
    if (failure) throw new Error(failure);
    console.log('| model | mean | median | 95 % | FLIP |' + (frames ? ' ms |' : '') + '\n| --- | --- | --- | --- | --- |' + (frames ? ' --- |' : ''));
    for (let i = 0; i < jobs.length; i++) {
        const { model, name, eye, target, time } = jobs[i];
        const z = Math.hypot(...eye.map((x, k) => x - target[k]));
        const theirs = await page.evaluate((all) => window.draw(...all), [i, eye, target, z, time]);
        const theirs_file = path.join(out, `${name}-khronos.png`);
        await writeFile(theirs_file, Buffer.from(theirs.split(',')[1], 'base64'));
        const ours = path.join(out, `${name}-facet.png`);
        execFileSync(facet, ['render', '-q', '--renderer', renderer, '-s', String(size), '-e', light, '--env-rotation=-90', `--eye=${eye}`,
            `--target=${target}`, '--fov=30', ...(time === undefined ? [] : [`--time=${time}`]), model, '-o', ours]);
        const our_url = 'data:image/png;base64,' + (await readFile(ours)).toString('base64');
        const [mean, median, p95] = await page.evaluate(([a, b]) => window.compare(a, b), [theirs, our_url]);
        const { metrics } = JSON.parse(execFileSync(facet, ['compare', ours, theirs_file, '--metric', 'flip', '--json']));
        console.log(`| ${name} | ${mean.toFixed(2)} | ${median.toFixed(1)} | ${p95.toFixed(1)} | ${metrics.flip.toFixed(4)} |` +
            (frames ? ` ${(await page.evaluate((n) => window.time_frames(n), frames)).toFixed(1)} |` : ''));
    }
} finally {
    await close();
}
