// tools.mjs FACET DIST WORK [MODEL...] - the package's functions for Node.js beside the native command: same bytes, same sentences.
// PNG has the same pixels: the package compresses with zlib, the native command with libdeflate where it is.
// Where only the C libraries' elementary functions differ, numbers may differ in their last digits.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { cpSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { basename, dirname, join } from 'node:path';
import { pathToFileURL } from 'node:url';

const [facet, dist, work, ...models] = process.argv.slice(2);
globalThis.fetch = () => {
    throw new Error('the package asks the network for something');
};
const { loadTools, readFolder, writeFiles, FacetError } = await import(pathToFileURL(join(dist, 'facet-viewer/node.js')));
const tools = await loadTools();

const QUAD = {
    'quad/quad.obj': 'mtllib quad.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n'
        + 'usemtl gold\nf 1/1/1 2/2/1 3/3/1\nusemtl glass\nf 1/1/1 3/3/1 4/4/1\n',
    'quad/quad.mtl': 'newmtl gold\nKd 0.8 0.6 0.2\nKs 0.9 0.8 0.5\nNs 80\nnewmtl glass\nKd 0 0 0\nKs 1 1 1\nNs 400\nNi 1.5\nd 0.3\nillum 4\n',
};

// ---- the native command in a folder of its own ----

let folders = 0;

function native(args, files = {}, input = undefined) {
    const folder = join(work, `native-${folders++}`);
    mkdirSync(folder);
    for (const [path, bytes] of Object.entries(files)) {
        mkdirSync(dirname(join(folder, path)), { recursive: true });
        writeFileSync(join(folder, path), bytes);
    }
    const { status, stdout, stderr } = spawnSync(facet, args, { cwd: folder, input, maxBuffer: 1 << 28 });
    return { code: status, stdout: stdout.toString(), stdoutBytes: stdout, stderr: stderr.toString(), read: (path) => readFileSync(join(folder, path)), folder };
}

// What differs from run to run.
const steady = (text) => text.replace(/"(seconds|peak_memory_bytes|peak_data_bytes)": *[-0-9.e+]+/g, '"$1": 0');

// Whether a file of the package is the native command's, which is in its folder.
function isSame(bytes, path, { read, folder }) {
    if (Buffer.from(bytes).equals(read(path))) return true;
    if (!path.endsWith('.png')) return false;
    writeFileSync(join(folder, 'package.png'), bytes);
    return spawnSync(facet, ['compare', 'package.png', path, '--max', 'max=0', '-q'], { cwd: folder }).status === 0;
}

// Both commands: same exit code, messages and standard output; the same files, byte for byte but for PNG.
async function assertSame(args, files = {}) {
    const [here, there] = [await tools.run(args, files), native(args, files)];
    const what = `facet ${args.join(' ')}`;
    assert.equal(here.stderr, there.stderr, what);
    assert.equal(here.code, there.code, what);
    assert.equal(steady(here.stdout), steady(there.stdout), what);
    for (const [path, bytes] of Object.entries(here.files)) {
        assert.ok(isSame(bytes, path, there), `${what}: ${path} has other bytes`);
    }
    rmSync(there.folder, { recursive: true });
    return here;
}

// Numbers of two texts, which are equal but for these.
function assertNear(a, b, tolerance, what) {
    const NUMBER = /-?\d+(?:\.\d+)?(?:e[-+]?\d+)?/g;
    assert.equal(a.replace(NUMBER, '#'), b.replace(NUMBER, '#'), what);
    const [x, y] = [a, b].map((text) => (text.match(NUMBER) ?? []).map(Number));
    const largest = Math.max(...x.map(Math.abs));
    x.forEach((value, i) => assert.ok(Math.abs(value - y[i]) <= tolerance * Math.max(Math.abs(value), 1e-3 * largest), `${what}: ${value} and ${y[i]}`));
}

// ---- tests ----

async function testModels() {
    const builtin = native(['convert', 'quad/quad.obj', 'quad.glb'], QUAD);
    const all = [{ 'quad.glb': builtin.read('quad.glb') }, ...models.map((path) => ({ [basename(path)]: readFileSync(path) }))];
    for (const files of all) {
        const [path] = Object.keys(files);
        await assertSame(['inspect', path], files);
        await assertSame(['inspect', path, '--json'], files);
        for (const output of ['out.glb', 'out.gltf', 'new/out.obj']) {
            const { files: made } = await assertSame(['convert', path, output], files);
            assert.ok(output in made && !(path in made), 'the new files, without those that were given');
        }
    }
    await assertSame(['inspect', 'quad', '--json'], QUAD);
    await assertSame(['convert', 'quad/quad.obj', 'a.glb', '--method', 'fit', '--glass', '--report', 'report.json'], QUAD);
}

