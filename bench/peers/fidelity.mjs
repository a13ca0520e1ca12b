// fidelity.mjs - renders models with other viewers in headless Chromium (SwiftShader) and with facet, with the same light, camera and
// tone mapping, and measures how far the images are apart: FLIP, and the mean difference in 8-bit codes.
// usage: node fidelity.mjs [--size N] [--samples N] [--renderers preview,gl,path] [--args "OPTIONS"] FACET MODELS LIGHT.hdr OUT [NAME ..]
// FACET: the command; MODELS: a folder with .glb and .gltf files; OUT: a folder for NAME-VIEWER.png, fidelity.json and worst.jpg, a sheet of
// the twelve models on which the first renderer is furthest from the nearest viewer; NAME: only these; --args: more options of facet
// render. Images that OUT has already are not rendered again: delete those of a renderer to renew them. CHROMIUM names the browser.
//
// Every image but those of path tracing is rendered at twice the size, and 2 x 2 codes are averaged. The spread of a model is the
// median FLIP of the viewers from one another; a ratio is the median FLIP of a renderer from the viewers, divided by the spread: below
// 1 it is nearer to them than they are to one another.
import { execFileSync, spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { open_page } from './browser.mjs';
import { make_bundles, pages } from './fidelity_pages.mjs';

const words = process.argv.slice(2);
const option = (name, otherwise) => words.includes(name) ? words.splice(words.indexOf(name), 2)[1] : otherwise;
const size = Number(option('--size', 384)), samples = option('--samples', '64');
const renderers = option('--renderers', 'preview,gl,path').split(','), extra = option('--args', '').split(' ').filter(Boolean);
const [facet, models, light, out, ...only] = words;
if (!out) {
    console.error('usage: node fidelity.mjs [--size N] [--samples N] [--renderers LIST] [--args OPTIONS] FACET MODELS LIGHT.hdr OUT [NAME ..]');
    process.exit(2);
}
mkdirSync(out, { recursive: true });
const viewers = Object.keys(pages), all_programs = [...viewers, ...renderers];

// ---- the models and their cameras ----

// Models that move: the time of the first animation, s.
const times = { Fox: 0.5, SimpleSkin: 1.2, MorphStressTest: 0.8, AnimatedColorsCube: 1 };
const azimuth = 20, elevation = 15; // degrees

const name_of = (file) => path.basename(file).replace(/\.(glb|gltf)$/, '');
const image_of = (name, program) => path.join(out, `${name}-${program}.png`);

// How to render a file: from above the front, the sphere around its bounds in the frame. None for a file without extent.
function job_of(file) {
    const inspected = spawnSync(facet, ['inspect', '--json', path.join(models, file)], { encoding: 'utf8' });
    const { min, max } = (inspected.status === 0 && JSON.parse(inspected.stdout).bounds) || {};
    const diagonal = min ? Math.hypot(...max.map((x, i) => x - min[i])) : 0;
    if (!(diagonal > 0)) return [];
    const name = name_of(file), target = min.map((x, i) => (x + max[i]) / 2), distance = diagonal / 2 / Math.sin(Math.PI / 12);
    const [a, e] = [azimuth, elevation].map((degrees) => degrees * Math.PI / 180);
    const eye = [Math.sin(a) * Math.cos(e), Math.sin(e), Math.cos(a) * Math.cos(e)].map((x, i) => target[i] + distance * x);
    const url = '/models/' + file.split(path.sep).map(encodeURIComponent).join('/');
    return [{ name, file, url, eye, target, distance, azimuth, elevation, size: 2 * size, time: times[name] }];
}

const jobs = readdirSync(models, { recursive: true }).filter((file) => /\.(glb|gltf)$/.test(file)).sort()
    .filter((file) => only.length === 0 || only.includes(name_of(file))).flatMap(job_of);

// ---- images ----

const url_of = (file) => existsSync(file) ? 'data:image/png;base64,' + readFileSync(file).toString('base64') : null;
const write_url = (file, url) => writeFileSync(file, Buffer.from(url.split(',')[1], 'base64'));
const images = await open_page('<!doctype html><link rel="icon" href="data:,"><script type="module" src="/fidelity_images.mjs"></script>', () => undefined);
await images.page.waitForFunction('window.ready');
const reduce_to = async (file, url) => write_url(file, await images.page.evaluate((image) => window.reduce(image), url));

// ---- rendering ----

const folder = mkdtempSync(path.join(tmpdir(), 'fidelity-'));

async function open_viewer(viewer) {
    const bundle_of = make_bundles(folder);
    const opened = await open_page(pages[viewer], (url) => url === '/light.hdr' ? light
        : url.startsWith('/models/') ? path.join(models, url.slice(8)) : url.startsWith('/bundles/') ? bundle_of(url) : undefined);
    await opened.page.waitForFunction('window.ready || window.failure', null, { timeout: 300000 });
    const failure = await opened.page.evaluate('window.failure');
    if (failure) throw new Error(`${viewer}: ${failure}`);
    return opened;
}

// The URL of the image of a job; throws after limit_s seconds.
async function draw(page, job, limit_s) {
    let timer;
    const late = new Promise((resolve, reject) => { timer = setTimeout(() => reject(new Error(`no image after ${limit_s} s`)), limit_s * 1000); });
    try {
        return await Promise.race([page.evaluate((words) => window.draw(words), job), late]);
    } finally {
        clearTimeout(timer);
    }
}

// A viewer that fails is opened anew for the next model.
async function draw_with(viewer) {
    let opened;
    for (const job of jobs.filter(({ name }) => !existsSync(image_of(name, viewer)))) {
        opened ??= await open_viewer(viewer);
        try {
            await reduce_to(image_of(job.name, viewer), await draw(opened.page, job, 600));
        } catch (error) {
            console.error(`${viewer}: ${job.name}: ${error.message.split('\n')[0]}`);
            await opened.close();
            opened = undefined;
        }
    }
    await opened?.close();
}

async function draw_facet(job, renderer) {
    const file = image_of(job.name, renderer), large = path.join(folder, 'large.png'), is_path = renderer === 'path';
    if (existsSync(file)) return;
    const { status, stderr } = spawnSync(facet, ['render', '-q', '--renderer', renderer,
        ...(is_path ? ['-s', `${size}`, '--samples', samples] : ['-s', `${2 * size}`]), '-e', light, `--eye=${job.eye}`, `--target=${job.target}`,
        '--fov=30', '--background', 'white', '--tone-mapping', 'neutral', ...extra, ...(job.time === undefined ? [] : [`--time=${job.time}`]),
        path.join(models, job.file), '-o', is_path ? file : large], { encoding: 'utf8' });
    if (status !== 0) {
        console.error(`${renderer}: ${job.name}: ${stderr.trim()}`);
        process.exitCode = 1;
    } else if (!is_path) {
        await reduce_to(file, url_of(large));
    }
}

// ---- measuring ----

async function distance(name, a, b) {
    const files = [a, b].map((program) => image_of(name, program));
    if (!files.every(existsSync)) return undefined;
    const { metrics } = JSON.parse(execFileSync(facet, ['compare', ...files, '--metric', 'flip', '--json']));
    return { flip: metrics.flip, mean: await images.page.evaluate(([x, y]) => window.mean_difference(x, y), files.map(url_of)) };
}

async function distances(name, from, programs) {
    const result = {};
    for (const program of programs.filter((program) => program !== from)) result[program] = await distance(name, from, program);
    return result;
}

function median(values) {
    const sorted = values.filter((value) => value !== undefined).sort((a, b) => a - b), middle = sorted.length >> 1;
    return sorted.length === 0 ? NaN : sorted.length % 2 ? sorted[middle] : (sorted[middle - 1] + sorted[middle]) / 2;
}

const median_of = (table, metric) => median(Object.values(table).map((d) => d?.[metric]));

// from[program][viewer]: the distance of a program from every other viewer; truth: that of the others from path tracing.
async function measure({ name }) {
    const result = { name, from: {} };
    for (const program of all_programs) result.from[program] = await distances(name, program, viewers);
    if (renderers.includes('path')) result.truth = await distances(name, 'path', all_programs);
    result.spread = median(viewers.flatMap((a, i) => viewers.slice(i + 1).map((b) => result.from[a][b]?.flip)));
    result.ratios = Object.fromEntries(renderers.map((renderer) => [renderer, median_of(result.from[renderer], 'flip') / result.spread]));
    return result;
}

// ---- printing ----

const print_row = (cells) => console.log(`| ${cells.join(' | ')} |`);
const print_head = (cells) => { print_row(cells); console.log(`| --- |${' ---: |'.repeat(cells.length - 1)}`); };
const cell_of = (d) => d ? `${d.flip.toFixed(3)} / ${d.mean.toFixed(1)}` : '-';

function print_models(results) {
    const columns = renderers.flatMap((renderer) => viewers.map((viewer) => [renderer, viewer]));
    print_head(['model', ...columns.map(([renderer, viewer]) => `${renderer}, ${viewer}`)]);
    for (const { name, from } of results) print_row([name, ...columns.map(([renderer, viewer]) => cell_of(from[renderer][viewer]))]);
}

function print_summary(results) {
    const row = (title, value) => print_row([title, ...all_programs.map(value)]);
    const values = (program, metric) => results.map(({ name, from }) => ({ name, value: median_of(from[program], metric) }))
        .filter(({ value }) => !Number.isNaN(value));
    const middle = (program, metric, digits) => median(values(program, metric).map(({ value }) => value)).toFixed(digits);
    const worst = (program, metric, digits) => {
        const { name, value } = values(program, metric).reduce((a, b) => b.value > a.value ? b : a, { name: '', value: 0 });
        return `${value.toFixed(digits)} (${name})`;
    };
    const ratios = (program) => results.map((result) => result.ratios[program]).filter(Number.isFinite);
    const of_renderers = (value) => (program) => renderers.includes(program) ? value(ratios(program)) : '';
    console.log();
    print_head(['', ...all_programs]);
    row('median FLIP from the viewers', (program) => middle(program, 'flip', 4));
    row('worst FLIP', (program) => worst(program, 'flip', 3));
    row('median mean difference, codes', (program) => middle(program, 'mean', 2));
    row('worst mean difference, codes', (program) => worst(program, 'mean', 1));
    if (renderers.includes('path'))
        row('median FLIP from path tracing', (program) => program === 'path' ? '0' : median(results.map(({ truth }) => truth[program]?.flip)).toFixed(4));
    row('median ratio to the spread', of_renderers((all) => median(all).toFixed(2)));
    row('models with a ratio above 1.2', of_renderers((all) => all.filter((ratio) => ratio > 1.2).length));
}

// The models on which the first renderer is furthest from the nearest viewer.
function worst_of(results, count) {
    const least = ({ from }) => Math.min(...Object.values(from[renderers[0]]).map((d) => d?.flip ?? Infinity));
    return results.filter((result) => Number.isFinite(least(result))).sort((a, b) => least(b) - least(a)).slice(0, count).map(({ name }) => name);
}

async function write_sheet(names) {
    const rows = names.map((title) => ({ title, urls: all_programs.map((program) => url_of(image_of(title, program))) }));
    const sheet = await images.page.evaluate((words) => window.sheet(...words), [all_programs, rows, 192]);
    write_url(path.join(out, 'worst.jpg'), sheet);
    console.log(`\nFurthest from all viewers, as in worst.jpg: ${names.join(', ')}.`);
}

try {
    for (const viewer of viewers) await draw_with(viewer);
    for (const renderer of renderers)
        for (const job of jobs) await draw_facet(job, renderer);
    const results = [];
    for (const job of jobs) results.push(await measure(job));
    writeFileSync(path.join(out, 'fidelity.json'), JSON.stringify(results, null, 1) + '\n');
    print_models(results);
    print_summary(results);
    const worst = worst_of(results, 12);
    if (worst.length) await write_sheet(worst);
} finally {
    await images.close();
    rmSync(folder, { recursive: true });
}
