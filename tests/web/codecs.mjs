// codecs.mjs - decoders as modules (web/element/codecs.js) beside the native command. usage: codecs.mjs FACET DIST WORK DATA
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';

const [facet, dist, work, data] = process.argv.slice(2);
const top = path.join(path.dirname(fileURLToPath(import.meta.url)), '../..');
const element = (file) => path.join(dist, 'facet-viewer', file);
const { loadTools } = await import(pathToFileURL(element('node.js')));
const { Codecs } = await import(pathToFileURL(element('codecs.js')));

// The native command in the folder work: exit code, sentence, and a file that it wrote.
function native(args, output) {
    const run = spawnSync(facet, args, { cwd: work, encoding: 'utf8' });
    return { code: run.status, stdout: run.stdout, stderr: run.stderr, file: output && run.status === 0 ? readFileSync(path.join(work, output)) : null };
}

// Tools with decoders of their own, and the names of those that were read. replace: bytes in place of a decoder's, or an Error.
async function start(replace = {}) {
    const read = [];
    const codecs = new Codecs({
        read: async (file) => {
            read.push(file);
            if (replace[file] instanceof Error) throw replace[file];
            return replace[file] ?? readFileSync(element(file));
        },
    });
    return { tools: await loadTools({ codecs }), read };
}

// The same command in both, which write the same bytes.
async function compare(tools, name, bytes, args, output) {
    writeFileSync(path.join(work, name), bytes);
    const theirs = native([...args, '-o', output], output);
    const ours = await tools.run([...args, '-o', output], { [name]: bytes });
    assert.equal(ours.code, 0, `${name}: ${ours.stderr}`);
    assert.equal(theirs.code, 0, theirs.stderr);
    assert.ok(theirs.file.equals(ours.files[output]), `${args.join(' ')}: the bytes differ from the native command's`);
    assert.equal(ours.stderr, theirs.stderr);
}

const testdata = (name) => readFileSync(path.join(top, 'src/io/testdata', name));
const image = (name) => readFileSync(path.join(top, 'tests/fuzz/corpus_image', name));
const ktx2 = (name) => readFileSync(path.join(top, 'src/image/testdata', name));
const shared = (...names) => names.map((name) => path.join(data, name)).filter((file) => existsSync(file));

// ---- the same as native, and fetched only when needed ----

{
    const { tools, read } = await start();
    await compare(tools, 'sail.glb', testdata('sail.glb'), ['convert', 'sail.glb'], 'out.glb');
    assert.deepEqual(read, [], 'a decoder was fetched for a model that needs none');
    for (const name of ['sail_draco_edgebreaker.glb', 'sail_draco_sequential.glb'])
        await compare(tools, name, testdata(name), ['convert', name], 'out.glb');
    for (const file of shared('models/extensions/Box_Draco.glb'))
        await compare(tools, 'box.glb', readFileSync(file), ['convert', 'box.glb'], 'out.glb');
    assert.deepEqual(read, ['codec_draco.wasm'], 'Draco is fetched once, and nothing else');
}
{
    const { tools, read } = await start();
    assert.equal(native(['render', '-s', '64x32', '-n', '1', '-q', '-o', 'env.exr']).code, 0);
    await compare(tools, 'env.exr', readFileSync(path.join(work, 'env.exr')), ['bake', 'env.exr', '--size', '16', '--samples', '16'], 'out.ktx2');
    for (const file of shared('env/exr/qwantani_512_float_piz.exr', 'env/exr/qwantani_256_half_none_tiled.exr', 'images/exr/flaga.exr'))
        await compare(tools, 'file.exr', readFileSync(file), ['bake', 'file.exr', '--size', '16', '--samples', '16'], 'out.ktx2');
    assert.deepEqual(read, ['codec_exr.wasm']);
}

// A black image, without compression.
function black_tga(width, height) {
    const bytes = Buffer.alloc(18 + 3 * width * height);
    bytes[2] = 2;
    bytes.writeUInt16LE(width, 12);
    bytes.writeUInt16LE(height, 14);
    bytes[16] = 24;
    return bytes;
}

const extent_of = (ktx2) => [ktx2.readUInt32LE(20), ktx2.readUInt32LE(24)];

// Metrics of an image against a black one agree in all digits where the decoded texels do.
async function compare_texels(tools, name, bytes, width, height) {
    const black = black_tga(width, height);
    writeFileSync(path.join(work, name), bytes);
    writeFileSync(path.join(work, 'black.tga'), black);
    const ours = await tools.run(['compare', name, 'black.tga', '--json'], { [name]: bytes, 'black.tga': black });
    const theirs = native(['compare', name, 'black.tga', '--json']);
    const of = (text) => JSON.parse(text).metrics;
    assert.ok(of(theirs.stdout).mae > 0, `${name}: ${theirs.stderr}`);
    assert.deepEqual(of(ours.stdout), of(theirs.stdout), `${name}: decoded texels differ from the native command's`);
}

{
    const { tools, read } = await start();
    assert.equal(native(['render', '-s', '48x32', '-n', '1', '-q', '--background', 'transparent', '-o', 'view.webp']).code, 0);
    await compare_texels(tools, 'view.webp', readFileSync(path.join(work, 'view.webp')), 48, 32);
    await compare_texels(tools, 'lossless.webp', image('lossless.webp'), 9, 7);
    assert.deepEqual(read, ['codec_webp.wasm']);
}

