// browser.mjs - a page of ours in headless Chromium with software WebGL (SwiftShader), served from this machine.
import { createServer } from 'node:http';
import { readFile } from 'node:fs/promises';
import { fileURLToPath } from 'node:url';
import path from 'node:path';
import { chromium } from 'playwright-core';

const here = path.dirname(fileURLToPath(import.meta.url));
const types = { '.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.wasm': 'application/wasm' };

// Opens the page name of this folder. /work/.. are the files of the folder work, all else those of this folder. CHROMIUM
// names the browser (/usr/bin/chromium). The page says window.ready, or window.failure. Returns { page, close }.
export async function open_page(name, work) {
    const server = createServer(async (request, response) => {
        try {
            const url = path.normalize(decodeURIComponent(new URL(request.url, 'http://localhost').pathname));
            const file = url.startsWith('/work/') ? path.join(work, url.slice(6)) : path.join(here, url);
            const bytes = await readFile(file);
            if (types[path.extname(url)]) response.setHeader('content-type', types[path.extname(url)]);
            response.end(bytes);
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
    const close = async () => { await browser.close(); server.close(); };
    const page = await browser.newPage();
    const messages = [];
    page.on('pageerror', (error) => messages.push(String(error)));
    page.on('console', (message) => { if (['error', 'warning'].includes(message.type())) messages.push(message.text()); });
    await page.goto(`http://127.0.0.1:${server.address().port}/${name}`);
    try {
        await page.waitForFunction('window.ready || window.failure', null, { timeout: 120000 });
        const failure = await page.evaluate('window.failure');
        if (failure) throw new Error(failure);
    } catch (error) {
        await close();
        throw new Error(`${name}: ${error.message}\n${messages.join('\n')}`);
    }
    return { page, close, messages };
}
