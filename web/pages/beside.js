// beside.js - the script of a page beside its files, on a web server.
import { showPage } from './show.js';

async function readFile({ path, url }) {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url} could not be fetched: the server answered ${response.status}`);
  return { path, file: await response.blob() };
}

showPage(({ files }) => Promise.all(files.map(readFile)));