async function testFunctions() {
    const { files, warnings } = await tools.convert(QUAD, 'quad/quad.obj', { output: 'quad.glb', profile: 'core' });
    assert.deepEqual(Object.keys(files), ['quad.glb']);
    assert.ok(Array.isArray(warnings));
    const info = await tools.inspect(files, 'quad.glb');
    assert.equal(info.counts.materials, 2);
    assert.equal(info.source, 'quad.glb');
    assert.equal(`facet ${await tools.version()}`, native(['version']).stdout.trim());
    const over = await tools.run(['convert', 'quad.glb', 'quad.glb'], files);
    assert.ok(over.code === 0 ? 'quad.glb' in over.files : over.files['quad.glb'] === undefined, over.stderr);
    const kept = await tools.run(['convert', 'quad/quad.obj', 'quad.glb', '--no-clobber'], { ...QUAD, ...files });
    assert.deepEqual([kept.code, kept.files], [0, {}]);
    const backwards = await tools.run(['convert', '-', '-o', 'b.obj'], {}, { stdin: files['quad.glb'] });
    assert.equal(backwards.code, 0, backwards.stderr);
    assert.ok('b.mtl' in backwards.files);
}

function jsonOfGlb(bytes) {
    const length = new DataView(bytes.buffer, bytes.byteOffset).getUint32(12, true);
    return { json: JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + length))), rest: Buffer.from(bytes.subarray(20 + length)) };
}

// Edited materials are in the saved file, and nothing else is different: of a .glb, of a .gltf with files, of an OBJ file.
async function testSave() {
    const edit = { pbrMetallicRoughness: { roughnessFactor: 0.125, baseColorFactor: [0.5, 0.25, 1, 1] }, extensions: { KHR_materials_clearcoat: { clearcoatFactor: 0.75 } } };
    const glb = native(['convert', 'quad/quad.obj', 'quad.glb'], QUAD).read('quad.glb');
    const before = jsonOfGlb(glb);
    const saved = await tools.save({ 'm/quad.glb': glb }, 'm/quad.glb', { 1: edit });
    const after = jsonOfGlb(saved);
    assert.deepEqual(after.rest, before.rest, 'the binary chunk is the same');
    assert.equal(after.json.materials[1].pbrMetallicRoughness.roughnessFactor, 0.125);
    assert.equal(after.json.materials[1].extensions.KHR_materials_clearcoat.clearcoatFactor, 0.75);
    assert.ok(after.json.extensionsUsed.includes('KHR_materials_clearcoat'));
    const { materials: [plain], extensionsUsed, ...others } = after.json;
    const { materials: [plainBefore], extensionsUsed: usedBefore, ...othersBefore } = before.json;
    assert.deepEqual([plain, others], [plainBefore, othersBefore]);
    assert.ok((usedBefore ?? []).every((name) => extensionsUsed.includes(name)));
    const [here, there] = [await tools.inspect({ 'a.glb': saved }, 'a.glb'), await tools.inspect({ 'a.glb': glb }, 'a.glb')];
    assert.equal(here.materials[1].pbrMetallicRoughness?.roughnessFactor ?? here.materials[1].roughness, 0.125);
    assert.deepEqual([here.counts, here.meshes, here.materials[0]], [there.counts, there.meshes, there.materials[0]]);
    assert.deepEqual(jsonOfGlb(await tools.save(QUAD, 'quad/quad.obj', { 1: edit })).json.materials[1], after.json.materials[1]);
    const null1 = jsonOfGlb(await tools.save({ 'a.glb': saved }, 'a.glb', { 1: { extensions: { KHR_materials_clearcoat: null } } })).json;
    assert.equal(null1.materials[1].extensions?.KHR_materials_clearcoat, undefined, 'null removes');
    await testSaveOfFiles(edit);
    await assert.rejects(tools.save({ 'a.glb': glb }, 'a.glb', { 7: edit }), /a\.glb: there is no material 7; it has 2/);
    await assert.rejects(tools.save({ 'a.glb': glb }, 'a.glb', { 0: { pbrMetallicRoughness: { roughnessFactor: 'x' } } }), /a\.glb: .*roughnessFactor/);
    await assert.rejects(tools.save({ 'a.glb': glb.subarray(0, 40) }, 'a.glb'), /a\.glb: /);
}

