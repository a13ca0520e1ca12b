// ktx_parse.mjs - what facet bake writes, read by ktx-parse and by ktx2.mjs. usage: node ktx_parse.mjs FACET WORK
//
// Cube maps of every lobe in every format, with and without Zstandard, and every table: both readers agree, the file breaks
// no rule, the texels are the nearest ones to those of the 32-bit file, which are those of OpenEXR files (read by three.js),
// and those are where a closed form says.
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { decompress } from 'fzstd';
import { read } from 'ktx-parse';
import { FloatType } from 'three';
import { EXRLoader } from 'three/addons/loaders/EXRLoader.js';
import { FACES, SLOPE, colors_of, filament_roughness, linear_roughness, mean_cosine, write_panorama } from './light.mjs';
import { read_ktx2 } from './ktx2.mjs';
import { broken_files } from './ktx2_bite.mjs';
import { formats, is_nearest } from './texels.mjs';
import { tables } from './reflectance.mjs';
import { Report, baker } from './report.mjs';
import { distance_to_colors } from './texture.mjs';

const [facet, work] = process.argv.slice(2);
const report = new Report(), bake = baker(facet);
const file = (name) => path.join(work, name);
const bytes_of = (name) => new Uint8Array(readFileSync(file(name)));

// The file by both readers, compared.
function read_both(name) {
    const bytes = bytes_of(name), ours = read_ktx2(bytes), theirs = read(bytes);
    ours.problems.forEach((problem) => report.expect(false, `${name}: ${problem}`));
    if (!report.expect(ours.problems.length === 0, `${name} breaks ${ours.problems.length} rules`)) return ours;
    const same = (a, b, what) => report.expect(JSON.stringify(a) === JSON.stringify(b), `${name}: ${what}: ${JSON.stringify(a)}, ` +
        `by ktx-parse ${JSON.stringify(b)}`);
    same([formats[ours.format].vk, ours.width, ours.height, 0, 0, ours.faces, ours.levels.length, ours.is_compressed ? 2 : 0],
        [theirs.vkFormat, theirs.pixelWidth, theirs.pixelHeight, theirs.pixelDepth, theirs.layerCount, theirs.faceCount,
            theirs.levelCount, theirs.supercompressionScheme], 'header');
    same(Object.fromEntries(ours.metadata), theirs.keyValue, 'metadata');
    const [descriptor, ...others] = theirs.dataFormatDescriptor;
    same([1, 1, 1, 0, [formats[ours.format].size, 0, 0, 0, 0, 0, 0, 0]], [descriptor.colorModel, descriptor.colorPrimaries,
        descriptor.transferFunction, descriptor.flags, descriptor.bytesPlane], 'descriptor');
    same(formats[ours.format].samples.map(([first, bits, channel, lower, upper]) => [first, bits - 1, channel, lower | 0, upper | 0]),
        descriptor.samples.map((s) => [s.bitOffset, s.bitLength, s.channelType, s.sampleLower | 0, s.sampleUpper | 0]), 'samples');
    same(0, others.length, 'more descriptors');
    theirs.levels.forEach((level, i) => {
        const whole = ours.is_compressed ? decompress(level.levelData) : level.levelData;
        const view = new DataView(whole.buffer, whole.byteOffset, whole.byteLength), { size, decode } = formats[ours.format];
        same(level.uncompressedByteLength, whole.length, `size of level ${i}`);
        const ends = [0, whole.length - size].map((at) => [...Float32Array.from(decode(view, at))]);
        same([ours.levels[i].texels.slice(0, 4), ours.levels[i].texels.slice(-4)].map((t) => [...t]), ends, `ends of level ${i}`);
    });
    return ours;
}

function check_texels(name, file_read, exact) {
    if (!report.expect(file_read.levels?.length === exact.levels.length, `${name} has not ${exact.levels.length} levels`)) return;
    let wrong = 0;
    exact.levels.forEach((level, i) => {
        for (let k = 0; k < level.texels.length; k += 4) {
            const texel = level.texels.subarray(k, k + 4), stored = file_read.levels[i].texels.subarray(k, k + 4);
            if (!is_nearest(file_read.format, [...texel], [...stored]) || (formats[file_read.format].channels === 4 && stored[3] !== 1))
                wrong++;
        }
    });
    report.expect(wrong === 0, `${name}: ${wrong} texels are not the nearest to those of rgba32f`);
}

// ---- cube maps ----

const SIZE = 32, LEVELS = 4;
write_panorama(file('colors.pfm'), 256, colors_of);

// Rows of an OpenEXR file from the top, RGB.
function read_exr(name) {
    const bytes = bytes_of(name), loader = new EXRLoader().setDataType(FloatType);
    const { data, width, height } = loader.parse(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength));
    const channels = data.length / (width * height), out = [];
    for (let y = height - 1; y >= 0; y--) // three.js has rows from the bottom
        for (let x = 0; x < width; x++) out.push(data.subarray(channels * (y * width + x), channels * (y * width + x) + 3));
    return out;
}

