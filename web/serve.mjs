// serve.mjs DIST [PORT] - serves the page on this machine only.
import { createServer } from 'node:http';
import { readFile } from 'node:fs/promises';
import path from 'node:path';

const root = path.resolve(process.argv[2]);
const types = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.svg': 'image/svg+xml', '.wasm': 'application/wasm' };
createServer(async (request, response) => {
  try {
    const name = path.normalize(decodeURIComponent(new URL(request.url, 'http://localhost').pathname));
    const bytes = await readFile(path.join(root, name.endsWith('/') ? 'index.html' : name));
    response.setHeader('content-type', types[path.extname(name) || '.html'] ?? 'application/octet-stream');
    response.end(bytes);
  } catch {
    response.statusCode = 404;
    response.end();
  }
}).listen(Number(process.argv[3] ?? 8080), '127.0.0.1', function () {
  console.log(`http://127.0.0.1:${this.address().port}/`);
});