// A .gltf with buffer and images: the .glb has the same meshes and images.
async function testSaveOfFiles(edit) {
    const path = models.find((model) => model.endsWith('WaterBottle.glb'));
    const files = path ? { 'a.glb': readFileSync(path) } : { 'a.glb': native(['convert', 'quad/quad.obj', 'quad.glb'], QUAD).read('quad.glb') };
    const { files: loose } = await tools.convert(files, 'a.glb', { output: 'in/a.gltf' });
    const [whole, packed] = [await tools.inspect(files, 'a.glb'), await tools.inspect({ 'a.glb': await tools.save(loose, 'in/a.gltf') }, 'a.glb')];
    for (const name of ['counts', 'meshes', 'images', 'materials', 'bounds']) assert.deepEqual(packed[name], whole[name], name);
    const edited = jsonOfGlb(await tools.save(loose, 'in/a.gltf', { 0: edit })).json;
    assert.equal(edited.materials[0].pbrMetallicRoughness.roughnessFactor, 0.125);
    assert.equal(edited.buffers.length, 1);
    assert.ok((edited.images ?? []).every((image) => image.uri === undefined && image.mimeType));
    await assert.rejects(tools.save({ 'a.gltf': loose['in/a.gltf'] }, 'a.gltf'), /a\.gltf: buffer 0: there is no file a\.bin/);
}

function halves(bytes) {
    const view = new Uint16Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + (bytes.length & ~1)));
    return view;
}

// Tables are equal; a sky evaluates exp() and sin(), whose last bits differ between C libraries: a texel differs by one step of half.
async function testBake() {
    await assertSame(['bake', '--dfg', '-o', 'dfg.ktx2', '--size', '32']);
    await assertSame(['bake', '--dfg', '-o', 'dfg.png', '--size', '32']);
    const args = ['bake', 'sun:45,135', '-o', 'sky.ktx2', '--size', '32', '--diffuse', 'diffuse.ktx2', '--sh', 'sh.json'];
    const { files } = await tools.bake({}, 'sun:45,135', { output: 'sky.ktx2', size: 32, diffuse: 'diffuse.ktx2', sh: 'sh.json' });
    const there = native(args);
    for (const path of ['sky.ktx2', 'diffuse.ktx2']) {
        const [a, b] = [halves(files[path]), halves(there.read(path))];
        assert.equal(a.length, b.length, path);
        let different = 0;
        a.forEach((half, i) => {
            assert.ok(Math.abs(half - b[i]) <= 1, `${path}: half ${i} is ${half}, natively ${b[i]}`);
            different += half !== b[i];
        });
        assert.ok(different < 0.001 * a.length, `${path}: ${different} of ${a.length} halves differ`);
    }
    assertNear(new TextDecoder().decode(files['sh.json']), there.read('sh.json').toString(), 1e-5, 'sh.json');
    // a panorama in a file, in several layouts
    const sky = native(['bake', 'sun:45,135', '-o', 'sky', '--size', '32', '--layout', 'three']);
    assert.equal(sky.code, 0, sky.stderr);
    const hdr = { 'light.hdr': sky.read('sky/environment.hdr') };
    await assertSame(['bake', 'light.hdr', '-o', 'out.ktx2', '--size', '16', '--format', 'rgb9e5', '--zstd', '9'], hdr);
    await assertSame(['bake', 'light.hdr', '-o', 'out', '--size', '16', '--layout', 'filament'], hdr);
}

async function testImages() {
    const shot = (ev) => native(['render', '--size', '32', '--samples', '1', '--exposure', ev, '-o', 'a.png']).read('a.png');
    const files = { 'a.png': shot('0'), 'b.png': shot('0.5') };
    await assertSame(['compare', 'a.png', 'b.png'], files);
    await assertSame(['compare', 'a.png', 'b.png', '-o', 'difference.png', '--heat-map', '--sheet'], files);
    const { metrics } = await tools.compare(files, 'a.png', 'a.png');
    assert.equal(metrics.flip, 0);
    const failed = await tools.compare(files, 'a.png', 'b.png', { max: 'flip=0.0001' });
    assert.equal(failed.passed, false, 'a limit that is passed is an answer, no error');
}

