// browser.mjs - a page of ours in headless Chromium with software WebGL (SwiftShader), served from this machine.
import { createServer } from 'node:http';
import { readFile } from 'node:fs/promises';
import { fileURLToPath } from 'node:url';
import path from 'node:path';
import { chromium } from 'playwright-core';

export { chromium };

const here = path.dirname(fileURLToPath(import.meta.url));
const types = { '.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.wasm': 'application/wasm',
    '.svg': 'image/svg+xml' };

// Opens the page at address. contents(url) is the path of the file behind a URL, or { text } of a page. CHROMIUM names the
// browser (/usr/bin/chromium). Returns the page, what closes it, and what it said: warnings, and errors that on_error gets, too.
export async function serve_page(address, contents, on_error = () => {}) {
    const server = createServer(async (request, response) => {
        try {
            const url = path.normalize(decodeURIComponent(new URL(request.url, 'http://localhost').pathname));
            const what = contents(url), type = what.text === undefined ? types[path.extname(url)] : 'text/html';
            const bytes = what.text ?? await readFile(what);
            if (type) response.setHeader('content-type', type);
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
    const page = await browser.newPage(), messages = [];
    page.on('pageerror', (error) => { messages.push(String(error)); on_error(error); });
    page.on('console', (message) => { if (['error', 'warning'].includes(message.type())) messages.push(message.text()); });
    await page.goto(`http://127.0.0.1:${server.address().port}${address}`);
    return { page, messages, close: async () => { await browser.close(); server.close(); } };
}

// Opens the page name of this folder, and waits until it says window.ready. /work/.. are the files of the folder work, all
// else those of this folder. Throws window.failure.
export async function open_page(name, work) {
    const served = await serve_page(`/${name}`, (url) => url.startsWith('/work/') ? path.join(work, url.slice(6)) : path.join(here, url));
    try {
        await served.page.waitForFunction('window.ready || window.failure', null, { timeout: 120000 });
        const failure = await served.page.evaluate('window.failure');
        if (failure) throw new Error(failure);
    } catch (error) {
        await served.close();
        throw new Error(`${name}: ${error.message}\n${served.messages.join('\n')}`);
    }
    return served;
}
