// browser.mjs - a page of ours in headless Chromium (tests/clients/browser.mjs): what the peers in a browser share.
import { fileURLToPath } from 'node:url';
import path from 'node:path';
import { serve_page } from '../../tests/clients/browser.mjs';

const here = path.dirname(fileURLToPath(import.meta.url));

// Opens text as the page /; file(url) names the file behind another address, or undefined for one below this folder.
// Returns the page and what closes it.
export const open_page = (text, file) =>
    serve_page('/', (url) => url === '/' ? { text } : file(url) ?? path.join(here, url),
        (error) => { console.error(String(error)); process.exitCode = 1; });