async function testPlots() {
    for (const kind of ['brdf', 'slice', 'albedo', 'fresnel', 'terms', 'tone', 'legacy']) {
        const args = ['plot', kind, '-o', '-', '--format', 'csv'];
        const [here, there] = [await tools.run(args), native(args)];
        assertNear(here.stdout, there.stdout, 1e-6, args.join(' '));
    }
    const { svg, fits } = await tools.plot('slice', ['roughness=0.4', 'ogl1,shininess=30'], { fit: true, size: '400x300' });
    assert.match(svg, /^<svg [^>]*width="400" height="300"/);
    assert.ok((svg.match(/<path /g) ?? []).length > 10 && svg.includes('>angle of the light, degrees</text>'));
    assert.deepEqual(fits.map(({ model }) => model), ['ogl1', 'pbr']);
    const data = await tools.plotData('slice', ['roughness=0.4'], { angle: 20 });
    const csv = native(['plot', 'slice', 'roughness=0.4', '--angle', '20', '-o', '-', '--format', 'csv']).stdout.trim().split('\n').at(-1);
    const last = data.panels[0].curves.map(({ y }) => y.at(-1));
    assertNear(`${data.panels[0].curves[0].x.at(-1)},${last.join(',')}`, csv, 1e-6, 'plotData');
    assert.deepEqual(data.panels[0].x.range, [-90, 90]);
    assert.ok(data.panels[0].plot[2] > 100, 'the place of the panel');
}

// The promise is rejected with a sentence, not with an error of JavaScript.
const refuses = (promise, expected) => assert.rejects(promise, (error) => {
    assert.ok(error instanceof FacetError, String(error.stack));
    assert.match(error.message, expected);
    return true;
});

async function testRefusals() {
    for (const words of [['nonsense'], ['inspect', 'no.glb'], ['convert', 'quad/quad.obj'], ['convert', 'quad/quad.obj', 'a.xyz'],
        ['bake', 'no.hdr', '-o', 'a.ktx2'], ['plot', 'brdf', 'roughness=2', '-o', 'a.csv'], ['help', 'bake'], ['help', '--max-memory']]) {
        await assertSame(words, QUAD);
    }
    const glb = native(['convert', 'quad/quad.obj', 'quad.glb'], QUAD).read('quad.glb');
    await assertSame(['inspect', 'cut.glb'], { 'cut.glb': glb.subarray(0, glb.length / 2) });
    await assertSame(['inspect', 'bad.gltf'], { 'bad.gltf': '{"asset":{"version":"2.0"},"meshes":[{}]' });
    await refuses(tools.inspect({ 'bad.gltf': '{' }, 'bad.gltf'), /^bad\.gltf: /);
    await refuses(tools.inspect({ '../up.gltf': '{}' }, '../up.gltf'), /relative/);
    await refuses(tools.inspect({ 'a.gltf': 5 }, 'a.gltf'), /Uint8Array/);
    await refuses(tools.convert(QUAD, 'quad/quad.obj', { output: 'a.glb', nonsense: true }), /--nonsense/);
    const drawn = await tools.run(['render', '-o', 'a.png']);
    assert.equal(drawn.code, 5);
    assert.match(drawn.stderr, /WebAssembly has no renderer for the CPU/);
    assert.equal((await tools.run(['render', '--size', 'x'])).code, 2, 'its options are checked all the same');
}

// Arguments of a wrong type, and files that have no place.
async function testArguments() {
    await refuses(tools.run('inspect'), /^args: an array/);
    await refuses(tools.run([Object.create(null)]), /^args\[0\]: a string/);
    await refuses(tools.run(['inspect', 'a'], null), /^files: an object/);
    await refuses(tools.run(['inspect', 'a'], { a: 'x', 'a/b': 'y' }), /^a\/b: .*as a file and as a folder/);
    await refuses(tools.inspect(QUAD, 'quad/quad.obj', null), /^options: an object/);
    await refuses(tools.inspect(QUAD, 'quad/quad.obj', { maxTexture: {} }), /^maxTexture: a string/);
    await refuses(tools.inspect(QUAD), /a string/);
    const deep = `${'d/'.repeat(400)}a.obj`, start = performance.now();
    await refuses(tools.run(['inspect', deep], { [deep]: 'v 0 0 0' }), /^d\/.*at most 63 folders/);
    await refuses(tools.convert(QUAD, 'quad/quad.obj', { output: deep }), /at most 63 folders/);
    assert.ok(performance.now() - start < 1000, 'deep names take time');
    // nothing is left outside of the folder of a run
    for (const output of ['/tmp/a.glb', '../a.glb', '/dev/shm/a.glb', '/new/a.glb']) {
        const { code, stderr, files } = await tools.run(['convert', 'quad/quad.obj', '-o', output], QUAD);
        assert.deepEqual([code, files], [6, {}], output);
        assert.match(stderr, /cannot be written to: Permission denied/);
    }
    await refuses(tools.convert(QUAD, 'quad/quad.obj', { output: '__proto__/a.glb' }), /cannot have the name __proto__/);
}

