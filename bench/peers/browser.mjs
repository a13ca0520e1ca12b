// browser.mjs - a page of ours in headless Chromium, served from this machine: what the peers in a browser share.
import { createServer } from 'node:http';
import { readFile } from 'node:fs/promises';
import { fileURLToPath } from 'node:url';
import path from 'node:path';
import { chromium } from 'playwright-core';

const here = path.dirname(fileURLToPath(import.meta.url));
const types = { '.js': 'text/javascript', '.wasm': 'application/wasm' };

// Opens text as the page /; file(url) names the file behind another address, or undefined for one below this folder.
// CHROMIUM names the browser (/usr/bin/chromium). Returns the page and what closes it.
export async function open_page(text, file) {
    const server = createServer(async (request, response) => {
        try {
            const url = decodeURIComponent(new URL(request.url, 'http://localhost').pathname);
            if (url === '/') {
                response.setHeader('content-type', 'text/html');
                return response.end(text);
            }
            const type = types[path.extname(url)];
            if (type) response.setHeader('content-type', type);
            response.end(await readFile(file(url) ?? path.join(here, path.normalize(url))));
        } catch {
            response.statusCode = 404;
            response.end();
        }
    });
    await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
    const browser = await chromium.launch({
        executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
        args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
            '--disable-background-networking', '--disable-component-update', '--disable-sync', '--no-first-run'],
    });
    const page = await browser.newPage();
    page.on('pageerror', (error) => { console.error(String(error)); process.exitCode = 1; });
    await page.goto(`http://127.0.0.1:${server.address().port}/`);
    return { page, close: async () => { await browser.close(); server.close(); } };
}
