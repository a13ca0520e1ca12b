// pack.mjs - the packed element: its files, its size, its metadata, and its types as a program sees them. usage: pack.mjs TGZ WORK [TSC]
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { copyFileSync, mkdirSync, readFileSync, statSync, symlinkSync } from 'node:fs';
import path from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';

const [archive, work, tsc] = process.argv.slice(2);
const here = path.dirname(fileURLToPath(import.meta.url));
const most = 6 << 20; // bytes

const files = execFileSync('tar', ['-tzf', archive], { encoding: 'utf8' }).trim().split('\n').map((name) => name.replace(/^package\//, ''));
for (const name of ['package.json', 'README.md', 'LICENSE', 'facet-viewer.js', 'facet-viewer.d.ts', 'module.js', 'engine.js', 'viewer.js', 'viewer.wasm', 'node.js', 'tools.js'])
    assert.ok(files.includes(name), `${name} is not in the package`);
assert.ok(!files.some((name) => name.startsWith('ocean')), 'the package has the sea, which nothing in it uses');
for (const name of files)
    assert.match(name, /^[\w.-]+\.(js|wasm|d\.ts)$|^(package\.json|README\.md|LICENSE)$/, `${name} does not belong in the package`);
assert.ok(statSync(archive).size < most, `the package has ${statSync(archive).size} bytes`);

// Every module that a file of the package imports is in it.
execFileSync('tar', ['-xzf', archive, '-C', work]);
const root = path.join(work, 'package');
for (const name of files.filter((file) => file.endsWith('.js')))
    for (const [, target] of readFileSync(path.join(root, name), 'utf8').matchAll(/(?:from|import\()\s*'\.\/([^']+)'/g))
        assert.ok(files.includes(target), `${name} imports ${target}, which is not in the package`);

const json = JSON.parse(readFileSync(path.join(root, 'package.json'), 'utf8'));
assert.match(json.version, /^[1-9]?\d+\.\d+\.\d+$/);
assert.notEqual(json.version, '0.0.0');
assert.ok(archive.endsWith(`facet-viewer-${json.version}.tgz`));
for (const target of [json.main, json.types, json.exports['.'].node, json.bin.facet]) assert.ok(files.includes(target.replace('./', '')), `${target} is not in the package`);

// Every attribute has a typed property.
const { ATTRIBUTES, propertyOf } = await import(pathToFileURL(path.join(root, 'attributes.js')));
const types = readFileSync(path.join(root, 'facet-viewer.d.ts'), 'utf8');
assert.deepEqual(Object.keys(ATTRIBUTES).map(propertyOf).filter((name) => !types.includes(`\n  ${name}: `)), [], 'properties without a type');

if (tsc) {
    mkdirSync(path.join(work, 'node_modules'));
    symlinkSync(root, path.join(work, 'node_modules/facet-viewer'));
    copyFileSync(path.join(here, 'types.ts'), path.join(work, 'types.ts'));
    execFileSync(process.execPath, [tsc, '--noEmit', '--strict', '--target', 'es2022', '--module', 'esnext', '--moduleResolution', 'bundler', '--lib', 'es2022,dom', path.join(work, 'types.ts')], { stdio: ['ignore', 'inherit', 'inherit'] });
}
console.log(`pack: ${files.length} files, ${statSync(archive).size} bytes${tsc ? ', types compile' : ''}`);