// Texels are those of the closed form. Of the environment itself texels are means over their area: less than the direction
// of their middle is long, by 1 / 3 to 1 / 6 of (edge / size)^2. Narrow lobes are summed over such means, wide ones exact.
function check_closed_form(name, cube, lobe, roughness_of) {
    cube.levels.forEach(({ width, texels }, level) => {
        const roughness = lobe === 'lambert' ? 1 : roughness_of(level, cube.levels.length);
        if (lobe === 'charlie' && level === 0) return; // a ring of no width
        const k = mean_cosine(lobe, roughness), tolerance = lobe === 'none' || roughness === 0
            ? 1e-4 + SLOPE / width ** 2 : roughness < 0.5 ? 3e-4 : 1e-4;
        const { worst, where } = distance_to_colors(texels, width, k);
        report.expect(worst <= tolerance, `${name}, level ${level} (roughness ${roughness}): off by ${worst} at ${where}`);
    });
}

for (const lobe of ['ggx', 'charlie', 'lambert', 'none']) {
    const levels = lobe === 'lambert' ? 1 : LEVELS;
    const options = (format, zstd) => ['--lobe', lobe, '--size', SIZE, '--mips', levels, '--format', format, '--zstd', zstd];
    const name = `${lobe}-rgba32f-0.ktx2`;
    bake(file('colors.pfm'), '-o', file(name), ...options('rgba32f', 0));
    const exact = read_both(name);
    report.expect(exact.format === 'rgba32f' && exact.faces === 6 && exact.width === SIZE && exact.levels.length === levels,
        `${name} is not what was asked for`);
    check_closed_form(name, exact, lobe, linear_roughness);
    bake(file('colors.pfm'), '-o', file(`${lobe}-{level}-{face}.exr`), '--lobe', lobe, '--size', SIZE, '--mips', levels,
        '--format', 'exr32');
    exact.levels.forEach(({ width, texels }, level) => FACES.forEach((face, f) => {
        const picture = read_exr(`${lobe}-${level}-${face}.exr`);
        report.expect(picture.length === width * width && picture.every((rgb, i) =>
            [0, 1, 2].every((c) => rgb[c] === texels[4 * (f * width * width + i) + c])), `${lobe}: ${face} of level ${level} is not the OpenEXR file's`);
    }));
    for (const format of ['rgba32f', 'rgba16f', 'rgb9e5', 'b10g11r11'])
        for (const zstd of [0, 5]) {
            if (format === 'rgba32f' && zstd === 0) continue;
            const other = `${lobe}-${format}-${zstd}.ktx2`;
            bake(file('colors.pfm'), '-o', file(other), ...options(format, zstd));
            const cube = read_both(other);
            report.expect(cube.format === format && cube.is_compressed === zstd > 0, `${other} is ${cube.format}`);
            check_texels(other, cube, exact);
        }
}
bake(file('colors.pfm'), '-o', file('filament.ktx2'), '--size', SIZE, '--mips', LEVELS, '--mapping', 'filament', '--format', 'rgba32f');
check_closed_form('filament.ktx2', read_both('filament.ktx2'), 'ggx', filament_roughness);

// ---- tables ----

const TABLE = 16;
for (const [kind, channels_at] of Object.entries(tables)) {
    const exact_name = `${kind}-exact.ktx2`, options = ['--dfg', '--distribution', kind, '--size', TABLE];
    bake(...options, '--format', 'rgba32f', '-o', file(exact_name));
    const exact = read_both(exact_name);
    report.expect(exact.faces === 1 && exact.width === TABLE && exact.height === TABLE && exact.levels.length === 1, `${exact_name} is no table`);
    for (const x of [2, 7, 15])
        for (const y of kind === 'average' && x > 2 ? [] : [6, 10, 15]) { // sheen is a peak at small roughness
            const v = (x + 0.5) / TABLE, r = (y + 0.5) / TABLE;
            channels_at(v, r).forEach((wanted, c) => report.near(exact.levels[0].texels[4 * (y * TABLE + x) + c], wanted,
                kind === 'average' ? 2e-4 : 5e-5, `${kind} at N.V ${v}, roughness ${r}, channel ${c}`));
        }
    for (const format of [null, 'rg32f', 'rgba16f', 'r16f', 'r32f'])
        for (const zstd of [0, 9]) {
            const other = `${kind}-${format}-${zstd}.ktx2`;
            bake(...options, ...(format ? ['--format', format] : []), '--zstd', zstd, '-o', file(other));
            const table = read_both(other);
            const own = { 1: 'r16f', 2: 'rg16f', 3: 'rgba16f' }[channels_at(0.5, 0.5).length];
            report.expect(table.format === (format ?? own) && table.faces === 1, `${other} is ${table.format}`);
            check_texels(other, table, exact);
        }
}

// ---- the reader bites ----

for (const name of ['ggx-rgba16f-0.ktx2', 'ggx-rgb9e5-0.ktx2'])
    for (const [what, bytes] of broken_files(bytes_of(name)))
        report.expect(read_ktx2(bytes).problems.length > 0, `${name} with a broken ${what} is taken for a good one`);

report.end('ktx-parse');