const gltf = (members) => ({ 'm/a.gltf': JSON.stringify({ asset: { version: '2.0' }, ...members }), 'm/b.bin': new Uint8Array(8) });

// Edits that are none, and files that are broken.
async function testSaveRefusals() {
    const glb = native(['convert', 'quad/quad.obj', 'quad.glb'], QUAD).read('quad.glb');
    const save = (edits) => tools.save({ 'a.glb': glb }, 'a.glb', edits);
    for (const key of ['-1', '0.5', ' 0', '', '0x0', '00', '2', '__proto__']) {
        await refuses(save(Object.defineProperty({}, key, { value: {}, enumerable: true })), /^a\.glb: there is no material .*; it has 2/);
    }
    for (const edits of [5, 'x', null, [{}]]) await refuses(save(edits), /^a\.glb: edits: an object/);
    await refuses(save({ 0: 5 }), /material 0: a part/);
    await refuses(save({ 0: { alphaCutoff: NaN } }), /material 0\.alphaCutoff: number NaN has no place in JSON/);
    await refuses(save({ 0: { alphaCutoff: 1n } }), /material 0\.alphaCutoff: bigint 1/);
    const cyclic = {};
    cyclic.extras = cyclic;
    await refuses(save({ 0: cyclic }), /nested more than 32 times/);

    // a member "__proto__" stays a member
    const bytes = await save({ 0: JSON.parse('{"extras": {"__proto__": {"polluted": "yes"}}, "__proto__": {"polluted": "yes"}}') });
    assert.equal({}.polluted, undefined, 'an edit reached Object.prototype');
    assert.ok(Object.hasOwn(jsonOfGlb(bytes).json.materials[0].extras, '__proto__'));

    for (const [members, expected] of [
        [{ buffers: [{ uri: 'toString', byteLength: 8 }] }, /buffer 0: there is no file toString/],
        [{ buffers: [{ uri: 5, byteLength: 8 }] }, /buffer 0: uri: a string/],
        [{ buffers: [{ uri: 'b.bin', byteLength: 9 }] }, /buffer 0: 9 bytes were expected, its file has 8/],
        [{ buffers: [{ uri: 'b.bin', byteLength: 'x' }] }, /buffer 0: byteLength: an integer/],
        [{ buffers: [{ uri: 'data:text/plain,%', byteLength: 1 }] }, /a data URI cannot be decoded/],
        [{ buffers: 'abc' }, /buffers: an array/],
        [{ buffers: [null] }, /buffers\[0\]: an object/],
        [{ bufferViews: [{ buffer: 'length', byteLength: 1 }] }, /bufferView 0: buffer: an integer/],
        [{ bufferViews: [{ buffer: 3, byteLength: 1 }] }, /bufferView 0: there is no buffer 3/],
        [{ buffers: [{ uri: 'b.bin', byteLength: 8 }], bufferViews: [{ buffer: 0, byteOffset: '4', byteLength: 1 }] }, /bufferView 0: byteOffset/],
        [{ images: [null] }, /images\[0\]: an object/],
        [{ materials: 5 }, /materials: an array/],
        [{ extensionsUsed: 5 }, /extensionsUsed: an array/],
    ]) await refuses(tools.save(gltf(members), 'm/a.gltf'), new RegExp(`^m/a\\.gltf: ${expected.source}`));
    await refuses(tools.save({ 'a.gltf': `{"asset": ${'['.repeat(1e5)}${']'.repeat(1e5)}}` }, 'a.gltf'), /^a\.gltf: /);
    await refuses(tools.save({}, 'toString'), /toString: there is no such file/);
}

