#!/usr/bin/env node
// facet.js - the command `facet` of the npm package: npx facet inspect model.glb. Files named on the command line are read, the command runs on
// them in memory (tools.js), and what it wrote is written to the disk. Images are not rendered in Node.js yet: the command says so.
import { existsSync, statSync } from 'node:fs';
import { readFile } from 'node:fs/promises';
import { basename, dirname, extname, join, relative, resolve } from 'node:path';
import { loadTools, readFolder, writeFiles, FacetError } from './node.js';

const OF_SEVERAL_FILES = new Set(['.gltf', '.obj']);
const PARTS = /\.(bin|mtl|png|jpe?g|webp|avif|ktx2|dds|tga|bmp|gif|hdr|exr|drc)$/i;
const OUTSIDE = 'elsewhere'; // folders that are not below the working directory, by number

// The names of folders in the command's memory.
class Folders {
  #outside = []; // as they are written on the command line

  nameOf(folder) {
    const below = relative(process.cwd(), resolve(folder));
    if (!below.startsWith('..') && resolve(below) === resolve(folder) && !isElsewhere(folder)) return below.split('\\').join('/');
    if (!this.#outside.includes(folder)) this.#outside.push(folder);
    return `${OUTSIDE}/${this.#outside.indexOf(folder)}`;
  }

  // The path on the disk of a file that the command wrote.
  placeOf(path) {
    const [first, number, ...rest] = path.split('/');
    return first === OUTSIDE && this.#outside[number] ? join(this.#outside[number], ...rest) : path;
  }

  // Messages name files as they are on the disk.
  inText(text) {
    return text.replace(new RegExp(`${OUTSIDE}/(\\d+)/`, 'g'), (all, number) => (this.#outside[number] ? join(this.#outside[number], '/') : all));
  }
}

const isFile = (path) => existsSync(path) && statSync(path).isFile();
const isElsewhere = (word) => /^(\.\.?[\\/]|[\\/]|[A-Za-z]:[\\/])/.test(word);

// Reads what the word names, with the files beside a model of several. Returns the word as the command sees it.
async function take(word, folders, files) {
  const [option, value] = /^(--[\w-]+=)(.+)$/s.exec(word)?.slice(1) ?? ['', word];
  if (value.startsWith('-') || (!isFile(value) && !isElsewhere(value))) return word;
  const folder = dirname(value);
  const root = folders.nameOf(folder);
  const inMemory = (name) => (root ? `${root}/${name}` : name);
  if (isFile(value)) files[inMemory(basename(value))] ??= await readFile(value);
  if (isFile(value) && OF_SEVERAL_FILES.has(extname(value).toLowerCase()))
    for (const [name, bytes] of Object.entries(await readFolder(folder, (path) => PARTS.test(path) && !path.startsWith('node_modules/')))) files[inMemory(name)] ??= bytes;
  return option + inMemory(basename(value));
}

async function readStdin() {
  const chunks = [];
  for await (const chunk of process.stdin) chunks.push(chunk);
  return Buffer.concat(chunks);
}

async function main(words) {
  const folders = new Folders();
  const files = {};
  const args = [];
  for (const word of words) args.push(await take(word, folders, files));
  const readsStdin = words[1] === '-' && !process.stdin.isTTY;
  const result = await (await loadTools()).run(args, files, readsStdin ? { stdin: await readStdin() } : {});
  await writeFiles('.', Object.fromEntries(Object.entries(result.files).map(([path, bytes]) => [folders.placeOf(path), bytes])));
  process.stderr.write(folders.inText(result.stderr));
  const isText = Buffer.from(result.stdout).equals(result.stdoutBytes);
  process.stdout.write(isText ? folders.inText(result.stdout) : result.stdoutBytes);
  return result.code;
}

main(process.argv.slice(2)).then((code) => { process.exitCode = code; }, (error) => {
  process.stderr.write(`facet: ${error.message}\n`);
  process.exitCode = error instanceof FacetError ? error.code ?? 2 : 70;
});
