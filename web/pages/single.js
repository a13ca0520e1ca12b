// single.js - the script of a page of one file: everything is in the page.
import { carry } from '../facet-viewer/module.js';
import { unpack } from './carried.js';
import { showPage } from './show.js';

const blocks = (name) => [...document.querySelectorAll(`script[data-${name}]`)];

async function readFiles() {
  await Promise.all(blocks('module').map(async ({ dataset, textContent }) => carry(dataset.module, await (await unpack(textContent)).arrayBuffer())));
  return Promise.all(blocks('path').map(async ({ dataset, textContent }) => ({ path: dataset.path, file: await unpack(textContent) })));
}

showPage(readFiles);