// Models of several files from a folder of the disk, and back.
async function testFolders() {
    const [from, to] = [join(work, 'from'), join(work, 'to')];
    await writeFiles(from, QUAD);
    const files = await readFolder(from);
    assert.deepEqual(Object.keys(files).sort(), ['quad/quad.mtl', 'quad/quad.obj']);
    assert.deepEqual(Object.keys(await readFolder(from, (path) => path.endsWith('.mtl'))), ['quad/quad.mtl']);
    await writeFiles(to, (await tools.convert(files, 'quad/quad.obj', { output: 'new/quad.gltf' })).files);
    const { files: again } = await tools.convert(await readFolder(to), 'new/quad.gltf', { output: 'quad.glb' });
    assert.ok(Buffer.from(again['quad.glb']).equals(native(['convert', 'quad/quad.obj', 'quad.glb'], QUAD).read('quad.glb')));
}

// The README's program, with the package where npm puts it.
async function testReadme() {
    const element = new URL('../../web/element/', import.meta.url), folder = join(work, 'project'), root = join(folder, 'node_modules/facet-viewer');
    cpSync(join(dist, 'facet-viewer'), root, { recursive: true });
    cpSync(new URL('package.json', element), join(root, 'package.json'));
    const [, program] = readFileSync(new URL('README.md', element), 'utf8').match(/```js\n([^]*?)```/);
    writeFileSync(join(folder, 'program.mjs'), program);
    await writeFiles(join(folder, 'models'), { 'chair.obj': QUAD['quad/quad.obj'].replace('quad.mtl', 'chair.mtl'), 'chair.mtl': QUAD['quad/quad.mtl'] });
    const { status, stdout, stderr } = spawnSync(process.execPath, ['program.mjs'], { cwd: folder, encoding: 'utf8' });
    assert.equal(status, 0, stderr);
    assert.match(stdout, /^2 materials\n/);
    assert.deepEqual(jsonOfGlb(readFileSync(join(folder, 'out/red.glb'))).json.materials[0].pbrMetallicRoughness.baseColorFactor, [0.8, 0.1, 0.1, 1]);
    assert.deepEqual(Object.keys(await readFolder(join(folder, 'out'))).sort(), ['chair.glb', 'red.glb']);
}

// npx facet: files of the disk, also of other folders, with the output and the exit codes of the native command.
async function testCommand() {
    const folder = join(work, 'command'), models = join(work, 'command-models'), here = join(dist, 'facet-viewer/facet.js');
    mkdirSync(folder);
    await writeFiles(models, QUAD);
    const both = (...args) => [[process.execPath, here], [facet]].map(([program, ...first]) => spawnSync(program, [...first, ...args], { cwd: folder, encoding: 'utf8' }));
    for (const args of [['inspect', '../command-models/quad/quad.obj'], ['inspect', 'nothing.glb'], ['inspect', join(models, 'quad/quad.obj'), '--json']]) {
        const [node, own] = both(...args);
        assert.equal(node.stderr, own.stderr, args.join(' '));
        assert.equal(steady(node.stdout), steady(own.stdout), args.join(' '));
        assert.equal(node.status, own.status);
    }
    const [, own] = ['node.glb', 'own.glb'].map((name, i) => both('convert', '../command-models/quad/quad.obj', '-q', `--output=${name}`)[i]);
    assert.equal(own.status, 0, own.stderr);
    assert.ok(readFileSync(join(folder, 'node.glb')).equals(readFileSync(join(folder, 'own.glb'))), 'another model');
    const [image] = both('render', 'own.glb', '-o', 'own.png');
    assert.ok(image.status > 0 && /no renderer for the CPU/.test(image.stderr), image.stderr);
}

// The module's memory is reused: runs do not add up.
async function testManyRuns() {
    const before = process.memoryUsage().arrayBuffers;
    for (let i = 0; i < 200; i++) await tools.run(['convert', 'quad/quad.obj', 'a.glb'], QUAD);
    const grown = process.memoryUsage().arrayBuffers - before;
    assert.ok(grown < 32 << 20, `200 runs left ${grown} bytes`);
    const runs = await Promise.all([1, 2, 3].map((i) => tools.run(['convert', 'quad/quad.obj', `${i}.glb`], QUAD)));
    assert.deepEqual(runs.map(({ files }) => Object.keys(files)), [['1.glb'], ['2.glb'], ['3.glb']], 'calls at the same time wait for each other');
}

for (const test of [testModels, testFunctions, testSave, testBake, testImages, testPlots, testRefusals, testArguments, testSaveRefusals, testFolders, testReadme, testCommand, testManyRuns]) {
    const start = performance.now();
    await test();
    console.log(`tools: ${test.name.replace(/^test/, '').toLowerCase()} ${((performance.now() - start) / 1000).toFixed(1)} s`);
}
