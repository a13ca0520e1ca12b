// build.mjs DIST - what facet view --html needs besides the files of DIST: pages/single.html, the page of one file with style, script and
// viewer inside, and pages/files.txt, the files that a folder of pages gets. Bundles by esbuild.
import { execFileSync } from 'node:child_process';
import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { gzipSync } from 'node:zlib';

const dist = process.argv[2];
const at = (name) => path.join(dist, name);
const esbuild = (...words) => execFileSync('esbuild', ['--minify', '--log-level=error', '--charset=utf8', ...words], { encoding: 'utf8' }).trim();

// A module of the viewer, for showPage(): its bytes are found by the name.
const carry = (name) => `<script type="application/octet-stream;base64" data-module="${name}">` +
  `${gzipSync(readFileSync(at(`facet-viewer/${name}`)), { level: 9 }).toString('base64')}</script>\n`;

const parts = {
  style: esbuild(at('pages/page.css')),
  modules: carry('viewer.wasm'),
  // import.meta.url of a page is its address; modules are not fetched from there
  script: esbuild('--bundle', '--format=esm', '--target=es2022', at('pages/single.js')),
};
const page = readFileSync(at('pages/single.in.html'), 'utf8').replace(/\[\[(\w+)\]\]/g, (_, name) => parts[name]);
writeFileSync(at('pages/single.html'), page);

const isOfViewer = (name) => /\.(js|wasm)$/.test(name) && !/^(node|tools|facet-command|ocean)\b/.test(name);
const viewer = readdirSync(at('facet-viewer')).filter(isOfViewer).sort().map((name) => `facet-viewer/${name}`);
writeFileSync(at('pages/files.txt'), [...viewer, 'pages/beside.js', 'pages/disk.js', 'pages/page.css', 'pages/show.js', ''].join('\n'));
console.log(`web: pages/single.html ${page.length} bytes`);
