// khronos_page.mjs - what khronos.html does for khronos.mjs: the Khronos glTF Sample Renderer with its own environments and
// with those of facet bake, which its KtxDecoder (libktx) loads; and the texels of both.
const dist = '/node_modules/@khronosgroup/gltf-viewer/dist';
const canvas = document.getElementById('canvas');
const gl = canvas.getContext('webgl2', { alpha: false, antialias: true, preserveDrawingBuffer: true });
let view, state, loader, model_name;

// size: texels of its cube maps, down to 2^lowest; lut: of its tables. The sampler has them as constants: 256, 4 and 1024.
window.start = async (size, lowest, lut) => {
    const text = (await (await fetch(`${dist}/gltf-viewer.module.js`)).text())
        .replace('this.textureSize = 256;', `this.textureSize = ${size};`)
        .replace('this.lowestMipLevel = 4;', `this.lowestMipLevel = ${lowest};`)
        .replace('this.lutResolution = 1024;', `this.lutResolution = ${lut};`);
    const { GltfView } = await import(URL.createObjectURL(new Blob([text], { type: 'text/javascript' })));
    view = new GltfView(gl);
    state = view.createState();
    loader = view.createResourceLoader(undefined, undefined, `${dist}/libs/`);
    state.renderingParameters.renderEnvironmentMap = false;
    state.renderingParameters.clearColor = [255, 255, 255, 255];
    state.renderingParameters.environmentRotation = 0;
};

// ---- texels ----

const program = (() => {
    const p = gl.createProgram();
    for (const [type, source] of [[gl.VERTEX_SHADER, `#version 300 es
        void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }`],
    [gl.FRAGMENT_SHADER, `#version 300 es
        precision highp float; precision highp samplerCube; precision highp sampler2D;
        uniform samplerCube cube; uniform sampler2D flat_map; uniform float lod, size; uniform int face; out vec4 color;
        void main() {
            float s = 2.0 * gl_FragCoord.x / size - 1.0, t = 2.0 * gl_FragCoord.y / size - 1.0;
            vec3 d = face == 0 ? vec3(1.0, -t, -s) : face == 1 ? vec3(-1.0, -t, s) : face == 2 ? vec3(s, 1.0, t) :
                face == 3 ? vec3(s, -1.0, -t) : face == 4 ? vec3(s, -t, 1.0) : vec3(-s, -t, -1.0);
            color = face < 6 ? textureLod(cube, d, lod) : textureLod(flat_map, gl_FragCoord.xy / size, lod);
        }`]]) {
        const shader = gl.createShader(type);
        gl.shaderSource(shader, source);
        gl.compileShader(shader);
        if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
        gl.attachShader(p, shader);
    }
    gl.linkProgram(p);
    return p;
})();

function base64(array) {
    const bytes = new Uint8Array(array.buffer);
    let text = '';
    for (let i = 0; i < bytes.length; i += 32768) text += String.fromCharCode(...bytes.subarray(i, i + 32768));
    return btoa(text);
}

// A level of a texture, RGBA floats: six faces of size x size, the upper row first; or a table (is_flat).
function read(texture, lod, size, is_flat) {
    gl.getExtension('EXT_color_buffer_float');
    const type = is_flat ? gl.TEXTURE_2D : gl.TEXTURE_CUBE_MAP, faces = is_flat ? [6] : [0, 1, 2, 3, 4, 5];
    const target = gl.createTexture(), framebuffer = gl.createFramebuffer(), vao = gl.createVertexArray();
    const out = new Float32Array(faces.length * 4 * size * size), u = (name) => gl.getUniformLocation(program, name);
    gl.bindVertexArray(vao);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, target);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, size, size);
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target, 0);
    gl.activeTexture(gl.TEXTURE0 + (is_flat ? 2 : 1));
    gl.bindTexture(type, texture);
    gl.useProgram(program);
    gl.uniform1i(u('cube'), 1);
    gl.uniform1i(u('flat_map'), 2);
    gl.uniform1f(u('lod'), lod);
    gl.uniform1f(u('size'), size);
    gl.viewport(0, 0, size, size);
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    gl.disable(gl.CULL_FACE);
    faces.forEach((face, i) => {
        gl.uniform1i(u('face'), face);
        gl.drawArrays(gl.TRIANGLES, 0, 3);
        gl.readPixels(0, 0, size, size, gl.RGBA, gl.FLOAT, out.subarray(i * 4 * size * size, (i + 1) * 4 * size * size));
    });
    const error = gl.getError();
    if (error) throw new Error(`WebGL's error 0x${error.toString(16)}`);
    gl.bindTexture(type, null);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.bindVertexArray(null);
    gl.deleteVertexArray(vao);
    gl.deleteFramebuffer(framebuffer);
    gl.deleteTexture(target);
    return base64(out);
}

