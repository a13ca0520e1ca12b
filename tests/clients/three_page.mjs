// three_page.mjs - what three.html does for three.mjs: loads files by three.js' own loaders, and reports what its shaders read.
import * as THREE from 'three';
import { HDRLoader } from 'three/addons/loaders/HDRLoader.js';
import { KTX2Loader } from 'three/addons/loaders/KTX2Loader.js';
import { LightProbeGenerator } from 'three/addons/lights/LightProbeGenerator.js';
import { cube_of, environment_of } from './three_cube.mjs';

const renderer = new THREE.WebGLRenderer({ canvas: document.getElementById('canvas'), antialias: true, preserveDrawingBuffer: true });
const loader = new KTX2Loader().setTranscoderPath('/node_modules/three/examples/jsm/libs/basis/').detectSupport(renderer);
const textures = new Map();

function base64(array) {
    const bytes = new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
    let text = '';
    for (let i = 0; i < bytes.length; i += 32768) text += String.fromCharCode(...bytes.subarray(i, i + 32768));
    return btoa(text);
}

window.load = async (name) => {
    const texture = await loader.loadAsync(`/work/${name}`);
    const what = { type: texture.constructor.name, levels: texture.mipmaps.length };
    textures.set(name, cube_of(texture));
    return what;
};

// ---- what a shader sees ----

const sampler = new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    uniforms: { map: { value: null }, lod: { value: 0 }, size: { value: 1 }, face: { value: 0 }, reach: { value: 1 }, x: { value: 1 } },
    vertexShader: 'in vec3 position; void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }',
    fragmentShader: `precision highp float; precision highp samplerCube;
        uniform samplerCube map; uniform float lod, size, reach, x; uniform int face; out vec4 color;
        void main() {
            vec2 p = (2.0 * gl_FragCoord.xy / size - 1.0) * reach;
            float s = p.x, t = p.y;
            vec3 d = face == 0 ? vec3(1.0, -t, -s) : face == 1 ? vec3(-1.0, -t, s) : face == 2 ? vec3(s, 1.0, t) :
                face == 3 ? vec3(s, -1.0, -t) : face == 4 ? vec3(s, -t, 1.0) : vec3(-s, -t, -1.0);
            color = textureLod(map, vec3(x * d.x, d.y, d.z), lod);
        }`,
    depthTest: false,
});
const screen = new THREE.Mesh(new THREE.BufferGeometry().setAttribute('position',
    new THREE.Float32BufferAttribute([-1, -1, 0, 3, -1, 0, -1, 3, 0], 3)), sampler);
screen.frustumCulled = false;

// size x size directions of each face, at the middles of texels of that size, scaled by reach; RGBA floats. Row 0 is the face's
// upper one (t = -1).
function sample(map, lod, size, reach = 1, mirror = 1) {
    const target = new THREE.WebGLRenderTarget(size, size, { type: THREE.FloatType, depthBuffer: false });
    const out = new Float32Array(6 * 4 * size * size), u = sampler.uniforms;
    u.map.value = map;
    u.lod.value = lod;
    u.size.value = size;
    u.reach.value = reach;
    u.x.value = mirror;
    for (let face = 0; face < 6; face++) {
        u.face.value = face;
        renderer.setRenderTarget(target);
        renderer.render(screen, new THREE.Camera());
        renderer.readRenderTargetPixels(target, 0, 0, size, size, out.subarray(face * 4 * size * size, (face + 1) * 4 * size * size));
    }
    renderer.setRenderTarget(null);
    target.dispose();
    return out;
}
window.sample = (name, lod, size, reach, mirror) => base64(sample(textures.get(name), lod, size, reach, mirror));

// ---- three.js' own filtering ----

let panorama;
window.load_panorama = async (name) => {
    panorama = await new HDRLoader().setDataType(THREE.FloatType).loadAsync(`/work/${name}`);
    panorama.mapping = THREE.EquirectangularReflectionMapping;
    panorama.minFilter = panorama.magFilter = THREE.LinearFilter;
    const generator = new THREE.PMREMGenerator(renderer);
    const start = performance.now(), target = generator.fromEquirectangular(panorama);
    sample(target.texture, 0, 1);
    textures.set('pmrem', target.texture);
    return { levels: target.texture.mipmaps.length, size: target.width, ms: performance.now() - start };
};
window.roughness_of = (level, count) => THREE.PMREMGenerator.lodToRoughness(level, count - 1);

// Coefficients [9][3] as three.js projects the panorama itself, from a cube map of size x size.
window.generate_probe = async (size) => {
    const target = new THREE.WebGLCubeRenderTarget(size, { type: THREE.FloatType });
    target.fromEquirectangularTexture(renderer, panorama);
    const probe = await LightProbeGenerator.fromCubeRenderTarget(renderer, target);
    return probe.sh.coefficients.map((c) => [c.x, c.y, c.z]);
};

// Runs lines of documentation as they stand; files are those of the folder at /work/FOLDER. Returns the light
// probes of the scene that they made, or the error.
window.run_documentation = async (code, folder) => {
    const scene = new THREE.Scene(), names = { ...THREE, KTX2Loader, renderer, scene };
    const located = code.replaceAll(/'([a-z_]+\.(ktx2|json))'/g, `'/work/${folder}/$1'`);
    try {
        await new Function(...Object.keys(names), `return (async () => {${located}\n})();`)(...Object.values(names));
    } catch (error) {
        return String(error);
    }
    environment = scene.environment;
    return scene.children.filter((child) => child.isLightProbe).map(({ sh }) => sh.coefficients.map((c) => [c.x, c.y, c.z]));
};

// ---- pictures: rows of spheres, metallic and rough from 0 to 1, and one of white plaster ----

let environment;
window.load_environment = async (name, is_mirrored) => { environment = environment_of(await loader.loadAsync(`/work/${name}`), is_mirrored); };
function draw(which, count, size) {
    const scene = new THREE.Scene(), camera = new THREE.OrthographicCamera(-0.5, count - 0.5, 0.5, -0.5, 0.1, 10);
    camera.position.z = 5;
    renderer.setSize(count * size, size, false);
    renderer.toneMapping = THREE.NeutralToneMapping;
    renderer.setClearColor(0xffffff, 1);
    if (which.probe) {
        const probe = new THREE.LightProbe();
        probe.sh.set(which.probe.map((c) => new THREE.Vector3(...c)));
        scene.add(probe);
    } else scene.environment = which.is_facet ? environment : panorama;
    const geometry = new THREE.SphereGeometry(0.46, 96, 64);
    for (let i = 0; i < count; i++) {
        const is_plaster = which.probe || i === count - 1;
        const sphere = new THREE.Mesh(geometry, new THREE.MeshStandardMaterial({ color: 0xffffff, metalness: is_plaster ? 0 : 1,
            roughness: is_plaster ? 1 : i / (count - 2) }));
        sphere.position.x = i;
        scene.add(sphere);
    }
    renderer.render(scene, camera);
}
// Bytes, RGB, of each picture.
window.draw_all = (pictures, count, size) => pictures.map((which) => {
    draw(which, count, size);
    const gl = renderer.getContext(), bytes = new Uint8Array(4 * count * size * size);
    gl.readPixels(0, 0, count * size, size, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    return [...bytes].filter((_, i) => i % 4 < 3);
});
window.draw = (which, count, size) => {
    draw(which, count, size);
    return renderer.domElement.toDataURL('image/png');
};
window.ready = true;
