// build.mjs DIST ESBUILD - what facet view --html needs besides the files of DIST: pages/single.html, the page of one file with style, script and
// viewer inside, and pages/files.txt, the files that a folder of pages gets.
import { execFileSync } from 'node:child_process';
import { readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { gzipSync } from 'node:zlib';

const [dist, bundler] = process.argv.slice(2);
const at = (name) => path.join(dist, name);
// tools.js, which writes models, is not carried: the element says so where it is asked for.
const esbuild = (entry, ...words) => execFileSync(bundler, ['--minify', '--log-level=error', '--charset=utf8', '--target=es2022', '--bundle', '--external:*/tools.js',
  ...words, at(`pages/${entry}`)], { encoding: 'utf8', maxBuffer: 2 ** 28 }).trim();

// A module of the viewer, for showPage(): its bytes are found by the name.
const carry = (name) => `<script type="application/octet-stream;base64" data-module="${name}">` +
  `${gzipSync(readFileSync(at(`facet-viewer/${name}`)), { level: 9 }).toString('base64')}</script>\n`;

const parts = {
  style: esbuild('page.css'),
  modules: carry('viewer.wasm'),
  // import.meta.url of a page is its address; modules are not fetched from there
  script: esbuild('single.js', '--format=esm'),
};
const page = readFileSync(at('pages/single.in.html'), 'utf8').replace(/\[\[(\w+)\]\]/g, (_, name) => parts[name]);
writeFileSync(at('pages/single.html'), page);

// The same as one classic script, for R's htmlwidgets.
writeFileSync(at('pages/viewer.wasm.gz'), gzipSync(readFileSync(at('facet-viewer/viewer.wasm')), { level: 9 }));
writeFileSync(at('pages/widget.js'), esbuild('widget.in.js', '--format=iife', '--define:import.meta.url=document.baseURI',
  '--loader:.gz=base64'));
rmSync(at('pages/viewer.wasm.gz'));

const isOfViewer = (name) => /\.(js|wasm)$/.test(name) && !/^(node|facet|tools|facet-command|ocean)(?!-viewer)\b/.test(name);
const viewer = readdirSync(at('facet-viewer')).filter(isOfViewer).sort().map((name) => `facet-viewer/${name}`);
writeFileSync(at('pages/files.txt'), [...viewer, 'pages/beside.js', 'pages/page.css', 'pages/show.js', 'pages/start.js', ''].join('\n'));
console.log(`web: pages/single.html ${page.length} bytes`);