const slots = { ggx: 'specularEnvMap', charlie: 'sheenEnvMap', lambert: 'diffuseEnvMap', lut_ggx: 'lut', lut_charlie: 'sheenLUT' };
const texture_of = (environment, slot) => environment.textures[environment[slots[slot]].index];
window.read_own = (slot, lod, size) => read(texture_of(own, slot).glTexture ?? own.images[texture_of(own, slot).source].image,
    lod, size, slot.startsWith('lut'));

// ---- environments ----

let own, facets;
window.filter = async (panorama, lut_sheen_E) => {
    const start = performance.now();
    own = await loader.loadEnvironment(`/work/${panorama}`, { lut_sheen_E_file: `/work/${lut_sheen_E}` });
    gl.finish();
    read(own.images[texture_of(own, 'ggx').source].image, 0, 1);
    return { levels: own.mipCount, scale: own.iblIntensityScale, ms: performance.now() - start };
};

const files = new Map();
// By libktx. levels: that the file has.
window.load = async (name, levels, is_flat) => {
    const texture = await view.ktxDecoder.loadKtxFromUri(`/work/${name}`);
    if (!texture) return false;
    const type = is_flat ? gl.TEXTURE_2D : gl.TEXTURE_CUBE_MAP;
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(type, texture);
    gl.texParameteri(type, gl.TEXTURE_MIN_FILTER, levels > 1 ? gl.LINEAR_MIPMAP_LINEAR : gl.LINEAR);
    gl.texParameteri(type, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
    gl.texParameteri(type, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(type, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    gl.texParameteri(type, gl.TEXTURE_MAX_LEVEL, levels - 1);
    files.set(name, texture);
    return true;
};
window.read_file = (name, lod, size, is_flat) => read(files.get(name), lod, size, is_flat);

// The viewer's environment with facet's files in the places of its own textures. { slot: name, .. }
window.replace = (names, levels) => {
    facets = Object.assign(Object.create(Object.getPrototypeOf(own)), own, { textures: own.textures.slice(), mipCount: levels });
    for (const [slot, name] of Object.entries(names)) {
        const texture = texture_of(own, slot);
        facets.textures[own[slots[slot]].index] = Object.assign(Object.create(Object.getPrototypeOf(texture)), texture,
            { glTexture: files.get(name), initialized: true });
    }
};

// A row of count spheres, size pixels each, from far away.
async function draw(model, is_facet, count, size) {
    canvas.width = count * size;
    canvas.height = size;
    state.environment = is_facet ? facets : own;
    if (model_name !== model) {
        state.gltf = await loader.loadGltf(`/work/${model}`);
        model_name = model;
    }
    state.sceneIndex = state.gltf.scene ?? 0;
    state.cameraIndex = undefined;
    state.animationIndices = [];
    const camera = state.userCamera, distance = 40, middle = (count - 1) / 2;
    camera.perspective.aspectRatio = count;
    camera.perspective.yfov = 2 * Math.atan(0.5 / distance);
    camera.perspective.znear = 1;
    camera.perspective.zfar = 100;
    camera.transform = new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, middle, 0, distance, 1]);
    for (let i = 0; i < 2; i++) {
        view.renderFrame(state, canvas.width, canvas.height);
        await new Promise(requestAnimationFrame);
    }
}
// Bytes, RGB.
window.draw = async (model, is_facet, count, size) => {
    await draw(model, is_facet, count, size);
    const bytes = new Uint8Array(4 * count * size * size);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.readPixels(0, 0, count * size, size, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    return [...bytes].filter((_, i) => i % 4 < 3);
};
window.picture = async (...args) => {
    await draw(...args);
    return canvas.toDataURL('image/png');
};
window.ready = true;