{
    const { tools, read } = await start();
    await compare_texels(tools, 'uastc_modes.ktx2', ktx2('uastc_modes.ktx2'), ...extent_of(ktx2('uastc_modes.ktx2')));
    assert.deepEqual(read, [], 'a decoder was fetched for a file without Zstandard');
    await compare_texels(tools, 'uastc_zstd.ktx2', ktx2('uastc_zstd.ktx2'), ...extent_of(ktx2('uastc_zstd.ktx2')));
    assert.equal(native(['bake', 'sun:40,135', '--size', '32', '--zstd', '9', '-q', '-o', 'sky.ktx2']).code, 0);
    await compare(tools, 'sky.ktx2', readFileSync(path.join(work, 'sky.ktx2')), ['bake', 'sky.ktx2', '--size', '16', '--samples', '16'], 'out.ktx2');
    assert.deepEqual(read, ['codec_zstd.wasm']);
}

// ---- what cannot be decoded has its sentence, and the next file is read ----

async function refuse(tools, name, bytes, expected) {
    const result = await tools.run(['compare', name, name, '--json'], { [name]: bytes });
    assert.notEqual(result.code, 0, `${name} was read`);
    assert.match(result.stderr, expected);
    assert.equal(result.stderr.trim().split('\n').length, 1, result.stderr);
}
const accept = async (tools, name) => assert.equal((await tools.run(['compare', name, name, '--json'], { [name]: image(name) })).code, 0, name);

{
    const { tools, read } = await start();
    for (const name of ['zip.exr', 'piz.exr', 'b44.exr', 'dwab.exr', 'lossy.webp']) {
        const whole = image(name);
        await refuse(tools, name, whole.subarray(0, whole.length - 30), /OpenEXR: .*(ends too early|damaged)|WebP: the file ends too early/);
        await accept(tools, name);
    }
    // 16383 x 16383 texels in a lossless file of a few bytes
    const huge = Buffer.concat([Buffer.from('RIFF\x1a\0\0\0WEBPVP8L\x0d\0\0\0\x2f\xfe\xbf\xff\x0f', 'latin1'), Buffer.alloc(8)]);
    await refuse(tools, 'huge.webp', huge, /WebP|out of memory/);
    await accept(tools, 'lossless.webp');
    await refuse(tools, 'image.avif', image('rgba_lossless.avif'), /image\.avif: AVIF: only a browser decodes it/);
    assert.deepEqual(read, ['codec_exr.wasm', 'codec_webp.wasm'], 'a decoder is fetched once');
}
{
    const { tools } = await start({ 'codec_webp.wasm': new Error('the server answers 404'), 'codec_draco.wasm': Buffer.from('no module') });
    await refuse(tools, 'lossy.webp', image('lossy.webp'), /lossy\.webp: WebP: codec_webp\.wasm could not be loaded: the server answers 404/);
    const draco = await tools.run(['inspect', 'a.glb'], { 'a.glb': testdata('sail_draco_sequential.glb') });
    assert.notEqual(draco.code, 0);
    assert.match(draco.stderr, /a\.glb: .*KHR_draco_mesh_compression.*codec_draco\.wasm could not be loaded/);
    await accept(tools, 'zip.exr');
}
{
    const { tools } = await start({ 'codec_zstd.wasm': new Error('the server answers 404') });
    await refuse(tools, 'a.ktx2', ktx2('uastc_zstd.ktx2'), /a\.ktx2: KTX2: level 0: codec_zstd\.wasm could not be loaded: the server answers 404/);
    const whole = await start();
    const damaged = Buffer.from(ktx2('uastc_zstd.ktx2'));
    damaged.fill(0xff, Number(damaged.readBigUInt64LE(80))); // from level 0 on
    await refuse(whole.tools, 'b.ktx2', damaged, /b\.ktx2: KTX2: level 0: the compressed data is damaged/);
    await compare_texels(whole.tools, 'c.ktx2', ktx2('uastc_zstd.ktx2'), ...extent_of(ktx2('uastc_zstd.ktx2')));
}

// ---- a decoder that breaks ----

// A module whose functions stop at once, but for malloc, free and _initialize.
function broken_module() {
    const names = ['_initialize', 'malloc', 'free', 'webp_probe', 'webp_decode', 'image_destroy'];
    const vector = (items) => [items.length, ...items.flat()];
    const section = (number, bytes) => [number, bytes.length, ...bytes];
    const text = (name) => vector([...Buffer.from(name)]);
    const constant = [0x41, 0x80, 0x08]; // i32.const 1024
    const bodies = [[0x0b], [...constant, 0x0b], [0x0b], ...Array(3).fill([0x00, 0x0b])].map((code) => [code.length + 1, 0, ...code]);
    return Uint8Array.from([0, 0x61, 0x73, 0x6d, 1, 0, 0, 0,
        ...section(1, vector([[0x60, 0, 0], [0x60, 1, 0x7f, 1, 0x7f], [0x60, 1, 0x7f, 0], [0x60, 0, 1, 0x7f]])),
        ...section(3, vector([[0], [1], [2], [3], [3], [3]])),
        ...section(5, [1, 0, 1]),
        ...section(7, vector([...names.map((name, i) => [...text(name), 0, i]), [...text('memory'), 2, 0]])),
        ...section(10, vector(bodies))]);
}

{
    const { tools } = await start({ 'codec_webp.wasm': broken_module() });
    for (let i = 0; i < 2; i++)
        await refuse(tools, 'lossy.webp', image('lossy.webp'), /lossy\.webp: WebP: the decoder stopped \(unreachable/);
    await accept(tools, 'zip.exr');
}
console.log('codecs: as the native command');
